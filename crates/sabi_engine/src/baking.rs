//! Baking: results written as texture sets.

pub(crate) mod bake;
pub(crate) mod bake_request;
pub(crate) mod documents;
pub(crate) mod encoded_cache;
#[cfg(test)]
mod fault_tests;
pub(crate) mod folder;
mod losses;
pub(crate) mod made_of;
mod map_encoder;
pub(crate) mod maps;
mod memory_budget;
mod mesh_maps;
pub(crate) mod model_copy;
pub(crate) mod preset_description;
pub(crate) mod preset_pictures;
pub(crate) mod presets;
pub(crate) mod recorded;
pub(crate) mod report;
pub(crate) mod seams;
mod set_works;
pub(crate) mod sheet_results;
