//! Where nodes stand: moving, aligning, straightening, laying out.

use std::collections::BTreeMap;

use sabi_engine::catalog::{Entry, Knob, KnobRole};
use sabi_graph::{Edit, NodeId, REROUTE_KIND};

use super::OpenDocument;

/// Width of a node, canvas points.
pub const NODE_WIDTH: f32 = 200.0;
/// Width and height of a bend in a wire, which has a port at each end.
pub(super) const BEND_SIZE: [f32; 2] = [36.0, 18.0];
/// Height of the strip with a node's title.
pub const TITLE_HEIGHT: f32 = 28.0;
/// Height of a port or a knob.
pub const ROW_HEIGHT: f32 = 19.0;
/// Side of the picture of a result.
pub const PICTURE_SIDE: f32 = 128.0;
/// Above the picture, and below everything.
pub const MARGIN: f32 = 5.0;
/// Most knobs that a node shows itself; the panel has all of them.
const MOST_KNOBS: usize = 3;
/// Places snap to multiples of it.
pub const GRID: f32 = 10.0;

/// Knobs that a node itself shows: its first ones that are quick to turn, and of inputs none, since those have rows.
pub fn own_knobs(entry: &Entry) -> impl Iterator<Item = &Knob> {
    let is_quick = |role: &KnobRole| {
        matches!(
            role,
            KnobRole::Plain | KnobRole::Length | KnobRole::Angle | KnobRole::Choice(_) | KnobRole::Toggle
        )
    };
    let is_small =
        move |knob: &&Knob| knob.ty.role == KnobRole::Color || knob.ty.components() == 1 && is_quick(&knob.ty.role);
    let own = entry.knobs.iter().filter(|knob| !knob.is_of_input);
    own.filter(is_small).take(MOST_KNOBS)
}

/// Whether a node is a mere bend in a wire, which is drawn as a dot.
pub fn is_bend(entry: &Entry) -> bool {
    entry.id == REROUTE_KIND
}

/// Width and height of a node: a title, rows, and a picture where there is a result.
pub fn size_of(entry: &Entry) -> [f32; 2] {
    if is_bend(entry) {
        return BEND_SIZE;
    }
    let rows = entry.inputs.len() + entry.outputs.len() + own_knobs(entry).count();
    let picture = if entry.outputs.is_empty() && entry.category() != "output" {
        0.0
    } else {
        PICTURE_SIDE + MARGIN
    };
    [NODE_WIDTH, TITLE_HEIGHT + rows as f32 * ROW_HEIGHT + picture + MARGIN]
}

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

impl OpenDocument {
    /// Width and height of a node that is seen, canvas points.
    pub fn size(&self, id: &NodeId) -> [f32; 2] {
        self.face(id).map_or([NODE_WIDTH, TITLE_HEIGHT], |face| size_of(face))
    }

    /// Moves nodes by so much; those that are dragged move within one step, which the caller begins and ends.
    pub fn move_to(&mut self, step: &str, places: BTreeMap<NodeId, [f32; 2]>) -> bool {
        let body = self.body();
        let moved = places
            .into_iter()
            .filter(|(id, pos)| self.node(id).is_some_and(|node| node.pos != *pos));
        let edits: Vec<Edit> = moved
            .map(|(node, pos)| Edit::Move {
                body: body.clone(),
                node,
                pos,
            })
            .collect();
        self.edit(step, edits)
    }

    /// Places of the selected nodes.
    pub fn places(&self) -> BTreeMap<NodeId, [f32; 2]> {
        let selected = self.selection.iter();
        selected
            .filter_map(|id| Some((id.clone(), self.node(id)?.pos)))
            .collect()
    }

    /// Brings the selected nodes in line.
    pub fn align(&mut self, by: Align) -> bool {
        let mut places = self.places();
        let sizes: BTreeMap<NodeId, [f32; 2]> = places.keys().map(|id| (id.clone(), self.size(id))).collect();
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
        self.move_to("Align", places)
    }

    /// Moves the selected nodes up or down so that the wires among them run level: each to the first of those it reads.
    pub fn straighten(&mut self) -> bool {
        let mut places = self.places();
        for id in self.graph().topological_order() {
            let Some(node) = self.node(&id).filter(|_| places.contains_key(&id)) else {
                continue;
            };
            let Some(face) = self.face(&id) else { continue };
            let wired = face.inputs.iter().enumerate().find_map(|(row, port)| {
                let from = node.inputs.get(&port.name)?;
                places.contains_key(&from.node).then_some((row, from.clone()))
            });
            let Some((row, from)) = wired else { continue };
            let Some(source) = self.face(&from.node) else {
                continue;
            };
            let out = source
                .outputs
                .iter()
                .position(|port| Some(&port.name) == from.port.as_ref())
                .unwrap_or(0);
            let level = places[&from.node][1] + output_row(source, out);
            let own = level - input_row(face, row);
            if let Some(pos) = places.get_mut(&id) {
                pos[1] = own;
            }
        }
        self.move_to("Straighten", places)
    }
}

/// Where the wire of an input ends, from the node's upper edge: rows of inputs come first.
pub fn input_row(entry: &Entry, row: usize) -> f32 {
    if is_bend(entry) {
        return BEND_SIZE[1] / 2.0;
    }
    TITLE_HEIGHT + (row as f32 + 0.5) * ROW_HEIGHT
}

/// Where the wire of an output begins, from the node's upper edge.
pub fn output_row(entry: &Entry, row: usize) -> f32 {
    input_row(entry, entry.inputs.len() + own_knobs(entry).count() + row)
}
