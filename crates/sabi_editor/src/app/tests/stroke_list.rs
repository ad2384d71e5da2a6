//! The list of strokes: groups, paths from strokes, copies, and strokes that are moved on the model.

use egui::{Event, Modifiers, PointerButton, vec2};
use sabi_paint::{Area, strokes_as_text};

use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::id;
use super::painting::painting_on;
use crate::dock::Panel;

/// A window with two strokes on the node `mask`, and their list.
pub(super) fn listed() -> Window {
    let mut window = painting_on("mask");
    let [from, to] = window.way();
    for offset in [-14.0, 14.0] {
        let by = vec2(0.0, offset);
        window.drag(from + by, to + by, PointerButton::Primary, Modifiers::NONE);
    }
    window.open(Panel::Parameters);
    window.click("Strokes 2");
    window
}

impl Window {
    fn names(&self, node: &str) -> Vec<String> {
        let list = self.list(node).expect("strokes");
        let names = list.strokes.iter().map(|stroke| {
            let group = stroke.group.as_ref().map_or("", |group| &group.name);
            format!("{group}{}", if stroke.leaves_nothing() { " hidden" } else { "" })
        });
        names.collect()
    }
}

#[test]
fn marked_strokes_become_a_group_that_is_hidden_and_undone_as_a_whole() {
    let mut window = listed();
    window.click("Stroke 1");
    window.click("Group the strokes");
    assert_eq!(window.names("mask"), ["Group 1", ""]);
    window.click("Hide the group");
    assert_eq!(window.names("mask"), ["Group 1 hidden", ""]);
    window.undo(1);
    window.click("Close the group");
    assert!(!window.has("Stroke 1"), "its strokes are not listed");
    window.click("Open the group");
    window.click("Group 1  (1)");
    window.click("Take them out of their group");
    assert_eq!(window.names("mask"), ["", ""]);
}

#[test]
fn a_stroke_becomes_a_path_of_a_few_knots() {
    let mut window = listed();
    window.click("Stroke 1");
    window.click("Make paths of them, with knots to bend");
    let list = window.list("mask").expect("strokes");
    let knots = list.strokes[0].as_path().expect("a path").knots.len();
    assert!((2..8).contains(&knots), "{knots}");
    assert!(list.strokes[1].path.is_none());
}

#[test]
fn strokes_are_given_to_another_node_through_the_clipboard() {
    let mut window = listed();
    let strokes = window.list("mask").expect("strokes").strokes.clone();
    let text = strokes_as_text(&strokes);
    window.harness.state_mut().documents.document.select([id("dots")]);
    window.settle();
    window.harness.event(Event::Paste(text.clone()));
    window.settle();
    assert_eq!(
        window.list("mask").expect("strokes").strokes.len(),
        2,
        "no paint node was selected"
    );
    window.key(egui::Key::B);
    let paint = window.document().selected_one().expect("the paint node").clone();
    window.harness.event(Event::Paste(text));
    window.settle();
    let pasted = window.list(paint.as_str()).expect("strokes");
    assert_eq!(pasted.strokes.len(), 2);
    assert_eq!(pasted.strokes[0].points, strokes[0].points);
    assert_eq!(window.editor().looks.marked_strokes.len(), 2);
    window.undo(1);
    assert!(window.list(paint.as_str()).is_none_or(|list| list.strokes.is_empty()));
}

#[test]
fn the_handles_of_marked_strokes_move_and_turn_them_on_the_model() {
    let mut window = listed();
    window.click("Stroke 1");
    let before = window.list("mask").expect("strokes").strokes[0].clone();
    let [from, to] = window.way();
    let middle = from.lerp(to, 0.5) + vec2(0.0, -14.0);
    let handle = middle + vec2(0.0, -34.0);
    window.drag(
        handle,
        handle + vec2(0.0, 10.0),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let list = window.list("mask").expect("strokes");
    assert_eq!(list.strokes.len(), 2, "nothing else was laid");
    let moved = list.strokes[0].clone();
    assert_eq!((moved.id, moved.area), (before.id, Area::Way));
    assert!(moved.points[0].site.position.y < before.points[0].site.position.y);
    let turn = middle + vec2(40.0, -24.0);
    window.drag(turn, turn + vec2(-30.0, -20.0), PointerButton::Primary, Modifiers::NONE);
    let turned = window.list("mask").expect("strokes").strokes[0].clone();
    let rise = |stroke: &sabi_paint::Stroke| {
        let [first, last] = [stroke.points.first(), stroke.points.last()];
        last.expect("a place").site.position.y - first.expect("a place").site.position.y
    };
    assert!(
        rise(&turned) > rise(&moved) + 0.01,
        "{} {}",
        rise(&turned),
        rise(&moved)
    );
    window.undo(2);
    assert_eq!(window.list("mask").expect("strokes").strokes[0].points, before.points);
}

#[test]
fn a_stroke_joins_the_group_that_it_is_marked_with() {
    let mut window = listed();
    window.click("Stroke 1");
    window.click("Group the strokes");
    window.click("Group 1  (1)");
    let place = window.harness.get_by_label("Stroke 2").rect().center();
    window.click_with(place, PointerButton::Primary, Modifiers::COMMAND);
    window.click("Group the strokes");
    assert_eq!(window.names("mask"), ["Group 1", "Group 1"]);
}
