//! An export that is made beside the window's work.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use sabi_engine::{BakeReport, EngineError, Phase, Progress};

use crate::errand::Errand;

/// An export that is being made. Dropping it cancels it and waits for that.
pub(crate) struct Running {
    pub(super) watch: Arc<Watch>,
    pub(super) errand: Errand<Result<BakeReport, EngineError>>,
    /// Where its textures go.
    pub(crate) folder: PathBuf,
}

/// How far it is.
#[derive(Default)]
pub(super) struct Watch {
    pub(super) is_canceled: AtomicBool,
    done: AtomicUsize,
    of: AtomicUsize,
    pub(super) phase: Mutex<Option<Phase>>,
}

impl Progress for Watch {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        if let Ok(mut known) = self.phase.lock() {
            *known = Some(phase);
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

type BakeWork = dyn FnOnce(&dyn Progress) -> Result<BakeReport, EngineError> + Send;

/// A bake that can be begun beside the window.
pub(crate) struct Bake {
    /// Where its textures go.
    pub(crate) folder: PathBuf,
    pub(crate) work: Box<BakeWork>,
}

impl Running {
    /// Begins a piece of work beside the window.
    pub(crate) fn start(context: &egui::Context, bake: Bake) -> Running {
        let watch = Arc::new(Watch::default());
        let watched = watch.clone();
        let Bake { folder, work } = bake;
        let errand = Errand::start(context, move || work(watched.as_ref()));
        Running { watch, errand, folder }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.watch.is_canceled.store(true, Ordering::Relaxed);
    }
}
