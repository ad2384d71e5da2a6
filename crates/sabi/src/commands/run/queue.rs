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

/// Time between two checks whether the run was stopped.
const LOOK: Duration = Duration::from_millis(100);

/// Event of an item.
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

/// Items that wait, and items that are being baked.
pub(super) struct Queue<'a> {
    arguments: &'a RunArguments,
    trusted: &'a TrustedPaths,
    waiting: VecDeque<usize>,
    /// Standard inputs of the items that are being baked; closing one stops its item.
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

    /// Starts as many items as may run at the same time, and waits for the next event; `None` once all have ended. A stopped run
    /// starts no items, and waits until those that are being baked have cleaned up.
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
                // This process holds a sender too, so the channel cannot be closed.
                Err(RecvTimeoutError::Disconnected) => return None,
            }
        }
    }

    fn start(&mut self, item: usize) {
        let sender = self.sender.clone();
        let tell = move |happened: Happened| {
            // Sending fails once the run has ended, which does not matter.
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
