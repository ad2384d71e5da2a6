//! WGSL text becomes node kinds: header, reflection, rules, linking.
//!
//! A node is one WGSL file (`shaders/nodes/<category>/<name>.wgsl`). [`read_kind`] reads one, [`Library`] holds many and
//! keeps the last good version of each.

mod analysis;
mod compile;
mod curve;
mod explain;
mod fault;
pub mod formula;
pub mod kind;
mod library;
pub mod link;
mod notes;
mod params;
mod ports;
mod reader;
mod rules;
mod scan;
mod words;

pub use compile::validate_wgsl;
pub use curve::curve_points;
pub use fault::Fault;
pub use library::{Libraries, Library, SourceFile};
pub use notes::color_linear;
pub use reader::read_kind;
