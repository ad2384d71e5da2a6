//! Models side by side, each with the same graph.

use std::path::{Path, PathBuf};

use egui::PointerButton;
use egui_kittest::kittest::Queryable;
use sabi_engine::live::ViewSubject;
use sabi_graph::Value;

use super::super::Window;
use super::super::hands::{beside, id};
use crate::app::Editor;
use crate::model_row::MOST_BESIDE;

const PAINTED: &str = r##"
    "paint": { "kind": "source/material", "params": { "color": "#a03010" }, "pos": [0, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "paint" }, "pos": [300, 0] }
"##;

/// Number of the newest picture on a model beside the main one.
fn picture_of(editor: &Editor, at: usize) -> Option<u64> {
    let picture = editor.row.beside().get(at)?.results.picture(&ViewSubject::Outputs)?;
    Some(picture.number)
}

impl Window {
    /// A window that shows one of Sabi's own models beside the cube.
    fn with_beside(name: &str) -> Window {
        let mut window = Window::opened(PAINTED);
        window.until_model();
        window.press("Models side by side");
        window.harness.get_by_label(name).click();
        window.settle();
        window.key(egui::Key::Escape);
        window.until("its picture", |editor| picture_of(editor, 0).is_some());
        window
    }

    /// Models beside the main one.
    fn beside(&self) -> Vec<String> {
        let files = self.editor().row.files().into_iter();
        let stem = |file: PathBuf| file.file_stem().expect("a name").to_string_lossy().into_owned();
        files.map(stem).collect()
    }

    fn main_model(&self) -> &Path {
        self.editor().evaluation.model.file()
    }
}

#[test]
fn a_model_of_the_menu_is_shown_beside_the_main_one_and_removed_again() {
    let mut window = Window::with_beside("sphere");
    assert_eq!(window.beside(), ["sphere"]);
    window.until("its texture", |editor| editor.views.model.has_picture_beside(0));
    window.press("Remove sphere");
    assert!(window.beside().is_empty());
    // A picture that was on its way may still arrive.
    window.until("its picture is released", |editor| {
        !editor.views.model.has_picture_beside(0)
    });
}

#[test]
fn a_knob_changes_the_first_model_and_the_one_beside_it() {
    let mut window = Window::with_beside("sphere");
    let pictures = |editor: &Editor| {
        let main = editor.evaluation.results.picture(&ViewSubject::Outputs);
        [main.map(|picture| picture.number), picture_of(editor, 0)]
    };
    window.until("the first picture", |editor| pictures(editor)[0].is_some());
    let before = pictures(window.editor());
    let paint = id("paint");
    let document = &mut window.harness.state_mut().documents.document;
    let value = Some(Value::Text("#20a040".to_owned()));
    sabi_editing::nodes::set_knob(document, &paint, "color", value);
    window.until("pictures of the new color", |editor| {
        let now = pictures(editor);
        now.iter().zip(&before).all(|(now, before)| now > before)
    });
}

#[test]
fn a_click_on_a_name_makes_that_model_the_first_one() {
    let mut window = Window::with_beside("sphere");
    window.press("sphere beside");
    assert!(window.main_model().ends_with("sphere.glb"));
    assert_eq!(window.beside(), ["cube"]);
    // While the new model is read, its name does not stand at the picture of the model that had its place before.
    let cube = window.editor().row.files().remove(0);
    let pictured = window.editor().views.model.pictured_beside(&cube);
    assert!(pictured.is_none_or(|file| file.ends_with("cube.glb")), "{pictured:?}");
    window.until("both", |editor| {
        editor.evaluation.model.loaded().1 && picture_of(editor, 0).is_some()
    });
}

#[test]
fn a_drag_on_any_model_turns_all_of_them() {
    let mut window = Window::with_beside("sphere");
    let before = window.editor().views.model.navigation.camera;
    let at = window.harness.get_by_label("Remove sphere").rect().center();
    let from = beside(at, [0.0, -120.0]);
    window.drag_along(
        &[from, beside(from, [60.0, 0.0])],
        PointerButton::Primary,
        egui::Modifiers::NONE,
    );
    assert_ne!(
        window.editor().views.model.navigation.camera.yaw_degrees,
        before.yaw_degrees
    );
}

#[test]
fn a_model_that_cannot_be_read_says_why_in_its_place() {
    let mut window = Window::opened(PAINTED);
    window.until_model();
    let broken = window.path("broken.glb");
    std::fs::write(&broken, b"no model").expect("a file");
    window.harness.state_mut().models().show_beside(&broken);
    window.until("its fault", |editor| editor.row.beside()[0].model.failure.is_some());
    let failure = window.editor().row.beside()[0]
        .model
        .failure
        .as_ref()
        .map(ToString::to_string);
    let shown = window.editor().views.model.fault_beside(&broken).expect("a sentence");
    assert_eq!(*shown, format!("broken: {}", failure.expect("a failure")));
    assert!(window.main_model().ends_with("cube.glb"), "the first model stays");
}

#[test]
fn a_model_is_shown_only_once_and_the_number_of_models_is_limited() {
    let mut window = Window::opened(PAINTED);
    window.until_model();
    let cube = window.main_model().to_owned();
    window.harness.state_mut().models().show_beside(&cube);
    window.settle();
    assert!(window.beside().is_empty() && window.says("is shown already."));
    for number in 0..=MOST_BESIDE {
        let missing = window.path(&format!("missing {number}.glb"));
        window.harness.state_mut().models().show_beside(&missing);
    }
    window.settle();
    assert_eq!(window.beside().len(), MOST_BESIDE);
    assert!(window.says("There are 8 models in the view, which is the most"));
}
