//! Insertion of nodes into wires, with room for them.

use std::collections::{BTreeMap, BTreeSet};

use sabi_engine::catalog::Entry;
use sabi_graph::{Edit, NodeId, SlotRef};

use crate::connections::PendingWire;
use crate::node_size::GRID;
use crate::open_document::OpenDocument;
use crate::{connections, node_size};

/// Space between an inserted node and the nodes before and after it, canvas points.
const ROOM: f32 = 3.0 * GRID;

/// Inserts a node into the wire that leads to an input. Nodes that would overlap it move to the right.
pub fn insert(document: &mut OpenDocument, id: &NodeId, to: &SlotRef) -> bool {
    match inserting(document, id, to) {
        Some(mut edits) => {
            edits.extend(making_room(document, id, to));
            document.edit("Insert", edits)
        }
        None => document.refuse(
            "only a node that nobody reads yet, with a free input and a result that fit, can be put into a wire",
        ),
    }
}

/// Returns whether a node can be inserted into the wire that leads to an input, for a preview of the insertion.
pub fn can_insert(document: &OpenDocument, id: &NodeId, to: &SlotRef) -> bool {
    inserting(document, id, to).is_some()
}

/// Returns whether a node that does not exist yet could be inserted into the wire that leads to an input.
pub fn can_insert_new(document: &OpenDocument, face: &Entry, to: &SlotRef) -> bool {
    let from = connections::wire_into(document, to);
    let reads = from.is_some_and(|from| face.input_for(connections::carried(document, from)).is_some());
    reads && connections::input(document, to).is_some_and(|input| face.output_for(input).is_some())
}

fn inserting(document: &OpenDocument, id: &NodeId, to: &SlotRef) -> Option<Vec<Edit>> {
    let from = connections::wire_into(document, to)?.clone();
    let is_read = !document.graph().readers(id.as_str()).is_empty();
    if from.node == *id || is_read || connections::depends_on(document, id, &to.node) {
        return None;
    }
    let face = document.face(id)?.clone();
    let into = connections::connecting_pending(document, &PendingWire::From(from), id, &face)?;
    let out = connections::connecting_pending(document, &PendingWire::Into(to.clone()), id, &face)?;
    Some(vec![into, out])
}

/// Edits that move an inserted node to the right of its source, and the nodes behind it to the right of it, as far as they
/// would overlap.
fn making_room(document: &OpenDocument, id: &NodeId, to: &SlotRef) -> Vec<Edit> {
    let Some((source, own)) = connections::wire_into(document, to).zip(document.node(id)) else {
        return Vec::new();
    };
    let mut place = own.pos;
    if let Some(right) = right_of(document, &source.node, place, node_size::of(document, id)) {
        place[0] = right;
    }
    let downstream = downstream(document, &to.node);
    let end = place[0] + node_size::of(document, id)[0] + ROOM;
    let lefts = downstream.iter().filter_map(|other| {
        let is_over = right_of(document, other, place, node_size::of(document, id)).is_some();
        Some(document.node(other)?.pos[0]).filter(|_| is_over)
    });
    let shift = lefts.map(|left| end - left).fold(0.0, f32::max);
    let shift = (shift / GRID).ceil() * GRID;
    let moved = downstream.iter().filter(|other| shift > 0.0 && *other != id);
    let mut places: BTreeMap<NodeId, [f32; 2]> = moved
        .filter_map(|other| document.node(other).map(|node| (other.clone(), node.pos)))
        .map(|(other, pos)| (other, [pos[0] + shift, pos[1]]))
        .collect();
    if place != own.pos {
        places.insert(id.clone(), place);
    }
    let body = document.body();
    let moves = places.into_iter().map(|(node, pos)| Edit::Move {
        body: body.clone(),
        node,
        pos,
    });
    moves.collect()
}

/// Returns the left edge at which a box of `size` is right of a node; none if the box at `place` does not overlap it.
fn right_of(document: &OpenDocument, other: &NodeId, place: [f32; 2], size: [f32; 2]) -> Option<f32> {
    let (pos, other_size) = (document.node(other)?.pos, node_size::of(document, other));
    let is_apart = |axis: usize, room: f32| {
        place[axis] >= pos[axis] + other_size[axis] + room || pos[axis] >= place[axis] + size[axis] + room
    };
    let right = pos[0] + other_size[0] + ROOM;
    (!is_apart(0, ROOM) && !is_apart(1, 0.0)).then_some((right / GRID).ceil() * GRID)
}

/// A node and all nodes that depend on it.
fn downstream(document: &OpenDocument, id: &NodeId) -> BTreeSet<NodeId> {
    let mut found = BTreeSet::from([id.clone()]);
    let mut next = vec![id.clone()];
    while let Some(id) = next.pop() {
        let readers = connections::neighbors(document, &id, false).into_iter();
        next.extend(readers.filter(|id| found.insert(id.clone())));
    }
    found
}
