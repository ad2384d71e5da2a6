//! Names for new graph files.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use sabi_files::free_file;

/// Returns the first of `stem.sabi`, `stem-2.sabi`, … that does not exist or already has these bytes; `None` if 1000 of them exist.
pub fn free_graph_file(folder: &Path, stem: &str, bytes: &[u8]) -> Option<PathBuf> {
    free_file(folder, OsStr::new(stem), "sabi", bytes)
}
