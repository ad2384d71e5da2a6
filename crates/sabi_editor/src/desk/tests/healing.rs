//! What readers get when nodes before them go: what muting those would give.

use super::*;

/// What an output is made of once muted nodes are pieces of wire, as the planner has it.
fn heard(desk: &Desk) -> Vec<String> {
    let flat = flat(desk);
    let entry = |at: usize| kinds().1.entry(&flat.nodes[at].kind).expect("a built-in kind").clone();
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

/// Deletes nodes with healing, and compares with muting them.
fn heals_as_muting(mut desk: Desk, ids: &[&str]) -> Desk {
    select(&mut desk, ids);
    for text in ids {
        desk.set_muted([id(text)], true);
    }
    let muted = heard(&desk);
    for _ in ids {
        desk.undo();
    }
    select(&mut desk, ids);
    step(&mut desk, |desk| desk.delete(true));
    assert_eq!(heard(&desk), muted);
    desk
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
fn readers_get_what_muting_would_give() {
    let desk = heals_as_muting(opened("", CHAIN), &["one"]);
    assert_eq!(wire(&desk, "two.above"), "n");
    let desk = heals_as_muting(opened("", CHAIN), &["two", "three"]);
    assert_eq!(wire(&desk, "layer.mask"), "w", "the first mask input is the one below");
    let desk = heals_as_muting(opened("", CHAIN), &["mix"]);
    assert_eq!(
        wire(&desk, "layer.base"),
        "low",
        "nothing lies below, so the one above is passed on"
    );
    let desk = heals_as_muting(opened("", CHAIN), &["tint"]);
    assert_eq!(
        wire(&desk, "layer.color_map"),
        "",
        "a mask is no color that passes through"
    );
    let desk = heals_as_muting(opened("", CHAIN), &["n", "w", "one"]);
    assert_eq!([wire(&desk, "two.above"), wire(&desk, "two.below")], ["", ""]);
    heals_as_muting(opened("", CHAIN), &["layer", "mix", "low", "base"]);
}

#[test]
fn an_input_with_a_mute_source_passes_nothing_and_the_next_one_does() {
    let nodes = r#""dead": { "kind": "noise/cells", "muted": true }, "n": { "kind": "noise/white" },
        "m": { "kind": "blend/mask", "inputs": { "below": "dead", "above": "n" } },
        "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#;
    let desk = heals_as_muting(opened("", nodes), &["m"]);
    assert_eq!(wire(&desk, "out.source"), "n");
    let silent = r#""dead": { "kind": "noise/cells", "muted": true },
        "m": { "kind": "adjust/levels", "inputs": { "source": "dead" } },
        "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#;
    let desk = heals_as_muting(opened("", silent), &["m"]);
    assert_eq!(wire(&desk, "out.source"), "dead", "it may speak again");
}

#[test]
fn wires_heal_through_bends() {
    let nodes = r#""n": { "kind": "noise/white" }, "r": { "kind": "graph/reroute", "inputs": { "source": "n" } },
        "m": { "kind": "adjust/levels", "inputs": { "source": "r" } }, "empty": { "kind": "graph/reroute" },
        "b": { "kind": "blend/mask", "inputs": { "below": "empty", "above": "m" } },
        "out": { "kind": "output/mask", "inputs": { "source": "b" } }"#;
    let mut desk = opened("", nodes);
    select(&mut desk, &["b", "m"]);
    step(&mut desk, |desk| desk.delete(true));
    assert_eq!(wire(&desk, "out.source"), "r");
    select(&mut desk, &["r"]);
    step(&mut desk, |desk| desk.delete(true));
    assert_eq!(wire(&desk, "out.source"), "n");
}

/// A group that passes its material input `over` on, whatever stands before that by name.
const GROUP: &str = r#""groups": {
    "inner": { "inputs": { "mask": { "to": ["blend.mask"] }, "above": { "to": ["blend.above"] }, "over": { "to": ["blend.below"] } },
      "outputs": { "material": "blend", "edge": "n" },
      "nodes": { "blend": { "kind": "material/blend" }, "n": { "kind": "noise/white" } } },
    "outer": { "inputs": { "above": { "to": ["i.above"] }, "over": { "to": ["r.source"] } },
      "outputs": { "material": "i.material" },
      "nodes": { "r": { "kind": "graph/reroute" }, "i": { "kind": "graph/group", "group": "inner", "inputs": { "over": "r" } } } } },"#;

#[test]
fn wires_heal_through_groups_as_their_inside_would_pass_them_on() {
    let nodes = r#""a": { "kind": "source/material" }, "o": { "kind": "source/material", "params": { "roughness": 1 } },
        "g": { "kind": "graph/group", "group": "outer", "inputs": { "above": "a", "over": "o" } },
        "e": { "kind": "graph/group", "group": "inner" },
        "layer": { "kind": "effect/layer", "inputs": { "base": "g.material", "mask": "e.edge" } },
        "out": { "kind": "output/material", "inputs": { "material": "layer" } }"#;
    let desk = heals_as_muting(opened(GROUP, nodes), &["g"]);
    assert_eq!(wire(&desk, "layer.base"), "o");
    let desk = heals_as_muting(opened(GROUP, nodes), &["e"]);
    assert_eq!(wire(&desk, "layer.mask"), "");
}

#[test]
fn inside_a_group_its_inputs_and_outputs_heal_too() {
    let nodes = r#""o": { "kind": "source/material" },
        "g": { "kind": "graph/group", "group": "wear", "inputs": { "base": "o" } },
        "out": { "kind": "output/material", "inputs": { "material": "g.material" } }"#;
    let groups = r#""groups": { "wear": { "inputs": { "base": { "to": ["one.base"] } }, "outputs": { "material": "three" },
        "nodes": { "one": { "kind": "effect/layer" }, "two": { "kind": "effect/relief", "inputs": { "base": "one" } },
                   "three": { "kind": "material/adjust", "inputs": { "material": "two" } } } } },"#;
    let mut desk = opened(groups, nodes);
    assert!(desk.enter(&id("g")));
    select(&mut desk, &["one"]);
    step(&mut desk, |desk| desk.delete(true));
    assert_eq!(desk.group_inputs()["base"].to, [to("two.base")]);
    select(&mut desk, &["three"]);
    step(&mut desk, |desk| desk.delete(true));
    assert_eq!(desk.group_outputs()["material"], from("two"));
    desk.leave();
    assert_eq!(wire(&desk, "out.material"), "g.material");
    flat(&desk);
}

#[test]
fn what_is_taken_out_of_its_wires_keeps_those_among_itself() {
    let mut desk = opened("", CHAIN);
    select(&mut desk, &["two", "three"]);
    step(&mut desk, Desk::take_out);
    assert_eq!(wire(&desk, "layer.mask"), "w");
    assert_eq!(wire(&desk, "three.source"), "two");
    assert_eq!([wire(&desk, "two.above"), wire(&desk, "two.below")], ["", ""]);
    assert_eq!(desk.selection().len(), 2);
}

#[test]
fn groups_that_hold_themselves_end_a_heal_all_the_same() {
    let groups = r#""groups": {
        "a": { "inputs": { "in": { "to": ["b.in"] } }, "outputs": { "out": "b.out" }, "nodes": { "b": { "kind": "graph/group", "group": "b" } } },
        "b": { "inputs": { "in": { "to": ["a.in"] } }, "outputs": { "out": "a.out" }, "nodes": { "a": { "kind": "graph/group", "group": "a" } } } },"#;
    let nodes = r#""n": { "kind": "noise/white" }, "g": { "kind": "graph/group", "group": "a", "inputs": { "in": "n" } },
        "out": { "kind": "output/mask", "inputs": { "source": "g.out" } }"#;
    let mut desk = opened(groups, nodes);
    select(&mut desk, &["g"]);
    assert!(desk.copied().is_none(), "what holds itself cannot be told in order");
    step(&mut desk, |desk| desk.delete(true));
    assert_eq!(wire(&desk, "out.source"), "");
}

#[test]
fn what_is_taken_out_of_its_wires_is_not_fed_from_outside_any_more() {
    let groups = r#""groups": { "G": { "inputs": { "base": { "to": ["one.base"] } }, "outputs": { "material": "two.material" },
        "nodes": { "one": { "kind": "effect/layer" }, "two": { "kind": "effect/relief", "inputs": { "base": "one" } } } } },"#;
    let mut desk = opened(groups, r#""g": { "kind": "graph/group", "group": "G" }"#);
    assert!(desk.enter(&id("g")));
    select(&mut desk, &["one"]);
    step(&mut desk, Desk::take_out);
    assert_eq!(desk.group_inputs()["base"].to, [to("two.base")]);
}
