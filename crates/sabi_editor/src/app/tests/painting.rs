//! Painting on the model, by hand.

use std::sync::Arc;

use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use sabi_editing::painting::{strokes_of, strokes_on};
use sabi_paint::{Action as BrushAction, Area, StrokeList};

use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::id;
use crate::dock::Panel;

const GRAPH: &str = r#"{
  "format": "sabi", "version": 1, "preview": { "size": 64 },
  "nodes": {
    "base": { "kind": "source/material", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [0, 300] },
    "mask": { "kind": "source/paint", "pos": [0, 600] },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "dots" }, "pos": [300, 0] },
    "moss": { "kind": "effect/layer", "inputs": { "base": "rust", "mask": "mask" }, "pos": [600, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "moss" }, "pos": [900, 0] }
  }
}"#;

/// A window whose model is ready, with a node selected and the brush taken.
pub(super) fn painting_on(node: &str) -> Window {
    let mut window = Window::of(GRAPH);
    window.until("the model", |editor| {
        let picture = editor
            .evaluation
            .results
            .picture(&sabi_engine::live::ViewSubject::Outputs);
        picture.is_some() && !editor.evaluation.is_busy()
    });
    window.harness.state_mut().documents.document.select([id(node)]);
    window.settle();
    window.key(Key::B);
    window
}

impl Window {
    /// Ends of a line over the middle of the model, on the screen.
    pub(super) fn way(&self) -> [Pos2; 2] {
        let middle = self.editor().shell.dock.rects[&Panel::Viewport].center();
        [middle - vec2(30.0, 0.0), middle + vec2(30.0, 10.0)]
    }

    pub(super) fn paint(&mut self, modifiers: Modifiers) {
        let way = self.way();
        self.drag_along(&way, PointerButton::Primary, modifiers);
    }

    /// Strokes of a node on the model, the lowest first; `None` where nothing is painted.
    pub(super) fn list(&self, node: &str) -> Option<Arc<StrokeList>> {
        let model = self.editor().evaluation.model.received.as_ref().expect("a model");
        strokes_on(self.document(), &id(node), &model.linked.model.stem)
    }

    /// Actions of a node's strokes, the lowest first.
    fn strokes(&self, node: &str) -> Vec<BrushAction> {
        let list = self.list(node).unwrap_or_default(); // Nothing is painted yet.
        list.strokes.iter().map(|stroke| stroke.action).collect()
    }
}

#[test]
fn a_drag_paints_a_stroke_as_one_undo_step_and_stores_it_at_once() {
    let mut window = painting_on("mask");
    let camera = window.editor().views.model.navigation.camera;
    window.paint(Modifiers::NONE);
    window.paint(Modifiers::COMMAND);
    assert_eq!(window.strokes("mask"), [BrushAction::Paint, BrushAction::Erase]);
    assert_eq!(
        window.editor().views.model.navigation.camera,
        camera,
        "the drag was the brush's"
    );
    let folder = window.path("worn.paint");
    let files: Vec<_> = std::fs::read_dir(&folder).expect("strokes beside the graph").collect();
    assert_eq!(files.len(), 1);
    window.undo(1);
    assert_eq!(window.strokes("mask"), [BrushAction::Paint]);
    window.undo(1);
    assert!(window.strokes("mask").is_empty());
    window.redo(2);
    assert_eq!(window.strokes("mask").len(), 2);
}

#[test]
fn escape_cancels_a_stroke_while_it_is_drawn() {
    let mut window = painting_on("mask");
    let way = window.way();
    window.pull(&way, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.strokes("mask").len(), 1, "the graph follows the brush");
    window.key(Key::Escape);
    assert!(window.strokes("mask").is_empty());
    window.button(way[1], PointerButton::Primary, false);
    window.settle();
    assert!(window.strokes("mask").is_empty());
}

#[test]
fn alt_and_the_end_of_painting_give_drags_back_to_the_camera() {
    let mut window = painting_on("mask");
    let mut camera = window.editor().views.model.navigation.camera;
    window.paint(Modifiers::ALT);
    assert_ne!(window.editor().views.model.navigation.camera, camera);
    camera = window.editor().views.model.navigation.camera;
    window.key(Key::B);
    window.paint(Modifiers::NONE);
    assert_ne!(window.editor().views.model.navigation.camera, camera);
    assert!(window.strokes("mask").is_empty());
}

#[test]
fn a_selected_mask_gets_a_paint_node_behind_it() {
    let mut window = painting_on("dots");
    let paint = window.document().selected_one().expect("the paint node").clone();
    assert_eq!(strokes_of(window.document(), &paint).as_deref(), Some(""));
    assert_eq!(window.reads(&paint, "base"), "dots.mask");
    assert_eq!(window.reads(&id("rust"), "mask"), format!("{}.mask", paint.as_str()));
    window.paint(Modifiers::NONE);
    assert_eq!(window.strokes(paint.as_str()).len(), 1);
}

#[test]
fn keys_change_the_size_of_the_brush_and_the_panel_lists_its_strokes() {
    let mut window = painting_on("mask");
    window.paint(Modifiers::NONE);
    let middle = window.way()[0];
    window.point(middle);
    let size = window.editor().shell.settings.brush.size;
    window.key(Key::CloseBracket);
    assert!(window.editor().shell.settings.brush.size > size);
    window.key(Key::OpenBracket);
    assert!((window.editor().shell.settings.brush.size - size).abs() < 1e-6);
    window.key(Key::E);
    assert_eq!(window.editor().shell.settings.brush.action, BrushAction::Erase);
    window.paint(Modifiers::NONE);
    window.paint(Modifiers::COMMAND);
    let actions = [BrushAction::Paint, BrushAction::Erase, BrushAction::Paint];
    assert_eq!(
        window.strokes("mask"),
        actions,
        "Ctrl lays paint where the brush erases"
    );
    window.undo(2);
    window.key(Key::E);
    window.open(Panel::Parameters);
    window.click("Strokes 1");
    window.click("Hide the stroke");
    assert!(window.has("Show the stroke"));
    window.click("Stroke 1");
    window.click("Remove the strokes");
    assert!(window.strokes("mask").is_empty());
    window.undo(2);
    assert_eq!(window.strokes("mask").len(), 1);
}

#[test]
fn a_stroke_in_the_2d_view_lands_on_the_model_too() {
    let mut window = painting_on("mask");
    window.until_inspected("mask");
    let texture = window.harness.get_by_label_contains("Texture of").rect();
    let side = texture.width().min(texture.height());
    let middle = texture.center();
    let way = [
        middle - vec2(0.4 * side, 0.3 * side),
        middle + vec2(0.4 * side, 0.3 * side),
    ];
    window.drag_along(&way, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.strokes("mask"), [BrushAction::Paint]);
}

#[test]
fn shift_draws_a_straight_line_from_where_the_last_stroke_ended() {
    let mut window = painting_on("mask");
    let [from, to] = window.way();
    window.click_with(from, PointerButton::Primary, Modifiers::NONE);
    window.click_with(to, PointerButton::Primary, Modifiers::SHIFT);
    let list = window.list("mask").expect("strokes");
    let points: Vec<usize> = list.strokes.iter().map(|stroke| stroke.points.len()).collect();
    assert!(points[0] == 1 && points[1] > 10, "{points:?}");
    assert_eq!(list.strokes[1].points[0].site, list.strokes[0].points[0].site);
}

#[test]
fn a_click_within_one_frame_paints_a_stroke() {
    let mut window = painting_on("mask");
    let at = window.way()[0];
    window.point(at);
    for pressed in [true, false] {
        window.queue_button(at, PointerButton::Primary, pressed);
    }
    window.settle();
    assert_eq!(window.strokes("mask"), [BrushAction::Paint]);
    assert_eq!(window.steps(), 1);
}

#[test]
fn painting_goes_on_with_the_next_mask_that_is_selected() {
    let mut window = painting_on("mask");
    window.harness.state_mut().documents.document.select([id("dots")]);
    window.settle();
    window.key(Key::B);
    let paint = window.document().selected_one().expect("the paint node").clone();
    window.paint(Modifiers::NONE);
    assert_eq!(
        (window.strokes("mask").len(), window.strokes(paint.as_str()).len()),
        (0, 1)
    );
}

#[test]
fn the_pressure_of_a_pen_is_kept_with_the_places_of_a_stroke() {
    let mut window = painting_on("mask");
    let [from, to] = window.way();
    let touch = |pos: Pos2, force: f32| egui::Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(1),
        phase: egui::TouchPhase::Move,
        pos,
        force: Some(force),
    };
    window.point(from);
    window.harness.event(touch(from, 0.25));
    window.button(from, PointerButton::Primary, true);
    window.harness.event(touch(to, 0.75));
    window.point(to);
    window.button(to, PointerButton::Primary, false);
    window.settle();
    let list = window.list("mask").expect("strokes");
    let points = &list.strokes[0].points;
    let [first, last] = [points[0].pressure, points[points.len() - 1].pressure];
    assert!(
        (first - 0.25).abs() < 0.01 && (last - 0.75).abs() < 0.05,
        "{first} {last}"
    );
}

#[test]
fn a_decal_has_handles_that_move_and_turn_it_once_it_is_laid() {
    let mut window = painting_on("mask");
    window.harness.state_mut().shell.settings.brush.area = Area::Decal;
    let [from, to] = window.way();
    window.drag_along(&[from, to], PointerButton::Primary, Modifiers::NONE);
    let laid = window.list("mask").expect("strokes").strokes[0].clone();
    assert_eq!((laid.area, laid.points.len()), (Area::Decal, 1));
    let marked = &window.editor().looks.marked_strokes;
    assert_eq!(marked.iter().copied().collect::<Vec<_>>(), [laid.id]);
    // The handle of its right side lies where the drag ended.
    window.drag_along(&[to, to + vec2(0.0, -60.0)], PointerButton::Primary, Modifiers::NONE);
    let list = window.list("mask").expect("strokes");
    let turned = &list.strokes[0];
    assert_eq!(list.strokes.len(), 1, "nothing else was laid");
    assert!(
        turned.brush.angle_degrees > laid.brush.angle_degrees + 20.0,
        "{}",
        turned.brush.angle_degrees
    );
    assert_eq!(turned.points, laid.points);
    let before = turned.clone();
    window.drag_along(&[from, from + vec2(0.0, 20.0)], PointerButton::Primary, Modifiers::NONE);
    let moved = window.list("mask").expect("strokes").strokes[0].clone();
    assert_ne!(moved.points, before.points);
    assert_eq!((&moved.brush, moved.id), (&before.brush, laid.id));
    window.undo(2);
    assert_eq!(window.list("mask").expect("strokes").strokes[0].brush, laid.brush);
}
