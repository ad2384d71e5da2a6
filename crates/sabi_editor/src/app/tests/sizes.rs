//! Bars of the window on screens of usual sizes and scales.

use egui::accesskit::Role;
use egui::{Rect, Vec2, vec2};
use egui_kittest::kittest::{NodeT, Queryable, by};

use super::Window;
use super::dropping::write_two_squares;
use super::hands::id;
use super::layers::LAYERED;
use super::stroke_list::listed;
use crate::dock::{Panel, Workspace};

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

/// Widgets of the bars and of some panels, with the part of the window that each belongs to.
fn widgets(window: &Window, panels: &[Panel]) -> Vec<(String, Rect, Rect)> {
    let dock = &window.editor().shell.dock;
    let whole = window.harness.ctx.content_rect();
    let tops = dock.rects.values().map(|panel| panel.top());
    let top = tops.fold(f32::INFINITY, f32::min);
    let roles = [
        Role::Button,
        Role::ComboBox,
        Role::CheckBox,
        Role::TextInput,
        Role::Slider,
        Role::Label,
    ];
    let nodes = window
        .harness
        .query_all(by().predicate(move |node| roles.contains(&node.role())));
    // Tabs that do not fit are scrolled to by arrows.
    let is_tab =
        |name: &str| name.starts_with(['⏴', '⏵']) || Panel::ALL.iter().any(|panel| name.starts_with(panel.title()));
    let placed = nodes.filter_map(|node| {
        let rect = node.rect();
        let name = node.accesskit_node().label().or(node.value()).unwrap_or_default();
        if is_tab(&name) {
            return None;
        }
        let panel = dock.rects.iter().find(|(_, panel)| panel.contains(rect.center()));
        match panel {
            Some((panel, of)) if panels.contains(panel) => Some((name, rect, *of)),
            Some(_) => None,
            // Contents that are scrolled out of a panel lie below it.
            None => (rect.center().y < top).then_some((name, rect, whole)),
        }
    });
    placed.collect()
}

/// Checks that no widget is cut off, and that none covers another one.
fn check(widgets: &[(String, Rect, Rect)], what: &str) {
    for (at, (name, rect, part)) in widgets.iter().enumerate() {
        assert!(
            part.expand(1.0).contains_rect(*rect),
            "{what}: '{name}' at {rect} is cut off by {part}"
        );
        for (other, beside, _) in &widgets[at + 1..] {
            let shared = rect.intersect(*beside);
            let is_inside = rect.contains_rect(*beside) || beside.contains_rect(*rect);
            assert!(
                is_inside || shared.width() < 2.0 || shared.height() < 2.0,
                "{what}: '{name}' at {rect} and '{other}' at {beside} overlap"
            );
        }
    }
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
                let widgets = widgets(&window, &[Panel::Viewport, Panel::Flat]);
                assert!(widgets.iter().any(|(name, ..)| name == "Add a model"), "at {size}");
                check(&widgets, &format!("at {size} with {shown}"));
            }
        }
    }
}

#[test]
fn the_bar_of_the_texture_has_room_for_the_sets_of_a_model_with_several_materials() {
    let mut window = Window::opened(r#""m": { "kind": "source/material", "label": "Large soft clouds of moss" }"#);
    let squares = write_two_squares(window.folder.path());
    window.harness.state_mut().models().take(&squares);
    window.until("the squares", |editor| {
        let model = editor.evaluation.model.received.as_ref();
        model.is_some_and(|model| model.sets.len() == 2)
    });
    window.harness.state_mut().look_at(&id("m"), None);
    window.until_inspected("m");
    for (workspace, title) in Workspace::ALL {
        let dock = &mut window.harness.state_mut().shell.dock;
        dock.arrange(workspace);
        dock.bring_up(Panel::Flat);
        for size in [LEAST, vec2(1280.0, 720.0), vec2(1600.0, 900.0), vec2(2560.0, 1440.0)] {
            window.harness.set_size(size);
            window.settle();
            let widgets = widgets(&window, &[Panel::Flat]);
            for name in ["Texture set: left", "RGB", "UV", "Tile"] {
                assert!(
                    widgets.iter().any(|(known, ..)| known == name),
                    "{title} at {size}: no '{name}'"
                );
            }
            check(&widgets, &format!("{title} at {size}"));
        }
    }
}

#[test]
fn rows_of_layers_and_of_strokes_have_room_for_all_they_show() {
    let mut window = Window::of(LAYERED);
    // This workspace has no canvas, whose nodes would have the same names.
    window.harness.state_mut().shell.dock.arrange(Workspace::Look);
    window.harness.state_mut().shell.dock.bring_up(Panel::Stack);
    for size in [vec2(1280.0, 720.0), vec2(1600.0, 900.0)] {
        window.harness.set_size(size);
        window.settle();
        let widgets = widgets(&window, &[Panel::Stack]);
        assert!(widgets.iter().any(|(name, ..)| name == "Opacity"), "{widgets:?}");
        check(&widgets, &format!("layers at {size}"));
    }
    let mut window = listed();
    window.harness.state_mut().shell.dock.arrange(Workspace::Look);
    window.settle();
    for is_marked in [false, true] {
        if is_marked {
            window.click("Stroke 1");
        }
        for size in [vec2(1280.0, 720.0), vec2(1600.0, 900.0)] {
            window.harness.set_size(size);
            window.settle();
            let widgets = widgets(&window, &[Panel::Parameters]);
            check(&widgets, &format!("strokes at {size}"));
        }
    }
}
