//! Layers that are dropped on the model and on nodes.

use super::*;
use crate::command::{LayerCommand, NodeSource, Outcome, perform};
use crate::dropped_layers::{DroppedOn, can_lie_on};

const TWO_OUTPUTS: &str = r#"
    "paint": { "kind": "source/material", "label": "Paint" }, "steel": { "kind": "source/material", "label": "Steel" },
    "a_body": { "kind": "output/material", "inputs": { "material": "paint" }, "params": { "materials": "body" } },
    "b_wheel": { "kind": "output/material", "inputs": { "material": "steel" }, "params": { "materials": "wheel" } }"#;

fn kind(kind: &str) -> NodeSource {
    NodeSource::Kind(kind.to_owned())
}

fn dropped(document: &mut OpenDocument, source: NodeSource, place: DroppedOn, has_normal_map: bool) -> Option<NodeId> {
    let command = LayerCommand::AddOnModel {
        source,
        place,
        has_normal_map,
    };
    match step(document, |document| perform(document, command.into())) {
        Outcome::Added(id) => Some(id),
        _ => None,
    }
}

fn titles(document: &OpenDocument, at: usize) -> Vec<String> {
    let stacks = stack::all(document);
    stacks[at].layers.iter().map(|layer| layer.title.clone()).collect()
}

fn output(name: &str) -> DroppedOn {
    DroppedOn::Output(StackEnd::Node(id(name)))
}

#[test]
fn a_layer_is_added_to_the_output_of_the_place_where_it_is_dropped() {
    let mut document = opened("", TWO_OUTPUTS);
    dropped(&mut document, kind("effect/layer"), output("b_wheel"), false).expect("a layer");
    assert_eq!(titles(&document, 0), ["Paint"]);
    assert_eq!(titles(&document, 1), ["Layer", "Steel"]);
    let command = LayerCommand::AddOnModel {
        source: kind("effect/layer"),
        place: DroppedOn::Unknown,
        has_normal_map: false,
    };
    let said = refused(&mut document, |document| {
        perform(document, command.into()) != Outcome::Unchanged
    });
    assert_eq!(
        said,
        "there are several outputs; drop it on the place of the model whose material it is for"
    );
}

#[test]
fn a_material_without_an_output_gets_one() {
    let mut document = opened("", TWO_OUTPUTS);
    let glass = DroppedOn::Material("glass".to_owned());
    dropped(&mut document, kind("effect/layer"), glass, false).expect("a layer");
    let stacks = stack::all(&document);
    let new = stacks
        .iter()
        .find(|stack| !["a_body", "b_wheel"].contains(&end_of(stack).as_str()));
    let new = new.expect("another output");
    assert_eq!(
        param(&document, &end_of(new), "materials"),
        Some(Value::Text("glass".to_owned()))
    );
    let layers: Vec<&str> = new.layers.iter().map(|layer| layer.title.as_str()).collect();
    assert_eq!(layers, ["Layer", "Model"], "on what the model looks like there");
}

fn end_of(stack: &stack::Stack) -> String {
    match &stack.end {
        StackEnd::Node(id) => id.to_string(),
        StackEnd::Port(name) => name.clone(),
    }
}

#[test]
fn a_layer_on_an_empty_graph_is_added_above_the_models_own_material() {
    let mut document = opened("", "");
    dropped(&mut document, kind("effect/layer"), DroppedOn::Unknown, true).expect("a layer");
    assert_eq!(titles(&document, 0), ["Layer", "Model"]);
}

#[test]
fn a_drop_connects_the_models_normal_map_if_no_layer_below_has_it() {
    let nodes = r#""paint": { "kind": "source/material", "label": "Paint" },
        "out": { "kind": "output/material", "inputs": { "material": "paint" } }"#;
    let mut document = opened("", nodes);
    let layer = dropped(&mut document, kind("effect/layer"), output("out"), true).expect("a layer");
    assert_eq!(titles(&document, 0), ["Layer", "Normal map of the model", "Paint"]);
    assert_eq!(document.selected_one(), Some(&layer));
    let normals = stack::all(&document)[0].layers[1].node.clone();
    let slope = wire(&document, &format!("{normals}.slope"));
    let (model, port) = slope.split_once('.').expect("an output");
    assert_eq!(
        (document.node(&id(model)).map(|node| node.kind.as_str()), port),
        (Some("source/model"), "slope")
    );
    let node = document.node(&normals).expect("a node");
    let switches = node
        .params
        .values()
        .filter(|value| **value == Value::Bool(false))
        .count();
    assert!(switches >= 9, "it changes nothing else: {:?}", node.params);
    // Now the layers below have the normal map.
    dropped(&mut document, kind("effect/relief"), output("out"), true).expect("a layer");
    assert_eq!(
        titles(&document, 0),
        ["Relief", "Layer", "Normal map of the model", "Paint"]
    );
    let mut without = opened("", nodes);
    dropped(&mut without, kind("effect/layer"), output("out"), false).expect("a layer");
    assert_eq!(titles(&without, 0), ["Layer", "Paint"]);
}

#[test]
fn a_base_material_of_the_library_keeps_the_models_normal_map() {
    let base = |name: &str| {
        let file = format!("base/{name}.sabi");
        let files = super::effect_library::all_files().into_iter();
        let mut files = files.filter(|path| path.ends_with(&file));
        NodeSource::Library(files.next().expect("a base material"))
    };
    let mut document = opened("", r#""out": { "kind": "output/material" }"#);
    dropped(&mut document, base("painted_metal"), output("out"), true).expect("a layer");
    assert_eq!(
        titles(&document, 0),
        ["Painted metal"],
        "which takes the model's own material"
    );
    let plain = r#""paint": { "kind": "source/material", "label": "Paint" },
        "out": { "kind": "output/material", "inputs": { "material": "paint" } }"#;
    let mut document = opened("", plain);
    dropped(&mut document, base("wood"), output("out"), true).expect("a layer");
    assert_eq!(titles(&document, 0), ["Wood", "Normal map of the model", "Paint"]);
}

#[test]
fn all_readers_of_a_node_read_the_layer_that_is_dropped_on_it() {
    let nodes = r#"
        "paint": { "kind": "source/material", "label": "Paint" },
        "dents": { "kind": "effect/relief", "inputs": { "base": "paint" } },
        "split": { "kind": "material/split", "inputs": { "material": "paint" } },
        "out": { "kind": "output/material", "inputs": { "material": "dents" } }, "n": { "kind": "noise/cells" }"#;
    let mut document = opened("", nodes);
    let on = |document: &mut OpenDocument, node: &str| {
        let command = LayerCommand::AddOnNode {
            source: kind("effect/layer"),
            node: id(node),
        };
        match step(document, |document| perform(document, command.into())) {
            Outcome::Added(id) => id.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let layer = on(&mut document, "paint");
    assert_eq!(wire(&document, &format!("{layer}.base")), "paint");
    assert_eq!(wire(&document, "dents.base"), layer);
    assert_eq!(wire(&document, "split.material"), layer);
    let top = on(&mut document, "out");
    assert_eq!(wire(&document, "out.material"), top);
    assert_eq!(wire(&document, &format!("{top}.base")), "dents");
    let interface = document.catalog().entry("effect/layer").cloned().expect("a kind");
    let takes = ["paint", "out", "n"].map(|node| can_lie_on(&document, &interface, &id(node)));
    assert_eq!(takes, [true, true, false]);
    let plain = document.catalog().entry("source/material").cloned().expect("a kind");
    assert!(!can_lie_on(&document, &plain, &id("paint")), "it would hide the node");
}
