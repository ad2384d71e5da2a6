//! Keys of the viewport and of the 2D view, and the list of keys.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable, by};

use super::Window;
use super::commands::window_with;
use super::hands::id;
use sabi_editing::clipboard;

use crate::command::{Command, InputPreset, Scope, ViewportCommand, WindowCommand};
use crate::dock::{Panel, Workspace};

impl Window {
    /// Returns whether a switch is on, by its accessible state.
    pub(super) fn is_on(&self, label: &str) -> bool {
        let mut found = self.harness.query_all(
            by().label(label)
                .predicate(|node| node.toggled() == Some(egui::accesskit::Toggled::True)),
        );
        found.next().is_some()
    }

    /// Clicks an entry of a menu, whose name contains its keys.
    pub(super) fn press_entry(&mut self, menu: &str, entry: &str) {
        self.press(menu);
        let found = self.harness.query_all(by().role(Role::Button).label_contains(entry));
        // Other entries have longer names that begin with it.
        let found = found.min_by_key(|found| found.accesskit_node().label().map_or(0, |label| label.len()));
        let at = found.map(|found| found.rect().center());
        self.click_at(at.unwrap_or_else(|| panic!("{menu} has no {entry}")));
    }
}

#[test]
fn keys_of_the_viewport_change_its_view() {
    let mut window = window_with(InputPreset::Default);
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    for (command, keys) in [
        (Command::Viewport(ViewportCommand::Front), "1"),
        (Command::Viewport(ViewportCommand::Right), "3"),
        (Command::Viewport(ViewportCommand::Top), "7"),
        (Command::Viewport(ViewportCommand::Lens), "5"),
        (Command::Viewport(ViewportCommand::ShowAll), "A"),
    ] {
        window.prepare(&[], Scope::Viewport);
        let camera = window.editor().views.model.navigation.camera;
        window.chord(keys);
        assert_ne!(
            window.editor().views.model.navigation.camera,
            camera,
            "{}",
            command.title()
        );
    }
    window.prepare(&["clouds"], Scope::Viewport);
    for (key, lines) in [("W", "Wireframe"), ("S", "Seams")] {
        let before = window.editor().views.model.shot.lines.len();
        window.chord(key);
        assert_eq!(window.editor().views.model.shot.lines.len(), before + 1, "{lines}");
    }
    window.chord("C");
    assert!(window.editor().views.model.comparison.share.is_some() && window.says("Pin a node (P) to compare with it"));
    window.chord("C");
    assert!(window.editor().views.model.comparison.share.is_none());
    assert_eq!(
        window.steps(),
        0,
        "C frames no nodes while the pointer is over the model"
    );
}

#[test]
fn the_wheel_zooms_into_the_model_in_the_direction_of_the_canvas() {
    let mut window = window_with(InputPreset::Default);
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    let model = window.editor().shell.dock.rects[&Panel::Viewport].center();
    let distance = |window: &Window| window.editor().views.model.navigation.camera.distance;
    let before = distance(&window);
    window.wheel(model, 200.0);
    assert!(distance(&window) < before);
    let canvas = window.on_canvas([0.5, 0.5]);
    let zoom = window.zoom();
    window.wheel(canvas, 200.0);
    assert!(window.zoom() > zoom);
}

#[test]
fn a_result_is_locked_on_the_model_by_a_key_while_the_pointer_is_over_the_model() {
    let mut window = window_with(InputPreset::Default);
    let model = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.point(model);
    window.key(Key::P);
    assert!(window.says("Select the node to pin to the 3D view first"));
    window.click_at(window.title(&id("clouds")));
    window.point(model);
    window.key(Key::P);
    assert!(window.editor().looks.pinned_3d.is_some());
    let follows = window.editor().shell.settings.follows;
    window.keys(Modifiers::SHIFT, Key::V);
    assert_ne!(window.editor().shell.settings.follows, follows);
}

#[test]
fn keys_of_the_2d_view_change_its_view() {
    let mut window = window_with(InputPreset::Default);
    window.click_at(window.title(&id("clouds")));
    window.until("the texture", |editor| editor.evaluation.results.inspected.is_some());
    window.prepare(&["clouds"], Scope::Flat);
    for (key, label) in [("T", "Tile"), ("W", "UV")] {
        assert!(!window.is_on(label));
        window.chord(key);
        assert!(window.is_on(label), "{key}");
        window.chord(key);
        assert!(!window.is_on(label), "{key} again");
    }
    window.chord("Z");
    assert_eq!(window.editor().views.flat.zoom, Some(1.0));
    for key in ["A", "F"] {
        window.chord("Z");
        window.chord(key);
        assert_eq!(window.editor().views.flat.zoom, None);
    }
}

/// A window that shows the list of keys.
fn with_keys() -> Window {
    let mut window = window_with(InputPreset::Default);
    window.prepare(&["mix"], Scope::Canvas);
    window.chord("Ctrl+/");
    assert!(window.has("Add a key for Mute"), "the list is open");
    window
}

#[test]
fn a_key_is_added_to_a_command_and_removed_again() {
    let mut window = with_keys();
    let clash = "M means both \"New graph\" and \"Mute\"";
    window.press("Add a key for New graph");
    window.key(Key::M);
    assert_eq!(window.steps(), 0, "the key that is chosen does nothing else");
    assert_eq!(window.editor().shell.settings.keys["new"], ["Ctrl+N", "M"]);
    assert!(window.says(clash), "what now means two things is told");
    window.press("Take Ctrl+N from New graph");
    assert_eq!(window.editor().shell.settings.keys["new"], ["M"]);
    window.press("Reset the keys of New graph");
    assert!(window.editor().shell.settings.keys.is_empty() && !window.says(clash));
    assert!(window.has("Take Ctrl+N from New graph"));
    window.press("Add a key for New graph");
    window.key(Key::M);
    assert!(window.says(clash));
    window.press("Reset all keys");
    assert!(!window.says(clash));
    window.prepare(&["mix"], Scope::Canvas);
    window.chord("M");
    assert_eq!(window.steps(), 1);
}

#[test]
fn escape_leaves_the_list_of_keys_as_it_was_and_a_known_key_is_not_added_twice() {
    let mut window = with_keys();
    for (modifiers, key) in [(Modifiers::NONE, Key::Escape), (Modifiers::COMMAND, Key::N)] {
        window.press("Add a key for New graph");
        assert!(window.editor().views.key_list.takes_keys());
        window.keys(modifiers, key);
        assert!(window.editor().shell.settings.keys.is_empty(), "{key:?}");
        assert!(!window.editor().views.key_list.takes_keys(), "{key:?}");
    }
    assert!(window.has("Add a key for New graph"), "the list is still open");
    assert!(
        window.editor().views.questions.open.is_none(),
        "the keys do nothing else"
    );
}

#[test]
fn a_paste_event_of_the_system_runs_the_command_that_its_key_is_bound_to() {
    let mut window = window_with(InputPreset::Default);
    window.prepare(&["mix"], Scope::Canvas);
    let copied = clipboard::copy(&window.harness.state_mut().documents.document).expect("a copy");
    let count = window.document().graph().len();
    let editor = window.harness.state_mut();
    editor.shell.settings.keys.insert("paste".to_owned(), Vec::new());
    editor
        .shell
        .settings
        .keys
        .insert("mute".to_owned(), vec!["Ctrl+V".to_owned()]);
    editor.shell.apply_settings();
    window.harness.event(egui::Event::Paste(copied));
    window.settle();
    assert_eq!(window.document().graph().len(), count, "nothing is pasted");
    assert!(window.document().node(&id("mix")).expect("a node").muted);
}

#[test]
fn paste_works_by_the_menu_and_by_any_key_wherever_the_pointer_is() {
    let mut window = window_with(InputPreset::Default);
    window.prepare(&["mix"], Scope::Canvas);
    let copied = clipboard::copy(&window.harness.state_mut().documents.document).expect("a copy");
    let count = window.document().graph().len();
    window.press_entry("Edit", "Paste");
    // The clipboard arrives.
    window.harness.event(egui::Event::Paste(copied.clone()));
    window.settle();
    assert_eq!(window.document().graph().len(), count + 1);
    window.point(window.editor().shell.dock.rects[&Panel::Viewport].center());
    window.harness.event(egui::Event::Paste(copied));
    window.settle();
    assert_eq!(window.document().graph().len(), count + 1, "nobody asked");
}

#[test]
fn a_menu_on_the_canvas_brings_the_canvas_up_and_holds_no_keys_once_it_is_hidden() {
    let mut window = window_with(InputPreset::Default);
    window.prepare(&["mix"], Scope::Canvas);
    for entry in ["Add a node", "Rename"] {
        window.harness.state_mut().window_command(WindowCommand::UseView);
        window.settle();
        assert!(window.editor().is_use_view());
        window.press_entry("Edit", entry);
        assert!(
            !window.editor().is_use_view() && window.editor().views.canvas.holds_keys(),
            "{entry}"
        );
        window.key(Key::Escape);
        assert!(!window.editor().views.canvas.holds_keys(), "{entry}");
    }
    // A click can change the view while a menu is open.
    window.prepare(&["mix"], Scope::Canvas);
    window.key(Key::Tab);
    assert!(window.editor().views.canvas.holds_keys());
    window.press("Model and parameters only");
    assert!(window.editor().is_use_view() && !window.editor().views.canvas.holds_keys());
    window.keys(Modifiers::COMMAND, Key::Z);
}

#[test]
fn model_and_graph_are_fitted_to_panels_of_another_shape_until_they_are_moved() {
    let mut window = Window::opened(
        r#""a": { "kind": "noise/simplex", "pos": [0, 0] }, "b": { "kind": "adjust/invert", "pos": [900, 0] }"#,
    );
    window.until_model();
    let camera = |window: &Window| window.editor().views.model.navigation.camera;
    let before = camera(&window);
    window.harness.state_mut().shell.dock.arrange(Workspace::Material);
    window.settle();
    assert_ne!(camera(&window), before);
    let canvas = window.editor().shell.dock.rects[&Panel::Canvas];
    for node in ["a", "b"] {
        assert!(canvas.contains_rect(window.rect(&id(node))), "{node}");
    }
    let model = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.wheel(model, 60.0);
    window.wheel(canvas.center(), 60.0);
    let moved = (camera(&window), window.zoom());
    window.harness.state_mut().shell.dock.arrange(Workspace::Texture);
    window.settle();
    assert_eq!((camera(&window), window.zoom()), moved);
}
