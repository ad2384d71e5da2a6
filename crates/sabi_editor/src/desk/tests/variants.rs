//! Named settings of the panel.

use super::*;

fn panel() -> Desk {
    let mut desk = opened(
        "",
        r#""n": { "kind": "noise/simplex", "params": { "size": 0.5 } }, "m": { "kind": "blend/mask", "inputs": { "below": "n" } },
           "out": { "kind": "output/mask", "inputs": { "source": "m" } }"#,
    );
    desk.expose(&id("n"), "size");
    desk.expose(&id("m"), "mode");
    desk
}

#[test]
fn a_variant_keeps_what_the_panel_shows_and_brings_it_back() {
    let mut desk = panel();
    step(&mut desk, |desk| desk.save_variant(" fine "));
    let kept: Vec<String> = desk.graph().variants()["fine"]
        .iter()
        .map(|(name, value)| format!("{name} {value:?}"))
        .collect();
    assert_eq!(kept, ["mode Text(\"multiply\")", "size Number(0.5)"]);
    desk.set_exposed_default("size", number(0.25));
    desk.set_knob(&id("m"), "mode", Some(Value::from("add")));
    step(&mut desk, |desk| desk.save_variant("coarse"));
    let with = |desk: &Desk, variant: Option<&str>| {
        let overrides = Overrides {
            variant: variant.map(str::to_owned),
            ..Overrides::default()
        };
        let flat = desk.session.graph().flatten(&overrides).expect("a graph");
        flat.nodes.into_iter().map(|node| node.params).collect::<Vec<_>>()
    };
    assert_eq!(with(&desk, Some("coarse")), with(&desk, None));
    let fine = with(&desk, Some("fine"));
    step(&mut desk, |desk| desk.apply_variant("fine"));
    assert_eq!(with(&desk, None), fine);
    step(&mut desk, |desk| desk.remove_variant("fine"));
    assert_eq!(desk.graph().variants().len(), 1);
}

#[test]
fn a_renamed_variant_is_renamed_in_instances_and_a_removed_one_is_gone_there() {
    let groups = r#""groups": { "g": { "outputs": { "mask": "n" }, "exposed": { "size": { "to": ["n.size"] } },
        "variants": { "big": { "size": 3 } }, "nodes": { "n": { "kind": "noise/white" } } } },"#;
    let nodes = r#""i": { "kind": "graph/group", "group": "g", "params": { "variant": "big" } },
        "out": { "kind": "output/mask", "inputs": { "source": "i" } }"#;
    let mut desk = opened(groups, nodes);
    let before = evaluated(&desk);
    desk.enter(&id("i"));
    step(&mut desk, |desk| desk.rename_variant("big", "huge"));
    assert_eq!(evaluated(&desk), before);
    assert_eq!(
        desk.document()
            .graph
            .node("i")
            .and_then(|node| node.params["variant"].as_text()),
        Some("huge")
    );
    step(&mut desk, |desk| desk.remove_variant("huge"));
    assert_ne!(evaluated(&desk), before);
}

#[test]
fn what_is_no_variant_is_told() {
    let mut desk = panel();
    desk.save_variant("one");
    desk.save_variant("two");
    let mut said = |does: &dyn Fn(&mut Desk) -> bool| refused(&mut desk, |desk| does(desk));
    assert_eq!(said(&|desk| desk.save_variant("  ")), "a variant needs a name");
    assert_eq!(
        said(&|desk| desk.save_variant("none")),
        "'none' stands for no variant; choose another name"
    );
    assert_eq!(said(&|desk| desk.apply_variant("lost")), "there is no variant 'lost'");
    assert_eq!(said(&|desk| desk.remove_variant("lost")), "there is no variant 'lost'");
    assert_eq!(
        said(&|desk| desk.rename_variant("lost", "x")),
        "there is no variant 'lost'"
    );
    assert_eq!(
        said(&|desk| desk.rename_variant("one", "two")),
        "there is a variant 'two' already; choose another name"
    );
    desk.set_exposed_range("size", Some([0.0, 1.0]));
    let wide =
        r#""exposed": { "size": { "to": ["n.size"], "range": [0, 1] } }, "variants": { "wide": { "size": 2 } },"#;
    let mut desk = opened(wide, r#""n": { "kind": "noise/white" }"#);
    assert_eq!(
        refused(&mut desk, |desk| desk.apply_variant("wide")),
        "'size' takes 0 to 1, and this is 2"
    );
    desk.unexpose("size");
    assert_eq!(
        refused(&mut desk, |desk| desk.save_variant("empty")),
        "a variant keeps the knobs of the panel, and there are none; publish some first"
    );
}
