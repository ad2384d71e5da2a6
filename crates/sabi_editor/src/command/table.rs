//! The commands: their names in settings, titles, scopes and keys.

use super::{
    ArrangeCommand, BrushCommand, CanvasCommand, Command, Favorite, FileCommand, GraphCommand, InputPreset,
    LookCommand, Scope, TextureCommand, ViewportCommand, WindowCommand,
};

/// Rows of a command, its name in settings, title, scope, keys, and keys of Blender and Substance where they differ. The
/// generated matches have no wildcard: a command without a row does not compile.
macro_rules! commands {
    ($($group:ident($kind:ident::$variant:ident) $name:literal $title:literal $scope:ident [$($chord:literal),*]
        $(blender [$($blender:literal),*])? $(substance [$($substance:literal),*])?;)*) => {
        impl Command {
            /// All commands, in the order of the list of keys.
            pub(crate) const ALL: &[Command] = &[$(Command::$group($kind::$variant),)*];

            /// Name in settings.
            pub(crate) fn name(self) -> &'static str {
                match self { $(Command::$group($kind::$variant) => $name,)* }
            }

            /// Title in menus and in the list of keys.
            pub(crate) fn title(self) -> &'static str {
                match self { $(Command::$group($kind::$variant) => $title,)* }
            }

            /// Scope in which its keys have their effect.
            pub(crate) fn scope(self) -> Scope {
                match self { $(Command::$group($kind::$variant) => Scope::$scope,)* }
            }

            /// Keys that are bound to it.
            pub(crate) fn keys(self, preset: InputPreset) -> &'static [&'static str] {
                match self {
                    $(Command::$group($kind::$variant) => {
                        let usual: &'static [&'static str] = &[$($chord),*];
                        $(if preset == InputPreset::Blender { return &[$($blender),*]; })?
                        $(if preset == InputPreset::Substance { return &[$($substance),*]; })?
                        let _ = preset;
                        usual
                    })*
                }
            }
        }
    };
}

commands! {
    File(FileCommand::New) "new" "New graph" Window ["Ctrl+N"];
    File(FileCommand::Open) "open" "Open…" Window ["Ctrl+O"];
    File(FileCommand::Save) "save" "Save" Window ["Ctrl+S"];
    File(FileCommand::SaveAs) "save_as" "Save as…" Window ["Ctrl+Shift+S"];
    File(FileCommand::ImportPictures) "import_pictures" "Import pictures…" Window [];
    File(FileCommand::Export) "export" "Export textures" Window ["Ctrl+E"];
    File(FileCommand::Pack) "pack" "Pack with all files…" Window [];
    Graph(GraphCommand::Undo) "undo" "Undo" Window ["Ctrl+Z"];
    Graph(GraphCommand::Redo) "redo" "Redo" Window ["Ctrl+Shift+Z", "Ctrl+Y"];
    Window(WindowCommand::NextPanel) "next_panel" "To the next panel" Window ["F6"];
    Window(WindowCommand::PreviousPanel) "previous_panel" "To the previous panel" Window ["Shift+F6"];
    Window(WindowCommand::Help) "help" "Help on the node" Window ["F1"];
    Window(WindowCommand::Tutorial) "tutorial" "Tutorial" Window ["Shift+F1"];
    Window(WindowCommand::Keys) "keys" "Keyboard shortcuts" Window ["Ctrl+/"];
    Window(WindowCommand::UseView) "use_view" "Model and parameters only" Window ["Ctrl+Space"];
    Window(WindowCommand::Larger) "larger" "Larger interface" Window ["Ctrl+="];
    Window(WindowCommand::Smaller) "smaller" "Smaller interface" Window ["Ctrl+-"];
    Canvas(CanvasCommand::AddMenu) "add_menu" "Add a node" Canvas ["Tab", "Space", "Shift+A"] blender ["Shift+A", "Space"] substance ["Space", "Tab"];
    Graph(GraphCommand::Delete) "delete" "Delete" Canvas ["Delete"] blender ["X", "Delete"];
    Graph(GraphCommand::Heal) "heal" "Delete and reconnect" Canvas ["Backspace"] blender ["Ctrl+X", "Backspace"];
    Graph(GraphCommand::TakeOut) "take_out" "Detach and reconnect its neighbors" Canvas ["Alt+X"];
    Graph(GraphCommand::SwapInputs) "swap_inputs" "Swap inputs" Canvas ["X", "Alt+S"] blender ["Alt+S"];
    Graph(GraphCommand::Mute) "mute" "Mute" Canvas ["M"];
    Graph(GraphCommand::Collapse) "collapse" "Collapse" Canvas ["H"];
    Graph(GraphCommand::HidePorts) "hide_ports" "Hide unused ports" Canvas ["Ctrl+H"];
    Graph(GraphCommand::NameWires) "name_wires" "Draw wires as names" Canvas ["Shift+W"];
    Graph(GraphCommand::Duplicate) "duplicate" "Duplicate" Canvas ["Ctrl+D"] blender ["Shift+D", "Ctrl+D"];
    Graph(GraphCommand::DuplicateWired) "duplicate_wired" "Duplicate with inputs" Canvas ["Ctrl+Shift+D"];
    Graph(GraphCommand::Copy) "copy" "Copy" Canvas ["Ctrl+C"];
    Graph(GraphCommand::Cut) "cut_nodes" "Cut" Canvas ["Ctrl+X"] blender [];
    Graph(GraphCommand::Paste) "paste" "Paste" Canvas ["Ctrl+V"];
    Graph(GraphCommand::Frame) "frame" "Add a frame" Canvas ["C"] blender ["Ctrl+J"];
    Canvas(CanvasCommand::Rename) "rename" "Rename" Canvas ["F2"];
    Canvas(CanvasCommand::AddNote) "add_note" "Add a note" Canvas ["Shift+C"];
    Arrange(ArrangeCommand::AlignLeft) "align_left" "Align left" Canvas ["Ctrl+Left"];
    Arrange(ArrangeCommand::AlignRight) "align_right" "Align right" Canvas ["Ctrl+Right"];
    Arrange(ArrangeCommand::AlignTop) "align_top" "Align top" Canvas ["Ctrl+Up"];
    Arrange(ArrangeCommand::AlignBottom) "align_bottom" "Align bottom" Canvas ["Ctrl+Down"];
    Arrange(ArrangeCommand::DistributeAcross) "distribute_across" "Distribute horizontally" Canvas ["Ctrl+Shift+Right"];
    Arrange(ArrangeCommand::DistributeDown) "distribute_down" "Distribute vertically" Canvas ["Ctrl+Shift+Down"];
    Arrange(ArrangeCommand::Straighten) "straighten" "Straighten wires" Canvas ["Q"];
    Arrange(ArrangeCommand::LayOut) "lay_out" "Lay out" Canvas ["L"] blender ["V"];
    Arrange(ArrangeCommand::SelectAll) "select_all" "Select all" Canvas ["Ctrl+A"] blender ["A", "Ctrl+A"];
    Arrange(ArrangeCommand::SelectMuted) "select_muted" "Select muted nodes" Canvas ["Shift+M"];
    Arrange(ArrangeCommand::SelectUp) "select_up" "Select upstream nodes" Canvas ["Ctrl+L"] blender ["L"];
    Arrange(ArrangeCommand::SelectDown) "select_down" "Select downstream nodes" Canvas ["Ctrl+Shift+L"] blender ["Shift+L"];
    Canvas(CanvasCommand::ShowSelected) "frame_selected" "Show the selected nodes" Canvas ["F"] blender ["Period", "F"];
    Canvas(CanvasCommand::ShowAll) "frame_all" "Show all nodes" Canvas ["A"] blender ["Home"];
    Graph(GraphCommand::Group) "group" "Group" Canvas ["Ctrl+G"];
    Graph(GraphCommand::Ungroup) "ungroup" "Ungroup" Canvas ["Ctrl+Shift+G"] blender ["Ctrl+Alt+G"];
    Graph(GraphCommand::Enter) "enter" "Enter the group" Canvas ["Enter"] blender ["Tab", "Enter"];
    Graph(GraphCommand::Leave) "leave" "Leave the group" Canvas ["Escape"];
    Look(LookCommand::Preview) "preview" "Show in the 2D and 3D view" Canvas ["V", "R"] blender ["R"];
    Look(LookCommand::Follow) "follow" "3D view follows clicks, or shows the outputs" Window ["Shift+V"];
    Look(LookCommand::Pin) "pin" "Pin this node to the 3D view" Window ["P"];
    Look(LookCommand::FlatPictures) "flat" "Thumbnails flat or on the model" Canvas ["T"];
    Look(LookCommand::MiniMap) "mini_map" "Mini map" Canvas ["N"];
    Canvas(CanvasCommand::NextPort) "next_port" "To the next port" Canvas ["Ctrl+Tab", "J"];
    Canvas(CanvasCommand::PreviousPort) "previous_port" "To the previous port" Canvas ["Ctrl+Shift+Tab", "K"];
    Canvas(CanvasCommand::Wire) "wire" "Start or drop a wire at the port" Canvas ["W"];
    Favorite(Favorite::First) "favorite_1" "Add favorite 1" Canvas ["1"];
    Favorite(Favorite::Second) "favorite_2" "Add favorite 2" Canvas ["2"];
    Favorite(Favorite::Third) "favorite_3" "Add favorite 3" Canvas ["3"];
    Favorite(Favorite::Fourth) "favorite_4" "Add favorite 4" Canvas ["4"];
    Favorite(Favorite::Fifth) "favorite_5" "Add favorite 5" Canvas ["5"];
    Favorite(Favorite::Sixth) "favorite_6" "Add favorite 6" Canvas ["6"];
    Favorite(Favorite::Seventh) "favorite_7" "Add favorite 7" Canvas ["7"];
    Favorite(Favorite::Eighth) "favorite_8" "Add favorite 8" Canvas ["8"];
    Favorite(Favorite::Ninth) "favorite_9" "Add favorite 9" Canvas ["9"];
    Viewport(ViewportCommand::ShowAll) "frame_model" "Show all of the model" Viewport ["A", "Home"] blender ["Home"];
    Viewport(ViewportCommand::Focus) "focus_model" "Focus on the surface under the pointer" Viewport ["F"] blender ["Period", "F"];
    Viewport(ViewportCommand::Front) "front" "Front view" Viewport ["1"];
    Viewport(ViewportCommand::Right) "right" "Right view" Viewport ["3"];
    Viewport(ViewportCommand::Top) "top" "Top view" Viewport ["7"];
    Viewport(ViewportCommand::Lens) "lens" "Perspective or orthographic" Viewport ["5"];
    Viewport(ViewportCommand::Wires) "wires" "Wireframe" Viewport ["W"];
    Viewport(ViewportCommand::Seams) "seams" "Seams" Viewport ["S"];
    Viewport(ViewportCommand::NextChannel) "next_channel" "Next channel" Viewport ["Period"] blender ["Ctrl+Period"];
    Viewport(ViewportCommand::PreviousChannel) "previous_channel" "Previous channel" Viewport ["Comma"];
    Viewport(ViewportCommand::Material) "material" "The whole material" Viewport ["M"];
    Look(LookCommand::Compare) "wipe" "Compare with the pinned node" Viewport ["C"];
    Brush(BrushCommand::Paint) "paint" "Paint on the model" Window ["B"];
    Brush(BrushCommand::Larger) "brush_larger" "Larger brush" Viewport ["CloseBracket"];
    Brush(BrushCommand::Smaller) "brush_smaller" "Smaller brush" Viewport ["OpenBracket"];
    Brush(BrushCommand::Erase) "brush_erase" "Paint or erase" Viewport ["E"];
    Texture(TextureCommand::ShowAll) "fit_flat" "Show all of the texture" Flat ["A", "F"];
    Texture(TextureCommand::TrueSize) "true_size" "Zoom 1:1" Flat ["Z"];
    Texture(TextureCommand::Tile) "tile_flat" "Repeat the texture" Flat ["T"];
    Texture(TextureCommand::UvWires) "uv_wires" "UV wires" Flat ["W"];
}
