//! Saving from the document.

use super::*;

#[test]
fn a_graph_saved_elsewhere_finds_its_group_files_and_undo_still_works() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir_all(folder.path().join("deep")).expect("a writable folder");
    let group = r#"{ "format": "sabi", "version": 1, "name": "Wear", "outputs": { "mask": "n" },
        "nodes": { "n": { "kind": "noise/white" } } }"#;
    std::fs::write(folder.path().join("wear.sabi"), group).expect("a writable folder");
    let mut document = document();
    document
        .save_as(&folder.path().join("main.sabi"))
        .expect("a writable folder");
    let wear = nodes::add_instance(&mut document, "wear.sabi", [0.0; 2], None).expect("a group file");
    nodes::add(
        &mut document,
        "output/mask",
        [300.0, 0.0],
        Some(&PendingWire::From(out(&wear))),
    );
    let before = evaluated(&document);
    document
        .save_as(&folder.path().join("deep/main.sabi"))
        .expect("a writable folder");
    assert_eq!(
        document.node(&wear).and_then(|node| node.group.as_deref()),
        Some("../wear.sabi")
    );
    assert_eq!(document.title(&wear), "Wear");
    assert_eq!(evaluated(&document), before);
    document.undo();
    document.undo();
    assert!(document.graph().is_empty());
    document.redo();
    document.redo();
    assert_eq!(evaluated(&document), before);
    assert!(!document.session.is_dirty());
    document.save().expect("a writable folder");
}
