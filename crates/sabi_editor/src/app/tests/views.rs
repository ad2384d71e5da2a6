//! Keys for the model and for the texture, and the list of all keys.

use egui::Key;
use egui_kittest::kittest::{Queryable, by};

use super::Window;
use super::commands::window_with;
use super::hands::id;
use crate::command::{Command, Habit, Scope};

impl Window {
    /// Whether a switch is on, told to those who do not see it.
    pub(super) fn is_on(&self, label: &str) -> bool {
        let mut found = self.harness.query_all(
            by().label(label)
                .predicate(|node| node.toggled() == Some(egui::accesskit::Toggled::True)),
        );
        found.next().is_some()
    }
}

#[test]
fn the_model_follows_its_keys() {
    let mut window = window_with(Habit::Default);
    window.until("a picture of the model", |editor| editor.model_view.drawn > 0);
    for (command, keys) in [
        (Command::Front, "1"),
        (Command::Right, "3"),
        (Command::Top, "7"),
        (Command::Lens, "5"),
        (Command::FrameModel, "A"),
    ] {
        window.prepare(&[], Scope::Viewport);
        let camera = window.editor().model_view.camera;
        window.chord(keys);
        assert_ne!(window.editor().model_view.camera, camera, "{}", command.title());
    }
    window.prepare(&["clouds"], Scope::Viewport);
    for (key, lines) in [("W", "Triangles"), ("S", "Seams")] {
        let before = window.editor().model_view.shot.lines.len();
        window.chord(key);
        assert_eq!(window.editor().model_view.shot.lines.len(), before + 1, "{lines}");
    }
    window.chord("C");
    assert!(window.editor().model_view.wipe.is_some() && window.says("Lock a node (P) to compare with it"));
    window.chord("C");
    assert!(window.editor().model_view.wipe.is_none());
    assert_eq!(
        window.steps(),
        0,
        "C frames no nodes while the pointer is over the model"
    );
}

#[test]
fn the_texture_follows_its_keys() {
    let mut window = window_with(Habit::Default);
    window.click_at(window.title(&id("clouds")));
    window.until("the texture", |editor| editor.stage.inspected.is_some());
    window.prepare(&["clouds"], Scope::Flat);
    for (key, label) in [("T", "Tile"), ("W", "UV")] {
        assert!(!window.is_on(label));
        window.chord(key);
        assert!(window.is_on(label), "{key}");
        window.chord(key);
        assert!(!window.is_on(label), "{key} again");
    }
    window.chord("Z");
    assert_eq!(window.editor().flat_view.zoom, Some(1.0));
    for key in ["A", "F"] {
        window.chord("Z");
        window.chord(key);
        assert_eq!(window.editor().flat_view.zoom, None);
    }
}

#[test]
fn the_list_of_keys_binds_a_command_anew() {
    let mut window = window_with(Habit::Default);
    window.prepare(&["mix"], Scope::Canvas);
    window.chord("Ctrl+/");
    assert!(window.has("Keys for Mute"), "the list is open");
    window.press("Keys for New graph");
    window.key(Key::M);
    assert_eq!(window.steps(), 0, "the key that is chosen does nothing else");
    assert_eq!(window.editor().settings.keys["new"], ["M"]);
    assert!(window.says("M means both"), "what now means two things is told");
    window.press("As they were at first");
    assert!(!window.says("M means both"));
    window.prepare(&["mix"], Scope::Canvas);
    window.chord("M");
    assert_eq!(window.steps(), 1);
}
