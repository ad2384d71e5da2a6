//! Colors taken from the model and the 2D view.

use egui::{CursorIcon, Key};
use sabi_engine::Session;
use sabi_engine::live::ViewSubject;
use sabi_graph::NodeId;

use super::super::Window;
use super::super::hands::id;

/// Paint on the model, a mask, and a color that is to match the paint.
const NODES: &str = r##"
    "clouds": { "kind": "noise/simplex", "pos": [0, 330] },
    "out": { "kind": "output/material", "inputs": { "material": "paint" }, "pos": [300, 0] },
    "paint": { "kind": "source/material", "params": { "color": "#c04020" }, "pos": [0, 0] },
    "tint": { "kind": "color/constant", "params": { "color": "#336699" }, "pos": [300, 330] }
"##;

impl Window {
    /// Asks for a color for a parameter of a node.
    fn take_dropper(&mut self, node: &NodeId) {
        self.click_at(self.title(node));
        self.press("Color: take from the model or the texture");
        assert!(self.editor().looks.color_target.is_some());
        self.until("what is seen", |editor| {
            editor.evaluation.results.picture(&editor.seen()).is_some() && !editor.evaluation.is_busy()
        });
    }

    fn color(&self, node: &str) -> String {
        self.param(&id(node), "color").unwrap_or_default().replace('"', "")
    }
}

fn ready(nodes: &str) -> Window {
    let mut window = Window::opened(nodes);
    window.until_model();
    window
}

#[test]
fn a_click_on_the_model_takes_the_visible_color_and_not_that_of_the_node() {
    let mut window = ready(NODES);
    window.take_dropper(&id("tint"));
    assert_eq!(
        window.editor().seen(),
        ViewSubject::Outputs,
        "its own color is of no use to it"
    );
    assert!(window.says("Click the color to take."));
    let middle = window.at_model([0.5, 0.5]);
    window.point(middle);
    window.harness.step();
    assert_eq!(
        window.harness.output().platform_output.cursor_icon,
        CursorIcon::Crosshair
    );
    window.click_at(middle);
    assert_eq!(window.color("tint"), "#c04020");
    assert!(window.editor().looks.color_target.is_none());
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_click_on_the_texture_takes_a_color_too() {
    let mut window = ready(NODES);
    window.take_dropper(&id("tint"));
    window.click_at(window.title(&id("paint")));
    window.until_inspected("paint");
    window.click_at(window.texture().center());
    assert_eq!(window.color("tint"), "#c04020");
}

#[test]
fn escape_cancels_the_eyedropper_and_does_not_leave_the_group() {
    let mut window = ready(NODES);
    window.take_dropper(&id("tint"));
    window.point(window.on_canvas([0.9, 0.5]));
    window.key(Key::Escape);
    assert!(window.editor().looks.color_target.is_none());
    window.click_at(window.at_model([0.5, 0.5]));
    assert_eq!((window.color("tint").as_str(), window.steps()), ("#336699", 0));
}

#[test]
fn a_click_where_there_is_no_color_says_so_and_the_eyedropper_waits() {
    let mut window = ready(NODES);
    window.take_dropper(&id("tint"));
    window.click_at(window.at_model([0.02, 0.97]));
    assert!(window.says("There is no surface under the pointer"));
    window.click_at(window.title(&id("clouds")));
    window.until("the mask", |editor| {
        editor.evaluation.results.picture(&editor.seen()).is_some() && !editor.evaluation.is_busy()
    });
    window.click_at(window.at_model([0.5, 0.5]));
    assert!(window.says("The model shows a mask, which has no color"));
    assert!(window.editor().looks.color_target.is_some());
    assert_eq!(window.color("tint"), "#336699");
}

/// Two squares beside each other, each with a material of its own and all of its map.
const SQUARES: &str = "
v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv 1 0 0\nv 1 1 0
vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9
vn 0 0 1
usemtl left\nf 1/1/1 2/2/1 3/3/1 4/4/1
usemtl right\nf 2/1/1 5/2/1 6/3/1 3/4/1
";

const TWO: &str = r##"
    "one": { "kind": "source/material", "params": { "color": "#c04020" }, "pos": [0, 0] },
    "other": { "kind": "source/material", "params": { "color": "#20a060" }, "pos": [0, 330] },
    "out_one": { "kind": "output/material", "params": { "materials": "left" }, "inputs": { "material": "one" } },
    "out_other": { "kind": "output/material", "params": { "materials": "right" }, "inputs": { "material": "other" } },
    "tint": { "kind": "color/constant", "pos": [600, 330] }
"##;

#[test]
fn the_color_is_taken_from_the_texture_set_that_is_clicked() {
    let mut window = Window::with(|folders| {
        let folder = super::super::beside(folders);
        std::fs::write(folder.join("squares.obj"), SQUARES).expect("a model");
        let file = folder.join("graph.sabi");
        std::fs::write(&file, super::super::graph_text(TWO)).expect("a graph");
        Session::open(&file, None).unwrap_or_else(|error| panic!("{error}"))
    });
    let model = window.path("squares.obj");
    window.harness.state_mut().models().take(&model);
    window.until_model();
    window.point(window.at_model([0.5, 0.9]));
    window.key(Key::Num1);
    for (share, color) in [([0.35, 0.5], "#c04020"), ([0.65, 0.5], "#20a060")] {
        window.take_dropper(&id("tint"));
        window.click_at(window.at_model(share));
        assert_eq!(window.color("tint"), color);
    }
}
