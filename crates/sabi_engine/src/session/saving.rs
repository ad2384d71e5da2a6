//! Saving of a session: to its file, which is checked first, and to its recovery file.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use sabi_files::{Unread, free_file, read_plain};
use sabi_graph::{Document, Edit};

use super::graph_write::GraphWrite;
use super::path_rewrite::PathRewrite;
use super::{FileState, Keeping, KnownContents, Session};
use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::{OpenGraph, SIZE_LIMIT_BYTES};
use crate::remedy::Remedy;

/// A document in which paths are rewritten for another folder.
type Moved = Option<(PathRewrite, Document)>;

impl Session {
    /// Sets the number of backups of a replaced file that are kept.
    pub fn set_backups(&mut self, backups: usize) {
        self.backups = backups;
    }

    /// Compares the file with the content that was last read from it or written to it. While the file is missing, everything is unsaved.
    pub fn check_file(&mut self) -> FileState {
        let Some(file) = &self.file else {
            return FileState::Same;
        };
        match read_plain(file, SIZE_LIMIT_BYTES) {
            Ok(bytes) if self.known.is_own(&bytes) => {
                self.is_apart = false;
                FileState::Same
            }
            Ok(bytes) if self.known.contains(&bytes) => FileState::Same,
            // A file that is too large or not an ordinary file was not written by this session.
            Ok(_) | Err(Unread::TooLarge(_) | Unread::NotPlain | Unread::Folder) => FileState::Another,
            Err(_) => {
                self.is_apart = true;
                FileState::Gone
            }
        }
    }

    /// Keeps the current document although its file has another text. The document is unsaved until the next save, which
    /// may replace that text, but no text that is written later.
    pub fn keep_document(&mut self) {
        self.is_apart = true;
        if let Some(Ok(bytes)) = self.file.as_ref().map(|file| read_plain(file, SIZE_LIMIT_BYTES)) {
            self.known.accept(&bytes);
        }
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
        self.known = KnownContents::of(&[saved.as_bytes(), read.text.as_bytes()]);
        self.open.text = read.text;
        self.saved = saved;
        self.is_apart = false;
        Ok(())
    }

    /// Saves to its own file.
    ///
    /// # Errors
    /// The file is written by another program since it was read or saved ([`Remedy::ReplaceFile`]), it was opened for reading
    /// alone, or the disk refuses; it is unchanged then.
    pub fn save(&mut self) -> Result<(), EngineError> {
        let Some(file) = self.file.clone() else {
            let refused = EngineError::new(ErrorKind::Usage, "this graph has no file yet");
            return Err(refused.with_remedies([Remedy::SaveUnderOtherName]));
        };
        if self.is_read_only {
            let why = format!(
                "{} is open in another window, and here for reading alone",
                file.display()
            );
            let refused = EngineError::new(ErrorKind::CannotWrite, why);
            return Err(refused.with_remedies([Remedy::SaveUnderOtherName]));
        }
        let known = self.known.clone();
        self.write(&file, Some(&known))
    }

    /// Saves to its own file, after what another program has written there was copied beside it. Returns the path of the copy;
    /// none where the file is gone or is this session's own.
    ///
    /// # Errors
    /// The file cannot be read, or the disk refuses; it is unchanged then.
    pub fn save_beside_theirs(&mut self) -> Result<Option<PathBuf>, EngineError> {
        let state = self.check_file();
        let Some(file) = self.file.clone().filter(|_| state == FileState::Another) else {
            return self.save().map(|()| None);
        };
        let unread = |error: std::io::Error| {
            let why = format!("{} cannot be read: {error}", file.display());
            EngineError::new(ErrorKind::CannotWrite, why).caused_by(error)
        };
        let theirs = read_plain(&file, SIZE_LIMIT_BYTES).map_err(|why| unread(why.into()))?;
        let mut stem = file.file_stem().map_or_else(OsString::new, OsString::from);
        stem.push("-theirs");
        let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or("sabi");
        let folder = file.parent().unwrap_or(Path::new(""));
        let Some(copy) = free_file(folder, &stem, ending, &theirs) else {
            let why = format!("{} has too many copies beside it", file.display());
            return Err(EngineError::new(ErrorKind::CannotWrite, why).with_remedies([Remedy::SaveUnderOtherName]));
        };
        self.disk.write_whole(&copy, &theirs)?;
        // If the file changes again after this, the user is asked again.
        self.known.accept(&theirs);
        self.save().map(|()| Some(copy))
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
        self.write(path, None)
    }

    fn write(&mut self, path: &Path, replaceable: Option<&KnownContents>) -> Result<(), EngineError> {
        self.end();
        let moved = self.moved_to(path);
        let text = match &moved {
            Some((_, document)) => document.to_json(),
            None => self.text().to_owned(),
        };
        // The graph is saved even if its strokes cannot be. They stay in memory and are tried again.
        let strokes = self.save_strokes(path);
        let write = GraphWrite {
            disk: &self.disk,
            backups: self.backups,
            replaceable,
        };
        let written = write.write(path, &text);
        if self.file.as_deref() == Some(path) {
            // Also after an error, since the file may have been replaced, only not durably.
            self.known.add(text.as_bytes());
        }
        written?;
        self.take_file(path, text, moved);
        match strokes {
            Ok(()) => self.forget_recovery(),
            Err(_) => self.keep_strokes_in_recovery(),
        }
        strokes
    }

    /// Returns the document with paths for the folder of another file, if that changes them.
    fn moved_to(&self, path: &Path) -> Moved {
        let rewrite = PathRewrite::between(
            self.open.folder(),
            path.parent().unwrap_or(Path::new("")),
            self.file.is_none(),
        );
        rewrite.map(|rewrite| {
            let document = rewrite.relocate(|relocation| self.open.document.relocated(relocation));
            (rewrite, document)
        })
    }

    /// Makes a written file the session's file. This is done after writing, so that a failed save changes nothing.
    fn take_file(&mut self, path: &Path, text: String, moved: Moved) {
        if let Some((rewrite, document)) = moved {
            rewrite.relocate(|relocation| self.history.relocate(&self.open.document, relocation));
            if document != self.open.document {
                self.changed_otherwise();
            }
            self.open.document = document;
            self.text = (self.revision, text.clone());
        }
        if self.file.as_deref() != Some(path) {
            self.file = Some(path.to_owned());
            self.is_read_only = false;
            self.claim_other_file();
        }
        self.open.path = path.to_owned();
        self.open.trusted = std::mem::take(&mut self.open.trusted).with_file(path);
        self.open.strokes.trust(&self.open.trusted);
        self.open.text = text.as_str().into();
        self.known = KnownContents::of(&[text.as_bytes()]);
        self.saved = text;
        self.is_apart = false;
    }

    /// Removes the recovery file, since the session's file has everything.
    fn forget_recovery(&mut self) {
        self.has_unsaved_strokes = false;
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
            recovery.set_file(self.file.as_deref());
        }
    }

    /// Keeps the recovery file, since strokes could not be stored beside the session's file.
    fn keep_strokes_in_recovery(&mut self) {
        self.has_unsaved_strokes = true;
        if let Some(recovery) = &mut self.recovery {
            recovery.set_file(self.file.as_deref());
            // The error about the strokes is the one that is reported. The next autosave tries again.
            let _ = recovery.keep(Some(&self.saved), &[], self.known.stored());
        }
        self.store_strokes_in_recovery();
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
        let kept = recovery.keep(graph.as_deref(), drafts, self.known.stored())?;
        // After a redo, strokes may not be in any file.
        if graph.is_some() {
            self.keep_all_strokes()?;
        }
        Ok(kept)
    }

    /// Does what [`Session::keep`] does on a thread of its own, so that a window does not wait for the disk. To be called every
    /// few seconds, and until all is done.
    ///
    /// # Errors
    /// The disk refused, now or for the copy before; an earlier recovery file is as it was.
    pub fn keep_meanwhile(&mut self, drafts: &[NodeDraft]) -> Result<Keeping, EngineError> {
        let Some(graph) = self.work_to_keep(drafts) else {
            return Ok(Keeping::Done);
        };
        let Some(recovery) = &mut self.recovery else {
            return Ok(Keeping::Done);
        };
        let has_graph = graph.is_some();
        let keeping = recovery.keep_meanwhile(graph, drafts, self.known.stored())?;
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
        Some(is_dirty.then(|| self.text.1.clone()))
    }

    /// Ends the session normally and removes its recovery file.
    pub fn close(mut self) {
        if let Some(recovery) = &mut self.recovery {
            recovery.forget();
        }
    }
}
