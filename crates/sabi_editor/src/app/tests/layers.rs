//! The panel of layers, used as in layer tools.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::{NodeT, Queryable, by};

use super::Window;
use super::hands::id;
use sabi_editing::stack;

use crate::dock::{Layout, Panel};

pub(super) const LAYERED: &str = r#"{
  "format": "sabi", "version": 1, "name": "Worn paint",
  "nodes": {
    "paint": { "kind": "source/material", "label": "Paint" },
    "n": { "kind": "noise/cells", "pos": [0, 300] },
    "dents": { "kind": "effect/relief", "label": "Dents", "inputs": { "base": "paint" }, "pos": [300, 0] },
    "rust": { "kind": "effect/layer", "label": "Rust", "inputs": { "base": "dents", "mask": "n" }, "pos": [600, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "rust" }, "pos": [900, 0] }
  }
}"#;

fn layered(text: &str) -> Window {
    let mut window = Window::of(text);
    window.harness.state_mut().shell.dock.bring_up(Panel::Stack);
    window.settle();
    window
}

fn titles(window: &Window) -> Vec<String> {
    let stacks = stack::all(&window.editor().documents.document);
    stacks[0].layers.iter().map(|layer| layer.title.clone()).collect()
}

/// Row of a layer, as opposed to the node of the same name on the canvas.
fn row(window: &Window, title: &str) -> egui::Pos2 {
    let panel = window.editor().shell.dock.rects[&Panel::Stack];
    let mut rows = window.harness.get_all_by_label(title).map(|node| node.rect());
    let row = rows.find(|rect| panel.contains(rect.center()));
    row.expect("a row").left_center() + vec2(50.0, 0.0)
}

#[test]
fn a_layer_is_dragged_to_another_place_or_says_why_it_cannot_be() {
    let mut window = layered(LAYERED);
    let [rust, dents, paint] = ["Rust", "Dents", "Paint"].map(|title| row(&window, title));
    window.drag(rust, dents + vec2(0.0, 20.0), PointerButton::Primary, Modifiers::NONE);
    assert_eq!(titles(&window), ["Dents", "Rust", "Paint"]);
    assert_eq!(window.steps(), 1);
    window.drag(rust, paint + vec2(0.0, 20.0), PointerButton::Primary, Modifiers::NONE);
    assert_eq!(
        titles(&window),
        ["Dents", "Rust", "Paint"],
        "nothing can lie below the material at the bottom"
    );
    let why = "'Paint' is the material at the bottom; nothing can lie below it";
    assert!(window.harness.query_by_label(why).is_some());
    assert_eq!(window.steps(), 1);
}

#[test]
fn the_eye_the_bar_and_the_bin_of_a_layer_each_make_one_undo_step() {
    let mut window = layered(LAYERED);
    window.click("Show Rust");
    assert!(stack::all(&window.editor().documents.document)[0].layers[0].is_muted);
    let bars: Vec<egui::Rect> = window
        .harness
        .get_all_by_label("Opacity")
        .map(|bar| bar.rect())
        .collect();
    let panel = window.editor().shell.dock.rects[&Panel::Stack];
    let bar = *bars.iter().find(|bar| panel.contains_rect(**bar)).expect("a bar");
    let middle = bar.center();
    window.drag(
        middle,
        middle - vec2(bar.width() / 3.0, 0.0),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let opacity = stack::all(&window.editor().documents.document)[0].layers[0]
        .opacity
        .expect("an opacity");
    assert!((0.0..1.0).contains(&opacity), "{opacity}");
    window.click("Remove Dents");
    assert_eq!(titles(&window), ["Rust", "Paint"]);
    assert_eq!(window.steps(), 3);
}

#[test]
fn a_layer_of_a_kind_is_added_on_top_and_above_another() {
    let mut window = layered(LAYERED);
    window.click(&format!("{} Layer", egui_phosphor::regular::PLUS));
    window.click_beside(Panel::Library, "Adjust material");
    assert_eq!(titles(&window)[0], "Adjust material");
    assert_eq!(titles(&window).len(), 4);
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_layer_that_other_nodes_read_is_locked_and_names_its_readers() {
    let shared = LAYERED.replace(
        r#""out": {"#,
        r#""other": { "kind": "material/split", "inputs": { "material": "dents" } }, "out": {"#,
    );
    let window = layered(&shared);
    let why = "'Dents' is also read by 'Split material', which would change too; use the canvas";
    assert!(window.harness.query_by_label(why).is_some());
    assert!(window.harness.query_by_label("Remove Dents").is_none());
    assert!(window.harness.query_by_label("Remove Rust").is_some());
}

#[test]
fn masks_and_layers_have_pictures_although_the_canvas_does_not_show_their_nodes() {
    let mut window = layered(LAYERED);
    let layout = {
        let mut tiles = egui_tiles::Tiles::default();
        let root = tiles.insert_pane(Panel::Stack);
        Layout::new("panels", root, tiles)
    };
    window.harness.state_mut().shell.dock.set_layout(layout);
    let noise = "n".parse().expect("an id");
    window.until("a picture of the mask", |editor| {
        editor.picture_of(&editor.reference(&noise, None)).is_some()
    });
}

#[test]
fn a_layer_of_a_group_has_the_picture_of_its_material_although_that_is_not_its_first_output() {
    let window = layered(
        r#"{
  "format": "sabi", "version": 1, "name": "",
  "groups": { "Moss": {
    "inputs": { "base": { "to": ["layer.base"], "type": "material" } },
    "outputs": { "where": "cells.mask", "whole": "layer" },
    "nodes": {
      "cells": { "kind": "noise/cells" },
      "layer": { "kind": "effect/layer", "inputs": { "mask": "cells" } }
    } } },
  "nodes": {
    "paint": { "kind": "source/material" },
    "grown": { "kind": "graph/group", "group": "Moss", "label": "Moss", "inputs": { "base": "paint" }, "pos": [300, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "grown.whole" }, "pos": [900, 0] }
  }
}"#,
    );
    assert_eq!(titles(&window), ["Moss", "Plain material"]);
    let editor = window.editor();
    let shown = editor.looks.chosen(&editor.documents.document, &id("grown"));
    assert_eq!(shown.port.as_deref(), Some("whole"));
    assert!(editor.views.layers.wanted.contains(&shown));
}

#[test]
fn a_layer_is_renamed_blended_and_masked_in_its_row() {
    let mut window = layered(LAYERED);
    let rust = id("rust");
    let at = row(&window, "Rust");
    window.double_click(at);
    window.typed("Old rust");
    window.key(Key::Enter);
    assert_eq!(titles(&window), ["Old rust", "Dents", "Paint"]);
    let choose = |window: &mut Window, way: &[&str]| {
        window.click_with(at, PointerButton::Secondary, Modifiers::NONE);
        for entry in way {
            let is_entry = |role| matches!(role, Role::Button | Role::RadioButton);
            let found = by().label_contains(entry).predicate(move |node| is_entry(node.role()));
            // Entries with a menu of their own end in an arrow, and other buttons have longer names. The library has entries of the
            // same names, scrolled out of the window.
            let screen = window.harness.ctx.content_rect();
            let found = window.harness.query_all(found);
            let found = found.filter(|node| screen.contains_rect(node.rect()));
            let found = found.min_by_key(|node| node.accesskit_node().label().map_or(0, |label| label.len()));
            let entry = found.expect("an entry").rect().center();
            window.click_at(entry);
        }
    };
    choose(&mut window, &["Color mode", "Multiply"]);
    choose(&mut window, &["Mask", "No mask"]);
    assert_eq!(window.param(&rust, "color_mode").as_deref(), Some("\"multiply\""));
    assert_eq!(window.document().graph().link_into(rust.as_str(), "mask"), None);
    choose(&mut window, &["Mask", "Noise", "Clouds"]);
    let mask = window.reads(&rust, "mask");
    assert!(!mask.is_empty(), "{:?}", window.labels());
    let kind = window.document().graph().node(&mask).map(|node| node.kind.clone());
    assert_eq!(kind.as_deref(), Some("noise/simplex"));
    assert_eq!(window.steps(), 4);
}

#[test]
fn a_mask_is_dragged_from_the_library_onto_a_layer() {
    let mut window = layered(LAYERED);
    window.open(Panel::Library);
    let library = window.editor().shell.dock.rects[&Panel::Library];
    window.fill("Search the library", "clouds");
    let entries = window
        .harness
        .get_all_by_label("Clouds")
        .map(|node| node.rect().center());
    let entry = entries.into_iter().find(|at| library.contains(*at)).expect("an entry");
    let at = row(&window, "Rust");
    window.drag(entry, at, PointerButton::Primary, Modifiers::NONE);
    let mask = window.reads(&id("rust"), "mask");
    let kind = window.document().graph().node(&mask).map(|node| node.kind.clone());
    assert_eq!(kind.as_deref(), Some("noise/simplex"));
    assert_eq!(window.steps(), 1);
}
