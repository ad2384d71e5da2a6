//! Views of the model that are kept, pictures of it that are saved, and its channels one by one.

use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;
use egui_phosphor::regular as icon;
use sabi_view::Mode;

use super::super::Window;
use super::super::hands::id;
use crate::command::{Command, InputPreset, Scope, ViewportCommand};
use crate::dock::Panel;

const LIT: &str = r##"
    "base": { "kind": "source/material", "pos": [0, 0] },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base" }, "params": { "color": "#6b3a1e" }, "pos": [300, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "rust" }, "pos": [600, 0] }"##;

#[test]
fn a_view_is_saved_under_a_name_and_available_in_every_session() {
    let mut window = Window::opened(LIT);
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    let camera = |window: &Window| window.editor().views.model.navigation.camera;
    let first = camera(&window);
    window.open_menu(icon::BOOKMARK_SIMPLE, "Views");
    window.press("Save this view");
    let kept = window.document().contents().preview.clone().expect("a preview").views;
    assert_eq!(kept.keys().collect::<Vec<_>>(), ["View 1"]);
    assert_eq!(window.steps(), 1);
    let at = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.wheel(at, 300.0);
    assert_ne!(camera(&window).distance, first.distance);
    window.open_menu(icon::BOOKMARK_SIMPLE, "Views");
    window.press(&format!("{} View 1", icon::BOOKMARK_SIMPLE));
    let back = camera(&window);
    assert!((back.distance - first.distance).abs() < 1e-5 && back.yaw_degrees == first.yaw_degrees);
    window.open_menu(icon::BOOKMARK_SIMPLE, "Views");
    window.press("Delete View 1");
    let kept = window.document().contents().preview.clone().expect("a preview").views;
    assert!(kept.is_empty());
    // The menu stays open while a name is typed in it.
    window.harness.get_by_label("Name of the view");
    let field = window.harness.get_by_label("Name of the view").rect().center();
    window.click_at(field);
    window.typed("Front of the barrel");
    window.press("Save this view");
    let kept = window.document().contents().preview.clone().expect("a preview").views;
    assert_eq!(kept.keys().collect::<Vec<_>>(), ["Front of the barrel"]);
}

#[test]
fn a_picture_of_the_view_is_saved_at_any_size_and_replaces_no_file() {
    let mut window = Window::opened(LIT);
    let folder = window.folder.path().canonicalize().expect("a folder");
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    let file = folder.join("graph.png");
    let view = &mut window.harness.state_mut().views.model.saved_picture;
    view.size = [320, 180];
    window.open_menu(icon::BOOKMARK_SIMPLE, "Views");
    window.press("Save a picture of the view…");
    window.key(Key::Enter);
    window.until("the picture", |editor| !editor.views.model.saved_picture.is_busy());
    let saved = image::open(&file).expect("a picture");
    assert_eq!([saved.width(), saved.height()], [320, 180]);
    let colors = saved.to_rgb8();
    assert_ne!(
        colors.get_pixel(160, 90),
        colors.get_pixel(2, 2),
        "the model stands before the background"
    );
    let written = std::fs::read(&file).expect("a picture");
    // The next one is offered another name, and the name of the first is refused.
    window.open_menu(icon::BOOKMARK_SIMPLE, "Views");
    window.press("Save a picture of the view…");
    window.typed("graph");
    window.key(Key::Enter);
    assert!(window.editor().views.questions.open.is_some());
    assert_eq!(std::fs::read(&file).expect("a picture"), written);
}

#[test]
fn channels_are_shown_one_by_one_by_keys_and_from_the_menu_of_a_node() {
    let mut window = Window::opened(LIT);
    let mode = |window: &Window| window.editor().views.model.shot.mode;
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    window.prepare(&[], Scope::Viewport);
    for (command, shown) in [
        (ViewportCommand::NextChannel, Mode::BaseColor),
        (ViewportCommand::NextChannel, Mode::Opacity),
        (ViewportCommand::PreviousChannel, Mode::BaseColor),
        (ViewportCommand::Material, Mode::Material),
    ] {
        window.chord(Command::Viewport(command).keys(InputPreset::Default)[0]);
        assert_eq!(mode(&window), shown);
    }
    let node = window.title(&id("rust"));
    window.click_with(node, PointerButton::Secondary, Modifiers::NONE);
    window.press("Show a channel on the model ⏵");
    window.press("Roughness");
    assert_eq!(mode(&window), Mode::Roughness);
    assert!(window.editor().shell.settings.follows);
    assert_eq!(
        window.editor().looks.inspected().map(|shown| shown.node.clone()),
        Some("rust".to_owned())
    );
}
