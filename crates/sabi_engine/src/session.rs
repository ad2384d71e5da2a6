//! A graph that is being worked on: its edits and how they are taken back, its file, and what is kept of it in case the
//! program ends before it is saved.

mod free_file;
mod moving;
mod recovery;
#[cfg(test)]
mod tests;
pub(crate) mod watch;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use sabi_files::{StagedSet, behind_links};
use sabi_graph::{Document, Edit, EditError, History};

pub use free_file::free_graph_file;
use moving::Moving;
pub use moving::{moved_to, with_whole_paths};
use recovery::UnsavedWork;
pub use recovery::{Recovery, recoveries};

use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::remedy::Remedy;

/// What a graph is called before it has a file.
const UNTITLED: &str = "untitled.sabi";
/// What the file that a save replaces is called, after its own name.
const BACKUP: &str = ".bak";

/// What the file of a session holds, beside what the session last read from it or wrote to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileState {
    /// The same, or the session has no file.
    Same,
    /// Something else, which another program wrote.
    Another,
    /// There is no such file any more, or none that can be read.
    Gone,
}

/// Where counting begins for each session of a process, so that no two of them are ever at the same revision.
static FIRST_REVISION: AtomicU64 = AtomicU64::new(0);
/// No session makes so many steps.
const REVISIONS: u64 = 1 << 32;

/// A graph that is being worked on.
#[derive(Debug)]
pub struct Session {
    open: OpenGraph,
    history: History,
    /// Where it is saved; none before the first time.
    file: Option<PathBuf>,
    /// The text in its file, or of the empty graph that it began as.
    saved: String,
    /// Whether its file is gone, or is to become again what is here: then everything is unsaved.
    is_apart: bool,
    /// The text at hand, by the revision that it is of.
    text: (u64, String),
    /// Rises with everything that changes the document.
    revision: u64,
    recovery: Option<Recovery>,
}

impl Session {
    /// An empty graph without a file. What is not saved is kept in `recovery_folder`, if there is one.
    pub fn new(recovery_folder: Option<&Path>) -> Session {
        let document = Document::new("");
        Session::of(
            OpenGraph {
                path: PathBuf::from(UNTITLED),
                text: document.to_json().into(),
                pictures: crate::Pictures::default(),
                document,
            },
            None,
            recovery_folder,
        )
    }

    /// A graph out of its file.
    pub fn open(path: &Path, recovery_folder: Option<&Path>) -> Result<Session, EngineError> {
        let open = OpenGraph::open(path)?;
        Ok(Session::of(open, Some(path.to_owned()), recovery_folder))
    }

    /// What was kept of a graph when the program ended before it was saved: nothing of it is saved yet. Where only node files
    /// were kept, the graph is as its file has it.
    ///
    /// # Errors
    /// What was kept cannot be read, or another window goes on with it.
    pub fn recover(mut recovery: Recovery) -> Result<Session, EngineError> {
        if !recovery.take() {
            let why = "another window goes on with this graph already; close it there first";
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
        let (UnsavedWork { graph, .. }, file) = recovery.read()?;
        let Some(text) = graph else {
            // Nothing of the graph was unsaved: it is what its file holds by now.
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
        Ok(Session {
            open: OpenGraph {
                path: name,
                text: text.clone().into(),
                pictures: crate::Pictures::default(),
                document,
            },
            history: History::new(),
            file,
            saved,
            is_apart: false,
            text: (revision, text),
            revision,
            recovery: Some(recovery),
        })
    }

    fn of(open: OpenGraph, file: Option<PathBuf>, recovery_folder: Option<&Path>) -> Session {
        let text = open.document.to_json();
        let revision = FIRST_REVISION.fetch_add(REVISIONS, Ordering::Relaxed);
        Session {
            history: History::new(),
            recovery: recovery_folder.map(|folder| Recovery::new(folder, file.as_deref())),
            saved: match &file {
                // A file that is not canonical is not made dirty by opening it.
                Some(_) => text.clone(),
                None => Document::new("").to_json(),
            },
            is_apart: false,
            text: (revision, text),
            revision,
            file,
            open,
        }
    }

    /// The graph with the files that it stands among, as it is now.
    pub fn graph(&self) -> &OpenGraph {
        &self.open
    }

    /// The document, as it is now.
    pub fn document(&self) -> &Document {
        &self.open.document
    }

    /// Its file; none before it is saved for the first time.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Rises with everything that changes the document; no other session of this process has the same ones.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Names of the steps that can be undone, the next one last.
    pub fn undo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.history.undo_names()
    }

    /// Names of the steps that can be done again, the next one last.
    pub fn redo_names(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.history.redo_names()
    }

    /// Makes an edit, as a step of that name or a part of the one that was begun. One that changes nothing is no step.
    pub fn edit(&mut self, name: &str, edit: Edit) -> Result<(), EditError> {
        if self.open.document.is_as_after(&edit) {
            return Ok(());
        }
        self.history.apply(&mut self.open.document, name, edit)?;
        self.revision += 1;
        Ok(())
    }

    /// Begins a step of several edits, such as a drag.
    pub fn begin(&mut self, name: &str) {
        self.history.begin(name);
    }

    /// Ends the step that was begun.
    pub fn end(&mut self) {
        self.history.end();
    }

    /// Takes back what was done since [`Session::begin`], as if it had never been.
    ///
    /// # Errors
    /// The document was changed past its history, which is a mistake of the program.
    pub fn cancel(&mut self) -> Result<(), EditError> {
        self.revision += 1;
        self.history.cancel(&mut self.open.document)
    }

    /// Takes the last step back and names it; none where there is nothing to undo.
    pub fn undo(&mut self) -> Result<Option<String>, EditError> {
        let undone = self.history.undo(&mut self.open.document)?;
        self.revision += u64::from(undone.is_some());
        Ok(undone)
    }

    /// Does the last step again that was undone and names it; none where there is none.
    pub fn redo(&mut self) -> Result<Option<String>, EditError> {
        let redone = self.history.redo(&mut self.open.document)?;
        self.revision += u64::from(redone.is_some());
        Ok(redone)
    }

    /// Finds out what its file holds by now, whoever wrote it. What is here is unsaved as long as the file is gone.
    pub fn look_at_file(&mut self) -> FileState {
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

    /// Goes on with what is here although its file holds something else by now: it is unsaved until it is saved again.
    pub fn keep_apart(&mut self) {
        self.is_apart = true;
    }

    /// Takes what its file holds by now in the place of what is here, as a step that can be undone.
    ///
    /// # Errors
    /// The file is none that can be read; nothing changes.
    pub fn read_again(&mut self) -> Result<(), EngineError> {
        let Some(file) = &self.file else {
            return Ok(());
        };
        let read = OpenGraph::open(file)?;
        self.end();
        let saved = read.document.to_json();
        let edit = Edit::Replace {
            document: Box::new(read.document),
        };
        let taken = self.edit("Open the file anew", edit);
        taken.map_err(|error| EngineError::of(ErrorKind::BadInput, error))?;
        self.open.text = read.text;
        self.saved = saved;
        self.is_apart = false;
        Ok(())
    }

    /// The canonical text of the document.
    pub fn text(&mut self) -> &str {
        if self.text.0 != self.revision {
            self.text = (self.revision, self.open.document.to_json());
        }
        &self.text.1
    }

    /// Whether there is something that its file does not hold.
    pub fn is_dirty(&mut self) -> bool {
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

    /// Saves to a file, which is the session's from then on. The file that was there stays beside it under a name that ends
    /// in `.bak`; at every moment either the old text or the new one is there, whole.
    ///
    /// In another folder, relative paths are written so that they lead where they led before. That is no step of its own:
    /// what can be undone and done again is rewritten with it, so that every state before and after the save names the same
    /// files as ever, by their paths from the new folder. In the first file of a graph, absolute paths to what is near it
    /// become relative, so that a project can be moved.
    pub fn save_as(&mut self, path: &Path) -> Result<(), EngineError> {
        self.end();
        let moving = Moving::between(
            self.open.folder(),
            path.parent().unwrap_or(Path::new("")),
            self.file.is_none(),
        );
        let moved = moving.map(|moving| {
            let document = moving.relocate(|relocation| self.open.document.relocated(relocation));
            (moving, document)
        });
        let text = match &moved {
            Some((_, document)) => document.to_json(),
            None => self.text().to_owned(),
        };
        write_with_backup(path, &text)?;
        // Only now, since a file that could not be written changes nothing.
        if let Some((moving, document)) = moved {
            moving.relocate(|relocation| self.history.relocate(&self.open.document, relocation));
            self.revision += u64::from(document != self.open.document);
            self.open.document = document;
            self.text = (self.revision, text.clone());
        }
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
            recovery.name(Some(path));
        }
        self.open.path = path.to_owned();
        self.open.text = text.as_str().into();
        self.file = Some(path.to_owned());
        self.saved = text;
        self.is_apart = false;
        Ok(())
    }

    /// Keeps what is not saved, if it changed since the last time: the graph, and node files that are being written. To be
    /// called every few seconds. Says whether it wrote.
    pub fn keep(&mut self, drafts: &[NodeDraft]) -> Result<bool, EngineError> {
        let is_dirty = self.is_dirty();
        let Some(recovery) = &mut self.recovery else {
            return Ok(false);
        };
        if !is_dirty && drafts.is_empty() {
            recovery.forget();
            return Ok(false);
        }
        recovery.keep(is_dirty.then_some(self.text.1.as_str()), drafts)
    }

    /// Ends the work in order: nothing of it needs to be recovered.
    pub fn close(mut self) {
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
        }
    }
}

/// Writes a graph file durably and keeps the replaced one as a backup. The file behind a symbolic link is written.
fn write_with_backup(path: &Path, text: &str) -> Result<(), EngineError> {
    let path = &behind_links(path);
    if fs::metadata(path).is_ok_and(|known| known.permissions().readonly()) {
        let why = format!("{} is write-protected", path.display());
        let refused = EngineError::new(ErrorKind::CannotWrite, why);
        return Err(refused.with_remedies([Remedy::AllowWriting, Remedy::SaveUnderOtherName]));
    }
    let Some(name) = path.file_name() else {
        let why = format!("{} names no file; add a name that ends in .sabi", path.display());
        return Err(EngineError::new(ErrorKind::CannotWrite, why));
    };
    let mut staged = StagedSet::create(path.parent().unwrap_or(Path::new(".")))?;
    if let Ok(before) = fs::read(path)
        && before != text.as_bytes()
    {
        let mut backup = name.to_owned();
        backup.push(BACKUP);
        staged.stage(backup, &before)?;
    }
    staged.stage(name, text.as_bytes())?;
    staged.commit()?;
    Ok(())
}
