//! Replacement of a node by a node of another kind.

use super::*;

#[test]
fn wires_knobs_labels_frames_and_the_panel_refer_to_the_new_node() {
    let mut document = opened(
        r#""exposed": { "wear": { "to": ["n.size", "n.lacunarity"], "label": "Wear" } },
           "frames": { "f": { "nodes": ["n", "levels"] } }, "outputs": { "mask": "n" },"#,
        r#""n": { "kind": "noise/simplex", "label": "Dust", "params": { "size": 0.5, "seed": 7, "octaves": 3 } },
           "levels": { "kind": "adjust/levels", "inputs": { "source": "n" } },
           "out": { "kind": "output/mask", "inputs": { "source": "levels" } }"#,
    );
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("n"), "noise/cells")
    });
    let new = document.selected_one().cloned().expect("the new node");
    assert!(document.node(&id("n")).is_none() && new.as_str().starts_with("cells_"));
    assert_eq!(document.title(&new), "Dust");
    let values = ["size", "seed", "octaves"].map(|name| param(&document, new.as_str(), name));
    assert_eq!(values, [number(0.5), number(7.0), None]);
    assert_eq!(wire(&document, "levels.source"), new.as_str());
    assert_eq!(document.graph().exposed()["wear"].to, [slot(&new, "size")]);
    assert_eq!(document.graph().frames()["f"].nodes, [new.clone(), id("levels")]);
    assert_eq!(ports::outputs(&document)["mask"], out(&new));
}

#[test]
fn wires_go_to_inputs_with_the_same_name_before_others_that_fit() {
    let nodes = r#""a": { "kind": "noise/cells" }, "b": { "kind": "noise/white" }, "c": { "kind": "source/material" },
        "d": { "kind": "source/material", "params": { "roughness": 1 } },
        "blend": { "kind": "material/blend", "inputs": { "above": "c", "below": "d", "mask": "a" } },
        "out": { "kind": "output/material", "inputs": { "material": "blend" } }"#;
    let mut document = opened("", nodes);
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("blend"), "effect/layer")
    });
    let layer = document.selected_one().cloned().expect("the new node");
    let wires = ["base", "mask", "color_map"].map(|input| wire(&document, &format!("{layer}.{input}")));
    assert_eq!(wires, ["d", "a", ""], "the material below comes first");
    assert_eq!(wire(&document, "out.material"), layer.as_str());
    // The new node has no input for a mask and no material output.
    step(&mut document, |document| {
        node_replacement::by_kind(document, &layer, "noise/simplex")
    });
    assert_eq!(wire(&document, "out.material"), "");
}

#[test]
fn a_value_that_the_new_kind_does_not_accept_is_dropped() {
    let mut document = opened(
        "",
        r#""n": { "kind": "noise/simplex", "params": { "size": 1e30, "stretch": [1, 2, 3], "mode": "ridged" } }"#,
    );
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("n"), "noise/cells")
    });
    let new = document.selected_one().cloned().expect("the new node");
    let values = ["size", "mode"].map(|name| param(&document, new.as_str(), name));
    assert_eq!(values, [None, None]);
    assert!(param(&document, new.as_str(), "stretch").is_some());
}

#[test]
fn a_node_in_a_group_is_replaced_and_stays_fed_by_the_group() {
    let mut document = opened(
        r#""groups": { "wear": { "inputs": { "where": { "to": ["levels.source"] } }, "outputs": { "mask": "levels" },
             "exposed": { "low": { "to": ["levels.low"] } },
             "nodes": { "levels": { "kind": "adjust/levels" } } } },"#,
        r#""n": { "kind": "noise/white" },
           "g": { "kind": "graph/group", "group": "wear", "inputs": { "where": "n" }, "params": { "low": 0.5 } },
           "out": { "kind": "output/mask", "inputs": { "source": "g" } }"#,
    );
    navigation::enter(&mut document, &id("g"));
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("levels"), "adjust/invert")
    });
    let new = document.selected_one().cloned().expect("the new node");
    assert_eq!(ports::inputs(&document)["where"].to, [slot(&new, "source")]);
    assert_eq!(ports::outputs(&document)["mask"], out(&new));
    // The new kind has no such knob, so the instance must not set it any more.
    navigation::leave(&mut document);
    assert_eq!(param(&document, "g", "low"), None);
    flat(&document);
}

#[test]
fn the_reason_why_a_node_cannot_be_replaced_is_reported() {
    let mut document = opened("", r#""n": { "kind": "noise/simplex" }"#);
    let said = refused(&mut document, |document| {
        node_replacement::by_kind(document, &id("n"), "noise/simplex")
    });
    assert_eq!(said, "this is a node of kind 'Clouds' already");
    let said = refused(&mut document, |document| {
        node_replacement::by_kind(document, &id("n"), "noise/nothing")
    });
    assert_eq!(said, "there is no node kind 'noise/nothing'");
}

#[test]
fn a_node_of_an_unknown_kind_can_be_replaced() {
    let mut document = opened(
        "",
        r#""a": { "kind": "noise/white" }, "n": { "kind": "magic/wand", "inputs": { "wood": "a" } },
           "l": { "kind": "adjust/levels", "inputs": { "source": "n" } }"#,
    );
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("n"), "adjust/invert")
    });
    let new = document.selected_one().cloned().expect("the new node");
    assert_eq!(wire(&document, &format!("{new}.source")), "a");
    assert_eq!(wire(&document, "l.source"), new.as_str());
}

#[test]
fn an_instance_can_replace_a_node_or_another_instance() {
    let groups = r#""groups": {
        "One": { "inputs": { "source": { "to": ["l.source"] } }, "outputs": { "mask": "l.mask" },
                 "nodes": { "l": { "kind": "adjust/levels" } } },
        "Two": { "inputs": { "source": { "to": ["i.source"] } }, "outputs": { "other": "i.mask" },
                 "nodes": { "i": { "kind": "adjust/invert" } } } },"#;
    let nodes = r#""a": { "kind": "noise/cells" }, "x": { "kind": "adjust/clamp", "inputs": { "source": "a" }, "pos": [30, 40] },
        "out": { "kind": "output/mask", "inputs": { "source": "x" } }"#;
    let mut document = opened(groups, nodes);
    for (group, output) in [("One", "mask"), ("Two", "other")] {
        let before = connections::wire_into(&document, &to("out.source"))
            .expect("a wire")
            .node
            .clone();
        assert!(step(&mut document, |document| node_replacement::by_group(
            document, &before, group
        )));
        let now = document.selected_one().cloned().expect("the instance");
        assert_eq!(wire(&document, &format!("{now}.source")), "a");
        assert_eq!(wire(&document, "out.source"), format!("{now}.{output}"));
        assert_eq!(document.node(&now).map(|node| node.pos), Some([30.0, 40.0]));
    }
    let now = document.selected_one().cloned().expect("the instance");
    let said = refused(&mut document, |document| {
        node_replacement::by_group(document, &now, "Two")
    });
    assert!(said.starts_with("this is a node of kind"), "{said}");
    flat(&document);
}
