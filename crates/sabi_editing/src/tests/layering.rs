//! The graph as a stack of layers.

use super::*;

const NODES: &str = r#"
    "paint": { "kind": "source/material", "pos": [0, 0] }, "n": { "kind": "noise/cells", "pos": [0, 300] },
    "dents": { "kind": "effect/relief", "label": "Dents", "inputs": { "base": "paint", "mask": "n" }, "pos": [300, 0] },
    "bend": { "kind": "graph/reroute", "inputs": { "source": "dents" }, "pos": [450, 0] },
    "rust": { "kind": "effect/layer", "label": "Rust", "inputs": { "base": "bend", "mask": "n.id" }, "params": { "opacity": 0.5 }, "pos": [600, 0] },
    "moss": { "kind": "material/blend", "label": "Moss", "inputs": { "below": "rust", "above": "green" }, "muted": true, "pos": [900, 0] },
    "green": { "kind": "source/material", "params": { "roughness": 1 }, "pos": [600, 300] },
    "out": { "kind": "output/material", "inputs": { "material": "moss" }, "pos": [1200, 0] }"#;

fn titles(document: &OpenDocument) -> Vec<String> {
    let stacks = stack::all(document);
    stacks[0].layers.iter().map(|layer| layer.title.clone()).collect()
}

fn end() -> StackEnd {
    StackEnd::Node(id("out"))
}

#[test]
fn the_chain_behind_an_output_is_a_list_of_layers() {
    let document = opened("", NODES);
    let stacks = stack::all(&document);
    assert_eq!(
        (stacks.len(), &stacks[0].end, stacks[0].title.as_str()),
        (1, &end(), "Material output")
    );
    assert!(stacks[0].is_plain());
    assert_eq!(titles(&document), ["Moss", "Rust", "Dents", "Plain material"]);
    let layer = |at: usize| &stacks[0].layers[at];
    assert_eq!(
        (layer(0).is_muted, layer(0).opacity, layer(0).mask.clone()),
        (true, None, None)
    );
    assert_eq!((layer(1).is_muted, layer(1).opacity), (false, Some(0.5)));
    assert_eq!(layer(1).mask, Some(from("n.id")));
    let lowest: Vec<bool> = stacks[0].layers.iter().map(|layer| layer.is_lowest.is_some()).collect();
    assert_eq!(lowest, [false, false, false, true]);
}

#[test]
fn visibility_and_opacity_of_a_layer_are_those_of_its_node() {
    let mut document = opened("", NODES);
    step(&mut document, |document| layers::toggle(document, &id("moss")));
    assert!(!stack::all(&document)[0].layers[0].is_muted);
    step(&mut document, |document| {
        layers::set_opacity(document, &id("rust"), 7.0)
    });
    assert_eq!(stack::all(&document)[0].layers[1].opacity, Some(1.0));
    let said = refused(&mut document, |document| {
        layers::set_opacity(document, &id("dents"), 0.5)
    });
    assert_eq!(said, "'Dents' has no Opacity");
    let said = refused(&mut document, |document| {
        layers::set_opacity(document, &id("rust"), f64::NAN)
    });
    assert_eq!(said, "an Opacity is a number");
}

#[test]
fn a_layer_is_moved_with_its_mask_and_settings() {
    for (from, to, now) in [
        (0, 1, ["Rust", "Moss", "Dents"]),
        (0, 2, ["Rust", "Dents", "Moss"]),
        (2, 0, ["Dents", "Moss", "Rust"]),
        (2, 1, ["Moss", "Dents", "Rust"]),
    ] {
        let mut document = opened("", NODES);
        let apart = |document: &OpenDocument| {
            let kept = ["dents.mask", "rust.mask", "moss.above"];
            kept.map(|input| wire(document, input))
        };
        let before = apart(&document);
        step(&mut document, |document| layers::move_to(document, &end(), from, to));
        assert_eq!(titles(&document)[..3], now);
        assert_eq!(titles(&document)[3], "Plain material");
        assert_eq!(apart(&document), before);
        assert_eq!(document.graph().len(), 8);
        layers::move_to(&mut document, &end(), to, from);
        assert_eq!(titles(&document), ["Moss", "Rust", "Dents", "Plain material"]);
        assert_eq!(evaluated(&document), evaluated(&opened("", NODES)));
    }
}

#[test]
fn the_reason_why_a_layer_cannot_be_moved_is_given() {
    let mut document = opened("", NODES);
    let mut said =
        |from: usize, to: usize| refused(&mut document, |document| layers::move_to(document, &end(), from, to));
    let bottom = "'Plain material' is the material at the bottom; nothing can lie below it";
    assert_eq!((said(0, 3), said(3, 2)), (bottom.to_owned(), bottom.to_owned()));
    assert_eq!(said(0, 4), "there is no such layer");
    assert_eq!(said(1, 1), "");
    let lost = StackEnd::Node(id("lost"));
    assert_eq!(
        refused(&mut document, |document| layers::move_to(document, &lost, 0, 1)),
        "the output of this stack is gone"
    );
    let shared = NODES.replace("\"n.id\"", "\"split\"")
        + r#", "split": { "kind": "material/split", "inputs": { "material": "dents" } }"#;
    let mut document = opened(
        "",
        &shared.replace("\"split\" }, \"params\"", "\"split.roughness\" }, \"params\""),
    );
    assert!(!stack::all(&document)[0].is_plain());
    assert_eq!(stack::all(&document)[0].layers[2].also_read_by, [id("split")]);
    let why = "'Dents' is also read by 'Split material', which would change too; use the canvas";
    let said = |document: &mut OpenDocument, from: usize, to: usize| {
        refused(document, |document| layers::move_to(document, &end(), from, to))
    };
    assert_eq!(
        (said(&mut document, 2, 1), said(&mut document, 0, 2)),
        (why.to_owned(), why.to_owned())
    );
    assert_eq!(
        refused(&mut document, |document| layers::remove(document, &end(), 2)),
        why
    );
    step(&mut document, |document| layers::move_to(document, &end(), 0, 1));
    assert_eq!(titles(&document)[..2], ["Rust", "Moss"]);
}

#[test]
fn layers_behind_a_reroute_with_other_readers_cannot_be_moved() {
    let nodes = format!(r#"{NODES}, "two": {{ "kind": "output/material", "inputs": {{ "material": "bend" }} }}"#);
    let mut document = opened("", &nodes);
    assert_eq!(stack::all(&document).len(), 2);
    assert!(!stack::all(&document)[0].is_plain());
    let said = refused(&mut document, |document| layers::move_to(document, &end(), 1, 2));
    assert_eq!(
        said,
        "a reroute between these layers has other readers, which would change too; use the canvas"
    );
    let said = refused(&mut document, |document| {
        layers::add(document, &end(), 2, "effect/layer")
    });
    assert_eq!(
        said,
        "a reroute there has other readers, which would change too; use the canvas"
    );
}

#[test]
fn removing_a_layer_has_the_same_result_as_muting_it() {
    let mut document = opened("", NODES);
    step(&mut document, |document| layers::remove(document, &end(), 1));
    assert_eq!(titles(&document), ["Moss", "Dents", "Plain material"]);
    step(&mut document, |document| layers::remove(document, &end(), 2));
    assert_eq!(titles(&document), ["Moss", "Dents"]);
    assert_eq!(
        refused(&mut document, |document| layers::remove(document, &end(), 9)),
        "there is no such layer"
    );
    step(&mut document, |document| layers::move_to(document, &end(), 0, 1));
    assert_eq!(
        titles(&document),
        ["Dents", "Moss"],
        "with nothing at the bottom all can be moved"
    );
}

#[test]
fn a_layer_is_added_above_another_layer() {
    let mut document = opened("", NODES);
    let add_ = |document: &mut OpenDocument, at: usize, kind: &str| {
        step(document, |document| layers::add(document, &end(), at, kind)).expect("a layer")
    };
    let top = add_(&mut document, 0, "effect/layer");
    assert_eq!(wire(&document, "out.material"), top.as_str());
    assert_eq!(document.selected_one(), Some(&top));
    let low = add_(&mut document, 4, "material/adjust");
    assert_eq!(
        (
            wire(&document, "dents.base"),
            wire(&document, &format!("{low}.material"))
        ),
        (low.to_string(), "paint".to_owned())
    );
    assert_eq!(
        titles(&document),
        ["Layer", "Moss", "Rust", "Dents", "Adjust material", "Plain material"]
    );
    let mut said = |at: usize, kind: &str| refused(&mut document, |document| layers::add(document, &end(), at, kind));
    assert_eq!(
        said(6, "effect/layer"),
        "nothing can lie below the material at the bottom"
    );
    assert_eq!(said(0, "noise/cells"), "'Cells' gives no material");
    assert_eq!(
        said(0, "source/material"),
        "'Plain material' takes no material, and would hide all layers below it"
    );
    assert_eq!(said(0, "lost/kind"), "there is no node kind 'lost/kind'");
    let mut document = opened("", r#""out": { "kind": "output/material" }"#);
    step(&mut document, |document| {
        layers::add(document, &end(), 0, "effect/relief")
    });
    step(&mut document, |document| {
        layers::add(document, &end(), 1, "source/material")
    });
    assert_eq!(titles(&document), ["Relief", "Plain material"]);
}

#[test]
fn material_outputs_of_a_group_are_stacks() {
    let groups = r#""groups": { "g": { "inputs": { "under": { "to": ["low.base"] } }, "outputs": { "material": "top" },
        "nodes": { "low": { "kind": "effect/relief", "label": "Low" }, "mid": { "kind": "effect/layer", "label": "Mid", "inputs": { "base": "low" } },
                   "top": { "kind": "effect/layer", "label": "Top", "inputs": { "base": "mid" } } } } },"#;
    let nodes = r#""p": { "kind": "source/material" }, "g": { "kind": "graph/group", "group": "g", "inputs": { "under": "p" } },
        "out": { "kind": "output/material", "inputs": { "material": "g" } }"#;
    let mut document = opened(groups, nodes);
    assert_eq!(titles(&document), ["g", "Plain material"]);
    navigation::enter(&mut document, &id("g"));
    let end = StackEnd::Port("material".to_owned());
    assert_eq!(stack::all(&document)[0].end, end);
    step(&mut document, |document| layers::move_to(document, &end, 0, 1));
    assert_eq!(titles(&document), ["Mid", "Top", "Low"]);
    let said = refused(&mut document, |document| layers::move_to(document, &end, 1, 2));
    assert_eq!(
        said,
        "'Low' lies on the group's input 'Under'; no layer can come between"
    );
    let said = refused(&mut document, |document| layers::add(document, &end, 3, "effect/layer"));
    assert_eq!(said, "the group's input 'Under' would bypass the layer; use the canvas");
    step(&mut document, |document| layers::add(document, &end, 0, "effect/layer"));
    step(&mut document, |document| layers::remove(document, &end, 1));
    assert_eq!(titles(&document), ["Layer", "Top", "Low"]);
    step(&mut document, |document| layers::remove(document, &end, 2));
    assert_eq!(
        ports::inputs(&document)["under"].to.len(),
        1,
        "what came in goes on to the next layer"
    );
    flat(&document);
}

#[test]
fn an_added_layer_covers_no_node() {
    for at in 0..4 {
        let mut document = opened("", NODES);
        let covered = |document: &OpenDocument| {
            let nodes: Vec<_> = document.graph().nodes().collect();
            let place = |at: usize| (nodes[at].1.pos, node_size::of(document, nodes[at].0));
            let pairs = (0..nodes.len()).flat_map(|one| (0..one).map(move |other| (one, other)));
            let covers = pairs.filter(|&(one, other)| {
                let [(one, size), (other, other_size)] = [one, other].map(place);
                (0..2).all(|axis| one[axis] < other[axis] + other_size[axis] && other[axis] < one[axis] + size[axis])
            });
            covers.count()
        };
        let before = covered(&document);
        for _ in 0..3 {
            step(&mut document, |document| {
                layers::add(document, &end(), at, "effect/layer")
            });
        }
        assert!(covered(&document) <= before, "added at {at}");
    }
}
