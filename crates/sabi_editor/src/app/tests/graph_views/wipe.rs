//! Drags of the line between two pictures of the model.

use egui::{CursorIcon, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable;

use super::super::Window;
use super::super::hands::{beside, id};
use super::shown_results::NODES;
use crate::dock::Panel;

impl Window {
    /// A place on the picture of the model, `[0, 0]` being its upper left corner.
    pub(super) fn at_model(&self, share: [f32; 2]) -> Pos2 {
        let rect = self.editor().shell.dock.rects[&Panel::Viewport];
        rect.min + vec2(share[0] * rect.width(), share[1] * rect.height())
    }

    /// The line between two pictures.
    fn line(&self) -> Pos2 {
        let share = self.editor().views.model.comparison.share.expect("a line");
        let rect = self.editor().shell.dock.rects[&Panel::Viewport];
        pos2(rect.left() + share * rect.width(), rect.center().y)
    }
}

/// A window that compares two nodes.
fn compared() -> Window {
    let mut window = Window::opened(NODES);
    window.until_model();
    window.click_at(window.title(&id("cells")));
    window.key(Key::P);
    window.click_at(window.title(&id("dots")));
    window.point(window.at_model([0.3, 0.9]));
    window.key(Key::C);
    window
}

#[test]
fn a_fast_drag_of_the_line_moves_it_and_turns_nothing() {
    let mut window = compared();
    let camera = window.editor().views.model.navigation.camera;
    let line = window.line();
    let end = beside(line, [-150.0, 30.0]);
    window.drag_from(line, end);
    assert!((window.line().x - end.x).abs() < 1.0, "{:?} {end:?}", window.line());
    assert_eq!(window.editor().views.model.navigation.camera, camera);
}

#[test]
fn a_drag_that_crosses_the_line_turns_the_model_and_leaves_the_line() {
    let mut window = compared();
    let camera = window.editor().views.model.navigation.camera;
    let line = window.line();
    let way = [
        beside(line, [-60.0, 0.0]),
        beside(line, [-2.0, 0.0]),
        beside(line, [70.0, 0.0]),
    ];
    window.drag_along(&way, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.line(), line);
    assert_ne!(
        window.editor().views.model.navigation.camera.yaw_degrees,
        camera.yaw_degrees
    );
}

#[test]
fn the_cursor_shows_that_a_drag_would_move_the_line() {
    let mut window = compared();
    let cursor = |window: &Window| window.harness.output().platform_output.cursor_icon;
    window.point(beside(window.line(), [5.0, 0.0]));
    window.harness.step();
    assert_eq!(cursor(&window), CursorIcon::ResizeHorizontal);
    window.point(beside(window.line(), [30.0, 0.0]));
    window.harness.step();
    assert_eq!(cursor(&window), CursorIcon::Default);
}

#[test]
fn the_key_f_focuses_the_point_under_the_pointer() {
    let mut window = Window::opened(NODES);
    window.until_model();
    let before = window.editor().views.model.navigation.camera;
    window.point(window.at_model([0.02, 0.98]));
    window.key(Key::F);
    assert_eq!(
        window.editor().views.model.navigation.camera,
        before,
        "there is nothing beside the model"
    );
    window.point(window.at_model([0.55, 0.55]));
    window.key(Key::F);
    let camera = window.editor().views.model.navigation.camera;
    assert!(camera.target.length() > 0.1, "a place of the surface: {camera:?}");
}

#[test]
fn each_compared_subject_is_named_on_its_side_of_the_line() {
    let mut window = compared();
    let editor = window.harness.state_mut();
    for node in ["cells", "dots"] {
        let name = "A name that is far too long for half of a view that is as narrow as this one is here".to_owned();
        sabi_editing::nodes::rename(&mut editor.documents.document, &id(node), &name);
    }
    let view = window.editor().shell.dock.rects[&Panel::Viewport];
    for share in [0.03, 0.3, 0.6, 0.97] {
        window.harness.state_mut().views.model.comparison.share = Some(share);
        window.settle();
        let line = window.line().x;
        let place = |start: &str| {
            let mut named = window
                .harness
                .query_all_by_label_contains(start)
                .map(|node| node.rect());
            named.find(|rect| view.contains(rect.center()))
        };
        let [one, other] = ["A  ", "B  "].map(place);
        if let Some(one) = one {
            assert!(view.left() <= one.left() && one.right() <= line, "{share}: {one}");
        }
        if let Some(other) = other {
            assert!(
                line <= other.left() && other.right() <= view.right(),
                "{share}: {other}"
            );
        }
        assert!(one.is_some() || share < 0.3, "{share}");
        assert!(other.is_some() || share > 0.6, "{share}");
    }
}
