//! Protection against loss of work: saving, the questions before it, and recovery copies.

use std::fs;
use std::sync::mpsc::channel;
use std::time::Duration;

use egui::{Key, Modifiers, ViewportEvent, ViewportId};
use sabi_engine::Session;

use super::Window;
use super::hands::id;
use crate::files::system_dialog::{DialogAnswer, SystemDialog};

pub(super) const CLOUDS: &str = r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#;

impl Window {
    /// Types a path into the question for a path, in place of its text.
    pub(super) fn answer_path(&mut self, path: &std::path::Path) {
        self.keys(Modifiers::COMMAND, Key::A);
        self.typed(&path.display().to_string());
        self.key(Key::Enter);
    }

    /// Opens a system dialog with this answer.
    fn opens_dialog(&mut self, answers: impl FnOnce() -> DialogAnswer + Send + 'static) {
        let dialog = SystemDialog::waiting(&self.harness.ctx, answers);
        self.harness.state_mut().views.questions.dialog = Some(dialog);
        self.settle();
    }

    fn is_dirty(&mut self) -> bool {
        self.harness.state_mut().documents.document.session.is_dirty()
    }

    pub(super) fn mute(&mut self) {
        self.harness.state_mut().documents.document.select([id("clouds")]);
        self.point(self.on_canvas([0.9, 0.9]));
        self.key(Key::M);
    }

    /// Asks the window to close, as its close button does. Returns whether it closes.
    pub(super) fn asks_to_close(&mut self) -> bool {
        let viewport = self.harness.input_mut().viewports.entry(ViewportId::ROOT).or_default();
        viewport.events.push(ViewportEvent::Close);
        self.harness.step();
        let commands = &self.harness.output().viewport_output[&ViewportId::ROOT].commands;
        let is_held = commands.contains(&egui::ViewportCommand::CancelClose);
        self.settle();
        !is_held
    }
}

/// Nodes of a graph file. A save also names the model, which is no edit of them.
fn graph_in(file: &std::path::Path) -> sabi_graph::Graph {
    let session = Session::open(file, None).unwrap_or_else(|error| panic!("{error}"));
    session.document().graph.clone()
}

#[test]
fn the_window_goes_on_while_the_systems_dialog_is_open_and_takes_its_answer() {
    let mut window = Window::untitled();
    window.add([0.3, 0.3], "clouds");
    let (answers, answer) = channel::<DialogAnswer>();
    window.keys(Modifiers::COMMAND, Key::S);
    window.opens_dialog(move || answer.recv().unwrap_or(DialogAnswer::NotOpened));
    assert!(window.says("The system's dialog is open"));
    let file = window.path("chosen.sabi");
    let chosen = DialogAnswer::Chosen(file.clone());
    answers.send(chosen).expect("somebody who waits");
    window.until("the answer", |editor| editor.views.questions.open.is_none());
    assert_eq!(window.document().session.file(), Some(&*file));
    assert!(file.exists());
    // A dialog that is closed leaves the question open; one that cannot be opened is reported.
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    for (answer, is_told) in [(DialogAnswer::Closed, false), (DialogAnswer::NotOpened, true)] {
        window.opens_dialog(move || answer);
        window.until("the end of it", |editor| editor.views.questions.dialog.is_none());
        assert!(window.says("Save the graph") && window.has("System dialog…"));
        assert_eq!(window.says("The system's dialog could not be opened"), is_told);
    }
}

#[test]
fn a_system_dialog_that_never_took_the_focus_is_reported_as_not_opened() {
    let mut window = Window::untitled();
    window.keys(Modifiers::COMMAND, Key::S);
    for (takes_focus, is_told) in [(true, false), (false, true)] {
        let (ends, end) = channel::<()>();
        let dialog = SystemDialog::ending(&window.harness.ctx, move || {
            let _ = end.recv();
            (None, Duration::from_secs(12))
        });
        window.harness.state_mut().views.questions.dialog = Some(dialog);
        window.harness.input_mut().focused = !takes_focus;
        window.harness.step();
        window.harness.input_mut().focused = true;
        drop(ends);
        window.until("the end of it", |editor| editor.views.questions.dialog.is_none());
        assert_eq!(window.says("The system's dialog could not be opened"), is_told);
    }
}

#[test]
fn a_graph_is_saved_under_a_name_and_opens_again_as_it_was() {
    let mut window = Window::untitled();
    window.add([0.3, 0.3], "clouds");
    assert!(window.says("untitled •"), "it is marked that something is not saved");
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(window.says("Save the graph"), "a graph without a file asks for one");
    let file = window.path("first");
    window.answer_path(&file);
    let file = file.with_extension("sabi");
    let text = window.text();
    assert_eq!(fs::read_to_string(&file).expect("a file"), text);
    assert!(!window.is_dirty() && window.says("first.sabi") && !window.says("first.sabi •"));
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.answer_path(&window.path("second.sabi"));
    assert_eq!(window.document().session.file(), Some(&*window.path("second.sabi")));
    window.keys(Modifiers::COMMAND, Key::N);
    assert!(window.document().session.file().is_none() && window.text() != text);
    window.keys(Modifiers::COMMAND, Key::O);
    window.answer_path(&file);
    assert_eq!(window.text(), text);
    let recent = &window.editor().shell.settings.recent;
    let names: Vec<_> = recent.iter().filter_map(|path| path.file_name()).collect();
    assert_eq!(names, ["first.sabi", "second.sabi"], "the last one first");
}

#[test]
fn undo_continues_past_a_save_and_the_earlier_file_is_kept() {
    let mut window = Window::opened(CLOUDS);
    let first = window.document().contents().graph.clone();
    window.mute();
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(!window.is_dirty());
    let backup = fs::read_to_string(window.path("graph.sabi.bak")).expect("a backup");
    assert_eq!(backup, super::graph_text(CLOUDS), "as it was, down to its spaces");
    window.undo(1);
    assert!(window.is_dirty());
    assert!(window.document().contents().graph == first);
}

#[test]
fn opening_another_graph_asks_about_unsaved_changes() {
    let mut window = Window::opened(CLOUDS);
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.mute();
    let changed = window.text();
    window.keys(Modifiers::COMMAND, Key::O);
    window.answer_path(&other);
    assert!(window.says("There are changes that are not saved"));
    window.press("Cancel");
    assert_eq!(window.text(), changed, "nothing happened");
    window.keys(Modifiers::COMMAND, Key::N);
    window.press("Discard");
    assert_eq!(window.document().graph().len(), 2);
    assert_eq!(
        fs::read_to_string(window.path("graph.sabi")).expect("a file"),
        super::graph_text(CLOUDS)
    );
    window.keys(Modifiers::COMMAND, Key::O);
    window.answer_path(&window.path("graph.sabi"));
    window.mute();
    window.keys(Modifiers::COMMAND, Key::O);
    window.answer_path(&other);
    let changed = window.document().contents().graph.clone();
    window.press("Save");
    assert!(graph_in(&window.path("graph.sabi")) == changed);
    assert_eq!(window.document().session.file(), Some(&*other));
}

#[test]
fn a_graph_without_a_file_is_saved_before_another_one_replaces_it() {
    let mut window = Window::untitled();
    window.add([0.3, 0.3], "clouds");
    let graph = window.document().contents().graph.clone();
    window.keys(Modifiers::COMMAND, Key::N);
    window.press("Save");
    assert!(window.says("Save the graph"));
    let file = window.path("kept.sabi");
    window.answer_path(&file);
    assert!(graph_in(&file) == graph, "what was there, and not what came after");
    assert_eq!(window.document().graph().len(), 2);
}

#[test]
fn work_that_could_not_be_saved_stays_open() {
    let mut window = Window::untitled();
    window.add([0.3, 0.3], "clouds");
    let text = window.text();
    fs::write(window.path("taken"), "a file").expect("a file");
    window.keys(Modifiers::COMMAND, Key::N);
    window.press("Save");
    window.answer_path(&window.path("taken").join("kept.sabi"));
    assert_eq!(window.text(), text);
    assert!(window.is_dirty());
    // Without a name nothing is saved.
    window.keys(Modifiers::COMMAND, Key::N);
    window.press("Save");
    window.key(Key::Escape);
    assert_eq!(window.text(), text);
    window.add([0.3, 0.6], "dots");
    window.keys(Modifiers::COMMAND, Key::S);
    window.answer_path(&window.path("later.sabi"));
    assert_eq!(
        window.document().graph().len(),
        2,
        "an answer that was not given is forgotten"
    );
}

#[test]
fn a_window_with_changes_asks_before_it_closes() {
    let mut window = Window::opened(CLOUDS);
    window.mute();
    assert!(!window.asks_to_close());
    assert!(window.says("There are changes that are not saved"));
    window.press("Cancel");
    assert!(!window.asks_to_close());
    window.press("Save");
    assert!(!window.is_dirty());
    assert!(window.editor().may_close);
    assert!(window.asks_to_close());
}

#[test]
fn unsaved_work_is_kept_and_offered_to_the_next_window() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.mute();
    let text = window.text();
    let unsaved = window.path("unsaved");
    let is_kept = || fs::read_dir(&unsaved).is_ok_and(|files| files.count() == 2);
    window.until("the work, and what says that it is in use", |_| is_kept());
    let mut window = window.after_a_crash();
    assert!(window.says("The program ended before this was saved"));
    assert!(window.says("graph.sabi"));
    window.press("Recover");
    assert_eq!(window.text(), text);
    assert!(window.is_dirty());
    let graph = window.document().contents().graph.clone();
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(graph_in(&window.path("graph.sabi")) == graph);
    assert_eq!(
        fs::read_dir(&unsaved).expect("a folder").count(),
        0,
        "nothing is left to recover"
    );
}

#[test]
fn a_recovery_copy_is_written_in_the_frame_in_which_a_node_is_added() {
    let mut window = Window::opened(CLOUDS);
    window.settle();
    window.harness.state_mut().documents.autosave.every = Duration::from_secs(3600);
    window.add([0.2, 0.2], "cells");
    let text = window.text();
    let mut window = window.after_a_crash();
    window.press("Recover");
    assert_eq!(window.text(), text);
}

#[test]
fn settings_and_recent_files_are_kept_for_the_next_window() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.keys(Modifiers::COMMAND, Key::Equals);
    window.keys(Modifiers::COMMAND, Key::S);
    window.settle();
    let folder = window.folder;
    drop(window.harness);
    let window = Window::in_folder(folder, |_| Session::new(None));
    assert!((window.editor().shell.settings.scale - 1.1).abs() < 1e-3);
    assert_eq!(window.editor().shell.settings.recent.len(), 1);
}

#[test]
fn a_saved_graph_opens_again_on_the_model_that_it_was_worked_on() {
    let mut window = Window::opened(CLOUDS);
    let model = window.path("hero.glb");
    std::fs::copy(window.editor().evaluation.model.file(), &model).expect("a model");
    window.keys(Modifiers::COMMAND, Key::S);
    let named = |window: &Window| {
        let session = Session::open(&window.path("graph.sabi"), None).expect("a graph");
        session.document().preview.clone().and_then(|preview| preview.mesh)
    };
    assert_eq!(
        named(&window).as_deref(),
        Some("examples/cube.glb"),
        "it comes with the program"
    );
    window.harness.state_mut().models().take(&model);
    window.settle();
    window.keys(Modifiers::COMMAND, Key::S);
    assert_eq!(named(&window).as_deref(), Some("hero.glb"));
}

#[test]
fn a_graph_on_a_built_in_model_names_it_without_a_path_and_opens_on_it_anywhere() {
    let mut window = Window::opened(CLOUDS);
    let examples = window.editor().documents.folders.examples.clone().expect("a folder");
    let own = crate::files::examples::first_model(&examples).expect("a model");
    window.harness.state_mut().models().take(&own);
    window.until("the model", |editor| {
        editor.evaluation.model.file().ends_with("bench.glb")
    });
    window.keys(Modifiers::COMMAND, Key::S);
    let text = fs::read_to_string(window.path("graph.sabi")).expect("a graph");
    assert!(text.contains(r#""mesh": "builtin:bench""#), "{text}");
    // A save to another place keeps the name, and another computer has the model in another folder.
    let other = Window::with(|folders| {
        let file = super::beside(folders).join("sent.sabi");
        fs::write(&file, &text).expect("a graph");
        Session::open(&file, None).expect("a graph")
    });
    let named = other.editor().documents.named_model().expect("a model");
    assert!(named.ends_with("examples/assets/meshes/bench.glb") && named.is_file());
    assert_ne!(named, own);
    assert!(sabi_editing::missing_files::missing(other.document()).is_empty());
}

#[test]
fn unsaved_work_is_kept_when_the_system_ends_the_program() {
    let mut window = Window::opened(CLOUDS);
    window.mute();
    let text = window.text();
    // The system ends the program: nothing is asked, but changes are kept.
    eframe::App::on_exit(window.harness.state_mut());
    let mut window = window.after_a_crash();
    assert!(window.says("The program ended before this was saved"));
    window.press("Recover");
    assert_eq!(window.text(), text);
    // Discarded changes are not kept.
    window.harness.state_mut().may_close = true;
    eframe::App::on_exit(window.harness.state_mut());
    assert!(sabi_engine::session::recoveries(&window.path("unsaved")).is_empty());
}

#[test]
fn a_save_keeps_the_redo_steps() {
    let mut window = Window::opened(CLOUDS);
    let model = window.path("other.obj");
    fs::write(&model, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a model");
    window.mute();
    window.harness.state_mut().models().take(&model);
    window.undo(1);
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(window.text().contains("other.obj"), "the graph opens on it again");
    window.redo(1);
    let redone = window.text();
    assert!(redone.contains("other.obj") && redone.contains("muted"), "{redone}");
}

#[test]
fn a_save_on_a_substitute_model_keeps_the_model_that_the_graph_names() {
    let mut window = Window::opened("");
    window.until("the model", |editor| editor.evaluation.model.loaded().1);
    let other = window.path("other.sabi");
    let text = r#"{ "format": "sabi", "version": 1, "preview": { "mesh": "gone.glb" }, "nodes": {} }"#;
    fs::write(&other, text).expect("a graph");
    let session = Session::open(&other, None).expect("a graph that can be read");
    window.harness.state_mut().take_session(session);
    window.until("the cube again", |editor| {
        editor.evaluation.model.refused().is_some() && editor.evaluation.model.loaded().1
    });
    window.keys(Modifiers::COMMAND, Key::S);
    let saved = fs::read_to_string(&other).expect("a graph");
    assert!(saved.contains("gone.glb"), "{saved}");
}
