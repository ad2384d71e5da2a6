//! Named settings of the panel.

use super::*;

fn panel() -> OpenDocument {
    let mut document = opened(
        "",
        r#""n": { "kind": "noise/simplex", "params": { "size": 0.5 } }, "m": { "kind": "blend/mask", "inputs": { "below": "n" } },
           "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#,
    );
    panel::expose(&mut document, &id("n"), "size");
    panel::expose(&mut document, &id("m"), "mode");
    document
}

#[test]
fn a_variant_keeps_what_the_panel_shows_and_brings_it_back() {
    let mut document = panel();
    step(&mut document, |document| variants::save(document, " fine "));
    let kept: Vec<String> = document.graph().variants()["fine"]
        .iter()
        .map(|(name, value)| format!("{name} {value:?}"))
        .collect();
    assert_eq!(kept, ["mode Text(\"multiply\")", "size Number(0.5)"]);
    panel_values::set_default(&mut document, "size", number(0.25));
    nodes::set_knob(&mut document, &id("m"), "mode", Some(Value::from("add")));
    step(&mut document, |document| variants::save(document, "coarse"));
    let with = |document: &OpenDocument, variant: Option<&str>| {
        let overrides = Overrides {
            variant: variant.map(str::to_owned),
            ..Overrides::default()
        };
        let flat = document.session.graph().flatten(&overrides).expect("a graph");
        flat.nodes.into_iter().map(|node| node.params).collect::<Vec<_>>()
    };
    assert_eq!(with(&document, Some("coarse")), with(&document, None));
    let (own, fine) = (with(&document, None), with(&document, Some("fine")));
    step(&mut document, |document| variants::show(document, Some("fine")));
    assert_eq!((shown(&document), with(&document, None)), (fine, own.clone()));
    step(&mut document, |document| variants::remove(document, "fine"));
    assert_eq!((shown(&document), document.graph().variants().len()), (own, 1));
}

/// Parameters of the nodes that the window shows.
fn shown(document: &OpenDocument) -> Vec<BTreeMap<String, Value>> {
    let overrides = Overrides::of_preview(document.contents());
    let flat = document.session.graph().flatten(&overrides).expect("a graph");
    flat.nodes.into_iter().map(|node| node.params).collect()
}

#[test]
fn every_variant_of_every_graph_is_shown_as_it_is_baked_whatever_was_shown_before() {
    let mut tried = 0;
    for file in super::effect_library::all_graphs() {
        let session = Session::open(&file, None).expect("a graph that can be read");
        let mut document = OpenDocument::new(session);
        let names: Vec<String> = document.graph().variants().keys().cloned().collect();
        let own = shown(&document);
        // In turn and back, so that each follows each other one.
        for name in names.iter().chain(names.iter().rev()) {
            assert!(variants::show(&mut document, Some(name)), "{}: {name}", file.display());
            let overrides = Overrides {
                variant: Some(name.clone()),
                ..Overrides::default()
            };
            let baked = document.session.graph().flatten(&overrides).expect("a graph");
            let baked: Vec<_> = baked.nodes.into_iter().map(|node| node.params).collect();
            assert_eq!(shown(&document), baked, "{}: {name}", file.display());
            tried += 1;
        }
        variants::show(&mut document, None);
        assert_eq!(shown(&document), own, "{}", file.display());
    }
    assert!(tried > 300, "{tried} variants in both directions");
}

#[test]
fn knobs_change_the_shown_variant_and_a_reset_takes_the_base_value() {
    let mut document = panel();
    variants::save(&mut document, "fine");
    variants::show(&mut document, Some("fine"));
    let own = evaluated(&document);
    step(&mut document, |document| {
        panel_values::set(document, "size", &Value::Number(0.75))
    });
    // The knob of the node as well, which the variant would override.
    step(&mut document, |document| {
        nodes::set_knob(document, &id("n"), "size", Some(Value::Number(0.125)))
    });
    assert_eq!(document.graph().variants()["fine"]["size"], Value::Number(0.125));
    assert_eq!(evaluated(&document), own, "the graph's own values stay");
    step(&mut document, |document| {
        panel_values::set(document, "size", &Value::Number(2.0))
    });
    step(&mut document, |document| panel_values::reset(document, "size"));
    let size = panel::knobs(&document)
        .into_iter()
        .find(|knob| knob.name == "size")
        .expect("a knob");
    assert_eq!((size.value, size.at_first), (Value::Number(0.5), Value::Number(0.5)));
    assert!(!document.graph().variants()["fine"].contains_key("size"));
    let before = document.contents().clone();
    assert!(panel_values::reset(&mut document, "size"));
    assert_eq!(document.contents(), &before, "a reset of what is not set sets nothing");
    // A copy of the shown variant is shown in its place.
    step(&mut document, |document| variants::save(document, "copy"));
    assert_eq!(shown_variant::name(&document), Some("copy"));
}

#[test]
fn a_variant_inside_of_a_group_is_that_of_the_entered_instance() {
    let groups = r#""groups": { "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"] } },
        "variants": { "big": { "size": 3 } }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""i": { "kind": "graph/group", "group": "g" }, "j": { "kind": "graph/group", "group": "g" },
        "b": { "kind": "blend/mask", "inputs": { "below": "i", "above": "j" } },
        "out": { "kind": "output/mask", "inputs": { "source": "b" } }"#;
    let mut document = opened(groups, nodes);
    navigation::enter(&mut document, &id("i"));
    step(&mut document, |document| variants::show(document, Some("big")));
    let chosen = |document: &OpenDocument, id: &str| {
        let node = document.contents().graph.node(id).expect("an instance");
        node.params.get("variant").and_then(Value::as_text).map(str::to_owned)
    };
    assert_eq!(
        (chosen(&document, "i").as_deref(), chosen(&document, "j")),
        (Some("big"), None)
    );
    step(&mut document, |document| {
        panel_values::set(document, "size", &Value::Number(0.5))
    });
    assert_eq!(document.graph().variants()["big"]["size"], Value::Number(0.5));
    step(&mut document, |document| variants::show(document, None));
    assert_eq!(chosen(&document, "i"), None);
}

#[test]
fn a_renamed_variant_is_renamed_in_instances_and_a_removed_one_is_gone_there() {
    let groups = r#""groups": { "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"] } },
        "variants": { "big": { "size": 3 } }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""i": { "kind": "graph/group", "group": "g", "params": { "variant": "big" } },
        "out": { "kind": "output/mask", "inputs": { "source": "i" } }"#;
    let mut document = opened(groups, nodes);
    let before = evaluated(&document);
    navigation::enter(&mut document, &id("i"));
    step(&mut document, |document| variants::rename(document, "big", "huge"));
    assert_eq!(evaluated(&document), before);
    assert_eq!(
        document
            .contents()
            .graph
            .node("i")
            .and_then(|node| node.params["variant"].as_text()),
        Some("huge")
    );
    step(&mut document, |document| variants::remove(document, "huge"));
    assert_ne!(evaluated(&document), before);
}

#[test]
fn what_is_no_variant_is_told() {
    let mut document = panel();
    variants::save(&mut document, "one");
    variants::save(&mut document, "two");
    let mut said = |does: &dyn Fn(&mut OpenDocument) -> bool| refused(&mut document, |document| does(document));
    assert_eq!(
        said(&|document| variants::save(document, "  ")),
        "a variant needs a name"
    );
    assert_eq!(
        said(&|document| variants::save(document, "none")),
        "'none' stands for no variant; choose another name"
    );
    assert_eq!(
        said(&|document| variants::show(document, Some("lost"))),
        "there is no variant 'lost'"
    );
    assert_eq!(
        said(&|document| variants::remove(document, "lost")),
        "there is no variant 'lost'"
    );
    assert_eq!(
        said(&|document| variants::rename(document, "lost", "x")),
        "there is no variant 'lost'"
    );
    assert_eq!(
        said(&|document| variants::rename(document, "one", "two")),
        "there is a variant 'two' already; choose another name"
    );
    panel_values::set_range(&mut document, "size", Some([0.0, 1.0]));
    let wide =
        r#""exposed": { "size": { "to": ["n.size"], "range": [0, 1] } }, "variants": { "wide": { "size": 2 } },"#;
    let mut document = opened(wide, r#""n": { "kind": "noise/white" }"#);
    assert_eq!(
        refused(&mut document, |document| variants::show(document, Some("wide"))),
        "'Size' takes 0 to 1, and this is 2"
    );
    panel::unexpose(&mut document, "size");
    assert_eq!(
        refused(&mut document, |document| variants::save(document, "empty")),
        "a variant stores the exposed parameters, and there are none; expose some first"
    );
}

#[test]
fn what_no_instance_can_take_is_refused_before_it_is_shown() {
    let groups = r#""groups": { "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"], "range": [0, 1] } },
        "nodes": { "n": { "kind": "noise/white" } } } }, "exposed": { "grain": { "to": ["i.size"] } },
        "variants": { "wide": { "grain": 2 } },"#;
    let nodes = r#""i": { "kind": "graph/group", "group": "g" }, "out": { "kind": "output/mask", "inputs": { "source": "i" } }"#;
    let mut document = opened(groups, nodes);
    let said = refused(&mut document, |document| variants::show(document, Some("wide")));
    assert!(said.contains("size"), "{said}");
    assert_eq!(shown_variant::name(&document), None);
}

#[test]
fn a_variant_that_is_gone_is_cleared_by_showing_the_base() {
    let groups = r#""groups": { "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"] } },
        "variants": { "big": { "size": 3 } }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""i": { "kind": "graph/group", "group": "g", "params": { "variant": "lost" } }"#;
    let mut document = opened(groups, nodes);
    navigation::enter(&mut document, &id("i"));
    assert_eq!(shown_variant::name(&document), None);
    step(&mut document, |document| variants::show(document, None));
    let instance = document.contents().graph.node("i").expect("an instance");
    assert!(!instance.params.contains_key("variant"));
}

#[test]
fn a_variant_that_is_tried_gives_what_it_gives_when_it_is_shown_and_changes_nothing() {
    let mut document = panel();
    variants::save(&mut document, "fine");
    panel_values::set_default(&mut document, "size", number(0.25));
    let before = document.session.text().to_owned();
    let tried = |document: &OpenDocument, name| {
        let graph = variants::tried(document, None, name).expect("a graph");
        let flat = graph.flatten(&Overrides::of_preview(&graph.document)).expect("a graph");
        flat.nodes.into_iter().map(|node| node.params).collect::<Vec<_>>()
    };
    let (own, fine) = (tried(&document, None), tried(&document, Some("fine")));
    assert_eq!(own, shown(&document));
    assert_eq!(document.session.text(), before);
    variants::show(&mut document, Some("fine"));
    assert_eq!(fine, shown(&document));
    assert_ne!(fine, own);
    assert!(variants::tried(&document, Some(&id("gone")), None).is_none());
}

#[test]
fn an_instance_that_is_given_a_variant_keeps_only_values_that_no_variant_has() {
    let mut document = opened(
        r#""groups": { "Spots": {
            "exposed": { "octaves": { "to": ["n.octaves"] }, "size": { "to": ["n.size"] } }, "outputs": { "mask": "n" },
            "variants": { "coarse": { "size": 0.9 }, "fine": { "size": 0.1 } },
            "nodes": { "n": { "kind": "noise/simplex" } } } },"#,
        r#""g": { "kind": "graph/group", "group": "Spots", "params": { "octaves": 2, "size": 0.4, "variant": "fine" } }"#,
    );
    let tried = variants::tried(&document, Some(&id("g")), Some("coarse")).expect("a graph");
    step(&mut document, |document| {
        instance_variants::choose(document, &id("g"), Some("coarse"))
    });
    let params = |document: &OpenDocument| {
        let params = &document.node(&id("g")).expect("a node").params;
        params
            .iter()
            .map(|(name, value)| format!("{name} {value:?}"))
            .collect::<Vec<_>>()
    };
    assert_eq!(params(&document), ["octaves Number(2.0)", "variant Text(\"coarse\")"]);
    assert_eq!(tried.document.graph, document.contents().graph);
    step(&mut document, |document| {
        instance_variants::choose(document, &id("g"), None)
    });
    assert_eq!(params(&document), ["octaves Number(2.0)"]);
    assert!(!instance_variants::choose(&mut document, &id("gone"), None));
}
