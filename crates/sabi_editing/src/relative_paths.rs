//! Paths as the document names them: from its own folder on.

use std::path::{Path, PathBuf};

use sabi_engine::canonical;

use super::OpenDocument;

impl OpenDocument {
    /// Writes a path as the document names it: from its own folder on where that is possible.
    pub fn relative(&self, path: &Path) -> String {
        match self.session.file() {
            Some(_) => self.seen_from_own_folder(path),
            None => absolute(path).display().to_string(),
        }
    }

    /// Writes a path from the document's folder on. A document without a file has the working directory as its folder.
    pub fn seen_from_own_folder(&self, path: &Path) -> String {
        let folder = absolute(self.session.graph().folder());
        let path = absolute(path);
        let common = folder
            .components()
            .zip(path.components())
            .take_while(|(one, other)| one == other)
            .count();
        // With nothing but the root in common, the absolute path is clearer.
        if common <= 1 {
            return path.display().to_string();
        }
        let up = folder.components().skip(common).map(|_| "..".to_owned());
        let down = path
            .components()
            .skip(common)
            .map(|part| part.as_os_str().to_string_lossy().into_owned());
        up.chain(down).collect::<Vec<String>>().join("/")
    }
}

/// The canonical path of a file that exists, and the path itself of one that does not.
fn absolute(path: &Path) -> PathBuf {
    canonical(path).unwrap_or_else(|_| path.to_owned())
}
