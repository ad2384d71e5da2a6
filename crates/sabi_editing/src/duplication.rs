//! Copies of nodes with new ids.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Edit, Frame, Graph, Node, NodeId, OutputRef, SlotRef};

use crate::open_document::OpenDocument;
use crate::{connections, frames, new_nodes, ports};

/// Offset of a copy from its original, canvas points.
const COPY_OFFSET: [f32; 2] = [40.0, 40.0];

/// Copied nodes before they are added, with the frames around them.
pub(crate) struct Copies {
    pub(crate) nodes: Vec<(NodeId, Node)>,
    wires: Vec<(SlotRef, OutputRef)>,
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
    let wires = wires_between(document.graph(), &chosen, keeps_inputs);
    let copies = copies(document, &chosen, wires, frames, COPY_OFFSET);
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

/// Wires between some nodes of a graph. If `keeps_inputs` is true, those from other nodes are listed, too.
pub(crate) fn wires_between(
    graph: &Graph,
    nodes: &BTreeMap<NodeId, Node>,
    keeps_inputs: bool,
) -> Vec<(SlotRef, OutputRef)> {
    let is_kept = |from: &NodeId| keeps_inputs || nodes.contains_key(from);
    let wires = nodes.keys().flat_map(|id| {
        let wires = connections::wires_from(graph, id, is_kept).into_iter();
        let node = id.clone();
        wires.map(move |(name, from)| {
            (
                SlotRef {
                    node: node.clone(),
                    name,
                },
                from,
            )
        })
    });
    wires.collect()
}

/// Copies nodes under new ids, with wires into them. A copy keeps its seed, so that it looks like the original.
pub(crate) fn copies(
    document: &mut OpenDocument,
    nodes: &BTreeMap<NodeId, Node>,
    mut wires: Vec<(SlotRef, OutputRef)>,
    frames: BTreeMap<String, Frame>,
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
        copy.pos = [0, 1].map(|axis| node.pos[axis] + offset[axis]);
        (new_id[id].clone(), copy)
    };
    let nodes = nodes.iter().map(copy).collect();
    for (to, from) in &mut wires {
        for id in [&mut to.node, &mut from.node] {
            if let Some(new) = new_id.get(id) {
                *id = new.clone();
            }
        }
    }
    let frames = copied_frames(document, frames, &new_id);
    Copies {
        nodes,
        wires,
        new_id,
        frames,
    }
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
    let nodes = copies.nodes.into_iter();
    let mut edits: Vec<Edit> = nodes
        .map(|(id, node)| new_nodes::addition(document, &id, node, BTreeMap::new()))
        .collect();
    edits.extend(copies.wires.into_iter().map(|(to, from)| Edit::Connect {
        body: body.clone(),
        node: to.node,
        input: to.name,
        from,
    }));
    edits.extend(copies.frames.into_iter().map(|(id, frame)| Edit::AddFrame {
        body: body.clone(),
        id,
        frame,
    }));
    edits
}
