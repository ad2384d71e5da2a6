//! Files that change while they are open.

use std::fs;
use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sabi_editing::{history, nodes, trust};
use sabi_engine::Session;

use super::{Editor, Window};

/// Replaces a file atomically, as many editors save.
fn write(path: &Path, contents: impl AsRef<[u8]>) {
    let folder = path.parent().expect("a folder");
    fs::create_dir_all(folder).expect("a folder");
    let draft = folder.join("draft");
    fs::write(&draft, contents).expect("a draft");
    fs::rename(draft, path).expect("a file");
}

fn graph_of(nodes: &str) -> String {
    format!(r#"{{ "format": "sabi", "version": 1, "preview": {{ "size": 64 }}, "nodes": {{ {nodes} }} }}"#)
}

/// A window on a graph with files beside it, all of them watched, and the folder of the files. The window shows the
/// node `seen`.
struct WatchedWindow {
    window: Window,
    folder: PathBuf,
}

impl WatchedWindow {
    fn of(nodes: &str, files: &[(&str, &[u8])], first: f32) -> WatchedWindow {
        let mut folder = PathBuf::new();
        let mut window = Window::with(|folders| {
            folder = folders.examples.clone().expect("a folder for examples");
            for (name, contents) in files {
                write(&folder.join(name), contents);
            }
            write(&folder.join("graph.sabi"), graph_of(nodes));
            Session::open(&folder.join("graph.sabi"), None).expect("a graph")
        });
        if window.says("The graph comes with nodes of its own") {
            window.click("Use these nodes");
        }
        let seen = "seen".parse().expect("an id");
        window.harness.state_mut().look_at(&seen, None);
        let mut watched = WatchedWindow { window, folder };
        watched.until_value(first);
        watched.rest();
        watched
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        write(&self.path(name), contents);
    }

    fn until_value(&mut self, value: f32) {
        self.window.until("the value", |editor| value_of(editor) == Some(value));
    }

    /// Writes the graph as another program does, and waits for the question. Returns the text of that version.
    fn written_by_another(&mut self) -> String {
        let theirs = graph_of(&PLAIN.replace("#ffffff", "#000000"));
        self.write("graph.sabi", &theirs);
        self.window
            .until("a question", |editor| editor.documents.is_file_foreign);
        theirs
    }

    /// Waits until all results have arrived and all files are watched.
    fn rest(&mut self) {
        self.window.until("rest", |editor| {
            editor.evaluation.model.loaded().1
                && !editor.evaluation.is_busy()
                && editor.documents.watching.is_watching()
        });
    }
}

/// Value of the shown node.
fn value_of(editor: &Editor) -> Option<f32> {
    let (_, values) = editor.evaluation.results.inspected.as_ref()?;
    let at = values.is_on_surface.iter().position(|is_there| *is_there)?;
    let plane = values.planes.first()?;
    plane.values.get(at * plane.components).copied()
}

/// A mask of one value.
fn level(value: f32) -> String {
    format!(
        "//! Level\n//! One value everywhere.\n\n/// The value.\nfn mask(at: Surface) -> f32 {{\n    return {value:?};\n}}\n"
    )
}

const LEVEL: &str = r#""seen": { "kind": "own/level" }"#;

#[test]
fn a_changed_node_file_changes_the_shown_result_and_a_broken_one_leaves_it() {
    let mut watched = WatchedWindow::of(LEVEL, &[("nodes/own/level.wgsl", level(0.25).as_bytes())], 0.25);
    watched.write("nodes/own/level.wgsl", level(0.5));
    watched.until_value(0.5);
    watched.write("nodes/own/level.wgsl", "fn mask() {");
    watched.window.until("a fault", |editor| editor.problem_count() > 0);
    watched.rest();
    assert_eq!(
        value_of(watched.window.editor()),
        Some(0.5),
        "the last good version stays"
    );
    let faults = &watched.window.editor().documents.document.node_kinds().kinds.faults;
    assert!(faults[0].path.ends_with("nodes/own/level.wgsl"), "{faults:?}");
    watched.write("nodes/own/level.wgsl", level(0.75));
    watched.until_value(0.75);
    assert_eq!(watched.window.editor().problem_count(), 0);
}

/// A mask of one value with as much to compute as a node may have: a tile takes longer than a tenth of a second.
fn slow(value: f32) -> String {
    let sines = "x = fract(sin(x) + 1.3);\n".repeat(16);
    let rounds = format!("var x = at.uv.x;\nfor (var i = 0; i < 60000; i++) {{\n{sines}}}\n");
    level(value).replace("return ", &format!("{rounds}return max(x - 100.0, 0.0) + "))
}

#[test]
fn a_node_that_blocks_the_device_is_stopped_and_muted_and_the_window_goes_on() {
    let mut watched = WatchedWindow::of(LEVEL, &[("nodes/own/level.wgsl", level(0.25).as_bytes())], 0.25);
    watched.window.editor().evaluation.gpu().set_impatient(true);
    watched.write("nodes/own/level.wgsl", slow(0.5));
    watched.window.until("a muted node", |editor| {
        editor
            .documents
            .document
            .contents()
            .graph
            .nodes()
            .any(|(_, node)| node.muted)
    });
    assert!(watched.window.says("keeps the device busy for too long and is muted"));
    watched.window.editor().evaluation.gpu().set_impatient(false);
    watched.write("nodes/own/level.wgsl", level(0.75));
    watched.rest();
    history::undo(&mut watched.window.harness.state_mut().documents.document);
    watched.until_value(0.75);
}

#[test]
fn the_first_node_file_beside_a_graph_is_found_and_asked_about() {
    let mut watched = WatchedWindow::of(PLAIN, &[], 1.0);
    watched.write("nodes/own/level.wgsl", level(0.5));
    watched.window.until("a question", |editor| {
        trust::untrusted_nodes(&editor.documents.document).is_some()
    });
    watched.window.click("Use these nodes");
    watched.window.until("another kind", |editor| {
        editor
            .documents
            .document
            .node_kinds()
            .kinds
            .library
            .kind("own/level")
            .is_some()
    });
}

#[test]
fn a_rewritten_model_is_shown_and_a_broken_one_leaves_the_last() {
    let mut watched = WatchedWindow::of(PLAIN, &[], 1.0);
    let triangles = |editor: &Editor| {
        let model = editor.evaluation.model.received.as_ref().expect("a model");
        model.linked.model.mesh.triangles.len()
    };
    let of_cube = triangles(watched.window.editor());
    let sphere = include_bytes!("../../../../../assets/meshes/sphere.glb");
    watched.write("cube.glb", sphere);
    watched
        .window
        .until("another model", |editor| triangles(editor) != of_cube);
    watched.rest();
    let of_sphere = triangles(watched.window.editor());
    watched.write("cube.glb", &sphere[..100]);
    watched
        .window
        .until("a failure", |editor| editor.evaluation.model.failure.is_some());
    assert_eq!(triangles(watched.window.editor()), of_sphere, "the last good one stays");
    watched.write("cube.glb", include_bytes!("../../../../../assets/meshes/cube.glb"));
    watched.window.until("a model", |editor| triangles(editor) == of_cube);
    watched.rest();
    assert_eq!(watched.window.editor().evaluation.model.failure, None);
}

/// A picture of one gray pixel, as a BMP file.
fn picture(gray: u8) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for number in [58_u32, 0, 54, 40, 1, 1, 24 << 16 | 1, 0, 4, 0, 0, 0, 0] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([gray, gray, gray, 0]);
    bytes
}

#[test]
fn a_rewritten_picture_is_shown() {
    let image = r#""seen": { "kind": "source/image", "params": { "file": "gray.bmp" } }"#;
    let mut watched = WatchedWindow::of(image, &[("gray.bmp", &picture(0))], 0.0);
    watched.write("gray.bmp", picture(255));
    watched.until_value(1.0);
    fs::remove_file(watched.path("gray.bmp")).expect("the picture");
    watched.window.until("a fault", |editor| editor.problem_count() > 0);
    watched.write("gray.bmp", picture(0));
    watched.until_value(0.0);
    assert_eq!(watched.window.editor().problem_count(), 0);
}

/// A group file that gives one color.
fn group(color: &str) -> String {
    format!(
        r##"{{ "format": "sabi", "version": 1, "outputs": {{ "color": "inner" }},
            "nodes": {{ "inner": {{ "kind": "color/constant", "params": {{ "color": "{color}" }} }} }} }}"##
    )
}

#[test]
fn a_group_file_that_another_program_saves_is_used() {
    let instance = r#""seen": { "kind": "graph/group", "group": "lib/wear.sabi" }"#;
    let mut watched = WatchedWindow::of(instance, &[("lib/wear.sabi", group("#000000").as_bytes())], 0.0);
    watched.write("lib/wear.sabi", group("#ffffff"));
    watched.until_value(1.0);
}

const PLAIN: &str = r##""seen": { "kind": "color/constant", "params": { "color": "#ffffff" } }"##;

#[test]
fn a_graph_that_another_program_writes_is_asked_about_and_can_be_reloaded() {
    let mut watched = WatchedWindow::of(PLAIN, &[], 1.0);
    watched.write("graph.sabi", graph_of(&PLAIN.replace("#ffffff", "#000000")));
    watched
        .window
        .until("a question", |editor| editor.documents.is_file_foreign);
    watched.rest();
    assert_eq!(
        value_of(watched.window.editor()),
        Some(1.0),
        "nothing happens by itself"
    );
    watched.window.harness.get_by_label("Reload the file").click();
    watched.until_value(0.0);
    assert!(!watched.window.editor().documents.is_file_foreign);
    let document = &mut watched.window.harness.state_mut().documents.document;
    assert!(!document.session.is_dirty());
    history::undo(document);
    watched.until_value(1.0);
}

#[test]
fn the_open_graph_can_be_kept_when_another_program_writes_its_file() {
    let mut watched = WatchedWindow::of(PLAIN, &[], 1.0);
    let theirs = watched.written_by_another();
    watched.window.harness.run_steps(2);
    watched.window.harness.get_by_label("Keep the open graph").click();
    watched
        .window
        .until("an answer", |editor| !editor.documents.is_file_foreign);
    assert!(!watched.window.asks_to_close(), "what is here is in no file");
    watched.window.press("Save");
    assert_eq!(fs::read_to_string(watched.path("graph.sabi.bak")).ok(), Some(theirs));
    watched.rest();
    assert_eq!(value_of(watched.window.editor()), Some(1.0));
}

#[test]
fn a_save_over_the_version_of_another_program_asks_first() {
    let mut watched = WatchedWindow::of(PLAIN, &[], 1.0);
    let theirs = watched.written_by_another();
    let on_disk = |watched: &WatchedWindow| fs::read_to_string(watched.path("graph.sabi")).expect("a file");
    watched.window.keys(Modifiers::COMMAND, Key::S);
    assert!(watched.window.says("Another program has written this file"));
    assert_eq!(on_disk(&watched), theirs);
    watched.window.press("Replace it");
    assert!(on_disk(&watched).contains("#ffffff"));
    assert!(!watched.window.editor().documents.is_file_foreign);
}

#[test]
fn a_save_of_the_window_is_not_reported_as_a_change_by_another_program() {
    let image = r#""seen": { "kind": "source/image", "params": { "file": "gray.bmp" } }"#;
    let mut watched = WatchedWindow::of(image, &[("gray.bmp", &picture(0))], 0.0);
    let editor = watched.window.harness.state_mut();
    let seen = "seen".parse().expect("an id");
    nodes::set_knob(
        &mut editor.documents.document,
        &seen,
        "projection",
        Some(sabi_graph::Value::Text("triplanar".to_owned())),
    );
    editor.saving().save();
    // Another change is reported again.
    watched.write("gray.bmp", picture(255));
    watched.until_value(1.0);
    assert!(!watched.window.editor().documents.is_file_foreign);
}

#[test]
fn a_device_that_is_lost_while_nothing_is_evaluated_is_noticed() {
    let mut watched = WatchedWindow::of(PLAIN, &[], 1.0);
    watched.window.destroy_device();
    watched.window.until("a way out", |editor| editor.is_leaving);
    watched.window.harness.run_steps(3);
    let kept = watched.window.handover.lock().expect("nobody panicked").take();
    let kept = kept.expect("the work goes on");
    assert_eq!(kept.document.session.file(), Some(watched.path("graph.sabi").as_path()));
}

/// Environment of constant light, as a Radiance file.
fn light(value: u8) -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
    bytes.extend([value, value, value, 128].repeat(8));
    bytes
}

#[test]
fn a_rewritten_environment_is_shown_and_a_broken_one_leaves_the_last() {
    let mut watched = WatchedWindow::of(PLAIN, &[("sky.hdr", &light(40))], 1.0);
    let sky = watched.path("sky.hdr");
    let number = |watched: &WatchedWindow| watched.window.editor().views.model.environment.number();
    let comes = |watched: &mut WatchedWindow, after: u64| {
        let is_other = move |editor: &Editor| editor.views.model.environment.number() > after;
        watched.window.until("the environment", is_other);
    };
    comes(&mut watched, 0);
    let before = number(&watched);
    watched.window.dropped(&sky);
    comes(&mut watched, before);
    watched.rest();
    let before = number(&watched);
    watched.write("sky.hdr", light(200));
    comes(&mut watched, before);
    watched.write("sky.hdr", "nothing");
    let is_said = |editor: &Editor| editor.shell.notices.has("sky.hdr");
    watched.window.until("the sentence", is_said);
    assert!(watched.window.editor().views.model.is_loaded(), "the last one stays");
}
