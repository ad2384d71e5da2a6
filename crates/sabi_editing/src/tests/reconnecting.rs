//! After nodes are deleted, their readers have the same sources as if the nodes were muted.

use super::*;

/// Describes each node that is not muted, with the sources of its inputs. Muted nodes pass inputs on, as in the planner.
fn heard(document: &OpenDocument) -> Vec<String> {
    let flat = flat(document);
    let entry = |at: usize| {
        kinds()
            .catalog
            .entry(&flat.nodes[at].kind)
            .expect("a built-in kind")
            .clone()
    };
    let behind = |from: &sabi_graph::FlatRef| {
        let mut ways = vec![from.clone()];
        let mut asked = std::collections::BTreeSet::new();
        while let Some(at) = ways.pop() {
            let node = &flat.nodes[at.node];
            if !node.muted {
                return format!("{} {:?}", node.kind, node.params);
            }
            if !asked.insert(at.node) {
                continue;
            }
            let entry = entry(at.node);
            let ty = entry.output(at.port.as_deref()).expect("a result").ty;
            let fitting = entry.inputs.iter().rev().filter(|port| port.ty == ty);
            ways.extend(fitting.filter_map(|port| node.inputs.get(&port.name)).cloned());
        }
        "nothing".to_owned()
    };
    let spoken = flat.nodes.iter().filter(|node| !node.muted);
    let mut heard: Vec<String> = spoken
        .map(|node| {
            let inputs = node
                .inputs
                .iter()
                .map(|(name, from)| format!("{name}: {}", behind(from)));
            let inputs: Vec<String> = inputs.filter(|told| !told.ends_with("nothing")).collect();
            format!("{} {:?} {inputs:?}", node.kind, node.params)
        })
        .collect();
    heard.sort();
    heard
}

/// Deletes nodes with reconnection, and compares the result with muting them.
fn heals_as_muting(mut document: OpenDocument, ids: &[&str]) -> OpenDocument {
    select(&mut document, ids);
    for text in ids {
        nodes::set_muted(&mut document, [id(text)], true);
    }
    let muted = heard(&document);
    for _ in ids {
        history::undo(&mut document);
    }
    select(&mut document, ids);
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(heard(&document), muted);
    document
}

const CHAIN: &str = r#"
    "n": { "kind": "noise/cells" }, "w": { "kind": "noise/white" },
    "one": { "kind": "adjust/levels", "inputs": { "source": "n" } },
    "two": { "kind": "blend/mask", "inputs": { "above": "one", "below": "w" } },
    "three": { "kind": "adjust/invert", "inputs": { "source": "two" } },
    "tint": { "kind": "color/gradient", "inputs": { "source": "three" } },
    "base": { "kind": "source/material" },
    "low": { "kind": "effect/relief", "inputs": { "base": "base", "mask": "three" } },
    "mix": { "kind": "material/blend", "inputs": { "above": "low", "mask": "three" } },
    "layer": { "kind": "effect/layer", "inputs": { "base": "mix", "mask": "three", "color_map": "tint" } },
    "out": { "kind": "output/material", "inputs": { "material": "layer" } }"#;

#[test]
fn readers_of_deleted_nodes_read_what_muting_would_give() {
    let document = heals_as_muting(opened("", CHAIN), &["one"]);
    assert_eq!(wire(&document, "two.above"), "n");
    let document = heals_as_muting(opened("", CHAIN), &["two", "three"]);
    assert_eq!(
        wire(&document, "layer.mask"),
        "w",
        "the first mask input is the one below"
    );
    let document = heals_as_muting(opened("", CHAIN), &["mix"]);
    assert_eq!(
        wire(&document, "layer.base"),
        "low",
        "nothing lies below, so the one above is passed on"
    );
    let document = heals_as_muting(opened("", CHAIN), &["tint"]);
    assert_eq!(
        wire(&document, "layer.color_map"),
        "",
        "a mask is no color that passes through"
    );
    let document = heals_as_muting(opened("", CHAIN), &["n", "w", "one"]);
    assert_eq!([wire(&document, "two.above"), wire(&document, "two.below")], ["", ""]);
    heals_as_muting(opened("", CHAIN), &["layer", "mix", "low", "base"]);
}

#[test]
fn an_input_with_a_muted_source_passes_nothing_and_the_next_input_is_used() {
    let nodes = r#""dead": { "kind": "noise/cells", "muted": true }, "n": { "kind": "noise/white" },
        "m": { "kind": "blend/mask", "inputs": { "below": "dead", "above": "n" } },
        "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#;
    let document = heals_as_muting(opened("", nodes), &["m"]);
    assert_eq!(wire(&document, "out.source"), "n");
    let silent = r#""dead": { "kind": "noise/cells", "muted": true },
        "m": { "kind": "adjust/levels", "inputs": { "source": "dead" } },
        "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#;
    let document = heals_as_muting(opened("", silent), &["m"]);
    assert_eq!(wire(&document, "out.source"), "dead", "it may speak again");
}

#[test]
fn wires_are_reconnected_through_reroutes() {
    let nodes = r#""n": { "kind": "noise/white" }, "r": { "kind": "graph/reroute", "inputs": { "source": "n" } },
        "m": { "kind": "adjust/levels", "inputs": { "source": "r" } }, "empty": { "kind": "graph/reroute" },
        "b": { "kind": "blend/mask", "inputs": { "below": "empty", "above": "m" } },
        "out": { "kind": "output/mask", "inputs": { "source": "b" } }"#;
    let mut document = opened("", nodes);
    select(&mut document, &["b", "m"]);
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(wire(&document, "out.source"), "r");
    select(&mut document, &["r"]);
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(wire(&document, "out.source"), "n");
}

/// A group that passes on its material input `over`, although other inputs come first by name.
const GROUP: &str = r#""groups": {
    "inner": { "inputs": { "mask": { "to": ["blend.mask"] }, "above": { "to": ["blend.above"] }, "over": { "to": ["blend.below"] } },
      "outputs": { "material": "blend", "edge": "n" },
      "nodes": { "blend": { "kind": "material/blend" }, "n": { "kind": "noise/white" } } },
    "outer": { "inputs": { "above": { "to": ["i.above"] }, "over": { "to": ["r.source"] } },
      "outputs": { "material": "i.material" },
      "nodes": { "r": { "kind": "graph/reroute" }, "i": { "kind": "graph/group", "group": "inner", "inputs": { "over": "r" } } } } },"#;

#[test]
fn wires_are_reconnected_through_groups_as_the_nodes_inside_pass_them_on() {
    let nodes = r#""a": { "kind": "source/material" }, "o": { "kind": "source/material", "params": { "roughness": 1 } },
        "g": { "kind": "graph/group", "group": "outer", "inputs": { "above": "a", "over": "o" } },
        "e": { "kind": "graph/group", "group": "inner" },
        "layer": { "kind": "effect/layer", "inputs": { "base": "g.material", "mask": "e.edge" } },
        "out": { "kind": "output/material", "inputs": { "material": "layer" } }"#;
    let document = heals_as_muting(opened(GROUP, nodes), &["g"]);
    assert_eq!(wire(&document, "layer.base"), "o");
    let document = heals_as_muting(opened(GROUP, nodes), &["e"]);
    assert_eq!(wire(&document, "layer.mask"), "");
}

#[test]
fn inputs_and_outputs_of_a_group_are_reconnected_inside_it() {
    let nodes = r#""o": { "kind": "source/material" },
        "g": { "kind": "graph/group", "group": "wear", "inputs": { "base": "o" } },
        "out": { "kind": "output/material", "inputs": { "material": "g.material" } }"#;
    let groups = r#""groups": { "wear": { "inputs": { "base": { "to": ["one.base"] } }, "outputs": { "material": "three" },
        "nodes": { "one": { "kind": "effect/layer" }, "two": { "kind": "effect/relief", "inputs": { "base": "one" } },
                   "three": { "kind": "material/adjust", "inputs": { "material": "two" } } } } },"#;
    let mut document = opened(groups, nodes);
    assert!(navigation::enter(&mut document, &id("g")));
    select(&mut document, &["one"]);
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(ports::inputs(&document)["base"].to, [to("two.base")]);
    select(&mut document, &["three"]);
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(ports::outputs(&document)["material"], from("two"));
    navigation::leave(&mut document);
    assert_eq!(wire(&document, "out.material"), "g.material");
    flat(&document);
}

#[test]
fn detached_nodes_keep_the_wires_between_them() {
    let mut document = opened("", CHAIN);
    select(&mut document, &["two", "three"]);
    step(&mut document, wires::detach_selected);
    assert_eq!(wire(&document, "layer.mask"), "w");
    assert_eq!(wire(&document, "three.source"), "two");
    assert_eq!([wire(&document, "two.above"), wire(&document, "two.below")], ["", ""]);
    assert_eq!(document.selection().len(), 2);
}

#[test]
fn reconnection_ends_for_groups_that_contain_themselves() {
    let groups = r#""groups": {
        "a": { "inputs": { "in": { "to": ["b.in"] } }, "outputs": { "out": "b.out" }, "nodes": { "b": { "kind": "graph/group", "group": "b" } } },
        "b": { "inputs": { "in": { "to": ["a.in"] } }, "outputs": { "out": "a.out" }, "nodes": { "a": { "kind": "graph/group", "group": "a" } } } },"#;
    let nodes = r#""n": { "kind": "noise/white" }, "g": { "kind": "graph/group", "group": "a", "inputs": { "in": "n" } },
        "out": { "kind": "output/mask", "inputs": { "source": "g.out" } }"#;
    let mut document = opened(groups, nodes);
    select(&mut document, &["g"]);
    assert!(
        clipboard::copy(&document).is_none(),
        "what holds itself cannot be told in order"
    );
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(wire(&document, "out.source"), "");
}

#[test]
fn detached_nodes_are_no_longer_fed_by_the_group() {
    let groups = r#""groups": { "G": { "inputs": { "base": { "to": ["one.base"] } }, "outputs": { "material": "two.material" },
        "nodes": { "one": { "kind": "effect/layer" }, "two": { "kind": "effect/relief", "inputs": { "base": "one" } } } } },"#;
    let mut document = opened(groups, r#""g": { "kind": "graph/group", "group": "G" }"#);
    assert!(navigation::enter(&mut document, &id("g")));
    select(&mut document, &["one"]);
    step(&mut document, wires::detach_selected);
    assert_eq!(ports::inputs(&document)["base"].to, [to("two.base")]);
}
