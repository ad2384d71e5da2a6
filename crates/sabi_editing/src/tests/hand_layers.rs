//! Layers that are filled and painted, and painted masks.

use super::*;
use crate::command::{LayerCommand, Outcome, perform};
use crate::hand_layers::HandLayer;

const NODES: &str = r#"
    "paint": { "kind": "source/material", "pos": [0, 0] }, "n": { "kind": "noise/cells", "pos": [0, 300] },
    "rust": { "kind": "effect/layer", "label": "Rust", "inputs": { "base": "paint", "mask": "n" }, "pos": [300, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "rust" }, "pos": [600, 0] }"#;

fn added(document: &mut OpenDocument, command: LayerCommand) -> NodeId {
    match perform(document, command.into()) {
        Outcome::Added(node) => node,
        other => panic!("{other:?} {:?}", document.take_notices()),
    }
}

#[test]
fn a_paint_layer_is_added_on_top_and_shows_painted_colors_unchanged() {
    let mut document = opened("", NODES);
    let command = LayerCommand::AddByHand {
        end: Some(StackEnd::Node(id("out"))),
        what: HandLayer::Paint,
    };
    let paint = step(&mut document, |document| added(document, command));
    assert_eq!(document.node(&paint).expect("a node").kind, "source/paint");
    assert!(document.selection().contains(&paint), "it is painted on next");
    let stack = &stack::all(&document)[0];
    let layer = &stack.layers[0];
    assert_eq!((stack.layers.len(), layer.title.as_str()), (3, "Paint layer"));
    assert_eq!(wire(&document, &format!("{}.mask", layer.node)), paint.to_string());
    assert_eq!(
        wire(&document, &format!("{}.color_map", layer.node)),
        format!("{paint}.color")
    );
    assert_eq!(
        wire(&document, &format!("{}.height_map", layer.node)),
        format!("{paint}.height"),
        "the brush can raise and carve"
    );
    assert_eq!(
        param(&document, layer.node.as_str(), "height"),
        Some(Value::Number(1.0))
    );
    // The color of a layer multiplies its color map: gray would darken the painted colors.
    assert_eq!(param(&document, layer.node.as_str(), "color"), Some("#ffffff".into()));
    assert_eq!(document.session.undo_names().collect::<Vec<_>>(), ["Add Paint layer"]);
}

#[test]
fn a_fill_layer_covers_everything_and_adds_an_output_if_there_is_none() {
    let mut document = document();
    let command = LayerCommand::AddByHand {
        end: None,
        what: HandLayer::Fill,
    };
    let layer = step(&mut document, |document| added(document, command));
    let stacks = stack::all(&document);
    let titles: Vec<&str> = stacks[0].layers.iter().map(|layer| layer.title.as_str()).collect();
    assert_eq!((stacks.len(), titles), (1, vec!["Fill layer", "Model"]));
    assert_eq!(stacks[0].layers[0].node, layer);
    assert_eq!(stacks[0].layers[0].mask, None);
    history::undo(&mut document);
    assert!(document.graph().is_empty());
}

#[test]
fn a_mask_is_painted_on_black_or_white_and_replaces_the_old_mask() {
    for (empty, held) in [(0.0, None), (1.0, Some(Value::Number(1.0)))] {
        let mut document = opened("", NODES);
        let node = id("rust");
        let command = LayerCommand::PaintMask { node, empty };
        let paint = step(&mut document, |document| added(document, command));
        assert_eq!(wire(&document, "rust.mask"), paint.to_string());
        assert_eq!(param(&document, paint.as_str(), "empty"), held);
    }
    let mut document = opened("", NODES);
    let (node, empty) = (id("paint"), 0.0);
    let command = LayerCommand::PaintMask { node, empty };
    let why = refused(&mut document, |document| perform(document, command.into()));
    assert_eq!(why, "'Plain material' takes no mask");
}

#[test]
fn connecting_a_color_map_keeps_a_color_that_was_chosen() {
    let mut document = opened(
        "",
        r##""p": { "kind": "source/paint" }, "gray": { "kind": "effect/layer", "pos": [300, 0] },
            "red": { "kind": "effect/layer", "params": { "color": "#ff0000" }, "pos": [300, 500] }"##,
    );
    for (layer, color) in [("gray", "#ffffff"), ("red", "#ff0000")] {
        let slot = slot(&id(layer), "color_map");
        assert!(wires::connect(&mut document, &from("p.color"), &slot));
        assert_eq!(param(&document, layer, "color"), Some(color.into()), "{layer}");
    }
}
