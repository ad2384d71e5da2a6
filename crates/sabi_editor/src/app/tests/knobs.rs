//! Parameters in the window: one step for each drag, on nodes and in the panel, of several nodes, exposed.

use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::{beside, id};

const TWO: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [300, 0] },
    "more": { "kind": "noise/simplex", "pos": [0, 330] }
"#;

#[test]
fn a_drag_in_the_panel_is_one_undo_step_and_evaluates_fast_until_it_ends() {
    let mut window = Window::opened(TWO);
    window.click_at(window.title(&id("clouds")));
    let before = window.text();
    let bar = window.knob("Grain");
    window.pull(
        &[bar, beside(bar, [20.0, 0.0])],
        PointerButton::Primary,
        Modifiers::NONE,
    );
    assert!(
        window.editor().documents.is_dragging,
        "pictures are quick while it is dragged"
    );
    window.point(beside(bar, [34.0, 0.0]));
    window.keys(Modifiers::COMMAND, Key::Z);
    window.button(beside(bar, [34.0, 0.0]), PointerButton::Primary, false);
    window.settle();
    assert!(!window.editor().documents.is_dragging);
    assert_eq!(
        window.steps(),
        1,
        "{:?}",
        window.document().session.undo_names().collect::<Vec<_>>()
    );
    assert!(window.param(&id("clouds"), "gain").is_some());
    window.undo(1);
    assert_eq!(window.text(), before);
}

#[test]
fn a_drag_on_the_node_itself_turns_its_knob_and_does_not_move_it() {
    let mut window = Window::opened(TWO);
    let panel = window.editor().shell.dock.rects[&crate::dock::Panel::Canvas];
    let near = window.rect(&id("dots"));
    let found = window
        .harness
        .query_all_by_label_contains("Spacing")
        .map(|node| node.rect().center());
    let bar = found
        .into_iter()
        .find(|at| panel.contains(*at) && near.contains(*at))
        .expect("a knob on the node");
    window.drag_from(bar, beside(bar, [25.0, 0.0]));
    assert!(window.param(&id("dots"), "spacing").is_some());
    assert_eq!(window.document().node(&id("dots")).expect("a node").pos, [300.0, 0.0]);
    assert_eq!(window.steps(), 1);
}

#[test]
fn several_selected_nodes_of_a_kind_are_turned_together() {
    let mut window = Window::opened(TWO);
    window.keys(Modifiers::COMMAND, Key::A);
    let near = window.rect(&id("more"));
    let found = window
        .harness
        .query_all_by_label("Detail")
        .map(|node| node.rect().center());
    let bar = found
        .into_iter()
        .find(|at| near.contains(*at))
        .expect("a knob on the node");
    window.double_click(bar);
    window.keys(Modifiers::COMMAND, Key::A);
    window.typed("5");
    window.key(Key::Enter);
    let detail = |window: &Window, node: &str| window.param(&id(node), "octaves");
    assert_eq!(
        [detail(&window, "clouds"), detail(&window, "more")].map(|it| it.unwrap_or_default()),
        ["5", "5"]
    );
    assert_eq!(window.param(&id("dots"), "octaves"), None);
    assert_eq!(window.steps(), 1);
}

#[test]
fn an_expression_is_evaluated_and_an_invalid_one_is_reported() {
    let mut window = Window::opened(TWO);
    window.click_at(window.title(&id("clouds")));
    window.set_number("Grain", "2*0.3");
    assert_eq!(window.param(&id("clouds"), "gain").as_deref(), Some("0.6"));
    window.set_number("Grain", "much");
    assert_eq!(window.param(&id("clouds"), "gain").as_deref(), Some("0.6"));
    assert_eq!(window.steps(), 1);
}

#[test]
fn after_a_number_was_typed_keys_run_commands_again() {
    let mut window = Window::opened(TWO);
    window.click_at(window.title(&id("clouds")));
    window.set_number("Grain", "0.25");
    window.undo(1);
    assert_eq!(window.param(&id("clouds"), "gain"), None);
    window.point(window.on_canvas([0.9, 0.9]));
    window.key(Key::M);
    assert!(window.document().node(&id("clouds")).expect("a node").muted);
}

#[test]
fn a_parameter_is_exposed_and_unexposed_by_its_menu() {
    let mut window = Window::opened(TWO);
    window.click_at(window.title(&id("clouds")));
    let bar = window.knob("Grain");
    window.click_with(bar, PointerButton::Secondary, Modifiers::NONE);
    window.press("Expose parameter");
    let exposed: Vec<_> = window.document().graph().exposed().values().cloned().collect();
    assert_eq!(exposed.len(), 1);
    assert_eq!(exposed[0].to[0].to_string(), "clouds.gain");
    window.click_with(window.knob("Grain"), PointerButton::Secondary, Modifiers::NONE);
    window.press("Stop exposing");
    assert_eq!(window.document().graph().exposed().len(), 0);
    assert_eq!(window.steps(), 2);
}

#[test]
fn the_value_of_a_connected_input_cannot_be_dragged() {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
        "mix": { "kind": "blend/mask", "inputs": { "below": "clouds" }, "pos": [300, 0] }
        "#,
    );
    window.click_at(window.title(&id("mix")));
    let at = window.knob("Below");
    window.drag_from(at, beside(at, [20.0, 0.0]));
    assert_eq!(window.param(&id("mix"), "below"), None);
    assert_eq!(window.steps(), 0);
}

#[test]
fn a_canceled_drag_leaves_the_graph_and_the_redo_steps_unchanged() {
    let mut window = Window::opened(r#""blend": { "kind": "blend/mask", "pos": [0, 0] }"#);
    let blend = id("blend");
    window.click_at(window.title(&blend));
    window.set_number("Opacity", "0.5");
    window.undo(1);
    let before = window.text();
    let at = window.knob("Opacity");
    window.pull(&[at, beside(at, [-30.0, 0.0])], PointerButton::Primary, Modifiers::NONE);
    assert_ne!(window.text(), before);
    window.key(Key::Escape);
    window.button(beside(at, [-30.0, 0.0]), PointerButton::Primary, false);
    assert_eq!(window.text(), before);
    window.redo(1);
    assert_eq!(window.param(&blend, "opacity").as_deref(), Some("0.5"));
}

#[test]
fn a_drag_whose_knob_disappeared_ends_when_the_button_is_released_outside() {
    let mut window = Window::opened(TWO);
    let near = window.rect(&id("dots"));
    let found = window.harness.query_all_by_label("Spacing");
    let mut found = found.map(|node| node.rect().center());
    let bar = found.find(|at| near.contains(*at)).expect("a knob on the node");
    drop(found);
    window.pull(
        &[bar, beside(bar, [25.0, 0.0])],
        PointerButton::Primary,
        Modifiers::NONE,
    );
    assert!(window.editor().documents.is_dragging);
    // Nodes are cards at this zoom.
    window.wheel(beside(bar, [25.0, 0.0]), -900.0);
    let outside = egui::pos2(-40.0, -40.0);
    window.point(outside);
    window.button(outside, PointerButton::Primary, false);
    window.settle();
    assert!(!window.editor().documents.is_dragging);
    window.harness.state_mut().documents.document.select([id("clouds")]);
    let empty = window.on_canvas([0.98, 0.02]);
    window.point(empty);
    window.key(Key::M);
    assert_eq!(window.steps(), 2, "muting is no part of the drag");
    window.undo(1);
    assert!(window.param(&id("dots"), "spacing").is_some());
}
