//! Inputs and outputs of groups, and instances that are adapted to them.

use super::*;

/// Creates a group with two instances. One of them is inside another group, which exposes its ports.
fn wear() -> OpenDocument {
    let groups = r#""groups": {
        "wear": { "inputs": { "where": { "to": ["l.source"], "label": "Where" } }, "outputs": { "mask": "l" },
          "exposed": { "low": { "to": ["l.low"], "range": [0, 1] } }, "variants": { "dark": { "low": 0 } },
          "nodes": { "l": { "kind": "adjust/levels" }, "b": { "kind": "blend/mask", "inputs": { "below": "l" } },
                     "n": { "kind": "noise/cells" }, "base": { "kind": "effect/relief" } } },
        "outer": { "inputs": { "in": { "to": ["i.where"] } }, "outputs": { "out": "i.mask" },
          "exposed": { "outer_low": { "to": ["i.low"] } },
          "nodes": { "i": { "kind": "graph/group", "group": "wear", "params": { "low": 0.25, "variant": "dark" } } } } },"#;
    let nodes = r#""w": { "kind": "noise/white" },
        "g": { "kind": "graph/group", "group": "wear", "inputs": { "where": "w" }, "params": { "low": 0.5 } },
        "o": { "kind": "graph/group", "group": "outer", "inputs": { "in": "g" }, "params": { "outer_low": 0.75 } },
        "out": { "kind": "output/mask", "inputs": { "source": "o" } },
        "two": { "kind": "output/mask", "inputs": { "source": "g.mask" } }"#;
    let mut document = opened(groups, nodes);
    assert!(navigation::enter(&mut document, &id("g")));
    document
}

#[test]
fn an_input_can_feed_only_inputs_that_accept_its_type() {
    let mut document = wear();
    let name = step(&mut document, |document| ports::expose_input(document, &to("b.above")));
    assert_eq!(name.as_deref(), Some("above"));
    step(&mut document, |document| ports::feed(document, "above", &to("b.mask")));
    assert_eq!(ports::inputs(&document)["above"].to, [to("b.above"), to("b.mask")]);
    // An input fed by another input of the group is now fed by this one.
    step(&mut document, |document| ports::feed(document, "where", &to("b.mask")));
    assert_eq!(ports::inputs(&document)["above"].to, [to("b.above")]);
    step(&mut document, |document| ports::unfeed(document, &to("b.mask")));
    let mut said = |input: &str, slot: &str| refused(&mut document, |document| ports::feed(document, input, &to(slot)));
    assert_eq!(
        said("above", "n.position"),
        "'Position' takes a vector, and this input of the group carries a mask"
    );
    assert_eq!(said("above", "n.lost"), "'Cells' has no input 'lost'");
    assert_eq!(said("lost", "b.mask"), "the group has no input 'lost'");
    let said = refused(&mut document, |document| ports::expose_input(document, &to("l.source")));
    assert_eq!(said, "the group's input 'Where' leads there already");
    flat(&document);
}

#[test]
fn a_renamed_input_is_renamed_in_all_instances_and_enclosing_groups() {
    let mut document = wear();
    let before = evaluated(&document);
    step(&mut document, |document| {
        ports::rename_input(document, "where", "place")
    });
    assert_eq!(evaluated(&document), before);
    step(&mut document, |document| {
        ports::set_input_label(document, "place", "The place")
    });
    navigation::leave(&mut document);
    assert_eq!(wire(&document, "g.place"), "w");
    assert_eq!(
        document
            .interface(&id("g"))
            .map(|interface| interface.inputs[0].label.clone())
            .as_deref(),
        Some("The place")
    );
}

#[test]
fn removing_an_input_removes_its_wires_in_all_instances() {
    let mut document = wear();
    step(&mut document, |document| ports::remove_input(document, "where"));
    navigation::leave(&mut document);
    assert_eq!(wire(&document, "g.where"), "");
    assert!(document.contents().groups["outer"].inputs["in"].to.is_empty());
    flat(&document);
}

#[test]
fn adding_a_second_output_keeps_the_wires_from_the_first_one_valid() {
    let mut document = wear();
    let before = evaluated(&document);
    let name = step(&mut document, |document| ports::expose_output(document, &from("n.id")));
    assert_eq!(name.as_deref(), Some("id"));
    assert_eq!(evaluated(&document), before);
    step(&mut document, |document| {
        ports::rename_output(document, "mask", "result")
    });
    assert_eq!(evaluated(&document), before);
    step(&mut document, |document| {
        ports::retarget_output(document, "result", &from("b"))
    });
    assert_ne!(evaluated(&document), before);
    navigation::leave(&mut document);
    assert_eq!(
        [wire(&document, "o.in"), wire(&document, "two.source")],
        ["g.result", "g.result"]
    );
}

#[test]
fn removing_an_output_removes_its_wires_in_all_instances() {
    let mut document = wear();
    step(&mut document, |document| ports::remove_output(document, "mask"));
    navigation::leave(&mut document);
    assert_eq!([wire(&document, "two.source"), wire(&document, "out.source")], ["", ""]);
    assert!(
        document.contents().groups["outer"].outputs.is_empty(),
        "what gave it out gives nothing either"
    );
    flat(&document);
}

#[test]
fn removing_a_node_removes_everything_it_exposed() {
    let mut document = wear();
    select(&mut document, &["l"]);
    step(&mut document, |document| nodes::delete(document, false));
    navigation::leave(&mut document);
    assert_eq!(param(&document, "g", "low"), None);
    assert_eq!(
        param(&document, "o", "outer_low"),
        None,
        "the group around exposed it in turn"
    );
    assert_eq!(
        wire(&document, "g.where"),
        "w",
        "the input is there still, and feeds nothing"
    );
    flat(&document);
}

#[test]
fn a_taken_name_is_refused() {
    let mut document = wear();
    ports::expose_input(&mut document, &to("b.above"));
    ports::expose_output(&mut document, &from("n.id"));
    let mut said = |does: &dyn Fn(&mut OpenDocument) -> bool| refused(&mut document, |document| does(document));
    assert_eq!(
        said(&|document| ports::rename_input(document, "where", "above")),
        "the group has an input 'above' already; choose another name"
    );
    assert_eq!(
        said(&|document| ports::rename_output(document, "mask", "id")),
        "the group has an output 'id' already; choose another name"
    );
    assert_eq!(
        said(&|document| ports::rename_input(document, "lost", "x")),
        "the group has no input 'lost'"
    );
    assert_eq!(
        said(&|document| ports::rename_output(document, "lost", "x")),
        "the group has no output 'lost'"
    );
    assert_eq!(
        said(&|document| ports::retarget_output(document, "lost", &from("n"))),
        "the group has no output 'lost'"
    );
    assert_eq!(
        said(&|document| ports::retarget_output(document, "mask", &from("n.x"))),
        "'Cells' gives no such result"
    );
    assert_eq!(
        said(&|document| ports::rename_input(document, "where", "a.b")),
        "\"a.b\" cannot be the name of a port; use 1 to 64 characters without dots and slashes"
    );
}

#[test]
fn the_main_graph_has_inputs_and_outputs_for_files_that_use_it_as_a_group() {
    let mut document = opened("", r#""l": { "kind": "adjust/levels" }"#);
    step(&mut document, |document| ports::expose_input(document, &to("l.source")));
    step(&mut document, |document| ports::expose_output(document, &from("l")));
    step(&mut document, |document| ports::rename_output(document, "mask", "wear"));
    step(&mut document, |document| {
        ports::rename_input(document, "source", "where")
    });
    assert_eq!(ports::inputs(&document)["where"].to, [to("l.source")]);
    assert_eq!(ports::outputs(&document)["wear"], from("l"));
}

#[test]
fn references_of_an_instance_that_were_broken_before_are_not_changed() {
    let groups = r#""groups": { "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"] } },
        "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let mut document = opened(
        groups,
        r#""i": { "kind": "graph/group", "group": "g", "params": { "of_old": 1 } }"#,
    );
    navigation::enter(&mut document, &id("i"));
    step(&mut document, |document| exposed_knobs::unexpose(document, "size"));
    navigation::leave(&mut document);
    assert_eq!(
        param(&document, "i", "of_old"),
        number(1.0),
        "it was wrong before, and may be somebody's"
    );
}
