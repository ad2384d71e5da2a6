//! Edits that follow from other edits: group instances are adapted to changes of what their group exposes, and frames
//! that lose their last node are removed.
//!
//! An instance that refers to an input, output or knob that its group does not expose would prevent the evaluation of the whole graph.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Body, Document, Edit, Frame, Graph, GroupDef, GroupInput, Node, NodeId, OutputRef, SlotRef, Value};

use crate::instances::{bodies, instances, ports};

/// Adds the edits that follow from these edits of the shown graph.
pub(crate) fn completed(document: &Document, shown: &Body, mut edits: Vec<Edit>) -> Vec<Edit> {
    let removals = emptied_frames(document, shown, &edits);
    edits.extend(removals);
    with_instances(document, edits)
}

/// Returns removals of the frames that these edits leave without a node. Such frames would be invisible.
fn emptied_frames(document: &Document, shown: &Body, edits: &[Edit]) -> Vec<Edit> {
    let Ok(graph) = document.body(shown) else {
        return Vec::new();
    };
    let exists = |id: &NodeId| graph.node(id.as_str()).is_some();
    let (mut removed, mut added) = (BTreeSet::new(), BTreeSet::new());
    // Frames that the edits themselves change (`Some`) or remove (`None`).
    let mut changed: BTreeMap<&String, Option<&Frame>> = BTreeMap::new();
    for edit in edits {
        match edit {
            Edit::RemoveNode { body, id } if body == shown => {
                removed.insert(id);
            }
            Edit::AddNode { body, id, .. } if body == shown => {
                added.insert(id);
            }
            Edit::AddFrame { body, id, frame } if body == shown => {
                changed.insert(id, Some(frame));
            }
            Edit::RemoveFrame { body, id } if body == shown => {
                changed.insert(id, None);
            }
            _ => {}
        }
    }
    let stays = |id: &NodeId| added.contains(id) || (!removed.contains(id) && exists(id));
    let held = graph
        .frames()
        .iter()
        .filter(|(_, frame)| frame.nodes.iter().any(exists));
    let emptied = held.filter(|(id, frame)| match changed.get(id) {
        Some(None) => false,
        Some(Some(changed)) => !changed.nodes.iter().any(stays),
        None => !frame.nodes.iter().any(stays),
    });
    let remove = |id: &String| Edit::RemoveFrame {
        body: shown.clone(),
        id: id.clone(),
    };
    emptied.map(|(id, _)| remove(id)).collect()
}

/// Adds the edits that adapt instances to changes of their groups.
fn with_instances(document: &Document, mut edits: Vec<Edit>) -> Vec<Edit> {
    let mut changed = changed_groups(&edits);
    if changed.is_empty() {
        return edits;
    }
    let mut after = document.clone();
    if after.apply(Edit::Batch(edits.clone())).is_err() {
        // The edits are invalid. The session will refuse them and give the reason.
        return edits;
    }
    // A group may expose parts of a changed group inside it, so the changes can propagate. They do so at most as often as
    // there are groups.
    for _ in 0..=document.groups.len() {
        let follows = following(document, &after, &changed);
        changed = changed_groups(&follows);
        if follows.is_empty() || after.apply(Edit::Batch(follows.clone())).is_err() {
            break;
        }
        edits.extend(follows);
    }
    edits
}

/// Groups whose inputs, outputs, knobs or variants these edits may change.
fn changed_groups(edits: &[Edit]) -> BTreeSet<String> {
    let mut changed = BTreeSet::new();
    for edit in edits {
        let body = match edit {
            Edit::RemoveNode { body, .. }
            | Edit::SetInput { body, .. }
            | Edit::SetOutput { body, .. }
            | Edit::Expose { body, .. }
            | Edit::Unexpose { body, .. }
            | Edit::SetVariant { body, .. } => body,
            Edit::Batch(edits) => {
                changed.extend(changed_groups(edits));
                continue;
            }
            _ => continue,
        };
        if let Body::Group(name) = body {
            changed.insert(name.clone());
        }
    }
    changed
}

/// Returns edits that adapt all instances of the changed groups, and all references to those instances.
fn following(before: &Document, after: &Document, changed: &BTreeSet<String>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for name in changed {
        let Some((was, is)) = before.groups.get(name).zip(after.groups.get(name)) else {
            continue;
        };
        let change = GroupChange { was, is };
        for (body, graph) in bodies(after) {
            let found: BTreeSet<&NodeId> = instances(graph, name).map(|(id, _)| id).collect();
            for (id, node) in instances(graph, name) {
                let instance = ChangedInstance {
                    body: &body,
                    graph,
                    id,
                    node,
                };
                instance.inputs(&change, &mut edits);
                instance.knobs(&change, &mut edits);
                instance.readers(&change, &mut edits);
            }
            if !found.is_empty() {
                let outer = OuterGraph {
                    document: after,
                    body: &body,
                    graph,
                    instances: &found,
                };
                outer.follow(&change, &mut edits);
            }
        }
    }
    edits
}

/// A group before and after the edits. A reference to a name that it did not expose before was broken already and is not changed.
struct GroupChange<'a> {
    was: &'a GroupDef,
    is: &'a GroupDef,
}

impl GroupChange<'_> {
    fn lost_input(&self, name: &str) -> bool {
        self.was.inputs.contains_key(name) && !self.is.inputs.contains_key(name)
    }

    fn lost_knob(&self, name: &str) -> bool {
        let [was, is] = [self.was, self.is].map(|group| group.graph.exposed().contains_key(name));
        was && !is
    }

    fn lost_variant(&self, name: &str) -> bool {
        let [was, is] = [self.was, self.is].map(|group| group.graph.variants().contains_key(name));
        was && !is
    }

    /// Returns the change of a wire from an instance: `None` for no change, another output, or `Some(None)` if the wire is removed.
    fn output(&self, from: &OutputRef) -> Option<Option<OutputRef>> {
        let is_there = |name: &str| self.is.outputs.contains_key(name);
        match from.port.as_deref() {
            Some(port) if is_there(port) || !self.was.outputs.contains_key(port) => None,
            Some(_) => Some(None),
            None if self.is.outputs.len() == 1 || self.was.outputs.len() != 1 => None,
            // A wire without an output name reads the only output.
            None => {
                let only = self.was.outputs.keys().next().filter(|only| is_there(only));
                Some(only.map(|only| OutputRef {
                    node: from.node.clone(),
                    port: Some(only.clone()),
                }))
            }
        }
    }
}

/// An instance of a changed group.
struct ChangedInstance<'a> {
    body: &'a Body,
    graph: &'a Graph,
    id: &'a NodeId,
    node: &'a Node,
}

impl ChangedInstance<'_> {
    fn inputs(&self, change: &GroupChange<'_>, edits: &mut Vec<Edit>) {
        let inputs = self.graph.inputs(self.id.as_str()).into_keys();
        let gone = inputs.filter(|name| change.lost_input(name));
        edits.extend(gone.map(|name| Edit::Disconnect {
            body: self.body.clone(),
            node: self.id.clone(),
            input: name.to_owned(),
        }));
    }

    fn knobs(&self, change: &GroupChange<'_>, edits: &mut Vec<Edit>) {
        let is_gone = |name: &str, value: &Value| match name {
            "variant" => value.as_text().is_some_and(|name| change.lost_variant(name)),
            name => change.lost_knob(name),
        };
        let gone = self.node.params.iter().filter(|(name, value)| is_gone(name, value));
        edits.extend(gone.map(|(name, _)| Edit::SetParam {
            body: self.body.clone(),
            node: self.id.clone(),
            param: name.clone(),
            value: None,
        }));
    }

    fn readers(&self, change: &GroupChange<'_>, edits: &mut Vec<Edit>) {
        for slot in self.graph.readers(self.id.as_str()) {
            let Some(from) = self.graph.link_into(slot.node.as_str(), &slot.name) else {
                continue;
            };
            let Some(now) = change.output(from) else {
                continue;
            };
            let (body, node, input) = (self.body.clone(), slot.node, slot.name);
            edits.push(Edit::link(body, node, input, now));
        }
    }
}

/// A graph that contains instances of a changed group, and the parts of those instances that it exposes.
struct OuterGraph<'a> {
    document: &'a Document,
    body: &'a Body,
    graph: &'a Graph,
    instances: &'a BTreeSet<&'a NodeId>,
}

impl OuterGraph<'_> {
    fn follow(&self, change: &GroupChange<'_>, edits: &mut Vec<Edit>) {
        let body = || self.body.clone();
        for (name, knob) in self.graph.exposed() {
            let to = self.kept(&knob.to, |name| change.lost_knob(name));
            if to.len() == knob.to.len() {
                continue;
            }
            let (body, name) = (body(), name.clone());
            edits.push(if to.is_empty() {
                Edit::Unexpose { body, name }
            } else {
                let knob = knob.with_targets(to);
                Edit::Expose { body, name, knob }
            });
        }
        let (inputs, outputs) = ports(self.document, self.body);
        for (name, input) in inputs {
            let to = self.kept(&input.to, |name| change.lost_input(name));
            if to.len() < input.to.len() {
                let input = Some(GroupInput { to, ..input.clone() });
                let (body, name) = (body(), name.clone());
                edits.push(Edit::SetInput { body, name, input });
            }
        }
        for (name, from) in outputs.iter().filter(|(_, from)| self.instances.contains(&from.node)) {
            if let Some(output) = change.output(from) {
                let (body, name) = (body(), name.clone());
                edits.push(Edit::SetOutput { body, name, output });
            }
        }
    }

    fn kept(&self, slots: &[SlotRef], is_lost: impl Fn(&str) -> bool) -> Vec<SlotRef> {
        let is_kept = |slot: &&SlotRef| !self.instances.contains(&slot.node) || !is_lost(&slot.name);
        slots.iter().filter(is_kept).cloned().collect()
    }
}
