use sabi_engine::Session;
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::names::Names;
use super::{Desk, Loose};

/// An empty graph, with names that are the same in every run.
fn desk() -> Desk {
    Desk::with_names(Session::new(None), Names::seeded(7))
}

fn add(desk: &mut Desk, kind: &str) -> NodeId {
    desk.add(kind, [0.0, 0.0], None).expect("a built-in kind")
}

fn out(id: &NodeId) -> OutputRef {
    OutputRef {
        node: id.clone(),
        port: None,
    }
}

fn slot(id: &NodeId, name: &str) -> SlotRef {
    SlotRef {
        node: id.clone(),
        name: name.to_owned(),
    }
}

#[test]
fn a_new_node_is_selected_and_has_a_seed_of_its_own() {
    let mut desk = desk();
    let [one, other] = [add(&mut desk, "noise/simplex"), add(&mut desk, "noise/simplex")];
    assert!(one.as_str().starts_with("simplex_"), "{one}");
    assert_eq!(desk.selected_one(), Some(&other));
    let seed = |id: &NodeId| desk.node(id).and_then(|node| node.params.get("seed").cloned());
    assert!(seed(&one).is_some() && seed(&one) != seed(&other));
}

#[test]
fn a_node_dropped_at_the_end_of_a_wire_is_tied_to_it() {
    let mut desk = desk();
    let noise = add(&mut desk, "noise/simplex");
    let loose = Loose::From(out(&noise));
    let levels = desk
        .add("adjust/levels", [300.0, 0.0], Some(&loose))
        .expect("a built-in kind");
    assert_eq!(desk.wire_into(&slot(&levels, "source")), Some(&out(&noise)));
    desk.undo();
    assert!(desk.node(&levels).is_none(), "node and wire are one step");
}
