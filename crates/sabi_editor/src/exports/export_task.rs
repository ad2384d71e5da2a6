//! An export on a thread of its own.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use egui::Context;
use sabi_engine::EngineError;
use sabi_engine::baking::BakeReport;
use sabi_engine::phases::{Activity, Phase, Progress, SharedActivity};

use crate::notices::with_capital;
use crate::task::{Task, TaskFailure};

/// An export on a thread of its own. Dropping it cancels it and waits for its end.
pub(crate) struct ExportTask {
    watch: Arc<ExportProgress>,
    task: Task<Result<BakeReport, EngineError>>,
    /// Folder that it writes to.
    pub(crate) folder: PathBuf,
    /// True if its result is added to that of the previous export.
    pub(crate) continues: bool,
}

/// Progress of an export, shared with its thread.
#[derive(Default)]
struct ExportProgress {
    is_canceled: AtomicBool,
    activity: SharedActivity,
    /// Sentence about what it waits for, until it goes on.
    waits_for: Mutex<Option<String>>,
}

impl ExportProgress {
    fn waits_for(&self) -> MutexGuard<'_, Option<String>> {
        // A panic leaves no half-changed value, since every change is a single assignment.
        self.waits_for.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for ExportProgress {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        *self.waits_for() = None;
        self.activity.set(phase, done, of);
    }

    fn waits(&self, sentence: &str) {
        *self.waits_for() = Some(with_capital(sentence));
    }

    fn is_canceled(&self) -> bool {
        self.is_canceled.load(Ordering::Relaxed)
    }
}

type BakeWork = dyn FnOnce(&dyn Progress) -> Result<BakeReport, EngineError> + Send;

/// An export that can be started.
pub(crate) struct Bake {
    /// Folder that it writes to.
    pub(crate) folder: PathBuf,
    /// True if its result is added to that of the previous export.
    pub(crate) continues: bool,
    pub(crate) work: Box<BakeWork>,
}

impl ExportTask {
    /// Starts an export; `context` draws a frame when it is done.
    pub(crate) fn start(context: &Context, bake: Bake) -> ExportTask {
        let watch = Arc::new(ExportProgress::default());
        let watched = watch.clone();
        let Bake {
            folder,
            continues,
            work,
        } = bake;
        let task = Task::start(context, move || work(watched.as_ref()));
        ExportTask {
            watch,
            task,
            folder,
            continues,
        }
    }

    /// Activity of the export; `None` before it has begun.
    pub(crate) fn activity(&self) -> Option<Activity> {
        self.watch.activity.get()
    }

    /// Sentence about another program that the export waits for; `None` while it is at work.
    pub(crate) fn waits_for(&self) -> Option<String> {
        self.watch.waits_for().clone()
    }

    /// Asks the export to end; [`ExportTask::poll`] says when it has.
    pub(crate) fn cancel(&self) {
        self.watch.is_canceled.store(true, Ordering::Relaxed);
    }

    /// Returns the result of the export once, after it has ended.
    pub(crate) fn poll(&self) -> Option<Result<Result<BakeReport, EngineError>, TaskFailure>> {
        self.task.poll()
    }
}

impl Drop for ExportTask {
    fn drop(&mut self) {
        self.cancel();
    }
}
