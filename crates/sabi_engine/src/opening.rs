//! Opening: loading of a graph, its node kinds, a model and environments.

pub(crate) mod cache_dir;
mod coverage;
pub(crate) mod document;
pub(crate) mod environment;
pub(crate) mod graph_faults;
pub(crate) mod kinds;
pub(crate) mod levels;
pub(crate) mod linked_model;
pub(crate) mod memory;
pub(crate) mod mesh_report;
mod model_warnings;
pub(crate) mod overlap;
pub(crate) mod override_faults;
pub(crate) mod own_folder;
pub(crate) mod set_file;
pub(crate) mod setting;
pub(crate) mod solidity;
pub(crate) mod stroke_report;
mod tiles;
pub(crate) mod toml_file;
pub(crate) mod unread;
