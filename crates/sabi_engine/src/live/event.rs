//! Events from the live evaluator to a window.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use sabi_export::SetKey;
use sabi_files::Refusal;
use sabi_graph::{Fit, NodeRef, PortType};
use sabi_view::{Pixels, Placement, ViewModel};

use super::request::ViewSubject;
use crate::error::EngineError;
use crate::evaluating::looks::ModelLooks;
use crate::evaluating::texture_sets::TextureSet;
use crate::evaluating::texture_space::ResultPlane;
use crate::opening::linked_model::FittedModel;
use crate::opening::linked_model::LinkedModel;
use crate::warning::Warning;

/// Event for a window. Its contents never change afterwards.
pub enum LiveEvent {
    /// The model was loaded, at the coarse or the full size, or its fit has changed.
    Model {
        /// Revision of the model.
        model_revision: u64,
        /// Texels per UV unit.
        size: u32,
        /// The model.
        model: Arc<LiveModel>,
    },
    /// The model cannot be loaded. The last model that was loaded stays in use.
    ModelFailed {
        /// Revision of the model.
        model_revision: u64,
        /// Cause.
        error: EngineError,
    },
    /// The picture of a viewport has changed. While a node that it needs is faulty, no event is sent.
    Looks {
        /// Revision of the request.
        revision: u64,
        /// Subject of the viewport.
        subject: ViewSubject,
        /// True if the full size follows.
        is_coarse: bool,
        /// Model that the looks belong to.
        model: Arc<LiveModel>,
        /// Looks of its materials, as textures on the device.
        looks: Arc<ModelLooks>,
        /// Id of the output that serves each material, by the material's index. Materials without an output are missing.
        outputs: Arc<BTreeMap<u32, String>>,
    },
    /// Exact values of an inspected node.
    Inspected {
        /// Revision of the request.
        revision: u64,
        /// Node.
        node: NodeRef,
        /// Its values in texture space.
        values: Arc<InspectedResult>,
    },
    /// The thumbnail of a node has changed.
    Thumbnail {
        /// Revision of the request.
        revision: u64,
        /// Node.
        node: NodeRef,
        /// Picture, transparent around the model.
        picture: Pixels,
    },
    /// The requested thumbnail of the outputs. While a node that they need is faulty, no event is sent.
    OutputsThumbnail {
        /// Revision of the request.
        revision: u64,
        /// Picture, transparent around the model.
        picture: Pixels,
    },
    /// The faults of the graph have changed.
    Faults {
        /// Revision of the request.
        revision: u64,
        /// All faults.
        faults: GraphFaults,
    },
    /// The list of image and group files that the graph names has changed. The files need not exist.
    Files {
        /// Revision of the request.
        revision: u64,
        /// Paths of the files.
        files: BTreeSet<PathBuf>,
        /// Refusals of files that the graph names but may not open.
        refused: Vec<Refusal>,
    },
    /// Times of a request, sent once it is answered or superseded.
    Times {
        /// Revision of the request.
        revision: u64,
        /// Times and counts.
        times: LiveTimes,
    },
    /// All results of a request were sent.
    Done {
        /// Revision of the request.
        revision: u64,
    },
    /// A part of a request could not be evaluated. The next request tries again.
    Failed {
        /// Revision of the request.
        revision: u64,
        /// Cause.
        error: EngineError,
    },
    /// The device is lost, or the worker has ended. No event follows, and a new evaluator has to be started.
    Lost(EngineError),
}

/// Model at one size, ready to be drawn and picked.
pub struct LiveModel {
    /// Revision of the model.
    pub model_revision: u64,
    /// Texels per UV unit.
    pub size: u32,
    /// Model with its atlas and the ray hierarchy for picking.
    pub linked: Arc<LinkedModel>,
    /// Model on the device.
    pub view: ViewModel,
    /// Placement in view space.
    pub placement: Placement,
    /// Fit: the unit of lengths and heights.
    pub fit: Fit,
    /// Warnings about the model and its atlas at this size.
    pub warnings: Vec<Warning>,
    /// Texture sets; empty if the model's UVs cover no texel at this size.
    pub sets: Vec<TextureSet>,
}

impl LiveModel {
    /// The model under its fit.
    pub fn fitted(&self) -> FittedModel<'_> {
        self.linked.fitted(self.fit)
    }

    /// Returns a texture set, or the first if the model does not have the wanted one.
    pub fn set(&self, wanted: Option<SetKey>) -> Option<&TextureSet> {
        self.sets.get(self.index_of_set(wanted))
    }

    /// Returns the index of [`LiveModel::set`].
    pub(super) fn index_of_set(&self, wanted: Option<SetKey>) -> usize {
        let at = self.sets.iter().position(|set| Some(set.key) == wanted);
        at.unwrap_or(0) // If the model does not have the wanted set, the first is used.
    }
}

/// Exact values of a node in texture space.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectedResult {
    /// Type of the result.
    pub ty: PortType,
    /// Side in pixels.
    pub size: u32,
    /// Texture set whose layout is used.
    pub set: TextureSet,
    /// Planes: one for a mask, color or vector, and for a material all that are set.
    pub planes: Vec<ResultPlane>,
    /// For each pixel, true if a chart covers it. The others contain padding.
    pub is_on_surface: Vec<bool>,
}

/// Faults and warnings of a graph.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GraphFaults {
    /// Faults of nodes.
    pub faults: Vec<NodeFault>,
    /// Nodes for which a file has yet to be chosen, each with a sentence that asks for it.
    pub unchosen: Vec<NodeFault>,
    /// Nodes without a fault of their own that need a faulty node or a node without a file.
    pub blocked: Vec<BlockedNode>,
    /// Faults that belong to no node.
    pub other: Vec<String>,
    /// Warnings for the artist.
    pub warnings: Vec<Warning>,
    /// Ids of nodes that kept the device busy for too long, as in [`NodeFault::node`]. They are left out until they are
    /// changed or muted, so that the window stays usable.
    pub too_long: Vec<String>,
}

/// Fault of a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeFault {
    /// Id of the node; for nodes inside groups `instance/inner`.
    pub node: String,
    /// Sentence that names the node.
    pub sentence: String,
}

/// Node that cannot be evaluated because it needs a faulty one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockedNode {
    /// Id of the blocked node.
    pub node: String,
    /// Id of the faulty node.
    pub blocked_by: String,
}

/// Times and counts of a request.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LiveTimes {
    /// Time of each evaluated node by its id, summed over sizes.
    pub nodes: Vec<(String, Duration)>,
    /// Plan steps that ran.
    pub steps: usize,
    /// Plan steps whose results were cached.
    pub cache_hits: usize,
    /// Bytes of cached results.
    pub texture_bytes: u64,
    /// Size limit of the cache in bytes.
    pub budget_bytes: u64,
    /// Time from the request to the last picture of a viewport; `None` if no picture changed.
    pub latency: Option<Duration>,
}
