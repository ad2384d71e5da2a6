//! What is drawn of a node.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use egui::TextureId;
use sabi_engine::catalog::Entry;
use sabi_graph::{NodeId, Value};

use crate::knobs::KnobEvent;
use crate::theme::Theme;

/// What is known of a node's result.
#[derive(Clone, Debug, Default)]
pub(super) struct NodeState {
    /// A picture of it.
    pub(super) picture: Option<TextureId>,
    /// How long it took.
    pub(super) time: Option<Duration>,
    /// What is wrong with it.
    pub(super) fault: Option<String>,
    /// What it waits for.
    pub(super) waits: Option<String>,
}

/// What is drawn of a node.
pub(super) struct NodeSummary {
    pub(super) id: NodeId,
    pub(super) face: Arc<Entry>,
    pub(super) title: String,
    pub(super) is_muted: bool,
    pub(super) state: NodeState,
    /// Whether the 2D view shows it.
    pub(super) is_previewed: bool,
    /// Whether it does so whatever is clicked.
    pub(super) is_pinned: bool,
    /// Values of the knobs that are rows of the node, by name; those that are not here have their defaults.
    pub(super) values: BTreeMap<String, Value>,
}

/// What drawing needs, and what rows asked for.
pub(super) struct Hand {
    pub(super) theme: Arc<Theme>,
    pub(super) zoom: f32,
    pub(super) knob_events: Vec<(NodeId, KnobEvent)>,
}
