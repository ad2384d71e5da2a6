//! Masks that multiply parameters are connected, exposed, copied and replaced like inputs.

use super::*;

const NODES: &str = r#"
    "c": { "kind": "noise/cells", "pos": [0, 0] },
    "n": { "kind": "noise/simplex", "inputs": { "gain": "c" }, "params": { "gain": 0.75 }, "pos": [300, 0] },
    "l": { "kind": "adjust/levels", "inputs": { "source": "n" }, "pos": [600, 0] },
    "out": { "kind": "output/mask", "inputs": { "source": "l" }, "pos": [900, 0] }"#;

/// Names of the inputs that a node has now.
fn inputs(document: &OpenDocument, node: &str) -> Vec<String> {
    let interface = document.interface(&id(node)).expect("a node");
    interface.inputs.iter().map(|port| port.name.clone()).collect()
}

#[test]
fn a_parameter_accepts_a_mask_and_its_node_then_has_an_input_for_it() {
    let mut document = opened("", NODES);
    assert_eq!(inputs(&document, "l"), ["source"]);
    step(&mut document, |document| {
        wires::connect(document, &from("c"), &to("l.gamma"))
    });
    assert_eq!(wire(&document, "l.gamma"), "c");
    assert_eq!(inputs(&document, "l"), ["source", "gamma"]);
    step(&mut document, |document| wires::remove_mask(document, &to("l.gamma")));
    assert_eq!(wire(&document, "l.gamma"), "");
    assert_eq!(inputs(&document, "l"), ["source"]);
    let said = refused(&mut document, |document| {
        wires::connect(document, &from("c"), &to("n.octaves"))
    });
    assert_eq!(said, "'Clouds' has no input 'octaves'");
}

#[test]
fn a_node_added_for_a_parameter_is_connected_to_it() {
    let mut document = opened("", NODES);
    let pending = PendingWire::Into(to("l.gamma"));
    let new = step(&mut document, |document| {
        nodes::add(document, "noise/white", [0.0, 0.0], Some(&pending))
    });
    assert_eq!(wire(&document, "l.gamma"), new.expect("a node").as_str());
}

#[test]
fn normal_inputs_come_before_parameters_that_accept_a_mask() {
    let mut document = opened("", NODES);
    let [plain, params] = wires::accepting(&document, &from("c"), &id("l"));
    assert_eq!(plain, [to("l.source")]);
    assert!(params.contains(&to("l.gamma")) && !params.contains(&to("l.source")));
    // A connected mask is still listed with the parameters, whether it has a row or not.
    wires::connect(&mut document, &from("c"), &to("l.gamma"));
    let linked = wires::accepting(&document, &from("c"), &id("l"));
    assert_eq!(linked, [plain, params]);
    let [plain, params] = wires::accepting(&document, &from("l"), &id("n"));
    assert_eq!([plain, params], [Vec::new(), Vec::new()], "it would close a loop");
}

#[test]
fn an_input_of_a_group_can_feed_the_mask_of_a_parameter() {
    let groups = r#""groups": { "G": { "outputs": { "mask": "l" }, "inputs": { "where": { "to": ["l.source"] } },
        "nodes": { "l": { "kind": "adjust/levels" } } } },"#;
    let nodes = r#""c": { "kind": "noise/cells" }, "g": { "kind": "graph/group", "group": "G" },
        "out": { "kind": "output/mask", "inputs": { "source": "g.mask" } }"#;
    let mut document = opened(groups, nodes);
    assert!(navigation::enter(&mut document, &id("g")));
    let name = step(&mut document, |document| ports::expose_input(document, &to("l.gamma")));
    assert_eq!(name.as_deref(), Some("gamma"));
    assert_eq!(inputs(&document, "l"), ["source", "gamma"]);
    let feedable = ports::feedable(&document, "where");
    assert!(feedable.contains(&to("l.black")) && !feedable.contains(&to("l.gamma")));
    step(&mut document, |document| ports::feed(document, "where", &to("l.black")));
    step(&mut document, |document| wires::remove_mask(document, &to("l.black")));
    assert_eq!(ports::inputs(&document)["where"].to, [to("l.source")]);
    navigation::leave(&mut document);
    assert_eq!(inputs(&document, "g"), ["gamma", "where"]);
    let before = evaluated(&document);
    step(&mut document, |document| {
        wires::connect(document, &from("c"), &to("g.gamma"))
    });
    assert_ne!(evaluated(&document), before);
    select(&mut document, &["g"]);
    let before = evaluated(&document);
    step(&mut document, groups::dissolve_selected);
    let levels = document.selected_one().cloned().expect("the node of the group");
    assert_eq!(wire(&document, &format!("{levels}.gamma")), "c");
    assert_eq!(evaluated(&document), before);
}

#[test]
fn grouping_and_ungrouping_keep_the_mask_of_a_parameter() {
    let before = evaluated(&opened("", NODES));
    for ids in [
        vec!["n"],
        vec!["c"],
        vec!["c", "n"],
        vec!["n", "l"],
        vec!["c", "n", "l"],
    ] {
        let mut document = opened("", NODES);
        select(&mut document, &ids);
        step(&mut document, groups::make);
        assert_eq!(evaluated(&document), before, "{ids:?}");
        step(&mut document, groups::dissolve_selected);
        assert_eq!(evaluated(&document), before, "{ids:?}");
    }
}

#[test]
fn copies_keep_the_mask_of_a_parameter() {
    let mut document = opened("", NODES);
    select(&mut document, &["c", "n"]);
    let text = clipboard::copy(&document).expect("two nodes");
    step(&mut document, |document| {
        clipboard::paste(document, &text, [0.0, 500.0])
    });
    let gains = |document: &OpenDocument| {
        let graph = document.graph();
        graph
            .ids()
            .filter(|id| graph.link_into(id.as_str(), "gain").is_some())
            .count()
    };
    assert_eq!(gains(&document), 2);
    select(&mut document, &["n"]);
    step(&mut document, |document| duplication::duplicate(document, true));
    assert_eq!(gains(&document), 3);
}

#[test]
fn a_muted_node_keeps_the_mask_of_its_parameter_but_does_not_pass_it_on() {
    let mut document = opened("", NODES);
    select(&mut document, &["n"]);
    step(&mut document, nodes::toggle_muted);
    assert_eq!(wire(&document, "n.gain"), "c");
    step(&mut document, |document| nodes::delete(document, true));
    assert_eq!(wire(&document, "l.source"), "");
}

#[test]
fn swapping_inputs_does_not_move_the_mask_of_a_parameter() {
    let mut document = opened("", NODES);
    wires::connect(&mut document, &from("c"), &to("l.gamma"));
    select(&mut document, &["l"]);
    wires::swap_inputs(&mut document);
    assert_eq!([wire(&document, "l.source"), wire(&document, "l.gamma")], ["n", "c"]);
}

#[test]
fn a_replaced_node_keeps_masks_of_parameters_that_the_new_node_also_has() {
    let mut document = opened("", NODES);
    wires::connect(&mut document, &from("c"), &to("l.gamma"));
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("n"), "noise/cells")
    });
    let cells = document.selected_one().cloned().expect("the new node");
    let has_gain = document
        .catalog()
        .entry("noise/cells")
        .expect("a kind")
        .param_mask("gain");
    let kept = if has_gain.is_some() { "c" } else { "" };
    assert_eq!(wire(&document, &format!("{cells}.gain")), kept);
    // The mask of a parameter that no longer exists does not become another input.
    step(&mut document, |document| {
        node_replacement::by_kind(document, &id("l"), "blend/mask")
    });
    let blend = document.selected_one().cloned().expect("the new node");
    let read = ["below", "above", "mask", "gamma"].map(|input| wire(&document, &format!("{blend}.{input}")));
    assert_eq!(read, [cells.as_str(), "", "", ""]);
}
