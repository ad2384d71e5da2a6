//! Files that change while a session is open: which of those that it hangs on did.
//!
//! The system tells what happens in a folder; where it tells nothing, as it does of shares that others write to, a look at
//! the files every few seconds finds it. Either way only a file that is another one by length or time, or that was told of
//! by name, has changed.

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

/// Nothing has happened for so long: whoever saves is done.
const SETTLE_PAUSE: Duration = Duration::from_millis(30);
/// After so long a look is taken, whether something goes on or not.
const SETTLE_LIMIT: Duration = Duration::from_millis(300);
/// How often a look is taken although nothing was told.
const LOOK_EVERY: Duration = Duration::from_secs(2);

/// Files that a session hangs on. They need not be there: that one comes is a change, too.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watched {
    /// The graph's own file.
    pub graph: Option<PathBuf>,
    /// Folders of nodes.
    pub nodes: Vec<PathBuf>,
    /// Files that the model is read from. A folder stands for what comes and goes in it.
    pub model: Vec<PathBuf>,
    /// What else a session hangs on: pictures and group files that the graph names, and the library. A folder stands for what
    /// comes and goes in it.
    pub files: Vec<PathBuf>,
}

/// What of it has changed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Whether the graph's own file did, whoever wrote it.
    pub graph: bool,
    /// Whether a node file did.
    pub nodes: bool,
    /// Whether a file of the model did.
    pub model: bool,
    /// The others that did, named as they are in [`Watched::files`].
    pub files: BTreeSet<PathBuf>,
}

impl Changes {
    /// Whether nothing has changed.
    pub fn is_empty(&self) -> bool {
        *self == Changes::default()
    }
}

/// Watches files on a thread of its own, so that no window waits for a slow disk.
pub struct Watcher {
    inbox: Sender<Message>,
    shared: Arc<Mutex<Shared>>,
}

/// What lies between those who want to know and the thread.
#[derive(Default)]
struct Shared {
    changes: Changes,
    /// How many calls of [`Watcher::watch`] the thread has not come to.
    waiting: usize,
}

enum Message {
    /// Watch these from now on.
    Watch(Box<Watched>),
    /// Something happened to these files.
    Told(Vec<PathBuf>),
    /// Nobody wants to know any more.
    End,
}

impl Watcher {
    /// Starts watching nothing yet; `wake` is called on the watcher's thread when something has changed.
    ///
    /// # Errors
    /// The system gives no thread.
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
        // It is not waited for at the end: a share that does not answer would keep the window from closing.
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

    /// Watches these files and no others from now on.
    pub fn watch(&self, watched: Watched) {
        locked(&self.shared).waiting += 1;
        // The thread is there as long as this is.
        let _ = self.inbox.send(Message::Watch(Box::new(watched)));
    }

    /// Whether it has come to the files that it was given last: what changes from here on is told.
    pub fn is_watching(&self) -> bool {
        locked(&self.shared).waiting == 0
    }

    /// What has changed since the last call.
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
    // What is in it is put in whole, so a panic elsewhere leaves nothing half made.
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What the thread holds.
struct Watching {
    messages: Receiver<Message>,
    shared: Arc<Mutex<Shared>>,
    wake: Box<dyn Fn() + Send>,
    folders: Folders,
    watched: Watched,
    look: Look,
}

impl Watching {
    /// Tells of changes until nobody wants to know any more.
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
            // Nobody said so: a folder that is listened to may have been put away and another one in its place.
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

/// What has come through the channel.
#[derive(Default)]
struct Heard {
    told: BTreeSet<PathBuf>,
    watched: Option<Watched>,
    /// How many of those came.
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

/// Waits until nothing has come for the time of a `pause`: an editor saves in several steps, which arrive together. A folder
/// that something writes to all the time never comes to rest, so the wait has a limit; what comes later is another change.
fn settle(messages: &Receiver<Message>, heard: &mut Heard, pause: Duration, limit: Duration) {
    let started = Instant::now();
    while !heard.is_over
        && let Some(left) = limit.checked_sub(started.elapsed())
        && let Ok(message) = messages.recv_timeout(pause.min(left))
    {
        heard.take(Some(message));
    }
}
