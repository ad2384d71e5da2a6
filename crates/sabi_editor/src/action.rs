//! What panels ask for: they show and ask, and the window does.

use std::collections::BTreeMap;
use std::path::PathBuf;

use sabi_graph::{NodeId, OutputRef, SlotRef};

use crate::command::Command;
use crate::desk::{Loose, Merge};
use crate::knobs::KnobEvent;

/// Something that a panel asks for.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// What a key or a menu entry means.
    Do(Command),
    /// Add a node of a kind.
    Add {
        kind: New,
        place: [f32; 2],
        loose: Option<Loose>,
        /// The wire into which it is put.
        into: Option<SlotRef>,
    },
    /// Put a node of another kind in the place of one.
    Replace { node: NodeId, kind: String },
    /// Tie a wire, taking it off another input where it came from one.
    Connect {
        from: OutputRef,
        to: SlotRef,
        off: Option<SlotRef>,
    },
    /// Tie a second wire to an input.
    Merge { from: OutputRef, to: SlotRef, how: Merge },
    /// Take wires off inputs.
    Cut(Vec<SlotRef>),
    /// Put a node into a wire.
    Insert { node: NodeId, into: SlotRef },
    /// Bend a wire.
    Reroute { into: SlotRef, place: [f32; 2] },
    /// A drag of nodes begins.
    BeginMove,
    /// Nodes are dragged.
    Move(BTreeMap<NodeId, [f32; 2]>),
    /// A drag of nodes ends.
    EndMove,
    /// Take the selected nodes out of their wires and begin to drag them.
    TakeOut,
    /// Select these and nothing else.
    Select(Vec<NodeId>),
    /// Select one more, or one less.
    Toggle(NodeId),
    /// Show a node's result in the 2D view and on the model.
    Show { node: NodeId, port: Option<String> },
    /// Show a node's result in the 2D view always.
    Pin { node: NodeId },
    /// Go into a group.
    Enter(NodeId),
    /// Go so far up.
    LeaveTo(usize),
    /// A knob of a node is turned; with the others of its kind that are selected.
    Knob { node: NodeId, event: KnobEvent },
    /// Name a node.
    Rename { node: NodeId, name: String },
    /// Name a frame.
    RenameFrame { frame: String, title: String },
    /// Give a frame its next color.
    RecolorFrame(String),
    /// Remove a frame.
    RemoveFrame(String),
    /// Paste a text at a place.
    Paste { text: String, place: [f32; 2] },
    /// Open a graph file.
    OpenFile(PathBuf),
    /// Save under a name.
    SaveTo(PathBuf),
    /// Take another model.
    TakeModel(PathBuf),
    /// Whatever a file is that was dropped on the window.
    Dropped(PathBuf),
    /// Show a node, which is named as the evaluation names it.
    GoTo(String),
    /// Take back or do again so many steps; negative is back.
    Steps(i32),
}

/// What is added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum New {
    /// A node of a kind.
    Kind(String),
    /// An instance of one of the document's groups.
    Group(String),
    /// A group out of a library file.
    Library(PathBuf),
}
