//! File of a session's graph: what is known of its content, and whether this session may write it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use sabi_files::{Disk, Unread, free_file, read_plain};

use super::BACKUPS;
use super::file_lock::FileMark;
use super::graph_write::GraphWrite;
use super::known_contents::KnownContents;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::SIZE_LIMIT_BYTES;
use crate::remedy::Remedy;

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

/// File of a session's graph. A graph that was never saved has none yet.
#[derive(Debug)]
pub struct GraphFile {
    /// `None` before the first save.
    path: Option<PathBuf>,
    /// Text of the file. For a graph without a file, the text that does not count as unsaved.
    saved: String,
    /// True if the file no longer exists, or has another text that the next save replaces. In these cases everything is unsaved.
    is_apart: bool,
    /// Contents of the file that a save may replace without asking.
    known: KnownContents,
    /// Number of backups of the file that are kept.
    backups: usize,
    /// Mark of the file as open here.
    mark: FileMark,
    is_read_only: bool,
}

impl GraphFile {
    /// Creates the file of a session that was opened, with its text and the contents that a save may replace.
    pub(super) fn new(path: Option<PathBuf>, saved: String, known: KnownContents) -> GraphFile {
        GraphFile {
            path,
            saved,
            is_apart: false,
            known,
            backups: BACKUPS,
            mark: FileMark::default(),
            is_read_only: false,
        }
    }

    /// Its path; `None` before the first save.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Sets the number of backups of a replaced file that are kept.
    pub fn set_backups(&mut self, backups: usize) {
        self.backups = backups;
    }

    /// Sets whether saving to this file is refused.
    pub fn set_read_only(&mut self, is_read_only: bool) {
        self.is_read_only = is_read_only;
    }

    /// Returns true if saving to this file is refused.
    pub fn is_read_only(&self) -> bool {
        self.is_read_only
    }

    /// Marks the file as open in this window, until the session ends. Returns false if another window has marked it.
    pub fn claim(&mut self) -> bool {
        match &self.path {
            Some(path) => self.mark.claim(path),
            None => true,
        }
    }

    /// Compares the file with the content that was last read from it or written to it. While the file is missing, everything is unsaved.
    pub fn check(&mut self) -> FileState {
        let Some(path) = &self.path else {
            return FileState::Same;
        };
        match read_plain(path, SIZE_LIMIT_BYTES) {
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

    /// Keeps the session's document although the file has another text. The document is unsaved until the next save, which
    /// may replace that text, but no text that is written later.
    pub fn keep_document(&mut self) {
        self.is_apart = true;
        if let Some(Ok(bytes)) = self.path.as_ref().map(|path| read_plain(path, SIZE_LIMIT_BYTES)) {
            self.known.accept(&bytes);
        }
    }

    /// Text that does not count as unsaved.
    pub(super) fn saved(&self) -> &str {
        &self.saved
    }

    /// Returns true if this text of the document is in the file.
    pub(super) fn has_text(&self, text: &str) -> bool {
        !self.is_apart && self.saved == text
    }

    /// Hash of the content that was read or written last, to be stored with a copy of unsaved work.
    pub(super) fn content_hash(&self) -> Option<String> {
        self.known.stored()
    }

    /// Returns the path, to save there.
    ///
    /// # Errors
    /// There is no file yet, or it was opened for reading alone.
    pub(super) fn writable_path(&self) -> Result<PathBuf, EngineError> {
        let Some(path) = self.path.clone() else {
            let refused = EngineError::new(ErrorKind::Usage, "this graph has no file yet");
            return Err(refused.with_remedies([Remedy::SaveUnderOtherName]));
        };
        if self.is_read_only {
            let why = format!(
                "{} is open in another window, and here for reading alone",
                path.display()
            );
            let refused = EngineError::new(ErrorKind::CannotWrite, why);
            return Err(refused.with_remedies([Remedy::SaveUnderOtherName]));
        }
        Ok(path)
    }

    /// Copies what another program has written to the file beside it, so that a save may replace it. Returns the path of the
    /// copy; `None` if the file is gone or is this session's own.
    ///
    /// # Errors
    /// The file cannot be read, or the disk refuses.
    pub(super) fn copy_theirs(&mut self, disk: &Disk) -> Result<Option<PathBuf>, EngineError> {
        let state = self.check();
        let Some(file) = self.path.as_ref().filter(|_| state == FileState::Another) else {
            return Ok(None);
        };
        let unread = |error: std::io::Error| {
            let why = format!("{} cannot be read: {error}", file.display());
            EngineError::new(ErrorKind::CannotWrite, why).caused_by(error)
        };
        let theirs = read_plain(file, SIZE_LIMIT_BYTES).map_err(|why| unread(why.into()))?;
        let mut stem = file.file_stem().map_or_else(OsString::new, OsString::from);
        stem.push("-theirs");
        let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or("sabi");
        let folder = file.parent().unwrap_or(Path::new(""));
        let Some(copy) = free_file(folder, &stem, ending, &theirs) else {
            let why = format!("{} has too many copies beside it", file.display());
            return Err(EngineError::new(ErrorKind::CannotWrite, why).with_remedies([Remedy::SaveUnderOtherName]));
        };
        disk.write_whole(&copy, &theirs)?;
        // If the file changes again after this, the user is asked again.
        self.known.accept(&theirs);
        Ok(Some(copy))
    }

    /// Writes a text to a file, this one or another. With `asks`, only a known content is replaced.
    pub(super) fn write(&mut self, disk: &Disk, path: &Path, text: &str, asks: bool) -> Result<(), EngineError> {
        let write = GraphWrite {
            disk,
            backups: self.backups,
            replaceable: asks.then_some(&self.known),
        };
        let written = write.write(path, text);
        if self.path.as_deref() == Some(path) {
            // Also after an error, since the file may have been replaced, only not durably.
            self.known.add(text.as_bytes());
        }
        written
    }

    /// Makes a file that was written with this text the session's file.
    pub(super) fn take(&mut self, path: &Path, text: String) {
        if self.path.as_deref() != Some(path) {
            self.path = Some(path.to_owned());
            self.is_read_only = false;
            let was_marked = self.mark.is_set();
            self.mark = FileMark::default();
            if was_marked {
                // If another window has the file, the user has already been asked about replacing it.
                self.claim();
            }
        }
        self.known = KnownContents::of(&[text.as_bytes()]);
        self.saved = text;
        self.is_apart = false;
    }

    /// Takes over the content of the file, which was read again: its bytes, and the text of its document.
    pub(super) fn reloaded(&mut self, bytes: &[u8], saved: String) {
        self.known = KnownContents::of(&[saved.as_bytes(), bytes]);
        self.saved = saved;
        self.is_apart = false;
    }
}
