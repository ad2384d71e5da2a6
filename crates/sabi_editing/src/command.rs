//! Edits as data: everything that an artist can do to the open document.

mod exposing_commands;
mod node_commands;
mod perform;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use sabi_graph::{Fit, NodeId, OutputRef, SavedView, SlotRef};
use sabi_paint::{Step, Stroke};

pub use exposing_commands::{ExposedCommand, PortCommand, VariantCommand};
pub use node_commands::{ArrangeCommand, GroupCommand, KnobCommand, LayerCommand, NodeCommand, NodeSource};
pub use perform::perform;

use crate::notes::NoteChange;
use crate::wires::MaskMerge;

/// Everything that an artist can do to the open document.
#[derive(Clone, Debug, PartialEq)]
pub enum EditCommand {
    /// Undo, redo and steps of several edits.
    History(HistoryCommand),
    /// Changes of what is selected.
    Selection(SelectionCommand),
    /// Changes of which graph is shown.
    Navigation(NavigationCommand),
    /// Nodes.
    Node(NodeCommand),
    /// Knobs of nodes.
    Knob(KnobCommand),
    /// Positions of nodes.
    Arrange(ArrangeCommand),
    /// Wires.
    Wire(WireCommand),
    /// Frames around nodes.
    Frame(FrameCommand),
    /// Texts on the canvas.
    Note(NoteCommand),
    /// Groups.
    Group(GroupCommand),
    /// The clipboard.
    Clipboard(ClipboardCommand),
    /// Exposed knobs.
    Exposed(ExposedCommand),
    /// Variants.
    Variant(VariantCommand),
    /// Inputs and outputs of the shown graph.
    Port(PortCommand),
    /// Layers of a stack.
    Layer(LayerCommand),
    /// Settings of the whole document.
    Document(DocumentCommand),
    /// Strokes of a brush.
    Paint(PaintCommand),
}

/// Implements the conversion of each group of commands to an [`EditCommand`].
macro_rules! groups {
    ($($group:ident: $command:ident,)*) => {
        $(impl From<$command> for EditCommand {
            fn from(command: $command) -> EditCommand {
                EditCommand::$group(command)
            }
        })*
    };
}

groups! {
    History: HistoryCommand,
    Selection: SelectionCommand,
    Navigation: NavigationCommand,
    Node: NodeCommand,
    Knob: KnobCommand,
    Arrange: ArrangeCommand,
    Wire: WireCommand,
    Frame: FrameCommand,
    Note: NoteCommand,
    Group: GroupCommand,
    Clipboard: ClipboardCommand,
    Exposed: ExposedCommand,
    Variant: VariantCommand,
    Port: PortCommand,
    Layer: LayerCommand,
    Document: DocumentCommand,
    Paint: PaintCommand,
}

/// Result of a command. If it was refused, the reason is among the document's notices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The command was refused, or there was nothing to change.
    Unchanged,
    /// The command was carried out.
    Done,
    /// A node was added, or replaced another one.
    Added(NodeId),
    /// Nodes were copied as this text, which the caller puts on the clipboard.
    Copied(String),
    /// A file was written.
    Saved(PathBuf),
}

impl From<bool> for Outcome {
    fn from(is_done: bool) -> Outcome {
        if is_done { Outcome::Done } else { Outcome::Unchanged }
    }
}

/// Change of painted strokes.
#[derive(Clone, Debug, PartialEq)]
pub enum PaintCommand {
    /// Replace the strokes of a paint node on a model by its earlier strokes plus this stroke on top.
    Stroke {
        /// Paint node.
        node: NodeId,
        /// Name of the model's file without its ending.
        model: String,
        /// Version of its strokes before the stroke.
        before: String,
        /// The stroke.
        stroke: Arc<Stroke>,
    },
    /// Apply several changes to the strokes of a paint node on a model, as one undo step.
    Steps {
        /// Paint node.
        node: NodeId,
        /// Name of the model's file without its ending.
        model: String,
        /// Version of its strokes before the changes.
        before: String,
        /// Name of the undo step.
        title: String,
        /// The changes.
        steps: Vec<Step>,
    },
    /// Add a paint node on top of a mask and select it. A paint node is only selected.
    Over(NodeId),
}

/// Undo, redo and steps of several edits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HistoryCommand {
    /// Undo the last step.
    Undo,
    /// Redo the last step that was undone.
    Redo,
    /// Begin an undo step with this name: all edits until its end are undone together.
    Begin(String),
    /// End the step that was begun.
    End,
    /// Cancel the step that was begun: the document is as it was before.
    Cancel,
}

/// Change of what is selected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SelectionCommand {
    /// Select these nodes and no others.
    Only(Vec<NodeId>),
    /// Add a node to the selection, or remove it from there.
    Toggle(NodeId),
    /// Select all nodes of the shown graph.
    All,
    /// Select all muted nodes of the shown graph and no others.
    Muted,
    /// Add all nodes that the selected ones depend on.
    Upstream,
    /// Add all nodes that depend on the selected ones.
    Downstream,
}

/// Change of which graph is shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NavigationCommand {
    /// Show the graph of a group instance.
    Enter(NodeId),
    /// Leave the group that was entered last.
    Leave,
    /// Leave groups until this many instances are entered.
    LeaveTo(usize),
    /// Select a node by its id in the evaluation, and show the graph that contains it.
    GoTo(String),
}

/// Change of wires.
#[derive(Clone, Debug, PartialEq)]
pub enum WireCommand {
    /// Connect an output to an input.
    Connect {
        /// Output that the wire starts at.
        from: OutputRef,
        /// Input that the wire leads to.
        to: SlotRef,
        /// Input from which the wire was taken.
        off: Option<SlotRef>,
    },
    /// Connect a second output to an input that is connected already.
    Merge {
        /// Second output.
        from: OutputRef,
        /// Input that is connected already.
        to: SlotRef,
        /// Method by which both masks are merged.
        how: MaskMerge,
    },
    /// Disconnect inputs.
    Disconnect(Vec<SlotRef>),
    /// Remove the mask that multiplies a parameter.
    RemoveMask(SlotRef),
    /// Insert a node into a wire.
    Insert {
        /// Node that is inserted.
        node: NodeId,
        /// Input that the wire leads to.
        into: SlotRef,
    },
    /// Add a reroute to a wire.
    Reroute {
        /// Input that the wire leads to.
        into: SlotRef,
        /// Center of the reroute, canvas points.
        place: [f32; 2],
    },
    /// Disconnect the selected nodes, and connect the nodes before them to the nodes behind them.
    DetachSelected,
    /// Swap the first two inputs of the same type of each selected node.
    SwapInputs,
}

/// Change of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FrameCommand {
    /// Add a frame around the selected nodes.
    Add,
    /// Set the title of a frame.
    Rename {
        /// Id of the frame.
        frame: String,
        /// New title.
        title: String,
    },
    /// Give a frame the next color of the palette.
    Recolor(String),
    /// Select the nodes in a frame.
    Select(String),
    /// Move the selected nodes into a frame, or (`None`) out of all frames.
    Assign(Option<String>),
    /// Remove a frame; its nodes stay.
    Remove(String),
}

/// Texts on the canvas.
#[derive(Clone, Debug, PartialEq)]
pub enum NoteCommand {
    /// Add a note.
    Add {
        /// Upper left corner, canvas points.
        place: [f32; 2],
        /// Its text.
        text: String,
    },
    /// Change a note.
    Change {
        /// Id of the note.
        note: String,
        /// The change of the note.
        change: NoteChange,
    },
    /// Remove a note.
    Remove(String),
}

/// Copying and pasting nodes as text.
#[derive(Clone, Debug, PartialEq)]
pub enum ClipboardCommand {
    /// Copy the selected nodes.
    Copy,
    /// Copy the selected nodes and delete them.
    Cut,
    /// Paste nodes from a text.
    Paste {
        /// Text from the clipboard.
        text: String,
        /// Upper left corner of the pasted nodes, canvas points.
        place: [f32; 2],
    },
}

/// Change of a setting of the whole document.
#[derive(Clone, Debug, PartialEq)]
pub enum DocumentCommand {
    /// Set the size in texels of the textures that are used while editing.
    SetSize(u32),
    /// Set the length that counts as 1.
    SetFit(Fit),
    /// Set the seed that is combined with the seeds of all nodes.
    SetSeed(u32),
    /// Save a view of the model under a name. An existing view with that name is replaced.
    KeepView(String, SavedView),
    /// Delete a saved view.
    ForgetView(String),
}

/// Positions of nodes, canvas points.
pub type Positions = BTreeMap<NodeId, [f32; 2]>;
