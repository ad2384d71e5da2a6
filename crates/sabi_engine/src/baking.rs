//! Baking: results written as texture sets.

pub(crate) mod bake;
pub(crate) mod bake_request;
pub(crate) mod documents;
pub(crate) mod encoded_cache;
#[cfg(test)]
mod fault_tests;
pub(crate) mod folder;
mod losses;
pub mod made_of;
mod map_encoder;
pub(crate) mod maps;
mod memory_budget;
mod mesh_maps;
pub(crate) mod model_copy;
pub mod preset_description;
pub mod preset_pictures;
pub mod presets;
pub mod recorded;
pub mod report;
pub(crate) mod seams;
mod set_works;
pub(crate) mod sheet_results;

pub use bake::{bake, bake_graph, check_bake, needs_force};
pub use bake_request::{
    BakeRequest, DEFAULT_PRESET, default_padding, export_channels, mesh_map_names, name_pattern_fault,
};
pub use report::BakeReport;
pub use seams::Seams;
