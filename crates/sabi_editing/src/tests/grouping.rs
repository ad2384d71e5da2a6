//! Grouping and ungrouping nodes does not change results.

use super::*;

const NODES: &str = r#"
    "n": { "kind": "noise/simplex", "params": { "seed": 7 }, "pos": [0, 0] },
    "w": { "kind": "noise/cells", "params": { "seed": 8 }, "pos": [0, 300] },
    "r": { "kind": "graph/reroute", "inputs": { "source": "w.id" }, "pos": [200, 300] },
    "m": { "kind": "blend/mask", "inputs": { "above": "r", "below": "n" }, "pos": [300, 0] },
    "i": { "kind": "adjust/invert", "inputs": { "source": "m" }, "muted": true, "pos": [600, 0] },
    "base": { "kind": "source/material", "pos": [600, 300] },
    "low": { "kind": "effect/relief", "inputs": { "base": "base", "mask": "m" }, "params": { "depth": 0.01 }, "pos": [900, 0] },
    "layer": { "kind": "effect/layer", "inputs": { "base": "low", "mask": "i", "height_map": "w.id" }, "pos": [1200, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "layer" }, "pos": [1500, 0] },
    "wear": { "kind": "output/mask", "inputs": { "source": "m" }, "pos": [1500, 300] }"#;

#[test]
fn grouping_and_ungrouping_keeps_the_results() {
    let before = evaluated(&opened("", NODES));
    for ids in [
        vec!["n"],
        vec!["r"],
        vec!["m", "n", "r"],
        vec!["w", "r", "m", "n", "i"],
        vec!["i", "low", "layer"],
        vec!["layer"],
        vec!["base", "low"],
        vec!["n", "w", "r", "m", "i", "base", "low", "layer"],
    ] {
        let mut document = opened("", NODES);
        select(&mut document, &ids);
        step(&mut document, groups::make);
        let instance = document.selected_one().cloned().expect("the instance");
        assert_eq!(evaluated(&document), before, "{ids:?}");
        assert_eq!(document.contents().groups.len(), 1);
        // Group the instance once more.
        step(&mut document, groups::make);
        assert_eq!(evaluated(&document), before, "{ids:?}");
        step(&mut document, groups::dissolve_selected);
        step(&mut document, groups::dissolve_selected);
        assert_eq!(evaluated(&document), before, "{ids:?}");
        assert!(document.contents().groups.is_empty() && document.node(&instance).is_none());
        assert_eq!(document.selection().len(), ids.len(), "what came out is selected");
    }
}

#[test]
fn wires_from_one_source_share_an_input_and_readers_of_one_result_share_an_output() {
    let mut document = opened("", NODES);
    select(&mut document, &["low", "i"]);
    step(&mut document, groups::make);
    let instance = document.selected_one().cloned().expect("the instance");
    navigation::enter(&mut document, &instance);
    let inputs: Vec<(&String, usize)> = ports::inputs(&document)
        .iter()
        .map(|(name, input)| (name, input.to.len()))
        .collect();
    assert_eq!(inputs, [(&"base".to_owned(), 1), (&"source".to_owned(), 2)]);
    let outputs: Vec<String> = ports::outputs(&document)
        .iter()
        .map(|(name, from)| format!("{name} {from}"))
        .collect();
    assert_eq!(outputs, ["mask i", "material low"]);
}

#[test]
fn the_reason_why_nodes_cannot_be_grouped_is_reported() {
    let mut document = opened("", NODES);
    select(&mut document, &["layer", "out"]);
    let said = refused(&mut document, groups::make);
    assert_eq!(
        said,
        "an output cannot be inside a group; leave it outside and group what leads to it"
    );
    select(&mut document, &["n", "layer"]);
    let said = refused(&mut document, groups::make);
    assert_eq!(said, "'Invert' lies between the selected nodes; select it too");
    select(&mut document, &["n"]);
    let said = refused(&mut document, groups::dissolve_selected);
    assert_eq!(said, "select a group to ungroup");
}

#[test]
fn grouping_moves_panel_ports_and_frames_and_ungrouping_restores_them() {
    let more = r#""exposed": { "seed_of_noise": { "to": ["n.seed", "w.seed"], "default": 4, "label": "Seed", "range": [0, 9] },
             "depth": { "to": ["low.depth"] } },
           "variants": { "deep": { "depth": 0.5 } },
           "frames": { "f": { "nodes": ["n", "m"] }, "g": { "nodes": ["n", "layer"] } },
           "inputs": { "where": { "to": ["n.position", "w.position"] } }, "outputs": { "mask": "m", "id": "w.id" },"#;
    let mut document = opened(more, NODES);
    let before = evaluated(&document);
    let with = |document: &OpenDocument| {
        let overrides = Overrides {
            variant: Some("deep".to_owned()),
            ..Overrides::default()
        };
        let mut params: Vec<String> = document
            .session
            .graph()
            .flatten(&overrides)
            .expect("a graph")
            .nodes
            .into_iter()
            .map(|node| format!("{} {:?}", node.kind, node.params))
            .collect();
        params.sort();
        params
    };
    let deep = with(&document);
    select(&mut document, &["n", "w", "r", "m", "low"]);
    step(&mut document, groups::make);
    let instance = document.selected_one().cloned().expect("the instance");
    assert_eq!((evaluated(&document), with(&document)), (before.clone(), deep.clone()));
    let knobs = document.graph().exposed();
    assert_eq!(knobs["seed_of_noise"].to, [slot(&instance, "seed_of_noise")]);
    assert_eq!(ports::inputs(&document)["where"].to, [slot(&instance, "position")]);
    assert_eq!(ports::outputs(&document)["mask"].node, instance);
    assert_eq!(document.graph().frames().keys().collect::<Vec<_>>(), ["g"]);
    assert_eq!(document.graph().frames()["g"].nodes, [instance.clone(), id("layer")]);
    assert_eq!(
        document.contents().groups["Group"]
            .graph
            .frames()
            .keys()
            .collect::<Vec<_>>(),
        ["f"]
    );
    step(&mut document, groups::dissolve_selected);
    assert_eq!((evaluated(&document), with(&document)), (before, deep));
    assert_eq!(document.graph().exposed()["seed_of_noise"].to.len(), 2);
    assert_eq!(ports::inputs(&document)["where"].to.len(), 2);
    assert_eq!(
        (document.graph().frames().len(), ports::outputs(&document).len()),
        (2, 2)
    );
}

#[test]
fn an_input_that_is_both_fed_and_connected_keeps_both() {
    let group = r#""groups": { "g": { "inputs": { "in": { "to": ["l.source"] } }, "outputs": { "mask": "l" },
        "nodes": { "n": { "kind": "noise/white" }, "l": { "kind": "adjust/levels", "inputs": { "source": "n" } } } } },"#;
    let nodes = r#""w": { "kind": "noise/cells" }, "fed": { "kind": "graph/group", "group": "g", "inputs": { "in": "w" } },
        "free": { "kind": "graph/group", "group": "g" },
        "out": { "kind": "output/mask", "inputs": { "source": "fed" } }, "two": { "kind": "output/mask", "inputs": { "source": "free" } }"#;
    let mut document = opened(group, nodes);
    let before = evaluated(&document);
    navigation::enter(&mut document, &id("free"));
    select(&mut document, &["l"]);
    step(&mut document, groups::make);
    assert_eq!(evaluated(&document), before);
    step(&mut document, groups::dissolve_selected);
    assert_eq!(evaluated(&document), before);
}

#[test]
fn a_group_made_inside_a_group_has_the_same_fit() {
    let group = r#""groups": { "g": { "fit": 2.5, "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""g": { "kind": "graph/group", "group": "g" }, "out": { "kind": "output/mask", "inputs": { "source": "g" } }"#;
    let mut document = opened(group, nodes);
    let before = evaluated(&document);
    navigation::enter(&mut document, &id("g"));
    selection::select_all(&mut document);
    step(&mut document, groups::make);
    assert_eq!(evaluated(&document), before);
    step(&mut document, groups::dissolve_selected);
    assert_eq!(evaluated(&document), before);
    assert_eq!(document.take_notices(), Vec::<String>::new());
}

#[test]
fn ungrouping_applies_the_values_of_the_instance_to_the_nodes() {
    let group = r#""groups": { "g": { "outputs": { "mask": "n" },
        "exposed": { "a": { "to": ["n.gain"] }, "b": { "to": ["n.gain"], "default": 0.125 }, "size": { "to": ["n.size"] },
                     "deep": { "to": ["n.octaves"] } },
        "variants": { "v": { "size": 0.75, "deep": 2 } },
        "nodes": { "n": { "kind": "noise/simplex" }, "i": { "kind": "graph/group", "group": "h" } } },
        "h": { "outputs": { "mask": "x" }, "nodes": { "x": { "kind": "noise/dots" } } } },"#;
    let nodes = r#""g": { "kind": "graph/group", "group": "g", "muted": true,
          "params": { "a": 0.5, "variant": "v", "deep": 3, "scale": 2 } },
        "out": { "kind": "output/mask", "inputs": { "source": "g.mask" } }"#;
    let mut document = opened(group, nodes);
    select(&mut document, &["g"]);
    step(&mut document, groups::dissolve_selected);
    let noise = document
        .graph()
        .nodes()
        .find(|(_, node)| node.kind == "noise/simplex")
        .expect("what came out")
        .1
        .clone();
    let set = ["gain", "size", "octaves"].map(|name| noise.params.get(name).cloned());
    assert_eq!(
        set,
        [number(0.5), number(1.5), number(3.0)],
        "its own before its variant's, lengths by its Scale"
    );
    assert!(noise.muted);
    let inner = document
        .graph()
        .nodes()
        .find(|(_, node)| node.group.as_deref() == Some("h"))
        .expect("what came out")
        .1;
    assert_eq!(inner.params.get("scale"), number(2.0).as_ref());
    assert_eq!(document.take_notices(), Vec::<String>::new());
}

#[test]
fn properties_that_ungrouping_loses_are_reported() {
    let group = r#""groups": { "g": { "fit": "metres", "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let mut document = opened(
        group,
        r#""g": { "kind": "graph/group", "group": "g", "label": "Dust", "params": { "seed": 5 } }"#,
    );
    select(&mut document, &["g"]);
    step(&mut document, groups::dissolve_selected);
    assert_eq!(
        document.take_notices(),
        [
            "'Dust' had a Seed of its own, without which its patterns are others",
            "'Dust' was made for models of another size; look at its lengths"
        ]
    );
}

#[test]
fn a_group_is_removed_only_with_its_last_instance() {
    let group = r#""groups": { "g": { "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""a": { "kind": "graph/group", "group": "g" }, "b": { "kind": "graph/group", "group": "g" },
        "m": { "kind": "blend/mask", "inputs": { "above": "a", "below": "b" } },
        "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#;
    let mut document = opened(group, nodes);
    let before = evaluated(&document);
    select(&mut document, &["a", "m"]);
    step(&mut document, groups::dissolve_selected);
    assert_eq!(document.contents().groups.len(), 1);
    assert!(document.selection().contains(&id("m")) && document.selection().len() == 2);
    select(&mut document, &["b"]);
    step(&mut document, groups::dissolve_selected);
    assert!(document.contents().groups.is_empty());
    assert_eq!(evaluated(&document), before);
}

#[test]
fn a_group_is_renamed_in_all_instances_also_while_it_is_entered() {
    let group = r#""groups": { "g": { "name": "Shown", "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""a": { "kind": "graph/group", "group": "g" }, "b": { "kind": "graph/group", "group": "g" }"#;
    let mut document = opened(group, nodes);
    navigation::enter(&mut document, &id("a"));
    select(&mut document, &["n"]);
    step(&mut document, |document| groups::rename(document, "g", " Fine dust "));
    assert_eq!(document.body(), sabi_graph::Body::Group("Fine dust".to_owned()));
    assert_eq!(document.selected_one(), Some(&id("n")));
    navigation::leave(&mut document);
    assert_eq!(["a", "b"].map(|name| document.title(&id(name))), ["Fine dust"; 2]);
    for (name, said) in [
        (
            "dust.sabi",
            "'dust.sabi' is the name of a file; choose one that does not end in .sabi",
        ),
        (
            "",
            "\"\" cannot be the name of a group; use 1 to 200 characters, none of them a control character",
        ),
    ] {
        assert_eq!(
            refused(&mut document, |document| groups::rename(document, "Fine dust", name)),
            said
        );
    }
}

#[test]
fn renaming_the_only_instance_renames_the_group_and_otherwise_sets_a_label() {
    let mut document = opened("", NODES);
    select(&mut document, &["m", "n", "r"]);
    step(&mut document, groups::make);
    let instance = document.selected_one().cloned().expect("the instance");
    step(&mut document, |document| nodes::rename(document, &instance, " Rust "));
    let names: Vec<&String> = document.contents().groups.keys().collect();
    assert_eq!(names, ["Rust"]);
    assert_eq!(document.node(&instance).and_then(|node| node.label.clone()), None);
    assert_eq!(document.title(&instance), "Rust");
    // With a second instance, a name applies to the node only.
    nodes::add_instance(&mut document, "Rust", [0.0; 2], None).expect("a second instance");
    step(&mut document, |document| nodes::rename(document, &instance, "Old rust"));
    assert!(document.contents().groups.contains_key("Rust"));
    assert_eq!(document.title(&instance), "Old rust");
    // A file name is not the name of a group of the document.
    step(&mut document, |document| nodes::rename(document, &instance, ""));
    assert_eq!(document.title(&instance), "Rust");
}
