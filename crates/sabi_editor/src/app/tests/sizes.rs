//! Bars of the window on screens of usual sizes and scales.

use egui::accesskit::Role;
use egui::{Rect, Vec2, vec2};
use egui_kittest::kittest::{NodeT, Queryable, by};

use super::Window;
use super::hands::id;
use crate::dock::Panel;

/// Screens in pixels.
const SCREENS: [Vec2; 3] = [vec2(1280.0, 720.0), vec2(1600.0, 900.0), vec2(2560.0, 1440.0)];
/// Least size of the window, points: what a 1280 × 720 screen has at a scale of 1.5.
const LEAST: Vec2 = vec2(853.0, 480.0);
/// Names of models, short and long.
const MODELS: [&str; 5] = [
    "crate",
    "helmet_with_visor",
    "bench",
    "lantern_on_a_long_chain",
    "teapot",
];

/// Widgets of the bars and of the panels whose contents do not scroll, with the part of the window that each belongs to.
fn widgets(window: &Window) -> Vec<(String, Rect, Rect)> {
    let dock = &window.editor().shell.dock;
    let whole = window.harness.ctx.content_rect();
    let tops = dock.rects.values().map(|panel| panel.top());
    let top = tops.fold(f32::INFINITY, f32::min);
    let fixed = [Panel::Viewport, Panel::Flat];
    let roles = [Role::Button, Role::ComboBox, Role::CheckBox, Role::TextInput];
    let nodes = window
        .harness
        .query_all(by().predicate(move |node| roles.contains(&node.role())));
    // Tabs that do not fit are scrolled to by arrows.
    let is_tab =
        |name: &str| name.starts_with(['⏴', '⏵']) || Panel::ALL.iter().any(|panel| name.starts_with(panel.title()));
    let placed = nodes.filter_map(|node| {
        let rect = node.rect();
        let name = node.accesskit_node().label().unwrap_or_default();
        if is_tab(&name) {
            return None;
        }
        let panel = dock.rects.iter().find(|(_, panel)| panel.contains(rect.center()));
        match panel {
            Some((panel, of)) if fixed.contains(panel) => Some((name, rect, *of)),
            Some(_) => None,
            // Contents that are scrolled out of a panel lie below it.
            None => (rect.center().y < top).then_some((name, rect, whole)),
        }
    });
    placed.collect()
}

#[test]
fn bars_have_room_for_everything_on_usual_screens() {
    let mut window = Window::opened(
        r#""n": { "kind": "noise/simplex", "label": "Large soft clouds of moss" },
           "m": { "kind": "source/material", "pos": [0, 300] }"#,
    );
    window.until_model();
    for name in MODELS {
        let file = window.path(&format!("{name}.glb"));
        window.harness.state_mut().documents.models.files.push(file);
    }
    for shown in ["n", "m"] {
        window.harness.state_mut().look_at(&id(shown), None);
        window.until("values", |editor| {
            let inspected = editor.evaluation.results.inspected.as_ref();
            inspected.is_some_and(|(node, _)| node.node == shown)
        });
        for screen in SCREENS {
            for scale in [1.0, 1.5, 2.0] {
                let size = (screen / scale).max(LEAST);
                window.harness.set_size(size);
                window.settle();
                let widgets = widgets(&window);
                assert!(widgets.iter().any(|(name, ..)| name == "Add a model"), "at {size}");
                for (at, (name, rect, part)) in widgets.iter().enumerate() {
                    assert!(
                        part.expand(1.0).contains_rect(*rect),
                        "at {size} with {shown}: '{name}' at {rect} is cut off by {part}"
                    );
                    for (other, beside, _) in &widgets[at + 1..] {
                        let shared = rect.intersect(*beside);
                        let is_inside = rect.contains_rect(*beside) || beside.contains_rect(*rect);
                        assert!(
                            is_inside || shared.width() < 2.0 || shared.height() < 2.0,
                            "at {size} with {shown}: '{name}' at {rect} and '{other}' at {beside} overlap"
                        );
                    }
                }
            }
        }
    }
}
