use super::*;

fn type_code(board: &mut Board, name: &str, code: &str) {
    click(board, name);
    board.event(Event::Text(code.to_owned()));
    board.run();
    key(board, Key::Enter);
}

#[test]
fn a_color_can_be_typed_in_several_notations_and_is_requested_in_that_of_files() {
    let mut board = board([knob("effect/layer.color")]);
    for (written, expected) in [("#6B3A1E", "#6b3a1e"), ("fff", "#ffffff"), ("102030", "#102030")] {
        type_code(&mut board, "Color: code", written);
        assert_eq!(taken(&mut board), [set("color", expected)]);
    }
}

#[test]
fn a_text_that_is_no_color_changes_nothing_and_is_reported() {
    let mut board = board([knob("effect/layer.color")]);
    for written in ["rust", "#12345", "#gggggg", "é€"] {
        type_code(&mut board, "Color: code", written);
        assert_eq!(taken(&mut board), []);
        assert!(says(&board, "is no color: write six digits"), "{written}");
    }
}

#[test]
fn a_color_can_be_taken_from_the_screen() {
    let mut board = board([knob("effect/layer.color")]);
    click(&mut board, "Color: take from the model or the texture");
    let knob = "color".to_owned();
    assert_eq!(taken(&mut board), [KnobEvent::Eyedropper { knob }]);
}

#[test]
fn a_drag_in_the_picker_is_one_step() {
    let mut board = board([knob("effect/layer.color")]);
    let swatch = board.get_by_label("Color").rect();
    click(&mut board, "Color");
    // The field of colors lies below the numbers and the sample.
    let field = swatch.left_bottom() + Vec2::new(90.0, 150.0);
    drag(&mut board, field, Vec2::new(30.0, 20.0));
    let log = taken(&mut board);
    assert_eq!(
        (log.first(), log.last()),
        (Some(&KnobEvent::Began), Some(&KnobEvent::Ended)),
        "{log:?}"
    );
    assert!(log.len() > 2 && current(&board) != Value::from("#808080"));
}

#[test]
fn a_color_is_set_by_hue_saturation_and_value_and_then_offered_to_other_colors() {
    let mut board = board(["effect/layer.color", "effect/layer.emission"].map(knob));
    click(&mut board, "Color");
    for (name, number) in [("Value", "100"), ("Saturation", "100"), ("Hue", "120")] {
        type_code(&mut board, name, number);
    }
    let log = taken(&mut board);
    assert_eq!(log.last(), Some(&set("color", "#00ff00")), "{log:?}");
    key(&mut board, Key::Escape);
    click(&mut board, "Emission");
    click(&mut board, "Picked before: #00ff00");
    let log = taken(&mut board);
    assert!(log.contains(&set("emission", "#00ff00")), "{log:?}");
}

#[test]
fn the_picker_takes_a_code_too() {
    let mut board = board([knob("effect/layer.color")]);
    click(&mut board, "Color");
    type_code(&mut board, "Code of the color", "#6b3a1e");
    let log = taken(&mut board);
    assert!(log.contains(&set("color", "#6b3a1e")), "{log:?}");
}

fn gradient(stops: &str) -> Board {
    let mut gradient = knob("color/gradient.stops");
    gradient.value = Some(json(stops));
    board([gradient])
}

/// Returns the position at which a stop of the gradient is grabbed.
fn handle(board: &Board, at: f32) -> Pos2 {
    let area = board.get_by_label("Stops").rect().shrink2(Vec2::new(6.5, 0.0));
    Pos2::new(egui::lerp(area.x_range(), at), area.bottom() - 4.0)
}

#[test]
fn a_stop_is_dragged_past_another_one() {
    let mut board = gradient(r##"[[0, "#000000"], [0.25, "#ff0000"], [1, "#ffffff"]]"##);
    let [from, to] = [0.25, 0.75].map(|at| handle(&board, at));
    drag(&mut board, from, to - from);
    assert_eq!(
        current(&board),
        json(r##"[[0, "#000000"], [0.75, "#ff0000"], [1, "#ffffff"]]"##)
    );
    let [from, to] = [0.0, 0.9].map(|at| handle(&board, at));
    drag(&mut board, from, to - from);
    assert_eq!(
        current(&board),
        json(r##"[[0.75, "#ff0000"], [0.9, "#000000"], [1, "#ffffff"]]"##)
    );
    assert_eq!(
        board.get_by_label("Stops").value().as_deref(),
        Some("stop 2 of 3 at 0.9")
    );
}

#[test]
fn a_click_on_the_ramp_adds_a_stop_of_the_color_that_is_there() {
    let mut board = gradient(r##"[[0, "#000000"], [1, "#ffffff"]]"##);
    let at = handle(&board, 0.5);
    press(&mut board, at);
    release(&mut board, at);
    // Half of the light is 188 of 255 in sRGB.
    assert_eq!(
        current(&board),
        json(r##"[[0, "#000000"], [0.5, "#bcbcbc"], [1, "#ffffff"]]"##)
    );
}

#[test]
fn a_stop_that_is_dragged_away_is_removed_unless_it_is_the_last_one() {
    let mut board = gradient(r##"[[0, "#000000"], [1, "#ffffff"]]"##);
    let at = handle(&board, 1.0);
    press(&mut board, at);
    pull(&mut board, at + Vec2::new(0.0, 90.0));
    assert_eq!(current(&board), json(r##"[[0, "#000000"]]"##));
    pull(&mut board, at + Vec2::new(-2.0, 10.0));
    assert_eq!(
        current(&board).as_list().map(<[Value]>::len),
        Some(2),
        "it comes back with the pointer"
    );
    pull(&mut board, at + Vec2::new(0.0, 90.0));
    release(&mut board, at + Vec2::new(0.0, 90.0));
    let at = handle(&board, 0.0);
    drag(&mut board, at, Vec2::new(0.0, 90.0));
    assert_eq!(current(&board), json(r##"[[0, "#000000"]]"##));
}

#[test]
fn escape_cancels_the_drag_of_a_stop() {
    let mut board = gradient(r##"[[0, "#000000"], [1, "#ffffff"]]"##);
    let at = handle(&board, 1.0);
    press(&mut board, at);
    pull(&mut board, at + Vec2::new(-50.0, 90.0));
    key(&mut board, Key::Escape);
    assert_eq!(taken(&mut board).last(), Some(&KnobEvent::Canceled));
}

#[test]
fn a_full_gradient_says_so_instead_of_taking_another_stop() {
    let stops: Vec<Value> = (0..16)
        .map(|at| json(&format!(r##"[{}, "#808080"]"##, f64::from(at) / 20.0)))
        .collect();
    let mut board = gradient(&Value::List(stops).to_json());
    let at = handle(&board, 0.95);
    press(&mut board, at);
    release(&mut board, at);
    assert_eq!(taken(&mut board), []);
    assert!(says(&board, "no more than 16 stops"));
}

#[test]
fn a_stop_has_its_color_and_place_in_numbers() {
    let mut board = gradient(r##"[[0, "#000000"], [1, "#ffffff"]]"##);
    type_into(&mut board, "Stops: position", "1/4");
    type_code(&mut board, "Stops: color: code", "#102030");
    assert_eq!(current(&board), json(r##"[[0.25, "#102030"], [1, "#ffffff"]]"##));
    click(&mut board, "Stops: turn around");
    assert_eq!(current(&board), json(r##"[[0, "#ffffff"], [0.75, "#102030"]]"##));
    click(&mut board, "Stops: take the stop out");
    assert_eq!(current(&board), json(r##"[[0, "#ffffff"]]"##));
    click(&mut board, "Stops: add a stop");
    assert_eq!(current(&board), json(r##"[[0, "#ffffff"], [0.5, "#ffffff"]]"##));
}

#[test]
fn a_preset_replaces_all_stops_at_once() {
    let mut board = gradient(r##"[[0, "#000000"], [1, "#ffffff"]]"##);
    click(&mut board, "Stops: presets and pictures");
    click(&mut board, "Old rust");
    let log = taken(&mut board);
    assert_eq!(log.len(), 1, "{log:?}");
    let rust = r##"[[0, "#1c100c"], [0.28, "#3d1d12"], [0.55, "#5e2d19"], [0.8, "#83482a"], [1, "#9a6a4c"]]"##;
    assert_eq!(current(&board), json(rust));
}

#[test]
fn the_menu_of_stops_asks_for_a_picture_to_pick_a_gradient_from() {
    let mut board = gradient(r##"[[0, "#000000"], [1, "#ffffff"]]"##);
    click(&mut board, "Stops: presets and pictures");
    click(&mut board, "Pick from a picture…");
    let knob = "stops".to_owned();
    assert_eq!(taken(&mut board), [KnobEvent::PickGradient { knob }]);
}
