//! Missing files that are found again.

use std::fs;

use super::*;
use crate::missing_files::{missing, relocate};

const NODES: &str = r#"
    "rust": { "kind": "source/image", "params": { "file": "lost/rust.png" } },
    "dirt": { "kind": "source/image", "params": { "file": "lost/masks/dirt.png" } },
    "dust": { "kind": "source/image", "params": { "file": "C:\\work\\dust.png" } },
    "none": { "kind": "source/image", "params": { "file": "lost/none.png" } },
    "empty": { "kind": "source/image" }"#;

/// A document of these nodes in a folder, with files below it.
fn in_folder(files: &[&str]) -> (OpenDocument, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in files {
        let file = folder.path().join(file);
        fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        fs::write(file, "a file").expect("a file");
    }
    let text = format!(
        r#"{{ "format": "sabi", "version": 1, "preview": {{ "mesh": "lost/hero.glb" }}, "nodes": {{ {NODES} }} }}"#
    );
    let file = folder.path().join("graphs/test.sabi");
    fs::create_dir_all(folder.path().join("graphs")).expect("a folder");
    fs::write(&file, text).expect("a graph");
    let session = Session::open(&file, None).expect("a graph that can be read");
    (document_with(session, 7), folder)
}

fn file_of(document: &OpenDocument, node: &str) -> String {
    let value = param(document, node, "file");
    value
        .and_then(|value| value.as_text().map(str::to_owned))
        .expect("a path")
}

#[test]
fn missing_files_are_listed_as_they_are_written() {
    let (document, _folder) = in_folder(&["graphs/lost/rust.png"]);
    assert_eq!(
        missing(&document),
        [
            r"C:\work\dust.png",
            "lost/hero.glb",
            "lost/masks/dirt.png",
            "lost/none.png"
        ]
    );
}

#[test]
fn finding_one_file_also_finds_missing_files_beside_it_in_one_step() {
    let moved = [
        "moved/rust.png",
        "moved/masks/dirt.png",
        "moved/hero.glb",
        "moved/dust.png",
    ];
    let (mut document, folder) = in_folder(&moved);
    let before = document.contents().clone();
    let found = folder.path().join("moved/rust.png");
    assert_eq!(relocate(&mut document, "lost/rust.png", &found), 4);
    let files = ["rust", "dirt", "dust"].map(|node| file_of(&document, node));
    assert_eq!(
        files,
        ["../moved/rust.png", "../moved/masks/dirt.png", "../moved/dust.png"]
    );
    let mesh = document.contents().preview.clone().and_then(|preview| preview.mesh);
    assert_eq!(mesh.as_deref(), Some("../moved/hero.glb"));
    assert_eq!(missing(&document), ["lost/none.png"]);
    history::undo(&mut document);
    assert_eq!(*document.contents(), before);
}

#[test]
fn no_file_above_the_chosen_folder_is_used() {
    let (mut document, folder) = in_folder(&["moved/hero.glb", "secret/rust.png", "moved/deep/none.png"]);
    let edit = sabi_graph::Edit::SetParam {
        body: document.body(),
        node: id("rust"),
        param: "file".to_owned(),
        value: Some(Value::Text("lost/../secret/rust.png".to_owned())),
    };
    assert!(document.edit("Set the file", vec![edit]));
    let found = folder.path().join("moved/hero.glb");
    assert_eq!(relocate(&mut document, "lost/hero.glb", &found), 1);
    assert_eq!(file_of(&document, "rust"), "lost/../secret/rust.png");
    assert_eq!(file_of(&document, "none"), "lost/none.png", "not below, and not beside");
}
