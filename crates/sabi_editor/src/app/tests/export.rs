//! Exports from the window.

use std::fs;
use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::id;
use crate::action::FileAction;
use sabi_editing::{exposed_knobs, exposed_values, nodes, variants};
use sabi_graph::Value;

use crate::dock::Panel;

const LAYERED: &str = r##"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "layer": { "kind": "effect/layer", "inputs": { "mask": "clouds" }, "params": { "color": "#6b3a1e" },
        "pos": [260, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "layer" }, "pos": [520, 0] }
"##;

fn maps_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut maps: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    maps.retain(|path| {
        path.extension()
            .is_some_and(|ending| ending == "png" || ending == "exr")
    });
    maps
}

/// A window with the export panel in front and a folder named.
fn ready() -> Window {
    let mut window = Window::opened(LAYERED);
    window.harness.state_mut().shell.settings.export.size = 64;
    window.open(Panel::Export);
    let panel = window.editor().shell.dock.rects[&Panel::Export];
    let found = window.harness.query_all_by_label("Folder").map(|node| node.rect());
    let field = found
        .filter(|rect| panel.contains(rect.center()))
        .max_by(|one, other| one.width().total_cmp(&other.width()));
    let field = field.expect("a field for the folder").center();
    window.click_at(field);
    // Replaces the proposed folder.
    window.keys(Modifiers::COMMAND, Key::A);
    window.typed("maps");
    window
}

#[test]
fn maps_are_written_to_the_folder_that_was_named() {
    let mut window = ready();
    let folder = window.path("maps");
    window.press("Export");
    window.until("the maps", |editor| editor.exports.running.is_none());
    assert!(window.says("Written to"), "{:?}", window.labels());
    let maps = maps_in(&folder);
    assert!(
        maps.iter().any(|path| path.to_string_lossy().contains("base_color")),
        "{maps:?} {:?}",
        window.labels()
    );
    // Exports again at every save, whatever panel is in front.
    for map in &maps {
        fs::remove_file(map).expect("removed");
    }
    let switch = |window: &Window| {
        let found = window
            .harness
            .get_by_role_and_label(Role::CheckBox, "Export at every save");
        found.scroll_to_me();
        found.rect().center()
    };
    switch(&window);
    window.settle();
    let place = switch(&window);
    window.click_at(place);
    assert!(window.editor().exports.place.again);
    window.open(Panel::Parameters);
    for detail in ["3", "4"] {
        window.click_at(window.title(&id("clouds")));
        window.set_number("Detail", detail);
        window.keys(Modifiers::COMMAND, Key::S);
        window.until("the maps again", |editor| editor.exports.running.is_none());
        assert!(!maps_in(&folder).is_empty(), "after a save with {detail}");
        fs::remove_dir_all(&folder).expect("removed");
    }
}

#[test]
fn a_material_without_any_pattern_says_why_there_are_no_maps() {
    let mut window = ready();
    window.harness.state_mut().documents.document.select([id("clouds")]);
    nodes::delete(&mut window.harness.state_mut().documents.document, false);
    window.press("Export");
    window.until("the end", |editor| editor.exports.running.is_none());
    assert!(
        window.says("Every channel is the same everywhere"),
        "{:?}",
        window.labels()
    );
    assert!(maps_in(&window.path("maps")).is_empty());
}

#[test]
fn the_documents_of_a_preset_are_listed_before_and_after_they_are_written() {
    let mut window = ready();
    window.harness.state_mut().shell.settings.export.preset = "usd".to_owned();
    window.harness.step();
    window.press("Files for USD");
    assert!(window.says("(model).usdz"), "{:?}", window.labels());
    window.press("Export");
    window.until("the maps", |editor| editor.exports.running.is_none());
    let written = fs::read_dir(window.path("maps")).expect("a folder").flatten();
    let mut documents: Vec<String> = written
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.contains(".usd"))
        .collect();
    documents.sort();
    assert_eq!(documents.len(), 2, "{documents:?}");
    assert!(documents.iter().all(|name| window.says(name)), "{:?}", window.labels());
}

#[test]
fn an_export_is_canceled_and_leaves_nothing() {
    let mut window = ready();
    window.harness.state_mut().shell.settings.export.size = 4096;
    window.press("Export");
    assert!(window.editor().exports.running.is_some());
    window.press("Cancel");
    window.until("the end", |editor| editor.exports.running.is_none());
    assert!(maps_in(&window.path("maps")).is_empty());
    assert!(!window.says("Written to"));
}

#[test]
fn an_export_that_waits_for_another_bake_of_its_folder_says_so_and_can_be_canceled() {
    let mut window = ready();
    let own = window.path("maps").join(".sabi");
    fs::create_dir_all(&own).expect("a folder");
    let lock = fs::File::create(own.join("lock")).expect("a file");
    lock.lock().expect("a lock, as another bake has it");
    window.press("Export");
    window.until("the sentence", |editor| {
        let running = editor.exports.running.as_ref();
        running.is_some_and(|running| running.waits_for().is_some())
    });
    assert!(
        window.says("Waiting for another bake, which writes into"),
        "{:?}",
        window.labels()
    );
    window.press("Cancel");
    window.until("the end", |editor| editor.exports.running.is_none());
    assert!(maps_in(&window.path("maps")).is_empty());
    window.press("Export");
    window.until("the sentence", |editor| {
        let running = editor.exports.running.as_ref();
        running.is_some_and(|running| running.waits_for().is_some())
    });
    drop(lock);
    window.until("the maps", |editor| editor.exports.running.is_none());
    assert!(!window.says("Waiting for another bake"), "{:?}", window.labels());
    assert!(!maps_in(&window.path("maps")).is_empty());
}

#[test]
fn a_refused_export_says_why() {
    let mut window = Window::opened(r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#);
    window.open(Panel::Export);
    window.harness.state_mut().exports.place.folder.clear();
    window.press("Export");
    assert!(window.says("Choose a folder for the textures first"));
    window.harness.state_mut().exports.place.folder = "maps".to_owned();
    window.press("Export");
    window.until("the end", |editor| editor.exports.running.is_none());
    assert!(window.says("output"), "{:?}", window.labels());
}

#[test]
fn chosen_channels_are_written_under_the_names_that_were_asked_for() {
    let mut window = ready();
    let export = &mut window.harness.state_mut().shell.settings.export;
    export.channels = vec!["base_color".to_owned()];
    export.names = "{channel".to_owned();
    window.settle();
    assert!(window.says("a brace is opened and not closed"), "{:?}", window.labels());
    window.harness.state_mut().shell.settings.export.names = "T_{graph}_{channel}_{size}".to_owned();
    window.settle();
    assert!(!window.says("a brace is opened"));
    window.press("Export");
    window.until("the maps", |editor| editor.exports.running.is_none());
    let file = window.path("maps").join("T_graph_base_color_64.png");
    assert_eq!(maps_in(&window.path("maps")), [file]);
}

#[test]
fn exporting_to_a_folder_with_foreign_files_is_asked_about() {
    let mut window = ready();
    let folder = window.path("maps");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("thesis.doc"), "").expect("a file");
    window.press("Export");
    assert!(
        window.says("none of them is a map of this graph"),
        "{:?}",
        window.labels()
    );
    assert!(window.editor().exports.running.is_none());
    window.press("Write the textures there anyway");
    window.until("the maps", |editor| editor.exports.running.is_none());
    assert!(!maps_in(&folder).is_empty());
    assert!(folder.join("thesis.doc").exists());
    window.press("Export");
    // A quick export may have ended already.
    assert!(
        !window.says("none of them is a map of this graph"),
        "now there are maps"
    );
    window.until("the maps", |editor| editor.exports.running.is_none());
}

#[test]
fn the_window_exports_the_same_bytes_as_a_bake_without_a_window() {
    let mut window = ready();
    window.press("Export");
    window.until("the maps", |editor| editor.exports.running.is_none());
    let mut alone = window.editor().bake_request(window.path("alone"), false);
    alone.graph = window.path("graph.sabi");
    alone.evaluator.adapter = sabi_gpu::AdapterChoice::Cpu;
    let report = sabi_engine::baking::bake(&alone, &sabi_engine::phases::NoProgress).expect("a bake");
    assert!(!report.files.is_empty());
    for name in report.files.iter().filter(|name| name.ends_with("png")) {
        let read = |folder: &str| fs::read(window.path(folder).join(name)).expect("a map");
        assert!(read("maps") == read("alone"), "{name}");
    }
}

#[test]
fn a_save_does_not_replace_exported_textures_by_those_of_another_model() {
    let mut window = ready();
    window.press("Export");
    window.until("the maps", |editor| editor.exports.running.is_none());
    window.harness.state_mut().exports.place.again = true;
    let other = window.path("other.glb");
    fs::copy(window.editor().evaluation.model.file(), &other).expect("a model");
    window.harness.state_mut().models().take(&other);
    window.settle();
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(window.editor().exports.running.is_none());
    assert!(window.says("were not exported again"), "{:?}", window.labels());
    window.press("Export");
    window.until("the maps of the other model", |editor| editor.exports.running.is_none());
    let place = &window.editor().exports.place;
    assert_eq!(place.model.as_deref(), Some(other.as_path()));
}

#[test]
fn the_base_and_every_variant_are_exported_to_folders_of_their_own() {
    let mut window = ready();
    let document = &mut window.harness.state_mut().documents.document;
    exposed_knobs::expose(document, &id("clouds"), "size");
    exposed_values::set(document, "size", &Value::Number(0.5));
    variants::save(document, "coarse/1");
    exposed_values::set(document, "size", &Value::Number(0.1));
    window.settle();
    let switch = window.harness.get_by_role_and_label(Role::CheckBox, "All variants");
    let switch = switch.rect().center();
    window.click_at(switch);
    window.press("Export");
    window.until("the maps", |editor| {
        editor.exports.running.is_none() && editor.exports.queued.is_empty()
    });
    let [base, coarse] = ["base", "coarse_1"].map(|name| {
        let file = window.path("maps").join(name);
        let maps = maps_in(&file);
        let color = maps.iter().find(|map| map.to_string_lossy().contains("base_color"));
        fs::read(color.expect("a map of the color")).expect("a file")
    });
    assert_ne!(base, coarse);
    // The panel lists the format of each map, and the channels without a map.
    let texts = window.labels().join("\n");
    assert!(texts.contains("base_color.png  (8 bits, sRGB)"), "{texts}");
    assert!(
        texts.contains(": 0 everywhere") && texts.contains("coarse_1/"),
        "{texts}"
    );
    let maps = window.path("maps").canonicalize().expect("a folder");
    assert!(
        window.says(&format!("Written to {}", maps.display())),
        "{:?}",
        window.labels()
    );
}

#[test]
fn the_graph_is_packed_with_its_model_once_it_is_saved() {
    let mut window = Window::opened(LAYERED);
    let document = &mut window.harness.state_mut().documents.document;
    document.select([id("clouds")]);
    nodes::delete(document, false);
    window.settle();
    let archive = window.path("worn.zip");
    let pack = |window: &mut Window| {
        let pack = FileAction::Pack(archive.clone());
        window.harness.state_mut().perform_on_file(pack);
        window.settle();
    };
    pack(&mut window);
    assert!(window.says("Save the graph first"), "{:?}", window.labels());
    window.keys(Modifiers::COMMAND, Key::S);
    pack(&mut window);
    window.until("the archive", |editor| !editor.packing.is_running());
    assert!(window.says("Packed 3 files into worn.zip"), "{:?}", window.labels());
    assert!(archive.is_file());
}
