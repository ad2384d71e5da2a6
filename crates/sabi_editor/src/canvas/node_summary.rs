//! Data from which nodes and their rows are drawn.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use egui::TextureId;
use sabi_editing::node_size::ShownRows;
use sabi_engine::catalog::Interface;
use sabi_graph::{NodeId, Value};

use crate::knobs::KnobEvent;
use crate::theme::Theme;

/// State of a node's result.
#[derive(Clone, Debug, Default)]
pub(super) struct NodeState {
    /// Picture of the result.
    pub(super) picture: Option<TextureId>,
    /// Time of the evaluation.
    pub(super) time: Option<Duration>,
    /// Error sentence.
    pub(super) fault: Option<String>,
    /// Sentence about what the node waits for.
    pub(super) waits: Option<String>,
}

/// Data from which a node is drawn.
pub(super) struct NodeSummary {
    pub(super) id: NodeId,
    pub(super) interface: Arc<Interface>,
    /// Rows that it shows.
    pub(super) rows: ShownRows,
    pub(super) title: String,
    pub(super) is_muted: bool,
    pub(super) state: NodeState,
    /// True if the 2D view shows the node.
    pub(super) is_previewed: bool,
    /// True if the node is pinned in the 2D view.
    pub(super) is_pinned: bool,
    /// Values of the node's parameters by name; the others have their defaults.
    pub(super) values: BTreeMap<String, Value>,
    /// Names under which the node's parameters are exposed, by their own names.
    pub(super) exposed: BTreeMap<String, String>,
    /// Names of the masks that multiply the node's parameters, by their names.
    pub(super) masks: BTreeMap<String, String>,
}

/// Settings with which rows of nodes are drawn, and the events of their widgets.
pub(super) struct RowContext {
    pub(super) theme: Arc<Theme>,
    pub(super) zoom: f32,
    pub(super) knob_events: Vec<(NodeId, KnobEvent)>,
    /// True if the menu of a parameter was asked for, in place of the node's.
    pub(super) has_asked_for_menu: bool,
}
