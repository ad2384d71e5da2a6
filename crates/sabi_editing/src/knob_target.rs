//! Knobs that receive a value from outside of their node or panel.

use sabi_graph::{NodeId, Value};

use crate::open_document::OpenDocument;
use crate::{nodes, panel_values};

/// Knob that receives a value from a file dialog or an eyedropper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KnobTarget {
    /// A knob of a node in the shown graph.
    Node {
        /// Node that has the knob.
        node: NodeId,
        /// Name of the knob.
        knob: String,
    },
    /// An exposed knob, by its name.
    Panel(String),
}

impl KnobTarget {
    /// A knob of a node in the shown graph.
    pub fn of_node(node: &NodeId, knob: String) -> KnobTarget {
        KnobTarget::Node {
            node: node.clone(),
            knob,
        }
    }
}

/// Sets a knob. A knob of a node is also set on all selected nodes of its kind.
pub fn set(document: &mut OpenDocument, knob: &KnobTarget, value: Value) -> bool {
    match knob {
        KnobTarget::Node { node, knob } => nodes::set_knob_of_selected(document, node, knob, Some(value)),
        KnobTarget::Panel(name) => panel_values::set(document, name, &value),
    }
}
