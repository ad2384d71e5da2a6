//! Actions: all requests of the views of the window. Views return them, and `app/perform.rs` performs them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

use egui::Pos2;
use sabi_editing::command::{EditCommand, NodeSource, PaintCommand};
use sabi_editing::knob_target::KnobTarget;
use sabi_engine::catalog::Interface;
use sabi_engine::catalog::node_file::NodeDraft;
use sabi_export::SetKey;
use sabi_graph::{NodeId, NodeRef, Value};
use sabi_paint::{Stroke, Version};
use sabi_view::Mode;

use crate::brush_shelf::KeptBrush;
use crate::command::{Command, InputPreset};
use crate::dock::{Panel, Workspace};
use crate::import_options::ImportOptions;
use crate::knobs::KnobEvent;
use crate::settings::brush::BrushChoices;
use crate::settings::export::{ExportChoices, ExportPlace};
use crate::settings::stencil::StencilChoices;
use crate::settings::text_font::TextFont;
use crate::theme::ColorScheme;

/// sRGB color that was clicked, or a sentence about why there is none.
pub(crate) type ClickedColor = Result<[u8; 3], String>;

/// Request of a view.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// Perform the command of a key or a menu entry.
    Do(Command),
    /// Edit the open document. A node that is added is shown.
    Edit(EditCommand),
    /// Show a short notice.
    Notice(String),
    /// Add a node in the middle of the canvas.
    AddInMiddle(NodeSource),
    /// Draw a node that is dragged to the canvas from another panel.
    DragNew { interface: Arc<Interface>, at: Pos2 },
    /// Add a dragged node where it was dropped, if that is on the canvas.
    DropNew {
        new: NodeSource,
        interface: Arc<Interface>,
        at: Pos2,
    },
    /// Put the selected group into a library.
    AddToLibrary(LibraryKind),
    /// Write the file of a node of the artist's own.
    SaveNode(NodeDraft),
    /// Replace a node by one of another kind.
    Replace { node: NodeId, by: NodeSource },
    /// Select these nodes and no others.
    Select(Vec<NodeId>),
    /// Go to the node or the port that an arrow key leads to.
    Arrow(ArrowKey),
    /// Show a node's result in the 2D view, and on the model if the model follows clicks. Without a port, the output
    /// that was chosen last is shown.
    Show { node: NodeId, port: Option<String> },
    /// Show one channel of a node's material on the model.
    ShowChannel { node: NodeId, mode: Mode },
    /// Keep a node's result in the 2D view, or release it.
    Pin { node: NodeId },
    /// Change the results that the model and the 2D view show.
    Look(LookAction),
    /// Change a parameter of a node, and of the selected nodes of its kind.
    Knob { node: NodeId, event: KnobEvent },
    /// Change the value of an exposed parameter.
    TurnExposed(KnobEvent),
    /// Save the present values as a variant, with a picture of the model.
    SaveVariant(String),
    /// Open, save or replace the graph's file.
    File(FileAction),
    /// Change the model that the graph is shown on.
    Model(ModelAction),
    /// Perform an action about trust in files outside of the graph's folder.
    Trust(TrustAction),
    /// Open or use a file or a folder that was dropped on the window.
    Dropped(PathBuf),
    /// Add a picture as a node, or the pictures of a folder as texture sets.
    ImportPictures(PathBuf),
    /// Show a texture set in the 2D view.
    ShowSet(SetKey),
    /// Select a node, by its full id, and show it on the canvas.
    GoTo(String),
    /// Undo or redo this many steps; negative is undo.
    Steps(i32),
    /// Write textures, or change the choices for that.
    Export(ExportAction),
    /// Give the clicked color to the parameter that waits for one.
    TakeColor(ClickedColor),
    /// Give a gradient that was picked from a picture to a parameter.
    SetGradient { parameter: KnobTarget, stops: Value },
    /// Ask for the picture that a gradient is picked from.
    AskForGradient(KnobTarget),
    /// Paint on the model.
    Paint(PaintAction),
    /// Change a setting.
    Setting(SettingAction),
    /// Bring a panel to the front.
    ShowPanel(Panel),
    /// Arrange the panels for a kind of work.
    Arrange(Workspace),
    /// Show the start page.
    ShowStartPage,
}

impl Action {
    /// Edits the open document.
    pub(crate) fn edit(command: impl Into<EditCommand>) -> Action {
        Action::Edit(command.into())
    }
}

/// Arrow key that leads from node to node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ArrowKey {
    Left,
    Right,
    Up,
    Down,
}

/// Change of the results that the model and the 2D view show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LookAction {
    /// Show the outputs on the model.
    Outputs,
    /// Show the clicked node on the model.
    Follow,
    /// Keep the node that was clicked last on the model.
    PinIn3d,
    /// Release the node that is pinned to the 3D view.
    UnpinFrom3d,
    /// Begin or end the comparison of the node that is pinned to the 3D view with the node that the model shows.
    Compare,
    /// Show the clicked node in the 2D view again.
    UnpinFrom2d,
}

/// Step that is taken once no unsaved changes can be lost: another graph is opened, or the window closes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    New,
    Open(PathBuf),
    /// The example of this index.
    Example(usize),
    /// The recovered graph of this index.
    Recover(usize),
    /// No graph: the window closes.
    Close,
}

/// Action about the graph's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FileAction {
    /// Continue with another graph, and ask first if changes would be lost.
    Ask(Next),
    /// Continue with another graph, and discard changes.
    Proceed(Next),
    /// Save to the graph's file, or ask for one.
    Save,
    /// Save to another file, and ask first if it exists.
    SaveAs(PathBuf),
    /// Save to another file, and replace an existing one.
    Overwrite(PathBuf),
    /// Copy the version that another program has written, then save to the graph's file.
    SaveBesideTheirs,
    /// Allow saving to the graph's file, although another window has it open.
    AllowSaving,
    /// Write the graph with all files that it uses into an archive.
    Pack(PathBuf),
    /// Ask for the new place of a missing file, which the graph names by this path.
    AskForMissing(String),
    /// Name a file in place of a missing one, and files beside it in place of other missing ones.
    Find { lost: String, file: PathBuf },
    /// Read the graph again from its file, which another program has changed.
    Reload,
    /// Keep the open graph although another program has changed its file.
    KeepOpen,
    /// Delete the recovery file of a graph that was never saved.
    DeleteRecovery(usize),
    /// Ask for a file for a picture of the model's view.
    AskForPicture,
    /// Save a picture of the model's view.
    SavePicture(PathBuf),
    /// Give an image file to a parameter.
    SetImage { parameter: KnobTarget, file: PathBuf },
    /// Pick a gradient for a parameter from an image file.
    PickGradient { parameter: KnobTarget, file: PathBuf },
}

/// Trust that the user gives.
#[derive(Clone, Debug)]
pub(crate) enum TrustAction {
    /// Let graphs and models open the files of a folder.
    Folder(PathBuf),
    /// Use the node files of a folder.
    Nodes(PathBuf),
    /// Leave the node files beside the open graph unused, and do not ask again until another graph is opened.
    LeaveNodes,
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
    /// Cancel the reading of the model. The previous model stays; if there is none, a built-in one is shown.
    CancelReading,
    /// Remove a model from the strip.
    Remove(PathBuf),
    /// Ask for a model file to show beside the main model.
    AskBeside,
    /// Show a model beside the main one, with the same graph.
    ShowBeside(PathBuf),
    /// Remove a model from beside the main one.
    RemoveBeside(PathBuf),
}

/// Action about exports.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ExportAction {
    /// Export. With `force`, the folder may have other files in it.
    Start { force: bool },
    /// Cancel the running export.
    Cancel,
    /// Use these choices from now on.
    Choose(ExportChoices),
    /// Use this target for the open graph from now on.
    Target(ExportPlace),
}

/// Action of the brush.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PaintAction {
    /// Begin to paint on the selected paint node by drags on the model; with `value`, the brush gets that value.
    PaintSelected { value: Option<f32> },
    /// Begin a stroke and an undo step: the brush touches the model.
    Begin,
    /// Lay the stroke as it is drawn so far.
    Lay(PaintCommand),
    /// Change the list of strokes, and store it.
    Change(PaintCommand),
    /// End the stroke and store it: the brush is lifted.
    End,
    /// Cancel the stroke.
    Cancel,
    /// Mark the stroke that was just laid, if it is a decal.
    MarkNew,
    /// Mark these strokes in their list.
    Mark(BTreeSet<Version>),
    /// Put strokes on the clipboard.
    CopyStrokes(Vec<Arc<Stroke>>),
    /// Add the strokes of a text from the clipboard to the selected paint node.
    PasteStrokes(String),
    /// Use this brush from now on.
    Choose(Box<BrushChoices>),
    /// Begin or end the choice of the brush's color by a click on the model.
    TakeColor,
    /// Ask for a picture as the tip of the brush.
    AskForPicture,
    /// Use a file as the tip of the brush.
    TakePicture(PathBuf),
    /// Use the result of a node, evaluated on a square, as the tip of the brush.
    TakeNode(NodeRef),
    /// Use a text as the tip of the brush.
    TakeText(String),
    /// Use this font for texts from now on.
    ChooseFont(TextFont),
    /// Ask for a font file.
    AskForFont,
    /// Use these settings of the stencil.
    ChooseStencil(Box<StencilChoices>),
    /// Ask for a picture for the stencil.
    AskForStencil,
    /// Use a picture as the stencil.
    TakeStencil(PathBuf),
    /// Use a brush that is kept.
    UseKept(Box<KeptBrush>),
    /// Keep the brush under a name.
    Keep(String),
    /// Remove the file of a brush that is kept.
    RemoveKept(PathBuf),
    /// Ask for the file of a brush.
    AskForBrush,
    /// Keep the brush of a file, and use it.
    TakeBrush(PathBuf),
}

/// Change of a setting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum SettingAction {
    Shade(ColorScheme),
    InputPreset(InputPreset),
    /// Number of backups of a graph file.
    Backups(usize),
    /// Keys that differ from those of the preset, by the command's name.
    Keys(BTreeMap<String, Vec<String>>),
    /// Environment of the viewport: a built-in name, or a file.
    Environment(String),
    /// Show effects of the library on the open model, or with their own pictures.
    TryEffects(bool),
    /// Add the node, group or file with this key to the favorites, or remove it.
    ToggleFavorite(String),
}

/// Library of groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LibraryKind {
    /// Sabi's own effects.
    Sabi,
    /// Folder `library` beside the graph.
    Project,
    /// Library of the user.
    User,
}
