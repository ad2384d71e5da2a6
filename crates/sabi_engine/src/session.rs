//! Session of an open graph: its edits and their history, its file, and its recovery file for the case that the program ends
//! abnormally.

mod free_file;
mod graph_write;
pub(crate) mod path_rewrite;
mod recovery;
mod stroke_files;
#[cfg(test)]
mod tests;
mod trust;
pub(crate) mod watch;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use sabi_graph::{Document, Edit, EditError, History};

pub use free_file::free_graph_file;
use graph_write::write_with_backup;
use path_rewrite::PathRewrite;
pub use path_rewrite::{relocate_paths, with_absolute_paths};
use recovery::UnsavedWork;
pub use recovery::{Recovery, recoveries};

use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::remedy::Remedy;

/// File name of a graph that has no file yet.
const UNTITLED: &str = "untitled.sabi";

/// State of a session's file, compared with the text that the session last read from it or wrote to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileState {
    /// The same, or the session has no file.
    Same,
    /// A different text, which another program wrote.
    Another,
    /// The file does not exist any more, or cannot be read.
    Gone,
}

/// First revision of the next session of this process, so that no two sessions ever have the same revision.
static FIRST_REVISION: AtomicU64 = AtomicU64::new(0);
/// Number of revisions reserved for each session; no session has as many.
const REVISIONS: u64 = 1 << 32;
/// Largest number of edits that are kept for those who follow the document.
const RECENT_EDITS: usize = 256;

/// An open graph that is edited.
#[derive(Debug)]
pub struct Session {
    open: OpenGraph,
    history: History,
    /// File of the graph; `None` before the first save.
    file: Option<PathBuf>,
    /// Text of the file; for a graph without a file, that of an empty graph.
    saved: String,
    /// True if the file is gone, or holds another text that the next save replaces: then everything is unsaved.
    is_apart: bool,
    /// Canonical text of the document, with the revision that it was made from.
    text: (u64, String),
    /// Revision of the document; rises with every change.
    revision: u64,
    /// The last edits, each of which raised the revision by one.
    recent: Vec<Edit>,
    recovery: Option<Recovery>,
}

impl Session {
    /// Creates a session of an empty graph without a file. Unsaved work is stored in `recovery_folder`, if there is one.
    pub fn new(recovery_folder: Option<&Path>) -> Session {
        Session::of(OpenGraph::empty(UNTITLED), None, recovery_folder)
    }

    /// Opens a graph file.
    pub fn open(path: &Path, recovery_folder: Option<&Path>) -> Result<Session, EngineError> {
        let open = OpenGraph::open(path)?;
        Ok(Session::of(open, Some(path.to_owned()), recovery_folder))
    }

    /// Restores a graph from a recovery file; all of it counts as unsaved. If only node files were stored, the graph is read
    /// from its own file.
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
            // No edit of the graph was unsaved, so its file has its current content.
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
        let saved = match &file {
            Some(file) => fs::read_to_string(file).unwrap_or_default(), // A missing file leaves everything unsaved.
            None => Document::new("").to_json(),
        };
        let text = document.to_json();
        let revision = FIRST_REVISION.fetch_add(REVISIONS, Ordering::Relaxed);
        let session = Session {
            open: OpenGraph::of_document(name, document),
            history: History::new(),
            file,
            saved,
            is_apart: false,
            text: (revision, text),
            revision,
            recent: Vec::new(),
            recovery: Some(recovery),
        };
        session.read_recovered_strokes();
        Ok(session)
    }

    fn of(open: OpenGraph, file: Option<PathBuf>, recovery_folder: Option<&Path>) -> Session {
        let text = open.document.to_json();
        let revision = FIRST_REVISION.fetch_add(REVISIONS, Ordering::Relaxed);
        Session {
            history: History::new(),
            recovery: recovery_folder.map(|folder| Recovery::new(folder, file.as_deref())),
            saved: match &file {
                // Opening a file that is not canonical leaves no unsaved changes.
                Some(_) => text.clone(),
                None => Document::new("").to_json(),
            },
            is_apart: false,
            text: (revision, text),
            revision,
            recent: Vec::new(),
            file,
            open,
        }
    }

    /// Current graph, with access to its files.
    pub fn graph(&self) -> &OpenGraph {
        &self.open
    }

    /// Current document.
    pub fn document(&self) -> &Document {
        &self.open.document
    }

    /// File of the graph; none before the first save.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Revision of the document, which rises with every change; no two sessions of a process share one.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Names of the steps that can be undone, the next one last.
    pub fn undo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.history.undo_names()
    }

    /// Names of the steps that can be redone, the next one last.
    pub fn redo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.history.redo_names()
    }

    /// Applies an edit, as a step with a name or as a part of the step that was begun. An edit without effect adds no step.
    pub fn edit(&mut self, name: &str, edit: Edit) -> Result<(), EditError> {
        if self.open.document.is_unchanged_by(&edit) {
            return Ok(());
        }
        let followed = (!edit.replaces_graphs()).then(|| edit.clone());
        self.history.apply(&mut self.open.document, name, edit)?;
        self.revision += 1;
        match followed {
            Some(edit) => self.recent.push(edit),
            None => self.recent.clear(),
        }
        if self.recent.len() > RECENT_EDITS {
            self.recent.drain(..RECENT_EDITS / 2);
        }
        Ok(())
    }

    /// Edits since a revision, oldest first; none where the document has changed otherwise, or long ago.
    pub fn edits_since(&self, revision: u64) -> Option<&[Edit]> {
        let count = usize::try_from(self.revision.checked_sub(revision)?).ok()?;
        self.recent.get(self.recent.len().checked_sub(count)?..)
    }

    /// Raises the revision after a change that is not a list of edits.
    fn changed_otherwise(&mut self) {
        self.revision += 1;
        self.recent.clear();
    }

    /// Begins a step of several edits, such as a drag. An empty name is replaced by that of the first edit.
    pub fn begin(&mut self, name: &str) {
        self.history.begin(name);
    }

    /// Ends the step that was begun.
    pub fn end(&mut self) {
        self.history.end();
    }

    /// Undoes all edits since [`Session::begin`] and removes them from the history.
    ///
    /// # Errors
    /// The document was changed without its history, which is a defect.
    pub fn cancel(&mut self) -> Result<(), EditError> {
        self.changed_otherwise();
        self.history.cancel(&mut self.open.document)
    }

    /// Undoes the last step and returns its name; none where there is nothing to undo.
    pub fn undo(&mut self) -> Result<Option<String>, EditError> {
        let undone = self.history.undo(&mut self.open.document)?;
        if undone.is_some() {
            self.changed_otherwise();
        }
        Ok(undone)
    }

    /// Redoes the step that was undone last and returns its name; none where there is nothing to redo.
    pub fn redo(&mut self) -> Result<Option<String>, EditError> {
        let redone = self.history.redo(&mut self.open.document)?;
        if redone.is_some() {
            self.changed_otherwise();
        }
        Ok(redone)
    }

    /// Compares the file with the text that was last read from it or written to it. While the file is gone, everything is
    /// unsaved.
    pub fn check_file(&mut self) -> FileState {
        let Some(file) = &self.file else {
            return FileState::Same;
        };
        let state = match fs::read(file) {
            Ok(bytes) if bytes == self.open.text.as_bytes() || bytes == self.saved.as_bytes() => FileState::Same,
            Ok(_) => FileState::Another,
            Err(_) => FileState::Gone,
        };
        match state {
            FileState::Same => self.is_apart = false,
            FileState::Gone => self.is_apart = true,
            FileState::Another => {}
        }
        state
    }

    /// Keeps the current document although its file holds another text; it is unsaved until the next save.
    pub fn keep_document(&mut self) {
        self.is_apart = true;
    }

    /// Replaces the document by the content of its file, as a step that can be undone.
    ///
    /// # Errors
    /// The file cannot be read; nothing changes.
    pub fn reload(&mut self) -> Result<(), EngineError> {
        let Some(file) = &self.file else {
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
        self.open.text = read.text;
        self.saved = saved;
        self.is_apart = false;
        Ok(())
    }

    /// Canonical text of the document.
    pub fn text(&mut self) -> &str {
        if self.text.0 != self.revision {
            self.text = (self.revision, self.open.document.to_json());
        }
        &self.text.1
    }

    /// Returns true if there are changes that its file does not hold. While a step is open, any change of it counts: the text is
    /// compared once it ends, and not for every move of a slider.
    pub fn is_dirty(&mut self) -> bool {
        if self.history.is_open() && self.text.0 != self.revision {
            return true;
        }
        self.has_unsaved_text()
    }

    fn has_unsaved_text(&mut self) -> bool {
        self.text();
        self.is_apart || self.text.1 != self.saved
    }

    /// Saves to its own file.
    pub fn save(&mut self) -> Result<(), EngineError> {
        let Some(file) = self.file.clone() else {
            let refused = EngineError::new(ErrorKind::Usage, "this graph has no file yet");
            return Err(refused.with_remedies([Remedy::SaveUnderOtherName]));
        };
        self.save_as(&file)
    }

    /// Saves to a file, which becomes the file of the session. A replaced file is kept as a backup whose name ends in `.bak`.
    /// At every moment the file holds its complete old or new text. Strokes are stored beside it before.
    ///
    /// In another folder, relative paths are rewritten to lead to the same files, in the document and in its history, without a
    /// step of its own. In the first file of a graph, absolute paths to files nearby become relative, so that a project can be
    /// moved.
    pub fn save_as(&mut self, path: &Path) -> Result<(), EngineError> {
        self.end();
        let rewrite = PathRewrite::between(
            self.open.folder(),
            path.parent().unwrap_or(Path::new("")),
            self.file.is_none(),
        );
        let moved = rewrite.map(|rewrite| {
            let document = rewrite.relocate(|relocation| self.open.document.relocated(relocation));
            (rewrite, document)
        });
        let text = match &moved {
            Some((_, document)) => document.to_json(),
            None => self.text().to_owned(),
        };
        // The graph is saved also where its strokes cannot be: they stay in memory, and are tried again.
        let strokes = self.save_strokes(path);
        write_with_backup(path, &text)?;
        // After the file was written, so that a failed save changes nothing.
        if let Some((rewrite, document)) = moved {
            rewrite.relocate(|relocation| self.history.relocate(&self.open.document, relocation));
            if document != self.open.document {
                self.changed_otherwise();
            }
            self.open.document = document;
            self.text = (self.revision, text.clone());
        }
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
            recovery.set_file(Some(path));
        }
        self.open.path = path.to_owned();
        self.open.trusted = std::mem::take(&mut self.open.trusted).with_file(path);
        self.open.text = text.as_str().into();
        self.file = Some(path.to_owned());
        self.saved = text;
        self.is_apart = false;
        strokes
    }

    /// Stores unsaved work in the recovery file, if it has changed since the last call: the graph, and drafts of node files.
    /// To be called every few seconds. Returns whether it wrote.
    pub fn keep(&mut self, drafts: &[NodeDraft]) -> Result<bool, EngineError> {
        let is_dirty = self.has_unsaved_text();
        let Some(recovery) = &mut self.recovery else {
            return Ok(false);
        };
        if !is_dirty && drafts.is_empty() {
            recovery.forget();
            return Ok(false);
        }
        let kept = recovery.keep(is_dirty.then_some(self.text.1.as_str()), drafts)?;
        // After a redo, strokes may be those of no file.
        if is_dirty {
            self.keep_strokes()?;
        }
        Ok(kept)
    }

    /// Ends the session normally and removes its recovery file.
    pub fn close(mut self) {
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
        }
    }
}
