//! Strokes of the paint nodes of a session. They are stored as soon as they are painted, beside the graph, or beside the
//! recovery file if the graph has no file yet.

use std::path::{Path, PathBuf};

use sabi_files::Disk;
use sabi_graph::{Document, Value};
use sabi_paint::PictureName;

use super::Session;
use crate::error::{EngineError, ErrorKind};
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

impl Session {
    /// Returns the file beside which strokes are stored: that of the graph, or its recovery file; `None` if the graph has neither.
    pub fn stroke_place(&self) -> Option<PathBuf> {
        let recovery = self.recovery.as_ref().map(|recovery| recovery.path().to_owned());
        self.file.clone().or(recovery)
    }

    /// Takes the strokes beside another graph file, of which nodes were copied, and stores those that this graph names now.
    ///
    /// # Errors
    /// A sentence about why they are in memory alone.
    pub fn take_strokes_beside(&self, other: &Path) -> Result<(), EngineError> {
        if self.stroke_place().as_deref() != Some(other) {
            self.open.strokes.read_beside(other);
        }
        self.keep_strokes()
    }

    /// Stores the strokes of all paint nodes. To be called after each stroke: a stroke that is stored survives the end of the
    /// program.
    ///
    /// # Errors
    /// A sentence about why they are in memory alone.
    pub fn keep_strokes(&self) -> Result<(), EngineError> {
        match self.stroke_place() {
            Some(place) => self.store_strokes(&place),
            None => {
                self.open.strokes.settle();
                Ok(())
            }
        }
    }

    /// Stores the strokes of all paint nodes as [`Session::keep_strokes`] does; where that fails, beside the recovery file.
    ///
    /// # Errors
    /// A sentence about why they are in memory alone.
    pub(super) fn keep_all_strokes(&mut self) -> Result<(), EngineError> {
        match self.keep_strokes() {
            Ok(()) => {
                self.has_unsaved_strokes = false;
                Ok(())
            }
            Err(error) => {
                self.has_unsaved_strokes = true;
                if self.store_strokes_in_recovery() {
                    Ok(())
                } else {
                    Err(error)
                }
            }
        }
    }

    /// Stores the strokes of all paint nodes beside the recovery file. Returns true if they are stored there.
    pub(super) fn store_strokes_in_recovery(&self) -> bool {
        let place = self.recovery.as_ref().map(|recovery| recovery.path().to_owned());
        place.is_some_and(|place| self.store_strokes(&place).is_ok())
    }

    /// Stores the strokes of all paint nodes beside the file to which the graph is saved.
    pub(super) fn save_strokes(&self, graph: &std::path::Path) -> Result<(), EngineError> {
        if graph != self.open.path {
            // Strokes of other models, and of nodes that were not evaluated, are not in memory yet.
            self.open.strokes.read_beside(&self.open.path);
        }
        self.store_strokes(graph)
    }

    /// Stores the known strokes of all paint nodes beside a graph file.
    fn store_strokes(&self, graph: &std::path::Path) -> Result<(), EngineError> {
        let stored = self.open.strokes.store(graph, &versions_of(&self.open.document));
        stored.map_err(|why| EngineError::new(ErrorKind::CannotWrite, why))
    }

    /// Reads the strokes beside the recovery file.
    pub(super) fn read_recovered_strokes(&self) {
        if let Some(recovery) = &self.recovery {
            self.open.strokes.read_beside(recovery.path());
        }
    }
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
