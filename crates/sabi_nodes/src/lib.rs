//! Reads node kinds from WGSL text: header, reflection, rules, linking.
//!
//! A node is one WGSL file (`shaders/nodes/<category>/<name>.wgsl`). [`read_kind`] reads a file. [`Library`] holds many
//! kinds and keeps the last valid version of each.
//!
//! Invariants:
//! * The file of a kind holds everything about it: ports, parameters, ranges and texts.
//! * A kind that was read compiles in every kernel that it is linked into, terminates, and writes only its own results.
//! * Every fault has a file, a line, a column and advice.
//! * Nothing here depends on wgpu, on threads or on the links of a graph.
//!
//! ```
//! use sabi_nodes::{Library, SourceFile, read_kind};
//!
//! let library = Library::builtin();
//! let file = SourceFile {
//! path: "half.wgsl".into(),
//! id: "adjust/half".to_owned(),
//! text: "\
//! //! Half
//! //! Scales a mask.
//!
//! struct Params {
//! /// Factor.
//! /// @range 0 1 @default 0.5
//! factor: f32,
//! }
//!
//! /// The mask, scaled.
//! /// @input source Mask to scale.
//! fn mask(at: Surface, source: f32, params: Params) -> f32 {
//! return source * params.factor;
//! }
//! "
//! .to_owned(),
//! };
//! let kind = read_kind(&file, library.libraries()).map_err(|faults| faults[0].to_string())?;
//! assert_eq!(kind.label, "Half");
//! assert_eq!(kind.inputs[0].name, "source");
//! # Ok::<(), String>(())
//! ```

mod analysis;
mod annotations;
pub mod arithmetic;
mod color;
mod compile;
mod curve;
mod explain;
mod fault;
pub mod formula;
mod header;
pub mod kind;
mod library;
mod limits;
pub mod link;
mod names;
mod params;
mod ports;
mod reader;
mod rules;
mod scan;
mod shader_files;
#[cfg(not(shaders_included))]
mod shader_list;
mod source_file;
mod words;

pub use color::{color_code, color_linear, typed_color};
pub use curve::curve_points;
pub use fault::Fault;
pub use library::{Library, files_of_folder};
pub use names::label_of;
pub use reader::read_kind;
pub use shader_files::Libraries;
pub use source_file::SourceFile;
