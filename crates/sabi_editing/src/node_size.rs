//! Sizes of nodes on the canvas, used by layout and drawing.

use std::collections::BTreeSet;

use sabi_engine::catalog::{Interface, Knob};
use sabi_graph::{Graph, NodeId, NodeRows, REROUTE_KIND};
use sabi_nodes::kind::Role;

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
/// Maximum number of knobs on a node. The parameter panel shows all of them.
const MOST_KNOBS: usize = 3;
/// Grid to which positions are snapped, canvas points.
pub const GRID: f32 = 10.0;

/// Returns the knobs that are shown on a node: the first ones that fit into a row and do not belong to an input, since
/// inputs have rows anyway.
pub fn own_knobs(entry: &Interface) -> impl Iterator<Item = &Knob> {
    let fits_row = |role: &Role| {
        matches!(
            role,
            Role::Plain | Role::Length | Role::Angle | Role::Choice(_) | Role::Toggle
        )
    };
    let is_small =
        move |knob: &&Knob| knob.ty.role == Role::Color || knob.ty.components() == 1 && fits_row(&knob.ty.role);
    let own = entry.knobs.iter().filter(|knob| !knob.is_of_input);
    own.filter(is_small).take(MOST_KNOBS)
}

/// Returns whether a node is a reroute, which is drawn as a dot.
pub fn is_reroute(entry: &Interface) -> bool {
    entry.id == REROUTE_KIND
}

/// Rows that a node shows, and their positions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownRows {
    inputs: VisibleRows,
    outputs: VisibleRows,
    knobs: usize,
    has_picture: bool,
    is_reroute: bool,
}

/// Choice of the rows of a list that are shown.
#[derive(Clone, Debug, PartialEq, Eq)]
enum VisibleRows {
    All(usize),
    Some(Vec<usize>),
}

impl VisibleRows {
    fn count(&self) -> usize {
        match self {
            VisibleRows::All(count) => *count,
            VisibleRows::Some(rows) => rows.len(),
        }
    }

    /// Returns the position of a row among the shown rows.
    fn place(&self, row: usize) -> Option<usize> {
        match self {
            VisibleRows::All(count) => (row < *count).then_some(row),
            VisibleRows::Some(rows) => rows.iter().position(|shown| *shown == row),
        }
    }
}

impl ShownRows {
    /// Returns all rows of a node.
    pub fn all(entry: &Interface) -> ShownRows {
        ShownRows {
            inputs: VisibleRows::All(entry.inputs.len()),
            outputs: VisibleRows::All(entry.outputs.len()),
            knobs: own_knobs(entry).count(),
            has_picture: !entry.outputs.is_empty() || entry.category() == "output",
            is_reroute: is_reroute(entry),
        }
    }

    /// Returns the rows of a node of a graph, according to its display settings.
    pub fn of(graph: &Graph, id: &NodeId, entry: &Interface) -> ShownRows {
        let all = ShownRows::all(entry);
        let Some(node) = graph.node(id.as_str()).filter(|_| !all.is_reroute) else {
            return all;
        };
        match node.display.rows {
            NodeRows::All => all,
            NodeRows::Wired => {
                let is_wired = |row: &usize| graph.link_into(id.as_str(), &entry.inputs[*row].name).is_some();
                ShownRows {
                    inputs: VisibleRows::Some((0..entry.inputs.len()).filter(is_wired).collect()),
                    outputs: VisibleRows::Some(read_outputs(graph, id, entry)),
                    knobs: 0,
                    ..all
                }
            }
            NodeRows::None => ShownRows {
                inputs: VisibleRows::Some(Vec::new()),
                outputs: VisibleRows::Some(Vec::new()),
                knobs: 0,
                has_picture: false,
                is_reroute: false,
            },
        }
    }

    /// Width and height of the node with its title bar, rows and thumbnail, canvas points.
    pub fn size(&self) -> [f32; 2] {
        if self.is_reroute {
            return REROUTE_SIZE;
        }
        let rows = self.inputs.count() + self.knobs + self.outputs.count();
        let picture = if self.has_picture { PICTURE_SIDE + MARGIN } else { 0.0 };
        [NODE_WIDTH, TITLE_HEIGHT + rows as f32 * ROW_HEIGHT + picture + MARGIN]
    }

    /// Returns the vertical position of the end of an input's wire, from the node's upper edge: the middle of its row, or
    /// of the title if the row is hidden. Rows of inputs come first.
    pub fn input(&self, row: usize) -> f32 {
        self.middle_of(self.inputs.place(row))
    }

    /// Returns the index, among the shown knobs, of the knob at a vertical position from the node's upper edge.
    pub fn knob_at(&self, down: f32) -> Option<usize> {
        let row = ((down - TITLE_HEIGHT) / ROW_HEIGHT).floor();
        let rows = self.inputs.count()..self.inputs.count() + self.knobs;
        let row = (row >= 0.0).then_some(row as usize)?;
        rows.contains(&row).then(|| row - rows.start)
    }

    /// Returns the vertical position of the start of an output's wire, from the node's upper edge.
    pub fn output(&self, row: usize) -> f32 {
        let before = self.inputs.count() + self.knobs;
        self.middle_of(self.outputs.place(row).map(|place| before + place))
    }

    fn middle_of(&self, place: Option<usize>) -> f32 {
        match place {
            _ if self.is_reroute => REROUTE_SIZE[1] / 2.0,
            Some(place) => TITLE_HEIGHT + (place as f32 + 0.5) * ROW_HEIGHT,
            None => TITLE_HEIGHT / 2.0,
        }
    }

    /// Returns the position of an input among the shown inputs.
    pub fn place_of_input(&self, input: usize) -> Option<usize> {
        self.inputs.place(input)
    }

    /// Returns the position of an output among the shown outputs.
    pub fn place_of_output(&self, output: usize) -> Option<usize> {
        self.outputs.place(output)
    }

    /// Returns whether an input has a row.
    pub fn shows_input(&self, input: usize) -> bool {
        self.place_of_input(input).is_some()
    }

    /// Returns whether an output has a row.
    pub fn shows_output(&self, output: usize) -> bool {
        self.place_of_output(output).is_some()
    }

    /// Returns whether the node shows knobs.
    pub fn shows_knobs(&self) -> bool {
        self.knobs > 0
    }

    /// Returns whether the node shows its thumbnail.
    pub fn shows_picture(&self) -> bool {
        self.has_picture
    }
}

/// Returns the outputs of a node that have readers. If there are none, returns the first output, so that a wire can be started there.
fn read_outputs(graph: &Graph, id: &NodeId, entry: &Interface) -> Vec<usize> {
    let first = entry.outputs.first().map(|port| port.name.as_str());
    let read: BTreeSet<&str> = graph
        .readers(id.as_str())
        .iter()
        .filter_map(|slot| graph.link_into(slot.node.as_str(), &slot.name))
        .filter_map(|from| from.port.as_deref().or(first))
        .collect();
    let is_read = |row: &usize| read.contains(entry.outputs[*row].name.as_str());
    let rows: Vec<usize> = (0..entry.outputs.len()).filter(is_read).collect();
    match rows.is_empty() && !entry.outputs.is_empty() {
        true => vec![0],
        false => rows,
    }
}

/// Width and height of a node that shows all rows, canvas points.
pub fn size_of(entry: &Interface) -> [f32; 2] {
    ShownRows::all(entry).size()
}

/// Returns the rows of a node of the shown graph; `None` if there is no such node.
pub fn rows_of(document: &OpenDocument, id: &NodeId) -> Option<ShownRows> {
    let interface = document.interface(id)?;
    Some(ShownRows::of(document.graph(), id, interface))
}

/// Width and height of a node of the shown graph, canvas points.
pub fn of(document: &OpenDocument, id: &NodeId) -> [f32; 2] {
    rows_of(document, id).map_or([NODE_WIDTH, TITLE_HEIGHT], |rows| rows.size())
}
