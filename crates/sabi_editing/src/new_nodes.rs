//! New nodes, before they are added to a graph.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Edit, Node, NodeId, OutputRef, Value};
use sabi_nodes::kind::Role;

use crate::open_document::OpenDocument;

/// Creates a node of a kind with an id and random seeds, without adding it to the graph.
pub(crate) fn of_kind(document: &mut OpenDocument, kind: &str, pos: [f32; 2]) -> (NodeId, Node) {
    let mut node = Node::new(kind);
    node.pos = pos.map(f32::round);
    let entry = document.catalog().entry(kind).cloned();
    let seeds = entry
        .iter()
        .flat_map(|entry| &entry.knobs)
        .filter(|knob| knob.ty.role == Role::Seed);
    for knob in seeds {
        let seed = Value::Number(f64::from(document.ids.seed()));
        node.params.insert(knob.name.clone(), seed);
    }
    let stem = kind.rsplit_once('/').map_or(kind, |(_, name)| name);
    let id = document.new_id(stem, &BTreeSet::new());
    (id, node)
}

/// Edit that adds a node to the shown graph and connects its inputs.
pub(crate) fn addition(document: &OpenDocument, id: &NodeId, node: Node, inputs: BTreeMap<String, OutputRef>) -> Edit {
    Edit::AddNode {
        body: document.body(),
        id: id.clone(),
        node,
        inputs,
    }
}
