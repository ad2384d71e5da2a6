//! Display of a graph on the canvas: rows and wires of nodes, and notes. No result depends on it.

use std::collections::BTreeMap;

use crate::Value;

/// How a node is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeDisplay {
    /// Rows that it shows.
    pub rows: NodeRows,
    /// True if the wires from this node are drawn as its name at both ends.
    pub has_named_wires: bool,
}

/// Rows that a node shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NodeRows {
    /// All ports, its first parameters and its picture.
    #[default]
    All,
    /// Wired ports and its picture.
    Wired,
    /// Only the title.
    None,
}

impl NodeRows {
    /// All variants with their names in files.
    pub(crate) const NAMES: [(NodeRows, &str); 3] = [
        (NodeRows::All, "all"),
        (NodeRows::Wired, "wired"),
        (NodeRows::None, "none"),
    ];
}

/// A text on the canvas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Note {
    /// The text.
    pub text: String,
    /// Upper left corner, canvas points.
    pub pos: [f32; 2],
    /// Width, canvas points; the height follows from the text.
    pub width: f32,
    /// Color, `#rrggbb`.
    pub color: Option<String>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}
