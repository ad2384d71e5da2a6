//! Folders of libraries, which links to their files begin with.

use std::path::PathBuf;

/// Folder of a library, with the name that links begin with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LibraryFolder {
    /// Name of the library in links, such as `sabi`.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
}
