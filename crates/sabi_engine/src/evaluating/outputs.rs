//! Outputs of a graph, and the materials that they serve.

use std::collections::BTreeMap;

use sabi_export::Channel;
use sabi_graph::{FlatGraph, FlatNode};

use crate::source::{OUTPUT_MATERIAL, claim, map_output};

/// Lists the outputs that are not muted, ordered by id.
pub(crate) fn outputs(graph: &FlatGraph) -> Vec<usize> {
    let mut found: Vec<usize> = all_outputs(graph).filter(|&node| !graph.nodes[node].muted).collect();
    found.sort_by_key(|&node| &graph.nodes[node].id);
    found
}

/// Filters the material outputs.
pub(crate) fn materials(graph: &FlatGraph, outputs: &[usize]) -> Vec<usize> {
    let nodes = outputs.iter().copied();
    nodes
        .filter(|&node| graph.nodes[node].kind == OUTPUT_MATERIAL)
        .collect()
}

/// Filters the outputs that become separate maps, with their channels.
pub(crate) fn map_outputs(graph: &FlatGraph, outputs: &[usize]) -> Vec<(usize, Channel)> {
    let nodes = outputs.iter().copied();
    nodes
        .filter_map(|node| Some((node, map_output(&graph.nodes[node])?)))
        .collect()
}

/// Returns all outputs. A material output inside a group, which is used when the group is opened by itself, counts only if
/// the graph has no output of its own.
fn all_outputs(graph: &FlatGraph) -> impl Iterator<Item = usize> {
    let is_own = |node: &FlatNode| !node.id.contains('/');
    let has_own = graph
        .nodes
        .iter()
        .any(|node| node.kind == OUTPUT_MATERIAL && is_own(node));
    let is_output = move |index: &usize| {
        let node = &graph.nodes[*index];
        match node.kind.as_str() {
            OUTPUT_MATERIAL => is_own(node) || !has_own,
            _ => map_output(node).is_some(),
        }
    };
    (0..graph.nodes.len()).filter(is_output)
}

/// Explains why a graph has no output, if it has none.
pub(crate) fn missing_output(graph: &FlatGraph) -> Option<String> {
    if !outputs(graph).is_empty() {
        return None;
    }
    let muted = quoted(all_outputs(graph).map(|node| graph.nodes[node].id.as_str()));
    Some(match all_outputs(graph).count() {
        0 => format!("the graph has no output; add a node of kind '{OUTPUT_MATERIAL}' and connect its material"),
        1 => format!("the graph's only output {muted} is muted; unmute it"),
        _ => format!("all outputs of the graph are muted ({muted}); unmute one"),
    })
}

/// Lists outputs whose maps would have the same file name, with a sentence for each.
pub(crate) fn duplicate_map_names(graph: &FlatGraph) -> Vec<String> {
    let mut taken: BTreeMap<String, (usize, String)> = BTreeMap::new();
    let mut sentences = Vec::new();
    for (node, channel) in map_outputs(graph, &outputs(graph)) {
        let name = channel.name().into_owned();
        // Many file systems ignore case.
        match taken.get(&name.to_lowercase()) {
            Some((first, other)) => {
                let export = match *other == name {
                    true => format!("both export a map named '{name}'"),
                    false => format!(
                        "export maps named '{other}' and '{name}', which are one file on systems that ignore capital letters"
                    ),
                };
                let [first, second] = [*first, node].map(|node| &graph.nodes[node]);
                sentences.push(format!(
                    "nodes '{}' and '{}' ({}) {export}; give one of them another name",
                    first.id, second.id, second.kind
                ));
            }
            None => {
                taken.insert(name.to_lowercase(), (node, name));
            }
        }
    }
    sentences
}

/// Finds the output that serves each of the model's materials, given their names. An output that lists the material has
/// priority over one for all materials. Among equals, the first by id is used.
pub(crate) fn serving_outputs(graph: &FlatGraph, outputs: &[usize], names: &[[&str; 2]]) -> Vec<Option<usize>> {
    let nodes = materials(graph, outputs);
    let of = |names: &[&str; 2]| {
        let claims = nodes
            .iter()
            .filter_map(|&node| Some((claim(&graph.nodes[node], names)?, node)));
        // Among equals, `min_by_key` returns the first.
        claims.min_by_key(|(claim, _)| *claim).map(|(_, node)| node)
    };
    names.iter().map(of).collect()
}

/// Lists the outputs that serve no material of the model, with a sentence for each.
pub(crate) fn unused_outputs(graph: &FlatGraph, outputs: &[usize], names: &[[&str; 2]]) -> Vec<String> {
    let served = serving_outputs(graph, outputs, names);
    let nodes = materials(graph, outputs).into_iter();
    let unused = nodes.filter(|&node| !served.contains(&Some(node)));
    let sentence = |node: usize| {
        let id = &graph.nodes[node].id;
        if names.iter().any(|names| claim(&graph.nodes[node], names).is_some()) {
            return format!("output '{id}' serves no material: other outputs serve all that it could");
        }
        let has = quoted(names.iter().map(|[name, _]| *name));
        format!("output '{id}' serves no material: its 'materials' lists none of the model's, which are {has}")
    };
    unused.map(sentence).collect()
}

/// Joins quoted names with commas.
pub(crate) fn quoted<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use sabi_graph::{Document, FlatGraph, Overrides, flatten};

    use super::*;

    fn flat(nodes: &str) -> FlatGraph {
        let text = format!(r#"{{ "format": "sabi", "version": 1, "name": "t", "nodes": {{ {nodes} }} }}"#);
        let document = Document::from_json(&text).unwrap();
        flatten(&document, &Overrides::default(), &mut |_| Err(String::new())).unwrap()
    }

    fn output(id: &str, materials: &str) -> String {
        format!(r#""{id}": {{ "kind": "output/material", "params": {{ "materials": "{materials}" }} }}"#)
    }

    /// Finds the ids of the outputs that serve wood, steel and glass.
    fn ids_of_serving(graph: &FlatGraph) -> Vec<Option<&str>> {
        let names = [["wood", "wood"], ["steel, raw", "steel, raw"], ["gl/ass", "gl_ass"]];
        let served = serving_outputs(graph, &outputs(graph), &names).into_iter();
        served
            .map(|node| node.map(|node| graph.nodes[node].id.as_str()))
            .collect()
    }

    #[test]
    fn an_output_that_lists_a_material_wins_over_one_that_takes_all() {
        let cases = [
            (
                vec![output("a", "*"), output("b", "wood")],
                [Some("b"), Some("a"), Some("a")],
            ),
            (vec![output("b", "*"), output("a", "*")], [Some("a"); 3]),
            (
                vec![output("b", "wood"), output("a", "x, wood")],
                [Some("a"), None, None],
            ),
            (
                vec![output("b", "wood, *"), output("a", "*")],
                [Some("b"), Some("a"), Some("a")],
            ),
            (vec![output("a", "steel, raw")], [None, Some("a"), None]),
            (
                vec![output("a", "gl_ass"), output("b", "gl/ass")],
                [None, None, Some("a")],
            ),
            (vec![output("a", "")], [None; 3]),
        ];
        for (nodes, expected) in cases {
            assert_eq!(ids_of_serving(&flat(&nodes.join(","))), expected, "{nodes:?}");
        }
    }

    #[test]
    fn an_output_that_serves_no_material_is_reported() {
        let names = [["wood", "wood"], ["steel", "steel"]];
        let graph = flat(&[output("a", "*"), output("b", "*"), output("c", "wod")].join(","));
        assert_eq!(
            unused_outputs(&graph, &outputs(&graph), &names),
            [
                "output 'b' serves no material: other outputs serve all that it could",
                "output 'c' serves no material: its 'materials' lists none of the model's, which are 'wood', 'steel'",
            ]
        );
    }

    #[test]
    fn outputs_that_would_share_a_file_are_named() {
        let mask =
            |id: &str, name: &str| format!(r#""{id}": {{ "kind": "output/mask", "params": {{ "name": "{name}" }} }}"#);
        let graph = flat(
            &[
                mask("a", "Wear"),
                mask("b", "wear"),
                mask("c", "rust"),
                mask("d", "height"),
            ]
            .join(","),
        );
        assert_eq!(
            duplicate_map_names(&graph),
            [
                "nodes 'a' and 'b' (output/mask) export maps named 'Wear' and 'wear', which are one file on systems that ignore \
                 capital letters; give one of them another name"
            ]
        );
        let color = mask("b", "Wear").replace("output/mask", "output/color");
        assert_eq!(
            duplicate_map_names(&flat(&[mask("a", "wear"), color].join(","))),
            [
                "nodes 'a' and 'b' (output/color) export maps named 'wear' and 'Wear', which are one file on systems that ignore \
                 capital letters; give one of them another name"
            ]
        );
        assert_eq!(
            duplicate_map_names(&flat(&[mask("a", "wear"), mask("b", "wear")].join(","))),
            ["nodes 'a' and 'b' (output/mask) both export a map named 'wear'; give one of them another name"]
        );
        let muted = mask("b", "Wear").replace("\"params\"", "\"muted\": true, \"params\"");
        assert!(duplicate_map_names(&flat(&[mask("a", "Wear"), muted].join(","))).is_empty());
    }

    #[test]
    fn a_graph_without_outputs_has_an_error_that_says_why() {
        let muted = |id: &str| format!(r#""{id}": {{ "kind": "output/mask", "muted": true }}"#);
        let cases = [
            (
                String::new(),
                Some("the graph has no output; add a node of kind 'output/material' and connect its material"),
            ),
            (muted("a"), Some("the graph's only output 'a' is muted; unmute it")),
            (
                [muted("a"), muted("b")].join(","),
                Some("all outputs of the graph are muted ('a', 'b'); unmute one"),
            ),
            ([muted("a"), output("b", "*")].join(","), None),
        ];
        for (nodes, words) in cases {
            assert_eq!(missing_output(&flat(&nodes)).as_deref(), words, "{nodes}");
        }
    }
}
