//! Drags in each preset, on the canvas and on the model.

use egui::{Modifiers, PointerButton, Pos2};

use super::Window;
use super::commands::window_with;
use super::hands::beside;
use crate::command::InputPreset;
use crate::dock::Panel;

const NONE: Modifiers = Modifiers::NONE;

/// Parts of the camera that a drag changes: direction, target and distance.
fn turned(window: &mut Window, button: PointerButton, modifiers: Modifiers) -> [bool; 3] {
    let seen = |window: &Window| {
        let camera = window.editor().views.model.navigation.camera;
        let [eye, target] = [camera.eye(), camera.target];
        ((eye - target).normalize(), target, camera.height_at_target())
    };
    let before = seen(window);
    let middle = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.drag(middle, beside(middle, [40.0, 25.0]), button, modifiers);
    let after = seen(window);
    [
        before.0.distance(after.0) > 1e-3,
        before.1.distance(after.1) > 1e-4,
        (before.2 - after.2).abs() > 1e-4,
    ]
}

const ORBITS: [bool; 3] = [true, false, false];
const PANS: [bool; 3] = [false, true, false];
const ZOOMS: [bool; 3] = [false, false, true];
const NOTHING: [bool; 3] = [false; 3];

fn looking_at_the_model(preset: InputPreset) -> Window {
    let mut window = window_with(preset);
    window.until("the model", |editor| editor.views.model.pictures.drawn > 0);
    window
}

#[test]
fn the_model_is_turned_as_in_blender() {
    use PointerButton::{Middle, Primary};
    let mut window = looking_at_the_model(InputPreset::Blender);
    assert_eq!(turned(&mut window, Middle, NONE), ORBITS);
    assert_eq!(turned(&mut window, Middle, Modifiers::SHIFT), PANS);
    assert_eq!(turned(&mut window, Middle, Modifiers::COMMAND), ZOOMS);
    assert_eq!(turned(&mut window, Primary, NONE), NOTHING);
}

#[test]
fn the_model_is_turned_as_in_substance() {
    use PointerButton::{Middle, Primary, Secondary};
    let mut window = looking_at_the_model(InputPreset::Substance);
    assert_eq!(turned(&mut window, Primary, Modifiers::ALT), ORBITS);
    assert_eq!(turned(&mut window, Middle, Modifiers::ALT), PANS);
    assert_eq!(turned(&mut window, Secondary, Modifiers::ALT), ZOOMS);
}

#[test]
fn the_model_is_turned_by_the_usual_drags() {
    use PointerButton::{Middle, Primary, Secondary};
    let mut window = looking_at_the_model(InputPreset::Default);
    assert_eq!(turned(&mut window, Primary, NONE), ORBITS);
    assert_eq!(turned(&mut window, Primary, Modifiers::SHIFT), PANS);
    assert_eq!(turned(&mut window, Middle, NONE), PANS);
    assert_eq!(turned(&mut window, Secondary, NONE), ZOOMS);
}

/// Movement of the canvas by a drag over an empty place, and whether it zooms in.
fn moved(window: &mut Window, button: PointerButton, modifiers: Modifiers) -> (egui::Vec2, bool) {
    let from = window.on_canvas([0.9, 0.9]);
    let held = window.editor().views.canvas.camera.place_at(from).expect("a place");
    let zoom = window.zoom();
    window.drag(from, beside(from, [-30.0, -50.0]), button, modifiers);
    let way: egui::Vec2 = window.screen(held) - from;
    (way, window.zoom() > zoom * 1.01)
}

#[test]
fn the_canvas_is_moved_and_zoomed_by_the_drags_of_each_preset() {
    use PointerButton::{Middle, Primary, Secondary};
    let by = egui::vec2(-30.0, -50.0);
    let is = |(way, is_nearer): (egui::Vec2, bool), expected: egui::Vec2, zooms: bool| {
        assert!(
            (way - expected).length() < 1.0 && is_nearer == zooms,
            "{way:?} {is_nearer}"
        );
    };
    let none = egui::Vec2::ZERO;
    let mut window = window_with(InputPreset::Default);
    is(moved(&mut window, Middle, NONE), by, false);
    is(
        moved(&mut window, Primary, Modifiers::COMMAND | Modifiers::SHIFT),
        by,
        false,
    );
    is(moved(&mut window, Secondary, Modifiers::ALT), none, true);
    assert!(!window.says("Find a node"), "no menu opens after it");
    let mut window = window_with(InputPreset::Blender);
    is(moved(&mut window, Middle, NONE), by, false);
    is(moved(&mut window, Middle, Modifiers::COMMAND), none, true);
    is(moved(&mut window, Primary, NONE), none, false);
    assert_eq!(window.steps(), 0);
}

#[test]
fn in_the_blender_preset_a_drag_selects_by_a_box_and_the_key_a_selects_all() {
    let mut window = window_with(InputPreset::Blender);
    let around: [Pos2; 2] = [window.on_canvas([0.01, 0.03]), window.on_canvas([0.99, 0.97])];
    window.drag_from(around[0], around[1]);
    let all = window.document().graph().len();
    assert_eq!(window.document().selection().len(), all);
    window.click_at(around[1]);
    assert_eq!(window.document().selection().len(), 0);
    window.chord("A");
    assert_eq!(window.document().selection().len(), all);
}

#[test]
fn the_list_of_keys_shows_the_drags_of_the_preset() {
    let mut window = window_with(InputPreset::Blender);
    window.key(egui::Key::F1);
    window.harness.state_mut().views.key_list.is_open = true;
    window.settle();
    assert!(window.has("Select in a box"));
    assert!(window.has("Left drag") && window.has("Ctrl+Middle drag"));
}
