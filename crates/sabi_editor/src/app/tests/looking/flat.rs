//! The 2D view: channels, exact values, pan and zoom.

use egui::{Pos2, Rect, vec2};
use egui_kittest::kittest::Queryable;

use super::super::Window;
use super::super::hands::id;

const COLOR: &str = r##"
    "paint": { "kind": "color/constant", "label": "Paint", "params": { "color": "#336699" }, "pos": [0, 0] }
"##;

/// A window that shows the texture of a color.
fn painted() -> Window {
    let mut window = Window::opened(COLOR);
    window.click_at(window.title(&id("paint")));
    window.until("the texture", |editor| editor.stage.inspected.is_some());
    window
}

impl Window {
    /// Where the texture is.
    pub(super) fn texture(&self) -> Rect {
        self.harness.get_by_label_contains("Texture of").rect()
    }

    /// What is said of the texel under a place.
    fn probed(&mut self, at: Pos2) -> String {
        self.point(at);
        self.settle();
        let told = self.labels();
        let mut told = told
            .into_iter()
            .filter(|label| label.contains(", ") && label.contains("   "));
        told.next().unwrap_or_default()
    }
}

#[test]
fn the_exact_values_of_the_texel_under_the_pointer_are_told() {
    let mut window = painted();
    let at = window.texture().center() + vec2(1.0, 1.0);
    let told = window.probed(at);
    let (place, values) = told.split_once("   ").expect("a place and values");
    assert_eq!(place, "32, 32");
    let values: Vec<f32> = values
        .split("  ")
        .map_while(|number| number.trim().parse().ok())
        .collect();
    let linear = |code: u8| egui::ecolor::linear_f32_from_gamma_u8(code);
    for (value, code) in values.iter().zip([0x33, 0x66, 0x99]) {
        assert!((value - linear(code)).abs() < 1e-3, "{told}");
    }
    assert_eq!(values.len(), 3, "{told}");
}

#[test]
fn each_number_of_a_color_can_be_looked_at_alone() {
    let mut window = painted();
    for name in ["R", "G", "B", "RGB"] {
        window.press(name);
        assert!(window.is_on(name), "{name}");
    }
}

#[test]
fn the_wheel_zooms_into_the_texel_under_the_pointer_and_a_drag_moves_the_texture() {
    let mut window = painted();
    let at = window.texture().center() + vec2(31.0, -17.0);
    let place = |told: String| told.split("   ").next().unwrap_or_default().to_owned();
    let before = place(window.probed(at));
    window.wheel(at, 300.0);
    assert!(window.editor().flat_view.zoom.is_some_and(|zoom| zoom > 4.0));
    assert_eq!(place(window.probed(at)), before, "it stays under the pointer");
    let end = at + vec2(40.0, 25.0);
    window.drag_from(at, end);
    assert_eq!(place(window.probed(end)), before, "it goes with the pointer");
}

#[test]
fn the_edges_of_the_model_are_drawn_over_the_texture() {
    let mut window = painted();
    let lines = |window: &Window| {
        let shapes = &window.harness.output().shapes;
        let is_line = |clipped: &&egui::epaint::ClippedShape| matches!(clipped.shape, egui::Shape::LineSegment { .. });
        shapes.iter().filter(is_line).count()
    };
    let without = lines(&window);
    window.press("UV");
    // Twelve edges and a diagonal on each side, some of them twice, since charts end there.
    let came = (0..2000).any(|_| {
        window.harness.step();
        std::thread::sleep(std::time::Duration::from_millis(5));
        lines(&window) >= without + 18
    });
    assert!(came);
}
