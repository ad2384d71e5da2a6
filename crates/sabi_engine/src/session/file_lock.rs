//! Lock of a session's file, which shows other windows that it is open here.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use sabi_files::{FileLock, LockError, behind_links, is_locked};

/// Mark that a file is open. It is removed when it is dropped. If the program is killed, the hidden file remains, but it
/// has no effect without a lock.
#[derive(Debug, Default)]
pub(super) struct FileMark {
    lock: Option<FileLock>,
}

impl FileMark {
    /// Returns true if it marks a file.
    pub(super) fn is_set(&self) -> bool {
        self.lock.is_some()
    }

    /// Marks a graph file, unless a file is marked. Returns false if another window has marked it.
    pub(super) fn claim(&mut self, graph: &Path) -> bool {
        if self.is_set() {
            return true;
        }
        let Some(lock) = lock_of(graph) else {
            return true;
        };
        match FileLock::acquire(&lock) {
            Ok(lock) => self.lock = Some(lock),
            Err(LockError::InUse { .. }) => return false,
            // In a folder that cannot be written to, and on a share without locks, windows cannot see each other.
            Err(LockError::Unavailable(_)) => {}
        }
        true
    }
}

impl Drop for FileMark {
    fn drop(&mut self) {
        if let Some(lock) = self.lock.take() {
            lock.remove();
        }
    }
}

/// Returns true if a graph file is open for editing in any window, including this program's own windows. Windows of
/// programs that have ended do not count.
pub fn is_open_in_a_window(graph: &Path) -> bool {
    lock_of(graph).is_some_and(|lock| is_locked(&lock))
}

/// Returns the hidden file beside a graph that is locked while the graph is open.
fn lock_of(graph: &Path) -> Option<PathBuf> {
    let graph = behind_links(graph);
    let mut name = OsString::from(".");
    name.push(graph.file_name()?);
    name.push(".lock");
    Some(graph.with_file_name(name))
}
