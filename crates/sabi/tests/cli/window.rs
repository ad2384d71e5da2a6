//! `sabi edit` in a window on a virtual display, with mouse and keyboard.

use std::process::{Child, Command};

use serde_json::Value;

use crate::cli_folder::{CliFolder, software_adapter};
use crate::display::Display;

const EMPTY: &str = r#"{ "format": "sabi", "version": 1, "name": "", "nodes": {} }"#;
/// Places of the panels of a new installation on a screen of 1600 × 900.
const MODEL: [usize; 4] = [10, 120, 640, 800];
const GRAPH: [usize; 4] = [665, 80, 1250, 860];
/// Offset from the corner of a node to its only output: below its title, one input and three knobs.
const OUTPUT_OF_CLOUDS: [i32; 2] = [200, 28 + 4 * 19 + 9];
/// Offset to its first input.
const FIRST_INPUT: [i32; 2] = [0, 28 + 9];
/// Offset to the middle of the first knob below one input.
const FIRST_KNOB: [i32; 2] = [100, 28 + 19 + 9];

/// The program with its window.
struct WindowProcess {
    child: Child,
}

impl WindowProcess {
    fn open(place: &CliFolder, display: &Display, arguments: &[&str]) -> WindowProcess {
        software_adapter();
        let mut command: Command = place.command(&[&["edit", "--adapter", "cpu"], arguments].concat());
        display.on(&mut command);
        command.env("XDG_CONFIG_HOME", place.path(".config"));
        let window = WindowProcess {
            child: command.spawn().unwrap(),
        };
        display.take_window();
        display.until("a model in the light", || display.screen().colors(MODEL) > 500);
        window
    }

    /// Kills the process, as a crash would end it.
    fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for WindowProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn plus(one: [i32; 2], other: [i32; 2]) -> [i32; 2] {
    [one[0] + other[0], one[1] + other[1]]
}

/// Adds a node by the menu with its corner at a place.
fn add(display: &Display, at: [i32; 2], name: &str) {
    display.point(at);
    // The picture of an earlier node comes later than the node, and would pass for the menu.
    display.until_still(GRAPH, "rest");
    display.until_changed(GRAPH, "the menu", || display.key("Tab"));
    display.hands(&["type", "--delay", "40", name]);
    display.until_changed(GRAPH, "a node in place of the menu", || display.key("Return"));
}

/// Waits for pictures on nodes: a lit model has more shades than frames, titles and wires.
fn until_pictures(display: &Display, shades: usize) {
    display.until("pictures on the nodes", || display.screen().colors(GRAPH) > shades);
}

fn saved(place: &CliFolder, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).unwrap()
}

#[test]
fn a_window_takes_mouse_and_keys_saves_what_was_made_and_opens_it_again() {
    let (place, display) = (CliFolder::new(), Display::new());
    place.write("new.sabi", EMPTY);
    let window = WindowProcess::open(&place, &display, &["new.sabi", "--mesh", "cube.glb"]);
    let [clouds, levels] = [[690, 120], [1000, 200]];
    add(&display, clouds, "clouds");
    add(&display, levels, "levels");
    // While a kernel is compiled the window stands still, and a whole drag would be one frame.
    until_pictures(&display, 60);
    display.drag(plus(clouds, OUTPUT_OF_CLOUDS), plus(levels, FIRST_INPUT));
    let knob = plus(levels, FIRST_KNOB);
    display.drag(knob, plus(knob, [40, 0]));
    until_pictures(&display, 60);
    display.key("ctrl+s");
    display.until("a saved graph", || {
        saved(&place, "new.sabi")["nodes"]
            .as_object()
            .is_some_and(|nodes| nodes.len() == 2)
    });
    let text = place.read("new.sabi");
    let graph = saved(&place, "new.sabi");
    let nodes = graph["nodes"].as_object().unwrap();
    let (id, _) = nodes.iter().find(|(_, node)| node["kind"] == "noise/simplex").unwrap();
    let (_, node) = nodes.iter().find(|(_, node)| node["kind"] == "adjust/levels").unwrap();
    assert_eq!(node["inputs"]["source"], id.as_str(), "{graph:#}");
    let black = node["params"]["black"].as_f64();
    assert!(black.is_some_and(|black| black > 0.05), "{graph:#}");
    drop(window);
    let _again = WindowProcess::open(&place, &display, &["new.sabi", "--mesh", "cube.glb"]);
    until_pictures(&display, 60);
    display.key("ctrl+s");
    assert_eq!(place.read("new.sabi"), text, "what is opened and saved is the same");
}

#[test]
fn what_was_not_saved_when_the_program_was_killed_is_offered_and_comes_back() {
    let (place, display) = (CliFolder::new(), Display::new());
    place.write("new.sabi", EMPTY);
    let window = WindowProcess::open(&place, &display, &["new.sabi", "--mesh", "cube.glb"]);
    add(&display, [800, 300], "clouds");
    let kept = place.path(".config/sabi/unsaved");
    let is_kept = || std::fs::read_dir(&kept).is_ok_and(|mut files| files.next().is_some());
    display.until("a copy of what is not saved", is_kept);
    window.kill();
    let _again = WindowProcess::open(&place, &display, &["--mesh", "cube.glb"]);
    // Recovered work is at the top of the start page.
    display.key("Tab");
    display.key("space");
    until_pictures(&display, 60);
    display.key("ctrl+s");
    display.until("a saved graph", || {
        let graph = saved(&place, "new.sabi");
        let nodes = graph["nodes"].as_object().unwrap();
        nodes.len() == 1 && nodes.values().all(|node| node["kind"] == "noise/simplex")
    });
}

#[test]
fn an_example_of_the_project_is_shown_with_its_model_and_a_picture_on_every_node() {
    let (place, display) = (CliFolder::new(), Display::new());
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/graphs/rusty-metal.sabi");
    let _window = WindowProcess::open(&place, &display, &[example]);
    until_pictures(&display, 400);
}
