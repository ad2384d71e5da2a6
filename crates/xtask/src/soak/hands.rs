//! Input at random for a real window: the same actions for the same seed.

use std::process::{Command, Stdio};

use xtask::project::TaskError;

/// Pixels of the display.
pub(crate) const SIZE: [u32; 2] = [1600, 900];
/// Height of the menu bar, which is never clicked: its menus quit the program and open dialogs of the system.
const MENUS: u32 = 36;

/// Keys of commands that work on the graph, the view and the file that is open.
const KEYS: [&str; 31] = [
    "ctrl+z",
    "ctrl+z",
    "ctrl+shift+z",
    "ctrl+s",
    "ctrl+a",
    "ctrl+c",
    "ctrl+v",
    "ctrl+d",
    "ctrl+g",
    "ctrl+shift+g",
    "ctrl+l",
    "ctrl+h",
    "ctrl+Tab",
    "ctrl+space",
    "ctrl+slash",
    "ctrl+Left",
    "ctrl+Up",
    "Delete",
    "BackSpace",
    "Escape",
    "Escape",
    "Return",
    "Home",
    "period",
    "b",
    "c",
    "f",
    "h",
    "i",
    "m",
    "F1",
];

/// Nodes that are searched for and added.
const NODES: [&str; 12] = [
    "clouds",
    "cells",
    "blur",
    "levels",
    "threshold",
    "edges",
    "layer",
    "scratches",
    "rust",
    "blend",
    "distance",
    "moss",
];

/// Random choice of actions, and the display that they are performed on.
pub(crate) struct Hands {
    display: String,
    state: u64,
}

impl Hands {
    pub(crate) fn new(display: String, seed: u64) -> Hands {
        Hands { display, state: seed }
    }

    /// A number below `limit`: SplitMix64 (Steele, Lea, Flood 2014).
    fn below(&mut self, limit: u32) -> u32 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % u64::from(limit)) as u32
    }

    fn one_of(&mut self, words: &[&'static str]) -> &'static str {
        words[self.below(words.len() as u32) as usize]
    }

    /// Coordinates of a place in the window, below its menus.
    fn place(&mut self) -> [String; 2] {
        let x = self.below(SIZE[0]);
        let y = MENUS + self.below(SIZE[1] - MENUS);
        [x.to_string(), y.to_string()]
    }

    /// Performs the next action.
    pub(crate) fn act(&mut self) -> Result<(), TaskError> {
        let [x, y] = self.place();
        let mut words = vec!["mousemove", x.as_str(), y.as_str()];
        let [to_x, to_y] = self.place();
        match self.below(20) {
            0..5 => words.extend(["click", "1"]),
            5..10 => {
                let button = self.one_of(&["1", "1", "1", "2", "3"]);
                let path = ["mousemove", "--sync", &to_x, &to_y, "mouseup", button];
                words.extend(["mousedown", button]);
                words.extend(path);
                return self.send(&words);
            }
            10..12 => words.extend(["click", "--repeat", "3", self.one_of(&["4", "5"])]),
            12 => words.extend(["click", "--repeat", "2", "--delay", "80", "1"]),
            13 => words.extend(["click", "3"]),
            14..16 => {
                // The search for nodes opens where the pointer is on the canvas; elsewhere the text goes into a field
                // or has no effect.
                words.extend(["key", "Tab", "sleep", "0.3", "type", self.one_of(&NODES)]);
                self.send(&words)?;
                return self.send(&["sleep", "0.3", "key", "Return"]);
            }
            _ => words.extend(["key", self.one_of(&KEYS)]),
        }
        self.send(&words)
    }

    /// Gives the window the keyboard focus, since the display has no window manager. False while there is no window.
    pub(crate) fn take_window(&self) -> bool {
        let output = self.tool(&["search", "--name", "Sabi$"]).output();
        let found = output.map_or(String::new(), |output| {
            String::from_utf8_lossy(&output.stdout).into_owned()
        });
        let Some(window) = found.lines().next_back() else {
            return false;
        };
        self.send(&["windowfocus", window]).is_ok()
    }

    fn tool(&self, words: &[&str]) -> Command {
        let mut command = Command::new("xdotool");
        command.args(words).env("DISPLAY", &self.display).stderr(Stdio::null());
        command
    }

    fn send(&self, words: &[&str]) -> Result<(), TaskError> {
        let status = self.tool(words).stdout(Stdio::null()).status();
        match status {
            // A window that has just closed refuses input; the caller notices by itself that it is gone.
            Ok(_) => Ok(()),
            Err(error) => Err(TaskError::failed(format!("xdotool cannot be started: {error}."))),
        }
    }
}
