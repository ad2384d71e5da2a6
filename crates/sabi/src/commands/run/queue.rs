//! Items that are baked at the same time.

use std::collections::VecDeque;
use std::process::ChildStdin;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use super::item_process::{Ended, ended, start};
use crate::arguments::RunArguments;
use crate::exit::{Exit, Failure};

/// Time between two looks at whether the run was stopped.
const LOOK: Duration = Duration::from_millis(100);

/// Items that wait and those that are baked.
pub(super) struct Queue<'a> {
    arguments: &'a RunArguments,
    waiting: VecDeque<usize>,
    /// Items that are baked; closing its input stops one.
    running: Vec<(usize, Option<ChildStdin>)>,
    sender: Sender<(usize, Ended)>,
    ends: Receiver<(usize, Ended)>,
}

impl<'a> Queue<'a> {
    pub(super) fn new(arguments: &'a RunArguments, waiting: &[usize]) -> Queue<'a> {
        let (sender, ends) = mpsc::channel();
        Queue {
            arguments,
            waiting: waiting.iter().copied().collect(),
            running: Vec::new(),
            sender,
            ends,
        }
    }

    /// Starts as many items as run at a time, and waits for the next that ends; `None` once all have. A run that is stopped starts
    /// none, and waits until those that are baked have cleaned up.
    pub(super) fn next_ended(&mut self, is_canceled: impl Fn() -> bool) -> Option<(usize, Ended)> {
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
            match self.ends.recv_timeout(LOOK) {
                Ok((item, ended)) => {
                    self.running.retain(|(running, _)| *running != item);
                    return Some((item, ended));
                }
                Err(RecvTimeoutError::Timeout) => {}
                // This end of the channel has a sender, too.
                Err(RecvTimeoutError::Disconnected) => return None,
            }
        }
    }

    fn start(&mut self, item: usize) {
        let sender = self.sender.clone();
        let tell = move |ended: Ended| {
            // Nobody listens to a run that has ended.
            let _ = sender.send((item, ended));
        };
        match start(self.arguments, item) {
            Ok((child, input)) => {
                self.running.push((item, input));
                thread::spawn(move || tell(ended(child)));
            }
            Err(error) => {
                self.running.push((item, None));
                let why = format!("no process can be started for the item: {error}");
                tell(Ended::Failed(Failure::new(Exit::Defect, why)));
            }
        }
    }
}
