//! The 2D view: channels, exact values, pan and zoom.

use egui::{Pos2, Rect, vec2};
use egui_kittest::kittest::Queryable;

use super::super::Window;
use super::super::hands::id;
use crate::theme::space;

const COLOR: &str = r##"
    "paint": { "kind": "color/constant", "label": "Paint", "params": { "color": "#336699" }, "pos": [0, 0] }
"##;

/// A window that shows the texture of a color.
fn painted() -> Window {
    let mut window = Window::opened(COLOR);
    window.click_at(window.title(&id("paint")));
    window.until("the texture", |editor| {
        let inspected = editor.evaluation.results.inspected.as_ref();
        inspected.is_some_and(|(_, values)| editor.views.flat.shows(values))
    });
    window
}

impl Window {
    /// Rectangle of the texture.
    pub(super) fn texture(&self) -> Rect {
        self.harness.get_by_label_contains("Texture of").rect()
    }

    /// The ends of UV wires that are drawn as lines, as shares of the texture while all of it is shown.
    fn uv_wires(&self) -> Vec<[[f32; 2]; 2]> {
        let panel = self.texture();
        let side = panel.width().min(panel.height()) - 2.0 * space::USUAL;
        let square = Rect::from_center_size(panel.center(), vec2(side, side));
        let color = self.editor().shell.theme.accent.gamma_multiply(0.5);
        let share = |at: Pos2| ((at - square.min) / side).into();
        let shapes = self.harness.output().shapes.iter();
        let lines = shapes.filter_map(|clipped| match &clipped.shape {
            egui::Shape::LineSegment { points, stroke } if stroke.color == color => Some(points.map(share)),
            _ => None,
        });
        lines.collect()
    }

    /// Text about the texel under a place.
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
fn the_exact_values_of_the_texel_under_the_pointer_are_shown() {
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
fn each_channel_of_a_color_can_be_shown_alone() {
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
    assert!(window.editor().views.flat.zoom.is_some_and(|zoom| zoom > 4.0));
    assert_eq!(place(window.probed(at)), before, "it stays under the pointer");
    let end = at + vec2(40.0, 25.0);
    window.drag_from(at, end);
    assert_eq!(place(window.probed(end)), before, "it goes with the pointer");
}

/// A square in the lower left half of its texture, and one of another material in the tile beside it.
const TWO_SETS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n\
    vt 0.1 0.1\nvt 0.5 0.1\nvt 0.5 0.5\nvt 0.1 0.5\nvt 1.2 0.2\nvt 1.9 0.2\nvt 1.9 0.9\nvt 1.2 0.9\n\
    usemtl wood\nf 1/1 2/2 3/3 4/4\nusemtl steel\nf 2/5 5/6 6/7 3/8\n";

#[test]
fn each_texture_set_of_the_model_is_seen_with_its_own_edges() {
    let mut window = painted();
    let file = window.path("two.obj");
    std::fs::write(&file, TWO_SETS).expect("a model");
    window.harness.state_mut().models().take(&file);
    window.press("UV");
    for (name, from, to) in [("wood", 0.1, 0.5), ("steel", 0.2, 0.9)] {
        if name == "steel" {
            window.click_at(window.harness.get_by_label("Texture set: wood").rect().center());
            window.press("steel");
        }
        window.until("the set", |editor| {
            let inspected = editor.evaluation.results.inspected.as_ref();
            inspected.is_some_and(|(_, values)| values.set.title() == name) && !editor.evaluation.is_busy()
        });
        let (_, values) = window.editor().evaluation.results.inspected.clone().expect("values");
        let texels = values.is_on_surface.iter().filter(|is_on| **is_on).count() as f32;
        let side = 64.0 * (to - from);
        assert!((texels - side * side).abs() < 4.0 * side, "{name}: {texels} texels");
        // Four sides and a diagonal; v is counted upward in such files.
        let is_its_own = |[u, v]: [f32; 2]| [u, 1.0 - v].iter().all(|at| (from - 0.01..to + 0.01).contains(at));
        let came = (0..2000).any(|_| {
            window.harness.step();
            std::thread::sleep(std::time::Duration::from_millis(5));
            let edges = window.uv_wires();
            edges.len() == 5 && edges.iter().flatten().all(|end| is_its_own(*end))
        });
        assert!(came, "{name}: {:?}", window.uv_wires());
    }
}

#[test]
fn the_edges_of_the_model_are_drawn_over_the_texture() {
    let mut window = painted();
    assert_eq!(window.uv_wires().len(), 0);
    window.press("UV");
    // Twelve edges and a diagonal on each side, some of them twice, since charts end there.
    let came = (0..2000).any(|_| {
        window.harness.step();
        std::thread::sleep(std::time::Duration::from_millis(5));
        window.uv_wires().len() >= 18
    });
    assert!(came);
}
