//! Names for new graph files.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use sabi_files::free_file;

/// Returns the first of `stem.sabi`, `stem-2.sabi`, … that does not exist or already holds these bytes; `None` when 1000 of
/// them are in use.
pub fn free_graph_file(folder: &Path, stem: &str, bytes: &[u8]) -> Option<PathBuf> {
    free_file(folder, OsStr::new(stem), "sabi", bytes)
}
