//! What stands in the place of nodes that go: knobs on the panel, inputs and outputs of the group and frames that named them
//! name it from then on.

use std::collections::BTreeSet;

use sabi_graph::{Edit, Exposed, Frame, GroupInput, NodeId, OutputRef, SlotRef};

use crate::instances;
use crate::open_document::OpenDocument;

/// What comes after nodes that are removed. What has no heir is taken off by their removal.
pub(crate) trait Heir {
    /// Knobs that a published knob of that name turns in place of one.
    fn knobs(&self, _published: &str, _knob: &SlotRef) -> Vec<SlotRef> {
        Vec::new()
    }

    /// Inputs that are fed in place of one.
    fn inputs(&self, _input: &SlotRef) -> Vec<SlotRef> {
        Vec::new()
    }

    /// The result that is given in place of one.
    fn output(&self, _from: &OutputRef) -> Option<OutputRef> {
        None
    }

    /// Nodes that stand in a frame in place of one.
    fn nodes(&self, _node: &NodeId) -> Vec<NodeId> {
        Vec::new()
    }
}

/// The edits by which everything that names the nodes in the graph that is seen, wires aside, names their heir; to be
/// made once the heir is there and before the nodes go.
pub(crate) fn handed_over(document: &OpenDocument, gone: &BTreeSet<NodeId>, heir: &dyn Heir) -> Vec<Edit> {
    let mut edits = Vec::new();
    let body = || document.body();
    let is_gone = |slot: &SlotRef| gone.contains(&slot.node);
    for (name, knob) in document.graph().exposed() {
        let to = handed_on(&knob.to, is_gone, |slot| heir.knobs(name, slot));
        if to != knob.to && !to.is_empty() {
            let knob = Exposed { to, ..knob.clone() };
            let (body, name) = (body(), name.clone());
            edits.push(Edit::Expose { body, name, knob });
        }
    }
    let (inputs, outputs) = instances::ports(document.contents(), document.shown());
    for (name, input) in inputs {
        let to = handed_on(&input.to, is_gone, |slot| heir.inputs(slot));
        if to != input.to {
            let input = Some(GroupInput { to, ..input.clone() });
            let (body, name) = (body(), name.clone());
            edits.push(Edit::SetInput { body, name, input });
        }
    }
    for (name, from) in outputs.iter().filter(|(_, from)| gone.contains(&from.node)) {
        if let Some(from) = heir.output(from) {
            let (body, name, output) = (body(), name.clone(), Some(from));
            edits.push(Edit::SetOutput { body, name, output });
        }
    }
    for (id, frame) in document.graph().frames() {
        let nodes = handed_on(&frame.nodes, |id| gone.contains(id), |id| heir.nodes(id));
        if nodes != frame.nodes {
            let frame = Frame { nodes, ..frame.clone() };
            let (body, id) = (body(), id.clone());
            edits.push(Edit::AddFrame { body, id, frame });
        }
    }
    edits
}

/// A list with heirs in the places of those that go, each once.
fn handed_on<T: Clone + PartialEq>(list: &[T], is_gone: impl Fn(&T) -> bool, heirs: impl Fn(&T) -> Vec<T>) -> Vec<T> {
    if !list.iter().any(&is_gone) {
        return list.to_vec();
    }
    let mut handed: Vec<T> = Vec::new();
    for item in list {
        let now = if is_gone(item) { heirs(item) } else { vec![item.clone()] };
        for item in now {
            if !handed.contains(&item) {
                handed.push(item);
            }
        }
    }
    handed
}
