//! The window without a pointer.

use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable, by};

use super::Window;
use super::hands::id;
use crate::dock::Panel;

/// Accessible name of the widget that has the keyboard focus.
fn focused(window: &Window) -> String {
    let found = window.harness.query_all(by().predicate(|node| node.is_focused()));
    found
        .filter_map(|node| node.accesskit_node().label())
        .next()
        .unwrap_or_default()
}

#[test]
fn a_graph_is_built_changed_and_undone_by_keys_alone() {
    let mut window = Window::empty();
    window.settle();
    let empty = window.text();
    window.key(Key::Tab);
    let noise = window.pick("clouds");
    window.key(Key::Tab);
    let layer = window.pick("effect layer");
    assert_ne!(
        window.document().node(&noise).expect("a node").pos,
        window.document().node(&layer).expect("a node").pos,
        "no node hides another"
    );
    // From the second input of the layer, the mask, back to the noise.
    window.key(Key::J);
    window.key(Key::J);
    window.key(Key::W);
    window.key(Key::ArrowLeft);
    assert_eq!(window.document().selected_one(), Some(&noise));
    window.key(Key::J);
    window.key(Key::W);
    assert_eq!(window.reads(&layer, "mask"), noise.to_string());
    assert_eq!(window.steps(), 3);
    // A parameter of the noise node.
    while window.editor().shell.keyboard.active != Panel::Parameters {
        window.key(Key::F6);
    }
    let mut names = vec![focused(&window)];
    while names.last().is_some_and(|name| name != "Detail") {
        assert!(names.len() < 20, "no way to the knob: {names:?}");
        window.key(Key::Tab);
        names.push(focused(&window));
    }
    window.key(Key::ArrowLeft);
    assert_eq!(window.param(&noise, "octaves").as_deref(), Some("7"));
    window.typed("3");
    window.key(Key::Enter);
    assert_eq!(window.param(&noise, "octaves").as_deref(), Some("3"));
    let steps = window.steps();
    window.undo(steps);
    assert_eq!(window.text(), empty);
}

#[test]
fn ports_are_stepped_through_both_ways_and_escape_drops_the_wire() {
    let mut window = Window::empty();
    window.key(Key::Tab);
    let noise = window.pick("clouds");
    window.key(Key::Tab);
    let invert = window.pick("invert");
    // The port before the first is the last one: the output.
    window.key(Key::K);
    window.key(Key::W);
    window.key(Key::Escape);
    window.key(Key::J);
    window.key(Key::W);
    window.key(Key::ArrowLeft);
    window.keys(Modifiers::COMMAND, Key::Tab);
    window.key(Key::W);
    assert_eq!(window.reads(&invert, "source"), noise.to_string());
    assert_eq!(window.reads(&noise, "position"), "");
}

#[test]
fn f6_steps_through_the_panels_and_says_which_one_is_active() {
    let mut window = Window::empty();
    window.settle();
    assert_eq!(window.editor().shell.keyboard.active, Panel::Canvas);
    let shown = window.editor().shell.dock.rects.len();
    let mut seen = Vec::new();
    for _ in 0..shown {
        window.key(Key::F6);
        let active = window.editor().shell.keyboard.active;
        assert!(window.says(&format!("Keys are for: {}", active.title())));
        let focused = focused(&window);
        assert_eq!(
            focused,
            if active == Panel::Canvas {
                "Canvas"
            } else {
                active.title()
            }
        );
        seen.push(active);
    }
    assert_eq!(seen.last(), Some(&Panel::Canvas), "once round");
    let mut back = Vec::new();
    for _ in 0..shown {
        window.keys(Modifiers::SHIFT, Key::F6);
        back.push(window.editor().shell.keyboard.active);
    }
    seen.rotate_right(1);
    back.reverse();
    assert_eq!(
        back.last(),
        seen.get(1).or(seen.last()).filter(|_| shown < 2).or(back.last())
    );
    seen.sort_unstable();
    back.sort_unstable();
    assert_eq!(seen, back);
}

#[test]
fn tab_opens_the_menu_only_while_keys_are_for_the_canvas() {
    let mut window = Window::empty();
    window.settle();
    window.key(Key::F6);
    window.key(Key::Tab);
    assert!(!window.says("Find a node"));
    window.keys(Modifiers::SHIFT, Key::F6);
    window.key(Key::Tab);
    assert!(window.says("Find a node"));
    assert_eq!(
        window
            .harness
            .get_by_label("Find a node")
            .accesskit_node()
            .label()
            .as_deref(),
        Some("Find a node")
    );
}

#[test]
fn the_arrow_keys_move_through_the_menu() {
    let mut window = Window::empty();
    window.settle();
    window.key(Key::Tab);
    window.typed("noise");
    window.key(Key::ArrowDown);
    window.key(Key::ArrowDown);
    window.key(Key::ArrowUp);
    window.key(Key::Enter);
    let second = window.document().selected_one().cloned().expect("a node");
    window.key(Key::Tab);
    let first = window.pick("noise");
    let kind = |id| window.document().node(id).expect("a node").kind.clone();
    assert_ne!(kind(&first), kind(&second));
}

#[test]
fn the_menu_is_as_tall_for_a_few_nodes_as_for_all_and_its_field_stays_in_place() {
    let mut window = Window::empty();
    // Near the lower end of the window, where a menu of another height would move.
    window.point(window.on_canvas([0.5, 0.95]));
    let places = |window: &Window| {
        let rect = window.harness.ctx.memory(|memory| memory.area_rect("add_menu"));
        let field = window.harness.get_by_label("Find a node").rect().min;
        (rect.expect("the menu"), field)
    };
    window.settle();
    window.key(Key::Tab);
    let at_first = places(&window);
    assert!(at_first.0.height() > 300.0);
    window.typed("xyzzy");
    assert_eq!(places(&window), at_first);
    for _ in 0.."xyzzy".len() {
        window.key(Key::Backspace);
    }
    assert_eq!(places(&window), at_first);
    window.typed("xyzzy");
    window.key(Key::Escape);
    window.key(Key::Tab);
    assert_eq!(places(&window), at_first);
}

#[test]
fn keys_typed_into_a_field_run_no_commands() {
    let mut window = Window::opened(r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#);
    window.click_at(window.title(&id("clouds")));
    let field = window.harness.get_by_label("Search the library").rect().center();
    window.click_at(field);
    // The pointer is over the canvas again, and the field still has the keyboard.
    window.point(window.on_canvas([0.5, 0.5]));
    for key in [Key::Delete, Key::M, Key::L, Key::X, Key::Space, Key::Backspace] {
        window.key(key);
    }
    assert_eq!(window.steps(), 0);
    assert_eq!(window.document().graph().len(), 1);
    assert!(!window.says("Find a node"));
}

#[test]
fn keys_act_on_the_panel_under_the_pointer_even_after_a_knob_was_turned() {
    let mut window =
        Window::opened(r#""clouds": { "kind": "noise/simplex", "params": { "size": 0.5 }, "pos": [0, 0] }"#);
    window.click_at(window.title(&id("clouds")));
    window.click_at(window.knob("Size"));
    window.point(window.on_canvas([0.8, 0.8]));
    window.key(Key::Delete);
    assert_eq!(
        window.document().graph().len(),
        0,
        "the node is deleted, and not its knob reset"
    );
}

/// A window in which a second mask was wired by keys to an input that has one.
fn asked_about_masks() -> Window {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
        "dots": { "kind": "noise/dots", "pos": [0, 330] },
        "invert": { "kind": "adjust/invert", "inputs": { "source": "clouds" }, "pos": [300, 0] }
        "#,
    );
    window.harness.state_mut().documents.document.select([id("dots")]);
    window.key(Key::K);
    window.key(Key::W);
    window.harness.state_mut().documents.document.select([id("invert")]);
    window.key(Key::J);
    window.key(Key::W);
    assert!(window.says("The input has a mask already. Combine both by:"));
    assert_eq!(focused(&window), "Multiply");
    window
}

#[test]
fn the_question_about_a_second_mask_is_answered_by_keys_alone() {
    let mode = |window: &mut Window| {
        assert!(!window.says("The input has a mask already. Combine both by:"));
        assert_eq!(focused(window), "Canvas", "keys are for the canvas again");
        let blend = window.document().selected_one().expect("the blend").clone();
        window.param(&blend, "mode")
    };
    let mut window = asked_about_masks();
    window.key(Key::Enter);
    assert_eq!(mode(&mut window).as_deref(), Some("\"multiply\""));
    let mut window = asked_about_masks();
    for key in [
        Key::ArrowUp,
        Key::ArrowDown,
        Key::ArrowDown,
        Key::ArrowDown,
        Key::ArrowUp,
    ] {
        window.key(key);
    }
    assert_eq!(focused(&window), "Max");
    window.key(Key::Enter);
    assert_eq!(mode(&mut window).as_deref(), Some("\"max\""));
    let mut window = asked_about_masks();
    window.key(Key::Num4);
    assert_eq!(mode(&mut window).as_deref(), Some("\"subtract\""));
    let mut window = asked_about_masks();
    window.key(Key::Escape);
    assert!(!window.says("The input has a mask already. Combine both by:"));
    assert_eq!(window.reads(&id("invert"), "source"), "clouds");
    assert_eq!(focused(&window), "Canvas");
    window.key(Key::M);
    assert!(window.document().node(&id("invert")).expect("a node").muted);
}

#[test]
fn arrows_step_through_ports_follow_wires_and_leave_no_focus_behind() {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
        "dots": { "kind": "noise/dots", "pos": [0, 330] },
        "mix": { "kind": "blend/mask", "inputs": { "above": "dots" }, "pos": [300, 100] }
        "#,
    );
    let port = |window: &Window| {
        let place = window.editor().views.canvas.focused_port();
        place.unwrap_or_default()
    };
    let selected = |window: &Window| window.document().selected_one().expect("a node").to_string();
    window.harness.state_mut().documents.document.select([id("mix")]);
    window.settle();
    window.key(Key::J);
    let first = port(&window);
    window.key(Key::ArrowDown);
    let second = port(&window);
    assert!(first != second && second.starts_with("mix."), "{first} {second}");
    window.key(Key::ArrowUp);
    assert_eq!(port(&window), first);
    while port(&window) != "mix.above" {
        window.key(Key::ArrowDown);
    }
    window.key(Key::ArrowLeft);
    assert_eq!(
        (selected(&window), port(&window)),
        ("dots".to_owned(), "dots.mask".to_owned())
    );
    window.key(Key::ArrowRight);
    assert_eq!(
        (selected(&window), port(&window)),
        ("mix".to_owned(), "mix.above".to_owned())
    );
    window.key(Key::ArrowRight);
    assert_eq!(port(&window), "mix.mask", "the other side of the node");
    window.key(Key::ArrowLeft);
    assert_eq!(port(&window), first);
    while port(&window) != "mix.below" {
        window.key(Key::ArrowDown);
    }
    window.key(Key::ArrowLeft);
    assert_eq!((selected(&window), port(&window)), ("clouds".to_owned(), String::new()));
    window.key(Key::W);
    window.key(Key::ArrowDown);
    assert_eq!(selected(&window), "dots", "between nodes, since no port has the focus");
}

/// Events of keys and their texts that all arrive while one frame is drawn.
fn in_one_frame(window: &mut Window, keys: &[(Key, &str)]) {
    let events = keys.iter().flat_map(|&(key, text)| {
        let event = |pressed| Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        let text = (!text.is_empty()).then(|| Event::Text(text.to_owned()));
        [Some(event(true)), text, Some(event(false))].into_iter().flatten()
    });
    window.harness.input_mut().events.extend(events);
    window.settle();
}

#[test]
fn text_typed_before_the_node_menu_is_drawn_goes_into_its_search() {
    let mut window = Window::empty();
    window.settle();
    // L and V are keys of commands, too.
    let word = [
        (Key::L, "l"),
        (Key::E, "e"),
        (Key::V, "v"),
        (Key::E, "e"),
        (Key::L, "l"),
        (Key::Enter, ""),
    ];
    in_one_frame(&mut window, &[&[(Key::Space, " ")], &word[..]].concat());
    window.settle();
    let kinds = |window: &Window| {
        let nodes = window.document().graph().nodes();
        nodes.map(|(_, node)| node.kind.clone()).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&window), ["adjust/levels"]);
    // Also where one menu is closed and the next one opened within a frame.
    in_one_frame(
        &mut window,
        &[&[(Key::Tab, "")], &word[..], &[(Key::Tab, "")], &word[..]].concat(),
    );
    for _ in 0..4 {
        window.settle();
    }
    assert_eq!(kinds(&window), ["adjust/levels"; 3]);
}

#[test]
fn escape_in_the_frame_of_the_key_that_opens_a_name_closes_it_again() {
    let mut window = Window::opened(r#""n": { "kind": "noise/simplex" }"#);
    window.settle();
    window.harness.state_mut().documents.document.select([id("n")]);
    in_one_frame(&mut window, &[(Key::F2, ""), (Key::X, "x"), (Key::Escape, "")]);
    for _ in 0..4 {
        window.settle();
    }
    assert!(!window.editor().views.canvas.holds_keys());
    assert_eq!(window.document().title(&id("n")), "Clouds");
}

#[test]
fn tab_over_the_canvas_opens_its_menu_while_a_field_elsewhere_has_the_focus() {
    let mut window = Window::empty();
    window.open(Panel::Library);
    let field = window.area("Search the library").center();
    window.click_at(field);
    window.point(window.on_canvas([0.5, 0.5]));
    window.harness.key_press(Key::Tab);
    for letter in ["f", "l", "o", "o", "d", " ", "f", "i", "l", "l"] {
        if letter == " " {
            window.harness.key_press(Key::Space);
        }
        window.harness.event(egui::Event::Text(letter.to_owned()));
    }
    window.settle();
    window.settle();
    assert!(window.document().graph().is_empty(), "typing adds nothing");
    window.key(Key::Enter);
    let added = window.document().selected_one().expect("a node").clone();
    assert_eq!(window.document().title(&added), "Parts");
}
