//! An export that is made beside the window's work.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread;

use sabi_engine::{BakeReport, EngineError, Progress, Stage};

/// An export that is being made.
pub(crate) struct Running {
    pub(super) watch: Arc<Watch>,
    pub(super) done: Receiver<Result<BakeReport, EngineError>>,
}

/// How far it is.
#[derive(Default)]
pub(super) struct Watch {
    pub(super) is_canceled: AtomicBool,
    done: AtomicUsize,
    of: AtomicUsize,
    pub(super) stage: Mutex<Option<Stage>>,
}

impl Progress for Watch {
    fn advance(&self, stage: Stage, done: usize, of: usize) {
        if let Ok(mut known) = self.stage.lock() {
            *known = Some(stage);
        }
        self.done.store(done, Ordering::Relaxed);
        self.of.store(of, Ordering::Relaxed);
    }

    fn is_canceled(&self) -> bool {
        self.is_canceled.load(Ordering::Relaxed)
    }
}

impl Watch {
    /// Which part of it all is done.
    pub(super) fn share(&self) -> f32 {
        self.done.load(Ordering::Relaxed) as f32 / self.of.load(Ordering::Relaxed).max(1) as f32
    }
}

impl Running {
    /// Begins a piece of work beside the window.
    pub(crate) fn start(
        context: &egui::Context,
        work: impl FnOnce(&dyn Progress) -> Result<BakeReport, EngineError> + Send + 'static,
    ) -> Running {
        let watch = Arc::new(Watch::default());
        let (sender, done) = channel();
        let (watched, woken) = (watch.clone(), context.clone());
        thread::spawn(move || {
            // A window that was closed meanwhile does not listen.
            let _ = sender.send(work(watched.as_ref()));
            woken.request_repaint();
        });
        Running { watch, done }
    }
}
