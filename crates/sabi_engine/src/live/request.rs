//! Requests of a window to the live evaluator.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use sabi_export::SetKey;
use sabi_gpu::{CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::NodeRef;

use super::graph_update::GraphUpdate;
use super::precedence::Precedence;
use crate::opening::kinds::Kinds;
use crate::opening::linked_model::ModelOptions;

/// Options of the live evaluator.
#[derive(Clone, Debug)]
pub struct LiveOptions {
    /// Folder of the disk cache; `None` to compute everything after each start.
    pub cache_dir: Option<PathBuf>,
    /// Size limit of the cache of results in GPU memory.
    pub cache_bytes: u64,
    /// Size limit of the textures of one evaluation, besides the cache.
    pub budget_bytes: u64,
    /// Maximum time of one GPU submission, since the window draws with the same device.
    pub submission: Duration,
    /// Side of a thumbnail, pixels.
    pub thumbnail_px: u32,
    /// The coarse picture is skipped if the last full one took less than this, since it would only flicker. With zero it is always drawn.
    pub coarse_after: Duration,
    /// Ray caster.
    pub caster: CasterChoice,
    /// True to compute the shade of models on themselves and on the ground after their first pictures.
    pub finds_shade: bool,
    /// True to compute it before the first picture, for pictures that are drawn once.
    pub finds_shade_first: bool,
    /// Precedence of the evaluators that share the device.
    pub precedence: Precedence,
    /// Rank among them. Between two steps, work waits while an evaluator of a lower rank has work.
    pub rank: u8,
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
            finds_shade: false,
            finds_shade_first: false,
            precedence: Precedence::default(),
            rank: 0,
        }
    }
}

/// Request for the results of a graph on a model. A newer request replaces an older one. Nodes and ports that do not exist are
/// left out of the answer.
#[derive(Clone, Debug)]
pub struct LiveRequest {
    /// Revision that all events of this request contain. It rises with every edit.
    pub revision: u64,
    /// The graph, or its edits since the previous request.
    pub graph: GraphUpdate,
    /// All node kinds.
    pub kinds: Arc<Kinds>,
    /// Revision of the kinds. It rises when node files are read again.
    pub kinds_revision: u64,
    /// The model, with the size of full pictures.
    pub model: Arc<ModelOptions>,
    /// Revision of the model. The model is loaded again when it rises: for another model, another size, or a changed file.
    pub model_revision: u64,
    /// Texels per UV unit of coarse pictures. Not used if the full size is not larger.
    pub coarse_size: u32,
    /// Subjects of the viewports, most important first.
    pub subjects: Vec<ViewSubject>,
    /// Nodes whose exact values are read back at full size, most important first.
    pub inspected: Vec<NodeRef>,
    /// Texture set for pictures in texture space. If the model does not have it, its first set is used.
    pub set: Option<SetKey>,
    /// Nodes that need a thumbnail, most important first.
    pub thumbnails: Vec<NodeRef>,
    /// True for a thumbnail of the model with the materials of the graph's outputs. It is sent even if it has not changed.
    pub outputs_thumbnail: bool,
    /// True if thumbnails show texture space instead of the model.
    pub is_flat: bool,
    /// True while a knob is dragged. Then ray hits are cached, coarse pictures use few rays, and thumbnails follow full pictures.
    pub is_moving: bool,
}

/// Subject of a viewport.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ViewSubject {
    /// The model with the materials of the graph's outputs.
    Outputs,
    /// One node's result on the whole model.
    Node(NodeRef),
}
