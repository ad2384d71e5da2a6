//! Saving from the desk.

use super::*;

#[test]
fn a_graph_saved_elsewhere_finds_its_group_files_and_undo_still_works() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir_all(folder.path().join("deep")).expect("a writable folder");
    let group = r#"{ "format": "sabi", "version": 1, "name": "Wear", "outputs": { "mask": "n" },
        "nodes": { "n": { "kind": "noise/white" } } }"#;
    std::fs::write(folder.path().join("wear.sabi"), group).expect("a writable folder");
    let mut desk = desk();
    desk.save_as(&folder.path().join("main.sabi"))
        .expect("a writable folder");
    let wear = desk
        .add_group_instance("wear.sabi", [0.0; 2], None)
        .expect("a group file");
    desk.add("output/mask", [300.0, 0.0], Some(&Loose::From(out(&wear))));
    let before = evaluated(&desk);
    desk.save_as(&folder.path().join("deep/main.sabi"))
        .expect("a writable folder");
    assert_eq!(
        desk.node(&wear).and_then(|node| node.group.as_deref()),
        Some("../wear.sabi")
    );
    assert_eq!(desk.title(&wear), "Wear");
    assert_eq!(evaluated(&desk), before);
    desk.undo();
    desk.undo();
    assert!(desk.graph().is_empty());
    desk.redo();
    desk.redo();
    assert_eq!(evaluated(&desk), before);
    assert!(!desk.session.is_dirty());
    desk.save().expect("a writable folder");
}
