//! Knobs that are exposed.

use super::*;

const NODES: &str = r#"
    "n": { "kind": "noise/simplex", "params": { "size": 0.5 } }, "w": { "kind": "noise/cells", "params": { "size": 0.25 } },
    "m": { "kind": "blend/mask", "inputs": { "above": "w", "below": "n" } },
    "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#;

fn names(document: &OpenDocument) -> Vec<String> {
    exposed_knobs::knobs(document)
        .into_iter()
        .map(|knob| knob.name)
        .collect()
}

fn value(document: &OpenDocument, name: &str) -> Option<Value> {
    exposed_knobs::knobs(document)
        .into_iter()
        .find(|knob| knob.name == name)
        .map(|knob| knob.value)
}

#[test]
fn a_knob_is_exposed_and_unexposed() {
    let mut document = opened("", NODES);
    step(&mut document, |document| {
        exposed_knobs::expose(document, &id("n"), "size")
    });
    step(&mut document, |document| {
        exposed_knobs::expose(document, &id("w"), "size")
    });
    assert_eq!(names(&document), ["size", "size_2"]);
    assert_eq!(
        [value(&document, "size"), value(&document, "size_2")],
        [number(0.5), number(0.25)]
    );
    assert_eq!(exposed_knobs::exposed_as(&document, &id("w"), "size"), Some("size_2"));
    let said = refused(&mut document, |document| {
        exposed_knobs::expose(document, &id("w"), "size")
    });
    assert_eq!(said, "this parameter is exposed already, as 'size_2'");
    let said = refused(&mut document, |document| {
        exposed_knobs::expose(document, &id("w"), "nothing")
    });
    assert_eq!(said, "'Cells' has no parameter 'nothing'");
    step(&mut document, |document| exposed_knobs::unexpose(document, "size"));
    assert_eq!(names(&document), ["size_2"]);
    let said = refused(&mut document, |document| exposed_knobs::unexpose(document, "size"));
    assert!(said.starts_with("there is no knob \"size\""), "{said}");
}

#[test]
fn one_exposed_knob_can_control_several_knobs_of_the_same_type() {
    let mut document = opened("", NODES);
    exposed_knobs::expose(&mut document, &id("n"), "size");
    step(&mut document, |document| {
        exposed_knobs::expose_also(document, &id("w"), "size", "size")
    });
    step(&mut document, |document| {
        exposed_values::set(document, "size", &Value::Number(0.75))
    });
    assert_eq!(
        ["n", "w"].map(|id| param(&document, id, "size")),
        [number(0.75), number(0.75)]
    );
    let said = refused(&mut document, |document| {
        exposed_knobs::expose_also(document, &id("n"), "mode", "size")
    });
    assert_eq!(said, "'Size' holds values of another sort than 'Mode'");
    step(&mut document, |document| {
        exposed_knobs::unexpose_knob(document, &id("n"), "size")
    });
    assert_eq!(document.graph().exposed()["size"].to, [to("w.size")]);
    step(&mut document, |document| {
        exposed_knobs::unexpose_knob(document, &id("w"), "size")
    });
    assert!(
        exposed_knobs::knobs(&document).is_empty() && !exposed_knobs::unexpose_knob(&mut document, &id("w"), "size")
    );
}

#[test]
fn an_exposed_knob_is_reset_to_its_value_when_the_graph_was_opened() {
    let mut document = opened(r#""exposed": { "size": { "to": ["n.size", "w.size"] } },"#, NODES);
    exposed_values::set(&mut document, "size", &Value::Number(0.75));
    assert_eq!(exposed_knobs::knobs(&document)[0].at_first, Value::Number(0.5));
    step(&mut document, |document| exposed_values::reset(document, "size"));
    assert_eq!(
        ["n", "w"].map(|id| param(&document, id, "size")),
        [number(0.5), number(0.5)]
    );
    exposed_knobs::expose(&mut document, &id("n"), "gain");
    exposed_values::set(&mut document, "gain", &Value::Number(0.125));
    step(&mut document, |document| exposed_values::reset(document, "gain"));
    assert_eq!(
        value(&document, "gain"),
        number(0.5),
        "that of the kind, since it was not there then"
    );
    let said = refused(&mut document, |document| exposed_values::reset(document, "nothing"));
    assert_eq!(said, "there is no exposed parameter 'nothing'");
}

#[test]
fn an_exposed_seed_does_not_take_the_reserved_name_of_the_instance_seed() {
    let mut document = opened("", NODES);
    selection::select_all(&mut document);
    selection::toggle(&mut document, &id("out"));
    groups::make(&mut document);
    let group = document.selected_one().cloned().expect("the instance");
    navigation::enter(&mut document, &group);
    step(&mut document, |document| {
        exposed_knobs::expose(document, &id("n"), "seed")
    });
    assert_eq!(names(&document), ["n_seed"]);
    let said = refused(&mut document, |document| {
        exposed_knobs::rename(document, "n_seed", "seed")
    });
    assert_eq!(said, "every group has a parameter 'seed'; choose another name");
    flat(&document);
}

#[test]
fn a_renamed_knob_is_renamed_in_variants_instances_and_enclosing_panels() {
    let groups = r#""groups": {
        "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"] } }, "variants": { "big": { "size": 3 } },
          "nodes": { "n": { "kind": "noise/white" } } } },
        "exposed": { "outer": { "to": ["i.size"] } },"#;
    let nodes = r#""i": { "kind": "graph/group", "group": "g", "params": { "size": 2 } },
        "j": { "kind": "graph/group", "group": "g", "params": { "variant": "big" } },
        "out": { "kind": "output/mask", "inputs": { "source": "i" } }, "two": { "kind": "output/mask", "inputs": { "source": "j" } }"#;
    let mut document = opened(groups, nodes);
    let before = evaluated(&document);
    navigation::enter(&mut document, &id("i"));
    step(&mut document, |document| {
        exposed_knobs::rename(document, "size", "grain size")
    });
    step(&mut document, |document| {
        exposed_knobs::set_label(document, "grain size", "Grain")
    });
    assert_eq!(evaluated(&document), before);
    assert_eq!(exposed_knobs::knobs(&document)[0].knob.label, "Grain");
    navigation::leave(&mut document);
    assert_eq!(document.graph().exposed()["outer"].to, [to("i.grain size")]);
    assert_eq!(param(&document, "i", "grain size"), number(2.0));
    let mut said = |name: &str, to: &str| refused(&mut document, |document| exposed_knobs::rename(document, name, to));
    assert_eq!(said("lost", "x"), "there is no exposed parameter 'lost'");
    assert_eq!(
        said("outer", "a=b"),
        "\"a=b\" cannot be the name of a knob; use 1 to 200 characters, without dots and equal signs"
    );
}

#[test]
fn knobs_keep_the_order_and_sections_that_were_set() {
    let mut document = opened("", NODES);
    for (node, knob) in [("n", "size"), ("n", "gain"), ("m", "opacity"), ("w", "jitter")] {
        exposed_knobs::expose(&mut document, &id(node), knob);
    }
    assert_eq!(names(&document), ["gain", "jitter", "opacity", "size"]);
    step(&mut document, |document| {
        exposed_knobs::move_knob(document, "size", Some("gain"))
    });
    assert_eq!(names(&document), ["size", "gain", "jitter", "opacity"]);
    step(&mut document, |document| {
        exposed_knobs::set_section(document, "gain", " Noise ")
    });
    step(&mut document, |document| {
        exposed_knobs::move_knob(document, "opacity", Some("gain"))
    });
    assert_eq!(names(&document), ["size", "jitter", "opacity", "gain"]);
    let sections: Vec<_> = exposed_knobs::knobs(&document)
        .into_iter()
        .map(|knob| knob.exposed.section)
        .collect();
    let noise = Some("Noise".to_owned());
    assert_eq!(sections, [None, None, noise.clone(), noise]);
    step(&mut document, |document| {
        exposed_knobs::move_knob(document, "size", None)
    });
    assert_eq!(names(&document), ["jitter", "opacity", "gain", "size"]);
    refused(&mut document, |document| {
        exposed_knobs::move_knob(document, "size", Some("size"))
    });
    refused(&mut document, |document| {
        exposed_knobs::move_knob(document, "lost", None)
    });
    refused(&mut document, |document| {
        exposed_knobs::move_knob(document, "size", None)
    });
}

#[test]
fn a_knob_with_a_default_overrides_nodes_and_setting_a_node_changes_the_default() {
    let mut document = opened("", NODES);
    exposed_knobs::expose(&mut document, &id("n"), "size");
    step(&mut document, |document| {
        exposed_values::set_default(document, "size", number(0.125))
    });
    assert_eq!(
        (value(&document, "size"), param(&document, "n", "size")),
        (number(0.125), number(0.5))
    );
    let size = |document: &OpenDocument| {
        flat(document)
            .nodes
            .iter()
            .find(|node| node.id == "n")
            .and_then(|node| node.params.get("size").cloned())
    };
    assert_eq!(size(&document), number(0.125));
    step(&mut document, |document| {
        exposed_values::set(document, "size", &Value::Number(0.25))
    });
    assert_eq!(size(&document), number(0.25));
    step(&mut document, |document| {
        nodes::set_knob(document, &id("n"), "size", number(0.75))
    });
    assert_eq!(
        (value(&document, "size"), size(&document)),
        (number(0.75), number(0.75))
    );
    step(&mut document, |document| {
        nodes::set_knob(document, &id("n"), "size", None)
    });
    assert_eq!(size(&document), None, "reset is reset");
}

/// A group that exposes `size` and has a variant, with an instance `i`.
fn dust() -> OpenDocument {
    let more = r#""groups": { "g": { "exposed": { "size": { "to": ["x.size"] } }, "variants": { "v": { "size": 0.5 } },
        "outputs": { "mask": "x" }, "nodes": { "x": { "kind": "noise/white" } } } },"#;
    opened(
        more,
        r#""i": { "kind": "graph/group", "group": "g", "label": "Dust", "params": { "size": 0.75 } }"#,
    )
}

#[test]
fn a_range_applies_to_the_default_the_variants_and_the_instances() {
    let mut document = dust();
    navigation::enter(&mut document, &id("i"));
    let mut said = |range: [f64; 2]| {
        refused(&mut document, |document| {
            exposed_values::set_range(document, "size", Some(range))
        })
    };
    assert_eq!(
        said([0.75, 1.0]),
        "the variant 'v' would lie outside: 'Size' takes 0.75 to 1, and this is 0.5"
    );
    assert_eq!(
        said([0.0, 0.5]),
        "the instance 'Dust' would lie outside: 'Size' takes 0 to 0.5, and this is 0.75"
    );
    assert_eq!(
        said([1.0, 0.0]),
        "the variant 'v' would lie outside: 'Size' takes 1 to 0, and this is 0.5"
    );
    step(&mut document, |document| {
        exposed_values::set_range(document, "size", Some([0.5, 0.75]))
    });
    let said = refused(&mut document, |document| {
        exposed_values::set_default(document, "size", number(2.0))
    });
    assert_eq!(said, "'Size' takes 0.5 to 0.75, and this is 2");
    let said = refused(&mut document, |document| {
        exposed_values::set(document, "size", &Value::from("much"))
    });
    assert_eq!(said, "'Size' takes numbers from 0.5 to 0.75, and this is none");
    step(&mut document, |document| {
        exposed_values::set_range(document, "size", None)
    });
}

#[test]
fn an_instance_refuses_values_out_of_range_and_unknown_knobs() {
    let mut document = dust();
    navigation::enter(&mut document, &id("i"));
    step(&mut document, |document| {
        exposed_values::set_range(document, "size", Some([0.5, 0.75]))
    });
    navigation::leave(&mut document);
    let mut said = |knob: &str, value: Value| {
        refused(&mut document, |document| {
            nodes::set_knob(document, &id("i"), knob, Some(value))
        })
    };
    for (knob, value, sentence) in [
        (
            "size",
            Value::Number(0.0),
            "\"size\" of \"i\" is 0, but goes from 0.5 to 0.75; choose a value in that range",
        ),
        (
            "scale",
            Value::Number(0.0),
            "the scale of group instance \"i\" must be a number above zero, not 0",
        ),
        (
            "seed",
            Value::Number(-1.0),
            "the seed of group instance \"i\" must be a whole number from 0 to 4294967295, not -1",
        ),
    ] {
        assert_eq!(said(knob, value), sentence);
    }
    assert!(said("variant", Value::from("w")).starts_with("there is no variant \"w\" of \"i\""));
    assert!(said("lost", Value::Number(0.0)).starts_with("group instance \"i\" has no knob \"lost\""));
    step(&mut document, |document| {
        nodes::set_knob(document, &id("i"), "variant", Some(Value::from("v")))
    });
    step(&mut document, |document| {
        nodes::set_knob(document, &id("i"), "variant", Some(Value::from("none")))
    });
    assert_eq!(param(&document, "i", "variant"), None);
    flat(&document);
}

#[test]
fn a_picked_color_or_chosen_file_is_set_on_all_selected_nodes_of_the_same_kind() {
    let mut document = opened(
        "",
        r#""a": { "kind": "source/image" }, "b": { "kind": "source/image" }"#,
    );
    select(&mut document, &["a", "b"]);
    let knob = KnobTarget::of_node(&id("a"), "file".to_owned());
    step(&mut document, |document| {
        knob_target::set(document, &knob, Value::from("torn.png"))
    });
    assert_eq!(param(&document, "b", "file"), Some(Value::from("torn.png")));
}
