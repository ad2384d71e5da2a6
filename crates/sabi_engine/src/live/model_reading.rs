//! Reading of a model on a separate thread, so that the worker need not wait for a model that is no longer wanted.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use super::queue::WorkerQueue;
use crate::error::EngineError;
use crate::opening::linked_model::LinkedModel;
use crate::phases::{Phase, Progress, stop_if_canceled, unless_left};

/// Interval for checking whether the reading of an abandoned model has ended.
const LOOK_AGAIN: Duration = Duration::from_millis(20);

/// Time for which the next model waits for the end of an abandoned one. The flattening of one huge chart cannot be interrupted.
const WAITS_FOR: Duration = Duration::from_secs(2);
/// Abandoned models that may be at work while another one is read.
const MOST_LEFT: usize = 2;

/// Reading of models, one after another. The reading of an abandoned model ends at its next check, on its own thread. The next
/// model waits a moment for that, and however long it takes while several are at work, so that few models take memory.
#[derive(Default)]
pub(super) struct ModelReading {
    left: Vec<JoinHandle<()>>,
}

/// Progress of reading a model. It is canceled once another model is requested.
pub(super) struct LoadProgress {
    queue: Arc<WorkerQueue>,
    model_revision: u64,
    is_left: AtomicBool,
}

impl LoadProgress {
    pub(super) fn new(queue: &Arc<WorkerQueue>, model_revision: u64) -> LoadProgress {
        LoadProgress {
            queue: queue.clone(),
            model_revision,
            is_left: AtomicBool::new(false),
        }
    }

    fn is_unwanted(&self) -> bool {
        self.is_left.load(Ordering::Relaxed) || self.queue.is_other_model_requested(self.model_revision)
    }
}

impl Progress for LoadProgress {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        if !self.is_left.load(Ordering::Relaxed) {
            self.queue.activity.set(phase, done, of);
        }
    }

    fn is_canceled(&self) -> bool {
        if !self.is_left.load(Ordering::Relaxed) {
            self.queue.wait_for_turn();
        }
        self.is_unwanted()
    }
}

impl ModelReading {
    /// Reads a model by `work`.
    ///
    /// # Errors
    /// The error of the work, or one of kind `Interrupted` as soon as another model is requested.
    pub(super) fn read(
        &mut self,
        progress: &Arc<LoadProgress>,
        work: impl FnOnce(&dyn Progress) -> Result<LinkedModel, EngineError> + Send + 'static,
    ) -> Result<LinkedModel, EngineError> {
        progress.advance(Phase::Load, 0, 1);
        let begun = Instant::now();
        self.left.retain(|left| !left.is_finished());
        while self.left.len() > MOST_LEFT || !self.left.is_empty() && begun.elapsed() < WAITS_FOR {
            stop_if_canceled(&ReadCancelation(progress))?;
            sleep(LOOK_AGAIN);
            self.left.retain(|left| !left.is_finished());
        }
        let shared = progress.clone();
        match unless_left(&ReadCancelation(progress), move || work(shared.as_ref())) {
            Ok(read) => read,
            Err(stopped) => {
                progress.is_left.store(true, Ordering::Relaxed);
                self.left.extend(stopped.left);
                Err(stopped.error)
            }
        }
    }
}

/// Cancelation of reading, for the thread that waits for it. That thread does not wait for its turn.
struct ReadCancelation<'p>(&'p LoadProgress);

impl Progress for ReadCancelation<'_> {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        self.0.advance(phase, done, of);
    }

    fn is_canceled(&self) -> bool {
        self.0.is_unwanted()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;
    use crate::error::ErrorKind;
    use crate::live::request::LiveOptions;

    fn no_model() -> EngineError {
        EngineError::new(ErrorKind::BadInput, "no model")
    }

    #[test]
    fn reading_of_a_model_that_is_no_longer_wanted_does_not_delay_the_caller() {
        let queue = Arc::new(WorkerQueue::new(&LiveOptions::default()));
        let progress = Arc::new(LoadProgress::new(&queue, 1));
        let mut reading = ModelReading::default();
        let ((begun, begins), (go, told)) = (channel(), channel());
        let closes = queue.clone();
        let closing = std::thread::spawn(move || {
            begins.recv().unwrap();
            closes.close();
        });
        let waiting = move |_: &dyn Progress| {
            begun.send(()).unwrap();
            let _ = told.recv();
            Err(no_model())
        };
        let error = reading.read(&progress, waiting).err();
        assert_eq!(error.map(|error| error.kind), Some(ErrorKind::Interrupted));
        closing.join().unwrap();
        let left = reading.left.pop().unwrap();
        assert!(!left.is_finished(), "it is still at work");
        queue.activity.clear();
        progress.advance(Phase::Atlas, 0, 1);
        assert_eq!(queue.activity.get(), None, "abandoned work reports no progress");
        go.send(()).unwrap();
        left.join().unwrap();
    }

    #[test]
    fn the_next_model_is_read_after_the_abandoned_one_has_ended() {
        let queue = Arc::new(WorkerQueue::new(&LiveOptions::default()));
        let progress = Arc::new(LoadProgress::new(&queue, 1));
        let mut reading = ModelReading::default();
        let (begun, begins) = channel();
        let leaves = progress.clone();
        let leaving = std::thread::spawn(move || {
            begins.recv().unwrap();
            leaves.is_left.store(true, Ordering::Relaxed);
        });
        let looking = move |_: &dyn Progress| {
            begun.send(()).unwrap();
            loop {
                sabi_cancel::look();
                std::thread::yield_now();
            }
        };
        let error = reading.read(&progress, looking).err();
        assert_eq!(error.map(|error| error.kind), Some(ErrorKind::Interrupted));
        leaving.join().unwrap();
        let next = Arc::new(LoadProgress::new(&queue, 2));
        let read = reading.read(&next, |_| Err(no_model()));
        assert_eq!(read.err(), Some(no_model()));
        assert!(reading.left.is_empty(), "the one before has ended");
    }

    #[test]
    fn the_next_model_does_not_wait_for_an_abandoned_one_that_cannot_be_interrupted() {
        let queue = Arc::new(WorkerQueue::new(&LiveOptions::default()));
        let progress = Arc::new(LoadProgress::new(&queue, 1));
        let mut reading = ModelReading::default();
        let ((begun, begins), (go, told)) = (channel(), channel::<()>());
        let leaves = progress.clone();
        let leaving = std::thread::spawn(move || {
            begins.recv().unwrap();
            leaves.is_left.store(true, Ordering::Relaxed);
        });
        let deaf = move |_: &dyn Progress| {
            begun.send(()).unwrap();
            let _ = told.recv();
            Err(no_model())
        };
        assert!(reading.read(&progress, deaf).is_err());
        leaving.join().unwrap();
        let next = Arc::new(LoadProgress::new(&queue, 2));
        let read = reading.read(&next, |_| Err(no_model()));
        assert_eq!(read.err(), Some(no_model()));
        assert!(!reading.left.iter().all(JoinHandle::is_finished), "it is still at work");
        drop(go);
    }

    #[test]
    fn an_error_of_reading_is_that_of_the_work() {
        let queue = Arc::new(WorkerQueue::new(&LiveOptions::default()));
        let progress = Arc::new(LoadProgress::new(&queue, 1));
        let read = ModelReading::default().read(&progress, |_| Err(no_model()));
        assert_eq!(read.err(), Some(no_model()));
        assert_eq!(queue.activity.get().map(|activity| activity.phase), Some(Phase::Load));
    }
}
