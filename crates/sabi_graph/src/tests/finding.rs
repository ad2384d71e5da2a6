//! Finding, in a flat graph, where the results of the document's nodes come from.

use super::document;
use crate::{Document, FlattenError, NodeRef, Overrides, ResultOrigin, flatten_and_find};

/// Two instances of a group with two outputs and a reroute in it, and reroutes around them.
fn grouped() -> Document {
    document(
        r#""groups": { "wear": {
             "inputs": { "source": { "to": ["wire.source"] } },
             "outputs": { "edge": "cut.mask", "raw": "wire" },
             "nodes": {
               "cut": { "kind": "adjust/threshold", "inputs": { "source": "wire" } },
               "wire": { "kind": "graph/reroute" } } } },"#,
        r#""a": { "kind": "graph/group", "group": "wear", "inputs": { "source": "clouds" } },
           "b": { "kind": "graph/group", "group": "wear" },
           "bend": { "kind": "graph/reroute", "inputs": { "source": "a.raw" } },
           "clouds": { "kind": "noise/simplex" },
           "loose": { "kind": "graph/reroute" }"#,
    )
}

/// Finds the sources of the wanted results, as `id.port`.
fn found(wanted: &[&str]) -> Vec<Result<Option<String>, FlattenError>> {
    let wanted = wanted.iter().map(|text| {
        let (node, port) = text
            .split_once('.')
            .map_or((*text, None), |(node, port)| (node, Some(port)));
        NodeRef {
            node: node.to_owned(),
            port: port.map(str::to_owned),
        }
    });
    let wanted: Vec<NodeRef> = wanted.collect();
    let no_files = &mut |_: &str| Err("no files in this test".to_owned());
    let (graph, found) = flatten_and_find(&grouped(), &Overrides::default(), no_files, &wanted).unwrap();
    let named = |found: ResultOrigin| {
        found.map(|source| {
            let source = source?;
            let port = source.port.map(|port| format!(".{port}")).unwrap_or_default();
            Some(graph.nodes[source.node].id.clone() + &port)
        })
    };
    found.into_iter().map(named).collect()
}

#[test]
fn instances_and_reroutes_are_found_at_any_depth() {
    let wanted = [
        "clouds",
        "clouds.mask",
        "a",
        "a.edge",
        "a.raw",
        "a/cut",
        "a/wire",
        "b.edge",
        "bend",
    ];
    let sources = [
        "clouds",
        "clouds.mask",
        "a/cut.mask",
        "a/cut.mask",
        "clouds",
        "a/cut",
        "clouds",
        "b/cut.mask",
        "clouds",
    ];
    let sources = sources.map(|source| Ok(Some(source.to_owned())));
    assert_eq!(found(&wanted), sources);
}

#[test]
fn a_missing_or_unconnected_node_has_no_source() {
    assert_eq!(
        found(&["gone", "a/gone", "gone/cut", "loose", "b.raw", "b/wire", ""]),
        vec![Ok(None); 7]
    );
}

#[test]
fn a_wrong_output_name_does_not_affect_the_other_results() {
    let found = found(&["a.rim", "bend.x", "clouds"]);
    let texts: Vec<String> = found
        .iter()
        .filter_map(|found| found.as_ref().err())
        .map(ToString::to_string)
        .collect();
    assert!(texts[0].contains("edge") && texts[0].contains("raw"), "{}", texts[0]);
    assert_eq!(
        texts[1],
        "node \"bend\" is a reroute and has no output \"x\"; link from the node's id alone"
    );
    assert_eq!(found[2], Ok(Some("clouds".to_owned())));
}
