//! Recovery files: copies of unsaved work, in case the program ends abnormally.

mod work;
mod writing;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use sabi_files::{Disk, FileError, FileLock, LockError, absolute, is_locked, read_plain, sweep};
use sabi_graph::Document;

use super::known_contents::KnownContents;
use super::stroke_files::forget_strokes;
use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::SIZE_LIMIT_BYTES;
use crate::remedy::Remedy;
use crate::source::strokes::paint_folder;
pub(super) use work::UnsavedWork;
use writing::Writing;

/// Number of the next session of this process, part of the names of recovery files.
static SESSIONS: AtomicU64 = AtomicU64::new(0);

/// File extension of recovery files.
const ENDING: &str = "recovery";

/// File for the unsaved work of a session. A lock file beside it marks it as in use while the session exists.
#[derive(Debug)]
pub struct Recovery {
    path: PathBuf,
    /// The graph's own file.
    file: Option<PathBuf>,
    /// Content that was written last.
    kept: Option<UnsavedWork>,
    /// Error from reading the file.
    fault: Option<EngineError>,
    lock: Option<FileLock>,
    disk: Disk,
    /// Copy that is being written.
    writing: Option<Writing>,
}

/// State of a copy of unsaved work, which is written on a separate thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeping {
    /// All unsaved work is in the copy, or there is nothing to copy.
    Done,
    /// It is being written.
    Begun,
    /// An earlier copy is still being written.
    Postponed,
}

/// Maximum size of a recovery file, which has a graph and drafts of nodes, in bytes.
const MOST_BYTES: u64 = 2 * SIZE_LIMIT_BYTES;

/// Finds the recovery files in a folder from sessions that did not end normally, newest first. Files in use by a running program are left
/// out; see [`recoveries_in_use`]. A file that cannot be read is listed with its error. Incomplete files are removed.
pub fn recoveries(folder: &Path) -> Vec<Recovery> {
    // A file that was being written when a program ended is not listed.
    sweep(folder);
    let mut found: Vec<(SystemTime, PathBuf)> = recovery_files(folder)
        .filter(|(_, path)| !is_locked(&lock_of(path)))
        .collect();
    found.sort();
    found
        .into_iter()
        .rev()
        .map(|(_, path)| Recovery::read_from(path))
        .collect()
}

/// Finds the recovery files in a folder that running programs use. A killed program uses its file until the system has
/// ended it, which may take a moment.
pub fn recoveries_in_use(folder: &Path) -> Vec<PathBuf> {
    let in_use = recovery_files(folder).filter(|(_, path)| is_locked(&lock_of(path)));
    in_use.map(|(_, path)| path).collect()
}

/// Returns the recovery files of a folder, with their modification times.
fn recovery_files(folder: &Path) -> impl Iterator<Item = (SystemTime, PathBuf)> {
    // If a folder cannot be read, there are none.
    let entries = fs::read_dir(folder).into_iter().flatten();
    entries.filter_map(|entry| {
        let path = entry.ok()?.path();
        let is_kept = path.extension().is_some_and(|ending| ending == ENDING);
        let when = fs::metadata(&path).and_then(|metadata| metadata.modified()).ok()?;
        is_kept.then_some((when, path))
    })
}

/// Returns the path of the lock file that marks a recovery file as in use.
fn lock_of(path: &Path) -> PathBuf {
    path.with_extension("lock")
}

impl Recovery {
    /// Creates the recovery file of a new session in a folder. It is written with the first unsaved work.
    pub(super) fn new(folder: &Path, file: Option<&Path>) -> Recovery {
        let number = SESSIONS.fetch_add(1, Ordering::Relaxed);
        // Process numbers are reused, but times are not. A clock before 1970 counts as 1970; the other parts of the name
        // still distinguish files.
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!("{}-{}-{number}.{ENDING}", std::process::id(), now.as_millis());
        Recovery {
            path: folder.join(name),
            file: file.map(absolute),
            kept: None,
            fault: None,
            lock: None,
            disk: Disk::default(),
            writing: None,
        }
    }

    /// Reads a recovery file; `None` if a running program uses it, or if it no longer exists.
    pub fn of_file(path: &Path) -> Option<Recovery> {
        let is_free = path.is_file() && !is_locked(&lock_of(path));
        is_free.then(|| Recovery::read_from(path.to_owned()))
    }

    /// Reads a recovery file. If it cannot be read, the result has a fault.
    fn read_from(path: PathBuf) -> Recovery {
        let mut recovery = Recovery {
            path,
            file: None,
            kept: None,
            fault: None,
            lock: None,
            disk: Disk::default(),
            writing: None,
        };
        match recovery.read() {
            Ok((kept, file)) => (recovery.kept, recovery.file) = (Some(kept), file),
            Err(fault) => recovery.fault = Some(fault),
        }
        recovery
    }

    /// Makes it write to this disk from now on.
    pub(super) fn turn_to_disk(&mut self, disk: &Disk) {
        self.disk = disk.clone();
    }

    /// Returns the error from reading the file; `None` if it was read.
    pub fn fault(&self) -> Option<&EngineError> {
        self.fault.as_ref()
    }

    /// Returns the drafts of node files that were not saved.
    pub fn drafts(&self) -> &[NodeDraft] {
        self.kept.as_ref().map_or(&[], |kept| &kept.drafts)
    }

    /// Path of the recovery file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the graph's own file; `None` if it was never saved.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Returns the graph, for showing what would be recovered; `None` if the graph is in its own file, or if it cannot be read.
    pub fn document(&self) -> Option<Document> {
        Document::from_json(self.kept.as_ref()?.graph.as_ref()?).ok()
    }

    /// Returns the size in bytes of the graph's text.
    pub fn graph_bytes(&self) -> Option<u64> {
        let text = self.kept.as_ref()?.graph.as_ref()?;
        Some(text.len() as u64)
    }

    /// Returns true if the content of the graph's own file has changed since the copy was written.
    pub fn is_file_changed(&self) -> bool {
        let now = self
            .file
            .as_ref()
            .and_then(|file| read_plain(file, SIZE_LIMIT_BYTES).ok());
        now.is_some_and(|now| !self.known_contents(Some(&now)).is_own(&now))
    }

    /// Returns the time at which the file was last written.
    pub fn when(&self) -> Option<SystemTime> {
        fs::metadata(&self.path).and_then(|metadata| metadata.modified()).ok()
    }

    /// Sets the graph's own file.
    pub(super) fn set_file(&mut self, file: Option<&Path>) {
        self.file = file.map(absolute);
    }

    /// Returns true if it holds the graph, not only node files.
    pub fn has_graph(&self) -> bool {
        self.kept.as_ref().is_some_and(|kept| kept.graph.is_some())
    }

    /// Reads the unsaved work and the path of the graph's own file.
    pub(super) fn read(&self) -> Result<(UnsavedWork, Option<PathBuf>), EngineError> {
        let damaged = |why: String| {
            let shown = self.path.display();
            EngineError::new(
                ErrorKind::BadInput,
                format!("{shown}: the recovery file cannot be read: {why}"),
            )
        };
        let bytes =
            read_plain(&self.path, MOST_BYTES).map_err(|unread| damaged(io::Error::from(unread).to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| damaged(error.to_string()))?;
        UnsavedWork::read(&text).map_err(damaged)
    }

    /// Returns the contents of the graph's own file that a save may replace: the content at the time of the copy. A copy by
    /// an earlier version has no hash; for it, `now`, the present content, is used.
    pub(super) fn known_contents(&self, now: Option<&[u8]>) -> KnownContents {
        match (self.kept.as_ref().and_then(|kept| kept.file_hash.as_deref()), now) {
            (Some(hash), _) => KnownContents::of_stored(hash),
            (None, Some(now)) => KnownContents::of(&[now]),
            (None, None) => KnownContents::default(),
        }
    }

    /// Returns true if there are strokes beside the recovery file.
    pub(super) fn has_strokes(&self) -> bool {
        paint_folder(&self.path).is_dir()
    }

    /// Writes a graph's text and drafts of node files durably, unless they were written last. The graph is `None` if it is
    /// in its own file. Returns true if it wrote.
    pub(super) fn keep(
        &mut self,
        graph: Option<&str>,
        drafts: &[NodeDraft],
        file_hash: Option<String>,
    ) -> Result<bool, EngineError> {
        self.finish_writing()?;
        let work = UnsavedWork {
            graph: graph.map(str::to_owned),
            drafts: drafts.to_vec(),
            file_hash,
        };
        if self.kept.as_ref() == Some(&work) {
            return Ok(false);
        }
        let written = self.disk.write_whole(&self.path, &work.to_bytes(self.file.as_deref()));
        written.map_err(|error| self.refused(error))?;
        self.acquire();
        self.kept = Some(work);
        Ok(true)
    }

    /// Starts to write like [`Recovery::keep`], on a separate thread.
    pub(super) fn keep_meanwhile(
        &mut self,
        graph: Option<String>,
        drafts: &[NodeDraft],
        file_hash: Option<String>,
    ) -> Result<Keeping, EngineError> {
        if self.writing.as_ref().is_some_and(|writing| !writing.is_over()) {
            return Ok(Keeping::Postponed);
        }
        self.finish_writing()?;
        let work = UnsavedWork {
            graph,
            drafts: drafts.to_vec(),
            file_hash,
        };
        if self.kept.as_ref() == Some(&work) {
            return Ok(Keeping::Done);
        }
        self.acquire();
        let bytes = work.to_bytes(self.file.as_deref());
        let writing = Writing::start(&self.disk, &self.path, bytes, work);
        self.writing = Some(writing.map_err(|error| self.refused(error))?);
        Ok(Keeping::Begun)
    }

    /// Waits for the copy that is being written.
    fn finish_writing(&mut self) -> Result<(), EngineError> {
        let Some(writing) = self.writing.take() else {
            return Ok(());
        };
        let written = writing.finish().map_err(|error| self.refused(error))?;
        self.kept = Some(written);
        Ok(())
    }

    fn refused(&self, error: FileError) -> EngineError {
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let why = format!("{} cannot be written: {}", folder.display(), error.reason());
        let refused = EngineError::new(ErrorKind::CannotWrite, why).caused_by(error);
        refused.with_remedies([Remedy::FreeSpace])
    }

    /// Removes the recovery file and its lock.
    pub fn forget(&mut self) {
        // If the copy could not be written, there is nothing to remove.
        let was_writing = self.writing.is_some();
        let _ = self.finish_writing();
        if self.kept.take().is_some() || self.fault.take().is_some() || was_writing {
            // The file may already be missing, so errors are ignored.
            let _ = self.disk.remove(&self.path);
        }
        forget_strokes(&self.disk, &self.path);
        if let Some(lock) = self.lock.take() {
            lock.remove();
        }
    }

    /// Marks the file as in use. Returns false if another session has marked it.
    pub(super) fn acquire(&mut self) -> bool {
        if self.lock.is_some() {
            return true;
        }
        match FileLock::acquire(&lock_of(&self.path)) {
            Ok(lock) => self.lock = Some(lock),
            Err(LockError::InUse { .. }) => return false,
            // Some network shares have no locks. Work on them can still be recovered, but it is not distinguished from work in use.
            Err(LockError::Unavailable(_)) => {}
        }
        true
    }
}
