//! Everything that a key or a menu entry can ask for without saying more, with the keys that ask for it.

use egui::{Key, Modifiers};

/// Where the pointer or the focus has to be for a key to mean this.
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

/// Habits that keys follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Habit {
    #[default]
    Default,
    Blender,
    Substance,
}

impl Habit {
    /// All of them, with what they are called.
    pub(crate) const ALL: [(Habit, &'static str); 3] = [
        (Habit::Default, "Default"),
        (Habit::Blender, "Blender"),
        (Habit::Substance, "Substance"),
    ];
}

/// A key with what is held down with it; `Ctrl` is Command on a Mac.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chord {
    pub(crate) modifiers: Modifiers,
    pub(crate) key: Key,
}

impl Chord {
    /// Reads `Ctrl+Shift+D`.
    pub(crate) fn parse(text: &str) -> Result<Chord, String> {
        let mut modifiers = Modifiers::NONE;
        // The key itself may be a plus.
        let (held, key) = match text.strip_suffix("++") {
            Some(held) => (held, "+"),
            None => text.rsplit_once('+').unwrap_or(("", text)),
        };
        for word in held.split('+').filter(|word| !word.is_empty()) {
            match word.trim() {
                "Ctrl" => modifiers.command = true,
                "Shift" => modifiers.shift = true,
                "Alt" => modifiers.alt = true,
                other => return Err(format!("'{other}' is no key to hold; there are Ctrl, Shift and Alt")),
            }
        }
        let key = Key::from_name(key.trim()).ok_or_else(|| format!("there is no key '{}'", key.trim()))?;
        Ok(Chord { modifiers, key })
    }

    /// How it is written.
    pub(crate) fn text(self) -> String {
        let held = [
            (self.modifiers.command || self.modifiers.ctrl, "Ctrl+"),
            (self.modifiers.shift, "Shift+"),
            (self.modifiers.alt, "Alt+"),
        ];
        let held: String = held
            .iter()
            .filter(|(is_held, _)| *is_held)
            .map(|(_, word)| *word)
            .collect();
        format!("{held}{}", self.key.name())
    }

    /// Whether this is what was pressed.
    pub(crate) fn is(self, modifiers: Modifiers, key: Key) -> bool {
        let held = |modifiers: Modifiers| [modifiers.command || modifiers.ctrl, modifiers.shift, modifiers.alt];
        key == self.key && held(modifiers) == held(self.modifiers)
    }
}

/// The commands: variant, name in settings, title, scope, keys, and those of Blender and Substance where they differ.
macro_rules! commands {
    ($($variant:ident $name:literal $title:literal $scope:ident [$($chord:literal),*]
        $(blender [$($blender:literal),*])? $(substance [$($substance:literal),*])?;)*) => {
        /// Something that can be asked for.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub(crate) enum Command {
            $(#[doc = $title] $variant,)*
        }

        impl Command {
            /// All of them, in the order of the list of keys.
            pub(crate) const ALL: &[Command] = &[$(Command::$variant,)*];

            /// Its name in settings.
            pub(crate) fn name(self) -> &'static str {
                match self { $(Command::$variant => $name,)* }
            }

            /// What it is called.
            pub(crate) fn title(self) -> &'static str {
                match self { $(Command::$variant => $title,)* }
            }

            /// Where its keys mean it.
            pub(crate) fn scope(self) -> Scope {
                match self { $(Command::$variant => Scope::$scope,)* }
            }

            /// Keys that ask for it.
            pub(crate) fn keys(self, habit: Habit) -> &'static [&'static str] {
                match self {
                    $(Command::$variant => {
                        let usual: &'static [&'static str] = &[$($chord),*];
                        $(if habit == Habit::Blender { return &[$($blender),*]; })?
                        $(if habit == Habit::Substance { return &[$($substance),*]; })?
                        let _ = habit;
                        usual
                    })*
                }
            }
        }
    };
}

commands! {
    New "new" "New graph" Window ["Ctrl+N"];
    Open "open" "Open…" Window ["Ctrl+O"];
    Save "save" "Save" Window ["Ctrl+S"];
    SaveAs "save_as" "Save as…" Window ["Ctrl+Shift+S"];
    Export "export" "Export textures" Window ["Ctrl+E"];
    Undo "undo" "Undo" Window ["Ctrl+Z"];
    Redo "redo" "Redo" Window ["Ctrl+Shift+Z", "Ctrl+Y"];
    NextPanel "next_panel" "To the next panel" Window ["F6"];
    PreviousPanel "previous_panel" "To the panel before" Window ["Shift+F6"];
    Help "help" "Page of the node" Window ["F1"];
    Keys "keys" "All keys" Window ["Ctrl+/"];
    UseView "use_view" "Only model and knobs" Window ["Ctrl+Space"];
    Larger "larger" "Larger interface" Window ["Ctrl+="];
    Smaller "smaller" "Smaller interface" Window ["Ctrl+-"];
    AddMenu "add_menu" "Add a node" Canvas ["Tab", "Space", "Shift+A"] blender ["Shift+A", "Space"] substance ["Space", "Tab"];
    Delete "delete" "Delete" Canvas ["Delete"] blender ["X", "Delete"];
    Heal "heal" "Delete and heal the wires" Canvas ["Backspace"] blender ["Ctrl+X", "Backspace"];
    TakeOut "take_out" "Take out of the wires" Canvas ["Alt+X"];
    SwapInputs "swap_inputs" "Swap inputs" Canvas ["X", "Alt+S"] blender ["Alt+S"];
    Mute "mute" "Mute" Canvas ["M"];
    Duplicate "duplicate" "Duplicate" Canvas ["Ctrl+D"] blender ["Shift+D", "Ctrl+D"];
    DuplicateWired "duplicate_wired" "Duplicate with inputs" Canvas ["Ctrl+Shift+D"];
    Copy "copy" "Copy" Canvas ["Ctrl+C"];
    CutNodes "cut_nodes" "Cut" Canvas ["Ctrl+X"] blender [];
    Paste "paste" "Paste" Canvas ["Ctrl+V"];
    Frame "frame" "Frame the nodes" Canvas ["C"] blender ["Ctrl+J"];
    Rename "rename" "Rename" Canvas ["F2"];
    AlignLeft "align_left" "Align left" Canvas ["Ctrl+Left"];
    AlignRight "align_right" "Align right" Canvas ["Ctrl+Right"];
    AlignTop "align_top" "Align top" Canvas ["Ctrl+Up"];
    AlignBottom "align_bottom" "Align bottom" Canvas ["Ctrl+Down"];
    Straighten "straighten" "Straighten wires" Canvas ["Q"];
    LayOut "lay_out" "Lay out" Canvas ["L"] blender ["V"];
    SelectAll "select_all" "Select all" Canvas ["Ctrl+A"] blender ["A", "Ctrl+A"];
    SelectUp "select_up" "Select what it is made from" Canvas ["Ctrl+L"] blender ["L"];
    SelectDown "select_down" "Select what is made from it" Canvas ["Ctrl+Shift+L"] blender ["Shift+L"];
    FrameSelected "frame_selected" "Show the selected nodes" Canvas ["F"] blender ["Period", "F"];
    FrameAll "frame_all" "Show all nodes" Canvas ["A"] blender ["Home"];
    Group "group" "Group" Canvas ["Ctrl+G"];
    Ungroup "ungroup" "Ungroup" Canvas ["Ctrl+Shift+G"] blender ["Ctrl+Alt+G"];
    Enter "enter" "Go into the group" Canvas ["Enter"] blender ["Tab", "Enter"];
    Leave "leave" "Go out of the group" Canvas ["Escape"];
    Preview "preview" "Show in the 2D view and on the model" Canvas ["V", "R"] blender ["R"];
    Follow "follow" "The model follows clicks, or shows the outputs" Canvas ["Shift+V"];
    Lock "lock" "Keep showing this node on the model" Canvas ["P"];
    Flat "flat" "Pictures on nodes flat or on the model" Canvas ["T"];
    MiniMap "mini_map" "Mini map" Canvas ["N"];
    NextPort "next_port" "To the next port" Canvas ["Ctrl+Tab", "J"];
    PreviousPort "previous_port" "To the port before" Canvas ["Ctrl+Shift+Tab", "K"];
    Wire "wire" "Take or drop a wire at the port" Canvas ["W"];
Favorite1 "favorite_1" "Add favorite 1" Canvas ["1"];
    Favorite2 "favorite_2" "Add favorite 2" Canvas ["2"];
    Favorite3 "favorite_3" "Add favorite 3" Canvas ["3"];
    Favorite4 "favorite_4" "Add favorite 4" Canvas ["4"];
    Favorite5 "favorite_5" "Add favorite 5" Canvas ["5"];
    Favorite6 "favorite_6" "Add favorite 6" Canvas ["6"];
    Favorite7 "favorite_7" "Add favorite 7" Canvas ["7"];
    Favorite8 "favorite_8" "Add favorite 8" Canvas ["8"];
    Favorite9 "favorite_9" "Add favorite 9" Canvas ["9"];
    FrameModel "frame_model" "Show all of the model" Viewport ["A", "Home"] blender ["Home"];
    FocusModel "focus_model" "Look at what is under the pointer" Viewport ["F"] blender ["Period", "F"];
    Front "front" "From the front" Viewport ["1"];
    Right "right" "From the right" Viewport ["3"];
    Top "top" "From above" Viewport ["7"];
    Lens "lens" "Perspective or parallel" Viewport ["5"];
    Wires "wires" "Triangles" Viewport ["W"];
    Seams "seams" "Seams" Viewport ["S"];
    Wipe "wipe" "Compare with the locked node" Viewport ["C"];
    FitFlat "fit_flat" "Show all of the texture" Flat ["A", "F"];
    TrueSize "true_size" "One texel a pixel" Flat ["Z"];
    TileFlat "tile_flat" "Repeat the texture" Flat ["T"];
    UvWires "uv_wires" "UV wires" Flat ["W"];
}

/// Commands that add favorites, in their order.
const FAVORITES: [Command; 9] = [
    Command::Favorite1,
    Command::Favorite2,
    Command::Favorite3,
    Command::Favorite4,
    Command::Favorite5,
    Command::Favorite6,
    Command::Favorite7,
    Command::Favorite8,
    Command::Favorite9,
];

impl Command {
    /// Whether it is meant although a text is being typed: a text has steps of its own to take back.
    pub(crate) fn is_beside_text(self) -> bool {
        self.scope() == Scope::Window && !matches!(self, Command::Undo | Command::Redo)
    }

    /// The place of the favorite that it adds, if it adds one.
    pub(crate) fn favorite(self) -> Option<usize> {
        FAVORITES.iter().position(|known| *known == self)
    }

    /// What adds the favorite of that place.
    pub(crate) fn of_favorite(at: usize) -> Option<Command> {
        FAVORITES.get(at).copied()
    }
}

/// Which keys mean what.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeyMap {
    bound: Vec<(Chord, Command)>,
}

impl KeyMap {
    /// The keys of a habit, with some commands bound anew: by name, the keys that now mean them. Says what cannot be read.
    pub(crate) fn new(habit: Habit, own: &std::collections::BTreeMap<String, Vec<String>>) -> (KeyMap, Vec<String>) {
        let mut faults = Vec::new();
        let mut bound = Vec::new();
        for command in Command::ALL {
            let texts: Vec<&str> = match own.get(command.name()) {
                Some(texts) => texts.iter().map(String::as_str).collect(),
                None => command.keys(habit).to_vec(),
            };
            for text in texts {
                match Chord::parse(text) {
                    Ok(chord) => bound.push((chord, *command)),
                    Err(why) => faults.push(format!("the key for \"{}\" is left out: {why}", command.title())),
                }
            }
        }
        (KeyMap { bound }, faults)
    }

    /// What a key means where the pointer is.
    pub(crate) fn command(&self, scope: Scope, modifiers: Modifiers, key: Key) -> Option<Command> {
        let meant = self.bound.iter().filter(|(chord, _)| chord.is(modifiers, key));
        let mut meant = meant.map(|(_, command)| *command);
        meant.find(|command| command.scope() == scope || command.scope() == Scope::Window)
    }

    /// Keys for a command.
    pub(crate) fn chords(&self, command: Command) -> impl Iterator<Item = Chord> {
        self.bound
            .iter()
            .filter(move |(_, bound)| *bound == command)
            .map(|(chord, _)| *chord)
    }

    /// The first key for a command, as text; nothing where there is none.
    pub(crate) fn shown(&self, command: Command) -> String {
        self.chords(command).next().map_or_else(String::new, Chord::text)
    }

    /// Commands that the same key means in the same place: only the first of them is ever done.
    pub(crate) fn clashes(&self) -> Vec<(Chord, [Command; 2])> {
        let mut clashes = Vec::new();
        for (at, (chord, one)) in self.bound.iter().enumerate() {
            for (other_chord, other) in &self.bound[at + 1..] {
                let meets = one.scope() == other.scope() || [one, other].iter().any(|it| it.scope() == Scope::Window);
                if chord == other_chord && one != other && meets {
                    clashes.push((*chord, [*one, *other]));
                }
            }
        }
        clashes
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    #[test]
    fn every_preset_can_be_read_and_no_key_means_two_things_in_one_place() {
        for (habit, name) in Habit::ALL {
            let (keys, faults) = KeyMap::new(habit, &BTreeMap::new());
            assert_eq!(faults, Vec::<String>::new(), "{name}");
            assert_eq!(keys.clashes(), [], "{name}");
        }
    }

    #[test]
    fn commands_have_names_of_their_own() {
        let names: BTreeSet<&str> = Command::ALL.iter().map(|command| command.name()).collect();
        assert_eq!(names.len(), Command::ALL.len());
    }

    #[test]
    fn nine_favorites_have_a_key_each_in_every_preset() {
        for (habit, name) in Habit::ALL {
            let (keys, _) = KeyMap::new(habit, &BTreeMap::new());
            for (at, favorite) in FAVORITES.into_iter().enumerate() {
                assert_eq!(keys.shown(favorite), (at + 1).to_string(), "{name}");
                assert_eq!(favorite.favorite(), Some(at));
            }
        }
        assert_eq!(Command::Mute.favorite(), None);
    }

    #[test]
    fn a_chord_is_written_as_it_is_read() {
        for text in ["Ctrl+Shift+D", "Tab", "Alt+X", "F6", "Ctrl+="] {
            let chord = Chord::parse(text).expect("a chord");
            assert_eq!(Chord::parse(&chord.text()), Ok(chord), "{text}");
        }
        assert_eq!(
            Chord::parse("Hyper+D"),
            Err("'Hyper' is no key to hold; there are Ctrl, Shift and Alt".to_owned())
        );
        assert_eq!(Chord::parse("Ctrl+Any"), Err("there is no key 'Any'".to_owned()));
    }

    #[test]
    fn a_key_can_be_bound_anew() {
        let own = BTreeMap::from([("mute".to_owned(), vec!["B".to_owned()])]);
        let (keys, _) = KeyMap::new(Habit::Default, &own);
        assert_eq!(
            keys.command(Scope::Canvas, Modifiers::NONE, Key::B),
            Some(Command::Mute)
        );
        assert_eq!(keys.command(Scope::Canvas, Modifiers::NONE, Key::M), None);
        assert_eq!(keys.command(Scope::Viewport, Modifiers::NONE, Key::B), None);
    }
}
