//! Paths that are drawn knot by knot on the model, and along its edges.

use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use sabi_paint::{Area, Bend, Path, Stroke};

use egui_kittest::kittest::Queryable;

use super::Window;
use super::painting::painting_on;
use crate::settings::brush::Hand;

fn drawing(hand: Hand) -> Window {
    let mut window = painting_on("mask");
    window.harness.state_mut().shell.settings.brush.hand = hand;
    window
}

impl Window {
    fn only_stroke(&self) -> Stroke {
        let list = self.list("mask").expect("strokes");
        assert_eq!(list.strokes.len(), 1);
        (*list.strokes[0]).clone()
    }

    fn only_path(&self) -> Path {
        self.only_stroke().as_path().expect("a path")
    }

    /// Places around the middle of the model, far enough from each other for their knots.
    fn corners(&self) -> [Pos2; 3] {
        let [left, right] = self.way();
        let middle = left.lerp(right, 0.5);
        [
            middle - vec2(30.0, 10.0),
            middle + vec2(30.0, -10.0),
            middle + vec2(0.0, 25.0),
        ]
    }

    fn click_corners(&mut self) -> [Pos2; 3] {
        let corners = self.corners();
        for corner in corners {
            self.click_at(corner);
        }
        corners
    }
}

#[test]
fn each_click_adds_a_knot_as_a_step_until_enter_ends_the_path() {
    let mut window = drawing(Hand::Path);
    window.click_corners();
    assert_eq!(window.only_path().knots.len(), 3);
    assert_eq!(window.steps(), 3);
    window.undo(1);
    assert_eq!(window.only_path().knots.len(), 2);
    window.redo(1);
    window.key(Key::Enter);
    let [corner, ..] = window.corners();
    window.click_at(corner - vec2(0.0, 25.0));
    let list = window.list("mask").expect("strokes");
    let knots: Vec<usize> = list
        .strokes
        .iter()
        .map(|stroke| stroke.as_path().expect("a path").knots.len())
        .collect();
    assert_eq!(knots, [3, 1], "a click after the end begins another path");
}

#[test]
fn a_click_on_the_first_knot_closes_the_path_and_a_double_click_ends_it() {
    let mut window = drawing(Hand::Path);
    let [first, ..] = window.click_corners();
    window.click_at(first);
    assert!(window.only_path().is_closed);
    let mut window = drawing(Hand::Path);
    let [.., last] = window.click_corners();
    window.double_click(last);
    let path = window.only_path();
    assert_eq!((path.knots.len(), path.is_closed), (3, false));
    window.double_click(last);
    assert_eq!(
        window.only_path().knots[2].bend,
        Bend::Corner,
        "it is a corner once the path has ended"
    );
}

#[test]
fn a_drag_pulls_handles_out_of_a_new_knot_and_moves_one_that_is_there() {
    let mut window = drawing(Hand::Path);
    let [from, to, beside] = window.corners();
    window.click_at(from);
    window.drag(to, to + vec2(0.0, 18.0), PointerButton::Primary, Modifiers::NONE);
    window.key(Key::Enter);
    let Bend::Handles([before, behind]) = window.only_path().knots[1].bend else {
        panic!("no handles");
    };
    let knot = window.only_path().knots[1].place;
    let middle = 0.5 * (before.site.position + behind.site.position);
    let reach = before.site.position.distance(behind.site.position);
    assert!(middle.distance(knot.site.position) < 0.1 * reach, "they lie opposite");
    window.drag(from, beside, PointerButton::Primary, Modifiers::NONE);
    let moved = window.only_path();
    assert_eq!(moved.knots.len(), 2);
    assert_eq!(moved.knots[1].place, knot);
    window.click_with(beside, PointerButton::Primary, Modifiers::COMMAND);
    assert_eq!(window.only_path().knots.len(), 1, "Ctrl removes a knot");
}

#[test]
fn a_press_on_a_path_between_two_knots_inserts_a_knot() {
    let mut window = drawing(Hand::Path);
    let [from, to, beside] = window.corners();
    for knot in [from, to] {
        window.click_at(knot);
    }
    window.key(Key::Enter);
    window.drag(from.lerp(to, 0.5), beside, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.only_path().knots.len(), 3);
}

#[test]
fn a_click_near_an_edge_lays_a_path_along_it() {
    let mut window = drawing(Hand::HardEdges);
    window.harness.state_mut().shell.settings.brush.area = Area::Ribbon;
    let [left, _] = window.way();
    // The clicks reach one of the upright edges of the cube, which is in front of the middle.
    for step in 0..40 {
        window.click_at(left + vec2(5.0 * step as f32 - 70.0, 0.0));
        if window.list("mask").is_some_and(|list| !list.strokes.is_empty()) {
            break;
        }
    }
    let path = window.only_path();
    assert_eq!((path.knots.len(), window.only_stroke().area), (2, Area::Ribbon));
    let [a, b] = [0, 1].map(|end| path.knots[end].place.site.position);
    assert_eq!((a.x, a.z), (b.x, b.z), "it is upright");
    let told = window.labels();
    assert!(
        told.iter().any(|text| text.contains("no such edge near the pointer")),
        "{told:?}"
    );
}

#[test]
fn a_click_on_a_knot_makes_no_undo_step_and_leaves_the_path_unchanged() {
    let mut window = drawing(Hand::Path);
    let [first, ..] = window.click_corners();
    window.key(Key::Enter);
    let (path, steps) = (window.only_path(), window.steps());
    window.click_at(first);
    assert_eq!((window.only_path(), window.steps()), (path, steps));
}

#[test]
fn a_path_that_clones_asks_for_its_source_first() {
    let mut window = drawing(Hand::Path);
    window.harness.state_mut().shell.settings.brush.action = sabi_paint::Action::Clone;
    let [first, second, _] = window.corners();
    window.click_at(first);
    assert!(window.list("mask").is_none(), "nothing is drawn without a source");
    let told = window.labels();
    assert!(
        told.iter()
            .any(|text| text.contains("Click with Ctrl where to copy from")),
        "{told:?}"
    );
    window.click_with(second, PointerButton::Primary, Modifiers::COMMAND);
    assert!(window.list("mask").is_none(), "a click with Ctrl is the source");
    window.click_at(first);
    assert!(window.only_stroke().source.is_some());
}

#[test]
fn a_path_is_drawn_and_bent_in_the_2d_view_too() {
    let mut window = drawing(Hand::Path);
    window.until_inspected("mask");
    let texture = window.harness.get_by_label_contains("Texture of").rect();
    let side = texture.width().min(texture.height());
    let at = |x: f32, y: f32| texture.center() + side * vec2(x, y);
    // Tries several places of the 2D view, from the middle outward, since not every place is on a chart.
    let places: Vec<Pos2> = [[0.02, 0.02], [0.1, 0.1], [0.2, 0.1], [0.1, 0.2], [0.2, 0.2]]
        .map(|[x, y]: [f32; 2]| at(x, y))
        .to_vec();
    for place in &places {
        window.click_at(*place);
    }
    window.key(Key::Enter);
    let path = window.only_path();
    assert!(path.knots.len() >= 2, "{}", path.knots.len());
    let steps = window.steps();
    for place in &places {
        window.drag(*place, *place + vec2(6.0, 4.0), PointerButton::Primary, Modifiers::NONE);
        if window.steps() > steps {
            break;
        }
    }
    let moved = window.only_path();
    assert_eq!(moved.knots.len(), path.knots.len());
    assert_ne!(moved.knots, path.knots, "a knot was dragged");
}
