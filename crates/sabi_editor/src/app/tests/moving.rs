//! Nodes and frames by the pointer: moving, selecting, copying, replacing.

use egui::{Event, Key, Modifiers, OutputCommand, PointerButton, Pos2};

use super::Window;
use super::hands::{beside, id};

const THREE: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [3, 347] },
    "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [400, 0] }
"#;

fn pos(window: &Window, node: &str) -> [f32; 2] {
    window.document().node(&id(node)).expect("a node").pos
}

fn selected(window: &Window) -> Vec<String> {
    window.document().selection().iter().map(ToString::to_string).collect()
}

#[test]
fn a_dragged_node_snaps_and_with_ctrl_does_not() {
    let mut window = Window::opened(THREE);
    let zoom = window.zoom();
    let handle = window.title(&id("dots"));
    window.drag_from(handle, beside(handle, [26.0 * zoom, 9.0 * zoom]));
    assert_eq!(pos(&window, "dots"), [30.0, 360.0]);
    assert_eq!(window.steps(), 1);
    let handle = window.title(&id("dots"));
    window.drag_with(handle, beside(handle, [26.0 * zoom, 13.0 * zoom]), Modifiers::COMMAND);
    assert_eq!(pos(&window, "dots"), [56.0, 373.0]);
}

#[test]
fn selected_nodes_move_together_and_another_one_alone() {
    let mut window = Window::opened(THREE);
    let zoom = window.zoom();
    window.click_at(window.title(&id("clouds")));
    window.click_with(window.title(&id("invert")), PointerButton::Primary, Modifiers::SHIFT);
    assert_eq!(selected(&window), ["clouds", "invert"]);
    let handle = window.title(&id("clouds"));
    window.drag_from(handle, beside(handle, [50.0 * zoom, 0.0]));
    assert_eq!(
        [pos(&window, "clouds"), pos(&window, "invert")],
        [[50.0, 0.0], [450.0, 0.0]]
    );
    let handle = window.title(&id("dots"));
    window.drag_from(handle, beside(handle, [47.0 * zoom, 3.0 * zoom]));
    assert_eq!(selected(&window), ["dots"]);
    assert_eq!(pos(&window, "clouds"), [50.0, 0.0]);
    assert_eq!(window.steps(), 2);
}

#[test]
fn escape_returns_dragged_nodes_to_where_they_were() {
    let mut window = Window::opened(THREE);
    let before = window.text();
    let handle = window.title(&id("invert"));
    let away = beside(handle, [0.0, 200.0]);
    window.pull(&[handle, away], PointerButton::Primary, Modifiers::ALT);
    assert_ne!(window.text(), before);
    window.key(Key::Escape);
    window.button(away, PointerButton::Primary, false);
    window.hold(Modifiers::NONE);
    window.settle();
    assert_eq!(window.text(), before, "the wires are back too");
    assert_eq!((window.steps(), window.document().session.redo_names().count()), (0, 0));
    window.key(Key::M);
    assert_eq!(window.steps(), 1, "what comes next is a step of its own");
}

#[test]
fn keys_wait_while_nodes_are_dragged() {
    let mut window = Window::opened(THREE);
    let handle = window.title(&id("invert"));
    let away = beside(handle, [0.0, 200.0]);
    window.pull(&[handle, away], PointerButton::Primary, Modifiers::NONE);
    window.keys(Modifiers::COMMAND, Key::Z);
    window.key(Key::Delete);
    window.point(beside(away, [0.0, 30.0]));
    window.button(away, PointerButton::Primary, false);
    window.settle();
    assert_eq!(window.steps(), 1, "one drag, one step");
    window.undo(1);
    assert_eq!(pos(&window, "invert"), [400.0, 0.0]);
}

#[test]
fn a_box_and_a_lasso_select_nodes_and_shift_keeps_the_earlier_selection() {
    let mut window = Window::opened(THREE);
    let around = window.rect(&id("dots")).expand(12.0);
    window.drag_from(around.left_top(), around.center());
    assert_eq!(selected(&window), ["dots"], "a box takes what it touches");
    let around = window.rect(&id("invert")).expand(12.0);
    window.drag_with(around.left_top(), around.right_bottom(), Modifiers::SHIFT);
    assert_eq!(selected(&window), ["dots", "invert"]);
    let around = window.rect(&id("clouds")).expand(12.0);
    let way = [
        around.left_top(),
        around.right_top(),
        around.right_bottom(),
        around.left_bottom(),
    ];
    window.drag_along(&way, PointerButton::Primary, Modifiers::ALT);
    assert_eq!(selected(&window), ["clouds"], "a lasso takes what it goes around");
    window.click_with(window.title(&id("dots")), PointerButton::Primary, Modifiers::COMMAND);
    assert_eq!(selected(&window), ["clouds", "dots"]);
    window.click_with(window.title(&id("clouds")), PointerButton::Primary, Modifiers::COMMAND);
    assert_eq!(selected(&window), ["dots"], "once more lets it go");
    window.click_at(window.on_canvas([0.9, 0.95]));
    assert_eq!(selected(&window), [""; 0]);
}

const FRAMED: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [260, 0] },
    "invert": { "kind": "adjust/invert", "pos": [0, 400] }
"#;

/// Place of the title of the frame around clouds and dots.
fn strip(window: &Window) -> Pos2 {
    let corner = window.rect(&id("clouds")).left_top();
    corner + egui::vec2(60.0, -35.0) * window.zoom()
}

#[test]
fn a_frame_moves_its_nodes_can_be_named_and_is_removed_without_them() {
    let mut window = Window::opened(FRAMED);
    window.click_at(window.title(&id("clouds")));
    window.click_with(window.title(&id("dots")), PointerButton::Primary, Modifiers::SHIFT);
    window.key(Key::C);
    let zoom = window.zoom();
    let handle = strip(&window);
    window.drag_from(handle, beside(handle, [40.0 * zoom, 60.0 * zoom]));
    assert_eq!(
        [pos(&window, "clouds"), pos(&window, "dots")],
        [[40.0, 60.0], [300.0, 60.0]]
    );
    assert_eq!(pos(&window, "invert"), [0.0, 400.0]);
    let title = |window: &Window| {
        let frame = window.document().graph().frames().values().next().cloned();
        frame.and_then(|frame| frame.title)
    };
    window.double_click(strip(&window));
    window.keys(Modifiers::COMMAND, Key::A);
    window.typed("Wear");
    window.key(Key::Enter);
    assert_eq!(title(&window).as_deref(), Some("Wear"));
    assert!(window.says("Frame Wear"), "it is named for those who do not see it");
    window.click_with(strip(&window), PointerButton::Secondary, Modifiers::NONE);
    window.press("Delete the frame, keep its nodes");
    assert_eq!(title(&window), None);
    assert_eq!(window.document().graph().len(), 3);
    window.undo(4);
    assert_eq!(window.steps(), 0);
}

#[test]
fn nodes_are_copied_as_text_and_pasted_under_the_pointer() {
    let mut window = Window::opened(THREE);
    window.click_at(window.title(&id("clouds")));
    window.click_with(window.title(&id("invert")), PointerButton::Primary, Modifiers::SHIFT);
    window.harness.event(Event::Copy);
    window.harness.step();
    let copied = window
        .harness
        .output()
        .platform_output
        .commands
        .iter()
        .find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
    let copied = copied.expect("a text in the clipboard");
    let at = window.on_canvas([0.4, 0.8]);
    window.point(at);
    let there = window
        .editor()
        .views
        .canvas
        .camera
        .place_at(at)
        .expect("on the canvas")
        .map(f32::round);
    window.harness.event(Event::Paste(copied));
    window.settle();
    assert_eq!(window.document().graph().len(), 5);
    let copies: Vec<_> = window.document().selection().iter().cloned().collect();
    assert_eq!(copies.len(), 2, "what was pasted is selected");
    let corner = window.document().node(&copies[0]).expect("a copy").pos;
    assert!(
        (corner[0] - there[0]).abs() <= 1.0 && (corner[1] - there[1]).abs() <= 1.0,
        "{corner:?} {there:?}"
    );
    let readers = copies
        .iter()
        .filter(|copy| window.reads(copy, "source") == copies[0].to_string());
    assert_eq!(readers.count(), 1, "the wire between them comes along");
    window.harness.event(Event::Paste("no graph".to_owned()));
    window.settle();
    assert!(window.says("The clipboard holds no nodes"));
    assert_eq!(window.steps(), 1);
}

#[test]
fn the_right_button_on_a_node_opens_a_menu_of_its_commands() {
    let mut window = Window::opened(THREE);
    window.click_with(window.title(&id("invert")), PointerButton::Secondary, Modifiers::NONE);
    assert_eq!(selected(&window), ["invert"]);
    window.press("Mute");
    assert!(window.document().node(&id("invert")).expect("a node").muted);
    window.harness.state_mut().pin(&id("invert"));
    window.click_with(window.title(&id("invert")), PointerButton::Secondary, Modifiers::NONE);
    window.press("Replace with…");
    window.typed("threshold");
    window.key(Key::Enter);
    let replaced = window
        .document()
        .graph()
        .nodes()
        .find(|(_, node)| node.kind == "adjust/threshold");
    let replaced = replaced.expect("another node").0.clone();
    assert!(window.document().node(&id("invert")).is_none());
    assert_eq!(window.reads(&replaced, "source"), "clouds", "wires that fit stay");
    let pinned = window
        .editor()
        .looks
        .pinned_2d
        .as_ref()
        .map(|pinned| pinned.node.as_str());
    assert_eq!(
        pinned,
        Some(replaced.as_str()),
        "who looked at the one looks at the other"
    );
}

#[test]
fn the_right_button_beside_nodes_adds_a_node_and_on_a_wire_inserts_one() {
    let mut window = Window::opened(THREE);
    let [one, other] = [window.port(&id("clouds"), "mask"), window.port(&id("invert"), "source")];
    window.click_with(one.lerp(other, 0.5), PointerButton::Secondary, Modifiers::NONE);
    let added = window.pick("threshold");
    assert_eq!(window.reads(&added, "source"), "clouds");
    assert_eq!(window.reads(&id("invert"), "source"), added.to_string());
    assert_eq!(window.steps(), 1);
    window.click_with(window.on_canvas([0.8, 0.9]), PointerButton::Secondary, Modifiers::NONE);
    window.key(Key::Escape);
    assert!(!window.says("Find a node"));
    window.click_with(window.on_canvas([0.8, 0.9]), PointerButton::Secondary, Modifiers::NONE);
    window.click_at(window.on_canvas([0.1, 0.95]));
    assert!(!window.says("Find a node"), "a click beside the menu closes it");
}

#[test]
fn a_click_on_a_node_or_a_port_shows_its_result_and_ctrl_shift_pins_it() {
    let mut window = Window::opened(
        r#"
        "cells": { "kind": "noise/cells", "pos": [0, 0] },
        "dots": { "kind": "noise/dots", "pos": [300, 0] }
        "#,
    );
    let seen = |window: &Window| {
        let editor = window.editor();
        [&editor.looks.shown, &editor.looks.pinned_2d].map(|seen| {
            let port = |node: &sabi_graph::NodeRef| node.port.as_ref().map(|port| format!(".{port}"));
            seen.as_ref()
                .map(|node| format!("{}{}", node.node, port(node).unwrap_or_default()))
                .unwrap_or_default()
        })
    };
    window.click_at(window.title(&id("cells")));
    assert_eq!(seen(&window), ["cells", ""]);
    window.click_at(window.port(&id("cells"), "id"));
    assert_eq!(seen(&window), ["cells.id", ""]);
    let both = Modifiers::COMMAND | Modifiers::SHIFT;
    window.click_with(window.title(&id("dots")), PointerButton::Primary, both);
    assert_eq!(seen(&window), ["cells.id", "dots"]);
    assert_eq!(selected(&window), ["cells"], "pinning selects nothing");
    window.click_with(window.title(&id("dots")), PointerButton::Primary, both);
    assert_eq!(seen(&window), ["cells.id", ""]);
}

#[test]
fn a_frame_takes_only_its_own_nodes_along_whatever_is_selected() {
    let mut window = Window::opened(FRAMED);
    window.click_at(window.title(&id("clouds")));
    window.click_with(window.title(&id("dots")), PointerButton::Primary, Modifiers::SHIFT);
    window.key(Key::C);
    window.click_at(window.title(&id("invert")));
    window.key(Key::C);
    let holds = |window: &Window| -> Vec<Vec<String>> {
        let frames = window.document().graph().frames().values();
        let mut held: Vec<Vec<String>> = frames
            .map(|frame| frame.nodes.iter().map(ToString::to_string).collect())
            .collect();
        held.sort();
        held
    };
    let before = [vec!["clouds", "dots"], vec!["invert"]];
    assert_eq!(holds(&window), before);
    let handle = strip(&window);
    window.drag_from(handle, beside(handle, [0.0, 20.0]));
    assert_eq!(holds(&window), before, "what was selected beside it is not put into it");
    assert_eq!(selected(&window), ["clouds", "dots"]);
    let handle = strip(&window);
    let other = window.rect(&id("invert")).center();
    window.drag_from(handle, other);
    assert_eq!(holds(&window), before, "no frame goes into another");
}

#[test]
fn the_menu_of_a_frame_gives_it_the_next_color() {
    let mut window = Window::opened(FRAMED);
    window.click_at(window.title(&id("clouds")));
    window.key(Key::C);
    let color = |window: &Window| {
        let frame = window.document().graph().frames().values().next().cloned();
        frame.and_then(|frame| frame.color).expect("a color")
    };
    let mut seen = vec![color(&window)];
    for _ in 0..2 {
        window.click_with(strip(&window), PointerButton::Secondary, Modifiers::NONE);
        window.press("Next color");
        seen.push(color(&window));
    }
    assert!(seen[0] != seen[1] && seen[1] != seen[2], "{seen:?}");
    window.undo(1);
    assert_eq!(color(&window), seen[1]);
}

#[test]
fn nodes_that_move_together_keep_their_places_beside_each_other() {
    let mut window = Window::opened(THREE);
    let zoom = window.zoom();
    window.click_at(window.title(&id("clouds")));
    window.click_with(window.title(&id("dots")), PointerButton::Primary, Modifiers::SHIFT);
    let handle = window.title(&id("clouds"));
    window.drag_from(handle, beside(handle, [52.0 * zoom, 0.0]));
    assert_eq!(
        [pos(&window, "clouds"), pos(&window, "dots")],
        [[50.0, 0.0], [53.0, 347.0]]
    );
}
