//! Titled boxes around nodes.

use sabi_graph::Frame;

use super::*;

#[test]
fn a_frame_surrounds_the_selected_nodes_and_its_nodes_stay_when_it_is_removed() {
    let mut document = opened("", r#""a": { "kind": "noise/white" }, "b": { "kind": "noise/white" }"#);
    selection::select_all(&mut document);
    step(&mut document, frames::add);
    select(&mut document, &["b"]);
    step(&mut document, frames::add);
    let frames: Vec<String> = document.graph().frames().keys().cloned().collect();
    let colors: Vec<_> = document
        .graph()
        .frames()
        .values()
        .map(|frame| frame.color.clone())
        .collect();
    assert!(frames.len() == 2 && colors[0] != colors[1]);
    document.select([]);
    let both = document
        .graph()
        .frames()
        .iter()
        .find(|(_, frame)| frame.nodes.len() == 2);
    let both = both.map(|(name, _)| name.clone()).expect("the first frame");
    frames::select(&mut document, &both);
    assert_eq!(document.selection().len(), 2);
    step(&mut document, |document| frames::remove(document, &both));
    assert_eq!(document.graph().len(), 2);
    let said = refused(&mut document, |document| frames::remove(document, &both));
    assert!(said.starts_with("there is no frame"), "{said}");
    assert_eq!(
        frames::next_color(Some("#123456")),
        frames::next_color(None),
        "a color of one's own begins the row"
    );
}

#[test]
fn moving_a_node_into_a_frame_removes_it_from_other_frames() {
    let mut document = opened(
        r#""frames": { "f": { "nodes": ["a", "gone"] }, "g": { "nodes": ["b"] } },"#,
        r#""a": { "kind": "noise/white" }, "b": { "kind": "noise/white" }"#,
    );
    let nodes = |document: &OpenDocument| -> BTreeMap<String, Vec<String>> {
        let frames = document.graph().frames().iter();
        let ids = |frame: &Frame| frame.nodes.iter().map(NodeId::to_string).collect();
        frames.map(|(name, frame)| (name.clone(), ids(frame))).collect()
    };
    let expected =
        |nodes: &[&str]| BTreeMap::from([("g".to_owned(), nodes.iter().map(|id| (*id).to_owned()).collect())]);
    let a = [id("a")].into();
    step(&mut document, |document| frames::assign(document, &a, Some("g")));
    assert_eq!(nodes(&document), expected(&["b", "a"]), "an empty frame goes");
    refused(&mut document, |document| frames::assign(document, &a, Some("g")));
    step(&mut document, |document| frames::assign(document, &a, None));
    assert_eq!(nodes(&document), expected(&["b"]));
}

#[test]
fn a_frame_is_removed_with_its_last_node_and_restored_with_it() {
    let mut document = opened(
        r#""frames": { "f": { "nodes": ["a", "b"] } },"#,
        r#""a": { "kind": "noise/white" }, "b": { "kind": "noise/white" }, "c": { "kind": "noise/white" }"#,
    );
    select(&mut document, &["a"]);
    step(&mut document, |document| nodes::delete(document, false));
    assert!(document.graph().frames().contains_key("f"), "it holds another node");
    select(&mut document, &["b"]);
    step(&mut document, |document| nodes::delete(document, false));
    assert!(document.graph().frames().is_empty());
    history::undo(&mut document);
    assert!(document.graph().frames().contains_key("f"));
}
