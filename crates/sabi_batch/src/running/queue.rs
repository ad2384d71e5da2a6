//! Items that are baked at the same time.

use std::collections::VecDeque;
use std::io;
use std::process::{ChildStdin, Command};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use sabi_engine::{EngineError, ErrorKind};
use sabi_files::io_reason;

use super::item_process::{ProcessEnd, end_of, start};

/// Time between two checks whether the run was stopped.
const LOOK: Duration = Duration::from_millis(100);

/// Event of an item.
#[derive(Debug)]
pub enum ItemEvent {
    /// Line that its process wrote to standard error.
    Line(String),
    /// End of its process; an error of kind `Defect` if it could not be started or waited for.
    Ended(Result<ProcessEnd, EngineError>),
}

/// Items that wait, and items that are being baked.
pub struct Queue<'a> {
    /// Returns the command that bakes an item.
    command: Box<dyn Fn(usize) -> io::Result<Command> + 'a>,
    /// Maximum number of items that are baked at the same time.
    jobs: usize,
    waiting: VecDeque<usize>,
    /// Standard inputs of the items that are being baked; closing one stops its item.
    running: Vec<(usize, Option<ChildStdin>)>,
    sender: Sender<(usize, ItemEvent)>,
    events: Receiver<(usize, ItemEvent)>,
}

impl<'a> Queue<'a> {
    /// Creates a queue of items, of which at most `jobs` are baked at the same time. `command` returns the command that bakes an item; it is
    /// to stop once its standard input is closed.
    pub fn new(
        waiting: impl IntoIterator<Item = usize>,
        jobs: usize,
        command: impl Fn(usize) -> io::Result<Command> + 'a,
    ) -> Queue<'a> {
        let (sender, events) = mpsc::channel();
        Queue {
            command: Box::new(command),
            jobs,
            waiting: waiting.into_iter().collect(),
            running: Vec::new(),
            sender,
            events,
        }
    }

    /// Starts as many items as may run at the same time, and waits for the next event, given with its item; `None` once all have ended. A
    /// stopped run starts no items, and waits until those that are being baked have cleaned up.
    pub fn next(&mut self, is_canceled: impl Fn() -> bool) -> Option<(usize, ItemEvent)> {
        loop {
            if is_canceled() {
                self.waiting.clear();
                for (_, input) in &mut self.running {
                    drop(input.take());
                }
            }
            while self.running.len() < self.jobs
                && let Some(item) = self.waiting.pop_front()
            {
                self.start(item);
            }
            if self.running.is_empty() {
                return None;
            }
            match self.events.recv_timeout(LOOK) {
                Ok((item, event)) => {
                    if matches!(event, ItemEvent::Ended(_)) {
                        self.running.retain(|(running, _)| *running != item);
                    }
                    return Some((item, event));
                }
                Err(RecvTimeoutError::Timeout) => {}
                // This process holds a sender too, so the channel cannot be closed.
                Err(RecvTimeoutError::Disconnected) => return None,
            }
        }
    }

    fn start(&mut self, item: usize) {
        let sender = self.sender.clone();
        let tell = move |event: ItemEvent| {
            // Sending fails once the run has ended, which does not matter.
            let _ = sender.send((item, event));
        };
        let failed = |why: &str, error: &io::Error| {
            let why = format!("{why}: {}", io_reason(error));
            ItemEvent::Ended(Err(EngineError::new(ErrorKind::Defect, why)))
        };
        match (self.command)(item).and_then(|mut command| start(&mut command)) {
            Ok((child, input)) => {
                self.running.push((item, input));
                thread::spawn(move || {
                    let end = end_of(child, |line| tell(ItemEvent::Line(line)));
                    let unknown = |error| failed("it cannot be told how the item ended", &error);
                    tell(end.map_or_else(unknown, |end| ItemEvent::Ended(Ok(end))));
                });
            }
            Err(error) => {
                self.running.push((item, None));
                tell(failed("no process can be started for the item", &error));
            }
        }
    }
}
