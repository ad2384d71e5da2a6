//! Strokes of the paint nodes of a session. They are stored as soon as they are painted, beside the graph, or beside the
//! recovery file if the graph has no file yet.

use std::path::{Path, PathBuf};

use sabi_files::Disk;
use sabi_graph::{Document, Value};
use sabi_paint::PictureName;

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::source::paint::NAME;
use crate::source::strokes::{paint_folder, picture_folder};

/// Versions of strokes that the nodes of a document name.
fn versions_of(document: &Document) -> String {
    let groups = document.groups.values().map(|group| &group.graph);
    let nodes = std::iter::once(&document.graph)
        .chain(groups)
        .flat_map(|graph| graph.nodes());
    let named = nodes
        .filter(|(_, node)| node.kind == NAME)
        .filter_map(|(_, node)| match node.params.get("strokes") {
            Some(Value::Text(versions)) => Some(versions.as_str()),
            _ => None,
        });
    named.collect::<Vec<&str>>().join(" ")
}

/// Stores the known strokes of all paint nodes of a graph beside a graph file or a recovery file.
///
/// # Errors
/// A sentence about why they are in memory alone.
pub(super) fn store(open: &OpenGraph, place: &Path) -> Result<(), EngineError> {
    let stored = open.strokes.store(place, &versions_of(&open.document));
    stored.map_err(|why| EngineError::new(ErrorKind::CannotWrite, why))
}

/// Stores the strokes of all paint nodes of a graph beside the file to which it is saved.
///
/// # Errors
/// As for [`store`].
pub(super) fn store_on_save(open: &OpenGraph, graph: &Path) -> Result<(), EngineError> {
    if graph != open.path {
        // Strokes of other models, and of nodes that were not evaluated, are not in memory yet.
        open.strokes.read_beside(&open.path);
    }
    store(open, graph)
}

/// Removes the strokes beside a recovery file.
pub(super) fn forget_strokes(disk: &Disk, recovery: &std::path::Path) {
    let folder: PathBuf = paint_folder(recovery);
    let is_stroke_file = |file: &Path| file.extension().is_some_and(|ending| ending == "strokes");
    let is_picture = |file: &Path| {
        let name = file.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| PictureName::try_from(name.to_owned()).is_ok())
    };
    remove_files(disk, &picture_folder(&folder), is_picture);
    remove_files(disk, &folder, is_stroke_file);
}

/// Removes files of a folder, and the folder if it is empty then.
fn remove_files(disk: &Disk, folder: &Path, is_meant: impl Fn(&Path) -> bool) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for file in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        if is_meant(&file) {
            // Files that cannot be removed stay; nothing refers to them.
            let _ = disk.remove(&file);
        }
    }
    if !disk.has_ended() {
        let _ = std::fs::remove_dir(folder);
    }
}
