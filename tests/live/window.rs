//! Stand-in for the editor's window: sends requests to the live evaluator and records the events that it receives.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use sabi_engine::evaluating::ModelLooks;
use sabi_engine::live::{GraphFaults, LiveEvent, LiveModel, LiveOptions, LiveRequest, LiveTimes, ViewSubject};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::source::{SessionPictures, Strokes};
use sabi_engine::{Kinds, Live, OpenGraph};
use sabi_files::TrustedPaths;
use sabi_gpu::Gpu;
use sabi_graph::{Document, NodeRef};
use sabi_tests::{device, project};
use sabi_view::Pixels;

/// Time limit for waiting for an event: far more than any of these tests takes.
const PATIENCE: Duration = Duration::from_secs(120);

/// Sizes of pictures.
pub(crate) const COARSE: u32 = 32;
pub(crate) const FULL: u32 = 64;

/// A window and its evaluator.
pub(crate) struct Window {
    // Dropped first, so that the evaluator does not wait for a window that no longer exists.
    woken: Receiver<()>,
    goes_on: Sender<()>,
    is_held: Cell<bool>,
    pub(crate) live: Live,
}

/// Events that a window received until a request was answered.
#[derive(Default)]
pub(crate) struct ReceivedEvents {
    pub(crate) all: Vec<LiveEvent>,
}

/// Creates a graph of these nodes, in a folder that does not matter.
pub(crate) fn graph(nodes: &str) -> OpenGraph {
    document(&format!(
        r#"{{ "format": "sabi", "version": 1, "name": "live", "nodes": {{ {nodes} }} }}"#
    ))
}

/// Creates a graph of this text.
pub(crate) fn document(text: &str) -> OpenGraph {
    OpenGraph {
        path: PathBuf::from("live.sabi"),
        text: text.into(),
        pictures: SessionPictures::default(),
        strokes: Strokes::default(),
        trusted: TrustedPaths::of_file(Path::new("live.sabi")).with_path(&std::env::temp_dir()),
        document: Document::from_json(text).unwrap_or_else(|error| panic!("{error}\n{text}")),
    }
}

/// Returns a reference to the node with this id.
pub(crate) fn node(id: &str) -> NodeRef {
    NodeRef {
        node: id.to_owned(),
        port: None,
    }
}

/// Returns a request for the outputs of a graph on the cube.
pub(crate) fn request(revision: u64, graph: OpenGraph) -> LiveRequest {
    LiveRequest {
        revision,
        graph: Arc::new(graph).into(),
        kinds: Arc::new(Kinds::builtin()),
        kinds_revision: 0,
        model: Arc::new(ModelOptions::new(&project("assets/meshes/cube.glb"), FULL)),
        model_revision: 0,
        coarse_size: COARSE,
        subjects: vec![ViewSubject::Outputs],
        inspected: Vec::new(),
        set: None,
        thumbnails: Vec::new(),
        outputs_thumbnail: false,
        is_flat: false,
        is_moving: false,
    }
}

/// Returns options with which no result depends on the speed of the machine.
pub(crate) fn options() -> LiveOptions {
    LiveOptions {
        coarse_after: Duration::ZERO,
        thumbnail_px: 32,
        ..LiveOptions::default()
    }
}

impl Window {
    /// Creates a window on the device that all tests share.
    pub(crate) fn new() -> Window {
        Window::on(device(), options())
    }

    pub(crate) fn on(gpu: Arc<Gpu>, options: LiveOptions) -> Window {
        // The evaluator waits after each event until the window calls `events` again.
        let (wake, woken) = channel();
        let (goes_on, held) = channel();
        let held = Mutex::new(held);
        let live = Live::start(gpu, options, move || {
            // Once the window is closed, sending fails, which does not matter.
            let _ = wake.send(()).map(|()| held.lock().map(|held| held.recv()));
        });
        Window {
            woken,
            goes_on,
            is_held: Cell::new(false),
            live,
        }
    }

    /// Returns the next events once there are any. The evaluator does nothing until the next call.
    pub(crate) fn events(&self) -> Vec<LiveEvent> {
        if self.is_held.replace(false) {
            // Sending fails if the evaluator has ended, which does not matter.
            let _ = self.goes_on.send(());
        }
        self.woken.recv_timeout(PATIENCE).expect("somebody works");
        self.is_held.set(true);
        self.live.take_events()
    }

    /// Returns all events up to the first batch that ends with one that `is_meant` selects.
    pub(crate) fn until(&self, is_meant: impl Fn(&LiveEvent) -> bool) -> ReceivedEvents {
        let mut told = ReceivedEvents::default();
        while !told.all.last().is_some_and(&is_meant) {
            told.all.extend(self.events());
        }
        told
    }

    /// Sends a request, and returns all events until it is answered.
    pub(crate) fn answer(&self, request: LiveRequest) -> ReceivedEvents {
        let asked = request.revision;
        self.live.submit(request);
        self.until(|event| matches!(event, LiveEvent::Done { revision } if *revision == asked))
    }
}

impl ReceivedEvents {
    /// Looks that viewports received, in order: revision of the request, true if coarse, the model and the looks.
    pub(crate) fn shown(&self) -> Vec<(u64, bool, &Arc<LiveModel>, &Arc<ModelLooks>)> {
        let shown = self.all.iter().filter_map(|event| match event {
            LiveEvent::Looks {
                revision,
                is_coarse,
                model,
                looks,
                ..
            } => Some((*revision, *is_coarse, model, looks)),
            _ => None,
        });
        shown.collect()
    }

    /// For each of the shown looks, in order, true if it was coarse.
    pub(crate) fn coarse_and_full(&self) -> Vec<bool> {
        self.shown().iter().map(|(_, is_coarse, ..)| *is_coarse).collect()
    }

    /// Thumbnails by node.
    pub(crate) fn thumbnails(&self) -> Vec<(&str, &Pixels)> {
        let thumbnails = self.all.iter().filter_map(|event| match event {
            LiveEvent::Thumbnail { node, picture, .. } => Some((node.node.as_str(), picture)),
            _ => None,
        });
        thumbnails.collect()
    }

    /// Nodes that have new thumbnails.
    pub(crate) fn pictured(&self) -> Vec<&str> {
        self.thumbnails().iter().map(|(node, _)| *node).collect()
    }

    /// Faults of the graph according to the last event about them.
    pub(crate) fn faults(&self) -> Option<&GraphFaults> {
        let mut faults = self.all.iter().rev();
        faults.find_map(|event| match event {
            LiveEvent::Faults { faults, .. } => Some(faults),
            _ => None,
        })
    }

    /// Times of the last evaluation; empty if nothing was evaluated.
    pub(crate) fn times(&self) -> LiveTimes {
        let mut times = self.all.iter().rev();
        let found = times.find_map(|event| match event {
            LiveEvent::Times { times, .. } => Some(times.clone()),
            _ => None,
        });
        found.unwrap_or_default()
    }

    /// Nodes that were evaluated.
    pub(crate) fn evaluated(&self) -> Vec<String> {
        self.times().nodes.into_iter().map(|(node, _)| node).collect()
    }
}

/// The bytes of all textures of what is shown.
pub(crate) fn bytes(shown: &ModelLooks) -> Vec<u8> {
    let gpu = device();
    let mut bytes = Vec::new();
    for look in &shown.looks {
        let maps = &look.maps;
        let maps = [&maps.color, &maps.surface, &maps.emission, &maps.height, &maps.normal];
        let node = look.node.iter().map(|node| &node.texture);
        for texture in maps.into_iter().flatten().chain(node) {
            for page in 0..texture.depth_or_array_layers() {
                sabi_gpu::read_layer(&gpu, texture, page, 0, &mut bytes).expect("a page");
            }
        }
    }
    bytes
}
