//! Folders of libraries. Links to files of a library start with its name.

use std::path::PathBuf;

/// Folder of a library, and the name with which links to it start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LibraryFolder {
    /// Name of the library in links, such as `sabi`.
    pub name: String,
    /// The folder.
    pub folder: PathBuf,
}
