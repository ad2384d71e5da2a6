//! Duplicates, and nodes copied as text.

use super::*;

const NODES: &str = r#"
    "n": { "kind": "noise/simplex", "params": { "seed": 7 }, "pos": [0, 0] },
    "l": { "kind": "adjust/levels", "inputs": { "source": "n" }, "pos": [300, 0] },
    "i": { "kind": "adjust/invert", "inputs": { "source": "l" }, "pos": [600, 50] }"#;

#[test]
fn a_duplicate_keeps_seeds_and_the_wires_between_the_copies() {
    let mut document = opened(r#""frames": { "f": { "title": "Both", "nodes": ["l", "n"] } },"#, NODES);
    select(&mut document, &["n", "l"]);
    step(&mut document, |document| duplication::duplicate(document, false));
    let copies: Vec<NodeId> = document.selection().iter().cloned().collect();
    let [levels, noise] = copies.as_slice() else {
        panic!("{copies:?}")
    };
    assert_eq!(param(&document, noise.as_str(), "seed"), number(7.0));
    assert_eq!(wire(&document, &format!("{levels}.source")), noise.as_str());
    assert_eq!(document.node(levels).map(|node| node.pos), Some([340.0, 40.0]));
    let frames: Vec<_> = document
        .graph()
        .frames()
        .values()
        .map(|frame| frame.nodes.clone())
        .collect();
    assert!(frames.contains(&vec![levels.clone(), noise.clone()]), "{frames:?}");
}

#[test]
fn a_duplicate_keeps_input_wires_only_if_asked_to() {
    let mut document = opened("", NODES);
    select(&mut document, &["l"]);
    step(&mut document, |document| duplication::duplicate(document, true));
    let copy = document.selected_one().cloned().expect("one copy");
    assert_eq!(wire(&document, &format!("{copy}.source")), "n");
    select(&mut document, &["l"]);
    step(&mut document, |document| duplication::duplicate(document, false));
    let copy = document.selected_one().cloned().expect("one copy");
    assert_eq!(wire(&document, &format!("{copy}.source")), "");
}

#[test]
fn a_copy_is_the_text_of_a_graph_file() {
    let mut document = opened(
        r#""frames": { "f": { "nodes": ["n"] }, "all": { "nodes": ["n", "i"] } },"#,
        NODES,
    );
    select(&mut document, &["n", "l"]);
    let text = clipboard::copy(&document).expect("two nodes");
    let copy = Document::from_json(&text).expect("a graph file");
    assert_eq!(copy.to_json(), text);
    assert_eq!(copy.graph.ids().map(NodeId::as_str).collect::<Vec<_>>(), ["l", "n"]);
    assert_eq!(copy.graph.frames().keys().collect::<Vec<_>>(), ["f"]);
    let mut other = self::document();
    step(&mut other, |document| clipboard::paste(document, &text, [100.0, 50.0]));
    assert_eq!(other.selection().len(), 2);
    let mut places: Vec<[f32; 2]> = other.graph().nodes().map(|(_, node)| node.pos).collect();
    places.sort_by(|one, two| one[0].total_cmp(&two[0]));
    assert_eq!(places, [[100.0, 50.0], [400.0, 50.0]]);
    assert_eq!(other.graph().frames().len(), 1);
    // Paste a second time, beside the first copy.
    step(&mut other, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!((other.graph().len(), other.graph().frames().len()), (4, 2));
}

#[test]
fn cutting_copies_and_deletes() {
    let mut document = opened("", NODES);
    select(&mut document, &["l"]);
    let text = step(&mut document, clipboard::cut).expect("a node");
    assert!(text.contains("adjust/levels") && document.node(&id("l")).is_none());
}

#[test]
fn a_text_that_is_not_a_graph_is_not_pasted() {
    let mut document = opened("", NODES);
    for text in [
        "",
        "hello",
        "{}",
        "[1, 2",
        r#"{ "format": "sabi", "version": 99, "nodes": {} }"#,
    ] {
        let said = refused(&mut document, |document| clipboard::paste(document, text, [0.0; 2]));
        assert_eq!(said, "the clipboard holds no nodes; copy some first", "{text}");
    }
    let empty = Document::new("").to_json();
    let said = refused(&mut document, |document| clipboard::paste(document, &empty, [0.0; 2]));
    assert_eq!(said, "the clipboard holds a graph without nodes");
    select(&mut document, &["n"]);
    let text = clipboard::copy(&document).expect("a node");
    let said = refused(&mut document, |document| {
        clipboard::paste(document, &text, [f32::NAN, 0.0])
    });
    assert_eq!(said, "a node can only stand at a finite place on the canvas");
}

/// Creates a group that contains another group; different values of `gain` give different inner groups.
fn nested(gain: f64) -> OpenDocument {
    let groups = format!(
        r#""groups": {{
             "inner": {{ "outputs": {{ "mask": "n" }}, "exposed": {{ "gain": {{ "to": ["n.gain"], "order": 1 }} }},
               "variants": {{ "much": {{ "gain": 0.75 }} }}, "frames": {{ "f": {{ "nodes": ["n"] }} }},
               "nodes": {{ "n": {{ "kind": "noise/simplex", "params": {{ "gain": {gain} }} }} }} }},
             "outer": {{ "name": "Outside", "fit": "metres", "outputs": {{ "mask": "i.mask" }},
               "nodes": {{ "i": {{ "kind": "graph/group", "group": "inner", "params": {{ "variant": "much" }} }} }} }},
             "unused": {{ "nodes": {{}} }} }},"#
    );
    let nodes = r#""g": { "kind": "graph/group", "group": "outer", "params": { "seed": 3 } },
        "out": { "kind": "output/mask", "inputs": { "source": "g.mask" } }"#;
    opened(&groups, nodes)
}

fn group_names(document: &OpenDocument) -> Vec<&str> {
    document.contents().groups.keys().map(String::as_str).collect()
}

#[test]
fn pasted_groups_are_imported_or_reused_if_they_are_the_same() {
    let mut source = nested(0.5);
    selection::select_all(&mut source);
    let text = clipboard::copy(&source).expect("nodes");
    assert!(!text.contains("unused"), "only what is needed");
    let mut target = document();
    step(&mut target, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!(group_names(&target), ["inner", "outer"]);
    for name in ["inner", "outer"] {
        assert_eq!(target.contents().groups[name], source.contents().groups[name]);
    }
    assert_eq!(evaluated(&target), evaluated(&source));
    step(&mut target, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!(group_names(&target), ["inner", "outer"], "used once more");
}

#[test]
fn a_group_with_a_taken_name_is_imported_once_under_another_name() {
    let mut source = nested(0.5);
    selection::select_all(&mut source);
    let text = clipboard::copy(&source).expect("nodes");
    let mut target = nested(0.25);
    step(&mut target, |document| clipboard::paste(document, &text, [0.0; 2]));
    let names = ["inner", "inner 2", "outer", "outer 2", "unused"];
    assert_eq!(group_names(&target), names, "the outer one holds another inner one");
    let mut both = [evaluated(&source), evaluated(&nested(0.25))].concat();
    both.sort_unstable();
    assert_eq!(evaluated(&target), both);
    step(&mut target, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!(group_names(&target), names, "what was brought is there now");
}

#[test]
fn two_pasted_groups_never_get_the_same_name() {
    let groups = |gain: f64| {
        let group = |gain: f64| {
            let node = format!(r#"{{ "kind": "noise/simplex", "params": {{ "gain": {gain} }} }}"#);
            format!(r#"{{ "outputs": {{ "mask": "n" }}, "nodes": {{ "n": {node} }} }}"#)
        };
        format!(
            r#""groups": {{ "a": {}, "a 2": {} }},"#,
            group(gain),
            group(gain + 0.125)
        )
    };
    let nodes = r#""one": { "kind": "graph/group", "group": "a" }, "two": { "kind": "graph/group", "group": "a 2" }"#;
    let mut source = opened(&groups(0.5), nodes);
    selection::select_all(&mut source);
    let text = clipboard::copy(&source).expect("nodes");
    let only_first = groups(0.25).replace("a 2", "b");
    let mut target = opened(&only_first, r#""x": { "kind": "graph/group", "group": "a" }"#);
    step(&mut target, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!(group_names(&target), ["a", "a 2", "a 2 2", "b"]);
}

#[test]
fn a_group_is_not_pasted_into_itself() {
    let mut document = nested(0.5);
    select(&mut document, &["g"]);
    let text = clipboard::copy(&document).expect("an instance");
    navigation::enter(&mut document, &id("g"));
    let said = refused(&mut document, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!(
        said,
        "'outer' holds 'outer', which is open here; a group cannot be inside itself"
    );
    navigation::enter(&mut document, &id("i"));
    let said = refused(&mut document, |document| clipboard::paste(document, &text, [0.0; 2]));
    assert_eq!(
        said,
        "'outer' holds 'inner', which is open here; a group cannot be inside itself"
    );
    let said = refused(&mut document, |document| {
        nodes::add_instance(document, "outer", [0.0; 2], None)
    });
    assert_eq!(
        said,
        "'outer' holds 'inner', which is open here; a group cannot be inside itself"
    );
    step(&mut document, |document| {
        nodes::add_instance(document, "unused", [0.0; 2], None)
    });
    flat(&document);
}

#[test]
fn a_duplicate_with_inputs_is_also_fed_by_the_inputs_of_the_group() {
    let groups = r#""groups": { "G": { "inputs": { "base": { "to": ["one.base"] } }, "outputs": { "material": "one.material" },
        "nodes": { "one": { "kind": "effect/layer" } } } },"#;
    let mut document = opened(groups, r#""g": { "kind": "graph/group", "group": "G" }"#);
    assert!(navigation::enter(&mut document, &id("g")));
    select(&mut document, &["one"]);
    step(&mut document, |document| duplication::duplicate(document, true));
    let copy = document.selected_one().cloned().expect("one copy");
    assert_eq!(
        ports::inputs(&document)["base"].to,
        [to("one.base"), slot(&copy, "base")]
    );
    step(&mut document, |document| duplication::duplicate(document, false));
    assert_eq!(ports::inputs(&document)["base"].to.len(), 2);
}

/// Creates a graph in a file of a folder, with an image node in the main graph and one in a group.
fn with_pictures(folder: &std::path::Path) -> OpenDocument {
    let text = r#"{ "format": "sabi", "version": 1,
        "nodes": { "g": { "kind": "graph/group", "group": "Old" },
                   "torn": { "kind": "source/image", "params": { "file": "tex/torn.png" } } },
        "groups": { "Old": { "outputs": { "mask": "inner.mask" },
            "nodes": { "inner": { "kind": "source/image", "params": { "file": "tex/torn.png" } } } } } }"#;
    std::fs::create_dir_all(folder).expect("a folder");
    let file = folder.join("test.sabi");
    std::fs::write(&file, text).expect("a writable folder");
    document_with(Session::open(&file, None).expect("a graph"), 7)
}

fn picture_in(document: &OpenDocument, group: &str, node: &str) -> Option<Value> {
    let group = document.contents().groups.get(group)?;
    group.graph.node(node)?.params.get("file").cloned()
}

#[test]
fn pasted_images_refer_to_the_same_files_as_the_copied_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().canonicalize().expect("a folder");
    let [mut one, mut other] = ["one", "other"].map(|name| with_pictures(&root.join(name)));
    selection::select_all(&mut one);
    let text = clipboard::copy(&one).expect("two nodes");
    step(&mut one, |document| clipboard::paste(document, &text, [0.0; 2]));
    let pasted = one.selection().iter().filter_map(|id| param(&one, id.as_str(), "file"));
    assert_eq!(pasted.collect::<Vec<_>>(), [Value::from("tex/torn.png")]);
    assert_eq!(one.contents().groups.len(), 1, "the group is the same one");
    step(&mut other, |document| clipboard::paste(document, &text, [0.0; 2]));
    let pasted = other
        .selection()
        .iter()
        .filter_map(|id| param(&other, id.as_str(), "file"));
    assert_eq!(pasted.collect::<Vec<_>>(), [Value::from("../one/tex/torn.png")]);
    assert_eq!(
        picture_in(&other, "Old 2", "inner"),
        Some(Value::from("../one/tex/torn.png"))
    );
    let mut untitled = document();
    assert!(clipboard::paste(&mut untitled, &text, [0.0; 2]));
    let whole = root.join("one/tex/torn.png").display().to_string();
    assert_eq!(picture_in(&untitled, "Old", "inner"), Some(Value::from(whole.as_str())));
}

#[test]
fn images_of_a_group_refer_to_the_same_files_after_a_trip_through_the_library() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().canonicalize().expect("a folder");
    let mut one = with_pictures(&root.join("one"));
    select(&mut one, &["g"]);
    let kept = library::save_group(&mut one, &root.join("library")).expect("a file");
    let mut other = with_pictures(&root.join("deep/other"));
    library::add(&mut other, &kept, [0.0; 2], None).expect("a node");
    assert_eq!(
        picture_in(&other, "Old 2", "inner"),
        Some(Value::from("../../one/tex/torn.png"))
    );
    // The graph from which the group was saved has it already, and reuses it.
    library::add(&mut one, &kept, [0.0; 2], None).expect("a node");
    assert_eq!(picture_in(&one, "Old", "inner"), Some(Value::from("tex/torn.png")));
    assert!(!one.contents().groups.contains_key("Old 2"));
}

#[test]
fn nodes_pasted_into_their_own_document_refer_to_the_same_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = with_pictures(folder.path());
    for written in ["./tex/torn.png", "/somewhere/torn.png", "tex/../torn.png"] {
        select(&mut document, &["torn"]);
        nodes::set_knob(&mut document, &id("torn"), "file", Some(Value::from(written)));
        let text = clipboard::copy(&document).expect("a node");
        step(&mut document, |document| clipboard::paste(document, &text, [0.0; 2]));
        let pasted = document.selected_one().cloned().expect("the copy");
        assert_eq!(param(&document, pasted.as_str(), "file"), Some(Value::from(written)));
    }
    // Simulate a text that was copied on a computer with other folders.
    let text = clipboard::copy(&document)
        .expect("a node")
        .replace("\"folder\": \"", "\"folder\": \"/of/nobody");
    let mut other = with_pictures(&folder.path().join("other"));
    step(&mut other, |document| clipboard::paste(document, &text, [0.0; 2]));
    let pasted = other.selected_one().cloned().expect("the copy");
    assert_eq!(
        param(&other, pasted.as_str(), "file"),
        Some(Value::from("tex/../torn.png"))
    );
}

/// A document in a file of a folder, with a Paint node named `hand`.
fn in_folder(folder: &std::path::Path, name: &str) -> OpenDocument {
    let file = folder.join(name);
    let text = r#"{ "format": "sabi", "version": 1, "nodes": { "hand": { "kind": "source/paint", "pos": [0, 0] } } }"#;
    std::fs::write(&file, text).expect("a file");
    OpenDocument::new(sabi_engine::Session::open(&file, None).expect("a graph"))
}

#[test]
fn copied_paint_nodes_take_their_strokes_to_another_graph() {
    use crate::painting;
    use sabi_paint::{Brush, Stroke};
    let [here, there] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let mut document = in_folder(here.path(), "worn.sabi");
    let stroke = std::sync::Arc::new(Stroke::new(Brush::default(), Vec::new()));
    assert!(painting::stroke(&mut document, &id("hand"), "crate", "", stroke));
    document.session.keep_strokes().expect("stored");
    select(&mut document, &["hand"]);
    let text = clipboard::copy(&document).expect("a node");
    let mut other = in_folder(there.path(), "other.sabi");
    step(&mut other, |document| clipboard::paste(document, &text, [300.0, 0.0]));
    let pasted = other.selected_one().cloned().expect("the copy");
    let list = painting::strokes_on(&other, &pasted, "crate").expect("its strokes");
    assert_eq!(list.strokes.len(), 1);
    assert!(
        there.path().join("other.paint/crate.strokes").exists(),
        "they are kept at once"
    );
    // A copy of nodes without strokes names no file for strokes.
    select(&mut other, &["hand"]);
    let text = clipboard::copy(&other).expect("a node");
    assert!(!text.contains("strokes_beside"), "{text}");
}
