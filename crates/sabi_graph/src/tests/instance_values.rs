//! Values of group instances that are checked without flattening.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::{Body, Document, Edit, Overrides, Value, flatten, takes_values};

/// A group whose knobs set a node and, through a knob of its own, another group.
const TEXT: &str = r#"{ "format": "sabi", "version": 1,
    "groups": {
        "rust": {
            "exposed": { "amount": { "to": ["n.x"], "range": [0, 1] }, "deep": { "to": ["inner.depth"], "range": [0, 10] } },
            "variants": { "old": { "amount": 1 }, "broken": { "deep": 9 } },
            "outputs": { "mask": "inner.mask" },
            "nodes": { "n": { "kind": "x" }, "inner": { "kind": "graph/group", "group": "pits" } } },
        "pits": {
            "exposed": { "depth": { "to": ["p.x"], "range": [0, 5] } },
            "outputs": { "mask": "p" }, "nodes": { "p": { "kind": "x" } } } },
    "nodes": { "i": { "kind": "graph/group", "group": "rust" } } }"#;

fn can_be_flattened(params: &BTreeMap<String, Value>) -> bool {
    let mut document = Document::from_json(TEXT).unwrap();
    for (param, value) in params {
        let edit = Edit::SetParam {
            body: Body::Main,
            node: "i".parse().unwrap(),
            param: param.clone(),
            value: Some(value.clone()),
        };
        document.apply(edit).unwrap();
    }
    flatten(&document, &Overrides::default(), &mut |_| Err("no files".to_owned())).is_ok()
}

#[test]
fn values_are_taken_just_where_the_graph_can_be_flattened() {
    let document = Document::from_json(TEXT).unwrap();
    let text = |text: &str| Value::Text(text.to_owned());
    for (param, value, taken) in [
        ("amount", Value::Number(0.5), true),
        ("amount", Value::Number(1.5), false),
        ("amount", text("much"), false),
        ("deep", Value::Number(4.0), true),
        // Within its own range, and out of that of the group inside.
        ("deep", Value::Number(7.0), false),
        ("variant", text("old"), true),
        ("variant", text("new"), false),
        ("variant", text("broken"), false),
        ("seed", Value::Number(7.0), true),
        ("seed", Value::Number(-1.0), false),
        ("fit", text("piece"), true),
        ("fit", text("foot"), false),
        ("absent", Value::Number(0.0), false),
    ] {
        let params = BTreeMap::from([(param.to_owned(), value)]);
        assert_eq!(
            takes_values(&document, "rust", &params, &mut |_| None),
            taken,
            "{params:?}"
        );
        assert_eq!(can_be_flattened(&params), taken, "{params:?}");
    }
}

#[test]
fn scales_and_groups_inside_themselves_are_left_to_flattening() {
    let document = Document::from_json(TEXT).unwrap();
    let scale = BTreeMap::from([("scale".to_owned(), Value::Number(2.0))]);
    assert!(can_be_flattened(&scale) && !takes_values(&document, "rust", &scale, &mut |_| None));
    let endless = r#"{ "format": "sabi", "version": 1, "groups": { "a": {
        "exposed": { "x": { "to": ["one.x", "two.x"] } }, "outputs": { "mask": "one.mask" },
        "nodes": { "one": { "kind": "graph/group", "group": "a" }, "two": { "kind": "graph/group", "group": "a" } } } }, "nodes": {} }"#;
    let endless = Document::from_json(endless).unwrap();
    let value = BTreeMap::from([("x".to_owned(), Value::Number(1.0))]);
    assert!(!takes_values(&endless, "a", &value, &mut |_| None));
}

#[test]
fn groups_in_files_are_read_from_where_they_are_named() {
    let rust = r#"{ "format": "sabi", "version": 1, "exposed": { "deep": { "to": ["inner.depth"] } },
        "outputs": { "mask": "inner.mask" }, "nodes": { "inner": { "kind": "graph/group", "group": "pits.sabi" } } }"#;
    let pits = r#"{ "format": "sabi", "version": 1, "exposed": { "depth": { "to": ["p.x"], "range": [0, 5] } },
        "outputs": { "mask": "p" }, "nodes": { "p": { "kind": "x" } } }"#;
    let files = [("lib/rust.sabi", rust), ("lib/pits.sabi", pits)];
    let mut read = |path: &str| {
        let (_, text) = files.iter().find(|(name, _)| *name == path)?;
        Some(Arc::new(Document::from_json(text).unwrap()))
    };
    let document = Document::new("Main");
    for (deep, taken) in [(4.0, true), (6.0, false)] {
        let params = BTreeMap::from([("deep".to_owned(), Value::Number(deep))]);
        assert_eq!(takes_values(&document, "lib/rust.sabi", &params, &mut read), taken);
    }
    assert!(!takes_values(&document, "lib/absent.sabi", &BTreeMap::new(), &mut read));
}
