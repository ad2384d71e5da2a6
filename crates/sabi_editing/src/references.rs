//! Transfer of references to removed nodes: exposed knobs, inputs and outputs of the group, and frames that referred
//! to a removed node refer to its successors instead.

use std::collections::BTreeSet;

use sabi_graph::{Edit, Frame, GroupInput, KnobCurve, NodeId, OutputRef, SlotRef};

use crate::instances;
use crate::open_document::OpenDocument;

/// Successors of removed nodes. References without a successor are removed together with the nodes.
pub(crate) trait Successors {
    /// Returns the knobs that an exposed knob controls in place of a removed knob; empty if there are none.
    fn knobs(&self, _exposed: &str, _knob: &SlotRef) -> Vec<SlotRef> {
        Vec::new()
    }

    /// Returns the curve of an exposed knob for the successor of a removed knob that had the curve `before`.
    fn curve(&self, before: Option<&KnobCurve>, _removed: &SlotRef, _successor: &SlotRef) -> Option<KnobCurve> {
        before.cloned()
    }

    /// Returns the inputs that are fed in place of a removed input; empty if there are none.
    fn inputs(&self, _input: &SlotRef) -> Vec<SlotRef> {
        Vec::new()
    }

    /// Output that replaces a removed one.
    fn output(&self, _from: &OutputRef) -> Option<OutputRef> {
        None
    }

    /// Returns the nodes that are in a frame in place of a removed node.
    fn nodes(&self, _node: &NodeId) -> Vec<NodeId> {
        Vec::new()
    }
}

/// Returns edits that redirect all references to nodes of the shown graph, except wires, to their successors. They must be
/// applied after the successors are added and before the nodes are removed.
pub(crate) fn redirecting(
    document: &OpenDocument,
    removed: &BTreeSet<NodeId>,
    successors: &dyn Successors,
) -> Vec<Edit> {
    let mut edits = Vec::new();
    let body = || document.body();
    let is_removed = |slot: &SlotRef| removed.contains(&slot.node);
    for (name, knob) in document.graph().exposed() {
        let to = with_successors(&knob.to, is_removed, |slot| successors.knobs(name, slot));
        if to != knob.to && !to.is_empty() {
            let mut redirected = knob.with_targets(to);
            for old in knob.to.iter().filter(|slot| is_removed(slot)) {
                for new in successors.knobs(name, old) {
                    if let Some(curve) = successors.curve(knob.curves.get(old), old, &new) {
                        redirected.curves.insert(new, curve);
                    }
                }
            }
            let knob = redirected;
            let (body, name) = (body(), name.clone());
            edits.push(Edit::Expose { body, name, knob });
        }
    }
    let (inputs, outputs) = instances::ports(document.contents(), document.shown());
    for (name, input) in inputs {
        let to = with_successors(&input.to, is_removed, |slot| successors.inputs(slot));
        if to != input.to {
            let input = Some(GroupInput { to, ..input.clone() });
            let (body, name) = (body(), name.clone());
            edits.push(Edit::SetInput { body, name, input });
        }
    }
    for (name, from) in outputs.iter().filter(|(_, from)| removed.contains(&from.node)) {
        if let Some(from) = successors.output(from) {
            let (body, name, output) = (body(), name.clone(), Some(from));
            edits.push(Edit::SetOutput { body, name, output });
        }
    }
    for (id, frame) in document.graph().frames() {
        let nodes = with_successors(&frame.nodes, |id| removed.contains(id), |id| successors.nodes(id));
        if nodes != frame.nodes {
            let frame = Frame { nodes, ..frame.clone() };
            let (body, id) = (body(), id.clone());
            edits.push(Edit::AddFrame { body, id, frame });
        }
    }
    edits
}

/// A list with removed items replaced by their successors, each item once.
fn with_successors<T: Clone + PartialEq>(
    list: &[T],
    is_removed: impl Fn(&T) -> bool,
    successors: impl Fn(&T) -> Vec<T>,
) -> Vec<T> {
    if !list.iter().any(&is_removed) {
        return list.to_vec();
    }
    let mut result: Vec<T> = Vec::new();
    for item in list {
        let now = if is_removed(item) {
            successors(item)
        } else {
            vec![item.clone()]
        };
        for item in now {
            if !result.contains(&item) {
                result.push(item);
            }
        }
    }
    result
}
