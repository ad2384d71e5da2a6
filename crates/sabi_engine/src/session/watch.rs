//! Watcher of the files that a session depends on.
//!
//! The system reports events in folders. If it does not, for example on network shares, polling every few seconds finds
//! changes. In both cases a file counts as changed if its length or time differs, or if an event named it.

mod folders;
mod snapshot;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use folders::Folders;
use snapshot::Snapshot;

use crate::error::{EngineError, ErrorKind};

/// Debounce after the last file event.
const SETTLE_PAUSE: Duration = Duration::from_millis(30);
/// Longest delay of a check of the files while events go on.
const SETTLE_LIMIT: Duration = Duration::from_millis(300);
/// Interval of polling without events.
const POLL_INTERVAL: Duration = Duration::from_secs(2);

/// Files on which a session depends. They need not exist, since the appearance of a file is also a change.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watched {
    /// File of the graph.
    pub graph: Option<PathBuf>,
    /// Folders of node files.
    pub nodes: Vec<PathBuf>,
    /// Files of the model. A folder represents its list of entries.
    pub model: Vec<PathBuf>,
    /// Other files: pictures and group files that the graph names, and the library. A folder represents its list of entries.
    pub files: Vec<PathBuf>,
}

/// Files that have changed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// True if the file of the graph has changed, also by this program.
    pub graph: bool,
    /// True if a node file has changed.
    pub nodes: bool,
    /// True if a file of the model has changed.
    pub model: bool,
    /// Other changed files, with their paths in [`Watched::files`].
    pub files: BTreeSet<PathBuf>,
}

impl Changes {
    /// Returns true if nothing has changed.
    pub fn is_empty(&self) -> bool {
        *self == Changes::default()
    }
}

/// Watcher of files on its own thread, so that the window never waits for a slow disk.
pub struct Watcher {
    inbox: Sender<Message>,
    shared: Arc<Mutex<Shared>>,
}

/// State shared with the thread.
#[derive(Default)]
struct Shared {
    changes: Changes,
    /// Number of calls of [`Watcher::watch`] that the thread has not handled.
    waiting: usize,
}

enum Message {
    /// Replaces the watched files.
    Watch(Box<Watched>),
    /// Reports an event of these files.
    Reported(Vec<PathBuf>),
    /// Ends the thread.
    End,
}

impl Watcher {
    /// Starts the thread, without files; `wake` is called on it after each change.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub fn new(wake: impl Fn() + Send + 'static) -> Result<Watcher, EngineError> {
        let (inbox, messages) = channel();
        let shared = Arc::new(Mutex::new(Shared::default()));
        let thread_state = WatchThread {
            messages,
            shared: shared.clone(),
            wake: Box::new(wake),
            folders: Folders::new(inbox.clone()),
            watched: Watched::default(),
            snapshot: Snapshot::default(),
        };
        // The thread is not joined at the end, since a network share that does not answer would keep the window from closing.
        let thread = std::thread::Builder::new().name("sabi watch".to_owned());
        let started = thread.spawn(move || thread_state.work());
        started.map_err(|error| {
            let why = format!(
                "the system gives no thread to watch files on ({error}); changed files are not noticed until they are \
                 opened again"
            );
            EngineError::new(ErrorKind::OutOfMemory, why).caused_by(error)
        })?;
        Ok(Watcher { inbox, shared })
    }

    /// Replaces the watched files.
    pub fn watch(&self, watched: Watched) {
        locked(&self.shared).waiting += 1;
        // The thread lives as long as the watcher.
        let _ = self.inbox.send(Message::Watch(Box::new(watched)));
    }

    /// Returns true if the thread watches the files of the last call, so that later changes are reported.
    pub fn is_watching(&self) -> bool {
        locked(&self.shared).waiting == 0
    }

    /// Returns and removes the changes since the last call.
    pub fn changes(&self) -> Changes {
        std::mem::take(&mut locked(&self.shared).changes)
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        let _ = self.inbox.send(Message::End);
    }
}

fn locked(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    // Every change of the state is a single assignment, so a panic elsewhere leaves it consistent.
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// State of the thread.
struct WatchThread {
    messages: Receiver<Message>,
    shared: Arc<Mutex<Shared>>,
    wake: Box<dyn Fn() + Send>,
    folders: Folders,
    watched: Watched,
    snapshot: Snapshot,
}

impl WatchThread {
    /// Reports changes until the watcher is dropped.
    fn work(mut self) {
        loop {
            let message = match self.messages.recv_timeout(POLL_INTERVAL) {
                Ok(message) => Some(message),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return,
            };
            let was_reported = matches!(message, Some(Message::Reported(_)));
            let mut pending = Pending::default();
            pending.take(message);
            if was_reported {
                settle(&self.messages, &mut pending, SETTLE_PAUSE, SETTLE_LIMIT);
            }
            if pending.has_ended {
                return;
            }
            self.report_changes(&pending, was_reported);
            if let Some(watched) = pending.watched {
                self.folders.arm(&watched);
                self.snapshot = Snapshot::at(&watched);
                self.watched = watched;
                locked(&self.shared).waiting -= pending.watch_calls;
            }
        }
    }

    fn report_changes(&mut self, pending: &Pending, was_reported: bool) {
        let now = Snapshot::at(&self.watched);
        let changes = now.since(&self.snapshot, &pending.reported).of(&self.watched);
        self.snapshot = now;
        if changes.is_empty() && !was_reported {
            return;
        }
        if !was_reported {
            // Polling found the changes. A watched folder may have been replaced by another folder, which has to be watched again.
            self.folders.disarm();
        }
        self.folders.arm(&self.watched);
        if !changes.is_empty() {
            self.deliver(changes);
        }
    }

    fn deliver(&self, new: Changes) {
        let mut shared = locked(&self.shared);
        let known = &mut shared.changes;
        known.graph |= new.graph;
        known.nodes |= new.nodes;
        known.model |= new.model;
        known.files.extend(new.files);
        drop(shared);
        (self.wake)();
    }
}

/// Messages that were received and not handled yet.
#[derive(Default)]
struct Pending {
    reported: BTreeSet<PathBuf>,
    watched: Option<Watched>,
    /// Number of messages that replace the list of watched files.
    watch_calls: usize,
    has_ended: bool,
}

impl Pending {
    fn take(&mut self, message: Option<Message>) {
        match message {
            Some(Message::Reported(paths)) => self.reported.extend(paths),
            Some(Message::Watch(watched)) => {
                self.watched = Some(*watched);
                self.watch_calls += 1;
            }
            Some(Message::End) => self.has_ended = true,
            None => {}
        }
    }
}

/// Collects messages until none has arrived for the time of a `pause`, since an editor saves in several steps. The wait has
/// a limit, since a folder may be written to all the time; later messages count as another change.
fn settle(messages: &Receiver<Message>, pending: &mut Pending, pause: Duration, limit: Duration) {
    let started = Instant::now();
    while !pending.has_ended
        && let Some(left) = limit.checked_sub(started.elapsed())
        && let Ok(message) = messages.recv_timeout(pause.min(left))
    {
        pending.take(Some(message));
    }
}
