//! Copies of nodes with new ids.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Edit, Frame, Graph, Node, NodeId, SlotRef};

use crate::open_document::OpenDocument;
use crate::{frames, new_nodes, ports};

/// Offset of a copy from its original, canvas points.
const COPY_OFFSET: [f32; 2] = [40.0, 40.0];

/// Copied nodes before they are added, with the frames around them.
pub(crate) struct Copies {
    pub(crate) nodes: Vec<(NodeId, Node)>,
    /// Id of each copy, by the id of the original.
    pub(crate) new_id: BTreeMap<NodeId, NodeId>,
    frames: Vec<(String, Frame)>,
}

impl Copies {
    pub(crate) fn ids(&self) -> Vec<NodeId> {
        self.nodes.iter().map(|(id, _)| id.clone()).collect()
    }
}

/// Frames of a graph that contain only chosen nodes.
pub(crate) fn frames_around(graph: &Graph, is_chosen: impl Fn(&NodeId) -> bool) -> BTreeMap<String, Frame> {
    let frames = graph.frames().iter();
    let whole = frames.filter(|(_, frame)| {
        // A frame may list nodes that no longer exist.
        let mut there = frame
            .nodes
            .iter()
            .filter(|id| graph.node(id.as_str()).is_some())
            .peekable();
        there.peek().is_some() && there.all(&is_chosen)
    });
    whole.map(|(id, frame)| (id.clone(), frame.clone())).collect()
}

/// Copies the selected nodes with the wires between them. If `keeps_inputs` is true, wires from other nodes are copied, too.
pub fn duplicate(document: &mut OpenDocument, keeps_inputs: bool) -> bool {
    let chosen = document
        .selection()
        .iter()
        .filter_map(|id| Some((id.clone(), document.node(id)?.clone())));
    let chosen: BTreeMap<NodeId, Node> = chosen.collect();
    let frames = frames_around(document.graph(), |id| chosen.contains_key(id));
    let copies = copies(document, &chosen, frames, keeps_inputs, COPY_OFFSET);
    let mut fed = Vec::new();
    if keeps_inputs {
        for (slot, by) in ports::fed_by_group(document, |id| copies.new_id.contains_key(id)) {
            let node = copies.new_id[&slot.node].clone();
            fed.push((SlotRef { node, ..slot }, Some(by)));
        }
    }
    let ids = copies.ids();
    let mut edits = additions(document, copies);
    ports::refeed(document, &mut edits, fed);
    document.edit_and_select("Duplicate", edits, ids)
}

/// Copies nodes under new ids. A copy keeps its seed, so that it looks like the original.
pub(crate) fn copies(
    document: &mut OpenDocument,
    nodes: &BTreeMap<NodeId, Node>,
    frames: BTreeMap<String, Frame>,
    keeps_inputs: bool,
    offset: [f32; 2],
) -> Copies {
    let mut taken = BTreeSet::new();
    let mut new_id = BTreeMap::new();
    for id in nodes.keys() {
        let stem = id.as_str().rsplit_once('_').map_or(id.as_str(), |(stem, _)| stem);
        let copy = document.new_id(stem, &taken);
        taken.insert(copy.clone());
        new_id.insert(id.clone(), copy);
    }
    let copy = |(id, node): (&NodeId, &Node)| {
        let mut copy = node.clone();
        copy.inputs
            .retain(|_, from| keeps_inputs || nodes.contains_key(&from.node));
        for from in copy.inputs.values_mut() {
            if let Some(new) = new_id.get(&from.node) {
                from.node = new.clone();
            }
        }
        copy.pos = [0, 1].map(|axis| node.pos[axis] + offset[axis]);
        (new_id[id].clone(), copy)
    };
    let nodes = nodes.iter().map(copy).collect();
    let frames = copied_frames(document, frames, &new_id);
    Copies { nodes, new_id, frames }
}

fn copied_frames(
    document: &mut OpenDocument,
    frames: BTreeMap<String, Frame>,
    new_id: &BTreeMap<NodeId, NodeId>,
) -> Vec<(String, Frame)> {
    let mut taken = frames::ids(document);
    let mut copied = Vec::new();
    for mut frame in frames.into_values() {
        let id = document.new_id("frame", &taken);
        frame.nodes = frame.nodes.iter().filter_map(|id| new_id.get(id).cloned()).collect();
        copied.push((id.to_string(), frame));
        taken.insert(id);
    }
    copied
}

/// Applies these edits, adds the copies and selects them, all as one undo step.
pub(crate) fn add_all(document: &mut OpenDocument, step: &str, mut edits: Vec<Edit>, copies: Copies) -> bool {
    let ids = copies.ids();
    edits.extend(additions(document, copies));
    document.edit_and_select(step, edits, ids)
}

/// Edits that add copies: all nodes first, since they may read each other, then their wires and frames.
pub(crate) fn additions(document: &OpenDocument, copies: Copies) -> Vec<Edit> {
    let body = document.body();
    let mut wires = Vec::new();
    let mut edits: Vec<Edit> = Vec::new();
    for (id, mut node) in copies.nodes {
        for (input, from) in std::mem::take(&mut node.inputs) {
            wires.push(Edit::Connect {
                body: body.clone(),
                node: id.clone(),
                input,
                from,
            });
        }
        edits.push(new_nodes::addition(document, &id, node));
    }
    edits.extend(wires);
    edits.extend(copies.frames.into_iter().map(|(id, frame)| Edit::AddFrame {
        body: body.clone(),
        id,
        frame,
    }));
    edits
}
