//! Missing files that the document refers to. When one is found in another place, missing files beside it are looked for there, too.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sabi_engine::session::document_with_paths;
use sabi_files::Unread;
use sabi_graph::Edit;

use crate::open_document::OpenDocument;
use crate::relative_paths;

/// Lists the paths of the model, the images and the group files that the document refers to and that do not exist, as
/// written in the document.
pub fn missing(document: &OpenDocument) -> Vec<String> {
    let graph = document.session.graph();
    // Paths that may not be opened, such as those of other computers, are not checked.
    let is_missing = |path: &String| matches!(graph.trusted.check(&graph.base(), path), Err(Unread::Missing));
    written_paths(document).into_iter().filter(is_missing).collect()
}

/// Lists the files that the document refers to and may open: its model, images and group files.
pub fn named(document: &OpenDocument) -> Vec<PathBuf> {
    let graph = document.session.graph();
    let file = |path: String| graph.trusted.check(&graph.base(), &path).ok();
    written_paths(document).into_iter().filter_map(file).collect()
}

/// Paths in the document, each once.
fn written_paths(document: &OpenDocument) -> BTreeSet<String> {
    let written = RefCell::new(BTreeSet::new());
    document_with_paths(document.contents(), &|path| {
        written.borrow_mut().insert(path.to_owned());
        path.to_owned()
    });
    let mut written = written.into_inner();
    written.retain(|path| !path.trim().is_empty());
    written
}

/// Replaces the path of a missing file by `found`. In the same undo step, other missing files are replaced if they are found beside
/// `found`: by their places relative to the missing file's folder, or by their names. Returns the number of files that were found.
pub fn relocate(document: &mut OpenDocument, lost: &str, found: &Path) -> usize {
    let mut places: BTreeMap<String, PathBuf> = BTreeMap::new();
    for other in missing(document) {
        let place = if other == lost {
            Some(found.to_owned())
        } else {
            beside(lost, &other, found)
        };
        places.extend(place.map(|place| (other, place)));
    }
    let mut texts = BTreeMap::new();
    for (written, place) in places {
        match relative_paths::chosen(document, &place) {
            Ok(text) => drop(texts.insert(written, text)),
            Err(refused) => document.notify(refused.to_string()),
        }
    }
    if texts.is_empty() {
        return 0;
    }
    let moved = document_with_paths(document.contents(), &|path| {
        texts.get(path).map_or_else(|| path.to_owned(), Clone::clone)
    });
    let edit = Edit::Replace {
        document: Box::new(moved),
    };
    match document.edit("Find missing files", vec![edit]) {
        true => texts.len(),
        false => 0,
    }
}

/// Returns the file name in a path, whichever system the path was written on.
pub fn name_of(written: &str) -> &str {
    split(written).1
}

/// Returns where another missing file should be, given that `lost` was found as `found`.
fn beside(lost: &str, other: &str, found: &Path) -> Option<PathBuf> {
    let folder = found.parent()?;
    let (lost_in, _) = split(lost);
    // Only files below the folder of the missing file: the user has chosen no other folder.
    let below = other.strip_prefix(lost_in).filter(|below| !leads_up(below));
    let places = below.into_iter().chain([name_of(other)]);
    let mut places = places.map(|place| folder.join(place.replace('\\', "/")));
    places.find(|place| place.is_file())
}

fn leads_up(path: &str) -> bool {
    path.split(['/', '\\']).any(|part| part == "..") || path.starts_with(['/', '\\'])
}

/// Splits a path into its folder with the last separator, and the file name.
fn split(written: &str) -> (&str, &str) {
    let at = written.rfind(['/', '\\']).map_or(0, |at| at + 1);
    written.split_at(at)
}
