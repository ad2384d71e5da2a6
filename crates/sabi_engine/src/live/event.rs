//! What a window is told.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use sabi_export::SetKey;
use sabi_graph::{Fit, NodeRef, PortType};
use sabi_view::{Pixels, Placement, ViewModel};

use super::request::ViewSubject;
use crate::baking::sets::TextureSet;
use crate::error::EngineError;
use crate::evaluating::looks::ModelLooks;
use crate::evaluating::texture_space::ResultPlane;
use crate::opening::linked_model::LinkedModel;

/// Something that a window is told. What is handed over never changes again.
pub enum LiveEvent {
    /// The model was loaded, coarse or in full, or its lengths count differently.
    Model {
        /// Which one.
        model_revision: u64,
        /// Texels for one unit of UV.
        size: u32,
        /// The model.
        model: Arc<LiveModel>,
    },
    /// The model cannot be had; the last good one stays in use.
    ModelFailed {
        /// Which one.
        model_revision: u64,
        /// Why.
        error: EngineError,
    },
    /// What a viewport shows has changed. Where something that it needs is at fault, what was shown before stays.
    Looks {
        /// Of which wish.
        revision: u64,
        /// What is shown.
        subject: ViewSubject,
        /// Whether the same follows at full size.
        is_coarse: bool,
        /// The model that the textures belong to.
        model: Arc<LiveModel>,
        /// The textures, on the device.
        looks: Arc<ModelLooks>,
    },
    /// The exact values of the inspected node.
    Inspected {
        /// Of which wish.
        revision: u64,
        /// The node.
        node: NodeRef,
        /// Its values.
        values: Arc<Inspected>,
    },
    /// What a node gives looks different now.
    Thumbnail {
        /// Of which wish.
        revision: u64,
        /// The node.
        node: NodeRef,
        /// Its picture, clear where the model is not.
        picture: Pixels,
    },
    /// What is wrong with the graph, whenever that changes.
    Faults {
        /// Of which wish.
        revision: u64,
        /// What it is.
        faults: Faults,
    },
    /// Which files besides its own the graph hangs on, whenever that changes: pictures and group files, there or not.
    Files {
        /// Of which wish.
        revision: u64,
        /// Where they are.
        files: BTreeSet<PathBuf>,
    },
    /// What a wish took, once it is answered or a newer one took its place.
    Times {
        /// Of which wish.
        revision: u64,
        /// What it took.
        times: LiveTimes,
    },
    /// All that a wish asks for was told.
    Done {
        /// Of which wish.
        revision: u64,
    },
    /// Something could not be evaluated; the rest goes on, and the next wish tries again.
    Failed {
        /// Of which wish.
        revision: u64,
        /// Why.
        error: EngineError,
    },
    /// The device is gone, or nobody works any more: there are no more news, and whoever wants some starts anew.
    Lost(EngineError),
}

/// A model at one size, ready to be drawn, picked and probed.
pub struct LiveModel {
    /// Which model.
    pub model_revision: u64,
    /// Texels for one unit of UV.
    pub size: u32,
    /// The model with its atlas and what picking follows rays through.
    pub linked: Arc<LinkedModel>,
    /// The model on the device.
    pub view: ViewModel,
    /// Where it stands in view space.
    pub placement: Placement,
    /// What counts as 1 in lengths and heights.
    pub fit: Fit,
    /// Its texture sets; none where its UVs cover no texel at this size.
    pub sets: Vec<TextureSet>,
}

impl LiveModel {
    /// One of its texture sets, or the first where it does not have that one.
    pub fn set(&self, wanted: Option<SetKey>) -> Option<&TextureSet> {
        self.sets.get(self.index_of_set(wanted))
    }

    /// Which of its sets that is.
    pub(super) fn index_of_set(&self, wanted: Option<SetKey>) -> usize {
        let at = self.sets.iter().position(|set| Some(set.key) == wanted);
        at.unwrap_or_default()
    }
}

/// A node's exact values in texture space.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspected {
    /// What the node gives.
    pub ty: PortType,
    /// Pixels along a side.
    pub size: u32,
    /// The texture set that is laid out.
    pub set: TextureSet,
    /// Its planes; that of a mask, color or vector, or all that a material sets.
    pub planes: Vec<ResultPlane>,
    /// For each pixel whether the surface lies there: other pixels hold padding.
    pub is_on_surface: Vec<bool>,
}

/// What is wrong with a graph.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// What is wrong at nodes.
    pub faults: Vec<NodeFault>,
    /// Nodes that are right and wait for one that is not.
    pub blocked: Vec<BlockedNode>,
    /// What is wrong and at no node.
    pub other: Vec<String>,
    /// What the artist should know.
    pub warnings: Vec<Warning>,
}

/// What the artist should know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The node it is about, if it is about one; inside groups `instance/inner`.
    pub node: Option<String>,
    /// A sentence.
    pub sentence: String,
}

/// What is wrong at a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeFault {
    /// The node; inside groups `instance/inner`.
    pub node: String,
    /// What is wrong, as a sentence that names it.
    pub sentence: String,
}

/// A node that waits for another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockedNode {
    /// The node that waits.
    pub node: String,
    /// The one at fault.
    pub blocked_by: String,
}

/// What answering a wish took.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LiveTimes {
    /// Nodes that were evaluated, by id, all sizes together.
    pub nodes: Vec<(String, Duration)>,
    /// Steps that ran.
    pub steps: usize,
    /// Steps that did not have to, since their results were known.
    pub cache_hits: usize,
    /// Bytes of results that are kept.
    pub texture_bytes: u64,
    /// Bytes of results that may be kept.
    pub budget_bytes: u64,
    /// From the wish until the last of what viewports show was told; none where they show the same as before.
    pub latency: Option<Duration>,
}
