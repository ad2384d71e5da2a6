//! Changes that other windows and programs make to the file of the open graph, and the questions of a save about them.

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use egui::{Key, Modifiers};
use sabi_engine::Session;

use super::Window;
use super::safety::CLOUDS;
use crate::action::SettingAction;

impl Window {
    fn saves(&mut self) {
        self.keys(Modifiers::COMMAND, Key::S);
    }

    fn on_disk(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.path(name)).ok()
    }
}

/// A window on a graph that another window has open, and the session of that one.
fn second_window() -> (Window, Session) {
    let mut first = None;
    let mut window = Window::with(|folders| {
        let file = super::beside(folders).join("graph.sabi");
        fs::write(&file, super::graph_text(CLOUDS)).expect("a graph");
        let mut session = Session::open(&file, None).expect("a graph that can be read");
        assert!(session.graph_file.claim());
        first = Some(session);
        Session::open(&file, folders.recovery.as_deref()).expect("a graph that can be read")
    });
    window.settle();
    (window, first.expect("the session of the first window"))
}

#[test]
fn a_graph_that_is_open_in_another_window_can_be_opened_for_reading_only() {
    let (mut window, _first) = second_window();
    assert!(window.says("This graph is open already"));
    assert!(window.says("is open in another window. If both windows save it"));
    window.press("Open it for reading only");
    assert!(window.says("graph.sabi (for reading only)"));
    let before = window.on_disk("graph.sabi");
    window.mute();
    window.saves();
    assert!(window.says("This graph is open already"), "a save asks again");
    assert_eq!(window.on_disk("graph.sabi"), before);
    window.press("Save a copy…");
    window.answer_path(&window.path("copy.sabi"));
    assert_eq!(window.on_disk("copy.sabi"), Some(window.text()));
    assert!(!window.says("for reading only"));
    assert_eq!(window.on_disk("graph.sabi"), before);
}

#[test]
fn a_graph_that_is_open_in_another_window_can_be_saved_if_the_user_opens_it_anyway() {
    let (mut window, _first) = second_window();
    window.press("Open it anyway");
    assert!(!window.says("for reading only"));
    window.mute();
    window.saves();
    assert_eq!(window.on_disk("graph.sabi"), Some(window.text()));
}

#[test]
fn a_file_that_is_open_in_another_window_is_not_replaced_without_a_question() {
    let (mut window, _first) = second_window();
    window.press("Open it for reading only");
    for name in ["graph.sabi", "other.sabi"] {
        let file = window.path(name);
        let mut other = Session::new(None);
        let _held = (name == "other.sabi").then(|| {
            other.save_as(&file).expect("a file");
            assert!(other.graph_file.claim());
        });
        window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
        window.answer_path(&file);
        assert!(window.says("This file is open in another window"), "{name}");
        window.key(Key::Escape);
    }
}

#[test]
fn the_same_graph_opens_in_its_own_window_again_without_a_question() {
    let mut window = Window::opened(CLOUDS);
    let file = window.path("graph.sabi");
    assert!(sabi_engine::session::is_open_in_a_window(&file));
    window.harness.state_mut().open_file(&file);
    window.settle();
    assert!(!window.says("This graph is open already"));
    // The first file of a new graph is claimed, too.
    window.keys(Modifiers::COMMAND, Key::N);
    assert!(!sabi_engine::session::is_open_in_a_window(&file));
    window.add([0.3, 0.3], "clouds");
    window.saves();
    window.answer_path(&window.path("first.sabi"));
    assert!(sabi_engine::session::is_open_in_a_window(&window.path("first.sabi")));
}

#[test]
fn a_save_checks_the_file_and_can_keep_the_version_of_another_program_beside_it() {
    let mut window = Window::opened(CLOUDS);
    window.mute();
    let theirs = super::graph_text("");
    fs::write(window.path("graph.sabi"), &theirs).expect("written");
    // Saves before the next frame, which would notice the change.
    window.harness.state_mut().saving().save();
    window.settle();
    assert!(window.says("Another program has written this file"));
    assert!(window.says("can be kept beside it, or is replaced and stays as graph.sabi.bak"));
    assert_eq!(window.on_disk("graph.sabi"), Some(theirs.clone()));
    window.press("Keep theirs beside it");
    assert_eq!(window.on_disk("graph.sabi"), Some(window.text()));
    assert_eq!(window.on_disk("graph-theirs.sabi"), Some(theirs));
    assert!(window.says("What the other program wrote is in"));
    assert!(!window.harness.state_mut().documents.document.session.is_dirty());
}

#[test]
fn the_number_of_backups_is_a_setting() {
    let mut window = Window::opened(CLOUDS);
    let change_and_save = |window: &mut Window| {
        window.mute();
        window.saves();
    };
    (0..5).for_each(|_| change_and_save(&mut window));
    let backups = |window: &Window| {
        let files = fs::read_dir(window.path("")).expect("a folder").flatten();
        let names = files.map(|file| file.file_name().to_string_lossy().into_owned());
        names.filter(|name| name.contains(".bak")).count()
    };
    assert_eq!(backups(&window), 3);
    window.harness.state_mut().shell.set(SettingAction::Backups(5));
    (0..5).for_each(|_| change_and_save(&mut window));
    assert_eq!(backups(&window), 5);
}

#[test]
fn a_recovery_shows_its_nodes_and_the_dates_and_sizes_of_both_files() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.mute();
    let size = format!("{} bytes", window.text().len());
    let saved = format!("{} bytes", super::graph_text(CLOUDS).len());
    let mut window = window.after_a_crash();
    assert!(window.says("1 node: Clouds"), "{:?}", window.labels());
    assert!(window.says("Drawing of the graph"));
    let dates = format!("unsaved work from just now, {size}; the file was saved just now, {saved}");
    assert!(window.says(&dates), "{:?}", window.labels());
    assert!(!window.says("The file was written by another program since"));
    window.press("Recover");
    assert!(window.harness.state_mut().documents.document.session.is_dirty());
}

#[test]
fn saving_a_recovered_graph_asks_first_if_its_file_was_written_since_the_crash() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.mute();
    let file: PathBuf = window.path("graph.sabi");
    let Window { harness, folder, .. } = window;
    drop(harness.into_state().documents.document.session);
    fs::write(&file, super::graph_text("")).expect("written");
    let mut window = Window::in_folder(folder, |_| Session::new(None));
    window.settle();
    assert!(window.says("The file was written by another program since"));
    window.press("Recover");
    window.saves();
    assert!(window.says("Another program has written this file"));
    assert_eq!(fs::read_to_string(&file).ok(), Some(super::graph_text("")));
}
