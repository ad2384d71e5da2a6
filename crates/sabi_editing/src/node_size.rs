//! Sizes of nodes on the canvas, which layout and drawing share.

use sabi_engine::catalog::{Entry, Knob, KnobRole};
use sabi_graph::{NodeId, REROUTE_KIND};

use crate::open_document::OpenDocument;

/// Width of a node, canvas points.
pub const NODE_WIDTH: f32 = 200.0;
/// Width and height of a reroute, which has a port at each side.
pub(crate) const REROUTE_SIZE: [f32; 2] = [36.0, 18.0];
/// Height of a node's title bar.
pub const TITLE_HEIGHT: f32 = 28.0;
/// Height of a port or a knob.
pub const ROW_HEIGHT: f32 = 19.0;
/// Side of a node's thumbnail.
pub const PICTURE_SIDE: f32 = 128.0;
/// Space above the thumbnail, and below the last row.
pub const MARGIN: f32 = 5.0;
/// Highest number of knobs on a node itself; the parameter panel shows all of them.
const MOST_KNOBS: usize = 3;
/// Distance that positions are snapped to, canvas points.
pub const GRID: f32 = 10.0;

/// Knobs that a node shows itself: the first ones that fit in a row and belong to no input, since inputs have rows already.
pub fn own_knobs(entry: &Entry) -> impl Iterator<Item = &Knob> {
    let fits_row = |role: &KnobRole| {
        matches!(
            role,
            KnobRole::Plain | KnobRole::Length | KnobRole::Angle | KnobRole::Choice(_) | KnobRole::Toggle
        )
    };
    let is_small =
        move |knob: &&Knob| knob.ty.role == KnobRole::Color || knob.ty.components() == 1 && fits_row(&knob.ty.role);
    let own = entry.knobs.iter().filter(|knob| !knob.is_of_input);
    own.filter(is_small).take(MOST_KNOBS)
}

/// Returns whether a node is a reroute, which is drawn as a dot.
pub fn is_reroute(entry: &Entry) -> bool {
    entry.id == REROUTE_KIND
}

/// Width and height of a node with its title bar, rows and, if it has a result, thumbnail; canvas points.
pub fn size_of(entry: &Entry) -> [f32; 2] {
    if is_reroute(entry) {
        return REROUTE_SIZE;
    }
    let rows = entry.inputs.len() + entry.outputs.len() + own_knobs(entry).count();
    let picture = if entry.outputs.is_empty() && entry.category() != "output" {
        0.0
    } else {
        PICTURE_SIDE + MARGIN
    };
    [NODE_WIDTH, TITLE_HEIGHT + rows as f32 * ROW_HEIGHT + picture + MARGIN]
}

/// Returns the vertical position at which the wire of an input ends, from the node's upper edge. Rows of inputs come
/// first.
pub fn input_row(entry: &Entry, row: usize) -> f32 {
    if is_reroute(entry) {
        return REROUTE_SIZE[1] / 2.0;
    }
    TITLE_HEIGHT + (row as f32 + 0.5) * ROW_HEIGHT
}

/// Returns the vertical position at which the wire of an output begins, from the node's upper edge.
pub fn output_row(entry: &Entry, row: usize) -> f32 {
    input_row(entry, entry.inputs.len() + own_knobs(entry).count() + row)
}

/// Width and height of a node of the shown graph, canvas points.
pub fn of(document: &OpenDocument, id: &NodeId) -> [f32; 2] {
    document
        .face(id)
        .map_or([NODE_WIDTH, TITLE_HEIGHT], |face| size_of(face))
}
