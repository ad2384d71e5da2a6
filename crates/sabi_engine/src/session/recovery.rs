//! What is kept of a graph between saves, for the case that the program ends without asking.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use sabi_files::{FileError, FileLock, LockError, absolute, is_locked, path_from_stored, stored_path, write_unsynced};
use serde_json::{Value as Json, json};

use crate::catalog::node_file::NodeDraft;
use crate::error::{EngineError, ErrorKind};
use crate::remedy::Remedy;

/// Tells two sessions of one process apart.
static SESSIONS: AtomicU64 = AtomicU64::new(0);

/// How names of kept files end.
const ENDING: &str = "recovery";

/// The file in which a session keeps what is not saved. Beside it lies one that is locked as long as the session lives, so that
/// others know that it is in use, whatever numbers processes have.
#[derive(Debug)]
pub struct Recovery {
    path: PathBuf,
    /// The graph's own file.
    file: Option<PathBuf>,
    /// What was kept last.
    kept: Option<UnsavedWork>,
    /// Why what was kept cannot be read.
    fault: Option<EngineError>,
    lock: Option<FileLock>,
}

/// What is not saved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct UnsavedWork {
    /// The graph's text; none where its file holds it.
    pub(super) graph: Option<String>,
    /// Node files that are being written.
    pub(super) drafts: Vec<NodeDraft>,
}

/// What is left in a folder of sessions that did not end in order, those of programs that still run left out; the newest
/// first. One that cannot be read is among them, with why.
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

/// What is locked while a file is in use.
fn lock_of(path: &Path) -> PathBuf {
    path.with_extension("lock")
}

impl Recovery {
    /// A file of its own for a session in a folder, which is made when there is something to keep.
    pub(super) fn new(folder: &Path, file: Option<&Path>) -> Recovery {
        let number = SESSIONS.fetch_add(1, Ordering::Relaxed);
        // Process numbers come again; times do not.
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

    /// Why what was kept cannot be read; none where it can.
    pub fn fault(&self) -> Option<&EngineError> {
        self.fault.as_ref()
    }

    /// Node files that were being written.
    pub fn drafts(&self) -> &[NodeDraft] {
        self.kept.as_ref().map_or(&[], |kept| &kept.drafts)
    }

    /// The graph's own file; none where it was never saved.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// When it was kept.
    pub fn when(&self) -> Option<SystemTime> {
        fs::metadata(&self.path).and_then(|metadata| metadata.modified()).ok()
    }

    /// Says where the graph is saved from now on.
    pub(super) fn name(&mut self, file: Option<&Path>) {
        self.file = file.map(absolute);
    }

    /// Whether the graph itself is kept, and not only node files.
    pub fn has_graph(&self) -> bool {
        self.kept.as_ref().is_some_and(|kept| kept.graph.is_some())
    }

    /// What was kept, and the graph's file.
    pub(super) fn read(&self) -> Result<(UnsavedWork, Option<PathBuf>), EngineError> {
        let damaged = |why: String| {
            let shown = self.path.display();
            EngineError::new(
                ErrorKind::BadInput,
                format!("{shown}: what was kept cannot be read: {why}"),
            )
        };
        let text = fs::read_to_string(&self.path).map_err(|error| damaged(error.to_string()))?;
        let kept: Json = serde_json::from_str(&text).map_err(|error| damaged(error.to_string()))?;
        let graph = match &kept["graph"] {
            Json::String(graph) => Some(graph.clone()),
            Json::Null if kept["drafts"].is_array() => None,
            _ => return Err(damaged("it holds no graph".to_owned())),
        };
        let drafts = kept["drafts"].as_array().map_or(&[][..], Vec::as_slice);
        let drafts: Option<Vec<NodeDraft>> = drafts.iter().map(NodeDraft::from_json).collect();
        let kept_here = UnsavedWork {
            graph,
            drafts: drafts.ok_or_else(|| damaged("a node in it has no text".to_owned()))?,
        };
        let file = match &kept["file"] {
            Json::String(stored) => {
                Some(path_from_stored(stored).ok_or_else(|| damaged("its path is damaged".to_owned()))?)
            }
            _ => None,
        };
        Ok((kept_here, file))
    }

    /// Keeps a graph's text and node files that are being written, unless they are those that were kept last; no
    /// graph where its file holds it.
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
        // Complete after a crash of the program. Waiting for the disk would stop the window, which calls this every few
        // seconds.
        write_unsynced(&self.path, bytes.as_bytes()).map_err(refused)?;
        self.take();
        self.kept = Some(UnsavedWork {
            graph: graph.map(str::to_owned),
            drafts: drafts.to_vec(),
        });
        Ok(true)
    }

    /// Lets go of what was kept.
    pub fn forget(&mut self) {
        if self.kept.take().is_some() || self.fault.take().is_some() {
            // One that is gone already is what is wanted.
            let _ = fs::remove_file(&self.path);
        }
        if let Some(lock) = self.lock.take() {
            lock.remove();
        }
    }

    /// Marks the file as in use; returns whether no other session has marked it.
    pub(super) fn take(&mut self) -> bool {
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
