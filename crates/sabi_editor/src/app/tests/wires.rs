//! Wires by the pointer.

use egui::{Key, Modifiers, PointerButton};
use sabi_editing::node_size::{ROW_HEIGHT, TITLE_HEIGHT};

use super::Window;
use super::hands::{beside, between, id};

/// Two masks, a blend without inputs, and a layer on paint.
const LOOSE: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [0, 330] },
    "layer": { "kind": "effect/layer", "pos": [330, 120] },
    "paint": { "kind": "source/material", "pos": [0, 660] }
"#;

/// The same with clouds as the layer's mask.
const WIRED: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [0, 330] },
    "invert": { "kind": "adjust/invert", "pos": [300, 520] },
    "layer": { "kind": "effect/layer", "inputs": { "mask": "clouds" }, "pos": [560, 120] }
"#;

#[test]
fn a_wire_is_dropped_at_a_port_or_anywhere_on_a_node_that_takes_it() {
    let mut window = Window::opened(LOOSE);
    window.wire(&id("clouds"), "mask", &id("layer"), "mask");
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    assert_eq!(window.steps(), 1);
    let from = window.port(&id("paint"), "material");
    window.drag_from(from, beside(window.title(&id("layer")), [30.0, 0.0]));
    assert_eq!(
        window.reads(&id("layer"), "base"),
        "paint",
        "the first input that takes a material"
    );
}

#[test]
fn a_wire_is_pulled_backwards_from_an_input_too() {
    let mut window = Window::opened(LOOSE);
    window.wire(&id("layer"), "mask", &id("dots"), "mask");
    assert_eq!(window.reads(&id("layer"), "mask"), "dots");
    let from = window.port(&id("layer"), "base");
    window.drag_from(from, beside(window.title(&id("paint")), [0.0, 0.0]));
    assert_eq!(window.reads(&id("layer"), "base"), "paint", "on the body of a node");
}

#[test]
fn a_wire_dropped_in_a_free_place_offers_the_nodes_that_it_fits() {
    let mut window = Window::opened(LOOSE);
    let from = window.port(&id("paint"), "material");
    let free = window.on_canvas([0.6, 0.8]);
    window.drag_from(from, free);
    assert!(window.says("Nodes that fit the wire"));
    let labels = window.labels();
    assert!(labels.iter().any(|label| label == "Adjust material"), "{labels:?}");
    // The list offers no mask nodes for a material.
    window.typed("threshold");
    assert!(window.says("No node is called that"), "a threshold takes no material");
    window.keys(Modifiers::COMMAND, Key::A);
    let layer = window.pick("effect layer");
    assert_ne!(layer, id("layer"));
    assert_eq!(window.reads(&layer, "base"), "paint", "it is tied at once");
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_wire_pulled_from_an_input_into_empty_space_offers_nodes_that_fit() {
    let mut window = Window::opened(LOOSE);
    let from = window.port(&id("layer"), "base");
    window.drag_from(from, window.on_canvas([0.6, 0.85]));
    window.typed("source material");
    window.key(Key::Enter);
    let added = window.document().selected_one().expect("a node").clone();
    assert_eq!(window.reads(&id("layer"), "base"), added.to_string());
}

#[test]
fn a_wire_taken_off_an_input_is_removed_or_reconnected_as_one_step() {
    let mut window = Window::opened(WIRED);
    let mask = window.port(&id("layer"), "mask");
    window.drag_from(mask, window.on_canvas([0.5, 0.95]));
    assert_eq!(window.reads(&id("layer"), "mask"), "");
    assert_eq!(window.steps(), 1);
    window.undo(1);
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    window.wire(&id("layer"), "mask", &id("layer"), "roughness_map");
    assert_eq!(window.reads(&id("layer"), "mask"), "");
    assert_eq!(window.reads(&id("layer"), "roughness_map"), "clouds");
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_wire_dropped_where_it_was_taken_changes_nothing() {
    let mut window = Window::opened(WIRED);
    let mask = window.port(&id("layer"), "mask");
    let way = [mask, beside(mask, [-60.0, 40.0]), mask];
    window.drag_along(&way, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    assert_eq!(window.steps(), 0);
}

#[test]
fn a_second_wire_on_a_connected_mask_asks_how_to_combine_both() {
    let mut window = Window::opened(WIRED);
    for (answer, mode) in [
        ("Multiply", "multiply"),
        ("Add", "add"),
        ("Max", "max"),
        ("Subtract", "subtract"),
    ] {
        window.wire(&id("dots"), "mask", &id("layer"), "mask");
        assert!(window.says("The input has a mask already. Combine both by:"));
        assert_eq!(
            window.reads(&id("layer"), "mask"),
            "clouds",
            "nothing is done before the answer"
        );
        window.press(answer);
        let blend = window.document().selected_one().expect("the blend").clone();
        assert_eq!(window.reads(&id("layer"), "mask"), blend.to_string());
        assert_eq!(
            [window.reads(&blend, "below"), window.reads(&blend, "above")],
            ["clouds", "dots"]
        );
        assert_eq!(window.param(&blend, "mode").as_deref(), Some(&*format!("\"{mode}\"")));
        assert_eq!(window.steps(), 1);
        window.undo(1);
    }
}

#[test]
fn a_second_wire_can_replace_the_first_or_be_canceled() {
    let mut window = Window::opened(WIRED);
    window.wire(&id("dots"), "mask", &id("layer"), "mask");
    window.key(Key::Escape);
    assert!(!window.says("The input has a mask already. Combine both by:"));
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    window.wire(&id("dots"), "mask", &id("layer"), "mask");
    window.press("Replace");
    assert_eq!(window.reads(&id("layer"), "mask"), "dots");
}

#[test]
fn a_port_that_refuses_a_wire_says_why_and_nothing_changes() {
    let mut window = Window::opened(WIRED);
    window.wire(&id("layer"), "material", &id("invert"), "source");
    assert!(window.says("this wire carries a material"));
    assert_eq!(window.reads(&id("invert"), "source"), "");
    assert_eq!(window.steps(), 0);
    let mut window = Window::opened(CHAIN);
    window.wire(&id("invert"), "mask", &id("invert"), "source");
    assert!(window.says("'Invert' cannot read its own result"));
    assert_eq!(window.reads(&id("invert"), "source"), "clouds");
    assert_eq!(window.steps(), 0);
}

#[test]
fn a_node_dropped_on_a_wire_is_inserted_into_it() {
    let mut window = Window::opened(WIRED);
    let middle = between(window.port(&id("clouds"), "mask"), window.port(&id("layer"), "mask"));
    let handle = window.title(&id("invert"));
    let center = window.rect(&id("invert")).center();
    window.drag_from(handle, middle + (handle - center));
    assert_eq!(window.reads(&id("invert"), "source"), "clouds");
    assert_eq!(window.reads(&id("layer"), "mask"), "invert");
    assert_eq!(window.steps(), 1, "moved and tied in one step");
    window.undo(1);
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    assert_eq!(
        window.document().node(&id("invert")).expect("a node").pos,
        [300.0, 520.0]
    );
}

#[test]
fn a_node_is_inserted_into_a_wire_by_the_place_where_it_is_held_and_by_tab_over_the_wire() {
    let mut window = Window::opened(WIRED);
    let middle = between(window.port(&id("clouds"), "mask"), window.port(&id("layer"), "mask"));
    let handle = window.title(&id("invert"));
    assert!(
        window.rect(&id("invert")).center().distance(handle) > 30.0,
        "held away from its middle"
    );
    window.drag_from(handle, middle);
    assert_eq!(window.reads(&id("invert"), "source"), "clouds");
    window.undo(1);
    window.point(middle);
    window.key(Key::Tab);
    window.typed("invert");
    window.key(Key::Enter);
    let read = window.reads(&id("layer"), "mask");
    assert_ne!(read, "clouds", "a new node lies between");
    assert_eq!(window.reads(&read.parse().expect("an id"), "source"), "clouds");
}

const CHAIN: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [280, 60] },
    "layer": { "kind": "effect/layer", "inputs": { "mask": "invert" }, "pos": [560, 120] }
"#;

#[test]
fn a_node_dragged_with_alt_leaves_its_wires_and_their_ends_are_connected() {
    let mut window = Window::opened(CHAIN);
    let handle = window.title(&id("invert"));
    window.drag_with(handle, beside(handle, [0.0, 420.0]), Modifiers::ALT);
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    assert_eq!(window.reads(&id("invert"), "source"), "");
    assert_eq!(window.steps(), 1);
    assert!(window.document().node(&id("invert")).expect("a node").pos[1] > 300.0);
    window.undo(1);
    assert_eq!(window.reads(&id("layer"), "mask"), "invert");
}

#[test]
fn a_line_drawn_with_ctrl_and_the_right_button_cuts_what_it_crosses() {
    let mut window = Window::opened(CHAIN);
    let gap = between(window.port(&id("clouds"), "mask"), window.port(&id("invert"), "source"));
    let way = [beside(gap, [0.0, -90.0]), beside(gap, [0.0, 90.0])];
    window.drag_along(&way, PointerButton::Secondary, Modifiers::COMMAND);
    assert_eq!(window.reads(&id("invert"), "source"), "");
    assert_eq!(
        window.reads(&id("layer"), "mask"),
        "invert",
        "the other wire is not crossed"
    );
    assert_eq!(window.steps(), 1);
    assert!(!window.says("Find a node"), "no menu opens after it");
}

#[test]
fn a_click_with_alt_cuts_a_wire_and_a_double_click_adds_a_reroute() {
    let mut window = Window::opened(CHAIN);
    let gap = between(window.port(&id("clouds"), "mask"), window.port(&id("invert"), "source"));
    window.double_click(gap);
    let reroute = window
        .document()
        .graph()
        .nodes()
        .find(|(_, node)| node.kind == "graph/reroute");
    let reroute = reroute.expect("a reroute").0.clone();
    assert_eq!(window.reads(&reroute, "source"), "clouds");
    assert_eq!(window.reads(&id("invert"), "source"), reroute.to_string());
    window.undo(1);
    window.click_with(gap, PointerButton::Primary, Modifiers::ALT);
    assert_eq!(window.reads(&id("invert"), "source"), "");
}

#[test]
fn ports_stand_beside_the_rows_that_name_them() {
    let mut window = Window::opened(CHAIN);
    let rect = window.rect(&id("layer"));
    let base = window.port(&id("layer"), "base");
    let row = (TITLE_HEIGHT + 0.5 * ROW_HEIGHT) * window.zoom();
    assert!(
        (base - (rect.left_top() + egui::vec2(0.0, row))).length() < 1.5,
        "{base:?} {rect:?}"
    );
    window.point(base);
}

#[test]
fn a_wire_that_is_pulled_and_dropped_within_one_slow_frame_is_connected() {
    let mut window = Window::opened(LOOSE);
    let ends = [window.port(&id("clouds"), "mask"), window.port(&id("layer"), "mask")];
    window.pause();
    window.point(ends[0]);
    for (at, pressed) in [(ends[0], true), (ends[1], false)] {
        window.harness.event(egui::Event::PointerMoved(at));
        window.queue_button(at, PointerButton::Primary, pressed);
    }
    window.settle();
    assert_eq!(window.reads(&id("layer"), "mask"), "clouds");
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_wire_dropped_on_a_node_takes_a_free_port_of_its_type_before_all_others() {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
        "dots": { "kind": "noise/dots", "pos": [0, 400] },
        "mix": { "kind": "blend/mask", "inputs": { "below": "clouds" }, "pos": [400, 0] },
        "all": { "kind": "material/combine", "pos": [400, 400] }
    "#,
    );
    let [mix, all, dots] = ["mix", "all", "dots"].map(id);
    window.drag_from(window.port(&dots, "mask"), window.rect(&mix).center());
    assert_eq!(
        (window.reads(&mix, "below"), window.reads(&mix, "above")),
        ("clouds".into(), "dots".into())
    );
    window.drag_from(window.port(&dots, "mask"), window.rect(&all).center());
    assert_eq!(window.reads(&all, "base_color"), "", "a mask is no color");
    assert_eq!(window.document().graph().inputs(all.as_str()).len(), 1);
}
