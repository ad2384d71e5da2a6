//! What a window wants to know.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use sabi_export::SetKey;
use sabi_gpu::{CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::NodeRef;

use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::opening::linked_model::ModelOptions;

/// How a graph is evaluated while it is worked on.
#[derive(Clone, Debug)]
pub struct LiveOptions {
    /// Where results that take long are kept between runs; none to make them anew.
    pub cache_dir: Option<PathBuf>,
    /// Bytes of results that are kept so that an edit evaluates only what it changes.
    pub cache_bytes: u64,
    /// Bytes of textures that one evaluation may hold besides.
    pub budget_bytes: u64,
    /// How long one piece of work may hold the device, which a window draws with, too.
    pub submission: Duration,
    /// Pixels along the side of a thumbnail.
    pub thumbnail_px: u32,
    /// A coarse picture is made first unless the last full one came within this time: it would only flicker. Zero for always.
    pub coarse_after: Duration,
    /// Who follows rays.
    pub caster: CasterChoice,
}

impl Default for LiveOptions {
    fn default() -> LiveOptions {
        LiveOptions {
            cache_dir: None,
            cache_bytes: DEFAULT_BUDGET_BYTES / 2,
            budget_bytes: DEFAULT_BUDGET_BYTES,
            submission: Duration::from_millis(25),
            thumbnail_px: 128,
            coarse_after: Duration::from_millis(40),
            caster: CasterChoice::Auto,
        }
    }
}

/// What a window wants to know of a graph on a model. A newer wish takes the place of an older one. Nodes and ports that are not
/// there are left out of the answer.
#[derive(Clone, Debug)]
pub struct LiveRequest {
    /// Stands in all news about it; rises with every edit.
    pub revision: u64,
    /// The graph.
    pub graph: Arc<OpenGraph>,
    /// All node kinds.
    pub kinds: Arc<Kinds>,
    /// Rises when node files were read again.
    pub kinds_revision: u64,
    /// The model; its size is that of full pictures.
    pub model: Arc<ModelOptions>,
    /// Rises when another model is wanted, another size of it, or its file changed: it is loaded then and not otherwise.
    pub model_revision: u64,
    /// Texels for one unit of UV of pictures that come at once; not used where the full size is not larger.
    pub coarse_size: u32,
    /// What viewports show, most important first.
    pub subjects: Vec<ViewSubject>,
    /// The node whose exact values are wanted at full size.
    pub inspected: Option<NodeRef>,
    /// Which texture set is shown where texture space is; the model's first where it does not have this one.
    pub set: Option<SetKey>,
    /// Nodes that are visible on the canvas, most important first.
    pub thumbnails: Vec<NodeRef>,
    /// Whether thumbnails show texture space and not the model.
    pub is_flat: bool,
    /// Whether a knob is being moved: what rays hit is remembered, a first picture shoots few of them, and thumbnails wait for
    /// full pictures.
    pub is_moving: bool,
}

/// What a viewport shows.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ViewSubject {
    /// What the outputs make of the model.
    Outputs,
    /// One node's result on all of the model.
    Node(NodeRef),
}
