//! Watcher of the files that a session depends on.
//!
//! The system reports events in folders. Where it does not, as for network shares, polling every few seconds finds changes. In
//! both cases a file has changed if its length or time differs, or if an event named it.

mod folders;
mod look;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use folders::Folders;
use look::Look;

use crate::error::{EngineError, ErrorKind};

/// Debounce after the last file event.
const SETTLE_PAUSE: Duration = Duration::from_millis(30);
/// Longest delay of a look at the files while events go on.
const SETTLE_LIMIT: Duration = Duration::from_millis(300);
/// Interval of polling without events.
const LOOK_EVERY: Duration = Duration::from_secs(2);

/// Files that a session depends on. They need not exist: a file that appears is a change, too.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watched {
    /// File of the graph.
    pub graph: Option<PathBuf>,
    /// Folders of node files.
    pub nodes: Vec<PathBuf>,
    /// Files of the model. A folder stands for its list of entries.
    pub model: Vec<PathBuf>,
    /// Other files: pictures and group files that the graph names, and the library. A folder stands for its list of entries.
    pub files: Vec<PathBuf>,
}

/// Files that have changed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Whether the file of the graph has changed, also by this program.
    pub graph: bool,
    /// Whether a node file has changed.
    pub nodes: bool,
    /// Whether a file of the model has changed.
    pub model: bool,
    /// Other changed files, with their paths in [`Watched::files`].
    pub files: BTreeSet<PathBuf>,
}

impl Changes {
    /// Whether nothing has changed.
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
    Told(Vec<PathBuf>),
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
        let watching = Watching {
            messages,
            shared: shared.clone(),
            wake: Box::new(wake),
            folders: Folders::new(inbox.clone()),
            watched: Watched::default(),
            look: Look::default(),
        };
        // The thread is not joined at the end: a share that does not answer would keep the window from closing.
        let thread = std::thread::Builder::new().name("sabi watch".to_owned());
        let started = thread.spawn(move || watching.work());
        started.map_err(|error| {
            let why = format!(
                "the system gives no thread to watch files on ({error}); files that change are not seen until they are \
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

    /// Whether the thread watches the files of the last call, so that later changes are reported.
    pub fn is_watching(&self) -> bool {
        locked(&self.shared).waiting == 0
    }

    /// Takes the changes since the last call.
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
struct Watching {
    messages: Receiver<Message>,
    shared: Arc<Mutex<Shared>>,
    wake: Box<dyn Fn() + Send>,
    folders: Folders,
    watched: Watched,
    look: Look,
}

impl Watching {
    /// Reports changes until the watcher is dropped.
    fn work(mut self) {
        loop {
            let message = match self.messages.recv_timeout(LOOK_EVERY) {
                Ok(message) => Some(message),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return,
            };
            let was_told = matches!(message, Some(Message::Told(_)));
            let mut heard = Heard::default();
            heard.take(message);
            if was_told {
                settle(&self.messages, &mut heard, SETTLE_PAUSE, SETTLE_LIMIT);
            }
            if heard.is_over {
                return;
            }
            self.look(&heard, was_told);
            if let Some(watched) = heard.watched {
                self.folders.arm(&watched);
                self.look = Look::at(&watched);
                self.watched = watched;
                locked(&self.shared).waiting -= heard.wishes;
            }
        }
    }

    fn look(&mut self, heard: &Heard, was_told: bool) {
        let now = Look::at(&self.watched);
        let changes = now.since(&self.look, &heard.told).of(&self.watched);
        self.look = now;
        if changes.is_empty() && !was_told {
            return;
        }
        if !was_told {
            // Found by polling: a watched folder may have been replaced by another one, which has to be watched again.
            self.folders.disarm();
        }
        self.folders.arm(&self.watched);
        if !changes.is_empty() {
            self.tell(changes);
        }
    }

    fn tell(&self, new: Changes) {
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

/// Messages received from the channel.
#[derive(Default)]
struct Heard {
    told: BTreeSet<PathBuf>,
    watched: Option<Watched>,
    /// Number of such messages.
    wishes: usize,
    is_over: bool,
}

impl Heard {
    fn take(&mut self, message: Option<Message>) {
        match message {
            Some(Message::Told(paths)) => self.told.extend(paths),
            Some(Message::Watch(watched)) => {
                self.watched = Some(*watched);
                self.wishes += 1;
            }
            Some(Message::End) => self.is_over = true,
            None => {}
        }
    }
}

/// Collects messages until none has arrived for the time of a `pause`: an editor saves in several steps. The wait has a limit,
/// since a folder may be written to all the time; later messages are another change.
fn settle(messages: &Receiver<Message>, heard: &mut Heard, pause: Duration, limit: Duration) {
    let started = Instant::now();
    while !heard.is_over
        && let Some(left) = limit.checked_sub(started.elapsed())
        && let Ok(message) = messages.recv_timeout(pause.min(left))
    {
        heard.take(Some(message));
    }
}
