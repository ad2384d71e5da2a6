//! Reroutes, cards and tooltips.

use egui::{Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;
use sabi_graph::NodeId;

use super::Window;
use super::hands::{beside, between, id};

const WIRED: &str = r#"
    "blur": { "kind": "filter/blur", "pos": [0, 330] },
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [400, 0] }
"#;

/// A window with a reroute in its wire, and the place that was clicked.
fn window_with_reroute() -> (Window, NodeId, [f32; 2]) {
    let mut window = Window::opened(WIRED);
    let gap = between(window.port(&id("clouds"), "mask"), window.port(&id("invert"), "source"));
    let place = window
        .editor()
        .views
        .canvas
        .camera
        .place_at(gap)
        .expect("a place on the canvas");
    window.double_click(gap);
    let mut nodes = window.document().graph().nodes();
    let reroute = nodes.find(|(_, node)| node.kind == "graph/reroute");
    let reroute = reroute.expect("a reroute").0.clone();
    drop(nodes);
    (window, reroute, place)
}

#[test]
fn a_reroute_is_a_dot_around_the_click_with_its_ports_at_its_ends() {
    let (window, reroute, place) = window_with_reroute();
    let rect = window.rect(&reroute);
    let clicked = window.screen(place);
    assert!((rect.center() - clicked).length() < 2.0, "{rect:?} {clicked:?}");
    assert!(rect.height() < 20.0 * window.zoom(), "{rect:?}");
    let mut named = window
        .harness
        .query_all_by_label("Reroute")
        .map(|node| node.rect().center());
    assert!(named.any(|at| (at - rect.center()).length() < 1.5), "it has a name");
    let ends = ["input", "output"].map(|side| window.port_at(&reroute, side, "source"));
    let expected = [rect.left_center(), rect.right_center()];
    for (end, expected) in ends.into_iter().zip(expected) {
        // The sensitive area of a port reaches farther outside than inside.
        assert!((end - expected).length() < 5.0, "{end:?} {expected:?}");
    }
}

#[test]
fn a_reroute_is_dragged_selected_and_wired_as_a_node_is() {
    let (mut window, reroute, _) = window_with_reroute();
    let at = window.rect(&reroute).center();
    window.click_at(at);
    assert_eq!(window.document().selected_one(), Some(&reroute));
    let before = window.document().node(&reroute).expect("the reroute").pos;
    window.drag_with(at, beside(at, [0.0, 90.0]), Modifiers::COMMAND);
    let after = window.document().node(&reroute).expect("the reroute").pos;
    assert!(
        (after[1] - before[1] - 90.0 / window.zoom()).abs() < 1.5,
        "{before:?} {after:?}"
    );
    assert_eq!(window.reads(&id("invert"), "source"), reroute.to_string());
    window.wire(&reroute, "source", &id("blur"), "source");
    assert_eq!(window.reads(&id("blur"), "source"), reroute.to_string());
}

#[test]
fn a_wire_is_pulled_from_the_side_of_a_card() {
    let mut window = Window::opened(WIRED);
    let far = window.on_canvas([0.5, 0.5]);
    window.wheel(far, -300.0);
    assert!(window.zoom() < 0.5, "{}", window.zoom());
    let side = window.rect(&id("clouds")).right_center();
    let onto = window.rect(&id("blur")).center();
    window.drag_from(side, onto);
    assert_eq!(window.reads(&id("blur"), "source"), "clouds");
    let side = window.rect(&id("invert")).left_center();
    window.drag_from(side, window.on_canvas([0.9, 0.9]));
    assert_eq!(window.reads(&id("invert"), "source"), "", "one is taken off there too");
    let named = window.harness.get_by_label("Blur, inputs").rect();
    let left = window.rect(&id("blur")).left();
    assert!((named.center().x - left).abs() < 8.0);
}

impl Window {
    /// Rests the pointer until the tooltip is shown.
    pub(super) fn rest_at(&mut self, at: egui::Pos2) {
        self.point(self.on_canvas([0.99, 0.01]));
        self.pause();
        self.point(at);
        self.pause();
        self.pause();
        self.settle();
    }
}

#[test]
fn titles_knobs_cards_and_reroutes_have_tooltips_with_names_and_faults() {
    let (mut window, reroute, _) = window_with_reroute();
    window.until("the fault", |editor| editor.evaluation.faults.of("blur").is_some());
    let fault = window.fault_of("blur");
    let interface = |window: &Window, node: &str| window.document().interface(&id(node)).expect("a node").clone();
    let summary = interface(&window, "invert").summary.clone();
    assert!(!window.says(&summary));
    window.rest_at(window.title(&id("invert")));
    assert!(window.says(&summary), "{summary}");
    let clouds = interface(&window, "clouds");
    let knob = clouds.knobs.iter().find(|knob| knob.label == "Detail").expect("a knob");
    let first = knob.doc.split('`').next().expect("a text").to_owned();
    let near = window.rect(&id("clouds"));
    let found = window.harness.query_all_by_label("Detail");
    let mut found = found.map(|node| node.rect().center());
    let at = found.find(|at| near.contains(*at)).expect("a knob on the node");
    drop(found);
    window.rest_at(at);
    assert!(window.says(&first), "{first}");
    window.rest_at(window.rect(&reroute).center());
    assert!(window.says("A bend in a wire"));
    window.rest_at(window.title(&id("blur")));
    assert!(window.says(&fault), "{fault}");
    let far = window.on_canvas([0.5, 0.5]);
    window.wheel(far, -300.0);
    assert!(!window.says(&fault));
    window.rest_at(window.rect(&id("blur")).center());
    assert!(window.says(&fault), "on a card too");
}

#[test]
fn the_time_of_a_node_is_shown_in_its_title() {
    let mut window = Window::opened(WIRED);
    window.until("a time", |editor| editor.evaluation.results.time("clouds").is_some());
    window.settle();
    let time = window.editor().evaluation.results.time("clouds").expect("a time");
    let title = window
        .rect(&id("clouds"))
        .with_max_y(window.port(&id("clouds"), "mask").y);
    let painted = window.painted();
    let shown = crate::time_text::time_text(time);
    let found = painted.iter().any(|(text, at)| *text == shown && title.contains(*at));
    assert!(found, "'{shown}' in {painted:?}");
}

impl Window {
    /// Painted texts with their places.
    fn painted(&self) -> Vec<(String, egui::Pos2)> {
        let mut shapes: Vec<&egui::Shape> = self.harness.output().shapes.iter().map(|it| &it.shape).collect();
        let mut painted = Vec::new();
        while let Some(shape) = shapes.pop() {
            match shape {
                egui::Shape::Vec(inner) => shapes.extend(inner),
                egui::Shape::Text(text) => painted.push((text.galley.text().to_owned(), text.pos)),
                _ => {}
            }
        }
        painted
    }
}

#[test]
fn a_muted_node_shows_the_picture_of_the_input_that_it_passes_on() {
    let mut window = Window::opened(WIRED);
    let pixels = |window: &Window, node: &str| {
        let editor = window.editor();
        let result = editor.reference(&id(node), None);
        editor.evaluation.results.thumbnail_pixels(&result).cloned()
    };
    window.until("pictures", |editor| {
        ["clouds", "invert"]
            .iter()
            .all(|node| editor.thumbnail_of(&id(node)).is_some())
    });
    assert!(pixels(&window, "clouds") != pixels(&window, "invert"));
    window.click_at(window.title(&id("invert")));
    window.key(egui::Key::M);
    let passed = pixels(&window, "clouds");
    window.until("the picture of the clouds", |editor| {
        let result = editor.reference(&id("invert"), None);
        editor.evaluation.results.thumbnail_pixels(&result).cloned() == passed
    });
}

#[test]
fn the_menu_of_a_wire_offers_only_nodes_that_fit_both_ends() {
    let mut window = Window::opened(WIRED);
    let [one, other] = [window.port(&id("clouds"), "mask"), window.port(&id("invert"), "source")];
    let gap = between(one, other);
    window.click_with(gap, PointerButton::Secondary, Modifiers::NONE);
    assert!(window.says("Nodes that fit the wire"));
    window.typed("material output");
    assert!(
        window.says("No node is called that"),
        "nothing can be read from an output"
    );
    window.keys(Modifiers::COMMAND, egui::Key::A);
    let added = window.pick("levels");
    assert_eq!(window.reads(&added, "source"), "clouds");
    let [right, left] = [window.rect(&added).right(), window.rect(&id("invert")).left()];
    assert!(right < left, "there is room for it: {right} {left}");
    assert_eq!(window.steps(), 1);
    window.undo(1);
    assert_eq!(window.document().node(&id("invert")).expect("a node").pos, [400.0, 0.0]);
}
