//! Recovery files: copies of unsaved work, for the case that the program ends abnormally.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use sabi_files::{FileError, FileLock, LockError, absolute, is_locked, path_from_stored, stored_path, write_unsynced};
use serde_json::{Value as Json, json};

use super::stroke_files::forget_strokes;
use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::remedy::Remedy;

/// Number of the next session of this process, part of the names of recovery files.
static SESSIONS: AtomicU64 = AtomicU64::new(0);

/// File extension of recovery files.
const ENDING: &str = "recovery";

/// File for the unsaved work of a session. A lock file beside it marks it as in use while the session lives.
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
}

/// Unsaved work of a session.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct UnsavedWork {
    /// The graph's text; none where its file holds it.
    pub(super) graph: Option<String>,
    /// Drafts of node files.
    pub(super) drafts: Vec<NodeDraft>,
}

/// Finds the recovery files in a folder of sessions that did not end normally, newest first; those in use by a running
/// program are left out. A file that cannot be read is listed with its error.
pub fn recoveries(folder: &Path) -> Vec<Recovery> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut found: Vec<(SystemTime, PathBuf)> = entries
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let is_kept = path.extension().is_some_and(|ending| ending == ENDING);
            let when = fs::metadata(&path).and_then(|metadata| metadata.modified()).ok()?;
            (is_kept && !is_locked(&lock_of(&path))).then_some((when, path))
        })
        .collect();
    found.sort();
    let left = found.into_iter().rev().map(|(_, path)| Recovery {
        path,
        file: None,
        kept: None,
        fault: None,
        lock: None,
    });
    left.map(|mut recovery| {
        match recovery.read() {
            Ok((kept, file)) => (recovery.kept, recovery.file) = (Some(kept), file),
            Err(fault) => recovery.fault = Some(fault),
        }
        recovery
    })
    .collect()
}

/// Returns the path of the lock file that marks a recovery file as in use.
fn lock_of(path: &Path) -> PathBuf {
    path.with_extension("lock")
}

impl Recovery {
    /// Creates the recovery file of a new session in a folder; it is written with the first unsaved work.
    pub(super) fn new(folder: &Path, file: Option<&Path>) -> Recovery {
        let number = SESSIONS.fetch_add(1, Ordering::Relaxed);
        // Process numbers are reused; times are not.
        // A clock before 1970 counts as 1970; the other parts of the name still tell files apart.
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!("{}-{}-{number}.{ENDING}", std::process::id(), now.as_millis());
        Recovery {
            path: folder.join(name),
            file: file.map(absolute),
            kept: None,
            fault: None,
            lock: None,
        }
    }

    /// Returns the error from reading the file; `None` if it was read.
    pub fn fault(&self) -> Option<&EngineError> {
        self.fault.as_ref()
    }

    /// Drafts of node files that were not saved.
    pub fn drafts(&self) -> &[NodeDraft] {
        self.kept.as_ref().map_or(&[], |kept| &kept.drafts)
    }

    /// Path of the recovery file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The graph's own file; none where it was never saved.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
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
        let text = fs::read_to_string(&self.path).map_err(|error| damaged(error.to_string()))?;
        let stored: Json = serde_json::from_str(&text).map_err(|error| damaged(error.to_string()))?;
        let graph = match &stored["graph"] {
            Json::String(graph) => Some(graph.clone()),
            Json::Null if stored["drafts"].is_array() => None,
            _ => return Err(damaged("it holds no graph".to_owned())),
        };
        let drafts = stored["drafts"].as_array().map_or(&[][..], Vec::as_slice);
        let drafts: Option<Vec<NodeDraft>> = drafts.iter().map(NodeDraft::from_json).collect();
        let work = UnsavedWork {
            graph,
            drafts: drafts.ok_or_else(|| damaged("a node in it has no text".to_owned()))?,
        };
        let file = match &stored["file"] {
            Json::String(text) => {
                Some(path_from_stored(text).ok_or_else(|| damaged("its path is damaged".to_owned()))?)
            }
            _ => None,
        };
        Ok((work, file))
    }

    /// Writes a graph's text and drafts of node files, unless they were the last that were written; the graph is `None` where its
    /// own file holds it. Returns whether it wrote.
    pub(super) fn keep(&mut self, graph: Option<&str>, drafts: &[NodeDraft]) -> Result<bool, EngineError> {
        let is_known = |kept: &UnsavedWork| kept.graph.as_deref() == graph && kept.drafts == drafts;
        if self.kept.as_ref().is_some_and(is_known) {
            return Ok(false);
        }
        let file = self.file.as_deref().map(stored_path);
        let written: Vec<Json> = drafts.iter().map(NodeDraft::to_json).collect();
        let bytes = json!({ "file": file, "graph": graph, "drafts": written }).to_string();
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let refused = |error: FileError| {
            let why = format!("{} cannot be written: {}", folder.display(), error.reason());
            let refused = EngineError::new(ErrorKind::CannotWrite, why).caused_by(error);
            refused.with_remedies([Remedy::FreeSpace])
        };
        // The file is complete after a crash of the program. It is not synced, since the window that calls this every few
        // seconds must not wait for the disk.
        write_unsynced(&self.path, bytes.as_bytes()).map_err(refused)?;
        self.acquire();
        self.kept = Some(UnsavedWork {
            graph: graph.map(str::to_owned),
            drafts: drafts.to_vec(),
        });
        Ok(true)
    }

    /// Removes the recovery file and its lock.
    pub fn forget(&mut self) {
        if self.kept.take().is_some() || self.fault.take().is_some() {
            // A file that is gone already needs no removal.
            let _ = fs::remove_file(&self.path);
        }
        forget_strokes(&self.path);
        if let Some(lock) = self.lock.take() {
            lock.remove();
        }
    }

    /// Marks the file as in use; returns whether no other session has marked it.
    pub(super) fn acquire(&mut self) -> bool {
        if self.lock.is_some() {
            return true;
        }
        match FileLock::acquire(&lock_of(&self.path)) {
            Ok(lock) => self.lock = Some(lock),
            Err(LockError::InUse { .. }) => return false,
            // Some network shares have no locks; work on them is still recovered, only not told apart from work in use.
            Err(LockError::Unavailable(_)) => {}
        }
        true
    }
}
