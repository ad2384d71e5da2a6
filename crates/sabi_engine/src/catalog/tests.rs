use sabi_graph::{Body, Document, PortType, Value};

use super::{Catalog, Interfaces};
use crate::opening::kinds::Kinds;

fn catalog() -> Catalog {
    Catalog::new(&Kinds::builtin())
}

fn document(nodes: &str) -> Document {
    let text = format!(r#"{{ "format": "sabi", "version": 1, "name": "", {nodes} }}"#);
    Document::from_json(&text).expect("the test's graph")
}

fn interfaces(document: &Document) -> Interfaces {
    Interfaces::new(&catalog(), document, &mut |_| None)
}

#[test]
fn every_kind_has_an_entry_with_a_name_and_a_summary() {
    for entry in catalog().entries() {
        assert!(!entry.label.is_empty() && !entry.summary.is_empty(), "{}", entry.id);
        assert!(entry.inputs.len() + entry.outputs.len() > 0, "{}", entry.id);
        assert!(
            !entry.category().is_empty() && entry.category() != entry.id,
            "{}",
            entry.id
        );
    }
}

#[test]
fn a_knob_holds_its_default_as_a_file_would() {
    let catalog = catalog();
    let knob = |kind: &str, name: &str| {
        let entry = catalog.entry(kind).expect("a built-in kind");
        entry.knob(name).expect("a documented parameter").clone()
    };
    assert_eq!(knob("noise/simplex", "size").ty.default, Value::Number(0.25));
    assert_eq!(knob("noise/simplex", "size").ty.role, sabi_nodes::kind::Role::Length);
    assert_eq!(knob("noise/simplex", "mode").ty.default, Value::Text("fbm".to_owned()));
    assert_eq!(knob("effect/layer", "color_on").ty.default, Value::Bool(true));
    assert_eq!(
        knob("effect/layer", "color").ty.default,
        Value::Text("#808080".to_owned())
    );
    let toward = Value::List([0.0, 1.0, 0.0].map(Value::Number).to_vec());
    assert_eq!(knob("surface/direction", "toward").ty.default, toward);
}

#[test]
fn a_parameter_with_a_mask_is_an_input_of_its_node_only() {
    let document = document(
        r#""nodes": {
            "clouds": { "kind": "noise/simplex" },
            "masked": { "kind": "noise/simplex", "inputs": { "gain": "clouds" } }
        }"#,
    );
    let interfaces = interfaces(&document);
    let interface = |node: &str| interfaces.of(&Body::Main, node).expect("an interface").clone();
    let names = |node: &str| -> Vec<String> { interface(node).inputs.iter().map(|port| port.name.clone()).collect() };
    assert_eq!(names("clouds"), ["position"]);
    assert_eq!(names("masked"), ["position", "gain"]);
    let gain = interface("clouds")
        .input("gain")
        .expect("a parameter that takes a mask")
        .clone();
    assert_eq!(gain.ty, Some(PortType::Mask));
    assert!(!gain.is_required);
    assert!(
        interface("clouds").input("octaves").is_none(),
        "a whole number takes no mask"
    );
}

#[test]
fn an_input_that_is_not_connected_is_a_knob() {
    let catalog = catalog();
    let blend = catalog.entry("blend/mask").expect("a built-in kind");
    let below = blend.knob("below").expect("an input with a knob");
    assert!(below.is_of_input);
    assert_eq!(below.ty.slider(), [0.0, 1.0]);
}

#[test]
fn a_wire_prefers_a_port_of_its_own_type() {
    let catalog = catalog();
    let layer = catalog.entry("effect/layer").expect("a built-in kind");
    let found = |ty| layer.input_for(Some(ty)).map(|port| port.name.as_str());
    assert_eq!(found(PortType::Material), Some("base"));
    assert_eq!(found(PortType::Mask), Some("mask"));
    assert_eq!(found(PortType::Color), Some("color_map"));
    assert_eq!(found(PortType::Vector), Some("slope"));
}

#[test]
fn a_group_shows_its_exposed_ports_and_a_reroute_the_type_of_its_wire() {
    let document = document(
        r#""groups": { "wear": {
            "inputs": { "where": { "to": ["worn.below"] } },
            "outputs": { "mask": "worn" },
            "exposed": { "amount": { "to": ["worn.opacity"], "range": [0, 0.5], "default": 0.4 } },
            "variants": { "light": { "amount": 0.1 } },
            "nodes": { "worn": { "kind": "blend/mask", "pos": [0, 0] } } } },
          "nodes": {
            "bend": { "kind": "graph/reroute", "inputs": { "source": "worn_1" }, "pos": [0, 0] },
            "worn_1": { "kind": "graph/group", "group": "wear", "pos": [0, 0] } }"#,
    );
    let interfaces = interfaces(&document);
    let group = interfaces.of(&Body::Main, "worn_1").expect("an instance");
    assert_eq!(group.label, "wear");
    assert_eq!(group.input("where").and_then(|port| port.ty), Some(PortType::Mask));
    assert_eq!(group.output(None).and_then(|port| port.ty), Some(PortType::Mask));
    let amount = group.knob("amount").expect("an exposed knob");
    assert_eq!(
        (amount.ty.default.as_number(), amount.ty.slider()),
        (Some(0.4), [0.0, 0.5])
    );
    let names: Vec<&str> = group.knobs.iter().map(|knob| knob.name.as_str()).collect();
    assert_eq!(names, ["amount", "seed", "scale", "fit", "variant"]);
    let bend = interfaces.of(&Body::Main, "bend").expect("a reroute");
    assert_eq!(bend.outputs[0].ty, Some(PortType::Mask));
}

#[test]
fn unknown_kinds_and_groups_have_an_entry() {
    let document = document(
        r#""nodes": {
            "lost": { "kind": "magic/wand", "pos": [0, 0] },
            "gone": { "kind": "graph/group", "group": "gone.sabi", "pos": [0, 0] } }"#,
    );
    let interfaces = interfaces(&document);
    let [lost, gone] = ["lost", "gone"].map(|id| interfaces.of(&Body::Main, id).expect("a placeholder"));
    assert_eq!(lost.label, "magic/wand");
    assert_eq!(gone.summary, "The group that this node names does not exist.");
}
