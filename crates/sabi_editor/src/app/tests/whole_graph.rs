//! A graph with a frame, an exposed parameter and a variant, built from nothing by mouse and keys.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use egui::{Key, Modifiers, PointerButton};
use sabi_graph::NodeId;
use serde_json::{Value as Json, json};

use super::Window;

/// Expected graph file.
fn file_of_the_graph() -> Json {
    json!({
        "format": "sabi",
        "version": 1,
        "name": "Rusty edges",
        "preview": { "mesh": "../assets/meshes/bench.glb", "size": 1024 },
        "exposed": { "amount": { "to": ["worn_p2dd.opacity"], "label": "Rust amount", "range": [0, 1] } },
        "variants": { "heavy": { "amount": 0.9 } },
        "frames": {
            "wear_x2c4": { "title": "Where it wears", "color": "#4a5a6a", "nodes": ["edges_k7f2", "grain_m3x9"] }
        },
        "nodes": {
            "edges_k7f2": { "kind": "surface/edges", "params": { "width": 0.03 }, "pos": [0, 0] },
            "grain_m3x9": { "kind": "noise/simplex", "params": { "seed": 7 }, "pos": [0, 260] },
            "out": { "kind": "output/material", "inputs": { "material": "rust_a81c" }, "pos": [780, 60] },
            "paint_0b5e": { "kind": "source/material", "params": { "color": "#3c5a6e" }, "pos": [260, -120] },
            "rust_a81c": { "kind": "effect/layer", "inputs": { "base": "paint_0b5e", "mask": "worn_p2dd" },
                "params": { "color": "#6b3a1e", "roughness": 0.9 }, "pos": [520, 60] },
            "worn_p2dd": { "kind": "blend/mask", "inputs": { "above": "grain_m3x9", "below": "edges_k7f2" },
                "pos": [260, 150] }
        }
    })
}

/// Adds a node with its upper left corner at a place of the canvas where it covers no other.
fn add_at(window: &mut Window, place: [f32; 2], query: &str) -> NodeId {
    window.point(window.screen(place));
    window.key(Key::Tab);
    window.pick(query)
}

fn build(window: &mut Window) -> BTreeMap<NodeId, &'static str> {
    // The whole graph has to be on the screen.
    window.wheel(window.on_canvas([0.0, 0.0]), -190.0);
    let ends = [window.on_canvas([0.1, 0.1]), window.on_canvas([0.14, 0.4])];
    window.drag_along(&ends, PointerButton::Middle, Modifiers::NONE);
    let edges = add_at(window, [0.0, 0.0], "edges");
    let grain = add_at(window, [0.0, 260.0], "clouds");
    let paint = add_at(window, [260.0, -120.0], "source material");
    let worn = add_at(window, [260.0, 150.0], "blend mask");
    let rust = add_at(window, [520.0, 60.0], "effect layer");
    let out = add_at(window, [780.0, 60.0], "material output");
    window.wire(&edges, "mask", &worn, "below");
    window.wire(&grain, "mask", &worn, "above");
    window.wire(&paint, "material", &rust, "base");
    window.wire(&worn, "mask", &rust, "mask");
    window.wire(&rust, "material", &out, "material");
    window.click_at(window.title(&edges));
    window.set_number("Width", "0.03");
    // New nodes get seeds of their own; Backspace gives a knob its default back.
    window.click_at(window.knob("Seed"));
    window.key(Key::Backspace);
    window.click_at(window.title(&grain));
    window.set_number("Seed", "7");
    window.click_at(window.title(&paint));
    window.set_color("Color", "#3c5a6e");
    window.click_at(window.title(&rust));
    window.set_color("Color", "#6b3a1e");
    window.set_number("Roughness", "0.9");
    window.click_at(window.title(&edges));
    window.click_with(window.title(&grain), PointerButton::Primary, Modifiers::SHIFT);
    window.key(Key::C);
    let strip = window.screen([100.0, -35.0]);
    window.double_click(strip);
    window.keys(Modifiers::COMMAND, Key::A);
    window.typed("Where it wears");
    window.key(Key::Enter);
    let ids = [edges, grain, out, paint, rust, worn];
    let names = [
        "edges_k7f2",
        "grain_m3x9",
        "out",
        "paint_0b5e",
        "rust_a81c",
        "worn_p2dd",
    ];
    ids.into_iter().zip(names).collect()
}

/// Exposes a parameter of a node, and saves a value of it as a variant.
fn expose(window: &mut Window, worn: &NodeId) {
    window.click_at(window.title(worn));
    window.click_with(window.knob("Opacity"), PointerButton::Secondary, Modifiers::NONE);
    window.press("Expose parameter");
    window.key(Key::Escape);
    window.click_at(window.on_canvas([0.97, 0.9]));
    window.click("Change the panel");
    window.fill("Label", "Rust amount");
    window.fill("Name in files", "amount");
    // The range equals that of the node, and is stored in the graph once it was set.
    window.fill("Highest value", "2");
    window.fill("Highest value", "1");
    window.click("Change the panel");
    window.set_number("Rust amount", "0.9");
    window.fill("Name of a variant", "heavy");
    window.click_at(window.title(worn));
    window.click_at(window.knob("Opacity"));
    window.key(Key::Backspace);
}

/// Names the graph, chooses a larger texture size and a model, and saves it.
fn settle_down(window: &mut Window) -> PathBuf {
    let [model, file] = ["assets/meshes/bench.glb", "graphs/rusty.sabi"].map(|path| window.path(path));
    for path in [&model, &file] {
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    }
    fs::copy(window.editor().evaluation.model.file(), &model).expect("a model");
    window.click_at(window.on_canvas([0.97, 0.9]));
    window.click("GROUP INPUTS AND OUTPUTS");
    // The section opens in an animation.
    window.harness.run_steps(30);
    window.fill("Name of the graph", "Rusty edges");
    window.click("512 texels");
    window.click("1024 × 1024");
    window.press("Add a model");
    window.answer_path(&model);
    window.keys(Modifiers::COMMAND, Key::S);
    window.answer_path(&file);
    file
}

#[test]
fn a_whole_graph_is_built_from_nothing_and_its_file_is_as_expected() {
    let mut window = Window::untitled();
    window.settle();
    let empty = window.text();
    let names = build(&mut window);
    assert_eq!(
        window.steps(),
        6 + 5 + 6 + 2,
        "nodes, wires, knobs, and the frame with its name"
    );
    let worn = names.iter().find(|(_, name)| **name == "worn_p2dd");
    expose(&mut window, worn.expect("the blend").0);
    let file = settle_down(&mut window);
    let built = window.text();
    assert_eq!(fs::read_to_string(&file).expect("a file"), built);
    let mut text = built.clone();
    for (id, name) in &names {
        text = text.replace(&id.to_string(), name);
    }
    let frame = window
        .document()
        .graph()
        .frames()
        .keys()
        .next()
        .expect("a frame")
        .clone();
    text = text.replace(&frame, "wear_x2c4");
    let read: Json = serde_json::from_str(&text).expect("a graph file");
    assert_eq!(read, file_of_the_graph(), "{text}");
    let steps = window.steps();
    window.undo(steps);
    // The model that was shown when the first node was added is named without a step, for the recovery of a graph that was
    // never saved.
    let shown = "  \"preview\": {\n    \"mesh\": \"../examples/cube.glb\"\n  },\n  \"nodes\"";
    let nothing = empty.replace("  \"nodes\"", shown);
    assert_eq!(window.text(), nothing, "as many steps lead back to nothing");
    window.redo(steps);
    assert_eq!(window.text(), built, "and forth to the same bytes");
}
