use super::*;

fn changed() -> Board {
    let mut opacity = knob("blend/mask.opacity");
    opacity.value = Some(Value::Number(0.5));
    board([opacity])
}

fn open_menu(board: &mut Board, name: &str) {
    board.get_by_label(name).click_secondary();
    board.run();
}

#[test]
fn only_changed_values_have_a_dot_which_resets_them() {
    let mut board = changed();
    click(&mut board, "Reset Opacity");
    let knob = "opacity".to_owned();
    assert_eq!(taken(&mut board), [KnobEvent::Reset { knob }]);
    assert!(board.query_by_label("Reset Opacity").is_none());
    board.state_mut().rows[0].value = Some(Value::Number(1.0));
    board.run();
    assert!(
        board.query_by_label("Reset Opacity").is_none(),
        "what is set to the default is the default"
    );
}

#[test]
fn a_changed_seed_has_no_dot_that_resets_it() {
    let mut seed = knob("noise/simplex.seed");
    seed.value = Some(Value::Number(77.0));
    let board = board([seed]);
    assert!(board.query_by_label("Reset Seed").is_none());
}

#[test]
fn the_menu_resets_exposes_and_unexposes_a_parameter() {
    let mut board = changed();
    open_menu(&mut board, "Opacity");
    click(&mut board, "Expose parameter");
    board.state_mut().rows[0].exposed = Some("amount");
    open_menu(&mut board, "Opacity");
    assert!(board.query_by_label("Expose parameter").is_none());
    click(&mut board, "Stop exposing");
    open_menu(&mut board, "Opacity");
    click(&mut board, "Reset");
    let knob = || "opacity".to_owned();
    let expected = [
        KnobEvent::Expose { knob: knob() },
        KnobEvent::Unexpose { knob: knob() },
        KnobEvent::Reset { knob: knob() },
    ];
    assert_eq!(taken(&mut board), expected);
}

#[test]
fn the_menu_links_a_mask_and_removes_it_and_the_number_can_be_set_all_the_time() {
    let mut board = changed();
    open_menu(&mut board, "Opacity");
    assert!(board.query_by_label("Multiply by a mask…").is_none());
    key(&mut board, Key::Escape);
    board.state_mut().rows[0].mask = ParamMask::Unlinked;
    open_menu(&mut board, "Opacity");
    click(&mut board, "Multiply by a mask…");
    open_menu(&mut board, "Opacity");
    click(&mut board, "Expose its mask as an input");
    board.state_mut().rows[0].mask = ParamMask::Of("Clouds");
    board.run();
    assert!(says(&board, "× mask of Clouds"));
    type_into(&mut board, "Opacity", "0.25");
    open_menu(&mut board, "Opacity");
    assert!(board.query_by_label("Multiply by a mask…").is_none());
    click(&mut board, "Remove the mask");
    let knob = || "opacity".to_owned();
    let expected = [
        KnobEvent::AddMask { knob: knob() },
        KnobEvent::ExposeMask { knob: knob() },
        set("opacity", Value::Number(0.25)),
        KnobEvent::RemoveMask { knob: knob() },
    ];
    assert_eq!(taken(&mut board), expected);
}

#[test]
fn the_menu_opens_by_keyboard_too() {
    let mut board = changed();
    focus(&mut board, "Opacity");
    board.key_press_modifiers(Modifiers::SHIFT, Key::F10);
    board.run();
    assert!(board.query_by_label("Expose parameter").is_some());
    key(&mut board, Key::Escape);
    assert!(board.query_by_label("Expose parameter").is_none());
}

#[test]
fn a_value_is_copied_as_a_file_would_have_it() {
    let mut board = board([knob("effect/layer.color")]);
    open_menu(&mut board, "Color");
    board.get_by_label("Copy value").click();
    board.step();
    let copied = board
        .output()
        .platform_output
        .commands
        .iter()
        .find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
    assert_eq!(copied.as_deref(), Some("\"#808080\""));
}

/// Chooses to paste in the menu, while the clipboard holds `text`.
fn paste(board: &mut Board, name: &str, text: &str) {
    open_menu(board, name);
    board.get_by_label("Paste value").click();
    board.step();
    board.event(Event::Paste(text.to_owned()));
    board.run();
}

#[test]
fn a_value_that_fits_can_be_pasted_and_another_one_is_reported() {
    let mut board = board([knob("effect/layer.color"), knob("blend/mask.opacity")]);
    for text in ["\"#102030\"", " #102030\n"] {
        board.state_mut().rows[0].value = None;
        paste(&mut board, "Color", text);
        assert_eq!(taken(&mut board), [set("color", "#102030")], "{text}");
    }
    for text in ["0.5", "[", "blue", ""] {
        paste(&mut board, "Color", text);
        assert_eq!(taken(&mut board), [], "{text}");
        assert!(says(&board, "but Color takes a color"), "{text}");
    }
    paste(&mut board, "Opacity", "7");
    assert_eq!(taken(&mut board), []);
    assert!(says(&board, "but Opacity takes a number from 0 to 1"));
}

#[test]
fn a_paste_that_arrives_late_is_not_taken_by_the_knob() {
    let mut board = board([knob("blend/mask.opacity")]);
    open_menu(&mut board, "Opacity");
    click(&mut board, "Paste value");
    board.run_steps(5);
    board.event(Event::Paste("0.5".to_owned()));
    board.run();
    assert_eq!(taken(&mut board), []);
}

#[test]
fn a_wired_input_says_where_its_value_comes_from() {
    let mut wired = knob("blend/mask.below");
    wired.wired = Some("Edges");
    let board = board([wired]);
    assert_eq!(board.get_by_label("Below").value().as_deref(), Some("from Edges"));
}

#[test]
fn nodes_that_differ_show_no_value_and_take_one_together() {
    let mut differing = knob("blend/mask.opacity");
    differing.value = Some(Value::Number(0.5));
    differing.differs = true;
    let mut board = board([differing]);
    assert_eq!(board.get_by_label("Opacity").value().as_deref(), Some("mixed"));
    type_into(&mut board, "Opacity", "*=2");
    assert_eq!(taken(&mut board), []);
    assert!(says(&board, "The selected nodes differ here"));
    key(&mut board, Key::Escape);
    type_into(&mut board, "Opacity", "0.5");
    assert_eq!(
        taken(&mut board),
        [set("opacity", 0.5)],
        "also where one of them has it"
    );
}

#[test]
fn an_unreadable_value_is_reported_and_can_be_set_again() {
    for (name, label, value) in [
        ("blend/mask.opacity", "Opacity", "\"much\""),
        ("noise/simplex.octaves", "Detail", "2.5"),
        ("noise/simplex.stretch", "Stretch X", "[1, 1]"),
        ("noise/simplex.mode", "Mode", "\"spiral\""),
        ("effect/layer.color", "Color", "\"red\""),
        ("effect/layer.color_on", "Color on", "1"),
        ("color/gradient.stops", "Stops", "[[2, \"#000000\"]]"),
        ("adjust/curve.points", "Points", "[]"),
        ("output/mask.name", "Name", "null"),
    ] {
        let mut broken = knob(name);
        broken.value = Some(json(value));
        let board = board([broken]);
        assert!(says(&board, &format!("This holds {value}, but takes ")), "{name}");
        assert!(board.query_by_label(label).is_some(), "{name}");
    }
}

#[test]
fn pointing_at_a_name_shows_the_doc_of_its_parameter() {
    let mut board = changed();
    board.state_mut().rows[0].knob.doc = "How much of `above` is seen.".to_owned();
    let bar = board.get_by_label("Opacity").rect();
    board.hover_at(Pos2::new(40.0, bar.center().y));
    board.run_steps(60);
    assert!(says(&board, "How much of above is seen."));
    assert!(says(&board, "opacity, 0 to 1, default 1"));
}

#[test]
fn every_knob_of_every_kind_is_shown_under_its_name() {
    for entry in CATALOG.entries().filter(|entry| !entry.knobs.is_empty()) {
        let rows = entry.knobs.iter().map(shown);
        let board = board_of(rows, ColorScheme::Light, None, Vec2::new(320.0, 4000.0));
        for knob in &entry.knobs {
            let is_vector = matches!(knob.ty.default, Value::List(_)) && (2..=4).contains(&knob.ty.components());
            let name = if is_vector {
                format!("{} X", knob.label)
            } else {
                knob.label.clone()
            };
            let found = board.query_all_by_label(&name).count();
            assert!(found >= 1, "{} has no widget called {name}", entry.id);
            assert!(!says(&board, "but takes"), "{}", entry.id);
        }
    }
}
