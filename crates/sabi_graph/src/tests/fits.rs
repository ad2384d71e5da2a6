//! Fits of the nodes of a flat graph: each node has the fit that its lengths were written for.

use crate::{Document, Fit, Overrides, flatten};

const TEXT: &str = r#"{ "format": "sabi", "version": 1, "fit": "metres",
    "groups": {
        "made_for_two": { "fit": 2, "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "x" } } },
        "plain": { "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "x" } } } },
    "nodes": {
        "a": { "kind": "graph/group", "group": "made_for_two" },
        "b": { "kind": "graph/group", "group": "plain" },
        "c": { "kind": "x" },
        "d": { "kind": "graph/group", "group": "other.sabi" } } }"#;

const FILE: &str =
    r#"{ "format": "sabi", "version": 1, "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "x" } } }"#;

fn fits(fit: Option<Fit>) -> Vec<(String, Fit)> {
    let document = Document::from_json(TEXT).unwrap();
    let overrides = Overrides {
        fit,
        ..Overrides::default()
    };
    let mut read = |_: &str| Document::from_json(FILE).map_err(|error| error.to_string());
    let graph = flatten(&document, &overrides, &mut read).unwrap();
    graph.nodes.into_iter().map(|node| (node.id, node.fit)).collect()
}

#[test]
fn a_group_keeps_its_own_fit_and_all_other_nodes_take_the_override() {
    let named = |c: Fit| {
        [
            ("a/n".to_owned(), Fit::Length(2.0)),
            ("b/n".to_owned(), c),
            ("c".to_owned(), c),
            ("d/n".to_owned(), Fit::Unit),
        ]
    };
    assert_eq!(fits(None), named(Fit::Metres));
    assert_eq!(fits(Some(Fit::Length(5.0))), named(Fit::Length(5.0)));
}

#[test]
fn the_fit_of_an_instance_applies_to_everything_inside() {
    let text = TEXT.replace(
        r#""group": "made_for_two" },"#,
        r#""group": "made_for_two", "params": { "fit": "piece" } },"#,
    );
    let document = Document::from_json(&text).unwrap();
    let mut read = |_: &str| Document::from_json(FILE).map_err(|error| error.to_string());
    let graph = flatten(&document, &Overrides::default(), &mut read).unwrap();
    let fits: Vec<Fit> = graph.nodes.into_iter().map(|node| node.fit).collect();
    assert_eq!(fits, [Fit::Piece, Fit::Metres, Fit::Metres, Fit::Unit]);
}
