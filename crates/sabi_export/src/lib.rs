//! Writing of texture sets and of the files that belong to them.
//!
//! [`set_keys`] lists the texture sets of a model, [`SetLayout`] maps texels to the pixels of a set, and [`PaddingMap`]
//! fills the space outside of the charts. [`BakeWriter`] receives one channel after the other, puts the complete files in
//! place at the end, and returns records of what was written for the report.
//!
//! Invariants:
//! * A set of files is written completely or not at all.
//! * A pixel inside a chart is a copy of its texel, except beside seams: `docs/design/export-seams.md`.
//! * A document of materials names files of the same bake alone, by their plain names.
//! * A copy of a model keeps every byte of its file that the new maps do not replace.
//! * Nothing here knows the graph, the device or where the numbers came from.
//!
//! ```
//! use sabi_export::{NameParts, NamePattern};
//!
//! let names = NamePattern::parse("T_$material_$map(.$udim)", &[])?;
//! let parts = NameParts { material: "wood", map: "base_color", udim: None, size: [1024; 2] };
//! assert_eq!(names.name(&parts), "T_wood_base_color");
//! # Ok::<(), sabi_export::ExportError>(())
//! ```

mod bands;
mod borders;
mod channel;
mod constant;
mod document;
mod encode;
mod encoded_files;
mod engine_format;
mod engine_memory;
mod error;
mod held_channels;
mod layout;
mod mesh_map;
mod model_copy;
mod name_pattern;
mod names;
mod padding;
pub mod preset;
mod record;
mod resize;
mod seams;
mod shared_texels;
mod shown_texels;
mod write;

pub use bands::BandGather;
pub use borders::{BorderGhost, BorderRule, ChartBorders, STEEPER};
pub use channel::{Channel, ChannelPixels, OutputKind};
pub use constant::ConstantValue;
pub use encoded_files::EncodedFiles;
pub use engine_format::EngineFormat;
pub use engine_memory::{EngineMemory, SetMemory};
pub use error::ExportError;
pub use layout::{Cover, NONE, SetKey, SetLayout, layouts, set_keys};
pub use mesh_map::MeshMap;
pub use model_copy::{
    CopiedFile, CopyOptions, CopySource, FinishMaps, FinishedCopy, LookChange, MapFile, MappedFactor, MaterialMaps,
    ModelCopy, Treatment, baked_materials, unwrapped_materials,
};
pub use name_pattern::{NameParts, NamePattern, folder_name};
pub use names::{file_stem, set_names, sheet_names};
pub use padding::{Padding, PaddingMap};
pub use record::{ConstantRecord, CutMap, DocumentRecord, DocumentedMaterial, OutputRecord, UnmappedChannels};
pub use seams::SeamSamples;
pub use shared_texels::SharedTexels;
pub use shown_texels::ShownTexels;
pub use write::{BakeWriter, CommittedBake, NamedPreset, SetOptions, SetWriter, WrittenChannel, WrittenDocuments};
