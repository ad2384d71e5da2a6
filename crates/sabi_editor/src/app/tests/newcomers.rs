//! First steps of a new user.

use std::fs;

use egui::accesskit::{Role, Toggled};
use egui::{Key, Modifiers, PointerButton, Rect, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use sabi_editing::stack;
use sabi_engine::live::ViewSubject;
use sabi_paint::Action as BrushAction;

use super::Window;
use super::hands::id;
use crate::dock::{Panel, Workspace};
use crate::files::new_graph;
use crate::theme::type_size;

/// A new graph, as the window begins with it.
fn new_graph() -> Window {
    let mut window = Window::with(|folders| new_graph::session(folders.recovery.as_deref()).expect("a graph"));
    window.until_model();
    window
}

impl Window {
    /// Part of the canvas that is seen, on the screen.
    fn canvas(&self) -> Rect {
        self.editor().shell.dock.rects[&Panel::Canvas]
    }

    /// Rectangle of a visible entry of the library.
    pub(super) fn listed_entry(&self, name: &str) -> Rect {
        let library = self.editor().shell.dock.rects[&Panel::Library];
        let mut entries = self.harness.query_all_by_label(name).map(|node| node.rect());
        let entry = entries.find(|rect| library.contains(rect.center()));
        entry.unwrap_or_else(|| panic!("'{name}' is not in the library, or scrolled out of it"))
    }

    fn titles(&self) -> Vec<String> {
        let stacks = stack::all(self.document());
        stacks[0].layers.iter().map(|layer| layer.title.clone()).collect()
    }
}

#[test]
fn a_new_graph_shows_the_model_and_says_what_to_do_until_something_is_done() {
    let mut window = new_graph();
    assert!(window.says("Drag an effect from the Library onto the model."));
    assert!(window.says("Tab or a right-click adds a node here."));
    assert_eq!(window.editor().problem_count(), 0);
    window.add([0.2, 0.2], "clouds");
    assert!(!window.says("Drag an effect from the Library onto the model."));
}

#[test]
fn nodes_of_the_first_drop_on_the_model_are_fully_in_view_on_the_canvas() {
    let mut window = Window::untitled();
    window.until_model();
    window.open(Panel::Library);
    window.fill("Search the library", "effect layer");
    let entry = window.listed_entry("Layer").center();
    let model = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.drag(entry, model, PointerButton::Primary, Modifiers::NONE);
    let nodes: Vec<_> = window.document().graph().ids().cloned().collect();
    assert_eq!(nodes.len(), 3, "a layer, the model's own material and an output");
    for node in nodes {
        assert!(window.canvas().contains_rect(window.rect(&node)), "{node}");
    }
}

#[test]
fn a_layer_that_is_added_outside_of_the_view_is_brought_into_it() {
    let mut window = new_graph();
    let corner = window.on_canvas([0.5, 0.5]);
    window.drag(
        corner,
        corner + vec2(3000.0, 0.0),
        PointerButton::Middle,
        Modifiers::NONE,
    );
    let model = id("model");
    assert!(!window.canvas().contains(window.rect(&model).center()));
    window.open(Panel::Stack);
    window.click("Fill layer");
    let layer = window.document().selected_one().expect("the layer").clone();
    assert!(window.canvas().contains_rect(window.rect(&layer)));
}

#[test]
fn the_names_of_a_groups_inputs_are_not_cut_off_when_it_is_entered() {
    // The nodes are so near that they are drawn with their ports and names rather than as cards.
    let name = "where_the_old_paint_of_the_boards_is_gone";
    let text = r#"{ "format": "sabi", "version": 1,
        "groups": { "Wear": { "inputs": { "NAME": { "to": ["a.source"] } }, "outputs": { "mask": "b" }, "nodes": {
            "a": { "kind": "adjust/levels", "pos": [0, 0] },
            "b": { "kind": "adjust/invert", "inputs": { "source": "a" }, "pos": [300, 0] } } } },
        "nodes": { "g": { "kind": "graph/group", "group": "Wear" } } }"#;
    let mut window = Window::of(&text.replace("NAME", name));
    window.double_click(window.title(&id("g")));
    assert_eq!(window.document().graph().len(), 2, "the group is shown");
    let font = egui::FontId::proportional(type_size::SMALL * window.zoom());
    let text = window
        .harness
        .ctx
        .fonts_mut(|fonts| fonts.layout_no_wrap(name.to_owned(), font, egui::Color32::WHITE));
    let port = window.port(&id("a"), "source");
    assert!(window.canvas().left() <= port.x - 31.0 * window.zoom() - text.size().x);
}

#[test]
fn the_place_of_a_drop_is_marked_and_named_while_it_is_dragged() {
    let mut window = new_graph();
    window.open(Panel::Library);
    window.fill("Search the library", "effect layer");
    let entry = window.listed_entry("Layer").center();
    let model = window.editor().shell.dock.rects[&Panel::Viewport].center();
    window.pull(&[entry, model], PointerButton::Primary, Modifiers::NONE);
    assert!(window.says("Layer on Material output"));
    window.button(model, PointerButton::Primary, false);
    window.settle();
    assert!(!window.says("Layer on Material output"));
    assert_eq!(window.titles(), ["Layer", "Model"]);
}

#[test]
fn a_file_held_over_the_window_has_a_caption_that_says_what_a_drop_does() {
    let mut window = new_graph();
    for (name, words) in [
        ("worn.sabi", "Drop worn.sabi to open it"),
        ("statue.glb", "Drop statue.glb to show the graph on it"),
        ("rust.png", "Drop rust.png to add it as an image"),
    ] {
        window.harness.input_mut().hovered_files = vec![egui::HoveredFile {
            path: Some(window.path(name)),
            ..egui::HoveredFile::default()
        }];
        window.harness.step();
        assert!(window.says(words), "{name}");
    }
    window.harness.input_mut().hovered_files.clear();
    window.settle();
    assert!(!window.says("Drop rust.png"));
}

#[test]
fn a_search_begins_with_its_best_match_wherever_the_list_was_scrolled_to() {
    let mut window = new_graph();
    window.open(Panel::Library);
    let library = window.editor().shell.dock.rects[&Panel::Library];
    window.wheel(library.center(), -2000.0);
    window.fill("Search the library", "flood fill");
    assert!(library.contains_rect(window.listed_entry("Parts")));
}

#[test]
fn a_paint_layer_is_one_click_from_the_layers_and_is_painted_at_once() {
    let mut window = new_graph();
    window.open(Panel::Stack);
    window.press("Paint layer");
    assert_eq!(window.titles(), ["Paint layer", "Model"]);
    assert!(window.editor().looks.is_painting);
    assert!(
        window.editor().shell.dock.is_shown(Panel::Parameters),
        "the brush is at hand"
    );
    assert!(window.says("Painting on Paint layer."));
    assert_eq!(
        window.editor().seen(),
        ViewSubject::Outputs,
        "the material is painted on"
    );
    window.until("rest", |editor| !editor.evaluation.is_busy());
    window.paint(Modifiers::NONE);
    let paint = window.document().selected_one().expect("the paint node").clone();
    assert_eq!(window.list(paint.as_str()).expect("strokes").strokes.len(), 1);
    assert_eq!(window.editor().seen(), ViewSubject::Outputs);
    window.key(Key::B);
    assert!(!window.editor().looks.is_painting);
    assert_eq!(
        window.editor().seen(),
        ViewSubject::Outputs,
        "what was shown while painting stays"
    );
    // A second layer is added, and painted on instead. The row of the first layer has the same name as the button.
    window.open(Panel::Stack);
    let panel = window.editor().shell.dock.rects[&Panel::Stack];
    let named = window.harness.get_all_by_role_and_label(Role::Button, "Paint layer");
    let mut buttons = named
        .map(|node| node.rect())
        .filter(|rect| panel.contains_rect(*rect) && rect.height() < 40.0);
    let button = buttons.next().expect("the button").center();
    drop(buttons);
    window.click_at(button);
    assert!(window.editor().looks.is_painting);
    assert_eq!(window.titles(), ["Paint layer", "Paint layer", "Model"]);
}

#[test]
fn a_mask_that_is_white_is_painted_with_black() {
    let mut window = new_graph();
    window.open(Panel::Stack);
    window.click("Fill layer");
    let layer = window.document().selected_one().expect("the layer").clone();
    for (entry, value) in [("White, to paint", 0.0), ("Black, to paint", 1.0)] {
        let panel = window.editor().shell.dock.rects[&Panel::Stack];
        let rows = window.harness.query_all_by_label("Fill layer").map(|node| node.rect());
        let mut rows = rows.filter(|rect| panel.contains(rect.center()) && rect.height() > 40.0);
        let row = rows.next().expect("the row").left_center() + vec2(50.0, 0.0);
        drop(rows);
        window.click_with(row, PointerButton::Secondary, Modifiers::NONE);
        let mask = window.harness.get_all_by_label_contains("Mask");
        let mask = mask.min_by_key(|node| node.accesskit_node().label().map_or(99, |label| label.len()));
        let mask = mask.expect("an entry").rect().center();
        window.click_at(mask);
        window.click(entry);
        assert!(window.editor().looks.is_painting, "{entry}");
        assert_eq!(window.editor().shell.settings.brush.value, value, "{entry}");
        assert!(window.says("Painting on the mask of Fill layer."), "{entry}");
        window.open(Panel::Stack);
        let mask = window.harness.get_by_label("Mask of Fill layer");
        assert_eq!(mask.accesskit_node().toggled(), Some(Toggled::True), "{entry}");
        let mask = window.reads(&layer, "mask");
        let empty = window.param(&id(&mask), "empty").unwrap_or_else(|| "0".to_owned());
        assert_eq!(empty, format!("{}", 1.0 - value), "{entry}");
        window.key(Key::B);
    }
}

#[test]
fn a_new_layer_is_painted_even_if_the_brush_erased_before() {
    let mut window = new_graph();
    window.harness.state_mut().shell.settings.brush.action = BrushAction::Erase;
    window.open(Panel::Stack);
    window.press("Paint layer");
    assert_eq!(window.editor().shell.settings.brush.action, BrushAction::Paint);
    window.until("rest", |editor| !editor.evaluation.is_busy());
    window.paint(Modifiers::NONE);
    let paint = window.document().selected_one().expect("the paint node").clone();
    let list = window.list(paint.as_str()).expect("strokes");
    assert_eq!(list.strokes[0].action, BrushAction::Paint);
    // On a node that has strokes, an eraser stays an eraser.
    window.harness.state_mut().shell.settings.brush.action = BrushAction::Erase;
    window.key(Key::B);
    window.key(Key::B);
    assert_eq!(window.editor().shell.settings.brush.action, BrushAction::Erase);
}

#[test]
fn layers_that_are_added_beside_the_canvas_stay_in_view() {
    let mut window = new_graph();
    for layer in ["Fill layer", "Paint layer", "Fill layer"] {
        window.open(Panel::Stack);
        let panel = window.editor().shell.dock.rects[&Panel::Stack];
        let named = window.harness.get_all_by_role_and_label(Role::Button, layer);
        let mut buttons = named.map(|node| node.rect()).filter(|rect| panel.contains_rect(*rect));
        let button = buttons.next().expect("the button").center();
        drop(buttons);
        window.click_at(button);
        let canvas = window.editor().shell.dock.rects[&Panel::Canvas];
        for id in window.document().graph().ids() {
            let rect = window.rect(id);
            assert!(canvas.contains_rect(rect), "{id} after {layer}: {rect} in {canvas}");
        }
    }
}

#[test]
fn a_new_paint_node_leaves_the_material_on_the_model_until_there_is_paint() {
    let mut window = new_graph();
    let paint = window.add([0.2, 0.8], "source paint");
    assert_eq!(window.document().node(&paint).expect("a node").kind, "source/paint");
    assert_eq!(window.editor().seen(), ViewSubject::Outputs);
    window.until("rest", |editor| !editor.evaluation.is_busy());
    window.key(Key::B);
    window.paint(Modifiers::NONE);
    assert_eq!(
        window.editor().seen(),
        ViewSubject::Node(window.editor().chosen(&paint))
    );
}

#[test]
fn a_new_image_asks_for_its_file_and_is_no_problem_without_one() {
    let mut window = new_graph();
    let image = window.add([0.2, 0.8], "bitmap");
    assert_eq!(window.document().node(&image).expect("a node").kind, "source/image");
    assert!(window.says("Choose an image"));
    window.key(Key::Escape);
    window.until("the faults", |editor| {
        editor.evaluation.faults.waits(image.as_str()).is_some()
    });
    assert_eq!(
        window
            .editor()
            .evaluation
            .faults
            .waits(image.as_str())
            .expect("a sentence"),
        "Choose a picture."
    );
    assert_eq!(window.editor().problem_count(), 0);
    assert_eq!(window.editor().evaluation.faults.of(image.as_str()), None);
}

#[test]
fn levels_show_the_histogram_of_their_input() {
    let mut window = Window::opened(
        r#""n": { "kind": "noise/simplex" }, "l": { "kind": "adjust/levels", "inputs": { "source": "n" }, "params": { "black": 0.4 }, "pos": [300, 0] }"#,
    );
    // The histogram does not depend on what the 2D view showed before.
    window.click_at(window.title(&id("n")));
    window.until_inspected("n");
    assert!(!window.has("Histogram of the input"));
    window.click_at(window.title(&id("l")));
    window.until("the histogram", |editor| editor.views.parameters.has_histogram());
    let measured = window.editor().evaluation.results.measured.as_ref().expect("values");
    assert_eq!(measured.0.node, "n");
    let rect = window.harness.get_by_label("Histogram of the input").rect();
    let steps = window.steps();
    let [from, to] = [0.4, 0.55].map(|value| {
        let of_input = window.editor().views.parameters.place_in_histogram(value, rect);
        egui::pos2(of_input.expect("in the range"), rect.center().y)
    });
    window.drag_from(from, to);
    let black = window.document().node(&id("l")).expect("a node").params.get("black");
    let black = black.and_then(|value| value.as_number()).expect("a number");
    assert!((black - 0.55).abs() < 0.02, "{black}");
    assert_eq!(window.steps(), steps + 1, "one step to undo");
    window.until_inspected("l");
    window.click_at(window.title(&id("n")));
    window.until_inspected("n");
    assert!(!window.has("Histogram of the input"));
}

#[test]
fn nodes_that_are_added_by_a_key_cover_no_other() {
    let mut window = new_graph();
    window.harness.state_mut().shell.settings.favorites = vec!["noise/cells".to_owned()];
    window.point(window.on_canvas([0.3, 0.9]));
    for _ in 0..3 {
        window.key(Key::Num1);
    }
    window.add([0.3, 0.9], "clouds");
    let nodes: Vec<_> = window.document().graph().ids().cloned().collect();
    assert_eq!(nodes.len(), 6);
    for (at, one) in nodes.iter().enumerate() {
        for other in &nodes[at + 1..] {
            let [first, second] = [one, other].map(|node| window.rect(node));
            assert!(!first.shrink(1.0).intersects(second.shrink(1.0)), "{one} and {other}");
        }
    }
}

#[test]
fn a_slider_on_a_node_is_exposed_by_its_own_menu() {
    let mut window = Window::opened(r#""n": { "kind": "noise/simplex", "pos": [0, 0] }"#);
    window.settle();
    let node = window.rect(&id("n"));
    let bars = window.harness.query_all_by_label("Size").map(|bar| bar.rect().center());
    let bar = bars
        .into_iter()
        .find(|at| node.contains(*at))
        .expect("a bar on the node");
    window.click_with(bar, PointerButton::Secondary, Modifiers::NONE);
    assert!(!window.says("Replace with…"), "the menu of the node stays away");
    window.click("Expose parameter");
    assert!(window.document().graph().exposed().iter().next().is_some());
    window.click_with(bar, PointerButton::Secondary, Modifiers::NONE);
    window.click("Stop exposing");
    assert!(window.document().graph().exposed().iter().next().is_none());
}

#[test]
fn the_start_page_can_open_an_example_with_only_the_model_and_its_parameters() {
    let mut window = new_graph();
    window.harness.state_mut().views.start.is_open = true;
    window.settle();
    let switch = window
        .harness
        .get_by_role_and_label(Role::CheckBox, "Model and parameters only");
    switch.click();
    window.settle();
    window.press("Worn oak");
    assert!(window.editor().is_use_view());
    assert!(
        window
            .document()
            .session
            .file()
            .is_some_and(|file| file.ends_with("worn-oak.sabi"))
    );
}

#[test]
fn enter_takes_the_only_file_that_matches() {
    let mut window = new_graph();
    for name in ["rusty barrel.sabi", "mossy wall.sabi"] {
        fs::write(window.path(name), super::graph_text("")).expect("a graph");
    }
    let start = window.path("mossy wall.sabi");
    window.harness.state_mut().open_file(&start);
    window.keys(Modifiers::COMMAND, Key::O);
    window.typed("barrel");
    window.key(Key::Enter);
    assert_eq!(
        window.document().session.file(),
        Some(&*window.path("rusty barrel.sabi"))
    );
}

#[test]
fn every_workspace_is_one_entry_of_the_menu() {
    let mut window = new_graph();
    for (workspace, title) in Workspace::ALL {
        window.press("Window");
        let menu = window.harness.get_by_label_contains("Workspace").rect().center();
        window.click_at(menu);
        let library = window.editor().shell.dock.rects.get(&Panel::Library).copied();
        let is_beside = |rect: &Rect| !library.is_some_and(|library| library.contains(rect.center()));
        let entries = window
            .harness
            .get_all_by_role_and_label(Role::Button, title)
            .map(|node| node.rect());
        let entry = entries.into_iter().find(is_beside).expect("an entry").center();
        window.click_at(entry);
        let dock = &window.editor().shell.dock;
        let is_shown = |panel| dock.is_shown(panel);
        let seen = [Panel::Viewport, Panel::Flat, Panel::Canvas].map(is_shown);
        let expected = match workspace {
            Workspace::Material => [true, false, true],
            Workspace::Texture => [true, true, true],
            Workspace::Paint => [true, true, false],
            Workspace::Look => [true, false, false],
        };
        assert_eq!(seen, expected, "{title}");
        assert!(is_shown(Panel::Parameters), "{title}");
    }
}

#[test]
fn textures_are_exported_beside_the_graph_unless_another_folder_is_chosen() {
    let mut window = Window::opened("");
    assert_eq!(window.editor().exports.place.folder, "graph-textures");
    window.harness.state_mut().exports.place.folder = "maps".to_owned();
    let file = window.path("graph.sabi");
    window.harness.state_mut().open_file(&file);
    assert_eq!(window.editor().exports.place.folder, "maps");
    let mut window = new_graph();
    assert_eq!(window.editor().exports.place.folder, "", "there is no place yet");
    window.keys(Modifiers::COMMAND, Key::S);
    let file = window.path("worn.sabi");
    window.answer_path(&file);
    assert_eq!(window.editor().exports.place.folder, "worn-textures");
}

#[test]
fn the_history_names_added_nodes() {
    let mut window = new_graph();
    window.add([0.2, 0.8], "clouds");
    window.open(Panel::Stack);
    window.click("Fill layer");
    let names: Vec<&str> = window.document().session.undo_names().collect();
    assert_eq!(names, ["Add Clouds", "Add Fill layer"]);
}

#[test]
fn the_history_names_both_ends_of_a_new_wire() {
    let mut window = Window::opened(
        r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }, "levels": { "kind": "adjust/levels", "pos": [300, 0] }"#,
    );
    let out = window.port(&id("clouds"), "mask");
    let into = window.port(&id("levels"), "source");
    window.pull(&[out, into], PointerButton::Primary, Modifiers::NONE);
    window.button(into, PointerButton::Primary, false);
    window.settle();
    let names: Vec<&str> = window.document().session.undo_names().collect();
    assert_eq!(names, ["Connect Clouds to Levels"]);
}
