//! Worker thread: answers the latest request step by step.

mod faults;
mod inspect;
mod model;
mod show;
mod thumbnails;

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use sabi_files::Refusal;
use sabi_gpu::Gpu;
use sabi_graph::NodeRef;

use super::evaluation_error::EvaluationError;
use super::event::{GraphFaults, LiveEvent, LiveModel, LiveTimes};
use super::flattened_request::FailedNode;
use super::loaded_model::LoadedModel;
use super::model_reading::ModelReading;
use super::queue::WorkerQueue;
use super::request::{LiveOptions, LiveRequest, ViewSubject};
use super::sized_model::RunTotals;
use super::thumbnail_renderer::ThumbnailRenderer;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;

/// Hash of what a picture shows.
pub(super) type PictureHash = [u8; 32];

/// State of the worker thread.
pub(super) struct Worker {
    pub(super) gpu: Arc<Gpu>,
    pub(super) options: LiveOptions,
    pub(super) queue: Arc<WorkerQueue>,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// Graph of the last request.
    graph: Arc<OpenGraph>,
    /// Last model that was loaded successfully.
    pub(super) loaded: Option<LoadedModel>,
    pub(super) reading: ModelReading,
    /// Revision of the last model that was tried.
    pub(super) tried: Option<u64>,
    pub(super) sent: SentEvents,
    /// Nodes whose results could not be made, by id.
    pub(super) failed_nodes: BTreeMap<String, FailedNode>,
    pub(super) thumbnail_renderer: Option<ThumbnailRenderer>,
    /// Time that the last full picture took.
    pub(super) full_duration: Option<Duration>,
    /// Revision of the model whose shade was computed last, and for how many sizes.
    shaded: Option<(Option<u64>, usize)>,
}

/// Hashes of everything that was sent, so that nothing is sent twice.
#[derive(Default)]
pub(super) struct SentEvents {
    pub(super) looks: BTreeMap<ViewSubject, SentLooks>,
    pub(super) thumbnails: BTreeMap<NodeRef, PictureHash>,
    pub(super) inspected: BTreeMap<NodeRef, PictureHash>,
    pub(super) faults: Option<GraphFaults>,
    pub(super) files: Option<(BTreeSet<PathBuf>, Vec<Refusal>)>,
}

/// Picture that a viewport shows.
#[derive(Clone, Copy, Default)]
pub(super) struct SentLooks {
    /// Hash of the coarse picture. It is kept after the full picture has been sent.
    pub(super) coarse: Option<PictureHash>,
    /// Hash of the full picture, once it was sent.
    pub(super) full: Option<PictureHash>,
    /// True if no result was missing.
    pub(super) is_whole: bool,
}

/// Work on one request.
pub(super) struct Job {
    pub(super) request: LiveRequest,
    pub(super) graph: Arc<OpenGraph>,
    pub(super) submitted: Instant,
    pub(super) totals: RunTotals,
    pub(super) latency: Option<Duration>,
    /// Hashes of the coarse pictures of this request.
    pub(super) coarse_keys: BTreeMap<ViewSubject, PictureHash>,
    /// True if the full picture comes first. The first picture is always finished.
    pub(super) is_full_first: bool,
}

impl Worker {
    pub(super) fn new(
        gpu: Arc<Gpu>,
        options: LiveOptions,
        queue: Arc<WorkerQueue>,
        wake: Arc<dyn Fn() + Send + Sync>,
    ) -> Worker {
        Worker {
            gpu,
            options,
            queue,
            wake,
            graph: Arc::new(OpenGraph::empty("")),
            loaded: None,
            reading: ModelReading::default(),
            tried: None,
            sent: SentEvents::default(),
            failed_nodes: BTreeMap::new(),
            thumbnail_renderer: None,
            full_duration: None,
            shaded: None,
        }
    }

    /// Answers requests until the queue is closed or the device is lost.
    pub(super) fn work(self) {
        let mut worker = PanicGuard(self);
        while let Some((request, submitted)) = worker.0.queue.next() {
            let revision = request.revision;
            // A panic may leave the state inconsistent, so the reset drops it.
            match catch_unwind(AssertUnwindSafe(|| worker.0.answer(request, submitted))) {
                Ok(Ok(())) => {}
                Ok(Err(loss)) => {
                    worker.0.queue.close();
                    worker.0.send(LiveEvent::Lost(loss));
                    return;
                }
                Err(_) => worker.0.reset(revision),
            }
        }
    }

    /// Drops all state after a panic; the next request is answered from the beginning.
    fn reset(&mut self, revision: u64) {
        self.loaded = None;
        self.tried = None;
        self.sent = SentEvents::default();
        self.failed_nodes.clear();
        self.thumbnail_renderer = None;
        self.full_duration = None;
        let why = "the evaluation of the graph failed, which is a defect of Sabi; undo the last edit, or continue with \
                   something else";
        self.fail(revision, EngineError::new(ErrorKind::Defect, why));
    }

    pub(super) fn send(&self, event: LiveEvent) {
        self.queue.send(event);
        (self.wake)();
    }

    /// Returns an error if a newer request is pending.
    pub(super) fn stop_if_superseded(&self) -> Result<(), EvaluationError> {
        if self.queue.is_superseded() {
            return Err(EvaluationError::Superseded);
        }
        Ok(())
    }

    /// Answers one request; an error is the loss of the device.
    fn answer(&mut self, mut request: LiveRequest, submitted: Instant) -> Result<(), EngineError> {
        let revision = request.revision;
        self.forget_dropped();
        if let Err(defect) = std::mem::take(&mut request.graph).apply(&mut self.graph) {
            self.fail(revision, defect);
            return Ok(());
        }
        let mut job = Job {
            request,
            graph: self.graph.clone(),
            submitted,
            totals: RunTotals::default(),
            latency: None,
            coarse_keys: BTreeMap::new(),
            is_full_first: false,
        };
        let outcome = self.answer_by_priority(&mut job);
        if outcome.is_ok()
            && let Some(sized) = self.loaded.as_mut().and_then(LoadedModel::best)
        {
            // Built here, since the window needs it for picking and must not be blocked.
            sized.model.linked.hierarchy();
            self.find_shade();
        }
        if job.totals.steps + job.totals.cache_hits > 0 {
            self.send_times(&job);
        }
        match outcome {
            Ok(()) => self.send(LiveEvent::Done { revision }),
            Err(EvaluationError::Superseded) => {}
            Err(EvaluationError::Lost(loss)) => return Err(loss),
            Err(EvaluationError::Failed(error)) => self.fail(revision, error),
            Err(EvaluationError::Node { why, .. }) => self.fail(revision, EngineError::new(ErrorKind::BadInput, why)),
        }
        Ok(())
    }

    /// Computes the shade of the loaded model.
    fn find_shade_now(&self) {
        for sized in self.loaded.iter().flat_map(LoadedModel::sizes) {
            let model = &sized.model;
            if !model.view.has_shade() {
                let shade = model.linked.shade(self.options.cache_dir.as_deref());
                // If there is no memory for it, pictures are drawn without shade.
                let _ = model.view.set_shade(&self.gpu, shade.ground, shade.openness);
            }
        }
    }

    /// Computes the shade of the loaded model on a separate thread, since it would delay an edit too long.
    fn find_shade(&mut self) {
        let models: Vec<Arc<LiveModel>> = self
            .loaded
            .iter()
            .flat_map(LoadedModel::sizes)
            .map(|sized| sized.model.clone())
            .filter(|model| !model.view.has_shade())
            .collect();
        let revision = self.loaded.as_ref().map(|loaded| loaded.revision);
        let sizes = models.len();
        if !self.options.finds_shade || sizes == 0 || self.shaded == Some((revision, sizes)) {
            return;
        }
        self.shaded = Some((revision, sizes));
        let (gpu, wake, cache_dir) = (self.gpu.clone(), self.wake.clone(), self.options.cache_dir.clone());
        let search = ShadeSearch::begin(&self.queue);
        let find = move || {
            for model in models {
                let shade = model.linked.shade(cache_dir.as_deref());
                // If there is no memory for it, or no device, the picture stays as it is.
                let _ = model.view.set_shade(&gpu, shade.ground, shade.openness);
                wake();
            }
            drop(search);
            wake();
        };
        // If no thread can be started, the picture stays as it is.
        let _ = std::thread::Builder::new().name("sabi shade".to_owned()).spawn(find);
    }

    /// Forgets that pictures which the window has dropped were sent.
    fn forget_dropped(&mut self) {
        let dropped = self.queue.take_dropped();
        for subject in &dropped.subjects {
            self.sent.looks.remove(subject);
        }
        for node in &dropped.thumbnails {
            self.sent.thumbnails.remove(node);
        }
    }

    /// Ends a request that could not be answered.
    fn fail(&self, revision: u64, error: EngineError) {
        self.send(LiveEvent::Failed { revision, error });
        self.send(LiveEvent::Done { revision });
    }

    /// Sends all results of a request, the most visible first.
    fn answer_by_priority(&mut self, job: &mut Job) -> Result<(), EvaluationError> {
        let flattened = self.flatten(job);
        self.load_first(job)?;
        let Some(flattened) = flattened else {
            self.stop_if_superseded()?;
            return self.load_full(job);
        };
        self.set_graph(job, &flattened)?;
        if self.options.finds_shade_first {
            self.find_shade_now();
        }
        let failed_nodes = self.failed_nodes.len();
        self.show_first(job, &flattened)?;
        if self.failed_nodes.len() != failed_nodes {
            self.send_faults(job, &flattened);
        }
        if job.request.is_moving {
            self.show_full(job, &flattened)?;
            self.show_thumbnails(job, &flattened)?;
        } else {
            self.show_thumbnails(job, &flattened)?;
            self.show_full(job, &flattened)?;
        }
        self.show_thumbnail_of_outputs(job, &flattened)?;
        self.inspect(job, &flattened)?;
        if let Some(sized) = self.loaded.as_mut().and_then(LoadedModel::first) {
            sized.check_solidity();
        }
        self.send_faults(job, &flattened);
        Ok(())
    }

    fn send_times(&self, job: &Job) {
        let sizes = self.loaded.iter().flat_map(LoadedModel::sizes);
        let (texture_bytes, budget_bytes) = sizes
            .map(|sized| sized.cache.bytes())
            .fold((0, 0), |(held, allowed), (more, most)| (held + more, allowed + most));
        let times = LiveTimes {
            nodes: job
                .totals
                .nodes
                .iter()
                .map(|(node, time)| (node.clone(), *time))
                .collect(),
            steps: job.totals.steps,
            cache_hits: job.totals.cache_hits,
            texture_bytes,
            budget_bytes,
            latency: job.latency,
        };
        self.send(LiveEvent::Times {
            revision: job.request.revision,
            times,
        });
    }
}

/// Records, until it is dropped, that the shade of a model is being computed.
struct ShadeSearch(Arc<WorkerQueue>);

impl ShadeSearch {
    fn begin(queue: &Arc<WorkerQueue>) -> ShadeSearch {
        queue.shade_searches.fetch_add(1, Ordering::Relaxed);
        ShadeSearch(queue.clone())
    }
}

impl Drop for ShadeSearch {
    fn drop(&mut self) {
        self.0.shade_searches.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Guard that reports a panic of the worker as an event, since the window would wait forever otherwise.
struct PanicGuard(Worker);

impl Drop for PanicGuard {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let why = "the evaluation of the graph failed; this is a defect of Sabi";
            self.0.queue.close();
            self.0.send(LiveEvent::Lost(EngineError::new(ErrorKind::Defect, why)));
        }
    }
}
