//! Items that are baked at the same time.

use std::collections::VecDeque;
use std::process::ChildStdin;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use sabi_engine::{Phase, TrustedPaths, io_reason};

use super::item_process::{Ended, ended, start};
use crate::arguments::RunArguments;
use crate::exit::{Exit, Failure};

/// Time between two looks at whether the run was stopped.
const LOOK: Duration = Duration::from_millis(100);

/// Something that happened to an item.
#[derive(Debug)]
pub(super) enum Happened {
    /// Steps of a phase are done.
    Step {
        phase: Phase,
        done: usize,
        of: usize,
    },
    Ended(Ended),
}

/// Items that wait and those that are baked.
pub(super) struct Queue<'a> {
    arguments: &'a RunArguments,
    trusted: &'a TrustedPaths,
    waiting: VecDeque<usize>,
    /// Items that are baked; closing its input stops one.
    running: Vec<(usize, Option<ChildStdin>)>,
    sender: Sender<(usize, Happened)>,
    happened: Receiver<(usize, Happened)>,
}

impl<'a> Queue<'a> {
    pub(super) fn new(arguments: &'a RunArguments, trusted: &'a TrustedPaths, waiting: &[usize]) -> Queue<'a> {
        let (sender, happened) = mpsc::channel();
        Queue {
            arguments,
            trusted,
            waiting: waiting.iter().copied().collect(),
            running: Vec::new(),
            sender,
            happened,
        }
    }

    /// Starts as many items as run at a time, and waits for what happens next; `None` once all have ended. A run that is stopped
    /// starts none, and waits until those that are baked have cleaned up.
    pub(super) fn next(&mut self, is_canceled: impl Fn() -> bool) -> Option<(usize, Happened)> {
        loop {
            if is_canceled() {
                self.waiting.clear();
                for (_, input) in &mut self.running {
                    drop(input.take());
                }
            }
            while self.running.len() < self.arguments.jobs as usize
                && let Some(item) = self.waiting.pop_front()
            {
                self.start(item);
            }
            if self.running.is_empty() {
                return None;
            }
            match self.happened.recv_timeout(LOOK) {
                Ok((item, happened)) => {
                    if matches!(happened, Happened::Ended(_)) {
                        self.running.retain(|(running, _)| *running != item);
                    }
                    return Some((item, happened));
                }
                Err(RecvTimeoutError::Timeout) => {}
                // This end of the channel has a sender, too.
                Err(RecvTimeoutError::Disconnected) => return None,
            }
        }
    }

    fn start(&mut self, item: usize) {
        let sender = self.sender.clone();
        let tell = move |happened: Happened| {
            // A run that has ended takes no more reports.
            let _ = sender.send((item, happened));
        };
        match start(self.arguments, self.trusted, item) {
            Ok((child, input)) => {
                self.running.push((item, input));
                thread::spawn(move || {
                    let ended = ended(child, |phase, done, of| tell(Happened::Step { phase, done, of }));
                    tell(Happened::Ended(ended));
                });
            }
            Err(error) => {
                self.running.push((item, None));
                let why = format!("no process can be started for the item: {}", io_reason(&error));
                tell(Happened::Ended(Ended::Failed(Failure::new(Exit::Defect, why))));
            }
        }
    }
}
