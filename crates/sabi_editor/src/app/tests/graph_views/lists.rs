//! Panels of times and of steps.

use egui_kittest::kittest::Queryable;

use super::super::Window;
use super::super::hands::{beside, id};
use super::shown_results::NODES;
use sabi_editing::nodes;

use crate::dock::Panel;

#[test]
fn times_are_listed_by_title_and_lead_to_their_node_until_it_is_deleted() {
    let mut window = Window::opened(NODES);
    window.until("times of both", |editor| {
        ["cells", "dots"]
            .iter()
            .all(|node| editor.evaluation.results.time(node).is_some())
    });
    window.open(Panel::Timing);
    let panel = window.editor().shell.dock.rects[&Panel::Timing];
    let row = |window: &Window, title: &str| {
        let found = window
            .harness
            .query_all_by_label(title)
            .map(|node| node.rect().center());
        found.into_iter().find(|at| panel.contains(*at))
    };
    let at = row(&window, "Spots").expect("a row");
    let times = window.harness.query_all_by_label_contains(" ms");
    let times: Vec<_> = times.map(|time| time.rect().center()).collect();
    let is_beside = |time: &egui::Pos2| (time.y - at.y).abs() < 8.0 && time.x > at.x;
    assert!(times.iter().any(is_beside), "its time");
    window.click_at(at);
    assert_eq!(window.document().selected_one(), Some(&id("dots")));
    nodes::delete(&mut window.harness.state_mut().documents.document, false);
    window.settle();
    assert!(row(&window, "Spots").is_none() && row(&window, "Tiles").is_some());
}

#[test]
fn a_click_in_the_history_goes_to_that_step() {
    let mut window = Window::opened(NODES);
    let before = window.text();
    for way in [[40.0, 0.0], [0.0, 60.0]] {
        let at = window.title(&id("dots"));
        window.drag_from(at, beside(at, way));
    }
    let after = window.text();
    window.open(Panel::History);
    window.press("Start");
    assert_eq!(window.text(), before);
    window.press("Move");
    assert_eq!(window.text(), after, "the last of two that are called so");
}
