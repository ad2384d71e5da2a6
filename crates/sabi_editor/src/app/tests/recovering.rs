//! Work that was not saved when a program ended is offered again: on the start page, and when its file is opened.

use std::fs;
use std::time::Duration;

use egui::Key;
use sabi_engine::Session;

use super::safety::CLOUDS;
use super::{ProgramFolders, Window, beside};
use crate::files::Question;

/// A window with unsaved work on `graph.sabi`. Returns it with the text of the work.
fn worked() -> (Window, String) {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.mute();
    window.settle();
    let text = window.text();
    (window, text)
}

fn open(folders: &ProgramFolders) -> Session {
    let file = beside(folders).join("graph.sabi");
    Session::open(&file, folders.recovery.as_deref()).expect("a graph that can be read")
}

#[test]
fn work_of_a_program_that_is_still_ending_is_offered_once_it_has_ended() {
    let (window, text) = worked();
    // Stands for a killed process, whose locks the system holds for a while.
    let ending = window.harness.into_state().documents.document.session;
    let mut next = Window::in_folder(window.folder, open);
    next.settle();
    assert!(next.says("This graph is open already"));
    assert!(!next.editor().views.start.is_open);
    drop(ending);
    next.until("the offer", |editor| {
        matches!(editor.views.questions.open, Some(Question::Recover { .. }))
    });
    assert!(!next.says("for reading only"), "the file is its own again");
    assert!(next.says("There is unsaved work on this graph"));
    next.press("Recover the changes");
    assert_eq!(next.text(), text);
}

#[test]
fn work_of_a_program_that_is_still_ending_appears_on_the_start_page() {
    let (window, _) = worked();
    let ending = window.harness.into_state().documents.document.session;
    let mut next = Window::in_folder(window.folder, |folders| Session::new(folders.recovery.as_deref()));
    next.settle();
    assert!(!next.editor().views.start.is_open);
    drop(ending);
    next.until("the start page", |editor| editor.views.start.is_open);
    assert!(next.says("The program ended before this was saved") && next.has("Recover"));
}

#[test]
fn unsaved_work_is_offered_whenever_its_file_is_opened() {
    let (window, text) = worked();
    let mut window = window.after_a_crash();
    let file = window.path("graph.sabi");
    let saved = Session::open(&file, None).expect("a graph").text().to_owned();
    for answer in ["Open the file as it was saved", "Recover the changes"] {
        window.key(Key::Escape);
        window.harness.state_mut().open_file(&file);
        window.settle();
        assert!(window.says("There is unsaved work on this graph"), "{answer}");
        window.press(answer);
        let is_recovered = answer.starts_with("Recover");
        assert_eq!(
            window.text(),
            if is_recovered { text.clone() } else { saved.clone() },
            "{answer}"
        );
    }
    assert!(window.editor().documents.recoveries.found.is_empty());
}

#[test]
fn a_file_of_another_window_can_be_saved_once_that_window_is_closed() {
    let mut first = None;
    let mut window = Window::with(|folders| {
        let file = beside(folders).join("graph.sabi");
        fs::write(&file, super::graph_text(CLOUDS)).expect("a graph");
        let mut session = Session::open(&file, None).expect("a graph that can be read");
        assert!(session.graph_file.claim());
        first = Some(session);
        open(folders)
    });
    window.settle();
    window.press("Open it for reading only");
    drop(first);
    window.mute();
    let text = window.text();
    window.harness.state_mut().saving().save();
    window.settle();
    assert!(!window.says("This graph is open already"));
    assert!(
        fs::read_to_string(window.path("graph.sabi")).is_ok_and(|saved| saved.contains("muted")),
        "{text}"
    );
}

#[test]
fn a_graph_that_was_never_saved_comes_back_on_its_model() {
    let mut window = Window::with(|folders| Session::new(folders.recovery.as_deref()));
    let model = window.path("hero.glb");
    fs::copy(window.editor().evaluation.model.file(), &model).expect("a model");
    window.harness.state_mut().models().take_chosen(&model);
    window.settle();
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.add([0.2, 0.2], "cells");
    window.settle();
    let mut window = window.after_a_crash();
    window.press("Recover");
    window.settle();
    let shown = window.editor().evaluation.model.file();
    assert_eq!(shown, model.canonicalize().expect("a model"));
}
