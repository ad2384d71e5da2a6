//! Adding, removing and setting nodes.

use std::collections::BTreeSet;

use super::*;

#[test]
fn a_new_node_is_selected_and_gets_its_own_seed() {
    let mut document = document();
    let [one, other] = [add(&mut document, "noise/simplex"), add(&mut document, "noise/simplex")];
    assert!(one.as_str().starts_with("simplex_"), "{one}");
    assert_eq!(document.selected_one(), Some(&other));
    let seed = |id: &NodeId| document.node(id).and_then(|node| node.params.get("seed").cloned());
    assert!(seed(&one).is_some() && seed(&one) != seed(&other));
}

#[test]
fn a_node_added_at_the_end_of_a_dragged_wire_is_connected() {
    let mut document = document();
    let noise = add(&mut document, "noise/simplex");
    let loose = PendingWire::From(out(&noise));
    let levels = step(&mut document, |document| {
        nodes::add(document, "adjust/levels", [300.0, 0.0], Some(&loose))
    });
    let levels = levels.expect("a built-in kind");
    assert_eq!(
        connections::wire_into(&document, &slot(&levels, "source")),
        Some(&out(&noise))
    );
    let loose = PendingWire::Into(slot(&noise, "position"));
    let warp = step(&mut document, |document| {
        nodes::add(document, "vector/warp", [-300.0, 0.0], Some(&loose))
    });
    assert_eq!(
        connections::wire_into(&document, &slot(&noise, "position")),
        warp.map(|id| out(&id)).as_ref()
    );
}

#[test]
fn an_unknown_kind_is_not_added() {
    let said = refused(&mut document(), |document| {
        nodes::add(document, "noise/simplx", [0.0; 2], None)
    });
    assert_eq!(said, "there is no node kind 'noise/simplx'");
    let said = refused(&mut document(), |document| {
        nodes::add_instance(document, "wear", [0.0; 2], None)
    });
    assert_eq!(said, "there is no group 'wear'");
    let said = refused(&mut document(), |document| {
        nodes::add_instance(document, "lost.sabi", [0.0; 2], None)
    });
    assert_eq!(said, "'lost.sabi' cannot be read; choose a graph file");
}

#[test]
fn a_group_file_is_added_with_its_inputs_and_outputs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("wear.sabi");
    let group = r#"{ "format": "sabi", "version": 1, "name": "Wear", "inputs": { "where": { "to": ["w.below"] } },
        "outputs": { "mask": "w" }, "nodes": { "w": { "kind": "blend/mask" } } }"#;
    std::fs::write(&file, group).expect("a writable folder");
    let mut document = document();
    document
        .save_as(&folder.path().join("main.sabi"))
        .expect("a writable folder");
    let noise = add(&mut document, "noise/white");
    let loose = PendingWire::From(out(&noise));
    let wear = step(&mut document, |document| {
        nodes::add_instance(document, "wear.sabi", [0.0; 2], Some(&loose))
    });
    let wear = wear.expect("a file that is there");
    assert_eq!(wire(&document, &format!("{wear}.where")), noise.as_str());
    assert_eq!(document.title(&wear), "Wear");
    assert!(!navigation::enter(&mut document, &wear));
    let said = document.take_notices().pop().unwrap_or_default();
    assert_eq!(
        said,
        "'wear.sabi' is a file of its own; open it to change what is inside"
    );
    // Another program saves the group file.
    std::fs::write(&file, group.replace("Wear", "Worn out")).expect("a writable folder");
    document.files_changed(&BTreeSet::from([file]));
    assert_eq!(document.title(&wear), "Worn out");
}

#[test]
fn undo_of_a_deletion_restores_all_references_and_selects_the_node() {
    let mut document = opened(
        r#""exposed": { "size": { "to": ["a.size"] } }, "frames": { "f": { "nodes": ["a", "b"] } },"#,
        r#""a": { "kind": "noise/simplex" }, "b": { "kind": "adjust/invert", "inputs": { "source": "a" } }"#,
    );
    select(&mut document, &["a"]);
    step(&mut document, |document| nodes::delete(document, false));
    assert!(document.selection().is_empty() && document.graph().exposed().is_empty());
    history::undo(&mut document);
    assert_eq!(document.selected_one(), Some(&id("a")));
    assert_eq!(wire(&document, "b.source"), "a");
}

#[test]
fn commands_that_need_a_selection_do_nothing_without_one() {
    let mut document = opened("", r#""a": { "kind": "noise/simplex" }"#);
    type Does = fn(&mut OpenDocument) -> bool;
    let all: [(&str, Does); 11] = [
        ("delete", |document| nodes::delete(document, false)),
        ("heal", |document| nodes::delete(document, true)),
        ("mute", nodes::toggle_muted),
        ("duplicate", |document| duplication::duplicate(document, true)),
        ("take out", wires::detach_selected),
        ("swap", wires::swap_inputs),
        ("group", groups::make),
        ("ungroup", groups::dissolve_selected),
        ("frame", frames::add),
        ("align", |document| arrangement::align(document, Align::Left)),
        ("straighten", arrangement::straighten),
    ];
    for (name, does) in all {
        let mut is_made = true;
        refused(&mut document, |document| is_made = does(document));
        assert!(!is_made, "{name}");
    }
    assert!(clipboard::copy(&document).is_none() && clipboard::cut(&mut document).is_none());
}

#[test]
fn edits_of_a_missing_node_are_refused_with_a_sentence() {
    let mut document = opened("", r#""a": { "kind": "noise/simplex" }"#);
    let lost = id("lost");
    let refused_all = [
        refused(&mut document, |document| {
            nodes::set_knob(document, &lost, "gain", number(1.0))
        }),
        refused(&mut document, |document| nodes::rename(document, &lost, "x")),
        refused(&mut document, |document| {
            node_replacement::by_kind(document, &lost, "noise/cells")
        }),
        refused(&mut document, |document| {
            wires::connect(document, &from("lost"), &to("a.position"))
        }),
        refused(&mut document, |document| {
            wires::connect(document, &from("a"), &to("lost.source"))
        }),
        refused(&mut document, |document| exposed_knobs::expose(document, &lost, "gain")),
    ];
    for said in refused_all {
        assert!(!said.is_empty());
    }
    assert!(!navigation::enter(&mut document, &lost) && !wires::reroute(&mut document, &to("lost.source"), [0.0; 2]));
}

#[test]
fn muting_applies_to_all_selected_nodes_and_unmutes_if_all_are_muted() {
    let mut document = opened(
        "",
        r#""a": { "kind": "noise/simplex", "muted": true }, "b": { "kind": "noise/cells" }"#,
    );
    select(&mut document, &["a", "b"]);
    let muted = |document: &OpenDocument| ["a", "b"].map(|id| document.graph().node(id).is_some_and(|node| node.muted));
    step(&mut document, nodes::toggle_muted);
    assert_eq!(muted(&document), [true, true]);
    step(&mut document, nodes::toggle_muted);
    assert_eq!(muted(&document), [false, false]);
}

#[test]
fn a_knob_is_set_on_all_selected_nodes_of_the_same_kind() {
    let mut document = opened(
        "",
        r#""a": { "kind": "noise/simplex" }, "b": { "kind": "noise/simplex" }, "c": { "kind": "noise/cells" }"#,
    );
    selection::select_all(&mut document);
    step(&mut document, |document| {
        nodes::set_knob_of_selected(document, &id("a"), "size", number(0.5))
    });
    let sizes = ["a", "b", "c"].map(|id| param(&document, id, "size"));
    assert_eq!(sizes, [number(0.5), number(0.5), None]);
    let said = refused(&mut document, |document| {
        nodes::set_knob(document, &id("a"), "size", number(f64::NAN))
    });
    assert!(said.starts_with("the value of \"size\" cannot be kept"), "{said}");
    step(&mut document, |document| {
        nodes::set_knob(document, &id("a"), "size", None)
    });
    assert_eq!(param(&document, "a", "size"), None);
}

#[test]
fn an_edit_without_effect_is_not_an_undo_step() {
    let mut document = opened("", r#""a": { "kind": "noise/simplex", "params": { "size": 0.5 } }"#);
    refused(&mut document, |document| {
        nodes::set_knob(document, &id("a"), "size", number(0.5))
    });
    refused(&mut document, |document| {
        nodes::set_knob(document, &id("a"), "gain", None)
    });
    refused(&mut document, |document| nodes::rename(document, &id("a"), " "));
}

#[test]
fn a_node_has_its_own_name_or_the_name_of_its_kind() {
    let mut document = opened("", r#""a": { "kind": "noise/simplex" }"#);
    let plain = document.title(&id("a"));
    step(&mut document, |document| {
        nodes::rename(document, &id("a"), " Clouds of dust ")
    });
    assert_eq!(document.title(&id("a")), "Clouds of dust");
    step(&mut document, |document| nodes::rename(document, &id("a"), ""));
    assert_eq!(document.title(&id("a")), plain);
}

#[test]
fn a_node_of_the_main_graph_is_muted_only_once_and_undo_unmutes_it() {
    let mut document = document();
    let noise = add(&mut document, "noise/simplex");
    assert!(nodes::mute_in_main_graph(&mut document, &noise));
    assert!(document.node(&noise).is_some_and(|node| node.muted));
    assert!(!nodes::mute_in_main_graph(&mut document, &noise), "it is muted already");
    assert!(!nodes::mute_in_main_graph(
        &mut document,
        &"gone".parse().expect("an id")
    ));
    history::undo(&mut document);
    assert!(document.node(&noise).is_some_and(|node| !node.muted));
}

#[test]
fn a_node_that_would_cover_another_is_placed_beside_it() {
    let document = opened("", r#""n": { "kind": "noise/cells", "pos": [0, 0] }"#);
    let interface = document.interface(&id("n")).cloned().expect("a node");
    let size = node_size::size_of(&interface);
    let free = [0.0, size[1]];
    assert_eq!(nodes::uncovered(&document, &interface, free), free);
    // At the edge of another node it moves only by the overlap plus the space between nodes.
    let [x, y] = nodes::uncovered(&document, &interface, [0.0, size[1] - 10.0]);
    assert!(x == 0.0 && (size[1]..size[1] + 30.0).contains(&y), "{x} {y}");
    for place in [[0.0, 0.0], [30.0, -20.0], [90.0, 100.0]] {
        let [x, y] = nodes::uncovered(&document, &interface, place);
        assert!(x.abs() >= size[0] || y.abs() >= size[1], "{place:?}: {x} {y}");
    }
    // It is placed on the right, in reading direction, although the left is nearer by an amount that nobody can see.
    let [x, y] = nodes::uncovered(&document, &interface, [-0.4, 0.0]);
    assert!(x >= size[0] && y == 0.0, "{x} {y}");
}
