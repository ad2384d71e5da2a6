//! Files that the document names and that are not there: they are found again in another place, together with those beside
//! them.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sabi_engine::{Unread, document_with_paths};
use sabi_graph::Edit;

use crate::open_document::OpenDocument;
use crate::relative_paths;

/// Lists the paths of the model, the pictures and the group files that the document names and that lead to no file, as they are
/// written.
pub fn missing(document: &OpenDocument) -> Vec<String> {
    let graph = document.session.graph();
    // What may not be opened is not looked for, such as paths of other computers.
    let is_missing = |path: &String| matches!(graph.trusted.check(&graph.base(), path), Err(Unread::Missing));
    written_paths(document).into_iter().filter(is_missing).collect()
}

/// Lists the files that the document names and may open: its model, pictures and group files.
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

/// Lets the document name `found` in place of a missing file, and in one step with it those files beside `found` that are missing,
/// too: by their places in the folder that the missing file was in, or by their names. Returns the number of files that were found.
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

/// Name of a file in a path as it is written, whichever system it was written on.
pub fn name_of(written: &str) -> &str {
    split(written).1
}

/// File for another path that is missing, where `lost` was found in the folder of `found`.
fn beside(lost: &str, other: &str, found: &Path) -> Option<PathBuf> {
    let folder = found.parent()?;
    let (lost_in, _) = split(lost);
    // Only what lies below the folder: the user has chosen no other.
    let below = other.strip_prefix(lost_in).filter(|below| !leads_up(below));
    let places = below.into_iter().chain([name_of(other)]);
    let mut places = places.map(|place| folder.join(place.replace('\\', "/")));
    places.find(|place| place.is_file())
}

fn leads_up(path: &str) -> bool {
    path.split(['/', '\\']).any(|part| part == "..") || path.starts_with(['/', '\\'])
}

/// Folder of a path with its last separator, and the name of the file.
fn split(written: &str) -> (&str, &str) {
    let at = written.rfind(['/', '\\']).map_or(0, |at| at + 1);
    written.split_at(at)
}
