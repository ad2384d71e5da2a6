//! Positions of nodes: moving, aligning, straightening and laying out.

mod layered_drawing;
mod layout;

use std::collections::BTreeMap;

use sabi_graph::{Edit, NodeId};

use crate::node_size;
use crate::open_document::OpenDocument;

pub use layout::lay_out;

/// Edges that nodes are aligned by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Left edges.
    Left,
    /// Right edges.
    Right,
    /// Top edges.
    Top,
    /// Bottom edges.
    Bottom,
}

/// Directions in which nodes are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DistributionAxis {
    /// From left to right.
    Horizontal,
    /// From top to bottom.
    Vertical,
}

/// Moves nodes to new positions. If many moves belong to one drag, the caller begins and ends the undo step.
pub fn move_nodes(document: &mut OpenDocument, step: &str, places: BTreeMap<NodeId, [f32; 2]>) -> bool {
    let body = document.body();
    let moved = places
        .into_iter()
        .filter(|(id, pos)| document.node(id).is_some_and(|node| node.pos != *pos));
    let edits: Vec<Edit> = moved
        .map(|(node, pos)| Edit::Move {
            body: body.clone(),
            node,
            pos,
        })
        .collect();
    document.edit(step, edits)
}

/// Positions of the selected nodes.
pub fn selected_positions(document: &OpenDocument) -> BTreeMap<NodeId, [f32; 2]> {
    let selected = document.selection().iter();
    selected
        .filter_map(|id| Some((id.clone(), document.node(id)?.pos)))
        .collect()
}

/// Aligns the selected nodes.
pub fn align(document: &mut OpenDocument, by: Align) -> bool {
    let mut places = selected_positions(document);
    let sizes: BTreeMap<NodeId, [f32; 2]> = places
        .keys()
        .map(|id| (id.clone(), node_size::of(document, id)))
        .collect();
    let ends = places.iter().map(|(id, pos)| match by {
        Align::Left => pos[0],
        Align::Right => pos[0] + sizes[id][0],
        Align::Top => pos[1],
        Align::Bottom => pos[1] + sizes[id][1],
    });
    let end = match by {
        Align::Left | Align::Top => ends.fold(f32::INFINITY, f32::min),
        Align::Right | Align::Bottom => ends.fold(f32::NEG_INFINITY, f32::max),
    };
    for (id, pos) in &mut places {
        match by {
            Align::Left => pos[0] = end,
            Align::Right => pos[0] = end - sizes[id][0],
            Align::Top => pos[1] = end,
            Align::Bottom => pos[1] = end - sizes[id][1],
        }
    }
    move_nodes(document, "Align", places)
}

/// Moves the selected nodes between the first and the last one so that the spaces between them are equal.
pub fn distribute(document: &mut OpenDocument, along: DistributionAxis) -> bool {
    let axis = match along {
        DistributionAxis::Horizontal => 0,
        DistributionAxis::Vertical => 1,
    };
    let mut places = selected_positions(document);
    if places.len() < 3 {
        return document.refuse("select three or more nodes to distribute them");
    }
    let mut order: Vec<(NodeId, f32)> = places
        .keys()
        .map(|id| (id.clone(), node_size::of(document, id)[axis]))
        .collect();
    order.sort_by(|(one, _), (other, _)| places[one][axis].total_cmp(&places[other][axis]));
    let (first, last) = (&order[0], &order[order.len() - 1]);
    let (begin, end) = (places[&first.0][axis], places[&last.0][axis]);
    let before_last: f32 = order[..order.len() - 1].iter().map(|(_, size)| size).sum();
    let steps = (order.len() - 1) as f32;
    let space = (end - begin - before_last) / steps;
    let mut at = begin;
    for (id, size) in &order {
        if let Some(pos) = places.get_mut(id) {
            pos[axis] = at;
        }
        // Nodes that do not fit beside each other get equal distances between their starts instead of equal spaces.
        at += if space < 0.0 {
            (end - begin) / steps
        } else {
            size + space
        };
    }
    move_nodes(document, "Distribute", places)
}

/// Moves the selected nodes up or down so that wires between them are horizontal: each node is aligned with its first source.
pub fn straighten(document: &mut OpenDocument) -> bool {
    let mut places = selected_positions(document);
    for id in document.graph().topological_order() {
        if !places.contains_key(&id) {
            continue;
        }
        let Some(interface) = document.interface(&id) else {
            continue;
        };
        let wired = interface.inputs.iter().enumerate().find_map(|(row, port)| {
            let from = document.graph().link_into(id.as_str(), &port.name)?;
            places.contains_key(&from.node).then_some((row, from.clone()))
        });
        let Some((row, from)) = wired else { continue };
        let Some(source) = document.interface(&from.node) else {
            continue;
        };
        let out = source
            .outputs
            .iter()
            .position(|port| Some(&port.name) == from.port.as_ref())
            .unwrap_or(0);
        let rows = node_size::rows_of(document, &from.node).zip(node_size::rows_of(document, &id));
        let Some((source_rows, rows)) = rows else { continue };
        let own = places[&from.node][1] + source_rows.output(out) - rows.input(row);
        if let Some(pos) = places.get_mut(&id) {
            pos[1] = own;
        }
    }
    move_nodes(document, "Straighten", places)
}
