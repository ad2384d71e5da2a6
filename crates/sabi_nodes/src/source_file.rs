//! Node files before they are read.

use std::path::PathBuf;

/// Maximum size of a node or library file.
pub(crate) const FILE_LIMIT_BYTES: usize = 256 * 1024;

/// Node file before it is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Path of the file, for messages and to distinguish files.
    pub path: PathBuf,
    /// Identifier in graph files, `category/name`.
    pub id: String,
    /// The WGSL text.
    pub text: String,
}
