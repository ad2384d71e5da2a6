//! Positions of nodes after they are arranged.

use super::*;

const NODES: &str = r#"
    "n": { "kind": "noise/simplex", "pos": [10, 400] }, "w": { "kind": "noise/cells", "pos": [-30, 90] },
    "m": { "kind": "blend/mask", "inputs": { "above": "w.id", "below": "n" }, "pos": [250, 0] },
    "base": { "kind": "source/material", "pos": [500, 0] },
    "layer": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "m" }, "pos": [500, 10] },
    "out": { "kind": "output/material", "inputs": { "material": "layer" }, "pos": [0, 0] }"#;

fn pos(document: &OpenDocument, id: &str) -> [f32; 2] {
    document.graph().node(id).expect("a node").pos
}

#[test]
fn selected_nodes_are_aligned() {
    let mut document = opened("", NODES);
    select(&mut document, &["n", "w", "m"]);
    let all = |document: &OpenDocument| ["n", "w", "m"].map(|id| pos(document, id));
    step(&mut document, |document| arrangement::align(document, Align::Left));
    assert_eq!(all(&document), [[-30.0, 400.0], [-30.0, 90.0], [-30.0, 0.0]]);
    history::undo(&mut document);
    step(&mut document, |document| arrangement::align(document, Align::Right));
    assert_eq!(all(&document).map(|pos| pos[0]), [250.0; 3]);
    history::undo(&mut document);
    step(&mut document, |document| arrangement::align(document, Align::Top));
    assert_eq!(all(&document).map(|pos| pos[1]), [0.0; 3]);
    history::undo(&mut document);
    step(&mut document, |document| arrangement::align(document, Align::Bottom));
    let ends = ["n", "w", "m"].map(|name| pos(&document, name)[1] + node_size::of(&document, &id(name))[1]);
    assert!(ends.iter().all(|end| (end - ends[0]).abs() < 1e-3), "{ends:?}");
    assert_eq!(pos(&document, "out"), [0.0, 0.0], "what is not selected stays");
}

#[test]
fn distributed_nodes_have_equal_spaces_and_the_ends_stay() {
    let mut document = opened("", NODES);
    select(&mut document, &["n", "w", "m"]);
    let ends = |document: &OpenDocument| {
        let mut places = ["n", "w", "m"].map(|name| {
            let top = pos(document, name)[1];
            [top, top + node_size::of(document, &id(name))[1]]
        });
        places.sort_by(|one, other| one[0].total_cmp(&other[0]));
        places
    };
    let before = ends(&document);
    step(&mut document, |document| {
        arrangement::distribute(document, DistributionAxis::Vertical)
    });
    let [first, middle, last] = ends(&document);
    assert_eq!((first, last), (before[0], before[2]));
    assert!(
        (middle[0] - first[1] - (last[0] - middle[1])).abs() < 1e-3,
        "{first:?} {middle:?} {last:?}"
    );
    select(&mut document, &["n", "w"]);
    let said = refused(&mut document, |document| {
        arrangement::distribute(document, DistributionAxis::Horizontal)
    });
    assert_eq!(said, "select three or more nodes to distribute them");
}

/// Returns the vertical offset between the two ends of a wire.
fn slant(document: &OpenDocument, input: &str) -> f32 {
    let input = to(input);
    let wire = connections::wire_into(document, &input).expect("a wire");
    let [reader, source] = [&input.node, &wire.node].map(|id| document.interface(id).expect("an interface"));
    let row = reader
        .inputs
        .iter()
        .position(|port| port.name == input.name)
        .expect("an input");
    let output = source.output(wire.port.as_deref()).expect("a result");
    let out = source
        .outputs
        .iter()
        .position(|port| port.name == output.name)
        .expect("a result");
    let [end, begin] = [&input.node, &wire.node].map(|id| pos(document, id.as_str())[1]);
    (end + ShownRows::all(reader).input(row)) - (begin + ShownRows::all(source).output(out))
}

#[test]
fn wires_between_straightened_nodes_are_horizontal() {
    let mut document = opened("", NODES);
    selection::select_all(&mut document);
    step(&mut document, arrangement::straighten);
    // Each node is level with the first that it reads.
    for input in ["m.below", "layer.base", "out.material"] {
        assert!(
            slant(&document, input).abs() < 1e-3,
            "{input}: {}",
            slant(&document, input)
        );
    }
    assert_eq!(["n", "w", "base"].map(|id| pos(&document, id)[1]), [400.0, 90.0, 0.0]);
    let before = pos(&document, "m");
    select(&mut document, &["m"]);
    refused(&mut document, arrangement::straighten);
    assert_eq!(pos(&document, "m"), before, "alone it is level with nothing");
}

#[test]
fn a_layout_has_no_overlaps_and_repeating_it_changes_nothing() {
    let mut document = opened("", NODES);
    step(&mut document, arrangement::lay_out);
    let ids: Vec<NodeId> = document.graph().ids().cloned().collect();
    for one in &ids {
        for from in document.graph().inputs(one.as_str()).into_values() {
            let [reader, source] = [one, &from.node].map(|id| pos(&document, id.as_str())[0]);
            assert!(source + NODE_WIDTH < reader, "{one} reads {}", from.node);
        }
        for other in ids.iter().filter(|other| *other != one) {
            let [[x, y], [other_x, other_y]] = [one, other].map(|id| pos(&document, id.as_str()));
            let is_apart = (x - other_x).abs() >= NODE_WIDTH
                || y + node_size::of(&document, one)[1] <= other_y
                || other_y + node_size::of(&document, other)[1] <= y;
            assert!(is_apart, "{one} and {other}");
        }
        assert!(pos(&document, one.as_str()).iter().all(|at| at % GRID == 0.0));
    }
    refused(&mut document, arrangement::lay_out);
    assert!(!arrangement::lay_out(&mut super::document()), "nothing is laid out");
}

#[test]
fn frames_are_laid_out_as_units_unless_they_read_each_other() {
    let framed = |frames: [[&str; 2]; 2]| {
        let mut document = opened("", NODES);
        for ids in frames {
            select(&mut document, &ids);
            step(&mut document, frames::add);
        }
        document.select([]);
        step(&mut document, arrangement::lay_out);
        let ends = |ids: [&str; 2]| {
            let lefts = ids.map(|id| pos(&document, id)[0]);
            [lefts[0].min(lefts[1]), lefts[0].max(lefts[1]) + NODE_WIDTH]
        };
        frames.map(ends)
    };
    let [first, second] = framed([["n", "m"], ["layer", "out"]]);
    assert!(first[1] < second[0], "{first:?} {second:?}");
    let [outer, inner] = framed([["n", "layer"], ["m", "w"]]);
    assert!(outer[0] < inner[1] && inner[0] < outer[1], "{outer:?} {inner:?}");
}

#[test]
fn only_selected_nodes_are_laid_out() {
    let mut document = opened("", NODES);
    select(&mut document, &["base", "layer"]);
    step(&mut document, arrangement::lay_out);
    assert_eq!(pos(&document, "n"), [10.0, 400.0]);
    assert!(pos(&document, "base")[0] + NODE_WIDTH < pos(&document, "layer")[0]);
}

#[test]
fn a_drag_is_one_undo_step_for_the_nodes_that_move() {
    let mut document = opened("", NODES);
    select(&mut document, &["n", "w"]);
    let begin = arrangement::selected_positions(&document);
    step(&mut document, |document| {
        document.session.begin("Move");
        for way in 1..20u8 {
            let shifted = begin
                .iter()
                .map(|(id, pos)| (id.clone(), [pos[0] + f32::from(way), pos[1]]));
            let shifted = shifted.collect();
            arrangement::move_nodes(document, "Move", shifted);
        }
        document.session.end();
    });
    assert_eq!(pos(&document, "n"), [29.0, 400.0]);
    let places = arrangement::selected_positions(&document);
    refused(&mut document, |document| {
        arrangement::move_nodes(document, "Move", places)
    });
    let nowhere = [(id("n"), [f32::INFINITY, 0.0])].into();
    let said = refused(&mut document, |document| {
        arrangement::move_nodes(document, "Move", nowhere)
    });
    assert_eq!(said, "a node can only stand at a finite place on the canvas");
}
