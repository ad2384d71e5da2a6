//! Parts of the window, compared with reviewed pictures in `crates/sabi_editor/tests/snapshots/`.
//!
//! `cargo xtask bless window` writes them again. Pixels may differ by the rounding of drivers, and a few at the edges of
//! letters by more.

use egui::{Key, Rect, vec2};
use egui_kittest::{SnapshotOptions, SnapshotResult, SnapshotResults, try_image_snapshot_options};
use sabi_editing::node_size::TITLE_HEIGHT;

use super::Window;
use super::hands::id;
use crate::dock::Panel;
use crate::theme::ColorScheme;

const NODES: &str = r##"
    "clouds": { "kind": "noise/simplex", "label": "Clouds", "pos": [0, 0] },
    "tones": { "kind": "color/gradient", "label": "Tones", "inputs": { "source": "clouds" }, "pos": [300, 0] },
    "bend": { "kind": "adjust/curve", "label": "Bend", "inputs": { "source": "clouds" }, "pos": [300, 300] },
    "rust": { "kind": "effect/layer", "label": "Rust", "inputs": { "mask": "bend" }, "pos": [600, 0] }
"##;

impl Window {
    /// A window of a shade that shows a node's parameters and its result, without the pointer.
    fn on(node: &str, shade: ColorScheme) -> Window {
        let mut window = Window::opened(NODES);
        let context = window.harness.ctx.clone();
        let editor = window.harness.state_mut();
        editor.shell.settings.shade = shade;
        editor.shell.apply_settings();
        editor.look_at(&id(node), None);
        editor.documents.document.select([id(node)]);
        context.all_styles_mut(|style| style.visuals.text_cursor.blink = false);
        window.harness.event(egui::Event::PointerGone);
        // Pictures are drawn again once the shade has arrived.
        window.until("the shade", |editor| editor.evaluation.has_shade());
        window.until("rest", |editor| {
            let has_picture = |id: &str| editor.thumbnail_of(&id.parse().expect("an id")).is_some();
            let is_drawn = has_picture(node) && editor.views.model.pictures.drawn > 0;
            is_drawn && editor.evaluation.results.inspected.is_some() && !editor.evaluation.is_busy()
        });
        window
    }

    /// Upper left part of a panel.
    fn part_of(&self, panel: Panel, largest: [f32; 2]) -> Rect {
        let panel = self.editor().shell.dock.rects[&panel];
        Rect::from_min_size(panel.min, panel.size().min(largest.into()))
    }

    /// Compares a part of the screen with a stored picture.
    fn compare(&mut self, name: &str, part: Rect) -> SnapshotResult {
        // Waits until animations have ended.
        self.harness.run_steps(30);
        let picture = self.harness.render().expect("a picture of the window");
        let [left, top] = [part.left(), part.top()].map(|at| at.round() as u32);
        let [width, height] = [part.width(), part.height()].map(|side| side.round() as u32);
        let part = image::imageops::crop_imm(&picture, left, top, width, height).to_image();
        let options = SnapshotOptions::new()
            .threshold(1.0)
            .failed_pixel_count_threshold((width * height / 500) as usize);
        try_image_snapshot_options(&part, name, &options)
    }
}

#[test]
fn knobs_look_as_in_their_reviewed_pictures() {
    let mut results = SnapshotResults::new();
    for (node, shade, name) in [
        ("rust", ColorScheme::Dark, "knobs_of_a_layer"),
        ("rust", ColorScheme::Light, "knobs_of_a_layer_on_light"),
        ("tones", ColorScheme::Dark, "knobs_of_a_gradient"),
        ("bend", ColorScheme::Dark, "knobs_of_a_curve"),
    ] {
        let mut window = Window::on(node, shade);
        // A curve shows the histogram of its input above its points.
        let height = if node == "bend" {
            window.until("the histogram", |editor| editor.views.parameters.has_histogram());
            330.0
        } else {
            260.0
        };
        let part = window.part_of(Panel::Parameters, [360.0, height]);
        results.add(window.compare(name, part));
    }
}

#[test]
fn a_node_looks_as_in_its_reviewed_picture_except_for_the_time_in_its_title() {
    let mut results = SnapshotResults::new();
    for (shade, name) in [(ColorScheme::Dark, "node"), (ColorScheme::Light, "node_on_light")] {
        let mut window = Window::on("rust", shade);
        let mut part = window.rect(&id("rust")).expand2(vec2(8.0, 4.0));
        part.min.y += TITLE_HEIGHT * window.zoom();
        results.add(window.compare(name, part));
    }
}

#[test]
fn the_add_menu_looks_as_in_its_reviewed_picture() {
    let mut window = Window::on("rust", ColorScheme::Dark);
    let at = window.on_canvas([0.05, 0.1]);
    window.point(at);
    window.key(Key::Tab);
    window.typed("blur");
    let part = Rect::from_min_size(at, vec2(400.0, 112.0));
    window.compare("add_menu", part).expect("the same picture");
}

#[test]
fn a_texture_with_its_histogram_looks_as_in_its_reviewed_picture() {
    let mut window = Window::on("clouds", ColorScheme::Dark);
    window.until("its picture", |editor| {
        let inspected = editor.evaluation.results.inspected.as_ref();
        inspected.is_some_and(|(node, values)| node.node == "clouds" && editor.views.flat.shows(values))
    });
    let panel = window.editor().shell.dock.rects[&Panel::Flat];
    let part = Rect::from_min_max(panel.max - vec2(300.0, 200.0), panel.max);
    window.compare("texture", part).expect("the same picture");
}
