//! Documents that are saved in another folder.

use std::collections::BTreeMap;

use super::document;
use crate::{Body, Document, Edit, History, Node, Relocation, Value};

/// Rewrites a path for a document that moves one folder deeper.
fn deeper(path: &str) -> String {
    format!("../{path}")
}

fn back(path: &str) -> String {
    path.strip_prefix("../").unwrap_or(path).to_owned()
}

fn is_file(kind: &str, param: &str) -> bool {
    kind == "source/image" && param == "file"
}

fn relocation(moved: &dyn Fn(&str) -> String) -> Relocation<'_> {
    Relocation {
        is_file: &is_file,
        moved,
    }
}

/// Creates a document with paths in all places that can have one, and with the same texts in places that cannot.
fn pictures() -> Document {
    document(
        r#""preview": { "mesh": "a.glb" },
           "exposed": { "where": { "to": ["i.picture"], "default": "d.png" }, "word": { "to": ["i.word"], "default": "w" } },
           "variants": { "other": { "where": "v.png", "word": "v.png" } },
           "groups": {
             "decal": {
               "exposed": { "picture": { "to": ["m.file"] }, "word": { "to": ["m.projection"] } },
               "nodes": { "m": { "kind": "source/image@1", "params": { "file": "m.png", "projection": "m.png" } } } } },"#,
        r#""f": { "kind": "graph/group", "group": "lib/f.sabi", "params": { "picture": "kept.png" } },
           "g": { "kind": "not/known", "params": { "file": "kept.png" } },
           "i": { "kind": "graph/group", "group": "decal", "params": { "picture": "i.png", "word": "i.png" } }"#,
    )
}

#[test]
fn exactly_the_paths_are_rewritten_for_another_folder() {
    let before = pictures().to_json();
    let moved = pictures().relocated(relocation(&deeper));
    let text = moved.to_json();
    for path in ["a.glb", "d.png", "m.png", "i.png", "lib/f.sabi"] {
        assert!(text.contains(&format!("\"../{path}\"")), "{path}: {text}");
    }
    assert_eq!(text.matches("../").count(), 6, "and one in the variant: {text}");
    assert_eq!(moved.relocated(relocation(&back)).to_json(), before);
}

#[test]
fn undo_after_a_move_restores_the_document_with_paths_of_the_new_folder() {
    let (mut document, mut history) = (Document::default(), History::new());
    let mut image = Node::new("source/image");
    image.params.insert("file".to_owned(), Value::from("a.png"));
    let id = "m".parse().unwrap();
    let steps = [
        Edit::AddNode {
            body: Body::Main,
            id,
            node: image,
            inputs: BTreeMap::new(),
        },
        Edit::SetParam {
            body: Body::Main,
            node: "m".parse().unwrap(),
            param: "file".to_owned(),
            value: Some(Value::from("b.png")),
        },
        Edit::RemoveNode {
            body: Body::Main,
            id: "m".parse().unwrap(),
        },
        Edit::AddGroup {
            name: "decal".to_owned(),
            group: Box::new(pictures().groups["decal"].clone()),
        },
        Edit::RemoveGroup {
            name: "decal".to_owned(),
        },
    ];
    let mut states = vec![document.clone()];
    for edit in steps {
        history.apply(&mut document, "Step", edit).unwrap();
        states.push(document.clone());
    }
    history.undo(&mut document).unwrap();
    history.undo(&mut document).unwrap();
    history.relocate(&document, relocation(&deeper));
    document = document.relocated(relocation(&deeper));
    let written = |state: &Document| state.relocated(relocation(&deeper)).to_json();
    for state in states[..3].iter().rev() {
        history.undo(&mut document).unwrap();
        assert_eq!(document.to_json(), written(state));
    }
    for state in &states[1..] {
        history.redo(&mut document).unwrap();
        assert_eq!(document.to_json(), written(state));
    }
}

#[test]
fn a_replaced_document_in_the_history_is_rewritten_for_another_folder() {
    let (mut document, mut history) = (pictures(), History::new());
    let replace = Edit::Replace {
        document: Box::new(Document::default()),
    };
    history.apply(&mut document, "Another", replace).unwrap();
    history.relocate(&document, relocation(&deeper));
    history.undo(&mut document).unwrap();
    assert_eq!(document, pictures().relocated(relocation(&deeper)));
}
