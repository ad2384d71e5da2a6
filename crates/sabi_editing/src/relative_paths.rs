//! Paths as written in the document: relative to its folder.

use std::path::{Path, PathBuf};

use sabi_engine::session::{relocate_paths, with_absolute_paths};
use sabi_files::{NotText, PathBase, canonical, path_text};
use sabi_graph::Document;

use crate::open_document::OpenDocument;
use crate::trust::trust_chosen;

/// Writes a path relative to the document's folder if possible. While the document has no file, the path is absolute.
///
/// # Errors
/// The path cannot be named in a file.
pub fn relative(document: &OpenDocument, path: &Path) -> Result<String, NotText> {
    match document.session.file() {
        Some(_) => PathBase::of_folder(absolute(document.session.graph().folder())).write(&absolute(path)),
        None => path_text(&absolute(path)),
    }
}

/// Writes the path of a file that the user chose, as [`relative`] does; from now on the document may open it.
///
/// # Errors
/// The path cannot be named in a file.
pub fn chosen(document: &mut OpenDocument, path: &Path) -> Result<String, NotText> {
    trust_chosen(document, path);
    relative(document, path)
}

/// Returns the canonical path of an existing file, or the path itself if the file does not exist.
fn absolute(path: &Path) -> PathBuf {
    canonical(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns a document from another folder with its paths converted to the folder of the open document, or to absolute paths
/// if the open document has no file.
pub(crate) fn relocated(document: &OpenDocument, other: &Document, from: &Path) -> Document {
    let here = document.session.graph().folder();
    let is_same = canonical(from).ok() == canonical(here).ok();
    match document.session.file() {
        Some(_) => relocate_paths(other, from, here),
        None if is_same => other.clone(),
        None => with_absolute_paths(other, from),
    }
}
