//! Groups: made, entered, left, put into the library and added from it.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT, Queryable};

use super::Window;
use super::hands::{beside, id};
use sabi_editing::navigation;

use crate::dock::Panel;

const WORN: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "layer": { "kind": "effect/layer", "inputs": { "mask": "mix" }, "pos": [520, 60] },
    "mix": { "kind": "blend/mask", "inputs": { "below": "clouds" }, "pos": [260, 60] }
"#;

/// A window with the nodes clouds and mix in a group.
fn grouped() -> Window {
    let mut window = Window::opened(WORN);
    window.click_at(window.title(&id("clouds")));
    window.click_with(window.title(&id("mix")), PointerButton::Primary, Modifiers::SHIFT);
    window.keys(Modifiers::COMMAND, Key::G);
    window
}

#[test]
fn a_group_is_made_entered_by_a_double_click_and_left_by_escape() {
    let mut window = grouped();
    let group = window.document().selected_one().expect("an instance").clone();
    assert!(window.reads(&id("layer"), "mask").starts_with(group.as_str()));
    assert_eq!((window.document().graph().len(), window.steps()), (2, 1));
    window.double_click(window.title(&group));
    assert_eq!(window.document().graph().len(), 2, "what is inside is seen");
    assert!(window.document().node(&id("clouds")).is_some());
    assert!(
        window
            .harness
            .query_all_by_role(Role::Link)
            .any(|link| link.accesskit_node().label().as_deref() == Some("Graph")),
        "the way out is shown"
    );
    window.key(Key::Escape);
    assert!(window.document().node(&id("layer")).is_some());
    window.double_click(window.title(&id("layer")));
    assert_eq!(
        navigation::breadcrumb(window.document()).len(),
        0,
        "only groups are entered"
    );
}

#[test]
fn groups_in_groups_are_left_step_by_step_or_at_once_by_the_path() {
    let mut window = grouped();
    let outer = window.document().selected_one().expect("an instance").clone();
    window.double_click(window.title(&outer));
    window.click_at(window.title(&id("clouds")));
    window.keys(Modifiers::COMMAND, Key::G);
    let inner = window.document().selected_one().expect("an instance").clone();
    window.double_click(window.title(&inner));
    assert_eq!(navigation::breadcrumb(window.document()).len(), 2);
    window.key(Key::Escape);
    assert_eq!(navigation::breadcrumb(window.document()).len(), 1);
    window.double_click(window.title(&inner));
    let way_out = window
        .harness
        .get_by_role_and_label(Role::Link, "Graph")
        .rect()
        .center();
    window.click_at(way_out);
    assert_eq!(navigation::breadcrumb(window.document()).len(), 0);
    // Undo takes back steps inside of the group, whatever graph is shown.
    window.undo(2);
    assert_eq!(window.document().contents().groups.len(), 0);
    assert_eq!(window.document().graph().len(), 3);
}

#[test]
fn the_canvas_returns_to_the_place_that_each_graph_was_left_at() {
    let mut window = grouped();
    let group = window.document().selected_one().expect("an instance").clone();
    window.wheel(window.title(&group), -120.0);
    let before = window.title(&group);
    window.double_click(before);
    assert!(
        window.on_canvas([0.5, 0.5]).distance(window.rect(&id("mix")).center()) < 500.0,
        "what is inside is framed"
    );
    window.key(Key::Escape);
    assert!((window.title(&group) - before).length() < 0.5);
}

#[test]
fn a_group_that_was_saved_to_the_library_is_added_by_search_and_by_drag() {
    let mut window = grouped();
    window.key(Key::F2);
    window.keys(Modifiers::COMMAND, Key::A);
    window.typed("Worn");
    window.key(Key::Enter);
    window.press("Save group");
    window.press("To the user library");
    assert!(window.says("is in the library now"));
    let files: Vec<_> = std::fs::read_dir(window.path("library"))
        .expect("a library")
        .flatten()
        .collect();
    assert_eq!(files.len(), 1);
    // Another graph without groups.
    window.keys(Modifiers::COMMAND, Key::S);
    window.keys(Modifiers::COMMAND, Key::N);
    assert_eq!(window.document().contents().groups.len(), 0);
    let kept = window.add([0.3, 0.3], "worn");
    let brought = window.document().node(&kept).expect("a node").group.clone();
    assert!(brought.is_some_and(|name| window.document().contents().groups.contains_key(&name)));
    window.undo(1);
    assert_eq!(
        (
            window.document().graph().len(),
            window.document().contents().groups.len()
        ),
        (2, 0),
        "one step"
    );
    // By a drag from the panel to the canvas.
    window.open(Panel::Library);
    let field = window.harness.get_by_label("Search the library").rect().center();
    window.click_at(field);
    window.typed("worn");
    let library = window.editor().shell.dock.rects[&Panel::Library];
    let entry = window
        .harness
        .query_all_by_label("Worn")
        .map(|node| node.rect().center())
        .find(|at| library.contains(*at))
        .expect("the group in the list, under the name that it was given");
    let at = window.on_canvas([0.5, 0.4]);
    let there = window.editor().views.canvas.camera.place_at(at).expect("a place");
    window.drag_from(entry, at);
    let added = window.document().selected_one().expect("an instance").clone();
    let pos = window.document().node(&added).expect("a node").pos;
    assert!(
        (pos[0] - there[0]).abs() <= 1.0 && (pos[1] - there[1]).abs() <= 1.0,
        "{pos:?} {there:?}"
    );
    window.drag_from(entry, beside(library.right_top(), [-3.0, -3.0]));
    assert_eq!(
        window.document().graph().len(),
        3,
        "two of the new graph, and one that was dropped: dropped elsewhere it is nowhere"
    );
    window.undo(1);
    replaces_by_a_group_of_the_library(&mut window);
}

fn replaces_by_a_group_of_the_library(window: &mut Window) {
    let levels = window.add([0.3, 0.3], "levels");
    let kind = &window.document().node(&levels).expect("a node").kind;
    assert_eq!(kind, "adjust/levels", "keys after a drag are not for the search field");
    let steps = window.steps();
    window.click_with(window.title(&levels), PointerButton::Secondary, Modifiers::NONE);
    window.press("Replace with…");
    window.typed("worn");
    window.key(Key::Enter);
    let placed = window.document().selected_one().expect("an instance").clone();
    assert!(
        window.document().node(&placed).expect("a node").group.is_some() && window.document().node(&levels).is_none()
    );
    assert_eq!(window.steps(), steps + 1);
}

#[test]
fn a_click_on_an_entry_of_the_library_adds_its_node() {
    let mut window = Window::empty();
    let field = window.harness.get_by_label("Search the library").rect().center();
    window.click_at(field);
    window.typed("clouds");
    let library = window.editor().shell.dock.rects[&Panel::Library];
    let found = window
        .harness
        .query_all_by_label("Clouds")
        .map(|node| node.rect().center());
    let entry = found.into_iter().find(|at| library.contains(*at)).expect("an entry");
    window.click_at(entry);
    assert_eq!(
        window.document().graph().len(),
        1,
        "a click adds it in the middle of what is seen"
    );
}

#[test]
fn escape_that_ends_a_text_a_menu_or_a_drag_does_not_leave_the_group() {
    let mut window = grouped();
    let group = window.document().selected_one().expect("an instance").clone();
    window.double_click(window.title(&group));
    let inside = navigation::breadcrumb(window.document()).len();
    let nodes = window.document().graph().len();
    // A text in a panel, with the pointer over the canvas.
    window.open(Panel::Library);
    let field = window.harness.get_by_label("Search the library").rect().center();
    window.click_at(field);
    window.typed("clouds");
    window.point(window.on_canvas([0.9, 0.9]));
    window.key(Key::Escape);
    assert_eq!(
        navigation::breadcrumb(window.document()).len(),
        inside,
        "it ended the text"
    );
    // A menu.
    window.click_with(window.title(&id("clouds")), PointerButton::Secondary, Modifiers::NONE);
    assert!(egui::Popup::is_any_open(&window.harness.ctx));
    window.key(Key::Escape);
    assert_eq!(
        navigation::breadcrumb(window.document()).len(),
        inside,
        "it closed the menu"
    );
    // An entry of the library that is being dragged.
    let library = window.editor().shell.dock.rects[&Panel::Library];
    let entries = window.harness.query_all_by_label("Clouds");
    let entry = entries
        .map(|node| node.rect().center())
        .find(|at| library.contains(*at));
    let to = window.on_canvas([0.5, 0.5]);
    window.pull(&[entry.expect("an entry"), to], PointerButton::Primary, Modifiers::NONE);
    window.key(Key::Escape);
    window.button(to, PointerButton::Primary, false);
    window.settle();
    assert_eq!(
        (
            navigation::breadcrumb(window.document()).len(),
            window.document().graph().len()
        ),
        (inside, nodes)
    );
    window.key(Key::Escape);
    assert_eq!(navigation::breadcrumb(window.document()).len(), inside - 1);
}
