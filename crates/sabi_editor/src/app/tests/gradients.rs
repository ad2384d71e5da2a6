//! Gradients from presets and pictures, in the window.

use std::fs;

use egui::Key;

use super::Window;
use super::hands::id;
use crate::gradient_picker::MOST_STOPS;

const COLORS: &str = r#""colors": { "kind": "color/gradient", "pos": [0, 0] }"#;

/// A bitmap of 24 bits, 64 pixels wide and 8 high: black on the left half, and the given color on the right.
fn halves([red, green, blue]: [u8; 3]) -> Vec<u8> {
    let [width, height] = [64_u32, 8];
    let size = 3 * width * height;
    let mut bytes = b"BM".to_vec();
    for number in [54 + size, 0, 54, 40, width, height, 24 << 16 | 1, 0, size, 0, 0, 0, 0] {
        bytes.extend(number.to_le_bytes());
    }
    for at in 0..width * height {
        let is_right = at % width >= width / 2;
        bytes.extend(if is_right { [blue, green, red] } else { [0; 3] });
    }
    bytes
}

/// Opens the question for a picture at the gradient's parameter, and answers it.
fn ask(window: &mut Window, file: &std::path::Path) {
    window.click_at(window.title(&id("colors")));
    window.press("Stops: presets and pictures");
    window.press("Pick from a picture…");
    window.answer_path(file);
}

#[test]
fn a_gradient_is_picked_from_a_picture_in_one_step() {
    let mut window = Window::opened(COLORS);
    let before = window.text();
    let file = window.path("halves.bmp");
    fs::write(&file, halves([200, 100, 50])).expect("a picture");
    ask(&mut window, &file);
    window.until("the picture", |editor| editor.views.gradient_picker.has_picture());
    assert!(
        window.says("4 stops"),
        "an edge has a stop on either side: {:?}",
        window.labels()
    );
    window.press("Use it");
    let picked = window.param(&id("colors"), "stops").expect("stops");
    assert!(picked.contains("#000000") && picked.contains("#c86432"), "{picked}");
    assert_eq!(window.steps(), 1);
    window.undo(1);
    assert_eq!(window.text(), before);
}

#[test]
fn a_line_is_drawn_over_the_picture_from_left_to_right_or_back() {
    let mut window = Window::opened(COLORS);
    let file = window.path("halves.bmp");
    fs::write(&file, halves([200, 100, 50])).expect("a picture");
    ask(&mut window, &file);
    window.until("the picture", |editor| editor.views.gradient_picker.has_picture());
    let picture = window.area("Picture to pick from");
    let at = |x: f32| picture.lerp_inside(egui::Vec2::new(x, 0.25));
    window.drag_from(at(0.45), at(0.05));
    assert!(window.says("1 stop"), "all black: {:?}", window.labels());
    window.drag_from(at(0.95), at(0.55));
    window.press("Use it");
    let picked = window.param(&id("colors"), "stops").expect("stops");
    assert!(picked.contains("#c86432") && !picked.contains("#000000"), "{picked}");
}

#[test]
fn a_file_that_is_no_picture_is_reported_and_changes_nothing() {
    let mut window = Window::opened(COLORS);
    let before = window.text();
    let file = window.path("broken.png");
    fs::write(&file, "no picture").expect("a file");
    ask(&mut window, &file);
    window.until("the fault", |editor| editor.views.gradient_picker.has_fault());
    assert!(window.says("The picture cannot be used"), "{:?}", window.labels());
    window.key(Key::Escape);
    assert!(!window.says("The picture cannot be used"));
    assert_eq!(window.text(), before);
}

#[test]
fn the_picker_knows_how_many_stops_a_gradient_has_room_for() {
    let window = Window::opened(COLORS);
    let interface = window.document().interface(&id("colors")).expect("a kind");
    let knob = interface.knob("stops").expect("stops");
    assert_eq!(knob.ty.components(), MOST_STOPS);
}
