//! Space for nodes that are inserted into a wire.

use super::*;

const CHAIN: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "aside": { "kind": "noise/white", "pos": [260, 600] },
    "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [250, 0] },
    "levels": { "kind": "adjust/levels", "inputs": { "source": "invert" }, "pos": [500, 40] },
    "new": { "kind": "adjust/threshold", "pos": [120, 20] }"#;

fn pos(document: &OpenDocument, id: &str) -> [f32; 2] {
    document.graph().node(id).expect("a node").pos
}

#[test]
fn an_inserted_node_moves_others_aside_in_the_same_step() {
    let mut document = opened("", CHAIN);
    let before = ["clouds", "aside", "invert", "levels", "new"].map(|id| pos(&document, id));
    step(&mut document, |document| {
        wires::insert(document, &id("new"), &to("invert.source"))
    });
    assert_eq!(
        [wire(&document, "new.source"), wire(&document, "invert.source")],
        ["clouds", "new"]
    );
    assert_eq!(pos(&document, "new"), [230.0, 20.0], "it stands beside what it reads");
    assert_eq!(pos(&document, "invert"), [460.0, 0.0]);
    assert_eq!(
        pos(&document, "levels"),
        [710.0, 40.0],
        "as far from the other as before"
    );
    assert_eq!(
        [pos(&document, "clouds"), pos(&document, "aside")],
        [before[0], before[1]]
    );
    history::undo(&mut document);
    let after = ["clouds", "aside", "invert", "levels", "new"].map(|id| pos(&document, id));
    assert_eq!(after, before);
}

#[test]
fn if_there_is_enough_space_no_node_moves() {
    let mut document = opened(
        "",
        &CHAIN.replace("[250, 0]", "[600, 0]").replace("[500, 40]", "[900, 40]"),
    );
    arrangement::move_nodes(&mut document, "Move", BTreeMap::from([(id("new"), [300.0, 0.0])]));
    step(&mut document, |document| {
        wires::insert(document, &id("new"), &to("invert.source"))
    });
    let all = ["new", "invert", "levels"].map(|id| pos(&document, id)[0]);
    assert_eq!(all, [300.0, 600.0, 900.0]);
}

#[test]
fn a_node_can_be_inserted_into_a_wire_only_if_it_fits_both_ends() {
    let document = opened("", CHAIN);
    let into = to("invert.source");
    let fits = |kind: &str| {
        let entry = document.catalog().entry(kind).expect("a kind");
        wires::can_insert_new(&document, entry, &into)
    };
    let kinds = ["adjust/levels", "graph/reroute", "output/mask", "source/material"];
    assert_eq!(kinds.map(fits), [true, true, false, false]);
    let levels = document.catalog().entry("adjust/levels").expect("a kind");
    assert!(
        !wires::can_insert_new(&document, levels, &to("new.source")),
        "there is no wire"
    );
}

#[test]
fn a_reroute_is_aligned_by_its_own_size() {
    let mut document = opened("", CHAIN);
    step(&mut document, |document| {
        wires::reroute(document, &to("levels.source"), [470.0, 300.0])
    });
    let bend: NodeId = wire(&document, "levels.source").parse().expect("a bend");
    let [width, height] = node_size::of(&document, &bend);
    assert!(width < 50.0 && height < 30.0);
    assert_eq!(
        pos(&document, bend.as_str()),
        [470.0 - width / 2.0, 300.0 - height / 2.0]
    );
    document.select([bend.clone(), id("levels")]);
    arrangement::straighten(&mut document);
    let level =
        pos(&document, "levels")[1] + ShownRows::all(document.interface(&id("levels")).expect("an interface")).input(0);
    assert!((pos(&document, bend.as_str())[1] + height / 2.0 - level).abs() < 1e-3);
    step(&mut document, |document| arrangement::align(document, Align::Right));
    let right = |id: &NodeId| pos(&document, id.as_str())[0] + node_size::of(&document, id)[0];
    assert!((right(&bend) - right(&id("levels"))).abs() < 1e-3);
}
