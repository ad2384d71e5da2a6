//! Work on a thread of its own, which the window does not wait for.

use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use egui::Context;

/// Work on a thread of its own. Dropping it waits for its end: a graphics driver that is still working while the
/// program exits in an orderly way would crash it. If that takes too long, the program ends without an orderly exit.
pub(crate) struct Task<T> {
    result: Receiver<T>,
    thread: Option<JoinHandle<()>>,
}

/// The work gave no result: it panicked, or the system gave no thread for it.
pub(crate) struct TaskFailure;

impl<T: Send + 'static> Task<T> {
    /// Starts the work; `context` draws a frame when it is done.
    pub(crate) fn start(context: &Context, work: impl FnOnce() -> T + Send + 'static) -> Task<T> {
        let (sender, result) = channel();
        let woken = context.clone();
        let started = Builder::new().name("sabi task".to_owned()).spawn(move || {
            // Fails where the task was dropped, and its result is not wanted.
            let _ = sender.send(work());
            drop(sender);
            woken.request_repaint();
        });
        Task {
            result,
            thread: started.ok(),
        }
    }

    /// Returns the result of the work once, after it is done.
    pub(crate) fn poll(&self) -> Option<Result<T, TaskFailure>> {
        match self.result.try_recv() {
            Ok(result) => Some(Ok(result)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(TaskFailure)),
        }
    }

    /// Returns the result of the work once, if it is done within this time.
    pub(crate) fn wait(&self, patience: Duration) -> Option<Result<T, TaskFailure>> {
        match self.result.recv_timeout(patience) {
            Ok(result) => Some(Ok(result)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(TaskFailure)),
        }
    }
}

impl<T> Task<T> {
    /// Returns whether the thread has ended.
    pub(crate) fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl<T> Drop for Task<T> {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            // `poll` reports a panic as a missing result.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    use super::*;

    #[test]
    fn dropping_a_task_waits_for_its_end() {
        let is_done = Arc::new(AtomicBool::new(false));
        let told = is_done.clone();
        let task = Task::start(&Context::default(), move || {
            std::thread::sleep(Duration::from_millis(50));
            told.store(true, Ordering::SeqCst);
        });
        drop(task);
        assert!(is_done.load(Ordering::SeqCst));
    }

    #[test]
    fn a_task_that_panics_is_reported_as_failed() {
        let task: Task<()> = Task::start(&Context::default(), || panic!("as this test wants"));
        let result = loop {
            if let Some(result) = task.poll() {
                break result;
            }
            std::thread::yield_now();
        };
        assert!(result.is_err());
    }
}
