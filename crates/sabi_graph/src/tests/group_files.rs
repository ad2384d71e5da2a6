//! Groups in files of their own, and groups that contain themselves.

use super::{document, flat};
use crate::{Fit, FlattenError, Overrides, Value, flatten};

#[test]
fn groups_that_hold_themselves_are_named_in_a_chain() {
    let holds = |name: &str, inner: &str| {
        format!(r#""{name}": {{ "nodes": {{ "i": {{ "kind": "graph/group", "group": "{inner}" }} }} }}"#)
    };
    let groups = [
        holds("rust", "dust"),
        holds("dust", "grime"),
        holds("grime", "rust"),
        holds("self", "self"),
    ];
    let more = format!("\"groups\": {{ {} }},", groups.join(","));
    let error = |group: &str| {
        let document = document(
            &more,
            &format!(r#""i": {{ "kind": "graph/group", "group": "{group}" }}"#),
        );
        flat(&document, &Overrides::default()).unwrap_err().to_string()
    };
    let text = "a group cannot hold itself: dust → grime → rust → dust; take one of these instances out";
    assert_eq!(error("grime"), text);
    assert_eq!(
        error("self"),
        "a group cannot hold itself: self → self; take one of these instances out"
    );
}

#[test]
fn groups_of_groups_that_fill_the_memory_are_refused() {
    let mut groups = String::from(r#""g0": { "nodes": { "n": { "kind": "x" } } }"#);
    for level in 1..60 {
        let inner = format!(r#""kind": "graph/group", "group": "g{}""#, level - 1);
        groups.push_str(&format!(
            r#", "g{level}": {{ "nodes": {{ "a": {{ {inner} }}, "b": {{ {inner} }} }} }}"#
        ));
    }
    let document = document(
        &format!("\"groups\": {{ {groups} }},"),
        r#""i": { "kind": "graph/group", "group": "g59" }"#,
    );
    let error = flat(&document, &Overrides::default()).unwrap_err();
    assert!(matches!(error, FlattenError::TooLarge { .. }), "{error}");
}

#[test]
fn a_group_file_keeps_its_fit_its_groups_and_its_folder() {
    let main = document(
        r#""fit": 2,"#,
        r#""a": { "kind": "graph/group", "group": "lib/rust.sabi", "params": { "amount": 0.5 } },
           "b": { "kind": "graph/group", "group": "lib/rust.sabi" }, "own": { "kind": "y" }"#,
    );
    let rust = document(
        r#""fit": "metres", "seed": 5, "exposed": { "amount": { "to": ["i.gain"] } }, "outputs": { "mask": "i" },
           "groups": { "inner": { "fit": "unit", "exposed": { "gain": { "to": ["n.gain"] } }, "outputs": { "x": "n" },
             "nodes": { "n": { "kind": "noise/cells" } } } },"#,
        r#""i": { "kind": "graph/group", "group": "inner" }, "deeper": { "kind": "graph/group", "group": "../c.sabi" }"#,
    );
    let deeper = document("", r#""n": { "kind": "source/image", "params": { "file": "c.png" } }"#);
    let mut asked = Vec::new();
    let mut read = |path: &str| {
        asked.push(path.to_owned());
        match path {
            "lib/rust.sabi" => Ok(rust.clone()),
            "c.sabi" => Ok(deeper.clone()),
            _ => Err("it is not there".to_owned()),
        }
    };
    let graph = flatten(&main, &Overrides::default(), &mut read).unwrap();
    assert_eq!(asked, ["lib/rust.sabi", "c.sabi"], "each file is read once");
    let seen: Vec<_> = graph
        .nodes
        .iter()
        .map(|node| (node.id.as_str(), node.fit, node.file.as_deref()))
        .collect();
    assert_eq!(
        seen,
        [
            ("a/deeper/n", Fit::Unit, Some("c.sabi")),
            ("a/i/n", Fit::Unit, Some("lib/rust.sabi")),
            ("b/deeper/n", Fit::Unit, Some("c.sabi")),
            ("b/i/n", Fit::Unit, Some("lib/rust.sabi")),
            ("own", Fit::Length(2.0), None),
        ]
    );
    assert_eq!(graph.nodes[1].params["gain"], Value::Number(0.5));
    assert_eq!(graph.nodes[1].seeds, [0]);
    let error = flatten(&main, &Overrides::default(), &mut |_| Err("no such file".to_owned())).unwrap_err();
    let text = "node \"a\" needs the group file \"lib/rust.sabi\", which cannot be read: no such file";
    assert_eq!(error.to_string(), text);
    // Each of these files uses a group file in a deeper folder.
    let endless = document("", r#""a": { "kind": "graph/group", "group": "lib/rust.sabi" }"#);
    let error = flatten(&endless, &Overrides::default(), &mut |_| Ok(endless.clone())).unwrap_err();
    assert!(matches!(error, FlattenError::TooManyFiles { .. }), "{error}");
}

#[test]
fn a_group_file_that_contains_itself_is_reported_by_name() {
    let main = document("", r#""a": { "kind": "graph/group", "group": "lib/rust.sabi" }"#);
    let rust = document("", r#""r": { "kind": "graph/group", "group": "../lib/rust.sabi" }"#);
    let error = flatten(&main, &Overrides::default(), &mut |_| Ok(rust.clone()))
        .unwrap_err()
        .to_string();
    let text = "a group cannot hold itself: lib/rust.sabi → lib/rust.sabi; take one of these instances out";
    assert_eq!(error, text);
}
