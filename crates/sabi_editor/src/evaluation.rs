//! Client of the engine's evaluation thread: requests of the window, and the newest results.

mod faults;
mod graph;
mod model;
mod results;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui::Context;
use sabi_editing::{NodeKinds, OpenDocument};
use sabi_engine::live::{LiveEvent, LiveOptions, LiveRequest, Precedence, ViewSubject};
use sabi_engine::phases::Activity;
use sabi_engine::{EngineError, Live};
use sabi_export::SetKey;
use sabi_files::Refusal;
use sabi_gpu::{DEFAULT_BUDGET_BYTES, Gpu};
use sabi_graph::NodeRef;

use crate::import_options::ImportOptions;
use faults::NodeFaults;
use graph::GraphTracker;
use model::RequestedModel;
use results::{DroppedResults, EvaluationResults};

pub(crate) use model::ModelOutcome;
pub(crate) use results::ResultPicture;

/// Texels for one unit of UV of a first picture.
const COARSE: u32 = 256;
/// Texels of full pictures where the graph names no size: on software drivers, and on graphics cards.
const FULL: [u32; 2] = [512, 1024];
/// Most texels of full pictures of the model, and of one beside it, which is shown in a part of the view.
const MOST: u32 = 4096;
const MOST_BESIDE: u32 = 512;
/// Rank of the evaluation of models beside the main one.
const RANK_BESIDE: u8 = 1;
/// Rank of the evaluation of trials: pictures of variants and effects that can be chosen.
const RANK_PREVIEWS: u8 = 2;
/// Longest submission of an evaluation in the background, since a frame may have to wait for it.
const SHORT_SUBMISSION: Duration = Duration::from_millis(8);

/// Results of the graph that the window shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct WantedResults {
    pub(crate) subjects: Vec<ViewSubject>,
    /// Result that the 2D view shows.
    pub(crate) inspected: Option<NodeRef>,
    /// Result whose histogram is shown among parameters.
    pub(crate) measured: Option<NodeRef>,
    pub(crate) set: Option<SetKey>,
    pub(crate) thumbnails: Vec<NodeRef>,
    pub(crate) is_flat: bool,
    pub(crate) is_moving: bool,
}

/// Client of the engine's evaluation thread.
pub(crate) struct Evaluation {
    gpu: Arc<Gpu>,
    live: Live,
    /// Order of all evaluations of this window.
    precedence: Precedence,
    /// Most texels of full pictures.
    most_texels: u32,
    cache_dir: Option<PathBuf>,
    pub(crate) model: RequestedModel,
    graph: GraphTracker,
    /// Revisions and wanted results of the last request.
    requested: Option<(Revisions, WantedResults)>,
    /// Number of requests.
    requests: u64,
    /// First revision of the requested file, and the number of the first request for it.
    first_of_file: (u64, u64),
    pub(crate) results: EvaluationResults,
    pub(crate) faults: NodeFaults,
    /// Images and group files that the graph names.
    pub(crate) files: Arc<BTreeSet<PathBuf>>,
    /// Refusals of files that the graph names and may not open.
    pub(crate) refused: Vec<Refusal>,
    /// Error of the last evaluation.
    pub(crate) failure: Option<EngineError>,
    /// Loss of the device.
    pub(crate) lost: Option<EngineError>,
}

/// Revisions that a request was made for.
#[derive(Clone, Debug, PartialEq)]
struct Revisions {
    document: u64,
    kinds: u64,
    model: u64,
    files: u64,
    /// True once the shade of the model is known, with which pictures of nodes are drawn again.
    has_shade: bool,
}

impl Evaluation {
    /// Starts the evaluation on a device; `context` draws a frame when a result arrives.
    pub(crate) fn new(
        gpu: Arc<Gpu>,
        model: &Path,
        import: ImportOptions,
        cache_dir: Option<PathBuf>,
        context: &Context,
    ) -> Evaluation {
        let options = LiveOptions {
            finds_shade: cache_dir.is_some(),
            cache_dir,
            ..LiveOptions::default()
        };
        Evaluation::start(gpu, model, import, options, MOST, context)
    }

    /// Starts the evaluation on a model beside this one: it works only while this one has nothing to do.
    pub(crate) fn beside(&self, model: &Path, import: ImportOptions, context: &Context) -> Evaluation {
        let options = LiveOptions {
            finds_shade: self.finds_shade(),
            cache_dir: self.cache_dir.clone(),
            cache_bytes: DEFAULT_BUDGET_BYTES / 8,
            submission: SHORT_SUBMISSION,
            precedence: self.precedence.clone(),
            rank: RANK_BESIDE,
            ..LiveOptions::default()
        };
        Evaluation::start(self.gpu.clone(), model, import, options, MOST_BESIDE, context)
    }

    /// Starts an evaluator for trials, which draws thumbnails of `thumbnail_px` pixels along a side while all others are
    /// idle.
    pub(crate) fn start_previews(&self, thumbnail_px: u32, context: &Context) -> Live {
        let options = LiveOptions {
            cache_dir: self.cache_dir.clone(),
            cache_bytes: DEFAULT_BUDGET_BYTES / 16,
            submission: SHORT_SUBMISSION,
            thumbnail_px,
            // A picture is drawn once, and with the same shade as in the view.
            finds_shade_first: self.finds_shade(),
            precedence: self.precedence.clone(),
            rank: RANK_PREVIEWS,
            ..LiveOptions::default()
        };
        let context = context.clone();
        Live::start(self.gpu.clone(), options, move || context.request_repaint())
    }

    /// Number that rises with every change of the graph that results depend on.
    pub(crate) fn graph_number(&self) -> u64 {
        self.graph.number
    }

    fn start(
        gpu: Arc<Gpu>,
        model: &Path,
        import: ImportOptions,
        options: LiveOptions,
        most_texels: u32,
        context: &Context,
    ) -> Evaluation {
        let context = context.clone();
        let (precedence, cache_dir) = (options.precedence.clone(), options.cache_dir.clone());
        let live = Live::start(gpu.clone(), options, move || context.request_repaint());
        Evaluation {
            gpu,
            live,
            precedence,
            most_texels,
            model: RequestedModel::new(model, import, FULL[0], cache_dir.as_deref()),
            cache_dir,
            graph: GraphTracker::default(),
            requested: None,
            requests: 0,
            first_of_file: (0, 0),
            results: EvaluationResults::default(),
            faults: NodeFaults::default(),
            files: Arc::default(),
            refused: Vec::new(),
            failure: None,
            lost: None,
        }
    }

    /// Folder of results that are kept between runs.
    pub(crate) fn cache_dir(&self) -> Option<&Path> {
        self.cache_dir.as_deref()
    }

    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// Returns whether results are outstanding.
    pub(crate) fn is_busy(&self) -> bool {
        self.live.is_busy()
    }

    /// Pauses the evaluations in the background for a time, since the window needs the device.
    pub(crate) fn hold_others(&self, for_time: Duration) {
        self.precedence.hold(for_time);
    }

    /// Returns whether the model is drawn with its shade on itself and on the ground.
    pub(crate) fn has_shade(&self) -> bool {
        self.model.received.as_ref().is_some_and(|model| model.view.has_shade())
    }

    /// Returns whether that shade is still to be computed.
    pub(crate) fn awaits_shade(&self) -> bool {
        self.finds_shade() && !self.has_shade() && (self.live.is_busy() || self.live.is_finding_shade())
    }

    /// Returns whether models are drawn with shade. Computing it takes seconds, so that it is only done where a cache
    /// folder keeps it.
    fn finds_shade(&self) -> bool {
        self.cache_dir.is_some()
    }

    /// Activity of the evaluation; `None` while it has none.
    pub(crate) fn activity(&self) -> Option<Activity> {
        self.live.activity()
    }

    /// Returns whether a picture is of another model than the requested one, which is still being read.
    pub(crate) fn is_outdated(&self, picture: &ResultPicture) -> bool {
        self.model.failure.is_none() && picture.model.model_revision < self.model.file_since()
    }

    /// Returns whether the values of the inspected result are of another model.
    pub(crate) fn is_inspected_outdated(&self) -> bool {
        self.results.inspected_since != self.model.file_since()
    }

    /// Sends a request if the graph or the wanted results changed since the last one.
    pub(crate) fn request(&mut self, document: &OpenDocument, wanted: WantedResults) {
        self.model.set_size(self.wanted_size(document));
        self.model.set_trusted(&document.session.graph().trusted);
        let NodeKinds { kinds, revision, .. } = document.node_kinds();
        self.graph.follow(document);
        let revisions = Revisions {
            document: self.graph.number,
            kinds: *revision,
            model: self.model.revision,
            files: document.files_revision(),
            has_shade: self.has_shade(),
        };
        if self
            .requested
            .as_ref()
            .is_some_and(|(before, results)| *before == revisions && *results == wanted)
        {
            return;
        }
        self.results.share_values(&wanted);
        let dropped = self.results.evict(document, &wanted, self.model.revision);
        self.mark_dropped(dropped);
        self.requests += 1;
        if self.first_of_file.0 != self.model.file_since() {
            self.first_of_file = (self.model.file_since(), self.requests);
        }
        self.live.submit(LiveRequest {
            revision: self.requests,
            graph: self.graph.take_unsent(),
            kinds: kinds.clone(),
            kinds_revision: *revision,
            model: self.model.options.clone(),
            model_revision: self.model.revision,
            coarse_size: COARSE,
            subjects: wanted.subjects.clone(),
            inspected: wanted.inspected.iter().chain(&wanted.measured).cloned().collect(),
            set: wanted.set,
            thumbnails: wanted.thumbnails.clone(),
            outputs_thumbnail: false,
            is_flat: wanted.is_flat,
            is_moving: wanted.is_moving,
        });
        self.requested = Some((revisions, wanted));
    }

    /// Texels along a side of full-resolution results, as the document names them or as the device allows.
    fn wanted_size(&self, document: &OpenDocument) -> u32 {
        let usual = match self.gpu.summary().kind {
            sabi_gpu::AdapterKind::Cpu => FULL[0],
            _ => FULL[1],
        };
        let named = document.contents().preview.as_ref().and_then(|preview| preview.size);
        named.unwrap_or(usual).clamp(64, MOST).min(self.most_texels)
    }

    /// Takes over the results that arrived.
    pub(crate) fn take_events(&mut self, context: &Context) {
        // The evaluation reports a loss only while it runs.
        if let Some(loss) = self.gpu.loss() {
            self.lost = Some(loss.into());
        }
        for event in self.live.take_events() {
            match event {
                LiveEvent::Model {
                    model, model_revision, ..
                } => self.model.receive(model_revision, Ok(model)),
                LiveEvent::ModelFailed { error, model_revision } => self.model.receive(model_revision, Err(error)),
                LiveEvent::Looks {
                    subject,
                    model,
                    looks,
                    outputs,
                    ..
                } => {
                    tracing::info!(?subject, texels = model.size, "a picture arrived");
                    self.failure = None;
                    let picture = ResultPicture {
                        model,
                        looks,
                        outputs,
                        number: 0,
                        changed: Vec::new(),
                    };
                    self.results.add_picture(subject, picture);
                }
                LiveEvent::Inspected { revision, node, values } => {
                    let wanted = self.requested.as_ref().map(|(_, wanted)| wanted);
                    let is_inspected = self.results.take_values(wanted, node, values);
                    if is_inspected && revision >= self.first_of_file.1 {
                        self.results.inspected_since = self.first_of_file.0;
                    }
                }
                LiveEvent::Thumbnail { node, picture, .. } => self.results.add_thumbnail(context, node, picture),
                LiveEvent::Files { files, refused, .. } => {
                    self.files = Arc::new(files);
                    self.refused = refused;
                }
                LiveEvent::Faults { faults, .. } => self.faults = NodeFaults::new(faults),
                LiveEvent::Times { times, .. } => self.results.add_times(times),
                LiveEvent::Failed { error, .. } => self.failure = Some(error),
                LiveEvent::Lost(error) => self.lost = Some(error),
                // A picture of the outputs is requested for choices only.
                LiveEvent::Done { .. } | LiveEvent::OutputsThumbnail { .. } => {}
            }
        }
    }

    /// Number of errors of the graph and of the model.
    pub(crate) fn problem_count(&self) -> usize {
        let failures = usize::from(self.failure.is_some()) + usize::from(self.model.failure.is_some());
        self.faults.all.faults.len() + self.faults.all.other.len() + failures
    }

    /// Drops all results of nodes, since another graph is opened.
    pub(crate) fn drop_nodes(&mut self) {
        let dropped = self.results.drop_nodes();
        self.mark_dropped(dropped);
    }

    fn mark_dropped(&self, dropped: DroppedResults) {
        if !dropped.subjects.is_empty() || !dropped.thumbnails.is_empty() {
            self.live.mark_dropped(dropped.subjects, dropped.thumbnails);
        }
    }
}
