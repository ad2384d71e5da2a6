//! Actions: everything that the views of the window ask for. Views show and ask; `app/perform.rs` does.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use egui::Pos2;
use sabi_editing::connections::PendingWire;
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::stack::StackEnd;
use sabi_editing::wires::MaskMerge;
use sabi_engine::NodeDraft;
use sabi_engine::catalog::Entry;
use sabi_graph::{Fit, NodeId, OutputRef, SlotRef, Value};

use crate::command::{Command, InputPreset};
use crate::dock::Panel;
use crate::import_options::ImportOptions;
use crate::knobs::KnobEvent;
use crate::settings::export::{ExportChoices, ExportPlace};
use crate::theme::Shade;

/// sRGB color that was clicked, or a sentence about why there is none.
pub(crate) type ClickedColor = Result<[u8; 3], String>;

/// Something that a view asks for.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// Perform a command, as a key or a menu entry asks for.
    Do(Command),
    /// Show a sentence for a while.
    Notice(String),
    /// Add a node, connected to a loose wire or put into a wire.
    Add {
        new: NewNode,
        place: [f32; 2],
        loose: Option<PendingWire>,
        into: Option<SlotRef>,
    },
    /// Add a node in the middle of the canvas.
    AddInMiddle(NewNode),
    /// Draw a node that is dragged to the canvas from another panel.
    DragNew { face: Arc<Entry>, at: Pos2 },
    /// Add a dragged node where it was dropped, if that is on the canvas.
    DropNew { new: NewNode, face: Arc<Entry>, at: Pos2 },
    /// Put the selected group into a library.
    AddToLibrary(LibraryKind),
    /// Write the file of a node of the artist's own.
    SaveNode(NodeDraft),
    /// Replace a node by one of another kind.
    Replace { node: NodeId, by: NewNode },
    /// Change wires.
    Wire(WireAction),
    /// Move nodes.
    Move(MoveAction),
    /// Disconnect the selected nodes and connect what they were between.
    TakeOut,
    /// Select these nodes and no others.
    Select(Vec<NodeId>),
    /// Go to the node or the port that an arrow key leads to.
    Arrow(ArrowKey),
    /// Add a node to the selection, or remove it from there.
    Toggle(NodeId),
    /// Show a node's result in the 2D view, and on the model where that follows clicks: at an output, or at the one that was
    /// chosen last.
    Show { node: NodeId, port: Option<String> },
    /// Keep a node's result in the 2D view, or release it.
    Pin { node: NodeId },
    /// Change what the model and the 2D view show.
    Look(LookAction),
    /// Show the inside of a group instance.
    Enter(NodeId),
    /// Leave groups until this many are left.
    LeaveTo(usize),
    /// Change a parameter of a node, and of the selected nodes of its kind.
    Knob { node: NodeId, event: KnobEvent },
    /// Change or set published parameters.
    Published(PublishedAction),
    /// Save, apply or change a variant.
    Variant(VariantAction),
    /// Change the inputs and outputs that the shown graph has as a group.
    Port(PortAction),
    /// Change a layer of a stack.
    Layer(LayerAction),
    /// Name a node.
    Rename { node: NodeId, name: String },
    /// Change frames around nodes.
    Frame(FrameAction),
    /// Paste nodes from a text at a place.
    Paste { text: String, place: [f32; 2] },
    /// Change what holds for the whole document.
    Document(DocumentAction),
    /// Open, save or replace the graph's file.
    File(FileAction),
    /// Change the model that the graph is shown on.
    Model(ModelAction),
    /// Take a file or a folder that was dropped on the window.
    Dropped(PathBuf),
    /// Select a node, which is named as the evaluation names it, and show it on the canvas.
    GoTo(String),
    /// Undo or redo this many steps; negative is undo.
    Steps(i32),
    /// Write textures, or change how.
    Export(ExportAction),
    /// Give the clicked color to the parameter that waits for one.
    TakeColor(ClickedColor),
    /// Change a setting.
    Setting(SettingAction),
    /// Bring a panel to the front.
    ShowPanel(Panel),
    /// Put all panels where they are in a new installation.
    ResetPanels,
    /// Show the start page.
    ShowStartPage,
}

/// Arrow key that leads from node to node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ArrowKey {
    Left,
    Right,
    Up,
    Down,
}

/// Step of a drag of nodes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum MoveAction {
    /// Begin the drag: everything until its end is one step to undo.
    Begin,
    /// Put nodes at these places.
    To(BTreeMap<NodeId, [f32; 2]>),
    /// End the drag.
    End,
    /// Cancel the drag: the nodes go back to where they were.
    Cancel,
}

/// Change of which result is shown where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LookAction {
    /// Show the outputs on the model.
    Outputs,
    /// Show the clicked node on the model.
    Follow,
    /// Keep the node that was clicked last on the model.
    Lock,
    /// Release the locked node.
    Release,
    /// Show the locked node beside what the model shows, or no longer.
    Compare,
    /// Show the clicked node in the 2D view again.
    Unpin,
}

/// Change of what holds for the whole document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DocumentAction {
    /// Texels along a side while working.
    Size(u32),
    /// Length that counts as 1.
    Fit(Fit),
    /// Seed that all nodes' seeds are made with.
    Seed(u32),
}

/// What takes the place of the open graph, once nothing is lost by that.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    New,
    Open(PathBuf),
    /// The example of this index.
    Example(usize),
    /// The recovered graph of this index.
    Recover(usize),
    /// Nothing: the window closes.
    Close,
}

/// Action about the graph's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FileAction {
    /// Go on with another graph, and ask first where changes would be lost.
    Ask(Next),
    /// Go on with another graph, whatever is lost.
    Proceed(Next),
    /// Save to the graph's file, or ask for one.
    Save,
    /// Save to another file, and ask first where that is another graph's.
    SaveAs(PathBuf),
    /// Save to another file, whatever is there.
    Overwrite(PathBuf),
    /// Read the graph again from its file, which another program has written.
    Reload,
    /// Keep the open graph although another program has written its file.
    KeepOpen,
    /// Delete what was kept of a graph that was never saved.
    DeleteRecovery(usize),
    /// Give an image file to a parameter.
    SetImage { parameter: KnobTarget, file: PathBuf },
}

/// Action about the model that the graph is shown on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ModelAction {
    /// Ask for a model file.
    Ask,
    /// Show another model.
    Show(PathBuf),
    /// Read the shown model with other options.
    Read(ImportOptions),
    /// Remove a model from the strip.
    Remove(PathBuf),
}

/// Action about exports.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ExportAction {
    /// Export; with `force` to a folder whatever files are in it.
    Start { force: bool },
    /// Cancel the running export.
    Cancel,
    /// Use these choices from now on.
    Choose(ExportChoices),
    /// Use this target for the open graph from now on.
    Target(ExportPlace),
}

/// Change of a setting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum SettingAction {
    Shade(Shade),
    InputPreset(InputPreset),
    /// Keys of commands that have others than the habit's, by the command's name.
    Keys(BTreeMap<String, Vec<String>>),
    /// Environment of the viewport: a built-in name, or a file.
    Environment(String),
    /// Make a favorite of what has this key, or no longer.
    ToggleFavorite(String),
}

/// Change of wires.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum WireAction {
    /// Connect an output to an input; `off` is the input that the wire is taken from.
    Connect {
        from: OutputRef,
        to: SlotRef,
        off: Option<SlotRef>,
    },
    /// Connect a second output to an input, with a node that merges both.
    Merge {
        from: OutputRef,
        to: SlotRef,
        how: MaskMerge,
    },
    /// Disconnect inputs.
    Cut(Vec<SlotRef>),
    /// Put a node into a wire.
    Insert { node: NodeId, into: SlotRef },
    /// Put a reroute into a wire.
    Reroute { into: SlotRef, place: [f32; 2] },
}

/// Change of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FrameAction {
    /// Name a frame.
    Rename { frame: String, title: String },
    /// Give a frame its next color.
    Recolor(String),
    /// Select the nodes in a frame.
    Select(String),
    /// Put the selected nodes into a frame, or take them out of all.
    Fill(Option<String>),
    /// Remove a frame.
    Remove(String),
}

/// Change of published parameters, which are named as published.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PublishedAction {
    /// Change a value.
    Turn(KnobEvent),
    /// Set the name that artists see.
    Label { name: String, label: String },
    /// Set the name in files and on command lines.
    Rename { name: String, to: String },
    /// Set the section of the panel.
    Section { name: String, section: String },
    /// Set the range.
    Range { name: String, range: Option<[f64; 2]> },
    /// Set the default, whatever the nodes of the parameter hold.
    Default { name: String, default: Option<Value> },
    /// Move before another parameter, or to the end.
    Move { name: String, before: Option<String> },
    /// Publish a parameter no longer.
    TakeOff(String),
}

/// Change of the variants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum VariantAction {
    /// Save the present values under a name.
    Save(String),
    /// Set the parameters to the values of a variant.
    Apply(String),
    /// Rename a variant.
    Rename { name: String, to: String },
    /// Remove a variant.
    Remove(String),
}

/// Change of the inputs and outputs of the shown graph, by their names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum PortAction {
    /// Name the graph.
    NameGraph(String),
    /// Publish an input of a node.
    PublishInput(SlotRef),
    /// Publish an output of a node.
    PublishOutput(OutputRef),
    /// Set the name of an input that artists see.
    LabelInput { name: String, label: String },
    /// Set the name of an input in files.
    RenameInput { name: String, to: String },
    /// Remove an input.
    RemoveInput(String),
    /// Connect an input to an input of a node.
    Feed { name: String, slot: SlotRef },
    /// Disconnect an input of a node from the input that feeds it.
    Unfeed(SlotRef),
    /// Rename an output.
    RenameOutput { name: String, to: String },
    /// Remove an output.
    RemoveOutput(String),
    /// Connect an output to another result.
    Retarget { name: String, from: OutputRef },
}

/// Change of layers, which are counted from the top of their stack.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LayerAction {
    /// Hide or show a layer.
    Toggle(NodeId),
    /// Set the opacity of a layer.
    Opacity { node: NodeId, opacity: f64 },
    /// Move a layer.
    Move { end: StackEnd, from: usize, to: usize },
    /// Remove a layer.
    Remove { end: StackEnd, at: usize },
    /// Add a layer of a kind above another one.
    Add { end: StackEnd, at: usize, kind: String },
}

/// Library of groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LibraryKind {
    /// Folder `library` beside the graph.
    Project,
    /// Library of the user.
    User,
}

/// What is added to a graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum NewNode {
    /// Node of a kind.
    Kind(String),
    /// Instance of one of the document's groups.
    Group(String),
    /// Group from a library file.
    Library(PathBuf),
}

impl NewNode {
    /// Key of a favorite in settings.
    pub(crate) fn key(&self) -> String {
        match self {
            NewNode::Kind(kind) => kind.clone(),
            NewNode::Group(group) => format!("group {group}"),
            NewNode::Library(file) => file.display().to_string(),
        }
    }
}
