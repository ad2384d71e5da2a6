//! Adding, removing and setting nodes.

use std::collections::BTreeSet;

use super::*;

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
    let levels = step(&mut desk, |desk| desk.add("adjust/levels", [300.0, 0.0], Some(&loose)));
    let levels = levels.expect("a built-in kind");
    assert_eq!(desk.wire_into(&slot(&levels, "source")), Some(&out(&noise)));
    let loose = Loose::Into(slot(&noise, "position"));
    let warp = step(&mut desk, |desk| desk.add("vector/warp", [-300.0, 0.0], Some(&loose)));
    assert_eq!(
        desk.wire_into(&slot(&noise, "position")),
        warp.map(|id| out(&id)).as_ref()
    );
}

#[test]
fn a_kind_that_nobody_knows_is_not_added() {
    let said = refused(&mut desk(), |desk| desk.add("noise/simplx", [0.0; 2], None));
    assert_eq!(said, "there is no node kind 'noise/simplx'");
    let said = refused(&mut desk(), |desk| desk.add_group_instance("wear", [0.0; 2], None));
    assert_eq!(said, "there is no group 'wear'");
    let said = refused(&mut desk(), |desk| desk.add_group_instance("lost.sabi", [0.0; 2], None));
    assert_eq!(said, "'lost.sabi' cannot be read; choose a graph file");
}

#[test]
fn a_group_file_is_added_with_what_it_takes_and_gives() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("wear.sabi");
    let group = r#"{ "format": "sabi", "version": 1, "name": "Wear", "inputs": { "where": { "to": ["w.below"] } },
        "outputs": { "mask": "w" }, "nodes": { "w": { "kind": "blend/mask" } } }"#;
    std::fs::write(&file, group).expect("a writable folder");
    let mut desk = desk();
    desk.save_as(&folder.path().join("main.sabi"))
        .expect("a writable folder");
    let noise = add(&mut desk, "noise/white");
    let loose = Loose::From(out(&noise));
    let wear = step(&mut desk, |desk| {
        desk.add_group_instance("wear.sabi", [0.0; 2], Some(&loose))
    });
    let wear = wear.expect("a file that is there");
    assert_eq!(wire(&desk, &format!("{wear}.where")), noise.as_str());
    assert_eq!(desk.title(&wear), "Wear");
    assert!(!desk.enter(&wear));
    let said = desk.take_notices().pop().unwrap_or_default();
    assert_eq!(
        said,
        "'wear.sabi' is a file of its own; open it to change what is inside"
    );
    // Somebody else saves it.
    std::fs::write(&file, group.replace("Wear", "Worn out")).expect("a writable folder");
    desk.files_changed(&BTreeSet::from([file]));
    assert_eq!(desk.title(&wear), "Worn out");
}

#[test]
fn deleting_takes_what_hangs_on_a_node_and_undo_brings_it_back_selected() {
    let mut desk = opened(
        r#""exposed": { "size": { "to": ["a.size"] } }, "frames": { "f": { "nodes": ["a", "b"] } },"#,
        r#""a": { "kind": "noise/simplex" }, "b": { "kind": "adjust/invert", "inputs": { "source": "a" } }"#,
    );
    select(&mut desk, &["a"]);
    step(&mut desk, |desk| desk.delete(false));
    assert!(desk.selection().is_empty() && desk.graph().exposed().is_empty());
    desk.undo();
    assert_eq!(desk.selected_one(), Some(&id("a")));
    assert_eq!(wire(&desk, "b.source"), "a");
}

#[test]
fn what_needs_a_selection_does_nothing_without_one() {
    let mut desk = opened("", r#""a": { "kind": "noise/simplex" }"#);
    type Does = fn(&mut Desk) -> bool;
    let all: [(&str, Does); 11] = [
        ("delete", |desk| desk.delete(false)),
        ("heal", |desk| desk.delete(true)),
        ("mute", Desk::mute),
        ("duplicate", |desk| desk.duplicate(true)),
        ("take out", Desk::take_out),
        ("swap", Desk::swap_inputs),
        ("group", Desk::make_group),
        ("ungroup", Desk::dissolve_groups),
        ("frame", Desk::frame),
        ("align", |desk| desk.align(super::super::Align::Left)),
        ("straighten", Desk::straighten),
    ];
    for (name, does) in all {
        let mut is_made = true;
        refused(&mut desk, |desk| is_made = does(desk));
        assert!(!is_made, "{name}");
    }
    assert!(desk.copied().is_none() && desk.cut_out().is_none());
}

#[test]
fn what_is_done_to_a_node_that_is_gone_is_refused_with_a_sentence() {
    let mut desk = opened("", r#""a": { "kind": "noise/simplex" }"#);
    let lost = id("lost");
    let refused_all = [
        refused(&mut desk, |desk| desk.set_knob(&lost, "gain", number(1.0))),
        refused(&mut desk, |desk| desk.rename(&lost, "x")),
        refused(&mut desk, |desk| desk.replace(&lost, "noise/cells")),
        refused(&mut desk, |desk| desk.connect(&from("lost"), &to("a.position"))),
        refused(&mut desk, |desk| desk.connect(&from("a"), &to("lost.source"))),
        refused(&mut desk, |desk| desk.expose(&lost, "gain")),
    ];
    for said in refused_all {
        assert!(!said.is_empty());
    }
    assert!(!desk.enter(&lost) && !desk.reroute(&to("lost.source"), [0.0; 2]));
}

#[test]
fn muting_is_for_all_selected_nodes_and_back_once_all_are_mute() {
    let mut desk = opened(
        "",
        r#""a": { "kind": "noise/simplex", "muted": true }, "b": { "kind": "noise/cells" }"#,
    );
    select(&mut desk, &["a", "b"]);
    let muted = |desk: &Desk| ["a", "b"].map(|id| desk.graph().node(id).is_some_and(|node| node.muted));
    step(&mut desk, Desk::mute);
    assert_eq!(muted(&desk), [true, true]);
    step(&mut desk, Desk::mute);
    assert_eq!(muted(&desk), [false, false]);
}

#[test]
fn a_knob_is_set_on_all_selected_nodes_of_the_kind() {
    let mut desk = opened(
        "",
        r#""a": { "kind": "noise/simplex" }, "b": { "kind": "noise/simplex" }, "c": { "kind": "noise/cells" }"#,
    );
    desk.select_all();
    step(&mut desk, |desk| desk.set_knob_of_alike(&id("a"), "size", number(0.5)));
    let sizes = ["a", "b", "c"].map(|id| param(&desk, id, "size"));
    assert_eq!(sizes, [number(0.5), number(0.5), None]);
    let said = refused(&mut desk, |desk| desk.set_knob(&id("a"), "size", number(f64::NAN)));
    assert!(said.starts_with("the value of \"size\" cannot be kept"), "{said}");
    step(&mut desk, |desk| desk.set_knob(&id("a"), "size", None));
    assert_eq!(param(&desk, "a", "size"), None);
}

#[test]
fn what_is_so_already_is_no_step() {
    let mut desk = opened("", r#""a": { "kind": "noise/simplex", "params": { "size": 0.5 } }"#);
    refused(&mut desk, |desk| desk.set_knob(&id("a"), "size", number(0.5)));
    refused(&mut desk, |desk| desk.set_knob(&id("a"), "gain", None));
    refused(&mut desk, |desk| desk.rename(&id("a"), " "));
}

#[test]
fn a_node_has_the_name_that_it_was_given_or_that_of_its_kind() {
    let mut desk = opened("", r#""a": { "kind": "noise/simplex" }"#);
    let plain = desk.title(&id("a"));
    step(&mut desk, |desk| desk.rename(&id("a"), " Clouds of dust "));
    assert_eq!(desk.title(&id("a")), "Clouds of dust");
    step(&mut desk, |desk| desk.rename(&id("a"), ""));
    assert_eq!(desk.title(&id("a")), plain);
}
