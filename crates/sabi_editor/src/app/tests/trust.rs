//! Files outside of the graph's folder, and node files beside it: they are asked about once.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::Session;

use super::{Editor, Window, beside, graph_text};
use crate::app::ProgramFolders;
use crate::paths::canonical_if_present;

/// A graph of these nodes in `shared`, beside a folder `private`.
fn shared(folders: &ProgramFolders, nodes: &str) -> PathBuf {
    let folder = beside(folders);
    for name in ["shared", "private"] {
        fs::create_dir_all(folder.join(name)).expect("a folder");
    }
    let picture = image::RgbImage::from_pixel(2, 2, image::Rgb([200, 100, 50]));
    picture.save(folder.join("private/photo.png")).expect("a picture");
    let file = folder.join("shared/graph.sabi");
    fs::write(&file, graph_text(nodes)).expect("a graph");
    file
}

const PHOTO: &str = r#""photo": { "kind": "source/image", "params": { "file": "../private/photo.png" } }"#;
const OUTSIDE: &str = "is outside of the folder of the file that names it";

fn is_refused(editor: &Editor) -> bool {
    !editor.evaluation.refused.is_empty()
}

#[test]
fn a_picture_from_elsewhere_is_read_once_its_folder_is_trusted() {
    let open = |folders: &ProgramFolders| Session::open(&shared(folders, PHOTO), None).expect("a graph");
    let mut window = Window::with(open);
    window.until("the refusal", is_refused);
    assert!(window.says(OUTSIDE) && window.fault_of("photo").contains(OUTSIDE));
    let home = canonical_if_present(&window.path("private"));
    window.press(&format!("Trust {}", home.display()));
    window.until("the picture", |editor| {
        !is_refused(editor) && editor.evaluation.faults.of("photo").is_none()
    });
    assert!(!window.says(OUTSIDE));
    assert_eq!(window.editor().shell.settings.trusted, [home]);
    window.harness.state_mut().save_settings();
    let folder = window.folder;
    drop(window.harness);
    let mut next = Window::in_folder(folder, open);
    next.until("its files", |editor| !editor.evaluation.files.is_empty());
    assert!(!is_refused(next.editor()) && !next.says(OUTSIDE), "it is asked once");
}

#[test]
fn a_model_that_was_chosen_is_shown_again_and_one_that_was_not_is_asked_about() {
    let named = |folders: &ProgramFolders| {
        let file = shared(folders, "");
        let text = fs::read_to_string(&file).expect("a graph");
        fs::write(
            &file,
            text.replace(r#""size": 64"#, r#""size": 64, "mesh": "../private/hero.glb""#),
        )
        .expect("a graph");
        Session::open(&file, None).expect("a graph")
    };
    let mut window = Window::with(named);
    let hero = window.path("private/hero.glb");
    fs::copy(window.editor().evaluation.model.file(), &hero).expect("a model");
    window.settle();
    assert!(window.says(OUTSIDE), "the graph names it");
    assert!(!window.editor().evaluation.model.file().ends_with("hero.glb"));
    window.harness.state_mut().models().take_chosen(&hero);
    window.until("the model", |editor| {
        editor.evaluation.model.loaded().1 && editor.evaluation.model.file().ends_with("hero.glb")
    });
    assert!(!window.says(OUTSIDE), "the user names it, too");
    let file = window.path("shared/graph.sabi");
    window.harness.state_mut().proceed(crate::action::Next::New);
    window.harness.state_mut().open_file(&file);
    window.settle();
    assert!(window.editor().evaluation.model.file().ends_with("hero.glb"));
    assert_eq!(
        window.editor().shell.settings.trusted,
        [canonical_if_present(&hero)],
        "and nothing beside it"
    );
}

#[test]
fn nodes_that_come_with_a_graph_are_used_once_the_user_trusts_them() {
    let level = "//! Level\n//! One value.\n\n/// The value.\nfn mask(at: Surface) -> f32 {\n    return 0.5;\n}\n";
    let open = |folders: &ProgramFolders| {
        let file = shared(folders, r#""own": { "kind": "mine/level" }"#);
        let nodes = file.with_file_name("nodes").join("mine");
        fs::create_dir_all(&nodes).expect("a folder");
        fs::write(nodes.join("level.wgsl"), level).expect("a node");
        Session::open(&file, None).expect("a graph")
    };
    let has_own = |window: &Window| {
        window
            .document()
            .node_kinds()
            .kinds
            .library
            .kind("mine/level")
            .is_some()
    };
    let asks = |window: &Window| window.says("The graph comes with nodes of its own");
    let mut window = Window::with(open);
    window.settle();
    assert!(asks(&window) && !has_own(&window));
    window.press("Not now");
    assert!(!asks(&window) && !has_own(&window));
    let file = window.path("shared/graph.sabi");
    window.harness.state_mut().open_file(&file);
    window.settle();
    window.press("Use these nodes");
    assert!(!asks(&window) && has_own(&window));
    window.harness.state_mut().save_settings();
    let folder = window.folder;
    drop(window.harness);
    let window = Window::in_folder(folder, open);
    assert!(!asks(&window) && has_own(&window), "it is asked once");
    assert!(Path::new(&window.editor().shell.settings.trusted_nodes[0]).ends_with("shared/nodes"));
}

/// A glTF file of one triangle whose buffer is a file beside it.
fn gltf_beside(folder: &Path) -> PathBuf {
    fs::create_dir_all(folder).expect("a folder");
    let corners: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = corners.iter().flat_map(|number| number.to_le_bytes()).collect();
    fs::write(folder.join("hero.bin"), bytes).expect("a buffer");
    let text = r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [0] } ], "nodes": [ { "mesh": 0 } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0] } ],
        "bufferViews": [ { "buffer": 0, "byteLength": 36 } ],
        "buffers": [ { "uri": "hero.bin", "byteLength": 36 } ] }"#;
    let file = folder.join("hero.gltf");
    fs::write(&file, text).expect("a model");
    file
}

#[test]
fn a_file_chosen_before_the_first_save_is_remembered_wherever_the_program_started() {
    let mut window = Window::untitled();
    // A file below the working directory, which is the folder of a graph without a file. It is no model, so that it is
    // refused.
    let chosen = canonical_if_present(&Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"));
    window.harness.state_mut().models().take_chosen(&chosen);
    assert_eq!(window.editor().shell.settings.trusted, [chosen]);
}

#[test]
fn a_saved_graph_opens_a_model_of_several_files_that_the_command_line_named() {
    let mut window = Window::opened("");
    let hero = gltf_beside(&window.path("models"));
    let kept = tempfile::tempdir().expect("a folder");
    let file = kept.path().join("graph.sabi");
    let editor = window.harness.state_mut();
    // Starts with the trust that a model on the command line gets; it is not stored.
    editor.documents.trust(&sabi_files::TrustedPaths::of_file(&hero));
    editor.models().take(&hero);
    window.until("the model", |editor| {
        editor.evaluation.model.loaded().1 && editor.evaluation.model.file().ends_with("hero.gltf")
    });
    window.harness.state_mut().saving().save_to(&file);
    window.settle();
    window.harness.state_mut().save_settings();
    let folder = window.folder;
    drop(window.harness);
    let mut next = Window::in_folder(folder, |_| Session::new(None));
    assert_eq!(next.editor().shell.settings.trusted, [canonical_if_present(&hero)]);
    next.harness.state_mut().open_file(&file);
    next.until("the model", |editor| {
        editor.evaluation.model.loaded().1 && editor.evaluation.model.file().ends_with("hero.gltf")
    });
    assert!(!next.says(OUTSIDE));
}
