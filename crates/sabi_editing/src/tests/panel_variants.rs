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
    let fine = with(&document, Some("fine"));
    step(&mut document, |document| variants::apply(document, "fine"));
    assert_eq!(with(&document, None), fine);
    step(&mut document, |document| variants::remove(document, "fine"));
    assert_eq!(document.graph().variants().len(), 1);
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
        said(&|document| variants::apply(document, "lost")),
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
        refused(&mut document, |document| variants::apply(document, "wide")),
        "'size' takes 0 to 1, and this is 2"
    );
    panel::unexpose(&mut document, "size");
    assert_eq!(
        refused(&mut document, |document| variants::save(document, "empty")),
        "a variant keeps the knobs of the panel, and there are none; publish some first"
    );
}
