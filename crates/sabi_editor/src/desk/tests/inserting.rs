//! Room for what is put into a wire.

use super::super::Align;
use super::super::arrange::input_row;
use super::*;

const CHAIN: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "aside": { "kind": "noise/white", "pos": [260, 600] },
    "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [250, 0] },
    "levels": { "kind": "adjust/levels", "inputs": { "source": "invert" }, "pos": [500, 40] },
    "new": { "kind": "adjust/threshold", "pos": [120, 20] }"#;

fn pos(desk: &Desk, id: &str) -> [f32; 2] {
    desk.graph().node(id).expect("a node").pos
}

#[test]
fn what_is_made_from_a_node_in_a_wire_makes_room_for_it_in_one_step() {
    let mut desk = opened("", CHAIN);
    let before = ["clouds", "aside", "invert", "levels", "new"].map(|id| pos(&desk, id));
    step(&mut desk, |desk| desk.insert(&id("new"), &to("invert.source")));
    assert_eq!(
        [wire(&desk, "new.source"), wire(&desk, "invert.source")],
        ["clouds", "new"]
    );
    assert_eq!(pos(&desk, "new"), [230.0, 20.0], "it stands beside what it reads");
    assert_eq!(pos(&desk, "invert"), [460.0, 0.0]);
    assert_eq!(pos(&desk, "levels"), [710.0, 40.0], "as far from the other as before");
    assert_eq!([pos(&desk, "clouds"), pos(&desk, "aside")], [before[0], before[1]]);
    desk.undo();
    let after = ["clouds", "aside", "invert", "levels", "new"].map(|id| pos(&desk, id));
    assert_eq!(after, before);
}

#[test]
fn where_there_is_room_nothing_moves() {
    let mut desk = opened(
        "",
        &CHAIN.replace("[250, 0]", "[600, 0]").replace("[500, 40]", "[900, 40]"),
    );
    desk.move_to("Move", BTreeMap::from([(id("new"), [300.0, 0.0])]));
    step(&mut desk, |desk| desk.insert(&id("new"), &to("invert.source")));
    let all = ["new", "invert", "levels"].map(|id| pos(&desk, id)[0]);
    assert_eq!(all, [300.0, 600.0, 900.0]);
}

#[test]
fn what_may_be_put_into_a_wire_fits_both_of_its_ends() {
    let desk = opened("", CHAIN);
    let into = to("invert.source");
    let fits = |kind: &str| {
        let entry = desk.catalog().entry(kind).expect("a kind");
        desk.may_insert_new(entry, &into)
    };
    let kinds = ["adjust/levels", "graph/reroute", "output/mask", "source/material"];
    assert_eq!(kinds.map(fits), [true, true, false, false]);
    let levels = desk.catalog().entry("adjust/levels").expect("a kind");
    assert!(!desk.may_insert_new(levels, &to("new.source")), "there is no wire");
}

#[test]
fn a_bend_is_brought_in_line_by_its_own_size() {
    let mut desk = opened("", CHAIN);
    step(&mut desk, |desk| desk.reroute(&to("levels.source"), [470.0, 300.0]));
    let bend: NodeId = wire(&desk, "levels.source").parse().expect("a bend");
    let [width, height] = desk.size(&bend);
    assert!(width < 50.0 && height < 30.0);
    assert_eq!(pos(&desk, bend.as_str()), [470.0 - width / 2.0, 300.0 - height / 2.0]);
    desk.select([bend.clone(), id("levels")]);
    desk.straighten();
    let level = pos(&desk, "levels")[1] + input_row(desk.face(&id("levels")).expect("a face"), 0);
    assert!((pos(&desk, bend.as_str())[1] + height / 2.0 - level).abs() < 1e-3);
    step(&mut desk, |desk| desk.align(Align::Right));
    let right = |id: &NodeId| pos(&desk, id.as_str())[0] + desk.size(id)[0];
    assert!((right(&bend) - right(&id("levels"))).abs() < 1e-3);
}
