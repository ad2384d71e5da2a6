//! Inputs and outputs of graphs that are used as groups, by menus of ports and the list in the parameters.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sabi_editing::{navigation, node_size, ports};
use sabi_graph::Body;

use super::Window;
use super::hands::id;

const GROUPED: &str = r#"{
  "format": "sabi", "version": 1, "name": "Worn edges",
  "groups": {
    "wear": { "inputs": { "where": { "to": ["l.source"] } }, "outputs": { "mask": "l" },
      "nodes": { "l": { "kind": "adjust/levels", "pos": [300, 0] }, "n": { "kind": "noise/cells" } } }
  },
  "nodes": {
    "w": { "kind": "noise/white" },
    "g": { "kind": "graph/group", "group": "wear", "inputs": { "where": "w" }, "pos": [260, 0] },
    "out": { "kind": "output/mask", "inputs": { "source": "g.mask" }, "pos": [520, 0] }
  }
}"#;

fn inside() -> Window {
    let mut window = Window::of(GROUPED);
    let instance = "g".parse().expect("an id");
    assert!(navigation::enter(
        &mut window.harness.state_mut().documents.document,
        &instance
    ));
    window.settle();
    window
}

#[test]
fn ports_are_exposed_and_unexposed_by_their_menus() {
    let mut window = inside();
    window.choose("Cells, input Position, vector", "Expose as input of the group");
    window.choose("Cells, output Mask, mask", "Expose as output of the group");
    let document = &window.editor().documents.document;
    assert_eq!(
        ports::inputs(document)["position"].to,
        ["n.position".parse().expect("an input")]
    );
    assert_eq!(ports::outputs(document)["mask_2"].to_string(), "n");
    window.choose("Cells, output Mask, mask", "Remove the output 'Mask 2'");
    window.choose("Levels, input Source, mask", "Disconnect from the input 'Where'");
    let document = &window.editor().documents.document;
    assert!(!ports::outputs(document).contains_key("mask_2"));
    assert!(ports::inputs(document)["where"].to.is_empty());
    assert_eq!(window.steps(), 4);
}

#[test]
fn a_port_is_disconnected_and_gets_a_new_node_by_its_menu() {
    let mut window = Window::of(GROUPED);
    window.choose("Mask output, input Source, mask", "Disconnect");
    let out = "out".parse().expect("an id");
    assert_eq!(window.wire_into(&out, "source"), None);
    window.choose("Mask output, input Source, mask", "Connect a new node…");
    window.harness.event(egui::Event::Text("clouds".to_owned()));
    window.settle();
    window.key(egui::Key::Enter);
    let added = window.wire_into(&out, "source").expect("a wire");
    let kind = window
        .editor()
        .documents
        .document
        .node(&added.node)
        .map(|node| node.kind.clone());
    assert_eq!(kind.as_deref(), Some("noise/simplex"));
}

#[test]
fn inputs_and_outputs_of_the_group_that_is_open_are_changed_in_a_list() {
    let mut window = inside();
    window.fill("Label of the input", "Where it is worn");
    window.fill("Input", "place");
    window.fill("Output", "worn");
    window.click("Levels · Mask");
    window.click("Cells · ID");
    let document = &window.editor().documents.document;
    assert_eq!(
        ports::inputs(document)["place"].label.as_deref(),
        Some("Where it is worn")
    );
    assert_eq!(ports::outputs(document)["worn"].to_string(), "n.id");
    let place = document.contents().graph.link_into("g", "place");
    assert!(place.is_some(), "instances follow");
    window.fill("Name of the group", "Wear and tear");
    assert_eq!(
        window.editor().documents.document.body(),
        Body::Group("Wear and tear".to_owned())
    );
    window.click("Remove the input place");
    assert!(ports::inputs(&window.editor().documents.document).is_empty());
    assert_eq!(window.steps(), 6);
}

#[test]
fn the_main_graph_is_named_and_can_be_a_group_for_others() {
    let mut window = Window::of(GROUPED);
    assert!(
        window.harness.query_by_label("Name of the graph").is_none(),
        "it is folded away"
    );
    window.click("GROUP INPUTS AND OUTPUTS");
    window.fill("Name of the graph", "Old edges");
    assert_eq!(window.editor().documents.document.contents().name, "Old edges");
    window.choose("wear, output Mask, mask", "Expose as output of the graph");
    assert_eq!(
        ports::outputs(&window.editor().documents.document)["mask"].to_string(),
        "g.mask"
    );
}

#[test]
fn a_click_on_an_input_selects_and_shows_its_node() {
    let mut window = Window::of(GROUPED);
    let group = "g".parse().expect("an id");
    window.click_at(window.port(&group, "where"));
    assert_eq!(window.editor().documents.document.selected_one(), Some(&group));
    let shown = window.editor().looks.inspected().map(|shown| shown.node.clone());
    assert_eq!(shown.as_deref(), Some("g"));
}

#[test]
fn wires_are_drawn_as_names_that_lead_to_their_source_and_can_be_connected_to() {
    let mut window = Window::of(GROUPED);
    let document = |window: &mut Window| window.document().contents().clone();
    window.click_at(window.title(&id("w")));
    window.keys(Modifiers::SHIFT, Key::W);
    assert!(
        document(&mut window)
            .graph
            .node("w")
            .is_some_and(|node| node.display.has_named_wires)
    );
    assert!(window.has("Wires from White noise"));
    window.press("Wire from White noise to g.where");
    assert_eq!(window.document().selected_one(), Some(&id("w")));
    window.choose("Mask output, input Source, mask", "Connect to White noise");
    assert_eq!(
        window.wire_into(&id("out"), "source").map(|from| from.node),
        Some(id("w"))
    );
    // The key shows only connected rows, and then only the title; the wires stay.
    window.click_at(window.title(&id("g")));
    let height = |window: &mut Window| node_size::of(window.document(), &id("g"))[1];
    let all = height(&mut window);
    window.keys(Modifiers::COMMAND, Key::H);
    let wired = height(&mut window);
    window.key(Key::H);
    let none = height(&mut window);
    assert!(none < wired && wired < all, "{none} {wired} {all}");
    window.key(Key::H);
    assert_eq!(height(&mut window), all);
    assert_eq!(window.wire_into(&id("g"), "where").map(|from| from.node), Some(id("w")));
}
