//! Entries of the library that are dropped on the model and on nodes of the canvas.

use std::path::{Path, PathBuf};

use egui::{Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::kittest::Queryable;
use egui_tiles::Tiles;
use sabi_editing::stack;

use super::Window;
use super::hands::id;
use crate::dock::{Layout, Panel};

const TWO_OUTPUTS: &str = r#"{
  "format": "sabi", "version": 1, "preview": { "size": 64 },
  "nodes": {
    "paint": { "kind": "source/material", "label": "Paint", "pos": [0, 0] },
    "steel": { "kind": "source/material", "label": "Steel", "pos": [0, 400] },
    "a": { "kind": "output/material", "inputs": { "material": "paint" }, "params": { "materials": "left" }, "pos": [400, 0] },
    "b": { "kind": "output/material", "inputs": { "material": "steel" }, "params": { "materials": "right" }, "pos": [400, 400] }
  }
}"#;

/// Two squares that face the front, each with a material of its own; the right one has a normal map.
pub(super) fn write_two_squares(folder: &Path) -> PathBuf {
    let mut bytes: Vec<u8> = Vec::new();
    let mut push = |values: &[f32]| values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    for left in [-1.0, 0.0] {
        push(&[
            left,
            -1.0,
            0.0,
            left + 1.0,
            -1.0,
            0.0,
            left + 1.0,
            1.0,
            0.0,
            left,
            1.0,
            0.0,
        ]);
    }
    for _ in 0..2 {
        push(&[0.05, 0.95, 0.95, 0.95, 0.95, 0.05, 0.05, 0.05]);
    }
    for index in [0_u16, 1, 2, 0, 2, 3] {
        bytes.extend(index.to_le_bytes());
    }
    std::fs::write(folder.join("squares.bin"), &bytes).expect("a writable folder");
    let bumps = image::RgbImage::from_pixel(4, 4, image::Rgb([150, 128, 250]));
    bumps.save(folder.join("bumps.png")).expect("a writable folder");
    let text = format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "scene": 0, "scenes": [{{ "nodes": [0] }}], "nodes": [{{ "mesh": 0 }}],
        "materials": [{{ "name": "left" }}, {{ "name": "right", "normalTexture": {{ "index": 0 }} }}],
        "textures": [{{ "source": 0 }}], "images": [{{ "uri": "bumps.png" }}],
        "meshes": [{{ "primitives": [
            {{ "attributes": {{ "POSITION": 0, "TEXCOORD_0": 2 }}, "indices": 4, "material": 0 }},
            {{ "attributes": {{ "POSITION": 1, "TEXCOORD_0": 3 }}, "indices": 4, "material": 1 }}] }}],
        "buffers": [{{ "uri": "squares.bin", "byteLength": {} }}],
        "bufferViews": [{{ "buffer": 0, "byteOffset": 0, "byteLength": 48 }}, {{ "buffer": 0, "byteOffset": 48, "byteLength": 48 }},
            {{ "buffer": 0, "byteOffset": 96, "byteLength": 32 }}, {{ "buffer": 0, "byteOffset": 128, "byteLength": 32 }},
            {{ "buffer": 0, "byteOffset": 160, "byteLength": 12 }}],
        "accessors": [
            {{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [0, 1, 0] }},
            {{ "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, -1, 0], "max": [1, 1, 0] }},
            {{ "bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2" }},
            {{ "bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC2" }},
            {{ "bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR" }}] }}"#,
        bytes.len()
    );
    let file = folder.join("squares.gltf");
    std::fs::write(&file, text).expect("a writable folder");
    file
}

impl Window {
    /// Drags an entry of the library to a place.
    fn drop_entry(&mut self, name: &str, query: &str, at: Pos2) {
        self.open(Panel::Library);
        self.fill("Search the library", query);
        self.settle();
        let library = self.panel(Panel::Library);
        let mut entries = self.harness.query_all_by_label(name).map(|node| node.rect().center());
        let entry = entries.find(|at| library.contains(*at)).expect("an entry");
        drop(entries);
        self.drag(entry, at, PointerButton::Primary, Modifiers::NONE);
    }

    /// Shows the two squares, and waits until they are drawn.
    fn show_squares(&mut self, squares: &Path) {
        self.harness.state_mut().models().take(squares);
        self.until("the squares", |editor| {
            let picture = editor
                .evaluation
                .results
                .picture(&sabi_engine::live::ViewSubject::Outputs);
            let is_of_squares = picture.is_some_and(|picture| picture.model.linked.model.materials.len() == 2);
            is_of_squares && editor.evaluation.model.file().ends_with("squares.gltf") && !editor.evaluation.is_busy()
        });
    }

    fn panel(&self, panel: Panel) -> Rect {
        self.editor().shell.dock.rects[&panel]
    }

    fn layers(&self, output: &str) -> Vec<String> {
        let stacks = stack::all(self.document()).into_iter();
        let mut of_output = stacks.filter(|stack| stack.end == stack::StackEnd::Node(id(output)));
        let layers = of_output.next().expect("a stack").layers.into_iter();
        layers.map(|layer| layer.title).collect()
    }
}

#[test]
fn a_dropped_layer_is_added_to_the_material_under_the_pointer_and_its_normal_map() {
    let mut window = Window::of(TWO_OUTPUTS);
    let squares = write_two_squares(window.folder.path());
    window.show_squares(&squares);
    let middle = window.panel(Panel::Viewport).center();
    window.point(middle);
    window.key(Key::Num1);
    window.drop_entry("Layer", "effect layer", middle + vec2(40.0, 0.0));
    assert_eq!(
        (window.layers("a"), window.layers("b")),
        (
            vec!["Paint".to_owned()],
            ["Layer", "Normal map of the model", "Steel"]
                .map(str::to_owned)
                .to_vec()
        )
    );
    window.drop_entry("Relief", "relief", middle - vec2(40.0, 0.0));
    assert_eq!(window.layers("a"), ["Relief", "Paint"]);
    assert_eq!(window.steps(), 2);
    // A drop beside the model names no material.
    let corner = window.panel(Panel::Viewport).left_bottom() + vec2(6.0, -6.0);
    window.harness.state_mut().looks.followed = None;
    window.drop_entry("Relief", "relief", corner);
    assert_eq!(window.steps(), 2);
    assert!(window.says("drop it on the place of the model"));
}

#[test]
fn a_layer_dropped_on_a_model_beside_the_main_one_is_added_to_its_material() {
    let mut window = Window::of(TWO_OUTPUTS);
    window.until_model();
    let squares = write_two_squares(window.folder.path());
    window.harness.state_mut().models().show_beside(&squares);
    window.until("the squares", |editor| {
        let beside = editor.row.beside().first();
        let picture = beside.and_then(|model| model.results.picture(&sabi_engine::live::ViewSubject::Outputs));
        picture.is_some() && editor.views.model.has_picture_beside(0) && !beside.is_some_and(|model| model.is_busy())
    });
    let file = window.editor().row.files().remove(0);
    let cell = window.editor().views.model.cell_beside(&file).expect("a cell");
    window.point(window.panel(Panel::Viewport).center());
    window.key(Key::Num1);
    window.drop_entry("Layer", "effect layer", cell.center() + vec2(30.0, 0.0));
    assert_eq!(window.layers("b"), ["Layer", "Normal map of the model", "Steel"]);
    window.drop_entry("Relief", "relief", cell.center() - vec2(30.0, 0.0));
    assert_eq!(window.layers("a"), ["Relief", "Paint"]);
}

#[test]
fn a_layer_is_not_dropped_on_a_hidden_view() {
    let one_output = TWO_OUTPUTS.replace(r#""materials": "left""#, r#""materials": "*""#);
    let mut window = Window::of(&one_output);
    window.until_model();
    let at = window.panel(Panel::Viewport).center();
    // The canvas takes the place of the view.
    let layout = {
        let mut tiles = Tiles::default();
        let tabs = [Panel::Canvas, Panel::Viewport].map(|panel| tiles.insert_pane(panel));
        let (left, right) = (tiles.insert_tab_tile(tabs.to_vec()), tiles.insert_pane(Panel::Library));
        let root = tiles.insert_horizontal_tile(vec![left, right]);
        Layout::new("panels", root, tiles)
    };
    window.harness.state_mut().shell.dock.set_layout(layout);
    window.settle();
    assert!(window.panel(Panel::Canvas).contains(at) && !window.editor().shell.dock.is_shown(Panel::Viewport));
    let entry = window.harness.get_by_label("Levels").rect().center();
    window.drag(entry, at, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.document().graph().len(), 5, "a node where it was dropped");
    window.undo(1);
    window.fill("Search the library", "plain material");
    let entry = window.harness.get_by_label("Plain material").rect().center();
    window.drag(entry, at, PointerButton::Primary, Modifiers::NONE);
    assert_eq!((window.layers("a").len(), window.document().graph().len()), (1, 5));
}

#[test]
fn a_layer_dropped_on_a_node_is_added_on_its_material() {
    let mut window = Window::of(TWO_OUTPUTS);
    window.settle();
    let paint = window.rect(&id("paint")).center();
    window.drop_entry("Layer", "effect layer", paint);
    assert_eq!(window.layers("a"), ["Layer", "Paint"]);
    let output = window.rect(&id("b")).center();
    window.drop_entry("Relief", "relief", output);
    assert_eq!(window.layers("b"), ["Relief", "Steel"]);
    assert_eq!(window.steps(), 2);
}

#[test]
fn the_2d_view_shows_the_texture_set_that_is_clicked_or_painted_on_the_model() {
    let mut window = Window::of(TWO_OUTPUTS);
    let squares = write_two_squares(window.folder.path());
    window.show_squares(&squares);
    let middle = window.panel(Panel::Viewport).center();
    window.point(middle);
    window.key(Key::Num1);
    let shown = |window: &Window| {
        let model = window.editor().evaluation.model.received.clone().expect("a model");
        let set = model.set(window.editor().views.flat.set).expect("a set");
        set.name.clone()
    };
    for (way, name) in [(40.0, "right"), (-40.0, "left"), (40.0, "right")] {
        window.click_at(middle + vec2(way, 0.0));
        assert_eq!(shown(&window), name);
    }
    let paint = window.add([0.2, 0.8], "source paint");
    window.harness.state_mut().documents.document.select([paint]);
    window.settle();
    window.key(Key::B);
    let left = middle - vec2(40.0, 0.0);
    window.drag(left, left + vec2(5.0, 20.0), PointerButton::Primary, Modifiers::NONE);
    assert_eq!(shown(&window), "left");
}

#[test]
fn requesting_a_model_that_is_being_read_does_not_restart_the_reading() {
    let mut window = Window::of(TWO_OUTPUTS);
    let squares = write_two_squares(window.folder.path());
    window.until_model();
    let editor = window.harness.state_mut();
    editor.models().take(&squares);
    let begun = editor.evaluation.model.file_since();
    editor.models().take(&squares);
    assert_eq!(editor.evaluation.model.file_since(), begun);
    window.until("the squares", |editor| !editor.evaluation.model.is_replacing());
    let editor = window.harness.state_mut();
    editor.models().take(&squares);
    assert_ne!(
        editor.evaluation.model.file_since(),
        begun,
        "once it is there, it is read anew"
    );
}
