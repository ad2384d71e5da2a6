//! Opening: loading of a graph, its node kinds, a model and environments.

pub(crate) mod cache_dir;
mod coverage;
pub(crate) mod document;
pub mod environment;
pub(crate) mod graph_faults;
pub(crate) mod kinds;
pub(crate) mod levels;
pub mod linked_model;
pub(crate) mod memory;
pub mod mesh_report;
mod model_warnings;
pub mod overlap;
pub(crate) mod override_faults;
pub(crate) mod own_folder;
pub(crate) mod set_file;
pub(crate) mod setting;
pub(crate) mod solidity;
pub mod stroke_report;
mod tiles;
pub mod toml_file;
pub mod unread;

pub use cache_dir::default_cache_dir;
pub use memory::default_memory_bytes;
pub use set_file::{SetFile, add_values};
pub use setting::read_setting;
