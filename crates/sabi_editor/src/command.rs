//! Commands: actions without parameters, which keys and menu entries can be bound to.

mod table;

use strum::VariantArray;

/// Place that the pointer or the keyboard focus must be in for the key of a command to have its effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    /// Anywhere.
    Window,
    /// On the canvas.
    Canvas,
    /// On the model.
    Viewport,
    /// On the 2D view.
    Flat,
}

/// Program whose keys and drags are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum InputPreset {
    #[default]
    Default,
    Blender,
    Substance,
}

impl InputPreset {
    /// All presets with their titles.
    pub(crate) const ALL: [(InputPreset, &'static str); 3] = [
        (InputPreset::Default, "Default"),
        (InputPreset::Blender, "Blender"),
        (InputPreset::Substance, "Substance"),
    ];
}

/// Action without parameters, grouped by the owner that performs it. Each group is matched without a
/// wildcard where it is performed, so that a new command that is not handled does not compile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Command {
    File(FileCommand),
    Window(WindowCommand),
    Graph(GraphCommand),
    Arrange(ArrangeCommand),
    Canvas(CanvasCommand),
    Look(LookCommand),
    Viewport(ViewportCommand),
    Texture(TextureCommand),
    Brush(BrushCommand),
    /// Adds a node of one of the first nine favorites.
    Favorite(Favorite),
}

/// Command about the graph's file and the files that are written from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum FileCommand {
    /// Starts an empty graph.
    New,
    /// Asks for a graph file to open.
    Open,
    /// Saves the graph to its file.
    Save,
    /// Asks for a file to save the graph to.
    SaveAs,
    /// Asks for a picture, or a folder of pictures, to add.
    ImportPictures,
    /// Exports the textures with the choices of the export panel.
    Export,
    /// Asks for an archive to write the graph to, with all files that it uses.
    Pack,
}

/// Command about the window itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum WindowCommand {
    /// Moves the keyboard focus to the next panel.
    NextPanel,
    /// Moves the keyboard focus to the previous panel.
    PreviousPanel,
    /// Shows the page of the selected node.
    Help,
    /// Shows the tutorial.
    Tutorial,
    /// Shows or hides the list of keys.
    Keys,
    /// Shows only the model and the exposed parameters, or all panels again.
    UseView,
    /// Enlarges the interface by one step.
    Larger,
    /// Shrinks the interface by one step.
    Smaller,
}

/// Command that edits the nodes of the open graph or moves between groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum GraphCommand {
    /// Undoes the last step.
    Undo,
    /// Redoes the last step that was undone.
    Redo,
    /// Deletes the selected nodes.
    Delete,
    /// Deletes the selected nodes and connects their readers to their sources.
    Heal,
    /// Disconnects the selected nodes and connects their readers to their sources.
    TakeOut,
    /// Swaps the first two inputs of the selected node.
    SwapInputs,
    /// Mutes or unmutes the selected nodes.
    Mute,
    /// Collapses the selected nodes to their titles, or shows everything again.
    Collapse,
    /// Hides the unused ports of the selected nodes, or shows them again.
    HidePorts,
    /// Draws wires from the selected nodes as their names, or as wires again.
    NameWires,
    /// Duplicates the selected nodes.
    Duplicate,
    /// Duplicates the selected nodes with the wires into them.
    DuplicateWired,
    /// Copies the selected nodes to the clipboard.
    Copy,
    /// Moves the selected nodes to the clipboard.
    Cut,
    /// Pastes nodes from the clipboard.
    Paste,
    /// Puts a frame around the selected nodes.
    Frame,
    /// Makes a group of the selected nodes.
    Group,
    /// Replaces the selected group instances by their nodes.
    Ungroup,
    /// Shows the graph of the selected group instance.
    Enter,
    /// Cancels the current drag, or else leaves the group.
    Leave,
}

/// Command that places or selects nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ArrangeCommand {
    /// Aligns the left sides of the selected nodes.
    AlignLeft,
    /// Aligns the right sides of the selected nodes.
    AlignRight,
    /// Aligns the tops of the selected nodes.
    AlignTop,
    /// Aligns the bottoms of the selected nodes.
    AlignBottom,
    /// Spaces the selected nodes evenly from left to right.
    DistributeAcross,
    /// Spaces the selected nodes evenly from top to bottom.
    DistributeDown,
    /// Moves the selected nodes so that their wires are straight.
    Straighten,
    /// Lays out the selected nodes, or all.
    LayOut,
    /// Selects all nodes.
    SelectAll,
    /// Selects all muted nodes and no others.
    SelectMuted,
    /// Selects all nodes that the selected ones depend on.
    SelectUp,
    /// Selects all nodes that depend on the selected ones.
    SelectDown,
}

/// Command about the view of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum CanvasCommand {
    /// Opens the menu that adds a node.
    AddMenu,
    /// Renames the selected node in place.
    Rename,
    /// Writes a note at the pointer.
    AddNote,
    /// Zooms to the selected nodes.
    ShowSelected,
    /// Zooms to all nodes.
    ShowAll,
    /// Moves the keyboard focus to the next port of the selected node.
    NextPort,
    /// Moves the keyboard focus to the previous port of the selected node.
    PreviousPort,
    /// Takes a wire at the focused port, or drops the dragged one there.
    Wire,
}

/// Command about the results that views show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum LookCommand {
    /// Shows the selected node in the 2D view and on the model.
    Preview,
    /// Switches whether the model shows the clicked node or the outputs.
    Follow,
    /// Keeps the selected node on the model, or releases it.
    Pin,
    /// Switches node pictures between texture space and the model.
    FlatPictures,
    /// Shows or hides the overview of the whole graph.
    MiniMap,
    /// Begins or ends the comparison of the pinned node with the node that the model shows.
    Compare,
}

/// Command about the camera and overlays of the viewport.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ViewportCommand {
    /// Shows the whole model.
    ShowAll,
    /// Centers the view on the surface under the pointer.
    Focus,
    /// Looks from the front.
    Front,
    /// Looks from the right.
    Right,
    /// Looks from above.
    Top,
    /// Switches between perspective and parallel projection.
    Lens,
    /// Shows or hides the triangles.
    Wires,
    /// Shows or hides the seams.
    Seams,
    /// Shows the next channel alone.
    NextChannel,
    /// Shows the previous channel alone.
    PreviousChannel,
    /// Shows the whole material again.
    Material,
}

/// Command about the brush.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum BrushCommand {
    /// Begins to paint on the selected paint node, or over the selected mask; or ends it.
    Paint,
    /// Makes the brush larger.
    Larger,
    /// Makes the brush smaller.
    Smaller,
    /// Switches the brush between erasing and painting.
    Erase,
}

/// Command about the 2D view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum TextureCommand {
    /// Shows the whole texture.
    ShowAll,
    /// Shows one texel on one pixel.
    TrueSize,
    /// Shows or hides copies of the texture around it.
    Tile,
    /// Shows or hides the UV wires.
    UvWires,
}

/// Place in the list of favorites that a key adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, VariantArray)]
pub(crate) enum Favorite {
    First,
    Second,
    Third,
    Fourth,
    Fifth,
    Sixth,
    Seventh,
    Eighth,
    Ninth,
}

impl Favorite {
    /// All places, in order.
    pub(crate) const ALL: &'static [Favorite] = Favorite::VARIANTS;

    /// Index in the list of favorites, from 0.
    pub(crate) fn index(self) -> usize {
        self as usize
    }
}

impl Command {
    /// Returns whether the command applies even while a text field has the keyboard focus. Undo and redo do not: text
    /// fields have an undo history of their own.
    pub(crate) fn is_beside_text(self) -> bool {
        let is_history = matches!(self, Command::Graph(GraphCommand::Undo | GraphCommand::Redo));
        self.scope() == Scope::Window && !is_history
    }

    /// Returns whether the command can open a text field, which gets the text that is typed next.
    pub(crate) fn may_open_text_field(self) -> bool {
        matches!(
            self,
            Command::Canvas(CanvasCommand::AddMenu | CanvasCommand::Rename)
                | Command::File(FileCommand::Open | FileCommand::Save | FileCommand::SaveAs)
        )
    }
}
