//! The shown graph, and the selection in it.

use super::*;
use crate::command::{EditCommand, Outcome, SelectionCommand, perform};

const GROUPS: &str = r#""groups": {
    "inner": { "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" }, "g": { "kind": "noise/cells" } } },
    "outer": { "outputs": { "mask": "i" }, "nodes": { "i": { "kind": "graph/group", "group": "inner" } } } },"#;
const NODES: &str = r#""g": { "kind": "graph/group", "group": "outer", "label": "Wear" },
    "h": { "kind": "graph/group", "group": "outer" }, "n": { "kind": "noise/white" }"#;

#[test]
fn groups_are_entered_and_left_again() {
    let mut document = opened(GROUPS, NODES);
    assert!(!navigation::enter(&mut document, &id("n")), "no group");
    assert!(navigation::enter(&mut document, &id("g")) && navigation::enter(&mut document, &id("i")));
    let path: Vec<String> = navigation::breadcrumb(&document)
        .into_iter()
        .map(|(_, title)| title)
        .collect();
    assert_eq!(path, ["Wear", "inner"]);
    assert_eq!(document.body(), sabi_graph::Body::Group("inner".to_owned()));
    assert_eq!(node_paths::full_id(&document, &id("n")), "g/i/n");
    assert!(navigation::leave(&mut document));
    assert_eq!(document.selected_one(), Some(&id("i")));
    assert!(navigation::leave_to(&mut document, 0) && !navigation::leave(&mut document));
    assert_eq!(document.selected_one(), Some(&id("g")));
    assert_eq!(node_paths::full_id(&document, &id("n")), "n");
}

#[test]
fn a_node_is_found_and_described_by_its_path() {
    let mut document = opened(GROUPS, NODES);
    for (path, title) in [
        ("n", Some("White noise")),
        ("g/i", Some("Wear › inner")),
        ("g/i/g", Some("Wear › inner › Cells")),
        ("g/n", None),
        ("n/n", None),
        ("gone", None),
    ] {
        assert_eq!(node_paths::exists(&document, path), title.is_some(), "{path}");
        assert!(
            title.is_none_or(|title| node_paths::title(&document, path) == title),
            "{path}: {}",
            node_paths::title(&document, path)
        );
    }
    assert_eq!(
        node_paths::title(&document, "gone"),
        "gone",
        "what is not there goes by its id"
    );
    navigation::enter(&mut document, &id("g"));
    assert_eq!(node_paths::in_shown_graph(&document, "g/i"), Some(id("i")));
    assert_eq!(node_paths::in_shown_graph(&document, "i"), None);
}

#[test]
fn selecting_muted_nodes_selects_all_of_the_shown_graph_and_no_others() {
    let groups = r#""groups": { "wear": { "outputs": { "mask": "n" }, "nodes": {
        "n": { "kind": "noise/white" }, "m": { "kind": "noise/cells", "muted": true } } } },"#;
    let nodes = r#""a": { "kind": "noise/white", "muted": true }, "b": { "kind": "noise/white" },
        "g": { "kind": "graph/group", "group": "wear", "muted": true }"#;
    let mut document = opened(groups, nodes);
    let muted = |document: &mut OpenDocument| perform(document, EditCommand::Selection(SelectionCommand::Muted));
    select(&mut document, &["b"]);
    assert_eq!(muted(&mut document), Outcome::Done);
    assert!(document.selection().iter().eq([&id("a"), &id("g")]));
    navigation::enter(&mut document, &id("g"));
    assert_eq!(muted(&mut document), Outcome::Done);
    assert_eq!(document.selected_one(), Some(&id("m")));
}

#[test]
fn without_muted_nodes_the_selection_stays_and_a_notice_is_added() {
    let mut document = opened("", r#""a": { "kind": "noise/white" }, "b": { "kind": "noise/white" }"#);
    select(&mut document, &["b"]);
    let said = refused(&mut document, selection::select_muted);
    assert_eq!(said, "no node of this graph is muted");
    assert_eq!(document.selected_one(), Some(&id("b")));
}

#[test]
fn an_edit_inside_a_group_changes_all_instances() {
    let mut document = opened(GROUPS, NODES);
    navigation::enter(&mut document, &id("g"));
    navigation::enter(&mut document, &id("i"));
    step(&mut document, |document| {
        nodes::set_knob(document, &id("n"), "size", number(0.5))
    });
    let sizes: Vec<_> = flat(&document)
        .nodes
        .into_iter()
        .filter(|node| node.id.ends_with("/n"))
        .collect();
    assert!(sizes.len() == 2 && sizes.iter().all(|node| node.params.get("size") == number(0.5).as_ref()));
}

#[test]
fn a_removed_group_is_left_and_its_selection_is_cleared() {
    let mut document = opened(GROUPS, NODES);
    select(&mut document, &["n"]);
    groups::make(&mut document);
    let made = document.selected_one().cloned().expect("the instance");
    navigation::enter(&mut document, &made);
    select(&mut document, &["n"]);
    // The outer graph has a node with that id again.
    history::undo(&mut document);
    assert!(navigation::breadcrumb(&document).is_empty());
    assert!(document.selection().is_empty(), "{:?}", document.selection());
    history::redo(&mut document);
    assert_eq!(document.selected_one(), Some(&made), "what came back is selected");
}

#[test]
fn undo_keeps_the_selection_of_nodes_that_exist() {
    let mut document = opened("", NODES_PLAIN);
    select(&mut document, &["a", "b"]);
    nodes::set_knob(&mut document, &id("a"), "size", number(0.5));
    history::undo(&mut document);
    assert_eq!(document.selection().len(), 2);
    let new = add(&mut document, "noise/white");
    document.select([new, id("a")]);
    history::undo(&mut document);
    assert_eq!(document.selected_one(), Some(&id("a")));
    assert_eq!(
        document.take_notices().pop().as_deref(),
        Some("Undone: Add White noise")
    );
}

const NODES_PLAIN: &str = r#""a": { "kind": "noise/white" }, "b": { "kind": "adjust/levels", "inputs": { "source": "a" } },
    "c": { "kind": "adjust/invert", "inputs": { "source": "b" } }, "d": { "kind": "noise/cells" }"#;

#[test]
fn upstream_and_downstream_nodes_are_selected() {
    let mut document = opened("", NODES_PLAIN);
    let selected = |document: &OpenDocument| document.selection().iter().map(NodeId::to_string).collect::<Vec<_>>();
    select(&mut document, &["b", "lost"]);
    selection::select_connected(&mut document, true);
    assert_eq!(selected(&document), ["a", "b"]);
    select(&mut document, &["b"]);
    selection::select_connected(&mut document, false);
    assert_eq!(selected(&document), ["b", "c"]);
    selection::toggle(&mut document, &id("b"));
    selection::toggle(&mut document, &id("d"));
    selection::toggle(&mut document, &id("lost"));
    assert_eq!(selected(&document), ["c", "d"]);
}

#[test]
fn a_group_that_contains_itself_can_be_entered_only_once() {
    let groups = r#""groups": { "a": { "nodes": { "i": { "kind": "graph/group", "group": "a" } } } },"#;
    let mut document = opened(groups, r#""g": { "kind": "graph/group", "group": "a" }"#);
    assert!(navigation::enter(&mut document, &id("g")));
    assert!(!navigation::enter(&mut document, &id("i")));
    assert_eq!(document.take_notices(), ["'a' contains itself; delete this node"]);
}
