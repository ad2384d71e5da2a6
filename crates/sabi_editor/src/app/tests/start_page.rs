//! Start page, dropped files, and the state of the window after a restart.

use std::fs;

use super::Window;
use super::safety::CLOUDS;
use crate::dock::Panel;

#[test]
fn the_start_page_opens_recent_files_examples_and_new_graphs() {
    let mut window = Window::opened(CLOUDS);
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.harness.state_mut().shell.settings.remember(&other);
    let mut choose = |card: &str| {
        window.harness.state_mut().views.start.is_open = true;
        window.settle();
        window.press(card);
        assert!(!window.editor().views.start.is_open, "{card}");
        let file = window.document().session.file();
        let name = file.map(|file| file.file_name().unwrap_or_default().to_string_lossy().into_owned());
        (name.unwrap_or_default(), window.document().graph().len())
    };
    assert_eq!(choose("other"), ("other.sabi".to_owned(), 0));
    let example = &crate::files::examples::EXAMPLES[0];
    let (name, nodes) = choose(example.title);
    assert!(name.ends_with(".sabi") && nodes > 0, "{name} {nodes}");
    assert_eq!(choose("Empty graph"), (String::new(), 2), "the model and an output");
    choose("Open…");
    assert!(window.says("Open a graph"), "it asks for the path");
}

#[test]
fn a_dropped_model_is_shown_and_a_dropped_graph_opened() {
    let mut window = Window::opened(CLOUDS);
    let model = window.path("other.obj");
    fs::write(&model, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a model");
    window.dropped(&model);
    let model = model.canonicalize().expect("a file");
    assert_eq!(window.editor().evaluation.model.file(), model);
    window.until("the model", |editor| editor.evaluation.model.loaded().1);
    assert!(
        window.editor().documents.models.files.contains(&model),
        "it is on the strip"
    );
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.mute();
    window.dropped(&other);
    assert!(window.says("There are changes that are not saved"));
    window.press("Discard");
    assert_eq!(window.document().session.file(), Some(&*other));
}

#[test]
fn the_layout_of_the_panels_survives_a_restart_and_can_be_reset() {
    let mut window = Window::opened(CLOUDS);
    window.open(Panel::History);
    window.harness.state_mut().save_settings();
    let mut window = window.after_a_crash();
    window.harness.state_mut().views.start.is_open = false;
    window.settle();
    assert!(window.editor().shell.dock.rects.contains_key(&Panel::History));
    window.press("Window");
    window.press("Reset the layout of the panels");
    assert!(!window.editor().shell.dock.rects.contains_key(&Panel::History));
}

#[test]
fn settings_that_could_not_be_saved_are_saved_with_the_next_change() {
    let mut window = Window::opened(CLOUDS);
    let folder = window.path("settings");
    let _ = fs::remove_file(folder.join("settings.json"));
    // A folder of this name prevents the file from being written.
    fs::create_dir_all(folder.join("settings.json")).expect("a folder");
    let editor = window.harness.state_mut();
    editor.shell.settings.has_mini_map = true;
    editor.save_settings();
    window.settle();
    assert!(window.says("The settings cannot be kept in"));
    fs::remove_dir(folder.join("settings.json")).expect("an empty folder");
    let editor = window.harness.state_mut();
    editor.shell.settings.follows = false;
    editor.save_settings();
    let (kept, _) = crate::settings::Settings::load(Some(&folder));
    assert!(kept.has_mini_map && !kept.follows);
}

#[cfg(unix)]
#[test]
fn a_model_behind_a_link_is_read_where_the_link_is() {
    let window = Window::opened(CLOUDS);
    let [real, link] = ["store/ab12.obj", "hero.obj"].map(|name| window.path(name));
    fs::create_dir_all(window.path("store")).expect("a folder");
    fs::write(&real, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a model");
    std::os::unix::fs::symlink(&real, &link).expect("a link");
    let mut window = window;
    window.dropped(&link);
    let model = window.editor().evaluation.model.file();
    assert_eq!(
        model.file_name(),
        link.file_name(),
        "what lies beside the link belongs to it"
    );
}
