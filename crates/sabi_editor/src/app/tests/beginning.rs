//! How work begins: the start page, files that are dropped, and the window as it was left.

use std::fs;

use super::Window;
use super::safety::CLOUDS;
use crate::dock::Panel;

#[test]
fn the_start_page_begins_opens_and_unpacks() {
    let mut window = Window::opened(CLOUDS);
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.harness.state_mut().settings.remember(&other);
    let mut choose = |card: &str| {
        window.harness.state_mut().files.is_start = true;
        window.settle();
        window.press(card);
        assert!(!window.editor().files.is_start, "{card}");
        let file = window.desk().session.file();
        let name = file.map(|file| file.file_name().unwrap_or_default().to_string_lossy().into_owned());
        (name.unwrap_or_default(), window.desk().graph().len())
    };
    assert_eq!(choose("other"), ("other.sabi".to_owned(), 0));
    let example = &crate::files::examples::EXAMPLES[0];
    let (name, nodes) = choose(example.title);
    assert!(name.ends_with(".sabi") && nodes > 0, "{name} {nodes}");
    assert_eq!(choose("Empty graph"), (String::new(), 0));
    choose("Open…");
    assert!(window.says("Open a graph"), "it asks for the path");
}

#[test]
fn a_graph_and_a_model_are_taken_where_they_are_dropped() {
    let mut window = Window::opened(CLOUDS);
    let model = window.path("other.obj");
    fs::write(&model, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a model");
    window.dropped(&model);
    let model = model.canonicalize().expect("a file");
    assert_eq!(window.editor().stage.model_file(), model);
    assert!(window.editor().settings.models.contains(&model), "it is on the strip");
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.mute();
    window.dropped(&other);
    assert!(window.says("There are changes that are not saved"));
    window.press("Let them go");
    assert_eq!(window.desk().session.file(), Some(&*other));
}

#[test]
fn panels_stay_where_they_were_put_until_they_are_put_back() {
    let mut window = Window::opened(CLOUDS);
    window.open(Panel::History);
    window.harness.state_mut().keep_settings();
    let mut window = window.after_a_crash();
    window.harness.state_mut().files.is_start = false;
    window.settle();
    assert!(window.editor().rects.contains_key(&Panel::History));
    window.press("Window");
    window.press("All panels where they were at first");
    assert!(!window.editor().rects.contains_key(&Panel::History));
}
