//! Views of the graph (zoom, pan, scrolling at edges, the mini map), and of results.

mod around;
mod eyedropper;
mod flat;
mod kept_state;
mod lists;
mod models_side_by_side;
mod saved_views;
mod shown_results;
mod wipe;

use egui::{Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::{beside, id};

const TWO: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [300, 100] }
"#;

#[test]
fn the_wheel_zooms_around_the_pointer_from_10_to_300_percent() {
    let mut window = Window::opened(TWO);
    let at = window.on_canvas([0.3, 0.6]);
    let held = window.editor().views.canvas.camera.place_at(at).expect("a place");
    for points in [150.0, -400.0, 90.0] {
        let before = window.zoom();
        window.wheel(at, points);
        assert_eq!(window.zoom() > before, points > 0.0, "away from oneself is nearer");
        let there = window.screen(held);
        assert!((there - at).length() < 0.5, "{there:?} {at:?}");
    }
    window.wheel(at, -5000.0);
    assert!((window.zoom() - 0.1).abs() < 1e-3, "{}", window.zoom());
    window.wheel(at, 5000.0);
    assert!((window.zoom() - 3.0).abs() < 1e-2, "{}", window.zoom());
}

#[test]
fn the_middle_button_moves_the_canvas_and_no_node() {
    let mut window = Window::opened(TWO);
    let before = window.title(&id("clouds"));
    let ends = [before, beside(before, [70.0, 40.0])];
    window.drag_along(&ends, PointerButton::Middle, Modifiers::NONE);
    assert!((window.title(&id("clouds")) - (before + vec2(70.0, 40.0))).length() < 0.5);
    assert_eq!(window.steps(), 0);
}

#[test]
fn dragging_to_the_edge_scrolls_the_canvas() {
    let mut window = Window::opened(TWO);
    let still = window.screen([0.0, 0.0]);
    let handle = window.title(&id("dots"));
    let edge = window.on_canvas([0.995, 0.5]);
    window.pull(&[handle, edge], PointerButton::Primary, Modifiers::NONE);
    window.harness.run_steps(30);
    window.button(edge, PointerButton::Primary, false);
    window.settle();
    let moved = window.screen([0.0, 0.0]) - still;
    assert!(moved.x < -100.0, "the canvas went by: {moved:?}");
    let end = window.title(&id("dots"));
    assert!(
        (end.x - edge.x).abs() < 12.0,
        "the node stays under the pointer: {end:?} {edge:?}"
    );
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_click_on_the_mini_map_goes_there() {
    let mut window = Window::opened(TWO);
    window.point(window.on_canvas([0.9, 0.5]));
    window.key(egui::Key::N);
    let map = window.harness.get_by_label("Mini map").rect();
    let before = window.screen([0.0, 0.0]);
    window.click_at(map.left_top() + vec2(6.0, 6.0));
    let after = window.screen([0.0, 0.0]);
    assert!(
        (after - before).x > 20.0 && (after - before).y > 20.0,
        "{before:?} {after:?}"
    );
    window.point(window.on_canvas([0.5, 0.5]));
    window.key(egui::Key::N);
    assert!(window.harness.query_by_label("Mini map").is_none());
}

#[test]
fn nodes_have_accessible_names_at_every_zoom() {
    let mut window = Window::opened(TWO);
    let at = window.rect(&id("clouds")).left_top();
    for points in [0.0, -300.0, -600.0] {
        window.wheel(at, points);
        let near = window.rect(&id("dots")).expand(2.0);
        let mut named = window.harness.query_all_by_label("Dots").map(|node| node.rect());
        let all: Vec<_> = named.by_ref().collect();
        assert!(
            all.iter()
                .any(|rect| near.contains_rect(*rect) && rect.width() > 0.8 * near.width()),
            "{} {near:?} {all:?}",
            window.zoom()
        );
    }
}

#[test]
fn the_wheel_scrolls_the_canvas_sideways_with_shift() {
    let mut window = Window::opened(TWO);
    let at = window.on_canvas([0.3, 0.6]);
    let (zoom, still) = (window.zoom(), window.screen([0.0, 0.0]));
    window.point(at);
    window.hold(Modifiers::SHIFT);
    window.harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 80.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::SHIFT,
    });
    window.harness.run_steps(30);
    window.hold(Modifiers::NONE);
    let moved = window.screen([0.0, 0.0]) - still;
    assert!((moved.length() - 80.0).abs() < 2.0, "{moved:?}");
    assert_eq!(window.zoom(), zoom);
}
