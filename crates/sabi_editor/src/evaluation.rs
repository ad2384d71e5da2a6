//! Client of the engine's evaluation thread: what the window asks for, and the newest results.

mod eviction;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use sabi_editing::OpenDocument;
use sabi_engine::view::Pixels;
use sabi_engine::{
    EngineError, Faults, Gpu, Inspected, Live, LiveEvent, LiveModel, LiveOptions, LiveRequest, LiveTimes, ModelLooks,
    ModelOptions, OpenGraph, SetKey, ViewSubject,
};
use sabi_graph::{Document, NodeRef};

use crate::import_options::ImportOptions;

/// Texels for one unit of UV of a first picture.
const COARSE: u32 = 256;
/// Texels of full pictures where the graph names no size: what software drivers do in a blink, and what graphics cards do.
const FULL: [u32; 2] = [512, 1024];

/// Maps of one result on the model.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) model: Arc<LiveModel>,
    pub(crate) looks: Arc<ModelLooks>,
    /// Rises with every picture.
    pub(crate) number: u64,
}

/// Results of the graph that the window shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Wanted {
    pub(crate) subjects: Vec<ViewSubject>,
    pub(crate) inspected: Option<NodeRef>,
    pub(crate) set: Option<SetKey>,
    pub(crate) thumbnails: Vec<NodeRef>,
    pub(crate) is_flat: bool,
    pub(crate) is_moving: bool,
}

/// Client of the engine's evaluation thread.
pub(crate) struct Evaluation {
    gpu: Arc<Gpu>,
    live: Live,
    cache_dir: Option<PathBuf>,
    model: Arc<ModelOptions>,
    reading: ImportOptions,
    model_revision: u64,
    asked: Option<(Asked, Wanted)>,
    graph: Arc<OpenGraph>,
    /// Rises with the graph.
    graph_number: u64,
    /// Document without node positions and frames, which no result depends on.
    bare: Document,
    /// Revisions of the graph and of its files that `bare` was made from.
    taken: Option<(u64, u64)>,
    requests: u64,
    pictures: BTreeMap<ViewSubject, Picture>,
    thumbnails: BTreeMap<NodeRef, (TextureHandle, Pixels)>,
    pub(crate) inspected: Option<(NodeRef, Arc<Inspected>)>,
    /// Highest-resolution model received so far.
    pub(crate) shown_model: Option<Arc<LiveModel>>,
    pub(crate) faults: Faults,
    /// Images and group files that the graph names.
    pub(crate) files: Arc<BTreeSet<PathBuf>>,
    by_node: BTreeMap<String, String>,
    waiting: BTreeMap<String, String>,
    times: BTreeMap<String, Duration>,
    pub(crate) last: LiveTimes,
    /// Error of the last evaluation.
    pub(crate) failure: Option<EngineError>,
    /// Error of the last attempt to read the model.
    pub(crate) model_failure: Option<EngineError>,
    pub(crate) lost: Option<EngineError>,
    numbers: u64,
}

/// Revisions that a request was made for.
#[derive(Clone, Debug, PartialEq)]
struct Asked {
    document: u64,
    kinds: u64,
    model: u64,
    files: u64,
}

impl Evaluation {
    /// Starts the evaluation on a device; `context` draws a frame when a result arrives.
    pub(crate) fn new(
        gpu: Arc<Gpu>,
        (model, reading): (&Path, ImportOptions),
        cache_dir: Option<PathBuf>,
        context: &Context,
    ) -> Evaluation {
        let woken = context.clone();
        let options = LiveOptions {
            cache_dir: cache_dir.clone(),
            ..LiveOptions::default()
        };
        let live = Live::start(gpu.clone(), options, move || woken.request_repaint());
        Evaluation {
            live,
            model: Arc::new(reading.options(model, FULL[0], cache_dir.as_deref())),
            reading,
            cache_dir,
            gpu,
            model_revision: 0,
            asked: None,
            graph: Arc::new(sabi_engine::Session::new(None).graph().clone()),
            graph_number: 0,
            bare: Document::default(),
            taken: None,
            requests: 0,
            pictures: BTreeMap::new(),
            thumbnails: BTreeMap::new(),
            inspected: None,
            shown_model: None,
            faults: Faults::default(),
            files: Arc::default(),
            by_node: BTreeMap::new(),
            waiting: BTreeMap::new(),
            times: BTreeMap::new(),
            last: LiveTimes::default(),
            failure: None,
            model_failure: None,
            lost: None,
            numbers: 0,
        }
    }

    /// Folder of results that are kept between runs.
    pub(crate) fn cache_dir(&self) -> Option<&Path> {
        self.cache_dir.as_deref()
    }

    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The file of the model.
    pub(crate) fn model_file(&self) -> &Path {
        &self.model.path
    }

    /// Revision of the received model, and whether it is the requested one.
    pub(crate) fn loaded_model(&self) -> (Option<u64>, bool) {
        let loaded = self.shown_model.as_ref().map(|model| model.model_revision);
        (loaded, loaded == Some(self.model_revision))
    }

    /// Texels along a side of full-resolution results.
    pub(crate) fn size(&self) -> u32 {
        self.model.size
    }

    /// Whether results are still to arrive.
    pub(crate) fn is_busy(&self) -> bool {
        self.live.is_busy()
    }

    /// Options for reading the model's file.
    pub(crate) fn import_options(&self) -> ImportOptions {
        self.reading
    }

    /// Evaluates on another model, or on the same one with other options.
    pub(crate) fn take_model(&mut self, file: &Path, reading: ImportOptions) {
        self.reading = reading;
        self.model = Arc::new(self.model_at(file, self.model.size));
        self.model_revision += 1;
        self.model_failure = None;
    }

    /// Reads the model again, since its file changed.
    pub(crate) fn reread_model(&mut self) {
        let file = self.model_file().to_owned();
        self.take_model(&file, self.reading);
    }

    /// Options for reading the model at a size.
    pub(crate) fn model_of_size(&self, size: u32) -> ModelOptions {
        self.model_at(self.model_file(), size)
    }

    fn model_at(&self, file: &Path, size: u32) -> ModelOptions {
        self.reading.options(file, size, self.cache_dir.as_deref())
    }

    /// Sends a request if the graph or the wanted results changed since the last one.
    pub(crate) fn ask(&mut self, document: &OpenDocument, wanted: Wanted) {
        let size = self.wanted_size(document);
        if size != self.model.size {
            self.model = Arc::new(self.model_of_size(size));
            self.model_revision += 1;
        }
        let (kinds, kinds_revision) = document.kinds();
        self.take_graph(document);
        let asked = Asked {
            document: self.graph_number,
            kinds: kinds_revision,
            model: self.model_revision,
            files: document.files_revision(),
        };
        if self
            .asked
            .as_ref()
            .is_some_and(|(before, looks)| *before == asked && *looks == wanted)
        {
            return;
        }
        self.evict(document, &wanted);
        self.requests += 1;
        self.live.submit(LiveRequest {
            revision: self.requests,
            graph: self.graph.clone(),
            kinds: kinds.clone(),
            kinds_revision,
            model: self.model.clone(),
            model_revision: self.model_revision,
            coarse_size: COARSE,
            subjects: wanted.subjects.clone(),
            inspected: wanted.inspected.clone(),
            set: wanted.set,
            thumbnails: wanted.thumbnails.clone(),
            is_flat: wanted.is_flat,
            is_moving: wanted.is_moving,
        });
        self.asked = Some((asked, wanted));
    }

    /// Takes over the graph if something changed that results depend on, which node positions are not.
    fn take_graph(&mut self, document: &OpenDocument) {
        let now = (document.session.revision(), document.files_revision());
        if self.taken == Some(now) {
            return;
        }
        let graph = document.session.graph();
        let bare = graph.document.without_places();
        let has_other_files = self.taken.is_none_or(|(_, files)| files != now.1);
        if has_other_files || graph.path != self.graph.path || bare != self.bare {
            self.graph = Arc::new(graph.clone());
            self.graph_number += 1;
            self.bare = bare;
        }
        self.taken = Some(now);
    }

    fn wanted_size(&self, document: &OpenDocument) -> u32 {
        let usual = match self.gpu.summary().kind {
            sabi_engine::AdapterKind::Cpu => FULL[0],
            _ => FULL[1],
        };
        let named = document.contents().preview.as_ref().and_then(|preview| preview.size);
        named.unwrap_or(usual).clamp(64, 4096)
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
                } if model_revision == self.model_revision => {
                    self.model_failure = None;
                    self.shown_model = Some(model);
                }
                LiveEvent::ModelFailed { error, model_revision } if model_revision == self.model_revision => {
                    self.model_failure = Some(error);
                }
                LiveEvent::Looks {
                    subject, model, looks, ..
                } => {
                    self.numbers += 1;
                    tracing::info!(?subject, texels = model.size, "a picture came");
                    self.failure = None;
                    let number = self.numbers;
                    self.pictures.insert(subject, Picture { model, looks, number });
                }
                LiveEvent::Inspected { node, values, .. } => self.inspected = Some((node, values)),
                LiveEvent::Thumbnail { node, picture, .. } => self.take_thumbnail(context, node, picture),
                LiveEvent::Files { files, .. } => self.files = Arc::new(files),
                LiveEvent::Faults { faults, .. } => self.take_faults(faults),
                LiveEvent::Times { times, .. } => {
                    self.times.extend(times.nodes.iter().cloned());
                    self.last = times;
                }
                LiveEvent::Failed { error, .. } => self.failure = Some(error),
                LiveEvent::Lost(error) => self.lost = Some(error),
                LiveEvent::Done { .. } | LiveEvent::Model { .. } | LiveEvent::ModelFailed { .. } => {}
            }
        }
    }

    fn take_thumbnail(&mut self, context: &Context, node: NodeRef, picture: Pixels) {
        let size = picture.size.map(|side| side as usize);
        let image = ColorImage::from_rgba_unmultiplied(size, &picture.rgba);
        match self.thumbnails.get_mut(&node) {
            Some((handle, known)) => {
                handle.set(image, TextureOptions::LINEAR);
                *known = picture;
            }
            None => {
                let handle = context.load_texture(format!("result of {}", node.node), image, TextureOptions::LINEAR);
                self.thumbnails.insert(node, (handle, picture));
            }
        }
    }

    fn take_faults(&mut self, faults: Faults) {
        let at_fault = faults.faults.iter();
        self.by_node = with_group_instances(at_fault.map(|fault| (&*fault.node, fault.sentence.clone())));
        let waiting = faults.blocked.iter();
        self.waiting = with_group_instances(waiting.map(|it| (&*it.node, format!("waiting for {}", it.blocked_by))));
        self.faults = faults;
    }

    /// Newest maps of a result, if any have arrived.
    pub(crate) fn picture(&self, subject: &ViewSubject) -> Option<&Picture> {
        self.pictures.get(subject)
    }

    pub(crate) fn thumbnail(&self, node: &NodeRef) -> Option<&TextureHandle> {
        self.thumbnails.get(node).map(|(handle, _)| handle)
    }

    /// Pixels of a node picture.
    pub(crate) fn thumbnail_pixels(&self, node: &NodeRef) -> Option<&Pixels> {
        self.thumbnails.get(node).map(|(_, picture)| picture)
    }

    /// Error of a node, or of the first one in a group instance.
    pub(crate) fn fault(&self, node: &str) -> Option<&String> {
        self.by_node.get(node)
    }

    /// Sentence about what a node, or the first one in a group instance, waits for.
    pub(crate) fn waits(&self, node: &str) -> Option<&String> {
        self.waiting.get(node)
    }

    /// Number of errors of the graph and of the model.
    pub(crate) fn problem_count(&self) -> usize {
        let failures = usize::from(self.failure.is_some()) + usize::from(self.model_failure.is_some());
        self.faults.faults.len() + self.faults.other.len() + failures
    }

    /// Sentence about why a node has no result: its error, or what it waits for.
    pub(crate) fn sentence(&self, node: &str) -> Option<&String> {
        self.fault(node).or_else(|| self.waits(node))
    }

    /// Time of a node's last evaluation; of a group instance, that of all nodes in it.
    pub(crate) fn time(&self, node: &str) -> Option<Duration> {
        let inner = format!("{node}/");
        let inside = self.times.range(inner.clone()..);
        let inside = inside
            .take_while(|(id, _)| id.starts_with(&inner))
            .map(|(_, time)| *time);
        let own = self.times.get(node).copied();
        own.into_iter().chain(inside).reduce(|sum, time| sum + time)
    }

    /// Numbers of held results on the model, node pictures and times.
    #[cfg(test)]
    pub(crate) fn held(&self) -> [usize; 3] {
        [self.pictures.len(), self.thumbnails.len(), self.times.len()]
    }

    /// Time of each node's last evaluation.
    pub(crate) fn times(&self) -> &BTreeMap<String, Duration> {
        &self.times
    }
}

/// Sentences by node, also at the group instances around it: one at `a/b/c` is also at `a/b` and `a`, unless another is there.
fn with_group_instances<'n>(told: impl Iterator<Item = (&'n str, String)>) -> BTreeMap<String, String> {
    let mut at_nodes = BTreeMap::new();
    for (node, sentence) in told {
        let nodes = std::iter::successors(Some(node), |inner| inner.rsplit_once('/').map(|(outer, _)| outer));
        for node in nodes {
            at_nodes.entry(node.to_owned()).or_insert_with(|| sentence.clone());
        }
    }
    at_nodes
}
