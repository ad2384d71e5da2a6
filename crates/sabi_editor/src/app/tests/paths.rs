//! The question for a path: lists of folders, completion and pasted paths.

use std::fs;

use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;

use super::Window;

#[test]
fn paths_are_chosen_from_lists_completed_by_tab_and_pasted_whole() {
    let mut window = Window::opened("");
    let file = |window: &Window| window.document().session.file().map(std::path::Path::to_owned);
    let folder = window.folder.path().canonicalize().expect("a folder");
    // The name is selected without its ending.
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.typed("rust");
    window.key(Key::Enter);
    assert_eq!(file(&window), Some(folder.join("rust.sabi")));
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.typed("deep/er/x");
    window.key(Key::Enter);
    assert!(window.says("There is no folder"), "none is made without a question");
    window.press("Create it and save");
    assert_eq!(file(&window), Some(folder.join("deep/er/x.sabi")));
    // Goes to the folder above, and opens another graph from there.
    window.keys(Modifiers::COMMAND, Key::O);
    for entry in ["To the folder above", "To the folder above"] {
        window.press(entry);
    }
    window.press("rust.sabi");
    window.press("Open");
    assert_eq!(file(&window), Some(folder.join("rust.sabi")));
    window.keys(Modifiers::COMMAND, Key::O);
    window.typed("deep/e");
    window.key(Key::Tab);
    window.typed("/x");
    window.key(Key::Tab);
    window.key(Key::Enter);
    assert_eq!(file(&window), Some(folder.join("deep/er/x.sabi")));
    window.keys(Modifiers::COMMAND, Key::O);
    window.typed("half a na");
    window.key(Key::Enter);
    assert!(window.editor().views.questions.open.is_some(), "there is no such file");
    let pasted = folder.join("rust.sabi").display().to_string();
    window.harness.event(Event::Paste(pasted));
    window.settle();
    window.key(Key::Enter);
    assert_eq!(file(&window), Some(folder.join("rust.sabi")));
}

#[test]
fn a_double_click_opens_one_entry_and_nothing_in_a_folder_that_it_opens() {
    let mut window = Window::opened("");
    let folder = window.folder.path().canonicalize().expect("a folder");
    for name in ["a/a/a", "b"] {
        fs::create_dir_all(folder.join(name)).expect("a folder");
    }
    let empty = super::graph_text("");
    for name in ["a/graph.sabi", "other.sabi"] {
        fs::write(folder.join(name), &empty).expect("a graph");
    }
    window.keys(Modifiers::COMMAND, Key::O);
    let at = |window: &Window, name: &str| {
        let mut entries = window.harness.query_all_by_label(name).map(|node| node.rect().center());
        entries.next_back().expect("an entry")
    };
    let entry = at(&window, "a");
    window.double_click(entry);
    assert!(window.says(&folder.join("a").display().to_string()));
    assert!(window.editor().views.questions.open.is_some());
    let entry = at(&window, "graph.sabi");
    window.double_click(entry);
    let opened = window.document().session.file().map(std::path::Path::to_owned);
    assert_eq!(opened, Some(folder.join("a/graph.sabi")));
}

#[test]
fn text_and_tab_in_one_frame_complete_the_new_text() {
    let mut window = Window::opened("");
    let folder = window.folder.path().canonicalize().expect("a folder");
    fs::write(folder.join("étude.sabi"), super::graph_text("")).expect("a graph");
    window.keys(Modifiers::COMMAND, Key::O);
    window.typed("é");
    let tab = Event::Key {
        key: Key::Tab,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let events = [Event::Text("t".to_owned()), tab];
    window.harness.input_mut().events.extend(events);
    for _ in 0..3 {
        window.settle();
    }
    window.key(Key::Enter);
    let opened = window.document().session.file().map(std::path::Path::to_owned);
    assert_eq!(opened, Some(folder.join("étude.sabi")));
}

#[test]
fn the_lists_of_places_are_called_home_and_recent() {
    let mut window = Window::opened("");
    window.keys(Modifiers::COMMAND, Key::O);
    assert!(window.has("Home") && window.says("RECENT"), "{:?}", window.labels());
}
