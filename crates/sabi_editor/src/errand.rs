//! Work that is done beside the window, on a thread of its own.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::{Builder, JoinHandle};

use egui::Context;

/// A piece of work that the window does not wait for. Dropping it waits for its end: a driver that is still at work when the
/// program ends takes it down.
pub(crate) struct Errand<T> {
    coming: Receiver<T>,
    thread: Option<JoinHandle<()>>,
}

/// The work ended without a result: it panicked, or the system gave no thread for it.
pub(crate) struct Failed;

impl<T: Send + 'static> Errand<T> {
    /// Begins the work, and draws the window anew when it is done.
    pub(crate) fn start(context: &Context, work: impl FnOnce() -> T + Send + 'static) -> Errand<T> {
        let (sender, coming) = channel();
        let woken = context.clone();
        let started = Builder::new().name("sabi errand".to_owned()).spawn(move || {
            // Who was told to let go of it does not listen any more.
            let _ = sender.send(work());
            drop(sender);
            woken.request_repaint();
        });
        Errand {
            coming,
            thread: started.ok(),
        }
    }

    /// What came of it, once.
    pub(crate) fn poll(&self) -> Option<Result<T, Failed>> {
        match self.coming.try_recv() {
            Ok(result) => Some(Ok(result)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(Failed)),
        }
    }
}

impl<T> Errand<T> {
    /// Whether nothing is left to wait for.
    pub(crate) fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl<T> Drop for Errand<T> {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            // A panic was told as a result that did not come.
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
    fn letting_go_of_an_errand_waits_for_its_end() {
        let is_done = Arc::new(AtomicBool::new(false));
        let told = is_done.clone();
        let errand = Errand::start(&Context::default(), move || {
            std::thread::sleep(Duration::from_millis(50));
            told.store(true, Ordering::SeqCst);
        });
        drop(errand);
        assert!(is_done.load(Ordering::SeqCst));
    }

    #[test]
    fn an_errand_that_panics_says_that_it_failed() {
        let errand: Errand<()> = Errand::start(&Context::default(), || panic!("as this test wants"));
        let result = loop {
            if let Some(result) = errand.poll() {
                break result;
            }
            std::thread::yield_now();
        };
        assert!(result.is_err());
    }
}
