//! Masks that multiply parameters, linked by the menu of a parameter and by wires that are dropped on nodes.

use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::id;

const LOOSE: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [330, 0] },
    "levels": { "kind": "adjust/levels", "pos": [330, 330] }
"#;

/// Opens the menu of a parameter and chooses an entry.
fn choose(window: &mut Window, knob: &str, entry: &str) {
    window.click_with(window.knob(knob), PointerButton::Secondary, Modifiers::NONE);
    window.press(entry);
}

#[test]
fn a_parameter_gets_a_new_node_as_its_mask_by_its_menu_and_loses_it_again() {
    let mut window = Window::opened(LOOSE);
    window.click_at(window.title(&id("dots")));
    choose(&mut window, "Variation", "Multiply by a mask…");
    assert!(window.says("Nodes that fit the wire"));
    let cells = window.pick("cells");
    assert_eq!(window.reads(&id("dots"), "variation"), cells.to_string());
    window.click_at(window.title(&id("dots")));
    assert!(window.says("× mask of Cells"));
    window.set_number("Variation", "0.5");
    assert_eq!(window.param(&id("dots"), "variation").as_deref(), Some("0.5"));
    choose(&mut window, "Variation", "Remove the mask");
    assert_eq!(window.reads(&id("dots"), "variation"), "");
    assert!(!window.says("× mask of"));
    assert_eq!(window.steps(), 3);
    choose(&mut window, "Variation", "Expose its mask as an input");
    assert!(window.says("× mask of the input 'Variation'"));
}

#[test]
fn a_wire_that_fits_no_input_of_a_node_asks_which_parameter_it_multiplies() {
    let mut window = Window::opened(LOOSE);
    let from = window.port(&id("clouds"), "mask");
    window.drag_from(from, window.title(&id("dots")));
    assert!(window.says("Multiply by the mask:"));
    window.press("Multiply Variation");
    assert_eq!(window.reads(&id("dots"), "variation"), "clouds");
    assert_eq!(window.steps(), 1);
    window.drag_from(from, window.title(&id("levels")));
    assert_eq!(window.reads(&id("levels"), "source"), "clouds", "an input takes it");
    assert_eq!(window.steps(), 2);
}

#[test]
fn a_wire_dropped_on_a_parameter_offers_the_inputs_and_that_parameter() {
    let mut window = Window::opened(LOOSE);
    let near = window.rect(&id("levels"));
    let found = window.harness.query_all_by_label("White");
    let mut found = found.map(|node| node.rect().center());
    let bar = found.find(|at| near.contains(*at)).expect("a knob on the node");
    drop(found);
    let from = window.port(&id("clouds"), "mask");
    window.drag_from(from, bar);
    assert!(window.says("Connect to:") && window.says("Multiply by the mask:"));
    window.key(Key::Escape);
    assert_eq!(window.steps(), 0);
    window.drag_from(from, bar);
    window.key(Key::Enter);
    assert_eq!(window.reads(&id("levels"), "white"), "clouds");
    assert_eq!(window.reads(&id("levels"), "source"), "");
    // Dragged from there to the node again, the wire is connected to the input.
    window.drag_from(window.port(&id("levels"), "white"), bar);
    window.press("Source");
    assert_eq!(window.reads(&id("levels"), "source"), "clouds");
    assert_eq!(window.reads(&id("levels"), "white"), "");
    assert_eq!(window.steps(), 2);
}

#[test]
fn a_slider_on_a_node_gets_a_mask_by_its_menu_too() {
    let mut window = Window::opened(LOOSE);
    let near = window.rect(&id("levels"));
    let found = window.harness.query_all_by_label("White");
    let mut found = found.map(|node| node.rect().center());
    let slider = found.find(|at| near.contains(*at)).expect("a slider on the node");
    drop(found);
    window.click_with(slider, PointerButton::Secondary, Modifiers::NONE);
    window.press("Multiply by a mask…");
    let cells = window.pick("cells");
    assert_eq!(window.reads(&id("levels"), "white"), cells.to_string());
}
