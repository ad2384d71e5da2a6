//! Evaluation of a graph while it is edited: a window submits requests and takes events with results as they arrive.
//!
//! One worker thread owns all evaluation, so that the window never blocks. It keeps the model at two sizes, evaluates on the
//! coarse one first, and caches results by their keys: an edit evaluates only the changed nodes and those downstream.

mod evaluation_error;
mod event;
mod flat_picture;
mod flattened_request;
mod graph_update;
mod groups;
mod loaded_model;
mod model_reading;
mod precedence;
mod queue;
mod request;
mod sized_model;
mod thumbnail_renderer;
mod worker;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::JoinHandle;

use sabi_gpu::Gpu;
use sabi_graph::NodeRef;

use crate::error::{EngineError, ErrorKind};
use crate::phases::Activity;
use crate::remedy::Remedy;
pub use event::{BlockedNode, GraphFaults, InspectedResult, LiveEvent, LiveModel, LiveTimes, NodeFault};
pub use graph_update::GraphUpdate;
pub use precedence::Precedence;
use queue::{DroppedPictures, WorkerQueue};
pub use request::{LiveOptions, LiveRequest, ViewSubject};
pub use thumbnail_renderer::THUMBNAIL_VERSION;
use worker::Worker;

/// Evaluator of a graph that is being edited. Dropping it cancels the work at its next step and joins the thread.
pub struct Live {
    queue: Arc<WorkerQueue>,
    worker: Option<JoinHandle<()>>,
}

impl Live {
    /// Starts the worker thread. `wake` is called after each event, and when a picture of the model has more to
    /// show.
    pub fn start(gpu: Arc<Gpu>, options: LiveOptions, wake: impl Fn() + Send + Sync + 'static) -> Live {
        let queue = Arc::new(WorkerQueue::new(&options));
        let worker = Worker::new(gpu, options, queue.clone(), Arc::new(wake));
        let started = std::thread::Builder::new()
            .name("sabi live".to_owned())
            .spawn(move || worker.work());
        if let Err(error) = &started {
            let why = format!("the system gives no thread to evaluate the graph on ({error})");
            let lost = EngineError::new(ErrorKind::OutOfMemory, why).with_remedies([Remedy::CloseOtherPrograms]);
            queue.send(LiveEvent::Lost(lost));
            queue.close();
        }
        Live {
            queue,
            worker: started.ok(),
        }
    }

    /// Replaces the previous request, whose update of the graph is still applied. Work that becomes obsolete ends at its next step.
    pub fn submit(&self, request: LiveRequest) {
        self.queue.submit(request);
    }

    /// Records that the window has dropped pictures, so that they are sent again when they are requested again. Otherwise
    /// pictures are sent only when they change.
    pub fn mark_dropped(&self, subjects: Vec<ViewSubject>, thumbnails: Vec<NodeRef>) {
        self.queue.mark_dropped(DroppedPictures { subjects, thumbnails });
    }

    /// Returns and removes the events since the last call, oldest first.
    pub fn take_events(&self) -> Vec<LiveEvent> {
        self.queue.take_events()
    }

    /// Returns the activity of the worker; `None` while it has none.
    pub fn activity(&self) -> Option<Activity> {
        self.queue.activity.get()
    }

    /// Returns true while the shade of the model is being computed, which happens after its pictures.
    pub fn is_finding_shade(&self) -> bool {
        self.queue.shade_searches.load(Ordering::Relaxed) > 0
    }

    /// Returns true if more events will follow.
    pub fn is_busy(&self) -> bool {
        self.queue.is_busy()
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.queue.close();
        if let Some(worker) = self.worker.take() {
            // A worker that panicked has reported it in its last event.
            let _ = worker.join();
        }
    }
}
