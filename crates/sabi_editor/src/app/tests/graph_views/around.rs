//! The viewport's surroundings: the strip of models, light, mode, and bars of lengths.

use egui::accesskit::Role;
use egui::{Key, PointerButton, Pos2, pos2};
use egui_kittest::kittest::Queryable;
use egui_phosphor::regular as icon;
use sabi_view::{Mode, ViewTransform};

use super::super::Window;
use super::super::hands::id;
use crate::dock::Panel;
use crate::settings::MOST_MODELS;

impl Window {
    fn add_model(&mut self, path: &str) {
        self.press("Add a model");
        self.typed(path);
        self.key(Key::Enter);
    }

    /// Names on the strip of models.
    fn strip(&self) -> Vec<String> {
        let models = self.editor().documents.models.files.iter();
        models
            .map(|model| model.file_stem().unwrap_or_default().to_string_lossy().into_owned())
            .collect()
    }

    /// Place of a model on the strip.
    fn entry(&self, name: &str) -> Pos2 {
        let label = format!("{} {name}", icon::CUBE);
        self.harness.get_by_label(&label).rect().center()
    }
}

#[test]
fn models_are_added_to_the_strip_switched_and_removed() {
    let mut window = Window::empty();
    window.until_model();
    let sphere = window.path("sphere.glb");
    std::fs::write(&sphere, include_bytes!("../../../../../../assets/meshes/sphere.glb")).expect("a model");
    window.add_model(&sphere.display().to_string());
    let file = |editor: &crate::app::Editor| editor.evaluation.model.file().to_owned();
    assert_eq!(file(window.editor()), sphere);
    window.until("the sphere", |editor| editor.evaluation.model.loaded().1);
    assert_eq!(window.strip(), ["cube", "sphere"]);
    window.click_at(window.entry("cube"));
    assert!(file(window.editor()).ends_with("cube.glb"));
    window.until("the cube", |editor| editor.evaluation.model.loaded().1);
    window.click_with(window.entry("sphere"), PointerButton::Secondary, egui::Modifiers::NONE);
    window.press("Remove from the list");
    assert_eq!(window.strip(), ["cube"]);
}

#[test]
fn a_model_that_cannot_be_shown_is_reported_and_the_previous_one_stays() {
    let mut window = Window::empty();
    window.until_model();
    let cube = window.editor().evaluation.model.file().to_owned();
    let broken = window.path("broken.glb");
    std::fs::write(&broken, b"no model").expect("a file");
    for file in [window.path("missing.glb"), broken] {
        window.harness.state_mut().models().take(&file);
        window.until("the cube", |editor| {
            editor.evaluation.model.file() == cube && editor.evaluation.model.loaded().1
        });
        assert!(window.says(&format!("{} could not be loaded; still showing cube", file.display())));
        assert_eq!(window.strip(), ["cube"]);
    }
}

#[test]
fn removing_the_shown_model_shows_the_next_one_and_the_only_one_stays() {
    let mut window = Window::empty();
    window.until_model();
    let sphere = window.path("sphere.glb");
    std::fs::write(&sphere, include_bytes!("../../../../../../assets/meshes/sphere.glb")).expect("a model");
    window.add_model(&sphere.display().to_string());
    window.until("the sphere", |editor| editor.evaluation.model.loaded().1);
    for _ in 0..2 {
        let shown = window.strip().pop().expect("a model");
        window.click_with(window.entry(&shown), PointerButton::Secondary, egui::Modifiers::NONE);
        window.press("Remove from the list");
        window.until("the cube", |editor| {
            editor.evaluation.model.file().ends_with("cube.glb") && editor.evaluation.model.loaded().1
        });
        assert_eq!(window.strip(), ["cube"]);
    }
    assert!(window.says("This is the only model."));
}

#[test]
fn the_strip_drops_its_oldest_model_when_it_is_full() {
    let mut window = Window::empty();
    for at in 0..MOST_MODELS {
        let file = window.path(&format!("model{at}.glb"));
        std::fs::write(&file, include_bytes!("../../../../../../assets/meshes/cube.glb")).expect("a model");
        window.add_model(&file.display().to_string());
        window.until("the model", |editor| editor.evaluation.model.loaded().1);
    }
    let expected: Vec<String> = (0..MOST_MODELS).map(|at| format!("model{at}")).collect();
    assert_eq!(window.strip(), expected);
}

#[test]
fn a_missing_environment_is_reported_and_another_one_is_used() {
    let mut window = Window::empty();
    let gone = window.path("gone.hdr").display().to_string();
    let environment = gone.clone();
    let editor = window.harness.state_mut();
    editor.shell.settings.environment.clone_from(&environment);
    editor.views.model = crate::model_view::ModelView::new(&environment, &editor.shell.settings.view);
    window.until("a picture", |editor| editor.views.model.pictures.drawn > 0);
    assert!(window.says("gone.hdr"), "{:?}", window.labels());
    assert_eq!(
        window.editor().shell.settings.environment,
        gone,
        "it may be there the next time"
    );
}

#[test]
fn menus_choose_the_mode_the_environment_and_the_light() {
    let mut window = Window::empty();
    window.until_model();
    window.open_menu(icon::SPHERE, "Material");
    window.press("Roughness");
    assert_eq!(window.editor().views.model.shot.mode, Mode::Roughness);
    window.key(Key::Escape);
    window.open_menu(icon::SUN, "Light");
    let other = sabi_engine::opening::environment::built_in_environments()
        .find(|name| *name != window.editor().shell.settings.environment)
        .expect("another environment");
    window.press(&other.replace('_', " "));
    assert_eq!(window.editor().shell.settings.environment, other);
    window.press("ACES");
    assert_eq!(window.editor().views.model.shot.transform, ViewTransform::Aces);
    let bar = window.harness.get_by_role_and_label(Role::Slider, "Exposure").rect();
    window.click_at(pos2(bar.right() - 2.0, bar.center().y));
    assert!(window.editor().views.model.shot.exposure_stops > 5.0);
    window.key(Key::Escape);
    window.open_menu(icon::EYE, "Overlays");
    window.harness.get_by_role_and_label(Role::CheckBox, "Relief").click();
    window.settle();
    assert!(window.editor().views.model.shot.has_relief);
    window.press("Plain");
    assert!(matches!(
        window.editor().views.model.shot.background,
        sabi_view::Background::Plain(_)
    ));
}

#[test]
fn lights_are_added_shown_kept_and_removed() {
    let mut window = Window::empty();
    window.until_model();
    window.until("a picture", |editor| editor.views.model.pictures.drawn > 0);
    window.open_menu(icon::SUN, "Light");
    window.settle();
    let editor = window.editor();
    let without = editor
        .views
        .model
        .pictures
        .shown(editor.evaluation.gpu())
        .expect("a picture");
    let kept = |window: &Window| window.editor().views.model.lights.kept().len();
    assert_eq!(kept(&window), 2, "key and rim light");
    for count in 3..=4 {
        window.press("Add a light");
        window.settle();
        assert_eq!(kept(&window), count);
    }
    window.until("the light of them", |editor| {
        let now = editor.views.model.pictures.shown(editor.evaluation.gpu());
        now.is_some_and(|now| now != without)
    });
    window.press("Add a light");
    assert_eq!(kept(&window), 4, "there is room for no more");
    window.press("Remove light 2");
    assert_eq!(kept(&window), 3);
    let text = serde_json::to_string(&window.editor().views.model.choices()).expect("text");
    assert_eq!(text.matches("has_shadow").count(), 3, "{text}");
    window.press("Studio lights");
    assert_eq!(kept(&window), 2);
}

const LENGTHS: &str = r#"
    "blur": { "kind": "filter/blur", "params": { "radius": 0.05 }, "inputs": { "source": "dots" }, "pos": [300, 0] },
    "dots": { "kind": "noise/dots", "params": { "size": 0.25 }, "pos": [0, 0] }
"#;

#[test]
fn pointing_at_a_length_draws_it_on_the_model_with_its_value_in_both_units() {
    let mut window = Window::opened(LENGTHS);
    window.until_model();
    window.click_at(window.title(&id("blur")));
    let says = |window: &Window| window.says("0.05 = ");
    assert!(!says(&window));
    window.point(window.knob("Radius"));
    window.settle();
    assert!(says(&window) && window.editor().views.model.length == Some(0.05));
    // Words on the picture appear and disappear without a change of the menus beside them.
    window.open_menu(icon::EYE, "Overlays");
    window.harness.get_by_role_and_label(Role::CheckBox, "Relief");
    window.key(Key::Escape);
    window.point(window.on_canvas([0.5, 0.97]));
    window.settle();
    assert!(!says(&window) && window.editor().views.model.length.is_none());
}

#[test]
fn a_length_on_a_node_is_shown_too_while_another_panel_is_in_front() {
    let mut window = Window::opened(LENGTHS);
    window.until_model();
    window.open(Panel::Stack);
    let near = window.rect(&id("dots"));
    let found = window
        .harness
        .query_all_by_label_contains("Size")
        .map(|node| node.rect().center());
    let bar = found
        .into_iter()
        .find(|at| near.contains(*at))
        .expect("a knob on the node");
    window.point(bar);
    window.settle();
    assert_eq!(window.editor().views.model.length, Some(0.25));
    window.point(window.on_canvas([0.5, 0.97]));
    window.settle();
    assert_eq!(window.editor().views.model.length, None);
}

#[test]
fn results_of_the_previous_model_are_covered_until_those_of_the_next_arrive() {
    let mut window = Window::opened(r#""n": { "kind": "noise/simplex" }"#);
    window.until_model();
    window.harness.state_mut().look_at(&id("n"), None);
    window.until("values", |editor| editor.evaluation.results.inspected.is_some());
    assert!(!window.editor().evaluation.is_inspected_outdated());
    let sphere = window.path("sphere.glb");
    std::fs::write(&sphere, include_bytes!("../../../../../../assets/meshes/sphere.glb")).expect("a model");
    window.harness.state_mut().models().take(&sphere);
    assert!(window.editor().evaluation.is_inspected_outdated(), "at once");
    window.until("values of the sphere", |editor| {
        !editor.evaluation.is_inspected_outdated()
    });
    assert!(window.editor().evaluation.model.loaded().1);
    // A model that cannot be shown leaves the results as they are.
    window
        .harness
        .state_mut()
        .models()
        .take(std::path::Path::new("missing.glb"));
    assert!(window.editor().evaluation.is_inspected_outdated());
    window.until("the sphere", |editor| !editor.evaluation.is_inspected_outdated());
    window.settle();
    assert_eq!(window.editor().evaluation.model.file(), sphere);
}
