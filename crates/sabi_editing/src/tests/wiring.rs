//! Connecting, cutting, inserting, merging.

use super::*;

fn two_masks() -> OpenDocument {
    opened(
        r#""groups": { "two": { "outputs": { "mask": "n", "other": "n.id" }, "nodes": { "n": { "kind": "noise/cells" } } } },"#,
        r#""a": { "kind": "noise/cells" }, "b": { "kind": "noise/white" },
           "g": { "kind": "graph/group", "group": "two" },
           "levels": { "kind": "adjust/levels", "inputs": { "source": "a" } },
           "base": { "kind": "source/material" },
           "layer": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "levels" } },
           "out": { "kind": "output/material", "inputs": { "material": "layer" } }"#,
    )
}

#[test]
fn a_new_wire_replaces_the_old_one() {
    let mut document = two_masks();
    step(&mut document, |document| {
        wires::connect(document, &from("b"), &to("levels.source"))
    });
    assert_eq!(wire(&document, "levels.source"), "b");
    step(&mut document, |document| {
        wires::disconnect(
            document,
            &[to("levels.source"), to("layer.mask"), to("layer.color_map")],
        )
    });
    assert_eq!(
        [wire(&document, "levels.source"), wire(&document, "layer.mask")],
        ["", ""]
    );
}

#[test]
fn a_wire_from_the_first_output_names_only_the_node_unless_it_is_a_group() {
    let mut document = two_masks();
    wires::connect(&mut document, &from("a.mask"), &to("levels.source"));
    assert_eq!(wire(&document, "levels.source"), "a");
    wires::connect(&mut document, &from("a.id"), &to("levels.source"));
    assert_eq!(wire(&document, "levels.source"), "a.id");
    for port in ["g", "g.mask"] {
        wires::connect(&mut document, &from(port), &to("levels.source"));
        // A wire from a group always names the output, since the group has two outputs, or may get a second one later.
        assert_eq!(wire(&document, "levels.source"), "g.mask");
    }
    flat(&document);
}

#[test]
fn a_wire_that_does_not_fit_is_refused_with_the_reason() {
    let mut document = two_masks();
    let mut said = |from_: &str, to_: &str| {
        refused(&mut document, |document| {
            wires::connect(document, &from(from_), &to(to_))
        })
    };
    assert_eq!(
        said("a", "layer.base"),
        "'Base' takes a material, and this wire carries a mask; only masks and colors are converted"
    );
    assert_eq!(said("layer", "layer.base"), "'Layer' cannot read its own result");
    assert_eq!(said("levels", "levels.source"), "'Levels' cannot read its own result");
    assert_eq!(said("out", "layer.base"), "'Material output' gives no result");
    assert_eq!(said("a.nothing", "levels.source"), "'Cells' gives no result 'nothing'");
    assert_eq!(said("a", "levels.nothing"), "'Levels' has no input 'nothing'");
    assert_eq!(
        said("levels", "a.position"),
        "'Position' takes a vector, and this wire carries a mask; only masks and colors are converted"
    );
    let invert = add(&mut document, "adjust/invert");
    wires::connect(&mut document, &from("levels"), &slot(&invert, "source"));
    let said = refused(&mut document, |document| {
        wires::connect(document, &out(&invert), &to("levels.source"))
    });
    assert_eq!(
        said,
        "'Invert' depends on 'Levels' already; this wire would close a loop"
    );
}

#[test]
fn a_reroute_accepts_what_its_readers_accept() {
    let mut document = two_masks();
    step(&mut document, |document| {
        wires::reroute(document, &to("layer.base"), [0.0; 2])
    });
    let bend = wire(&document, "layer.base");
    assert_eq!(wire(&document, &format!("{bend}.source")), "base");
    let said = refused(&mut document, |document| {
        wires::connect(document, &from("a"), &to(&format!("{bend}.source")))
    });
    assert!(said.starts_with("'Base' takes a material"), "{said}");
    // A reroute without readers accepts any type, whatever it reads now.
    wires::disconnect(&mut document, &[to("layer.base")]);
    assert!(wires::connect(
        &mut document,
        &from("a"),
        &to(&format!("{bend}.source"))
    ));
    let said = refused(&mut document, |document| {
        wires::connect(document, &from(&bend), &to("layer.base"))
    });
    assert!(said.starts_with("'Base' takes a material"), "{said}");
}

#[test]
fn a_node_is_inserted_into_a_wire() {
    let mut document = two_masks();
    let invert = add(&mut document, "adjust/invert");
    assert!(wires::can_insert(&document, &invert, &to("layer.mask")));
    step(&mut document, |document| {
        wires::insert(document, &invert, &to("layer.mask"))
    });
    assert_eq!(wire(&document, &format!("{invert}.source")), "levels");
    assert_eq!(wire(&document, "layer.mask"), invert.as_str());
}

#[test]
fn a_node_is_inserted_into_a_wire_by_a_free_input() {
    let mut document = two_masks();
    let blend = add(&mut document, "blend/mask");
    wires::connect(&mut document, &from("b"), &slot(&blend, "below"));
    step(&mut document, |document| {
        wires::insert(document, &blend, &to("layer.mask"))
    });
    assert_eq!(wire(&document, &format!("{blend}.above")), "levels");
    assert_eq!(wire(&document, &format!("{blend}.below")), "b");
}

#[test]
fn a_node_that_does_not_fit_is_not_inserted_into_a_wire() {
    let mut document = two_masks();
    let relief = add(&mut document, "effect/relief");
    let why = "to insert a node into a wire, its output must be unconnected, and it needs a free input and an output of fitting types";
    for (node, input) in [
        (relief.clone(), "layer.mask"),
        (id("levels"), "layer.mask"),
        (id("layer"), "out.material"),
        (id("out"), "layer.mask"),
        (id("base"), "out.material"),
        (id("lost"), "layer.mask"),
        (relief, "layer.color_map"),
    ] {
        assert!(!wires::can_insert(&document, &node, &to(input)), "{node} into {input}");
        assert_eq!(
            refused(&mut document, |document| wires::insert(document, &node, &to(input))),
            why
        );
    }
}

#[test]
fn a_node_is_not_inserted_before_a_node_it_depends_on() {
    let mut document = opened(
        "",
        r#""a": { "kind": "noise/cells" }, "levels": { "kind": "adjust/levels", "inputs": { "source": "a" } },
           "blend": { "kind": "blend/mask", "inputs": { "mask": "levels" } }"#,
    );
    assert!(!wires::can_insert(&document, &id("blend"), &to("levels.source")));
    let said = refused(&mut document, |document| {
        wires::insert(document, &id("blend"), &to("levels.source"))
    });
    assert!(said.starts_with("to insert a node into a wire"), "{said}");
}

#[test]
fn a_second_mask_is_blended_with_the_first_one() {
    let mut document = two_masks();
    assert!(wires::can_merge(&document, &from("b"), &to("layer.mask")));
    for same in ["levels", "levels.mask"] {
        assert!(
            !wires::can_merge(&document, &from(same), &to("layer.mask")),
            "it is there already"
        );
    }
    assert!(
        !wires::can_merge(&document, &from("b"), &to("layer.base"))
            && !wires::can_merge(&document, &from("b"), &to("layer.height_map"))
    );
    for (_, how) in MaskMerge::OFFERED {
        let MaskMerge::Blend(mode) = how else { continue };
        step(&mut document, |document| {
            wires::merge(document, &from("b"), &to("layer.mask"), how)
        });
        let blend = wire(&document, "layer.mask");
        assert_eq!(wire(&document, &format!("{blend}.below")), "levels");
        assert_eq!(wire(&document, &format!("{blend}.above")), "b");
        assert_eq!(param(&document, &blend, "mode"), Some(Value::from(mode)));
        let interface = document.interface(&id(&blend)).expect("an interface").clone();
        let sabi_nodes::kind::Role::Choice(words) = &interface.knob("mode").expect("a mode").ty.role else {
            panic!("a mode is a choice");
        };
        assert!(words.iter().any(|word| word == mode), "{mode}");
        history::undo(&mut document);
    }
    step(&mut document, |document| {
        wires::merge(document, &from("b"), &to("layer.mask"), MaskMerge::Replace)
    });
    assert_eq!(wire(&document, "layer.mask"), "b");
}

#[test]
fn a_mask_is_not_merged_into_its_own_source() {
    let mut document = two_masks();
    let invert = add(&mut document, "adjust/invert");
    wires::connect(&mut document, &from("levels"), &slot(&invert, "source"));
    let said = refused(&mut document, |document| {
        wires::merge(document, &out(&invert), &to("levels.source"), MaskMerge::Blend("add"))
    });
    assert_eq!(
        said,
        "'Invert' depends on 'Levels' already; this wire would close a loop"
    );
}

#[test]
fn swapping_inputs_also_swaps_the_knobs_of_unconnected_inputs() {
    let mut document = opened(
        "",
        r#""a": { "kind": "noise/cells" },
           "m": { "kind": "blend/mask", "inputs": { "above": "a" }, "params": { "below": 0.25 } },
           "alone": { "kind": "blend/mask" }"#,
    );
    select(&mut document, &["m", "alone"]);
    step(&mut document, wires::swap_inputs);
    assert_eq!([wire(&document, "m.below"), wire(&document, "m.above")], ["a", ""]);
    assert_eq!(
        [param(&document, "m", "below"), param(&document, "m", "above")],
        [None, number(0.25)]
    );
    step(&mut document, wires::swap_inputs);
    assert_eq!([wire(&document, "m.below"), wire(&document, "m.above")], ["", "a"]);
}

#[test]
fn swapping_inputs_also_swaps_the_inputs_of_the_group_that_feed_them() {
    let groups = r#""groups": { "G": {
        "inputs": { "one": { "to": ["m.below", "other.below"] }, "two": { "to": [] } },
        "outputs": { "mask": "m.mask" },
        "nodes": { "a": { "kind": "noise/cells" }, "other": { "kind": "blend/mask" },
                   "m": { "kind": "blend/mask", "inputs": { "above": "a" } } } } },"#;
    let mut document = opened(groups, r#""g": { "kind": "graph/group", "group": "G" }"#);
    assert!(navigation::enter(&mut document, &id("g")));
    select(&mut document, &["m"]);
    step(&mut document, wires::swap_inputs);
    assert_eq!([wire(&document, "m.below"), wire(&document, "m.above")], ["a", ""]);
    assert_eq!(ports::inputs(&document)["one"].to, [to("other.below"), to("m.above")]);
    step(&mut document, wires::swap_inputs);
    assert_eq!(wire(&document, "m.above"), "a");
    assert_eq!(ports::inputs(&document)["one"].to, [to("other.below"), to("m.below")]);
}

#[test]
fn connecting_a_height_sets_a_visible_strength_unless_one_was_set() {
    let mut document = document();
    let layer = add(&mut document, "effect/layer");
    let clouds = add(&mut document, "noise/simplex");
    let height = |document: &OpenDocument| document.node(&layer).expect("a node").params.get("height").cloned();
    let from = OutputRef {
        node: clouds,
        port: None,
    };
    let to = SlotRef {
        node: layer.clone(),
        name: "height_map".to_owned(),
    };
    assert!(wires::connect(&mut document, &from, &to));
    assert_eq!(height(&document), Some(Value::Number(0.01)));
    history::undo(&mut document);
    assert_eq!(height(&document), None, "one step");
    nodes::set_knob(&mut document, &layer, "height", number(-0.2));
    assert!(wires::connect(&mut document, &from, &to));
    assert_eq!(height(&document), Some(Value::Number(-0.2)));
    // Inserting a node into the wire sets the value, too.
    nodes::set_knob(&mut document, &layer, "height", None);
    let pending = PendingWire::Into(to);
    assert!(nodes::add(&mut document, "noise/cells", [0.0, 0.0], Some(&pending)).is_some());
    assert_eq!(height(&document), Some(Value::Number(0.01)));
}
