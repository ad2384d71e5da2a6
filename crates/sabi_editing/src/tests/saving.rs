//! Saving the open document.

use sabi_files::Disk;

use super::*;

#[test]
fn a_graph_saved_in_another_folder_finds_its_group_files_and_can_be_undone() {
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
    history::undo(&mut document);
    history::undo(&mut document);
    assert!(document.graph().is_empty());
    history::redo(&mut document);
    history::redo(&mut document);
    assert_eq!(evaluated(&document), before);
    assert!(!document.session.is_dirty());
    document.session.save().expect("a writable folder");
}

#[test]
fn a_fault_while_saving_to_the_library_leaves_whole_files_and_replaces_none() {
    let saved_on = |disk: &Disk| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let library = folder.path().join("library");
        std::fs::create_dir(&library).expect("a writable folder");
        std::fs::write(library.join("old.sabi"), "theirs").expect("a writable folder");
        let text = r#"{ "format": "sabi", "version": 1, "nodes": { "g": { "kind": "graph/group", "group": "Old" } },
            "groups": { "Old": { "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" } } } } }"#;
        let file = folder.path().join("test.sabi");
        std::fs::write(&file, text).expect("a writable folder");
        let session = Session::open(&file, None).expect("a graph").on_disk(disk);
        let mut document = document_with(session, 7);
        select(&mut document, &["g"]);
        let is_told = library::save_group(&mut document, &library).is_some();
        assert_eq!(
            std::fs::read_to_string(library.join("old.sabi")).expect("a file"),
            "theirs"
        );
        let group = library.join("old-2.sabi");
        assert!(!is_told || group.is_file() && disk.at_risk().is_empty());
        if group.is_file() {
            let opened = Session::open(&group, None).expect("a whole graph");
            assert_eq!(opened.document().graph.len(), 1);
        }
    };
    let disk = Disk::counting();
    saved_on(&disk);
    assert!(disk.steps() > 0);
    Disk::each_fault(disk.steps()).for_each(|(disk, _)| saved_on(&disk));
}
