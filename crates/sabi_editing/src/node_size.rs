//! Sizes of nodes on the canvas, which layout and drawing share.

use sabi_engine::catalog::{Entry, Knob, KnobRole};
use sabi_graph::{NodeId, REROUTE_KIND};

use crate::open_document::OpenDocument;

/// Width of a node, canvas points.
pub const NODE_WIDTH: f32 = 200.0;
/// Width and height of a bend in a wire, which has a port at each end.
pub(crate) const BEND_SIZE: [f32; 2] = [36.0, 18.0];
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

/// Width and height of a node that is seen, canvas points.
pub fn of(document: &OpenDocument, id: &NodeId) -> [f32; 2] {
    document
        .face(id)
        .map_or([NODE_WIDTH, TITLE_HEIGHT], |face| size_of(face))
}
