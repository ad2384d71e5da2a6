//! Instances follow their group: what it does not publish any more, nothing outside of it names either. An instance that
//! names an input, an output or a knob that is not there would take the whole graph with it.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{
    Body, Document, Edit, GROUP_KIND, Graph, GroupDef, GroupInput, Node, NodeId, OutputRef, SlotRef, Value,
};

/// The graphs of a document.
pub(super) fn bodies(document: &Document) -> Vec<(Body, &Graph)> {
    let groups = document.groups.iter();
    let groups = groups.map(|(name, group)| (Body::Group(name.clone()), &group.graph));
    std::iter::once((Body::Main, &document.graph)).chain(groups).collect()
}

/// The instances of a group in a graph.
pub(super) fn instances<'g>(graph: &'g Graph, group: &'g str) -> impl Iterator<Item = (&'g NodeId, &'g Node)> {
    let of_group = move |node: &Node| node.kind == GROUP_KIND && node.group.as_deref() == Some(group);
    graph.nodes().filter(move |(_, node)| of_group(node))
}

/// What a graph takes and gives as a group.
pub(super) fn ports<'d>(
    document: &'d Document,
    body: &Body,
) -> (&'d BTreeMap<String, GroupInput>, &'d BTreeMap<String, OutputRef>) {
    let group = match body {
        Body::Main => None,
        Body::Group(name) => document.groups.get(name),
    };
    match group {
        Some(group) => (&group.inputs, &group.outputs),
        None => (&document.inputs, &document.outputs),
    }
}

/// The edits, and after them those that instances need to follow.
pub(super) fn followed(document: &Document, mut edits: Vec<Edit>) -> Vec<Edit> {
    let mut changed = changed_groups(&edits);
    if changed.is_empty() {
        return edits;
    }
    let mut after = document.clone();
    if after.apply(Edit::Batch(edits.clone())).is_err() {
        // It is refused once more by the session, which says why.
        return edits;
    }
    // What follows in a group may in turn be published by it; groups hold each other no deeper than there are some.
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

/// Groups that may publish something else after these edits.
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

/// The edits that bring everything outside of the changed groups in line with them.
fn following(before: &Document, after: &Document, changed: &BTreeSet<String>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for name in changed {
        let Some((was, is)) = before.groups.get(name).zip(after.groups.get(name)) else {
            continue;
        };
        let change = Change { was, is };
        for (body, graph) in bodies(after) {
            let found: BTreeSet<&NodeId> = instances(graph, name).map(|(id, _)| id).collect();
            for (id, node) in instances(graph, name) {
                let instance = Instance {
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
                let published = Published {
                    document: after,
                    body: &body,
                    graph,
                    instances: &found,
                };
                published.follow(&change, &mut edits);
            }
        }
    }
    edits
}

/// A group before the edits and after them. What it never published is not theirs to take away.
struct Change<'a> {
    was: &'a GroupDef,
    is: &'a GroupDef,
}

impl Change<'_> {
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

    /// What becomes of a wire from an instance: nothing, or it leads from another output, or (`Some(None)`) is gone.
    fn output(&self, from: &OutputRef) -> Option<Option<OutputRef>> {
        let is_there = |name: &str| self.is.outputs.contains_key(name);
        match from.port.as_deref() {
            Some(port) if is_there(port) || !self.was.outputs.contains_key(port) => None,
            Some(_) => Some(None),
            None if self.is.outputs.len() == 1 || self.was.outputs.len() != 1 => None,
            // A wire that names no output means the only one.
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
struct Instance<'a> {
    body: &'a Body,
    graph: &'a Graph,
    id: &'a NodeId,
    node: &'a Node,
}

impl Instance<'_> {
    fn inputs(&self, change: &Change<'_>, edits: &mut Vec<Edit>) {
        let gone = self.node.inputs.keys().filter(|name| change.lost_input(name));
        edits.extend(gone.map(|name| Edit::Disconnect {
            body: self.body.clone(),
            node: self.id.clone(),
            input: name.clone(),
        }));
    }

    fn knobs(&self, change: &Change<'_>, edits: &mut Vec<Edit>) {
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

    fn readers(&self, change: &Change<'_>, edits: &mut Vec<Edit>) {
        for slot in self.graph.readers(self.id.as_str()) {
            let reader = self.graph.node(slot.node.as_str());
            let Some(from) = reader.and_then(|node| node.inputs.get(&slot.name)) else {
                continue;
            };
            let Some(now) = change.output(from) else {
                continue;
            };
            let (body, node, input) = (self.body.clone(), slot.node, slot.name);
            edits.push(match now {
                Some(from) => Edit::Connect {
                    body,
                    node,
                    input,
                    from,
                },
                None => Edit::Disconnect { body, node, input },
            });
        }
    }
}

/// What a graph publishes of the instances in it.
struct Published<'a> {
    document: &'a Document,
    body: &'a Body,
    graph: &'a Graph,
    instances: &'a BTreeSet<&'a NodeId>,
}

impl Published<'_> {
    fn follow(&self, change: &Change<'_>, edits: &mut Vec<Edit>) {
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
                let knob = sabi_graph::Exposed { to, ..knob.clone() };
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
