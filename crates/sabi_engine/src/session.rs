//! Session of an open graph: its edits and their history, its file, and its recovery file in case the program ends abnormally.

mod edits;
mod file_lock;
mod free_file;
mod graph_file;
mod graph_write;
mod known_contents;
pub(crate) mod path_rewrite;
mod recovery;
mod stroke_files;
#[cfg(test)]
mod tests;
pub mod watch;

use std::path::{Path, PathBuf};

use sabi_files::{Disk, TrustedPaths, read_plain};
use sabi_graph::{Document, Edit, EditError};

use edits::Edits;
pub use file_lock::is_open_in_a_window;
pub use free_file::free_graph_file;
pub use graph_file::{FileState, GraphFile};
use known_contents::KnownContents;
use path_rewrite::PathRewrite;
pub use path_rewrite::{document_with_paths, relocate_paths, with_absolute_paths};
use recovery::UnsavedWork;
pub use recovery::{Keeping, Recovery, recoveries, recoveries_in_use};

use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::{OpenGraph, SIZE_LIMIT_BYTES};

/// File name of a graph that has no file yet.
const UNTITLED: &str = "untitled.sabi";

/// Number of backups of a graph file that are kept, unless a session sets another number.
pub const BACKUPS: usize = 3;

/// An open graph that is edited.
///
/// Work that needs one part alone is a method of that part. The session does what concerns several: an edit changes the document, its
/// history and what is unsaved; a save writes the document and its strokes, and then the recovery file is no longer needed.
#[derive(Debug)]
pub struct Session {
    open: OpenGraph,
    edits: Edits,
    /// File of the graph.
    pub graph_file: GraphFile,
    recovery: Option<Recovery>,
    disk: Disk,
    /// Canonical text of the document, as of its last use.
    text: CanonicalText,
    /// True if strokes could not be stored beside the file, so that only the recovery copy has them.
    has_unsaved_strokes: bool,
}

/// Canonical text of a document.
#[derive(Debug)]
struct CanonicalText {
    text: String,
    /// Revision of the document to which it belongs.
    revision: u64,
}

/// A document in which paths are rewritten for another folder.
type Moved = Option<(PathRewrite, Document)>;

impl Session {
    /// Creates a session of an empty graph without a file. Unsaved work is stored in `recovery_folder`, if there is one.
    pub fn new(recovery_folder: Option<&Path>) -> Session {
        Session::of(OpenGraph::empty(UNTITLED), None, recovery_folder)
    }

    /// Creates a session of a graph without a file that begins with this document. The document does not count as unsaved.
    pub fn beginning_with(document: Document, recovery_folder: Option<&Path>) -> Session {
        let session = Session::of(OpenGraph::of_document(UNTITLED, document), None, recovery_folder);
        let saved = session.text.text.clone();
        Session {
            graph_file: GraphFile::new(None, saved, KnownContents::default()),
            ..session
        }
    }

    /// Opens a graph file.
    pub fn open(path: &Path, recovery_folder: Option<&Path>) -> Result<Session, EngineError> {
        let open = OpenGraph::open(path)?;
        Ok(Session::of(open, Some(path.to_owned()), recovery_folder))
    }

    /// Restores a graph from a recovery file; all of its content counts as unsaved. If only node files were stored, the
    /// graph is read from its own file.
    ///
    /// # Errors
    /// The recovery file cannot be read, or is in use by another window.
    pub fn recover(mut recovery: Recovery) -> Result<Session, EngineError> {
        if !recovery.acquire() {
            let why = "this graph is already open in another window; close it there first";
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
        let (UnsavedWork { graph, .. }, file) = recovery.read()?;
        let Some(text) = graph else {
            // Only node files were unsaved, so the graph has the present content of its file.
            let session = match &file {
                Some(file) => Session::open(file, None)?,
                None => Session::new(None),
            };
            return Ok(Session {
                recovery: Some(recovery),
                ..session
            });
        };
        let name = file.clone().unwrap_or_else(|| PathBuf::from(UNTITLED));
        let document = Document::from_json(&text)
            .map_err(|error| EngineError::of(ErrorKind::BadInput, error.with_name(name.display().to_string())))?;
        let file_bytes = file.as_ref().and_then(|file| read_plain(file, SIZE_LIMIT_BYTES).ok());
        let saved = match &file {
            // If the file is missing or damaged, everything is unsaved.
            Some(_) => String::from_utf8(file_bytes.clone().unwrap_or_default()).unwrap_or_default(),
            None => Document::new("").to_json(),
        };
        let known = recovery.known_contents(file_bytes.as_deref());
        let edits = Edits::new();
        let session = Session {
            text: CanonicalText {
                text: document.to_json(),
                revision: edits.revision(),
            },
            open: OpenGraph::of_document(name, document),
            edits,
            graph_file: GraphFile::new(file, saved, known),
            disk: Disk::default(),
            has_unsaved_strokes: recovery.has_strokes(),
            recovery: Some(recovery),
        };
        if let Some(recovery) = &session.recovery {
            session.open.strokes.read_beside(recovery.path());
        }
        Ok(session)
    }

    fn of(open: OpenGraph, file: Option<PathBuf>, recovery_folder: Option<&Path>) -> Session {
        let text = open.document.to_json();
        let edits = Edits::new();
        let (saved, known) = match &file {
            // Opening a file that is not canonical causes no unsaved changes.
            Some(_) => (
                text.clone(),
                KnownContents::of(&[text.as_bytes(), open.text.as_bytes()]),
            ),
            None => (Document::new("").to_json(), KnownContents::default()),
        };
        Session {
            recovery: recovery_folder.map(|folder| Recovery::new(folder, file.as_deref())),
            graph_file: GraphFile::new(file, saved, known),
            text: CanonicalText {
                text,
                revision: edits.revision(),
            },
            edits,
            disk: Disk::default(),
            has_unsaved_strokes: false,
            open,
        }
    }

    /// Makes the session write to this disk instead of the real one.
    pub fn on_disk(mut self, disk: &Disk) -> Session {
        self.disk = disk.clone();
        self.open.strokes.turn_to_disk(disk);
        if let Some(recovery) = &mut self.recovery {
            recovery.turn_to_disk(disk);
        }
        self
    }

    /// Disk that it writes to.
    pub fn disk(&self) -> &Disk {
        &self.disk
    }

    /// Returns the current graph, with access to its files.
    pub fn graph(&self) -> &OpenGraph {
        &self.open
    }

    /// Current document.
    pub fn document(&self) -> &Document {
        &self.open.document
    }

    /// Returns the file of the graph; `None` before the first save.
    pub fn file(&self) -> Option<&Path> {
        self.graph_file.path()
    }

    /// Allows the graph to open the files that it names below these paths, too.
    pub fn trust(&mut self, trusted: &TrustedPaths) {
        let before = self.open.trusted.clone();
        self.open.trusted = before.clone().with(trusted);
        if self.open.trusted != before {
            self.open.strokes.trust(trusted);
            self.edits.changed_otherwise();
        }
    }

    /// Returns the revision of the document, which rises with every change. Two sessions of a process never have the same revision.
    pub fn revision(&self) -> u64 {
        self.edits.revision()
    }

    /// Returns the names of the steps that can be undone, the next one last.
    pub fn undo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.edits.history().undo_names()
    }

    /// Returns the names of the steps that can be redone, the next one last.
    pub fn redo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.edits.history().redo_names()
    }

    /// Applies an edit, as a step with a name or as a part of the open step. An edit without effect adds no step.
    pub fn edit(&mut self, name: &str, edit: Edit) -> Result<(), EditError> {
        self.edits.apply(&mut self.open.document, name, edit)
    }

    /// Applies an edit that is not a step: it cannot be undone, and steps that can be redone are kept.
    ///
    /// # Errors
    /// The edit is refused; nothing changes.
    pub fn edit_aside(&mut self, edit: Edit) -> Result<(), EditError> {
        self.edits.apply_aside(&mut self.open.document, edit)
    }

    /// Returns the edits since a revision, oldest first; `None` if the document has changed in other ways, or if the revision is too old.
    pub fn edits_since(&self, revision: u64) -> Option<&[Edit]> {
        self.edits.since(revision)
    }

    /// Begins a step of several edits, for example a drag. If the name is empty, the name of the first edit is used.
    pub fn begin(&mut self, name: &str) {
        self.edits.begin(name);
    }

    /// Ends the step that was begun.
    pub fn end(&mut self) {
        self.edits.end();
    }

    /// Undoes all edits since [`Session::begin`] and removes them from the history.
    ///
    /// # Errors
    /// The document was changed without its history, which is a defect.
    pub fn cancel(&mut self) -> Result<(), EditError> {
        self.edits.cancel(&mut self.open.document)
    }

    /// Undoes the last step and returns its name; `None` if there is nothing to undo.
    pub fn undo(&mut self) -> Result<Option<String>, EditError> {
        self.edits.undo(&mut self.open.document)
    }

    /// Redoes the last undone step and returns its name; `None` if there is nothing to redo.
    pub fn redo(&mut self) -> Result<Option<String>, EditError> {
        self.edits.redo(&mut self.open.document)
    }

    /// Canonical text of the document.
    pub fn text(&mut self) -> &str {
        if self.text.revision != self.edits.revision() {
            self.text = CanonicalText {
                text: self.open.document.to_json(),
                revision: self.edits.revision(),
            };
        }
        &self.text.text
    }

    /// Returns true if there are changes that are not in its file. While a step is open, any change of it counts. The texts
    /// are compared only when the step ends, not for every move of a slider.
    pub fn is_dirty(&mut self) -> bool {
        if self.edits.history().is_open() && self.text.revision != self.edits.revision() {
            return true;
        }
        self.has_unsaved_text()
    }

    fn has_unsaved_text(&mut self) -> bool {
        self.text();
        self.has_unsaved_strokes || !self.graph_file.has_text(&self.text.text)
    }

    /// Replaces the document by the content of its file, as a step that can be undone.
    ///
    /// # Errors
    /// The file cannot be read; nothing changes.
    pub fn reload(&mut self) -> Result<(), EngineError> {
        let Some(file) = self.graph_file.path() else {
            return Ok(());
        };
        let read = OpenGraph::open(file)?;
        self.end();
        let saved = read.document.to_json();
        let edit = Edit::Replace {
            document: Box::new(read.document),
        };
        let taken = self.edit("Reload the file", edit);
        taken.map_err(|error| EngineError::of(ErrorKind::BadInput, error))?;
        self.graph_file.reloaded(read.text.as_bytes(), saved);
        self.open.text = read.text;
        Ok(())
    }

    /// Saves to its own file.
    ///
    /// # Errors
    /// The file is written by another program since it was read or saved ([`Remedy::ReplaceFile`]), it was opened for reading
    /// alone, or the disk refuses; it is unchanged then.
    pub fn save(&mut self) -> Result<(), EngineError> {
        let path = self.graph_file.writable_path()?;
        self.write(&path, true)
    }

    /// Saves to the session's file. If another program has changed the file, its content is first copied to a file
    /// beside it. Returns the path of the copy; `None` if the file is gone or holds what this session wrote.
    ///
    /// # Errors
    /// The file cannot be read, or the disk refuses; it is unchanged then.
    pub fn save_beside_theirs(&mut self) -> Result<Option<PathBuf>, EngineError> {
        let copy = self.graph_file.copy_theirs(&self.disk)?;
        self.save().map(|()| copy)
    }

    /// Saves to a file, which becomes the file of the session, whatever it holds. A replaced file is kept as a backup whose name
    /// ends in `.bak`, and earlier backups as `.bak2` and so on. At every moment the file holds its complete old or new text.
    /// Strokes are stored beside it before.
    ///
    /// In another folder, relative paths are rewritten to lead to the same files, in the document and in its history, without a
    /// step of its own. In the first file of a graph, absolute paths to files nearby become relative, so that a project can be
    /// moved.
    ///
    /// # Errors
    /// The disk refuses, or strokes could not be stored, in which case the recovery file keeps them.
    pub fn save_as(&mut self, path: &Path) -> Result<(), EngineError> {
        self.write(path, false)
    }

    /// Saves to a file, which becomes the file of the session. With `asks`, only a known content of the file is replaced.
    fn write(&mut self, path: &Path, asks: bool) -> Result<(), EngineError> {
        self.end();
        let moved = self.moved_to(path);
        let text = match &moved {
            Some((_, document)) => document.to_json(),
            None => self.text().to_owned(),
        };
        // The graph is saved even if its strokes cannot be. They stay in memory and are tried again.
        let strokes = stroke_files::store_on_save(&self.open, path);
        self.graph_file.write(&self.disk, path, &text, asks)?;
        self.take_written(path, text, moved);
        self.has_unsaved_strokes = strokes.is_err();
        if let Some(recovery) = &mut self.recovery {
            if strokes.is_ok() {
                // The session's file has everything.
                recovery.forget();
                recovery.set_file(Some(path));
            } else {
                recovery.set_file(Some(path));
                // The error about the strokes is the one that is reported. The next autosave tries again.
                let _ = recovery.keep(Some(self.graph_file.saved()), &[], self.graph_file.content_hash());
                let _ = stroke_files::store(&self.open, recovery.path());
            }
        }
        strokes
    }

    /// Returns the document with paths for the folder of another file, if that changes them.
    fn moved_to(&self, path: &Path) -> Moved {
        let rewrite = PathRewrite::between(
            self.open.folder(),
            path.parent().unwrap_or(Path::new("")),
            self.file().is_none(),
        );
        rewrite.map(|rewrite| {
            let document = rewrite.relocate(|relocation| self.open.document.relocated(relocation));
            (rewrite, document)
        })
    }

    /// Makes a written file the session's file. This is done after writing, so that a failed save changes nothing.
    fn take_written(&mut self, path: &Path, text: String, moved: Moved) {
        if let Some((rewrite, document)) = moved {
            rewrite.relocate(|relocation| self.edits.relocate(&self.open.document, relocation));
            if document != self.open.document {
                self.edits.changed_otherwise();
            }
            self.open.document = document;
            self.text = CanonicalText {
                text: text.clone(),
                revision: self.edits.revision(),
            };
        }
        self.open.path = path.to_owned();
        self.open.trusted = std::mem::take(&mut self.open.trusted).with_file(path);
        self.open.strokes.trust(&self.open.trusted);
        self.open.text = text.as_str().into();
        self.graph_file.take(path, text);
    }

    /// Stores unsaved work in the recovery file, if it has changed since the last call: the graph, and drafts of node files.
    /// Returns whether it wrote.
    ///
    /// # Errors
    /// The disk refuses; an earlier recovery file is as it was.
    pub fn keep(&mut self, drafts: &[NodeDraft]) -> Result<bool, EngineError> {
        let Some(graph) = self.work_to_keep(drafts) else {
            return Ok(false);
        };
        let Some(recovery) = &mut self.recovery else {
            return Ok(false);
        };
        let kept = recovery.keep(graph.as_deref(), drafts, self.graph_file.content_hash())?;
        // After a redo, strokes may not be in any file.
        if graph.is_some() {
            self.keep_all_strokes()?;
        }
        Ok(kept)
    }

    /// As [`Session::keep`], on a thread of its own, so that a window does not wait for the disk. To be called every
    /// few seconds, and at the end until it is done.
    ///
    /// # Errors
    /// This copy or the one before could not be written; an earlier recovery file is unchanged.
    pub fn keep_meanwhile(&mut self, drafts: &[NodeDraft]) -> Result<Keeping, EngineError> {
        let Some(graph) = self.work_to_keep(drafts) else {
            return Ok(Keeping::Done);
        };
        let Some(recovery) = &mut self.recovery else {
            return Ok(Keeping::Done);
        };
        let has_graph = graph.is_some();
        let keeping = recovery.keep_meanwhile(graph, drafts, self.graph_file.content_hash())?;
        if has_graph {
            self.keep_all_strokes()?;
        }
        Ok(keeping)
    }

    /// Returns the text of the graph if it is not saved; `None` if nothing is unsaved, in which case the recovery file is removed.
    fn work_to_keep(&mut self, drafts: &[NodeDraft]) -> Option<Option<String>> {
        let is_dirty = self.has_unsaved_text();
        if !is_dirty && drafts.is_empty() {
            if let Some(recovery) = &mut self.recovery {
                recovery.forget();
            }
            return None;
        }
        Some(is_dirty.then(|| self.text.text.clone()))
    }

    /// Returns the file beside which strokes are stored: that of the graph, or its recovery file; `None` if the graph has neither.
    pub fn stroke_place(&self) -> Option<PathBuf> {
        let recovery = self.recovery.as_ref().map(Recovery::path);
        self.file().or(recovery).map(Path::to_owned)
    }

    /// Reads the strokes beside another graph file from which nodes were copied, and stores the strokes that this graph
    /// names now.
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
            Some(place) => stroke_files::store(&self.open, &place),
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
    fn keep_all_strokes(&mut self) -> Result<(), EngineError> {
        let kept = self.keep_strokes();
        self.has_unsaved_strokes = kept.is_err();
        kept.or_else(|error| match &self.recovery {
            Some(recovery) if stroke_files::store(&self.open, recovery.path()).is_ok() => Ok(()),
            _ => Err(error),
        })
    }

    /// Ends the session normally and removes its recovery file.
    pub fn close(mut self) {
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
        }
    }
}
