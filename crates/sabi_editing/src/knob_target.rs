//! Knobs that receive a value from outside of their node or graph.

use sabi_graph::{NodeId, Value};

use crate::open_document::OpenDocument;
use crate::{exposed_values, nodes};

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
    Exposed(String),
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
        KnobTarget::Exposed(name) => exposed_values::set(document, name, &value),
    }
}
