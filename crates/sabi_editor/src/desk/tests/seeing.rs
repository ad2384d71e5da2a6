//! The graph that is seen, and what is selected in it.

use super::*;

const GROUPS: &str = r#""groups": {
    "inner": { "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" }, "g": { "kind": "noise/cells" } } },
    "outer": { "outputs": { "mask": "i" }, "nodes": { "i": { "kind": "graph/group", "group": "inner" } } } },"#;
const NODES: &str = r#""g": { "kind": "graph/group", "group": "outer", "label": "Wear" },
    "h": { "kind": "graph/group", "group": "outer" }, "n": { "kind": "noise/white" }"#;

#[test]
fn one_goes_into_groups_and_back_to_where_one_came_from() {
    let mut desk = opened(GROUPS, NODES);
    assert!(!desk.enter(&id("n")), "no group");
    assert!(desk.enter(&id("g")) && desk.enter(&id("i")));
    let path: Vec<String> = desk.path().into_iter().map(|(_, title)| title).collect();
    assert_eq!(path, ["Wear", "inner"]);
    assert_eq!(desk.body(), sabi_graph::Body::Group("inner".to_owned()));
    assert_eq!(desk.full_id(&id("n")), "g/i/n");
    assert!(desk.leave());
    assert_eq!(desk.selected_one(), Some(&id("i")));
    assert!(desk.leave_to(0) && !desk.leave());
    assert_eq!(desk.selected_one(), Some(&id("g")));
    assert_eq!(desk.full_id(&id("n")), "n");
}

#[test]
fn a_node_is_found_and_called_by_the_way_to_it() {
    let mut desk = opened(GROUPS, NODES);
    for (path, title) in [
        ("n", Some("Grains")),
        ("g/i", Some("Wear › inner")),
        ("g/i/g", Some("Wear › inner › Cells")),
        ("g/n", None),
        ("n/n", None),
        ("gone", None),
    ] {
        assert_eq!(desk.has(path), title.is_some(), "{path}");
        assert!(
            title.is_none_or(|title| desk.title_at(path) == title),
            "{path}: {}",
            desk.title_at(path)
        );
    }
    assert_eq!(desk.title_at("gone"), "gone", "what is not there goes by its id");
    desk.enter(&id("g"));
    assert_eq!(desk.seen_at("g/i"), Some(id("i")));
    assert_eq!(desk.seen_at("i"), None);
}

#[test]
fn an_edit_inside_is_one_in_all_instances() {
    let mut desk = opened(GROUPS, NODES);
    desk.enter(&id("g"));
    desk.enter(&id("i"));
    step(&mut desk, |desk| desk.set_knob(&id("n"), "size", number(0.5)));
    let sizes: Vec<_> = flat(&desk)
        .nodes
        .into_iter()
        .filter(|node| node.id.ends_with("/n"))
        .collect();
    assert!(sizes.len() == 2 && sizes.iter().all(|node| node.params.get("size") == number(0.5).as_ref()));
}

#[test]
fn an_entered_group_that_is_gone_is_left_and_nothing_there_stays_selected() {
    let mut desk = opened(GROUPS, NODES);
    select(&mut desk, &["n"]);
    desk.make_group();
    let made = desk.selected_one().cloned().expect("the instance");
    desk.enter(&made);
    select(&mut desk, &["n"]);
    // The graph outside has a node of that id once more.
    desk.undo();
    assert!(desk.path().is_empty());
    assert!(desk.selection().is_empty(), "{:?}", desk.selection());
    desk.redo();
    assert_eq!(desk.selected_one(), Some(&made), "what came back is selected");
}

#[test]
fn undo_keeps_the_selection_as_far_as_it_is_there() {
    let mut desk = opened("", NODES_PLAIN);
    select(&mut desk, &["a", "b"]);
    desk.set_knob(&id("a"), "size", number(0.5));
    desk.undo();
    assert_eq!(desk.selection().len(), 2);
    let new = add(&mut desk, "noise/white");
    desk.select([new, id("a")]);
    desk.undo();
    assert_eq!(desk.selected_one(), Some(&id("a")));
    assert_eq!(desk.take_notices().pop().as_deref(), Some("Undone: Add Grains"));
}

const NODES_PLAIN: &str = r#""a": { "kind": "noise/white" }, "b": { "kind": "adjust/levels", "inputs": { "source": "a" } },
    "c": { "kind": "adjust/invert", "inputs": { "source": "b" } }, "d": { "kind": "noise/cells" }"#;

#[test]
fn streams_are_selected_up_and_down() {
    let mut desk = opened("", NODES_PLAIN);
    let selected = |desk: &Desk| desk.selection().iter().map(NodeId::to_string).collect::<Vec<_>>();
    select(&mut desk, &["b", "lost"]);
    desk.select_stream(true);
    assert_eq!(selected(&desk), ["a", "b"]);
    select(&mut desk, &["b"]);
    desk.select_stream(false);
    assert_eq!(selected(&desk), ["b", "c"]);
    desk.toggle(&id("b"));
    desk.toggle(&id("d"));
    desk.toggle(&id("lost"));
    assert_eq!(selected(&desk), ["c", "d"]);
}

#[test]
fn a_group_that_holds_itself_is_entered_once() {
    let groups = r#""groups": { "a": { "nodes": { "i": { "kind": "graph/group", "group": "a" } } } },"#;
    let mut desk = opened(groups, r#""g": { "kind": "graph/group", "group": "a" }"#);
    assert!(desk.enter(&id("g")));
    assert!(!desk.enter(&id("i")));
    assert_eq!(desk.take_notices(), ["'a' holds itself; take this instance of it away"]);
}
