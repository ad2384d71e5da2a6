use super::*;

/// Returns the fraction of a bar's range that a drag over `points` covers, if its width corresponds to the whole range.
fn share(board: &Board, name: &str, points: f32) -> f64 {
    f64::from(points / board.get_by_label(name).rect().width())
}

#[test]
fn a_drag_over_half_of_a_bar_goes_through_half_of_its_range() {
    let mut board = board([knob("blend/mask.opacity")]);
    board.state_mut().rows[0].value = Some(Value::Number(0.2));
    board.run();
    let at = middle(&board, "Opacity");
    let way = board.get_by_label("Opacity").rect().width() / 2.0;
    drag(&mut board, at, Vec2::new(way, 0.0));
    assert!((number(&board) - 0.7).abs() < 1e-6, "{}", number(&board));
}

#[test]
fn shift_makes_a_drag_ten_times_finer() {
    let mut board = board([knob("blend/mask.opacity")]);
    board.state_mut().rows[0].value = Some(Value::Number(0.2));
    board.run();
    let at = middle(&board, "Opacity");
    let way = board.get_by_label("Opacity").rect().width() / 2.0;
    board.input_mut().modifiers = Modifiers::SHIFT;
    drag(&mut board, at, Vec2::new(way, 0.0));
    assert!((number(&board) - 0.25).abs() < 1e-6, "{}", number(&board));
}

#[test]
fn a_drag_leaves_the_soft_range_and_stops_at_the_hard_one() {
    let mut board = board([knob("material/adjust.saturation")]);
    let at = middle(&board, "Saturation");
    let soft = board.state().rows[0].knob.ty.soft.expect("a soft range");
    drag(&mut board, at, Vec2::new(500.0, 0.0));
    let left = number(&board);
    assert!(left > soft[1], "{left} is inside {soft:?}");
    let more = 1.0 + share(&board, "Saturation", 500.0) * (soft[1] - soft[0]);
    assert!((left - more).abs() < 0.01, "{left} instead of {more}");
    drag(&mut board, at, Vec2::new(9000.0, 0.0));
    assert_eq!(number(&board), 10.0);
    drag(&mut board, at, Vec2::new(-9000.0, 0.0));
    assert_eq!(number(&board), 0.0);
}

#[test]
fn whole_numbers_stay_whole() {
    let mut board = board([knob("noise/simplex.octaves")]);
    let at = middle(&board, "Detail");
    drag(&mut board, at, Vec2::new(-37.0, 0.0));
    assert_eq!(number(&board).fract(), 0.0);
    assert!(number(&board) < 8.0);
    type_into(&mut board, "Detail", "2.6");
    assert_eq!(number(&board), 3.0);
}

#[test]
fn an_expression_can_be_typed() {
    let mut board = board([knob("blend/mask.opacity")]);
    type_into(&mut board, "Opacity", "2*0.3");
    assert_eq!(number(&board), 0.6);
    type_into(&mut board, "Opacity", "*=0.5");
    assert_eq!(number(&board), 0.3);
    type_into(&mut board, "Opacity", "7");
    assert_eq!(number(&board), 1.0, "the hard range holds what is typed too");
}

#[test]
fn an_invalid_expression_changes_nothing_and_says_why() {
    let mut board = board([knob("blend/mask.opacity")]);
    taken(&mut board);
    type_into(&mut board, "Opacity", "0,5");
    assert_eq!(taken(&mut board), []);
    assert!(says(&board, "Decimals are written with a point"));
    // The field stays open with the typed text, so that it can be corrected.
    board.event(Event::Text("x".to_owned()));
    board.run();
    assert!(!says(&board, "Decimals"), "typing on takes the sentence away");
    key(&mut board, Key::Escape);
    assert_eq!(taken(&mut board), []);
    assert_eq!(board.get_by_label("Opacity").value().as_deref(), Some("1"));
}

#[test]
fn a_number_that_no_file_can_hold_is_refused_with_a_sentence() {
    let mut free = knob("adjust/levels.gamma");
    free.knob.ty.range = None;
    let mut board = board([free]);
    type_into(&mut board, "Gamma", "1e200");
    assert_eq!(taken(&mut board), []);
    assert!(says(&board, "larger than a graph file can hold"));
}

#[test]
fn escape_leaves_a_field_with_its_earlier_value() {
    let mut board = board([knob("blend/mask.opacity")]);
    double_click_bar(&mut board, "Opacity");
    board.event(Event::Text("0.1".to_owned()));
    board.run();
    key(&mut board, Key::Escape);
    assert_eq!(taken(&mut board), []);
}

fn double_click_bar(board: &mut Board, name: &str) {
    let at = middle(board, name);
    double_click(board, at);
}

#[test]
fn a_field_opens_by_double_click_and_by_ctrl_click() {
    let mut board = board([knob("blend/mask.opacity")]);
    double_click_bar(&mut board, "Opacity");
    board.event(Event::Text("0.1".to_owned()));
    key(&mut board, Key::Enter);
    assert_eq!(number(&board), 0.1);
    board.get_by_label("Opacity").click_modifiers(Modifiers::COMMAND);
    board.run();
    board.event(Event::Text("0.2".to_owned()));
    key(&mut board, Key::Enter);
    assert_eq!(number(&board), 0.2);
}

#[test]
fn a_typed_number_is_accepted_when_something_else_is_clicked() {
    let mut board = board([knob("blend/mask.opacity"), knob("blend/mask.mode")]);
    double_click_bar(&mut board, "Opacity");
    board.event(Event::Text("0.1".to_owned()));
    board.run();
    let elsewhere = Pos2::new(300.0, 500.0);
    press(&mut board, elsewhere);
    release(&mut board, elsewhere);
    assert_eq!(number(&board), 0.1);
}

#[test]
fn the_wheel_steps_while_ctrl_is_held_and_else_scrolls() {
    let mut board = board([knob("blend/mask.opacity")]);
    board.state_mut().rows[0].value = Some(Value::Number(0.5));
    board.get_by_label("Opacity").hover();
    board.run();
    for (modifiers, expected) in [(Modifiers::NONE, 0.5), (Modifiers::CTRL, 0.52)] {
        board.event(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: Vec2::new(0.0, 2.0),
            phase: egui::TouchPhase::Move,
            modifiers,
        });
        board.run();
        assert_eq!(number(&board), expected);
    }
}

#[test]
fn each_number_of_a_vector_has_a_bar() {
    let mut board = board([knob("noise/simplex.stretch")]);
    type_into(&mut board, "Stretch Y", "2.5");
    assert_eq!(current(&board), json("[1, 2.5, 1]"));
    let at = middle(&board, "Stretch Z");
    drag(&mut board, at, Vec2::new(20.0, 0.0));
    let held = current(&board);
    let held = held.as_list().expect("a list");
    assert_eq!(held[..2], json("[1, 2.5]").as_list().unwrap()[..]);
    assert!(held[2].as_number() > Some(1.0));
}

#[test]
fn a_direction_is_turned_by_its_ball_and_set_by_its_axes() {
    let mut board = board([knob("surface/direction.toward")]);
    click(&mut board, "Toward −X");
    assert_eq!(current(&board), json("[-1, 0, 0]"));
    let at = middle(&board, "Toward as a ball");
    taken(&mut board);
    drag(&mut board, at, Vec2::new(25.0, 0.0));
    let turned: Vec<f64> = current(&board)
        .as_list()
        .unwrap()
        .iter()
        .filter_map(Value::as_number)
        .collect();
    let length: f64 = turned.iter().map(|number| number * number).sum();
    assert!((length - 1.0).abs() < 1e-3, "{turned:?}");
    assert!(turned[0] > -0.95, "{turned:?} has not moved");
    let log = taken(&mut board);
    assert_eq!(
        (log.first(), log.last()),
        (Some(&KnobEvent::Began), Some(&KnobEvent::Ended))
    );
}

#[test]
fn an_angle_is_turned_by_its_dial_the_short_way_around() {
    let mut board = board([knob("material/adjust.hue")]);
    board.state_mut().rows[0].value = Some(Value::Number(170.0));
    board.run();
    let bar = board.get_by_label("Hue").rect();
    let middle = Pos2::new(bar.right() + 2.0 + bar.height() / 2.0, bar.center().y);
    // From the left side of the dial downward, past half a turn.
    press(&mut board, middle + Vec2::new(-8.0, -1.0));
    pull(&mut board, middle + Vec2::new(-8.0, 0.0));
    let before = number(&board);
    pull(&mut board, middle + Vec2::new(-8.0, 0.5));
    assert!(number(&board) > before, "{} after {before}", number(&board));
    pull(&mut board, middle + Vec2::new(0.0, 8.0));
    release(&mut board, middle);
    assert_eq!(number(&board), 180.0, "the hard range holds it");
    assert_eq!(board.get_by_label("Hue").value().as_deref(), Some("180°"));
}

#[test]
fn angles_are_typed_in_degrees() {
    let mut board = board([knob("surface/direction.reach")]);
    type_into(&mut board, "Reach", "pi/4 rad");
    assert_eq!(number(&board), 45.0);
}

#[test]
fn a_length_is_written_in_units_of_the_model_and_shown_on_it() {
    let mut board = board([knob("filter/blur.radius")]);
    let value = board.get_by_label("Radius").value();
    assert_eq!(value.as_deref(), Some("0.02 = 3.4 cm here"));
    assert_eq!(board.state().length, None);
    board.get_by_label("Radius").hover();
    board.run();
    assert_eq!(board.state().length, Some(0.02));
    let at = middle(&board, "Radius");
    press(&mut board, at);
    pull(&mut board, at + Vec2::new(30.0, 200.0));
    assert_eq!(board.state().length, Some(number(&board)));
    assert!(number(&board) > 0.02);
    release(&mut board, at);
    type_into(&mut board, "Radius", "17 cm");
    assert_eq!(number(&board), 0.1);
}

#[test]
fn a_seed_is_stepped_typed_and_rolled() {
    let mut board = board([knob("noise/simplex.seed")]);
    click(&mut board, "Seed: one more");
    assert_eq!(number(&board), 1.0);
    click(&mut board, "Seed: one less");
    click(&mut board, "Seed: one less");
    assert_eq!(number(&board), 0.0, "a seed is not negative");
    type_into(&mut board, "Seed", "4294967296");
    assert_eq!(number(&board), f64::from(u32::MAX));
    click(&mut board, "Seed: random seed");
    let rolled = number(&board);
    assert!(rolled < 10_000.0 && rolled.fract() == 0.0, "{rolled}");
    taken(&mut board);
    click(&mut board, "Seed: random seed");
    assert_ne!(number(&board), rolled);
}
