//! Paths as the document names them: relative to its own folder.

use std::path::{Path, PathBuf};

use sabi_engine::{NotText, PathBase, canonical, path_text};

use super::OpenDocument;

impl OpenDocument {
    /// Writes a path as the document names it: relative to its own folder where that is possible, absolute while the
    /// document has no file.
    ///
    /// # Errors
    /// The path cannot be named in a file.
    pub fn relative(&self, path: &Path) -> Result<String, NotText> {
        match self.session.file() {
            Some(_) => self.seen_from_own_folder(path),
            None => path_text(&absolute(path)),
        }
    }

    /// Writes a path relative to the document's folder. A document without a file has the working directory as its folder.
    ///
    /// # Errors
    /// The path cannot be named in a file.
    pub fn seen_from_own_folder(&self, path: &Path) -> Result<String, NotText> {
        let folder = absolute(self.session.graph().folder());
        PathBase::of_folder(folder).write(&absolute(path))
    }
}

/// Returns the canonical path of a file that exists, and the path itself of one that does not.
fn absolute(path: &Path) -> PathBuf {
    canonical(path).unwrap_or_else(|_| path.to_owned())
}
