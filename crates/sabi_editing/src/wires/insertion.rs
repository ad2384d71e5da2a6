//! Insertion of nodes into wires, and making space for them.

use sabi_engine::catalog::Interface;
use sabi_graph::{Edit, NodeId, SlotRef};

use crate::connections::PendingWire;
use crate::node_size::GRID;
use crate::open_document::OpenDocument;
use crate::{connections, node_size};

/// Space between an inserted node and the nodes before and after it, canvas points.
const ROOM: f32 = 3.0 * GRID;
/// Maximum number of steps up and down in which a free place is searched.
const MOST_STEPS: i32 = 200;

/// Inserts a node into the wire that leads to an input. Nodes that would overlap it move to the right.
pub fn insert(document: &mut OpenDocument, id: &NodeId, to: &SlotRef) -> bool {
    match inserting(document, id, to) {
        Some(mut edits) => {
            edits.extend(making_room(document, id, to));
            document.edit("Insert", edits)
        }
        None => document.refuse(
            "to insert a node into a wire, its output must be unconnected, and it needs a free input and an output of fitting types",
        ),
    }
}

/// Returns whether a node can be inserted into the wire that leads to an input, for a preview of the insertion.
pub fn can_insert(document: &OpenDocument, id: &NodeId, to: &SlotRef) -> bool {
    inserting(document, id, to).is_some()
}

/// Returns whether a node that does not exist yet could be inserted into the wire that leads to an input.
pub fn can_insert_new(document: &OpenDocument, interface: &Interface, to: &SlotRef) -> bool {
    let from = connections::wire_into(document, to);
    let reads = from.is_some_and(|from| interface.input_for(connections::carried(document, from)).is_some());
    reads && connections::input(document, to).is_some_and(|input| interface.output_for(input).is_some())
}

fn inserting(document: &OpenDocument, id: &NodeId, to: &SlotRef) -> Option<Vec<Edit>> {
    let from = connections::wire_into(document, to)?.clone();
    let is_read = !document.graph().readers(id.as_str()).is_empty();
    if from.node == *id || is_read || connections::depends_on(document, id, &to.node) {
        return None;
    }
    let interface = document.interface(id)?.clone();
    let into = connections::connecting_pending(document, &PendingWire::From(from), id, &interface)?;
    let out = connections::connecting_pending(document, &PendingWire::Into(to.clone()), id, &interface)?;
    Some(vec![into, out])
}

/// Returns edits that move an inserted node to the right of its source, and the nodes behind it further right, as far as
/// they would overlap.
fn making_room(document: &OpenDocument, id: &NodeId, to: &SlotRef) -> Vec<Edit> {
    let Some((source, own)) = connections::wire_into(document, to).zip(document.node(id)) else {
        return Vec::new();
    };
    let size = node_size::of(document, id);
    let (place, mut edits) = room_between(document, own.pos, size, Some(&source.node), &to.node, Some(id));
    if place != own.pos {
        edits.push(Edit::Move {
            body: document.body(),
            node: id.clone(),
            pos: place,
        });
    }
    edits
}

/// Returns a place for a box to the right of a node and before another one, and edits that move the latter and all nodes
/// that depend on it to the right, as far as they would overlap. `own` is the node of the box, if it exists.
pub(crate) fn room_between(
    document: &OpenDocument,
    mut place: [f32; 2],
    size: [f32; 2],
    source: Option<&NodeId>,
    reader: &NodeId,
    own: Option<&NodeId>,
) -> ([f32; 2], Vec<Edit>) {
    if let Some(right) = source.and_then(|source| right_of(document, source, place, size)) {
        place[0] = right;
    }
    let downstream = document.graph().downstream([reader]);
    let end = place[0] + size[0] + ROOM;
    let lefts = downstream.iter().filter_map(|other| {
        let is_over = right_of(document, other, place, size).is_some();
        Some(document.node(other)?.pos[0]).filter(|_| is_over)
    });
    let overlap = lefts.map(|left| end - left).fold(0.0, f32::max);
    let shift = (overlap / GRID).ceil() * GRID;
    let moved = downstream.iter().filter(|other| shift > 0.0 && Some(*other) != own);
    let places = moved.filter_map(|other| document.node(other).map(|node| (other.clone(), node.pos)));
    let moves = places.map(|(node, pos)| Edit::Move {
        body: document.body(),
        node,
        pos: [pos[0] + shift, pos[1]],
    });
    (place, moves.collect())
}

/// Returns a place near this one where a box covers none of these nodes: the same place, or one above or below it.
pub(crate) fn uncovering(document: &OpenDocument, place: [f32; 2], size: [f32; 2], nodes: &[&NodeId]) -> [f32; 2] {
    let step = |at: i32| 2.0 * GRID * (if at % 2 == 0 { -(at / 2) } else { at / 2 + 1 }) as f32;
    let places = (0..MOST_STEPS).map(|at| [place[0], place[1] + if at == 0 { 0.0 } else { step(at) }]);
    let is_free = |place: &[f32; 2]| nodes.iter().all(|id| right_of(document, id, *place, size).is_none());
    places.into_iter().find(is_free).unwrap_or(place) // If the graph is so dense that no place is free, the given place is used.
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
