//! The library, favorites, the page of a node and dropped folders.

use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;
use sabi_editing::command::NodeSource;
use sabi_graph::NodeId;

use super::{Editor, Window};
use crate::action::LibraryKind;
use crate::app::library_files::save_to_library;
use crate::dock::Panel;

const GROUPED: &str = r#"{
  "format": "sabi", "version": 1, "name": "Worn edges",
  "groups": { "Wear": { "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/cells" } } } },
  "nodes": { "g": { "kind": "graph/group", "group": "Wear" } }
}"#;

fn kinds(window: &Window) -> Vec<String> {
    let nodes = window.editor().documents.document.graph().nodes();
    nodes.map(|(_, node)| node.kind.clone()).collect()
}

/// Selects the only node.
fn select_only(window: &mut Window) -> NodeId {
    let id = window
        .editor()
        .documents
        .document
        .graph()
        .ids()
        .next()
        .cloned()
        .expect("a node");
    window.harness.state_mut().documents.document.select([id.clone()]);
    window.settle();
    id
}

#[test]
fn the_first_favorites_are_added_by_number_where_the_pointer_is() {
    let mut window = Window::empty();
    window.harness.state_mut().shell.settings.favorites = vec!["noise/cells".to_owned(), "filter/blur".to_owned()];
    window.settle();
    let at = window.on_canvas([0.3, 0.4]);
    window.point(at);
    window.key(Key::Num2);
    assert_eq!(kinds(&window), ["filter/blur"]);
    let place = window.editor().views.canvas.camera.place_at(at).expect("on the canvas");
    let id = window
        .editor()
        .documents
        .document
        .selected_one()
        .cloned()
        .expect("the new node");
    let pos = window
        .editor()
        .documents
        .document
        .node(&id)
        .map(|node| node.pos)
        .expect("a node");
    assert!(
        (pos[0] - place[0]).abs() <= 1.0 && (pos[1] - place[1]).abs() <= 1.0,
        "{pos:?} {place:?}"
    );
    window.key(Key::Num7);
    let said = "Favorite 7 is empty; click a star in the library to fill it.";
    assert!(window.harness.query_by_label(said).is_some());
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_click_on_the_star_adds_a_favorite_and_the_next_one_removes_it() {
    let mut window = Window::empty();
    window.settle();
    window.click("Levels is a favorite");
    assert_eq!(window.editor().shell.settings.favorites, ["adjust/levels"]);
    window.click("Levels is a favorite");
    assert!(window.editor().shell.settings.favorites.is_empty());
}

#[test]
fn a_dragged_entry_is_added_where_it_is_dropped_but_not_outside_of_the_canvas() {
    let mut window = Window::empty();
    window.settle();
    let entry = window.harness.get_by_label("Levels").rect().center();
    let at = window.on_canvas([0.5, 0.5]);
    window.drag(entry, at, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(kinds(&window), ["adjust/levels"]);
    let model = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.drag(entry, model, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_group_is_kept_beside_the_project_with_its_picture_and_used_from_there() {
    let mut window = Window::of(GROUPED);
    let instance = select_only(&mut window);
    window.until("a picture of the group", |editor| {
        editor.picture_of(&editor.reference(&instance, None)).is_some()
    });
    window.click("Save group");
    window.click("To the project library");
    let file = window.path("library").join("wear.sabi");
    assert!(file.is_file());
    let cache = window.editor().folders().cache.clone().expect("a cache");
    assert!(sabi_engine::evaluating::load_thumbnail(&cache, &[&file.to_string_lossy(), "group"]).is_some());
    window.settle();
    assert_eq!(sections_of(&window, "Wear"), ["project library"], "it is listed once");
    // Adding it from the library gives the group that the graph has already.
    let document = &mut window.harness.state_mut().documents.document;
    let named = sabi_editing::library::import(document, &file);
    assert_eq!(named.as_deref(), Some("Wear"));
    assert_eq!(document.contents().groups.len(), 1);
    // Once changed, the group differs from that of the library, and both are listed.
    let document = &mut window.harness.state_mut().documents.document;
    sabi_editing::navigation::enter(document, &instance);
    sabi_editing::nodes::add(document, "noise/simplex", [0.0; 2], None);
    window.settle();
    assert_eq!(sections_of(&window, "Wear"), ["groups here", "project library"]);
}

/// Sections in which groups with a name are listed.
fn sections_of(window: &Window, name: &str) -> Vec<String> {
    let candidates = window.editor().documents.candidates().iter();
    let named = candidates.filter(|candidate| candidate.interface.label == name);
    named.map(|candidate| candidate.section.clone()).collect()
}

#[test]
fn the_library_follows_its_folder_and_reports_unreadable_files() {
    let mut window = Window::of(GROUPED);
    let library = window.path("library");
    std::fs::create_dir_all(&library).expect("a folder");
    let is_there = |editor: &Editor| {
        let mut found = editor.documents.candidates().iter();
        found.any(|candidate| candidate.section == "project library")
    };
    window.until("the watch", |editor| editor.documents.watching.is_watching());
    // Writes the file as another program does.
    let group = r#"{ "format": "sabi", "version": 1, "outputs": { "mask": "n" },
        "nodes": { "n": { "kind": "noise/cells" } } }"#;
    let file = library.join("wear.sabi");
    std::fs::write(&file, group).expect("a file");
    window.until("the group", is_there);
    window.until("the watch", |editor| editor.documents.watching.is_watching());
    std::fs::write(&file, "half of").expect("a file");
    window.until("its end", |editor| !is_there(editor));
    assert!(window.says("wear.sabi"), "{:?}", window.labels());
    std::fs::write(&file, group).expect("a file");
    window.until("the group", is_there);
    assert!(!window.says("wear.sabi"));
}

#[test]
fn a_graph_without_a_file_has_no_library_beside_it() {
    let mut window = Window::untitled();
    window.settle();
    window.click("Save group");
    window.click("To the project library");
    assert!(!window.path("library").exists(), "the entry cannot be chosen");
    let Editor {
        documents,
        evaluation,
        shell,
        ..
    } = window.harness.state_mut();
    save_to_library(documents, evaluation, shell, LibraryKind::Project);
    window.settle();
    let said = "Save the graph first, so that there is a folder beside it.";
    assert!(window.harness.query_by_label(said).is_some());
}

#[test]
fn f1_opens_the_page_of_a_node() {
    let mut window = Window::empty();
    window.add([0.3, 0.3], "levels");
    window.key(Key::F1);
    assert!(window.editor().shell.dock.rects.contains_key(&Panel::Page));
    assert!(window.harness.query_by_label("adjust/levels").is_some());
    assert!(
        window.harness.query_by_label("What Levels gives").is_some(),
        "its picture"
    );
}

#[test]
fn nodes_that_come_with_the_program_have_pictures_in_the_library() {
    let mut window = Window::empty();
    for kind in ["adjust/levels", "noise/cells"] {
        // Asks for the picture as an entry does when it is scrolled into view.
        window.until("a picture", |editor| {
            editor.views.library.picture_of_kind(kind).is_some()
        });
    }
    assert_eq!(window.editor().views.library.picture_of_kind("graph/reroute"), None);
}

#[test]
fn a_group_of_the_graph_has_the_picture_of_an_instance_in_the_library() {
    let mut window = Window::of(GROUPED);
    let instance = select_only(&mut window);
    window.until("a picture", |editor| editor.thumbnail_of(&instance).is_some());
    let context = window.harness.ctx.clone();
    let group = NodeSource::Group("Wear".to_owned());
    let (read, views, _) = window.harness.state_mut().parts();
    assert!(views.library.small_picture(&context, &read, &group).is_some());
}

#[test]
fn a_custom_node_starts_as_a_copy_and_its_faults_are_reported_while_typing() {
    let mut window = Window::of(GROUPED);
    let added = window.add([0.3, 0.6], "levels");
    window.key(Key::F1);
    window.click("Copy as a node of my own");
    assert!(window.harness.query_by_label("Nothing is wrong.").is_some());
    window.fill("Id of the node", "noise/simplex");
    let why = "there is a node 'noise/simplex' already; choose another name";
    assert!(window.harness.query_by_label(why).is_some());
    window.fill("Id of the node", "adjust/mine");
    let text = window.harness.get_by_label("Text of the node").rect();
    window.click_at(text.intersect(window.editor().shell.dock.rects[&Panel::Page]).center());
    window.keys(Modifiers::COMMAND, Key::End);
    window
        .harness
        .event(egui::Event::Text("fn broken() -> f32 { return nothing; }".to_owned()));
    window.settle();
    let is_told = window.harness.query_by_label("Nothing is wrong.").is_none();
    assert!(is_told, "a fault is told at once");
    window.keys(Modifiers::COMMAND, Key::Z);
    window.settle();
    window.click("Save node");
    let file = window.path("nodes").join("adjust").join("mine.wgsl");
    let text = std::fs::read_to_string(&file).expect("the file");
    assert!(text.starts_with("//! Mine\n"), "{text}");
    assert!(window.harness.query_by_label("Saved; nothing is wrong.").is_some());
    window.click("Close");
    window.until("the node among those that can be added", |editor| {
        editor.documents.document.catalog().entry("adjust/mine").is_some()
    });
    assert_eq!(window.editor().documents.document.selected_one(), Some(&added));
}

#[test]
fn a_dropped_folder_becomes_a_material() {
    let mut window = Window::of(GROUPED);
    let folder = window.path("bricks");
    std::fs::create_dir_all(&folder).expect("a folder");
    for name in ["Bricks_diff_1k.png", "Bricks_rough_1k.png", "notes.txt"] {
        std::fs::write(folder.join(name), "").expect("a file");
    }
    window.dropped(&folder);
    let kinds = kinds(&window);
    assert_eq!(
        kinds.iter().filter(|kind| *kind == "source/image").count(),
        2,
        "{kinds:?}"
    );
    assert!(kinds.contains(&"material/combine".to_owned()));
    assert_eq!(window.steps(), 1);
    // The new nodes cover no others and are in view, and their material is shown.
    let canvas = window.editor().shell.dock.rects[&Panel::Canvas];
    let rects: Vec<_> = window
        .document()
        .graph()
        .ids()
        .map(|id| (id.clone(), window.rect(id)))
        .collect();
    for (at, (id, rect)) in rects.iter().enumerate() {
        assert!(canvas.contains_rect(*rect), "{id} is in view");
        let covered = rects[at + 1..].iter().find(|(_, other)| other.intersects(*rect));
        assert_eq!(covered, None, "{id} covers another node");
    }
    let material = window.document().selected_one().expect("the material").clone();
    let shown = window.editor().looks.shown.clone();
    assert_eq!(shown, Some(window.editor().chosen(&material)));
    let empty = window.path("empty");
    std::fs::create_dir_all(&empty).expect("a folder");
    window.dropped(&empty);
    let said = format!("{} holds no pictures", empty.display());
    assert!(window.harness.query_by_label(&said).is_some());
}

impl Window {
    /// Asks for pictures by the menu.
    fn ask_for_pictures(&mut self) {
        self.press("File");
        self.harness.get_by_label_contains("Import pictures").click();
        self.settle();
    }
}

#[test]
fn a_folder_of_pictures_is_imported_by_the_file_menu_as_by_a_drop() {
    let mut window = Window::of(GROUPED);
    let folder = window.path("bricks");
    std::fs::create_dir_all(&folder).expect("a folder");
    for name in ["Bricks_diff_1k.png", "Bricks_rough_1k.png"] {
        std::fs::write(folder.join(name), "").expect("a file");
    }
    window.ask_for_pictures();
    // Either the listed folder is imported, or one whose name is typed, as here.
    window.typed("bricks");
    window.click("Import the folder");
    let found = kinds(&window);
    assert_eq!(
        found.iter().filter(|kind| *kind == "source/image").count(),
        2,
        "{found:?}"
    );
    assert_eq!(window.steps(), 1);
    // A single picture is a node.
    std::fs::write(window.path("rust.png"), "").expect("a file");
    window.ask_for_pictures();
    window.typed("rust.png");
    window.click("Import");
    let added = window.document().selected_one().expect("the picture").clone();
    assert_eq!(window.param(&added, "file").as_deref(), Some("\"rust.png\""));
}

#[test]
fn a_dropped_picture_is_a_node_in_one_step() {
    let mut window = Window::of(GROUPED);
    let before = window.text();
    window.dropped(&window.path("rust.png"));
    let added = window
        .editor()
        .documents
        .document
        .selected_one()
        .cloned()
        .expect("the picture");
    assert_eq!(window.param(&added, "file").as_deref(), Some("\"rust.png\""));
    assert_eq!(window.steps(), 1);
    window.undo(1);
    assert_eq!(window.text(), before);
}

#[test]
fn an_entry_dropped_on_a_wire_is_inserted_into_it_if_it_fits() {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
        "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [500, 0] }
        "#,
    );
    let [clouds, invert] = ["clouds", "invert"].map(super::hands::id);
    let middle = super::hands::between(window.port(&clouds, "mask"), window.port(&invert, "source"));
    let entry = window.harness.get_by_label("Levels").rect().center();
    window.drag(entry, middle, PointerButton::Primary, Modifiers::NONE);
    let added = window
        .editor()
        .documents
        .document
        .selected_one()
        .cloned()
        .expect("the node");
    assert_eq!(window.reads(&added, "source"), "clouds");
    assert_eq!(window.reads(&invert, "source"), added.to_string());
    assert_eq!(window.steps(), 1);
    window.undo(1);
    window.harness.state_mut().shell.settings.favorites = vec!["source/material".to_owned()];
    window.settle();
    let paint = window
        .editor()
        .documents
        .document
        .catalog()
        .entry("source/material")
        .expect("a kind")
        .label
        .clone();
    let paint = window.harness.get_by_label(&paint).rect().center();
    window.drag(paint, middle, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(
        window.reads(&invert, "source"),
        "clouds",
        "what does not fit lies beside it"
    );
    assert_eq!(window.steps(), 1);
}

#[test]
fn an_entry_that_is_dragged_to_the_far_edge_scrolls_the_canvas() {
    let mut window = Window::opened(r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#);
    let entry = window.harness.get_by_label("Levels").rect().center();
    let still = window.screen([0.0, 0.0]);
    let edge = window.on_canvas([0.5, 0.995]);
    let way = [entry, window.on_canvas([0.5, 0.5]), edge];
    window.pull(&way, PointerButton::Primary, Modifiers::NONE);
    window.harness.run_steps(30);
    window.button(edge, PointerButton::Primary, false);
    window.settle();
    let moved = window.screen([0.0, 0.0]) - still;
    assert!(moved.y < -100.0, "the canvas went by: {moved:?}");
    assert_eq!(kinds(&window).len(), 2);
}

#[test]
fn f1_leaves_an_unsaved_draft_which_is_kept_until_the_user_discards_it() {
    let mut window = Window::of(GROUPED);
    window.add([0.3, 0.6], "levels");
    window.key(Key::F1);
    window.click("Copy as a node of my own");
    window.fill("Id of the node", "adjust/mine");
    window.add([0.6, 0.6], "threshold");
    window.key(Key::F1);
    assert!(window.harness.query_by_label("adjust/threshold").is_some());
    assert!(window.harness.query_by_label("Text of the node").is_none());
    window.click("Continue editing adjust/mine");
    assert!(window.harness.query_by_label("Text of the node").is_some());
    window.click("Discard");
    assert!(
        window
            .harness
            .query_by_label("'adjust/mine' has changes that are not saved.")
            .is_some()
    );
    window.click("Keep editing");
    assert!(window.harness.query_by_label("Discard changes").is_none());
    window.click("To the selected node");
    window.click("Continue editing adjust/mine");
    window.click("Discard");
    window.click("Discard changes");
    assert!(window.harness.query_by_label("adjust/threshold").is_some());
    assert!(window.harness.query_by_label("Continue editing adjust/mine").is_none());
}

#[test]
fn the_dots_of_an_entry_are_named_beside_it() {
    let mut window = Window::opened("");
    window.open(Panel::Library);
    window.fill("Search the library", "clouds");
    let entry = window.listed_entry("Clouds").center();
    window.rest_at(entry);
    assert!(window.says("Gives") && window.has("Mask"), "{:?}", window.labels());
}
