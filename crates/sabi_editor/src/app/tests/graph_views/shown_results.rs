//! Results that the views show: clicks, pins, and the menu on the picture.

use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_phosphor::regular as icon;
use sabi_engine::live::ViewSubject;
use sabi_graph::NodeRef;

use super::super::Window;
use super::super::hands::id;
use crate::dock::Panel;

pub(super) const NODES: &str = r#"
    "cells": { "kind": "noise/cells", "label": "Tiles", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "label": "Spots", "pos": [300, 0] }
"#;

/// A result, as a graph file names it; empty for the outputs.
fn name(seen: &ViewSubject) -> String {
    match seen {
        ViewSubject::Outputs => String::new(),
        ViewSubject::Node(node) => named(node),
    }
}

fn named(node: &NodeRef) -> String {
    let port = node.port.as_ref().map(|port| format!(".{port}"));
    format!("{}{}", node.node, port.unwrap_or_default())
}

impl Window {
    /// Returns the result that the model shows, as graph files name it; empty for the outputs.
    pub(super) fn on_model(&self) -> String {
        name(&self.editor().seen())
    }

    fn in_flat(&self) -> String {
        self.editor().looks.inspected().map(named).unwrap_or_default()
    }

    /// Opens a menu on the picture of the model.
    pub(super) fn open_menu(&mut self, sign: &str, name: &str) {
        self.press(&format!("{sign} {name}"));
    }

    /// Waits until the model is loaded.
    pub(in crate::app::tests) fn until_model(&mut self) {
        self.until("the model", |editor| {
            editor.views.model.pictures.drawn > 0 && editor.evaluation.model.loaded().1 && !editor.evaluation.is_busy()
        });
    }
}

#[test]
fn a_click_on_a_node_shows_it_on_the_model_and_one_beside_nodes_the_outputs() {
    let mut window = Window::opened(NODES);
    window.until_model();
    assert!(window.on_model().is_empty() && window.says("Outputs"));
    window.click_at(window.title(&id("cells")));
    assert_eq!((window.on_model(), window.in_flat()), ("cells".into(), "cells".into()));
    assert!(window.says("Follows: Tiles"));
    window.click_at(window.on_canvas([0.9, 0.9]));
    assert!(window.on_model().is_empty() && window.says("Outputs"));
    assert_eq!(window.in_flat(), "cells", "the 2D view keeps what it has");
}

#[test]
fn a_locked_node_stays_on_the_model_whatever_is_clicked() {
    let mut window = Window::opened(NODES);
    window.until_model();
    window.click_at(window.title(&id("cells")));
    window.key(Key::P);
    window.click_at(window.title(&id("dots")));
    assert_eq!((window.on_model(), window.in_flat()), ("cells".into(), "dots".into()));
    assert!(window.says("Pinned: Tiles"));
    window.click_at(window.on_canvas([0.9, 0.9]));
    assert_eq!(window.on_model(), "cells");
}

#[test]
fn a_second_node_that_is_shown_takes_the_place_of_the_first() {
    let mut window = Window::opened(NODES);
    for node in ["cells", "dots", "dots"] {
        window.harness.state_mut().documents.document.select([id(node)]);
        window.point(window.on_canvas([0.9, 0.9]));
        window.key(Key::V);
        assert_eq!(window.on_model(), node);
    }
    window.keys(Modifiers::SHIFT, Key::V);
    assert!(
        window.on_model().is_empty(),
        "another key has the model show the outputs"
    );
    window.click_at(window.title(&id("cells")));
    assert!(window.on_model().is_empty());
    window.keys(Modifiers::SHIFT, Key::V);
    assert_eq!(window.on_model(), "cells");
}

#[test]
fn the_menu_on_the_picture_shows_and_changes_the_subject_of_the_model() {
    let mut window = Window::opened(NODES);
    window.until_model();
    window.click_at(window.title(&id("cells")));
    let choose = |window: &mut Window, entry: &str| {
        window.open_menu(icon::CROSSHAIR, "Preview");
        window.press(entry);
        window.key(Key::Escape);
    };
    choose(&mut window, "Outputs");
    assert!(window.on_model().is_empty());
    choose(&mut window, "Follow the node that is clicked");
    assert_eq!(window.on_model(), "cells");
    choose(&mut window, "Pin Tiles");
    window.click_at(window.title(&id("dots")));
    assert_eq!(window.on_model(), "cells");
    choose(&mut window, "Compare with Tiles");
    assert_eq!(window.on_model(), "dots");
    assert!(window.says("A  Follows: Spots") && window.says("B  Pinned: Tiles"));
    choose(&mut window, "Compare with Tiles");
    choose(&mut window, "Pin Spots");
    window.click_at(window.title(&id("cells")));
    assert_eq!(window.on_model(), "dots");
    choose(&mut window, "Pinned: Spots");
    assert_eq!(window.on_model(), "cells", "it is let go");
    choose(&mut window, "Pin Tiles");
    choose(&mut window, "Outputs");
    assert!(window.on_model().is_empty(), "nothing is pinned any more");
    window.click_at(window.title(&id("dots")));
    choose(&mut window, "Compare with Spots");
    choose(&mut window, "Compare with Spots");
    assert!(
        window.on_model().is_empty(),
        "what was pinned to be compared is let go with the comparison"
    );
}

#[test]
fn each_entry_of_the_menu_of_views_sets_the_camera_that_it_names() {
    let mut window = Window::opened(NODES);
    window.until_model();
    let mut looks = Vec::new();
    for entry in [
        "Front view",
        "Right view",
        "Top view",
        "Perspective or orthographic",
        "Show all of the model",
    ] {
        window.harness.state_mut().views.model.navigation.camera.zoom(1.1);
        let before = window.editor().views.model.navigation.camera;
        window.open_menu(icon::VIDEO_CAMERA, "Camera");
        window.press(entry);
        let camera = window.editor().views.model.navigation.camera;
        assert_ne!(camera, before, "{entry}");
        looks.push((camera.yaw_degrees, camera.pitch_degrees));
    }
    assert_eq!(looks[..3], [(0.0, 0.0), (90.0, 0.0), (0.0, 90.0)]);
}

#[test]
fn a_click_on_a_node_shows_its_chosen_output_which_a_pin_keeps() {
    let mut window = Window::opened(NODES);
    window.click_at(window.port(&id("cells"), "id"));
    window.click_at(window.title(&id("dots")));
    window.click_at(window.title(&id("cells")));
    assert_eq!(window.in_flat(), "cells.id");
    let both = Modifiers::COMMAND | Modifiers::SHIFT;
    window.click_with(window.title(&id("cells")), PointerButton::Primary, both);
    window.click_at(window.port(&id("cells"), "mask"));
    assert_eq!(window.in_flat(), "cells.id", "it is pinned");
    assert_eq!(
        window.on_model(),
        "cells",
        "the first output is one to choose like others"
    );
}

#[test]
fn a_pin_is_shown_on_its_node_and_above_the_texture_where_it_can_be_removed() {
    let mut window = Window::opened(NODES);
    assert!(!window.has("Unpin"));
    let both = Modifiers::COMMAND | Modifiers::SHIFT;
    window.click_with(window.title(&id("cells")), PointerButton::Primary, both);
    window.click_at(window.title(&id("dots")));
    assert_eq!(window.in_flat(), "cells");
    let panel = window.editor().shell.dock.rects[&Panel::Canvas];
    let pinned = |window: &Window| {
        let nodes = window.harness.query_all_by_label("Tiles");
        let mut nodes = nodes.filter(|node| panel.contains(node.rect().center()));
        nodes.any(|node| node.accesskit_node().description().as_deref() == Some("pinned to the 2D view"))
    };
    assert!(pinned(&window));
    window.press("Unpin");
    assert_eq!(window.in_flat(), "dots");
    assert!(!window.has("Unpin") && !pinned(&window));
}

#[test]
fn a_subject_that_cannot_be_shown_says_why_on_the_picture() {
    let mut window = Window::opened(r#""blur": { "kind": "filter/blur", "pos": [0, 0] }"#);
    window.until_model();
    window.click_at(window.title(&id("blur")));
    window.until("the fault", |editor| editor.evaluation.faults.of("blur").is_some());
    let fault = window.fault_of("blur");
    assert!(window.says(&format!("Follows: Blur — {fault}")));
}

#[test]
fn a_soft_view_says_so_and_offers_a_size_that_is_sharp() {
    let mut window = Window::opened(NODES);
    window.until_model();
    window.until("the words", |editor| {
        editor.evaluation.model.size() == 64 && !editor.evaluation.is_busy()
    });
    assert!(window.says("Soft: a texel is"), "{:?}", window.labels());
    let labels = window.labels();
    let offer = labels
        .iter()
        .find(|label| label.starts_with("Work at "))
        .expect("an offer")
        .clone();
    window.click(&offer);
    let size = window
        .document()
        .contents()
        .preview
        .as_ref()
        .and_then(|preview| preview.size)
        .expect("a size");
    assert!(size >= 256 && offer == format!("Work at {size} texels"), "{offer}");
    window.until("the sharp picture", |editor| {
        let shown = editor
            .evaluation
            .results
            .picture(&sabi_engine::live::ViewSubject::Outputs);
        shown.is_some_and(|picture| picture.model.size == size) && !editor.evaluation.is_busy()
    });
    assert!(!window.says("Soft"));
}
