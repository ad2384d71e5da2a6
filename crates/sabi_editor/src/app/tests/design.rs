//! The graph that DESIGN.md begins with, built from nothing.

use std::collections::BTreeMap;

use egui::{Key, Modifiers, PointerButton};
use sabi_graph::NodeId;
use serde_json::{Value as Json, json};

use super::Window;

/// Its nodes and frame, as they stand in DESIGN.md §3.
fn nodes_and_frames() -> [Json; 2] {
    [
        json!({
            "edges_k7f2": { "kind": "surface/edges", "params": { "width": 0.03 }, "pos": [0, 0] },
            "grain_m3x9": { "kind": "noise/simplex", "params": { "seed": 7 }, "pos": [0, 220] },
            "out": { "kind": "output/material", "inputs": { "material": "rust_a81c" }, "pos": [780, 60] },
            "paint_0b5e": { "kind": "source/material", "params": { "color": "#3c5a6e" }, "pos": [260, -120] },
            "rust_a81c": { "kind": "effect/layer", "inputs": { "base": "paint_0b5e", "mask": "worn_p2dd" },
                "params": { "color": "#6b3a1e", "roughness": 0.9 }, "pos": [520, 60] },
            "worn_p2dd": { "kind": "blend/mask", "inputs": { "above": "grain_m3x9", "below": "edges_k7f2" },
                "pos": [260, 80] }
        }),
        json!({
            "wear_x2c4": { "title": "Where it wears", "color": "#4a5a6a", "nodes": ["edges_k7f2", "grain_m3x9"] }
        }),
    ]
}

/// Adds a node with its upper left corner at a place of the canvas.
fn add_at(window: &mut Window, place: [f32; 2], query: &str) -> NodeId {
    window.point(window.screen(place));
    window.key(Key::Tab);
    window.pick(query)
}

fn build(window: &mut Window) -> BTreeMap<NodeId, &'static str> {
    // All of it has to be on the screen.
    window.wheel(window.on_canvas([0.0, 0.0]), -190.0);
    let ends = [window.on_canvas([0.1, 0.1]), window.on_canvas([0.14, 0.4])];
    window.drag_along(&ends, PointerButton::Middle, Modifiers::NONE);
    let edges = add_at(window, [0.0, 0.0], "edges");
    let grain = add_at(window, [0.0, 220.0], "clouds");
    let paint = add_at(window, [260.0, -120.0], "source material");
    let worn = add_at(window, [260.0, 80.0], "blend mask");
    let rust = add_at(window, [520.0, 60.0], "effect layer");
    let out = add_at(window, [780.0, 60.0], "material output");
    window.wire((&edges, "mask"), (&worn, "below"));
    window.wire((&grain, "mask"), (&worn, "above"));
    window.wire((&paint, "material"), (&rust, "base"));
    window.wire((&worn, "mask"), (&rust, "mask"));
    window.wire((&rust, "material"), (&out, "material"));
    window.click_at(window.title(&edges));
    window.set_number("Width", "0.03");
    // New nodes get seeds of their own; Backspace gives a knob its default back.
    window.click_at(window.knob("Seed"));
    window.key(Key::Backspace);
    // Its title is below the node above it.
    window.click_at(window.rect(&grain).center());
    window.set_number("Seed", "7");
    window.click_at(window.title(&paint));
    window.set_color("Color", "#3c5a6e");
    window.click_at(window.title(&rust));
    window.set_color("Color", "#6b3a1e");
    window.set_number("Roughness", "0.9");
    window.click_at(window.title(&edges));
    window.click_with(window.rect(&grain).center(), PointerButton::Primary, Modifiers::SHIFT);
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

#[test]
fn the_graph_of_the_design_is_built_from_nothing_and_its_text_is_the_designs() {
    let mut window = Window::empty();
    window.settle();
    let empty = window.text();
    let names = build(&mut window);
    let built = window.text();
    let mut text = built.clone();
    for (id, name) in &names {
        text = text.replace(&format!("\"{id}\""), &format!("\"{name}\""));
    }
    let frame = window.desk().graph().frames().keys().next().expect("a frame").clone();
    text = text.replace(&format!("\"{frame}\""), "\"wear_x2c4\"");
    let read: Json = serde_json::from_str(&text).expect("a graph file");
    let [nodes, frames] = nodes_and_frames();
    assert_eq!(read["nodes"], nodes, "{text}");
    assert_eq!(read["frames"], frames);
    let steps = window.steps();
    assert_eq!(steps, 6 + 5 + 6 + 2, "nodes, wires, knobs, and the frame with its name");
    window.undo(steps);
    assert_eq!(window.text(), empty, "as many steps lead back to nothing");
    window.redo(steps);
    assert_eq!(window.text(), built, "and forth to the same bytes");
}
