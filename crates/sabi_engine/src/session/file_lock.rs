//! Lock of a session's file, which shows other windows that it is open here.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use sabi_files::{FileLock, LockError, behind_links, is_locked};

use super::Session;

/// Mark that a file is open. It is removed when it is dropped. If the program is killed, the hidden file remains, but it
/// has no effect without a lock.
#[derive(Debug, Default)]
pub(super) struct FileMark {
    lock: Option<FileLock>,
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

impl Session {
    /// Marks the file as open in this window, until the session ends. Returns false if another window has marked it.
    pub fn claim_file(&mut self) -> bool {
        if self.mark.lock.is_some() {
            return true;
        }
        let Some(lock) = self.file.as_deref().and_then(lock_of) else {
            return true;
        };
        match FileLock::acquire(&lock) {
            Ok(lock) => self.mark.lock = Some(lock),
            Err(LockError::InUse { .. }) => return false,
            // In a folder that cannot be written to, and on a share without locks, windows cannot see each other.
            Err(LockError::Unavailable(_)) => {}
        }
        true
    }

    /// Marks another file, which has become the session's file.
    pub(super) fn claim_other_file(&mut self) {
        let was_marked = self.mark.lock.is_some();
        self.mark = FileMark::default();
        if was_marked {
            // If another window has the file, the user has already been asked about replacing it.
            self.claim_file();
        }
    }

    /// Sets whether saving to the session's file is refused.
    pub fn set_read_only(&mut self, is_read_only: bool) {
        self.is_read_only = is_read_only;
    }

    /// Returns true if saving to the session's file is refused.
    pub fn is_read_only(&self) -> bool {
        self.is_read_only
    }
}
