//! What panels ask for: they show and ask, and the window does.

use std::collections::BTreeMap;
use std::path::PathBuf;

use sabi_editing::{MaskMerge, PendingWire, StackEnd};
use sabi_engine::NodeDraft;
use sabi_graph::{NodeId, OutputRef, SlotRef, Value};

use crate::canvas::Way;
use crate::command::Command;
use crate::knobs::KnobEvent;
use crate::reading::Reading;

/// Something that a panel asks for.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// What a key or a menu entry means.
    Do(Command),
    /// Add a node of a kind.
    Add {
        kind: New,
        place: [f32; 2],
        loose: Option<PendingWire>,
        /// The wire into which it is put.
        into: Option<SlotRef>,
    },
    /// Put the selected group into a library.
    Shelve(Shelf),
    /// Write the file of a node of the artist's own.
    SaveNode(NodeDraft),
    /// Put a node of another kind in the place of one.
    Replace { node: NodeId, by: New },
    /// Change wires.
    Wire(WireAsk),
    /// A drag of nodes begins.
    BeginMove,
    /// Nodes are dragged.
    Move(BTreeMap<NodeId, [f32; 2]>),
    /// A drag of nodes ends.
    EndMove,
    /// A drag of nodes is let go: they are where they were.
    TakeBack,
    /// Take the selected nodes out of their wires and begin to drag them.
    TakeOut,
    /// Select these and nothing else.
    Select(Vec<NodeId>),
    /// Go to the node or the port that an arrow key leads to.
    Arrow(Way),
    /// Select one more, or one less.
    Toggle(NodeId),
    /// Show a node's result in the 2D view, and on the model where that follows: of an output, or the one chosen last.
    Show { node: NodeId, port: Option<String> },
    /// Show a node's result in the 2D view always.
    Pin { node: NodeId },
    /// Change what the model and the 2D view show.
    Look(LookAsk),
    /// Go into a group.
    Enter(NodeId),
    /// Go so far up.
    LeaveTo(usize),
    /// A knob of a node is turned; with the others of its kind that are selected.
    Knob { node: NodeId, event: KnobEvent },
    /// Change or turn what is published.
    Panel(PanelAsk),
    /// Save, apply or change a variant of the panel.
    Variant(VariantAsk),
    /// Change what the graph that is seen takes and gives as a group.
    Port(PortAsk),
    /// Change a layer of a stack.
    Layer(LayerAsk),
    /// Name a node.
    Rename { node: NodeId, name: String },
    /// Change frames around nodes.
    Frame(FrameAsk),
    /// Paste a text at a place.
    Paste { text: String, place: [f32; 2] },
    /// Open a graph file.
    OpenFile(PathBuf),
    /// Take another model.
    TakeModel(PathBuf),
    /// Read the model that is shown otherwise.
    ReadModel(Reading),
    /// Whatever a file is that was dropped on the window.
    Dropped(PathBuf),
    /// Show a node, which is named as the evaluation names it.
    GoTo(String),
    /// Take back or do again so many steps; negative is back.
    Steps(i32),
}

/// Something that is asked of what is shown where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LookAsk {
    /// Have the model show what the outputs make of it.
    Outputs,
    /// Have the model show the node that is clicked.
    Follow,
    /// Have the model show the node that was clicked last whatever is clicked from now on.
    Lock,
    /// Let the locked node go.
    Release,
    /// Show the locked node beside what the model shows, or no longer.
    Compare,
    /// Have the 2D view show the node that is clicked again.
    Unpin,
}

/// Something that is asked of wires.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum WireAsk {
    /// Tie a wire, taking it off another input where it came from one.
    Connect {
        from: OutputRef,
        to: SlotRef,
        off: Option<SlotRef>,
    },
    /// Tie a second wire to an input.
    Merge {
        from: OutputRef,
        to: SlotRef,
        how: MaskMerge,
    },
    /// Take wires off inputs.
    Cut(Vec<SlotRef>),
    /// Put a node into a wire.
    Insert { node: NodeId, into: SlotRef },
    /// Bend a wire.
    Reroute { into: SlotRef, place: [f32; 2] },
}

/// Something that is asked of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FrameAsk {
    /// Name one.
    Rename { frame: String, title: String },
    /// Give one its next color.
    Recolor(String),
    /// Select the nodes in one.
    Select(String),
    /// Put the selected nodes into one, or take them out of all.
    Fill(Option<String>),
    /// Remove one.
    Remove(String),
}

/// Something that is asked of the panel of published knobs; knobs go by their name on it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PanelAsk {
    /// Turn one.
    Turn(KnobEvent),
    /// The name that artists see.
    Label { name: String, label: String },
    /// The name in files and on command lines.
    Rename { name: String, to: String },
    /// The part of the panel that it stands in.
    Section { name: String, section: String },
    /// What it may hold.
    Range { name: String, range: Option<[f64; 2]> },
    /// What it holds while nobody sets it, whatever its nodes hold.
    Default { name: String, default: Option<Value> },
    /// Stand before another one, or at the end.
    Move { name: String, before: Option<String> },
    /// Take it off.
    TakeOff(String),
}

/// Something that is asked of the variants of the panel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum VariantAsk {
    /// Keep what the panel holds now under a name.
    Save(String),
    /// Turn the panel as one has it.
    Apply(String),
    /// Give one another name.
    Rename { name: String, to: String },
    /// Remove one.
    Remove(String),
}

/// Something that is asked of the inputs and outputs of the graph that is seen, which go by their names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum PortAsk {
    /// Name the graph.
    NameGraph(String),
    /// Make an input out of one of a node.
    PublishInput(SlotRef),
    /// Make an output out of a result.
    PublishOutput(OutputRef),
    /// The name of an input that artists see.
    LabelInput { name: String, label: String },
    /// The name of an input in files.
    RenameInput { name: String, to: String },
    /// Remove an input.
    RemoveInput(String),
    /// Have an input feed one of a node too.
    Feed { name: String, slot: SlotRef },
    /// Take an input of a node off what feeds it.
    Unfeed(SlotRef),
    /// The name of an output.
    RenameOutput { name: String, to: String },
    /// Remove an output.
    RemoveOutput(String),
    /// Have an output give another result.
    Retarget { name: String, from: OutputRef },
}

/// Something that is asked of layers, which are counted from the top of their stack.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LayerAsk {
    /// Hide or show one.
    Toggle(NodeId),
    /// How much of one is used.
    Opacity { node: NodeId, opacity: f64 },
    /// Put one elsewhere.
    Move { end: StackEnd, from: usize, to: usize },
    /// Remove one.
    Remove { end: StackEnd, at: usize },
    /// Add a node of a kind above one.
    Add { end: StackEnd, at: usize, kind: String },
}

/// A library of groups to be used again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shelf {
    /// In the folder `library` beside the graph.
    Project,
    /// The user's own.
    User,
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

impl New {
    /// What a favorite is remembered by.
    pub(crate) fn key(&self) -> String {
        match self {
            New::Kind(kind) => kind.clone(),
            New::Group(group) => format!("group {group}"),
            New::Library(file) => file.display().to_string(),
        }
    }
}
