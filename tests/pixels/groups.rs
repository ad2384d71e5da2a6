//! Groups are inlined, so nesting costs no time and does not change results.

use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, OnMesh, project};

/// Number of groups nested in each other.
const DEPTH: usize = 6;

/// The three effects, each with its own color.
const EFFECTS: [(&str, &str); 3] = [("one", "#a03020"), ("three", "#2030a0"), ("two", "#20a030")];

fn effect(base: &str, mask: &str, color: &str) -> String {
    format!(
        r#"{{ "kind": "effect/layer", "inputs": {{ {base} "mask": "{mask}" }},
              "params": {{ "color": "{color}", "height": 0.02, "opacity": 0.5 }} }}"#
    )
}

const MASK: &str = r#""mask": { "kind": "noise/simplex", "params": { "size": 0.5, "octaves": 3, "seed": 5 } },
    "base": { "kind": "source/material", "params": { "color": "\#808080" } }"#;

/// Returns a graph in which one mask is passed through six nested groups to each of three effects, which are layered.
fn nested() -> String {
    let mut groups = Vec::new();
    for level in 1..=DEPTH {
        let inside = if level == DEPTH {
            effect("", "wire", "#ffffff")
        } else {
            format!(
                r#"{{ "kind": "graph/group", "group": "g{}", "inputs": {{ "base": "below", "mask": "wire" }} }}"#,
                level + 1
            )
        };
        let (inside, knob) = if level == DEPTH {
            (effect(r#""base": "below","#, "wire", "#ffffff"), "fx.color")
        } else {
            (inside, "fx.tint")
        };
        groups.push(format!(
            r#""g{level}": {{ "exposed": {{ "tint": {{ "to": ["{knob}"] }} }},
                "inputs": {{ "base": {{ "to": ["below.source"], "type": "material" }}, "mask": {{ "to": ["wire.source"] }} }},
                "outputs": {{ "material": "fx" }},
                "nodes": {{ "below": {{ "kind": "graph/reroute" }}, "wire": {{ "kind": "graph/reroute" }}, "fx": {inside} }} }}"#
        ));
    }
    let instance = |(id, color): (&str, &str), base: &str| {
        format!(
            r#""{id}": {{ "kind": "graph/group", "group": "g1", "inputs": {{ "base": "{base}", "mask": "mask" }},
                "params": {{ "tint": "{color}" }} }}"#
        )
    };
    let nodes = [
        instance(EFFECTS[0], "base"),
        instance(EFFECTS[1], "two"),
        instance(EFFECTS[2], "one"),
    ];
    format!(
        r#"{{ "format": "sabi", "version": 1, "groups": {{ {} }}, "nodes": {{ {MASK}, {} }} }}"#,
        groups.join(","),
        nodes.join(",")
    )
    .replace("\\#", "#")
}

fn flat() -> String {
    let base = |id: &str| format!(r#""base": "{id}","#);
    let nodes = [
        format!(r#""one": {}"#, effect(&base("base"), "mask", EFFECTS[0].1)),
        format!(r#""three": {}"#, effect(&base("two"), "mask", EFFECTS[1].1)),
        format!(r#""two": {}"#, effect(&base("one"), "mask", EFFECTS[2].1)),
    ];
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ {MASK}, {} }} }}"#,
        nodes.join(",")
    )
    .replace("\\#", "#")
}

#[test]
fn one_mask_through_six_groups_into_three_effects_gives_the_bytes_of_the_flat_graph() {
    let cube = project("assets/meshes/cube.glb");
    let mut nested = OnMesh::new(&nested(), &cube, 64);
    let mut flat = OnMesh::new(&flat(), &cube, 64);
    let inner = format!("three/{}", ["fx"; DEPTH].join("/"));
    for mode in [Mode::Bake { fuse: true }, Mode::Bake { fuse: false }, Mode::Interactive] {
        let asked = || EvaluationOptions {
            mode,
            ..EvaluationOptions::baked()
        };
        let (nested, flat) = (nested.evaluate_as(&inner, asked()), flat.evaluate_as("three", asked()));
        assert_eq!(nested.plan.passes(), flat.plan.passes(), "{mode:?}");
        assert!(nested.bytes() == flat.bytes(), "{mode:?}: the bytes differ");
    }
}
