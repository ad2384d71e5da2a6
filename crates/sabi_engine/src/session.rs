//! Session of an open graph: its edits and their history, its file, and its recovery file in case the program ends abnormally.

mod file_lock;
mod free_file;
mod graph_write;
mod known_contents;
pub(crate) mod path_rewrite;
mod recovery;
mod saving;
mod stroke_files;
#[cfg(test)]
mod tests;
mod trust;
pub mod watch;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use sabi_files::{Disk, read_plain};
use sabi_graph::{Document, Edit, EditError, History};

use file_lock::FileMark;
pub use file_lock::is_open_in_a_window;
pub use free_file::free_graph_file;
use known_contents::KnownContents;
pub use path_rewrite::{document_with_paths, relocate_paths, with_absolute_paths};
use recovery::UnsavedWork;
pub use recovery::{Keeping, Recovery, recoveries, recoveries_in_use};

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::{OpenGraph, SIZE_LIMIT_BYTES};

/// File name of a graph that has no file yet.
const UNTITLED: &str = "untitled.sabi";

/// Number of backups of a graph file that are kept, unless a session sets another number.
pub const BACKUPS: usize = 3;

/// State of a session's file, compared with the text that the session last read from it or wrote to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileState {
    /// The same, or the session has no file.
    Same,
    /// A different text, written by another program.
    Another,
    /// The file no longer exists, or cannot be read.
    Gone,
}

/// First revision of the next session of this process, so that no two sessions ever have the same revision.
static FIRST_REVISION: AtomicU64 = AtomicU64::new(0);
/// Number of revisions reserved for each session, which is never reached.
const REVISIONS: u64 = 1 << 32;
/// Maximum number of edits that are kept for readers that follow the document.
const RECENT_EDITS: usize = 256;

/// An open graph that is edited.
#[derive(Debug)]
pub struct Session {
    open: OpenGraph,
    history: History,
    /// File of the graph; `None` before the first save.
    file: Option<PathBuf>,
    /// Text of the file. For a graph without a file, the text of an empty graph.
    saved: String,
    /// True if the file no longer exists, or has another text that the next save replaces. In these cases everything is unsaved.
    is_apart: bool,
    /// Canonical text of the document, with the revision to which it belongs.
    text: (u64, String),
    /// Revision of the document. It rises with every change.
    revision: u64,
    /// The last edits, each of which raised the revision by one.
    recent: Vec<Edit>,
    recovery: Option<Recovery>,
    disk: Disk,
    /// Contents of the file that a save may replace without asking.
    known: KnownContents,
    /// Number of backups of the file that are kept.
    backups: usize,
    /// Mark of the file as open here.
    mark: FileMark,
    is_read_only: bool,
    /// True if strokes could not be stored beside the file, so that only the recovery copy has them.
    has_unsaved_strokes: bool,
}

impl Session {
    /// Creates a session of an empty graph without a file. Unsaved work is stored in `recovery_folder`, if there is one.
    pub fn new(recovery_folder: Option<&Path>) -> Session {
        Session::of(OpenGraph::empty(UNTITLED), None, recovery_folder)
    }

    /// Creates a session of a graph without a file that begins with this document. The document does not count as unsaved.
    pub fn beginning_with(document: Document, recovery_folder: Option<&Path>) -> Session {
        let session = Session::of(OpenGraph::of_document(UNTITLED, document), None, recovery_folder);
        Session {
            saved: session.text.1.clone(),
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
            disk: Disk::default(),
            known: recovery.known_contents(file_bytes.as_deref()),
            backups: BACKUPS,
            mark: FileMark::default(),
            is_read_only: false,
            has_unsaved_strokes: recovery.has_strokes(),
            recovery: Some(recovery),
        };
        session.read_recovered_strokes();
        Ok(session)
    }

    fn of(open: OpenGraph, file: Option<PathBuf>, recovery_folder: Option<&Path>) -> Session {
        let text = open.document.to_json();
        let revision = FIRST_REVISION.fetch_add(REVISIONS, Ordering::Relaxed);
        let known = match &file {
            Some(_) => KnownContents::of(&[text.as_bytes(), open.text.as_bytes()]),
            None => KnownContents::default(),
        };
        Session {
            disk: Disk::default(),
            known,
            backups: BACKUPS,
            mark: FileMark::default(),
            is_read_only: false,
            has_unsaved_strokes: false,
            history: History::new(),
            recovery: recovery_folder.map(|folder| Recovery::new(folder, file.as_deref())),
            saved: match &file {
                // Opening a file that is not canonical causes no unsaved changes.
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
        self.file.as_deref()
    }

    /// Returns the revision of the document, which rises with every change. Two sessions of a process never have the same revision.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns the names of the steps that can be undone, the next one last.
    pub fn undo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.history.undo_names()
    }

    /// Returns the names of the steps that can be redone, the next one last.
    pub fn redo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.history.redo_names()
    }

    /// Applies an edit, as a step with a name or as a part of the open step. An edit without effect adds no step.
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

    /// Applies an edit that is not a step: it cannot be undone, and steps that can be redone are kept.
    ///
    /// # Errors
    /// The edit is refused; nothing changes.
    pub fn edit_aside(&mut self, edit: Edit) -> Result<(), EditError> {
        if self.open.document.is_unchanged_by(&edit) {
            return Ok(());
        }
        self.open.document.apply(edit)?;
        self.changed_otherwise();
        Ok(())
    }

    /// Returns the edits since a revision, oldest first; `None` if the document has changed in other ways, or if the revision is too old.
    pub fn edits_since(&self, revision: u64) -> Option<&[Edit]> {
        let count = usize::try_from(self.revision.checked_sub(revision)?).ok()?;
        self.recent.get(self.recent.len().checked_sub(count)?..)
    }

    /// Raises the revision after a change that is not a list of edits.
    fn changed_otherwise(&mut self) {
        self.revision += 1;
        self.recent.clear();
    }

    /// Begins a step of several edits, for example a drag. If the name is empty, the name of the first edit is used.
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

    /// Undoes the last step and returns its name; `None` if there is nothing to undo.
    pub fn undo(&mut self) -> Result<Option<String>, EditError> {
        let undone = self.history.undo(&mut self.open.document)?;
        if undone.is_some() {
            self.changed_otherwise();
        }
        Ok(undone)
    }

    /// Redoes the last undone step and returns its name; `None` if there is nothing to redo.
    pub fn redo(&mut self) -> Result<Option<String>, EditError> {
        let redone = self.history.redo(&mut self.open.document)?;
        if redone.is_some() {
            self.changed_otherwise();
        }
        Ok(redone)
    }

    /// Canonical text of the document.
    pub fn text(&mut self) -> &str {
        if self.text.0 != self.revision {
            self.text = (self.revision, self.open.document.to_json());
        }
        &self.text.1
    }

    /// Returns true if there are changes that are not in its file. While a step is open, any change of it counts. The texts
    /// are compared only when the step ends, not for every move of a slider.
    pub fn is_dirty(&mut self) -> bool {
        if self.history.is_open() && self.text.0 != self.revision {
            return true;
        }
        self.has_unsaved_text()
    }

    fn has_unsaved_text(&mut self) -> bool {
        self.text();
        self.is_apart || self.has_unsaved_strokes || self.text.1 != self.saved
    }
}
