//! Node files that change while a session is open are read again.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use notify::{RecursiveMode, Watcher};

use crate::error::{EngineError, ErrorKind};
use crate::kinds::Kinds;

/// Nothing has changed for so long: the folder is at rest.
const SETTLE_PAUSE: Duration = Duration::from_millis(30);
/// After so long the folder is read, at rest or not.
const SETTLE_LIMIT: Duration = Duration::from_millis(300);

/// Watches a folder of nodes.
pub struct NodeWatcher {
    folder: PathBuf,
    changes: Receiver<()>,
    // Watching ends when this is dropped.
    _watcher: notify::RecommendedWatcher,
}

impl NodeWatcher {
    /// Starts watching.
    pub fn new(folder: &Path) -> Result<NodeWatcher, EngineError> {
        let cannot = |error: notify::Error| {
            let why = format!("{}: the folder cannot be watched: {error}", folder.display());
            EngineError::new(ErrorKind::MissingInput, why)
        };
        let (sender, changes) = channel();
        let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            let is_change = event.is_ok_and(|event| !event.kind.is_access());
            if is_change {
                // The other end is gone only when the watcher is being dropped.
                let _ = sender.send(());
            }
        })
        .map_err(cannot)?;
        watcher.watch(folder, RecursiveMode::Recursive).map_err(cannot)?;
        Ok(NodeWatcher {
            folder: folder.to_owned(),
            changes,
            _watcher: watcher,
        })
    }

    /// Reads the folder again if anything in it changed, waiting up to `patience` for it. Nodes with faults keep their
    /// last good version. Answers whether something was read.
    pub fn refresh(&self, kinds: &mut Kinds, patience: Duration) -> bool {
        if self.changes.recv_timeout(patience).is_err() {
            return false;
        }
        settle(&self.changes, SETTLE_PAUSE, SETTLE_LIMIT);
        kinds.faults.retain(|fault| !fault.path.starts_with(&self.folder));
        kinds.add_folder(&self.folder);
        true
    }
}

/// Waits until nothing has changed for the time of a `pause`: an editor saves in several steps, which arrive together. A
/// folder that something writes to all the time never comes to rest, so the wait has a limit; what comes later is told
/// at the next refresh.
fn settle(changes: &Receiver<()>, pause: Duration, limit: Duration) {
    let started = Instant::now();
    while let Some(left) = limit.checked_sub(started.elapsed())
        && changes.recv_timeout(pause.min(left)).is_ok()
    {}
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc::channel;
    use std::time::Duration;

    use super::settle;

    #[test]
    fn a_folder_that_never_rests_is_not_waited_for() {
        let (sender, changes) = channel();
        let has_settled = &AtomicBool::new(false);
        std::thread::scope(|scope| {
            let writer = scope.spawn(move || {
                for _ in (0..5000).take_while(|_| !has_settled.load(Ordering::Relaxed)) {
                    sender.send(()).expect("somebody listens");
                    std::thread::sleep(Duration::from_millis(1));
                }
                has_settled.load(Ordering::Relaxed)
            });
            // A pause that never comes: only the limit ends the wait before the writer does.
            settle(&changes, Duration::from_secs(3600), Duration::from_millis(20));
            has_settled.store(true, Ordering::Relaxed);
            assert!(writer.join().expect("the writer"), "the wait ended with the writing");
        });
    }
}
