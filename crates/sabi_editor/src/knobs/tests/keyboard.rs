use super::*;

#[test]
fn arrows_step_a_bar_and_shift_makes_the_steps_tenths() {
    let mut opacity = knob("blend/mask.opacity");
    opacity.value = Some(Value::Number(0.5));
    let mut board = board([opacity]);
    focus(&mut board, "Opacity");
    for (pressed, expected) in [
        (Key::ArrowRight, 0.51),
        (Key::ArrowUp, 0.52),
        (Key::ArrowLeft, 0.51),
        (Key::ArrowDown, 0.5),
        (Key::PageUp, 0.6),
        (Key::PageDown, 0.5),
        (Key::End, 1.0),
        (Key::Home, 0.0),
    ] {
        key(&mut board, pressed);
        assert_eq!(number(&board), expected, "{pressed:?}");
    }
    board.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    board.run();
    assert_eq!(number(&board), 0.001);
    key(&mut board, Key::Backspace);
    assert_eq!(board.state().rows[0].value, None);
}

#[test]
fn a_digit_starts_a_new_number_in_a_bar() {
    let mut board = board([knob("blend/mask.opacity")]);
    focus(&mut board, "Opacity");
    for digit in ["0", ".", "2"] {
        board.event(Event::Text(digit.to_owned()));
        board.run();
    }
    key(&mut board, Key::Enter);
    assert_eq!(number(&board), 0.2);
    assert!(
        board.get_by_label("Opacity").is_focused(),
        "the bar has the keyboard again"
    );
}

#[test]
fn requests_of_screen_readers_are_performed() {
    use egui::accesskit::{Action, ActionData, ActionRequest};
    use egui_kittest::kittest::NodeT;
    let mut board = board([knob("noise/simplex.octaves")]);
    let asked = [
        (Action::Decrement, None, 7.0),
        (Action::Increment, None, 8.0),
        (Action::SetValue, Some(ActionData::NumericValue(3.0)), 3.0),
        (Action::SetValue, Some(ActionData::Value("2+2".into())), 4.0),
    ];
    for (action, data, expected) in asked {
        let (target_node, target_tree) = board.get_by_label("Detail").accesskit_node().locate();
        board.event(Event::AccessKitActionRequest(ActionRequest {
            action,
            target_tree,
            target_node,
            data,
        }));
        board.run();
        assert_eq!(number(&board), expected);
    }
}

#[test]
fn a_switch_a_word_and_a_list_change_by_keyboard() {
    let rows = ["effect/layer.color_on", "noise/simplex.mode", "effect/relief.profile"];
    let mut board = board(rows.map(knob));
    focus(&mut board, "Color on");
    key(&mut board, Key::Space);
    focus(&mut board, "Billow");
    key(&mut board, Key::Enter);
    focus(&mut board, "Profile");
    key(&mut board, Key::ArrowDown);
    let expected = [set("color_on", false), set("mode", "billow"), set("profile", "raised")];
    assert_eq!(taken(&mut board), expected);
    // The list opens at the present word, and the keys continue from there.
    key(&mut board, Key::Enter);
    key(&mut board, Key::ArrowDown);
    key(&mut board, Key::Enter);
    assert_eq!(taken(&mut board), [set("profile", "dent")]);
    assert!(board.get_by_label("Profile").is_focused());
}

#[test]
fn a_ball_is_turned_by_arrows() {
    let mut board = board([knob("surface/direction.toward")]);
    focus(&mut board, "Toward as a ball");
    key(&mut board, Key::ArrowDown);
    let held = current(&board);
    let up = held.as_list().unwrap()[1].as_number().unwrap();
    assert!((0.99..1.0).contains(&up), "{up}");
    focus(&mut board, "Toward +Z");
    key(&mut board, Key::Space);
    assert_eq!(super::current(&board), json("[0, 0, 1]"));
}

#[test]
fn stops_are_chosen_moved_added_and_removed_by_keyboard() {
    let mut board = board([knob("color/gradient.stops")]);
    focus(&mut board, "Stops");
    key(&mut board, Key::Insert);
    assert_eq!(
        current(&board),
        json(r##"[[0, "#000000"], [0.5, "#bcbcbc"], [1, "#ffffff"]]"##)
    );
    key(&mut board, Key::ArrowRight);
    key(&mut board, Key::PageDown);
    key(&mut board, Key::ArrowLeft);
    assert_eq!(
        current(&board),
        json(r##"[[0, "#000000"], [0.51, "#bcbcbc"], [0.99, "#ffffff"]]"##)
    );
    key(&mut board, Key::PageUp);
    key(&mut board, Key::Delete);
    assert_eq!(current(&board), json(r##"[[0, "#000000"], [0.99, "#ffffff"]]"##));
}

#[test]
fn points_are_chosen_moved_added_and_removed_by_keyboard() {
    let mut board = board([knob("adjust/curve.points")]);
    focus(&mut board, "Points");
    key(&mut board, Key::Insert);
    assert_eq!(current(&board), json("[[0, 0], [0.5, 0.5], [1, 1]]"));
    key(&mut board, Key::ArrowUp);
    key(&mut board, Key::ArrowRight);
    assert_eq!(current(&board), json("[[0, 0], [0.51, 0.51], [1, 1]]"));
    key(&mut board, Key::PageUp);
    key(&mut board, Key::Delete);
    assert_eq!(current(&board), json("[[0.51, 0.51], [1, 1]]"));
}

#[test]
fn tab_goes_from_knob_to_knob_without_a_stop_at_names_and_dots() {
    let mut rows = ["blend/mask.opacity", "blend/mask.below", "blend/mask.above"].map(knob);
    rows[0].value = Some(Value::Number(0.5));
    let mut board = board(rows);
    for name in ["Opacity", "Below", "Above"] {
        key(&mut board, Key::Tab);
        assert!(board.get_by_label(name).is_focused(), "{name}");
    }
}
