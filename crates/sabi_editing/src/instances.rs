//! Group instances: the ports that a graph has when used as a group, its instances in the document, and renames of their ports.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sabi_engine::catalog::{Interface, Interfaces};
use sabi_graph::{
    Body, Document, Edit, ExposedParameter, GROUP_KIND, Graph, GroupInput, Node, NodeId, OutputRef, SlotRef,
};

/// All graphs of a document.
pub(crate) fn bodies(document: &Document) -> Vec<(Body, &Graph)> {
    let groups = document.groups.iter();
    let groups = groups.map(|(name, group)| (Body::Group(name.clone()), &group.graph));
    std::iter::once((Body::Main, &document.graph)).chain(groups).collect()
}

/// Returns the instances of a group in a graph.
pub(crate) fn instances<'g>(graph: &'g Graph, group: &'g str) -> impl Iterator<Item = (&'g NodeId, &'g Node)> {
    let of_group = move |node: &Node| node.kind == GROUP_KIND && node.group.as_deref() == Some(group);
    graph.nodes().filter(move |(_, node)| of_group(node))
}

/// Returns the inputs and outputs that a graph has when used as a group.
pub(crate) fn ports<'d>(
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

/// Returns edits that rename knobs in all exposed knobs that control them.
pub(crate) fn renamed_knobs(document: &Document, matches: impl Fn(&Body, &SlotRef) -> bool, to: &str) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (body, graph) in bodies(document) {
        for (name, knob) in graph.exposed() {
            let mut knob: ExposedParameter = knob.clone();
            if renamed(&mut knob.to, |slot| matches(&body, slot), to) {
                let curves = knob.curves.into_iter().map(|(mut slot, curve)| {
                    if matches(&body, &slot) {
                        to.clone_into(&mut slot.name);
                    }
                    (slot, curve)
                });
                knob.curves = curves.collect();
                let (body, name) = (body.clone(), name.clone());
                edits.push(Edit::Expose { body, name, knob });
            }
        }
    }
    edits
}

/// Returns the instances of the shown group in all graphs; none for the main graph.
pub(crate) fn of_body(document: &Document, shown: &Body) -> Vec<(Body, NodeId, Node)> {
    let Body::Group(open) = shown else {
        return Vec::new();
    };
    let bodies = bodies(document).into_iter();
    let found = bodies.flat_map(|(body, graph)| {
        instances(graph, open).map(move |(id, node)| (body.clone(), id.clone(), node.clone()))
    });
    found.collect()
}

/// Returns a test for ports and knobs of instances of the shown group.
pub(crate) fn is_instance_of(document: &Document, shown: &Body) -> impl Fn(&Body, &SlotRef) -> bool + use<> {
    let found = of_body(document, shown).into_iter();
    let found: BTreeSet<(Body, NodeId)> = found.map(|(body, id, _)| (body, id)).collect();
    move |body: &Body, slot: &SlotRef| found.contains(&(body.clone(), slot.node.clone()))
}

/// Returns edits that rename inputs in all group inputs that feed them.
pub(crate) fn renamed_inputs(document: &Document, matches: impl Fn(&Body, &SlotRef) -> bool, to: &str) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (body, _) in bodies(document) {
        for (name, input) in ports(document, &body).0 {
            let mut input = input.clone();
            if renamed(&mut input.to, |slot| matches(&body, slot), to) {
                let (body, name, input) = (body.clone(), name.clone(), Some(input));
                edits.push(Edit::SetInput { body, name, input });
            }
        }
    }
    edits
}

/// Renames the slots that match. Returns whether any matched.
fn renamed(slots: &mut [SlotRef], matches: impl Fn(&SlotRef) -> bool, to: &str) -> bool {
    let mut is_changed = false;
    for slot in slots.iter_mut().filter(|slot| matches(slot)) {
        slot.name = to.to_owned();
        is_changed = true;
    }
    is_changed
}

/// Returns the ports and knobs of instances of a graph.
pub(crate) fn interface_of<'f>(interfaces: &'f Interfaces, body: &Body) -> Option<&'f Arc<Interface>> {
    match body {
        Body::Main => interfaces.of_whole(),
        Body::Group(name) => interfaces.of_group(name),
    }
}
