//! Protection against loss of work: when a graph is opened, a file is replaced, and the window closes.

use std::fs;
use std::time::Duration;

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sabi_editing::{navigation, nodes, selection};
use sabi_engine::Session;

use super::safety::CLOUDS;
use super::{Editor, Window};
use crate::action::{ExportAction, LibraryKind};
use crate::app::library_files::save_to_library;
use crate::command::WindowCommand;
use crate::dock::Panel;

#[test]
fn a_recent_file_is_opened_only_after_the_question_about_unsaved_changes() {
    let mut window = Window::opened(CLOUDS);
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.harness.state_mut().shell.settings.remember(&other);
    window.mute();
    window.press("File");
    let recent = window.harness.get_by_label_contains("Recent").rect().center();
    window.point(recent);
    window.click_at(recent);
    window.press(&other.canonicalize().expect("a file").display().to_string());
    assert!(
        window.says("There are changes that are not saved"),
        "{:?}",
        window.labels()
    );
    window.press("Discard");
    assert_eq!(window.document().graph().len(), 0);
}

#[test]
fn another_graph_is_evaluated_as_soon_as_it_is_open() {
    let mut window = Window::opened("");
    window.until("rest", |editor| {
        !editor.evaluation.is_busy() && editor.views.model.pictures.drawn > 0
    });
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text(CLOUDS)).expect("a graph");
    window.harness.state_mut().open_file(&other);
    let clouds = window.editor().reference(&super::hands::id("clouds"), None);
    window.until("a picture of its node", |editor| {
        editor.evaluation.results.thumbnail(&clouds).is_some()
    });
}

#[test]
fn a_graph_that_is_opened_again_shows_its_pictures_again() {
    let mut window = Window::opened(CLOUDS);
    let clouds = window.editor().reference(&super::hands::id("clouds"), None);
    window.until("a picture", |editor| {
        editor.evaluation.results.thumbnail(&clouds).is_some()
    });
    let file = window.path("graph.sabi");
    window.harness.state_mut().open_file(&file);
    window.until("the picture again", |editor| {
        editor.evaluation.results.thumbnail(&clouds).is_some()
    });
}

#[test]
fn the_file_of_another_graph_is_not_replaced_without_a_question() {
    let mut window = Window::opened(CLOUDS);
    let other = window.path("other.sabi");
    fs::write(&other, "theirs").expect("a file");
    let save_as = |window: &mut Window| {
        window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
        window.answer_path(&other);
    };
    save_as(&mut window);
    assert!(window.says("This file exists already"));
    assert_eq!(fs::read_to_string(&other).expect("a file"), "theirs");
    window.press("Another name…");
    assert!(window.says("Save the graph"), "the path can be changed");
    window.key(Key::Escape);
    save_as(&mut window);
    window.press("Replace it");
    assert_eq!(fs::read_to_string(&other).expect("a file"), window.text());
    assert_eq!(
        fs::read_to_string(window.path("other.sabi.bak")).expect("a file"),
        "theirs"
    );
    // The graph's own file is replaced without a question.
    window.mute();
    save_as(&mut window);
    assert!(!window.says("This file exists already"));
}

#[test]
fn a_graph_saved_under_the_name_of_a_picture_gets_its_own_ending() {
    let mut window = Window::opened(CLOUDS);
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.answer_path(&window.path("wood.png"));
    assert!(!window.path("wood.png").exists());
    assert_eq!(window.document().session.file(), Some(&*window.path("wood.png.sabi")));
}

#[test]
fn a_group_in_the_library_is_not_replaced_by_another_of_the_same_name() {
    let mut window = Window::opened(CLOUDS);
    window
        .harness
        .state_mut()
        .documents
        .document
        .select([super::hands::id("clouds")]);
    window.keys(Modifiers::COMMAND, Key::G);
    let keep = |window: &mut Window| {
        let Editor {
            documents,
            evaluation,
            shell,
            ..
        } = window.harness.state_mut();
        save_to_library(documents, evaluation, shell, LibraryKind::User);
        window.settle();
        fs::read_dir(window.path("library")).expect("a library").count()
    };
    assert_eq!(keep(&mut window), 1);
    assert_eq!(keep(&mut window), 1, "the same is kept once");
    let instance = window.document().selected_one().cloned().expect("the group");
    assert!(navigation::enter(
        &mut window.harness.state_mut().documents.document,
        &instance
    ));
    selection::select_all(&mut window.harness.state_mut().documents.document);
    nodes::toggle_muted(&mut window.harness.state_mut().documents.document);
    navigation::leave(&mut window.harness.state_mut().documents.document);
    window.harness.state_mut().documents.document.select([instance]);
    assert_eq!(keep(&mut window), 2);
}

#[test]
fn the_window_stays_open_until_textures_are_written() {
    let mut window = Window::opened(
        r##""clouds": { "kind": "noise/simplex" }, "layer": { "kind": "effect/layer", "inputs": { "mask": "clouds" },
            "params": { "color": "#6b3a1e" } }, "out": { "kind": "output/material", "inputs": { "material": "layer" } }"##,
    );
    let editor = window.harness.state_mut();
    editor.shell.settings.export.size = 512;
    editor.exports.place.folder = "maps".to_owned();
    editor.perform_export(ExportAction::Start { force: false });
    assert!(!window.asks_to_close());
    assert!(window.says("An export is running"));
    window.press("Keep the window open");
    assert!(!window.editor().may_close);
    assert!(!window.asks_to_close());
    window.until("the end", |editor| editor.may_close);
    assert!(window.asks_to_close());
    assert!(window.path("maps").is_dir());
}

/// A window that is exporting, and exports again at every save.
fn exporting_at_every_save() -> Window {
    let mut window = Window::opened(
        r#""clouds": { "kind": "noise/simplex" },
        "out": { "kind": "output/mask", "inputs": { "source": "clouds" }, "params": { "name": "clouds" } }"#,
    );
    let editor = window.harness.state_mut();
    editor.shell.settings.export.size = 512;
    editor.exports.place.folder = "maps".to_owned();
    editor.exports.place.again = true;
    editor.perform_export(ExportAction::Start { force: false });
    window
}

#[test]
fn a_save_during_an_export_exports_once_more() {
    let mut window = exporting_at_every_save();
    let editor = window.harness.state_mut();
    editor.saving().save();
    assert!(!window.editor().exports.queued.is_empty());
    window.until("both", |editor| {
        editor.exports.running.is_none() && editor.exports.queued.is_empty()
    });
}

#[test]
fn the_export_folder_of_each_graph_is_remembered_by_the_next_window() {
    let mut window = Window::opened(CLOUDS);
    let first = window.path("graph.sabi");
    let other = window.path("other.sabi");
    fs::write(&other, super::graph_text("")).expect("a graph");
    let place = &mut window.harness.state_mut().exports.place;
    (place.folder, place.again) = ("maps".to_owned(), true);
    window.harness.state_mut().open_file(&other);
    let place = &window.editor().exports.place;
    assert!(place.folder == "other-textures" && !place.again, "{place:?}");
    window.harness.state_mut().open_file(&first);
    assert_eq!(window.editor().exports.place.folder, "maps");
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.settle();
    let folder = window.folder;
    drop(window.harness);
    let window = Window::in_folder(folder, |_| Session::open(&first, None).expect("a graph"));
    assert_eq!(window.editor().exports.place.folder, "maps");
}

#[test]
fn a_window_with_an_unsaved_node_file_stays_open() {
    let mut window = Window::opened(CLOUDS);
    window
        .harness
        .state_mut()
        .documents
        .document
        .select([super::hands::id("clouds")]);
    window.key(Key::F1);
    window.press("Copy as a node of my own");
    assert!(window.asks_to_close(), "nothing was written yet");
    window.fill("Id of the node", "noise/mine");
    assert!(!window.asks_to_close());
    assert!(window.says("The text of a node is not saved"));
}

#[test]
fn an_unsaved_node_file_is_recovered_whether_or_not_the_graph_was_changed() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window
        .harness
        .state_mut()
        .documents
        .document
        .select([super::hands::id("clouds")]);
    window.key(Key::F1);
    window.press("Copy as a node of my own");
    window.fill("Id of the node", "noise/mine");
    window.settle();
    // A save deletes only the recovery copy of the graph.
    window.keys(Modifiers::COMMAND, Key::S);
    window.settle();
    let unsaved = window.editor().views.page.unsaved();
    assert_eq!(unsaved.len(), 1);
    let mut window = window.after_a_crash();
    assert!(window.says("the node file noise/mine"));
    window.press("Recover");
    assert_eq!(window.editor().views.page.unsaved(), unsaved);
    window.harness.state_mut().shell.dock.bring_up(Panel::Page);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.settle();
    assert!(!window.asks_to_close(), "it is still in no file");
    window.press("Save node");
    let file = window.path("nodes").join("noise").join("mine.wgsl");
    assert_eq!(fs::read_to_string(file).expect("a file"), unsaved[0].text);
    window.settle();
    assert_eq!(fs::read_dir(window.path("unsaved")).expect("a folder").count(), 0);
}

#[test]
fn a_recovered_node_file_is_kept_beside_another_unsaved_version_of_it() {
    let mut window = Window::opened(CLOUDS);
    let draft = |text: &str| sabi_engine::catalog::node_file::NodeDraft {
        folder: window.path("nodes"),
        id: "noise/mine".to_owned(),
        text: text.to_owned(),
        known: None,
    };
    let (first, second) = (draft("//! First"), draft("//! Second"));
    first.save(&sabi_files::Disk::default()).expect("a file");
    let Editor { views, documents, .. } = window.harness.state_mut();
    let (page, document) = (&mut views.page, &documents.document);
    page.recover(vec![first.clone()], document);
    page.recover(vec![second.clone()], document);
    assert_eq!(page.unsaved(), [first.clone(), second.clone()], "both are kept");
    page.saved(&first);
    assert_eq!(
        page.unsaved(),
        std::slice::from_ref(&second),
        "the other one is in no file"
    );
    page.recover(vec![second.clone()], document);
    assert_eq!(page.unsaved(), [second.clone(), second]);
}

#[test]
fn an_unreadable_recovery_file_is_listed_until_it_is_discarded() {
    let folder = tempfile::tempdir().expect("a folder");
    let unsaved = folder.path().join("unsaved");
    fs::create_dir_all(&unsaved).expect("a folder");
    fs::write(unsaved.join("1-1-1.recovery"), "half of").expect("a file");
    let mut window = Window::in_folder(folder, |_| Session::new(None));
    window.settle();
    assert!(window.says("the recovery file cannot be read"));
    assert!(!window.has("Recover"));
    window.press("Discard");
    window.press("Discard permanently");
    assert!(!window.says("the recovery file cannot be read"));
    assert_eq!(fs::read_dir(&unsaved).expect("a folder").count(), 0);
}

#[test]
fn the_start_page_stays_in_view_however_many_recoveries_are_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let unsaved = folder.path().join("unsaved");
    fs::create_dir_all(&unsaved).expect("a folder");
    for session in 0..60 {
        let text = format!(
            r#"{{ "file": null, "graph": {:?}, "drafts": [] }}"#,
            r#"{"format":"sabi","version":1,"nodes":{}}"#
        );
        fs::write(unsaved.join(format!("1-{session}-0.recovery")), text).expect("a file");
    }
    let mut window = Window::in_folder(folder, |_| Session::new(None));
    window.settle();
    let screen = window.harness.ctx.content_rect();
    let below = window.harness.get_by_label("Empty graph").rect();
    assert!(screen.contains_rect(below), "{below} in {screen}");
}

#[test]
fn keys_of_the_window_work_while_text_is_typed_but_letters_run_no_commands() {
    let mut window = Window::opened(CLOUDS);
    window.mute();
    let text = window.text();
    window.open(Panel::Library);
    let field = window.editor().shell.dock.rects[&Panel::Library];
    let at = window.harness.get_by_label("Search the library").rect().center();
    assert!(field.contains(at));
    window.click_at(at);
    window.keys(Modifiers::COMMAND, Key::S);
    let saved = fs::read_to_string(window.path("graph.sabi")).expect("a file");
    assert!(saved != text && saved == window.text(), "with the name of the model");
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), saved, "the step is the text's");
}

#[test]
fn showing_a_panel_that_the_use_view_lacks_ends_that_view() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().window_command(WindowCommand::UseView);
    window.settle();
    window.harness.state_mut().shell.dock.bring_up(Panel::Export);
    assert!(window.editor().is_use_view());
    window.keys(Modifiers::NONE, Key::F1);
    assert!(!window.editor().is_use_view());
    assert!(window.editor().shell.dock.rects.contains_key(&Panel::Page));
}

#[test]
fn a_recovery_file_can_be_discarded_once_no_window_uses_it() {
    let mut window = Window::opened(CLOUDS);
    window.harness.state_mut().documents.autosave.every = Duration::ZERO;
    window.mute();
    let unsaved = window.path("unsaved");
    assert!(sabi_engine::session::recoveries(&unsaved).is_empty(), "it is in use");
    let mut window = window.after_a_crash();
    assert!(window.says("graph.sabi"));
    window.press("Discard");
    window.press("Discard permanently");
    assert!(!window.says("The program ended before this was saved"));
    assert!(sabi_engine::session::recoveries(&unsaved).is_empty());
}

#[test]
fn settings_that_cannot_be_read_are_put_aside() {
    let window = Window::opened(CLOUDS);
    let Window { harness, folder, .. } = window;
    drop(harness);
    let settings = folder.path().join("settings");
    fs::create_dir_all(&settings).expect("a folder");
    fs::write(settings.join("settings.json"), r#"{ "shade": "Purple" }"#).expect("settings");
    let mut window = Window::in_folder(folder, |_| Session::new(None));
    window.settle();
    assert!(window.says("The settings could not be read"), "{:?}", window.labels());
    let aside = fs::read_to_string(settings.join("settings.json.bak")).expect("put aside");
    assert!(aside.contains("Purple"));
}

#[test]
fn the_title_of_the_window_names_the_graph() {
    let mut window = Window::opened(CLOUDS);
    window.settle();
    assert_eq!(window.editor().shell.title, "graph.sabi – Sabi");
    window.mute();
    assert_eq!(window.editor().shell.title, "graph.sabi • – Sabi");
}

#[test]
fn textures_of_a_saved_graph_are_written_although_another_one_is_opened_meanwhile() {
    let mut window = exporting_at_every_save();
    let editor = window.harness.state_mut();
    // The second export has other file names, which shows that it ran.
    editor.shell.settings.export.names = "saved_{channel}".to_owned();
    editor.saving().save();
    let other = window.path("deeper").join("other.sabi");
    fs::create_dir_all(window.path("deeper")).expect("a folder");
    fs::write(&other, super::graph_text("")).expect("a graph");
    window.harness.state_mut().open_file(&other);
    window.until("both", |editor| {
        editor.exports.running.is_none() && editor.exports.queued.is_empty()
    });
    let written = fs::read_dir(window.path("maps")).expect("a folder").flatten();
    let names: Vec<_> = written
        .map(|file| file.file_name().to_string_lossy().into_owned())
        .collect();
    assert!(names.iter().any(|name| name.starts_with("saved_")), "{names:?}");
    assert!(!window.path("deeper").join("maps").exists());
}
