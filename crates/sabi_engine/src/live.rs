//! A graph that is evaluated while it is worked on: a window wishes, and is told of results as they come.
//!
//! One thread owns all evaluation, so that no window ever waits. It keeps the model at two sizes, evaluates on the coarse one
//! first, and keeps results by what they are: an edit evaluates the nodes that it changes and what hangs below them.

mod evaluation_error;
mod event;
mod faults;
mod flat;
mod groups;
mod inspect;
mod model;
mod queue;
mod request;
mod show;
mod sized_model;
mod thumbnail_renderer;
mod thumbnails;
mod worker;

use std::sync::Arc;
use std::thread::JoinHandle;

use sabi_gpu::Gpu;
use sabi_graph::NodeRef;

use crate::error::{EngineError, ErrorKind};
pub use event::{BlockedNode, Faults, Inspected, LiveEvent, LiveModel, LiveTimes, NodeFault, Warning};
use queue::{Forgotten, WorkerQueue};
pub use request::{LiveOptions, LiveRequest, ViewSubject};
use worker::Worker;

/// Evaluates a graph while it is worked on. Dropping it stops the work at its next step and waits for that.
pub struct Live {
    queue: Arc<WorkerQueue>,
    worker: Option<JoinHandle<()>>,
}

impl Live {
    /// Starts the thread that works. `wake` is called there whenever news have come.
    pub fn start(gpu: Arc<Gpu>, options: LiveOptions, wake: impl Fn() + Send + 'static) -> Live {
        let queue = Arc::new(WorkerQueue::default());
        let worker = Worker::new(gpu, options, queue.clone(), Box::new(wake));
        let started = std::thread::Builder::new()
            .name("sabi live".to_owned())
            .spawn(move || worker.work());
        if let Err(error) = &started {
            let why = format!("the system gives no thread to evaluate the graph on ({error}); close other programs");
            queue.tell(LiveEvent::Lost(EngineError::new(ErrorKind::OutOfMemory, why)));
            queue.close();
        }
        Live {
            queue,
            worker: started.ok(),
        }
    }

    /// Wishes for something else than before. Work that is of no use any more ends at its next step.
    pub fn submit(&self, request: LiveRequest) {
        self.queue.submit(request);
    }

    /// Says that pictures were let go of: where they are wished for again, they are told again. What is told once is otherwise
    /// not told a second time as long as it looks the same.
    pub fn forget(&self, subjects: Vec<ViewSubject>, thumbnails: Vec<NodeRef>) {
        self.queue.forget(Forgotten { subjects, thumbnails });
    }

    /// What came since the last call, oldest first.
    pub fn take_events(&self) -> Vec<LiveEvent> {
        self.queue.take_events()
    }

    /// Whether more news are to be expected.
    pub fn is_busy(&self) -> bool {
        self.queue.is_busy()
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.queue.close();
        if let Some(worker) = self.worker.take() {
            // A worker that panicked has said so in its last news.
            let _ = worker.join();
        }
    }
}
