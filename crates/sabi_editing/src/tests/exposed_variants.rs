//! Named settings of the exposed knobs.

use super::*;

fn two_exposed_knobs() -> OpenDocument {
    let mut document = opened(
        "",
        r#""n": { "kind": "noise/simplex", "params": { "size": 0.5 } }, "m": { "kind": "blend/mask", "inputs": { "below": "n" } },
           "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#,
    );
    exposed_knobs::expose(&mut document, &id("n"), "size");
    exposed_knobs::expose(&mut document, &id("m"), "mode");
    document
}

#[test]
fn a_variant_stores_the_values_of_the_panel_and_restores_them() {
    let mut document = two_exposed_knobs();
    step(&mut document, |document| variants::save(document, " fine "));
    let kept: Vec<String> = document.graph().variants()["fine"]
        .iter()
        .map(|(name, value)| format!("{name} {value:?}"))
        .collect();
    assert_eq!(kept, ["mode Text(\"multiply\")", "size Number(0.5)"]);
    exposed_values::set_default(&mut document, "size", number(0.25));
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

/// Returns the parameters of the nodes as they are evaluated in the editor.
fn shown(document: &OpenDocument) -> Vec<BTreeMap<String, Value>> {
    let overrides = Overrides::of_preview(document.contents());
    let flat = document.session.graph().flatten(&overrides).expect("a graph");
    flat.nodes.into_iter().map(|node| node.params).collect()
}

#[test]
fn every_variant_is_shown_as_it_is_baked_whatever_was_shown_before() {
    let mut tried = 0;
    for file in super::effect_library::all_graphs() {
        let session = Session::open(&file, None).expect("a graph that can be read");
        let mut document = OpenDocument::new(session);
        let names: Vec<String> = document.graph().variants().keys().cloned().collect();
        let own = shown(&document);
        // There and back, so that each variant is shown after its neighbors in both directions.
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
fn knobs_change_the_shown_variant_and_a_reset_restores_the_graphs_value() {
    let mut document = two_exposed_knobs();
    variants::save(&mut document, "fine");
    variants::show(&mut document, Some("fine"));
    let own = evaluated(&document);
    step(&mut document, |document| {
        exposed_values::set(document, "size", &Value::Number(0.75))
    });
    // Setting the knob of the node also changes the variant, which would override it otherwise.
    step(&mut document, |document| {
        nodes::set_knob(document, &id("n"), "size", Some(Value::Number(0.125)))
    });
    assert_eq!(document.graph().variants()["fine"]["size"], Value::Number(0.125));
    assert_eq!(evaluated(&document), own, "the graph's own values stay");
    step(&mut document, |document| {
        exposed_values::set(document, "size", &Value::Number(2.0))
    });
    step(&mut document, |document| exposed_values::reset(document, "size"));
    let size = exposed_knobs::knobs(&document)
        .into_iter()
        .find(|knob| knob.name == "size")
        .expect("a knob");
    assert_eq!((size.value, size.at_first), (Value::Number(0.5), Value::Number(0.5)));
    assert!(!document.graph().variants()["fine"].contains_key("size"));
    let before = document.contents().clone();
    assert!(exposed_values::reset(&mut document, "size"));
    assert_eq!(document.contents(), &before, "a reset of what is not set sets nothing");
    // After saving under another name, the copy is shown.
    step(&mut document, |document| variants::save(document, "copy"));
    assert_eq!(shown_variant::name(&document), Some("copy"));
}

#[test]
fn inside_a_group_the_variant_of_the_entered_instance_is_shown() {
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
        exposed_values::set(document, "size", &Value::Number(0.5))
    });
    assert_eq!(document.graph().variants()["big"]["size"], Value::Number(0.5));
    step(&mut document, |document| variants::show(document, None));
    assert_eq!(chosen(&document, "i"), None);
}

#[test]
fn renaming_or_removing_a_variant_also_changes_all_instances() {
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
fn invalid_variant_names_are_reported() {
    let mut document = two_exposed_knobs();
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
    exposed_values::set_range(&mut document, "size", Some([0.0, 1.0]));
    let wide =
        r#""exposed": { "size": { "to": ["n.size"], "range": [0, 1] } }, "variants": { "wide": { "size": 2 } },"#;
    let mut document = opened(wide, r#""n": { "kind": "noise/white" }"#);
    assert_eq!(
        refused(&mut document, |document| variants::show(document, Some("wide"))),
        "'Size' takes 0 to 1, and this is 2"
    );
    exposed_knobs::unexpose(&mut document, "size");
    assert_eq!(
        refused(&mut document, |document| variants::save(document, "empty")),
        "a variant stores the exposed parameters, and there are none; expose some first"
    );
}

#[test]
fn a_variant_that_an_instance_cannot_take_is_refused() {
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
fn a_missing_variant_is_cleared_by_showing_the_graphs_own_values() {
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
fn trying_a_variant_gives_the_same_result_as_showing_it_and_changes_nothing() {
    let mut document = two_exposed_knobs();
    variants::save(&mut document, "fine");
    exposed_values::set_default(&mut document, "size", number(0.25));
    let before = document.session.text().to_owned();
    let tried = |document: &OpenDocument, name| {
        let graph = variants::graph_with_variant(document, None, name).expect("a graph");
        let flat = graph.flatten(&Overrides::of_preview(&graph.document)).expect("a graph");
        flat.nodes.into_iter().map(|node| node.params).collect::<Vec<_>>()
    };
    let (own, fine) = (tried(&document, None), tried(&document, Some("fine")));
    assert_eq!(own, shown(&document));
    assert_eq!(document.session.text(), before);
    variants::show(&mut document, Some("fine"));
    assert_eq!(fine, shown(&document));
    assert_ne!(fine, own);
    assert!(variants::graph_with_variant(&document, Some(&id("gone")), None).is_none());
}

#[test]
fn an_instance_with_a_variant_keeps_only_values_that_no_variant_sets() {
    let mut document = opened(
        r#""groups": { "Spots": {
            "exposed": { "octaves": { "to": ["n.octaves"] }, "size": { "to": ["n.size"] } }, "outputs": { "mask": "n" },
            "variants": { "coarse": { "size": 0.9 }, "fine": { "size": 0.1 } },
            "nodes": { "n": { "kind": "noise/simplex" } } } },"#,
        r#""g": { "kind": "graph/group", "group": "Spots", "params": { "octaves": 2, "size": 0.4, "variant": "fine" } }"#,
    );
    let tried = variants::graph_with_variant(&document, Some(&id("g")), Some("coarse")).expect("a graph");
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
