//! Flattening.

use super::{document, flat};
use crate::{Document, FlatGraph, FlatNode, Overrides, Value};

/// Formats each node as a line `id kind(params) <- input:source`.
fn lines(graph: &FlatGraph) -> Vec<String> {
    let line = |node: &FlatNode| {
        let mut line = format!("{} {}", node.id, node.kind);
        for (name, value) in &node.params {
            line.push_str(&format!(" {name}={}", value.to_json()));
        }
        for (input, from) in &node.inputs {
            let port = from.port.as_ref().map(|port| format!(".{port}")).unwrap_or_default();
            line.push_str(&format!(" {input}<-{}{port}", graph.nodes[from.node].id));
        }
        line
    };
    graph.nodes.iter().map(line).collect()
}

fn set(name: &str, value: impl Into<Value>) -> Overrides {
    Overrides {
        set: vec![(name.to_owned(), value.into())],
        ..Overrides::default()
    }
}

/// Creates groups nested six deep. Each passes the mask on and has an input for one effect.
fn nested_six_deep() -> Document {
    let mut groups = String::new();
    for level in 1..=6 {
        let inner = format!("\"group\": \"g{}\"", level + 1);
        let inside = if level == 6 {
            "\"fx\": { \"kind\": \"effect/layer\", \"params\": { \"height\": 0.5 } }".to_owned()
        } else {
            format!(
                "\"fx\": {{ \"kind\": \"graph/group\", {inner}, \"params\": {{ \"seed\": {level}, \"scale\": 0.5, \
                 \"tint\": \"#111111\" }} }}"
            )
        };
        let knob = if level == 6 { "fx.color" } else { "fx.tint" };
        let port = if level == 6 { "fx.material" } else { "fx" };
        groups.push_str(&format!(
            "\"g{level}\": {{ \"exposed\": {{ \"tint\": {{ \"to\": [\"{knob}\"] }} }}, \"inputs\": {{ \"mask\": {{ \
             \"to\": [\"wire.source\"] }} }}, \"outputs\": {{ \"material\": \"{port}\" }}, \"nodes\": {{ \"wire\": {{ \
             \"kind\": \"graph/reroute\" }}, {} }} }},",
            inside.replacen("{ \"kind\"", "{ \"inputs\": { \"mask\": \"wire\" }, \"kind\"", 1)
        ));
    }
    let groups = groups.trim_end_matches(',');
    let instance = |id: &str, tint: &str| {
        format!(
            "\"{id}\": {{ \"kind\": \"graph/group\", \"group\": \"g1\", \"inputs\": {{ \"mask\": \"bend\" }}, \
             \"params\": {{ \"tint\": \"{tint}\" }} }}"
        )
    };
    document(
        &format!("\"seed\": 9, \"groups\": {{ {groups} }},"),
        &format!(
            "\"mask\": {{ \"kind\": \"noise/simplex@3\" }}, \"bend\": {{ \"kind\": \"graph/reroute\", \"inputs\": {{ \
             \"source\": \"mask.mask\" }} }}, {}, {}, {}",
            instance("one", "#aa0000"),
            instance("two", "#00aa00"),
            instance("three", "#0000aa"),
        ),
    )
}

#[test]
fn one_mask_through_six_levels_into_three_effects_stays_one_node() {
    let graph = flat(&nested_six_deep(), &Overrides::default()).unwrap();
    let inner = "fx/fx/fx/fx/fx/fx effect/layer";
    assert_eq!(
        lines(&graph),
        [
            "mask noise/simplex".to_owned(),
            format!("one/{inner} color=\"#aa0000\" height=0.5 mask<-mask.mask"),
            format!("three/{inner} color=\"#0000aa\" height=0.5 mask<-mask.mask"),
            format!("two/{inner} color=\"#00aa00\" height=0.5 mask<-mask.mask"),
        ]
    );
    assert_eq!(graph.nodes[0].version, 3);
    let effect = &graph.nodes[1];
    assert_eq!((effect.version, effect.length_scale), (1, 1.0 / 32.0));
    assert_eq!(effect.seeds, [9, 1, 2, 3, 4, 5]);
    assert_eq!(graph.upstream(&[2]), [0, 2]);
}

#[test]
fn a_group_flattens_to_the_nodes_that_it_contains() {
    let grouped = document(
        r#""groups": { "dust": { "inputs": { "on": { "to": ["layer.base"] } }, "outputs": { "out": "layer" },
            "nodes": { "grain": { "kind": "noise/simplex" },
              "layer": { "kind": "effect/layer", "inputs": { "mask": "grain" } } } } },"#,
        r#""a": { "kind": "source/material" },
           "d": { "kind": "graph/group", "group": "dust", "inputs": { "on": "a" } },
           "out": { "kind": "output/material", "inputs": { "material": "d" } }"#,
    );
    let plain = document(
        "",
        r#""a": { "kind": "source/material" }, "grain": { "kind": "noise/simplex" },
           "layer": { "kind": "effect/layer", "inputs": { "base": "a", "mask": "grain" } },
           "out": { "kind": "output/material", "inputs": { "material": "layer" } }"#,
    );
    let mut from_group = flat(&grouped, &Overrides::default()).unwrap();
    for node in &mut from_group.nodes {
        node.id = node.id.trim_start_matches("d/").to_owned();
    }
    assert_eq!(from_group, flat(&plain, &Overrides::default()).unwrap());
}

#[test]
fn later_settings_win_over_earlier_ones() {
    let document = document(
        r##""exposed": { "amount": { "to": ["a.gain", "b.gain"], "range": [0, 1], "default": 0.1 },
                        "tint": { "to": ["a.color"] } },
            "variants": { "heavy": { "amount": 0.9, "tint": "#ffffff" } },"##,
        r##""a": { "kind": "x", "params": { "gain": 0.5, "color": "#000000" } }, "b": { "kind": "x" }"##,
    );
    let with = |variant: Option<&str>, set: &[(&str, f64)]| {
        let overrides = Overrides {
            variant: variant.map(str::to_owned),
            set: set
                .iter()
                .map(|(name, value)| ((*name).to_owned(), Value::Number(*value)))
                .collect(),
            seed: Some(77),
            fit: None,
            left_out: Vec::new(),
        };
        let graph = flat(&document, &overrides).unwrap();
        assert_eq!(graph.nodes[0].seeds, [77]);
        lines(&graph)
    };
    assert_eq!(with(None, &[]), ["a x color=\"#000000\" gain=0.1", "b x gain=0.1"]);
    assert_eq!(
        with(Some("heavy"), &[]),
        ["a x color=\"#ffffff\" gain=0.9", "b x gain=0.9"]
    );
    assert_eq!(
        with(Some("heavy"), &[("amount", 0.3), ("a.gain", 7.0), ("b.new", 1.0 / 3.0)]),
        ["a x color=\"#ffffff\" gain=7", "b x gain=0.3 new=0.33333334"]
    );
}

#[test]
fn an_error_about_an_override_lists_the_existing_names() {
    let document = document(
        r#""exposed": { "amount": { "to": ["edges_k7f2.width"], "range": [0, 1] } }, "variants": { "heavy": {} },"#,
        r#""edges_k7f2": { "kind": "surface/edges" }"#,
    );
    let heavy = Overrides {
        variant: Some("haevy".to_owned()),
        ..Overrides::default()
    };
    for (overrides, text) in [
        (
            heavy,
            "there is no variant \"haevy\" (did you mean \"heavy\"?); this graph has \"heavy\"",
        ),
        (
            set("amont", 1.0),
            "nothing is called \"amont\" (did you mean \"amount\"?); set an exposed knob (\"amount\") or a node's \
             parameter as node.param",
        ),
        (
            set("egdes_k7f2.width", 1.0),
            "nothing is called \"egdes_k7f2.width\" (did you mean \"edges_k7f2.width\"?); set an exposed knob \
             (\"amount\") or a node's parameter as node.param",
        ),
        (
            set("amount", 1.5),
            "\"amount\" is 1.5, but goes from 0 to 1; choose a value in that range",
        ),
        (
            set("amount", "much"),
            "\"amount\" takes a number from 0 to 1, not a text",
        ),
        (
            set("amount", "0,5"),
            "\"amount\" takes a number from 0 to 1, not \"0,5\"; write the decimal point, as in 0.5",
        ),
        (
            set("amount", f64::NAN),
            "the value of \"amount\" cannot be kept: numbers must be finite and below 3.4e38, lists nested at most \
             64 levels",
        ),
    ] {
        assert_eq!(flat(&document, &overrides).unwrap_err().to_string(), text);
    }
}

/// A document with one instance `i` of a group with an input, two outputs and a knob.
fn with_instance(instance: &str, more_nodes: &str) -> Document {
    document(
        r#""groups": { "g": { "exposed": { "amount": { "to": ["n.gain"], "range": [0, 1] } },
              "variants": { "heavy": { "amount": 1 } },
              "inputs": { "where": { "to": ["n.position"] } }, "outputs": { "mask": "n", "id": "n.id" },
              "nodes": { "n": { "kind": "noise/cells" } } } },"#,
        &format!(r#""i": {{ "kind": "graph/group", "group": "g" {instance} }} {more_nodes}"#),
    )
}

#[test]
fn an_error_about_an_instance_lists_the_names_of_its_group() {
    let reads = |port: &str| format!(r#", "r": {{ "kind": "x", "inputs": {{ "source": "i{port}" }} }}"#);
    for (instance, more, text) in [
        (
            r#", "params": { "amuont": 1 }"#,
            String::new(),
            "group instance \"i\" has no knob \"amuont\" (did you mean \"amount\"?); it has \"amount\", \"fit\", \
             \"scale\", \"seed\", \"variant\"",
        ),
        (
            r#", "params": { "amount": 2 }"#,
            String::new(),
            "\"amount\" of \"i\" is 2, but goes from 0 to 1; choose a value in that range",
        ),
        (
            r#", "params": { "scale": 0 }"#,
            String::new(),
            "the scale of group instance \"i\" must be a number above zero, not 0",
        ),
        (
            r#", "params": { "fit": "feet" }"#,
            String::new(),
            "the fit of group instance \"i\" must be \"as_made\", \"piece\", \"unit\" or \"metres\", not \"feet\"",
        ),
        (
            r#", "params": { "seed": 0.5 }"#,
            String::new(),
            "the seed of group instance \"i\" must be a whole number from 0 to 4294967295, not 0.5",
        ),
        (
            r#", "params": { "variant": "haevy" }"#,
            String::new(),
            "there is no variant \"haevy\" of \"i\" (did you mean \"heavy\"?); this graph has \"heavy\"",
        ),
        (
            r#", "inputs": { "were": "r" }"#,
            r#", "r": { "kind": "x" }"#.to_owned(),
            "node \"i\" has no input \"were\" (did you mean \"where\"?); it has \"where\"",
        ),
        (
            "",
            reads(".msk"),
            "group instance \"i\" has no output \"msk\" (did you mean \"mask\"?); it has \"id\", \"mask\"",
        ),
        (
            "",
            reads(""),
            "a link from group instance \"i\" must name one of its outputs as node.output; it has \"id\", \"mask\"",
        ),
    ] {
        let document = with_instance(instance, &more);
        assert_eq!(flat(&document, &Overrides::default()).unwrap_err().to_string(), text);
    }
}

#[test]
fn a_bad_version_or_a_named_output_of_a_reroute_is_an_error() {
    let error = |nodes: &str| {
        flat(&document("", nodes), &Overrides::default())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        error(r#""a": { "kind": "x@0" }"#),
        "node \"a\" has the kind \"x@0\"; after the @ stands a version from 1 up, as in \"noise/simplex@2\""
    );
    assert_eq!(
        error(r#""r": { "kind": "graph/reroute" }, "a": { "kind": "x", "inputs": { "source": "r.out" } }"#),
        "node \"r\" is a reroute and has no output \"out\"; link from the node's id alone"
    );
}

#[test]
fn instance_knobs_variants_and_mute_reach_inside() {
    let document = with_instance(r#", "muted": true, "params": { "variant": "heavy" }"#, "");
    let graph = flat(&document, &Overrides::default()).unwrap();
    assert_eq!(lines(&graph), ["i/n noise/cells gain=1"]);
    assert!(graph.nodes[0].muted);
    let graph = flat(&document, &set("i.amount", 0.25)).unwrap();
    assert_eq!(lines(&graph), ["i/n noise/cells gain=0.25"]);
}

#[test]
fn an_input_whose_link_ends_at_an_unconnected_reroute_is_not_connected() {
    let document = document(
        r#""groups": { "g": { "inputs": { "in": { "to": ["n.source", "n.base"] } }, "outputs": { "out": "n" },
              "nodes": { "own": { "kind": "y" }, "n": { "kind": "x", "inputs": { "base": "own" } } } } },"#,
        r#""i": { "kind": "graph/group", "group": "g" }, "loose": { "kind": "graph/reroute" },
           "fed": { "kind": "graph/group", "group": "g", "inputs": { "in": "i" } },
           "r": { "kind": "x", "inputs": { "source": "loose" } }"#,
    );
    // If nothing is connected to the group's input, the node inside keeps its own link.
    let graph = flat(&document, &Overrides::default()).unwrap();
    assert_eq!(
        lines(&graph),
        [
            "fed/own y",
            "i/own y",
            "i/n x base<-i/own",
            "fed/n x base<-i/n source<-i/n",
            "r x"
        ]
    );
}

#[test]
fn each_reroute_of_a_long_chain_is_followed_only_once() {
    let mut nodes =
        String::from(r#""n": { "kind": "x" }, "w0": { "kind": "graph/reroute", "inputs": { "source": "n" } }"#);
    for place in 1..20_000 {
        nodes.push_str(&format!(
            r#", "w{place}": {{ "kind": "graph/reroute", "inputs": {{ "source": "w{}" }} }}"#,
            place - 1
        ));
        nodes.push_str(&format!(
            r#", "r{place}": {{ "kind": "x", "inputs": {{ "source": "w{place}" }} }}"#
        ));
    }
    let graph = flat(&document("", &nodes), &Overrides::default()).unwrap();
    assert!(graph.nodes[1..].iter().all(|node| node.inputs["source"].node == 0));
}
