use super::*;

fn node(rows: impl IntoIterator<Item = TestKnob>, zoom: f32) -> Board {
    board_of(rows, ColorScheme::Dark, Some(zoom), Vec2::new(320.0, 600.0))
}

#[test]
fn a_bar_on_a_node_is_dragged_as_one_step_at_any_zoom() {
    for zoom in [0.5, 1.0, 2.0] {
        let mut board = node(["blend/mask.opacity", "blend/mask.below"].map(knob), zoom);
        let at = middle(&board, "Below");
        drag(&mut board, at, Vec2::new(-60.0, 0.0));
        let log = taken(&mut board);
        assert_eq!(
            (log.first(), log.last()),
            (Some(&KnobEvent::Began), Some(&KnobEvent::Ended)),
            "{log:?}"
        );
        assert_eq!(log.iter().filter(|event| **event == KnobEvent::Ended).count(), 1);
        let below = board.state().rows[1].value.as_ref().and_then(Value::as_number);
        assert!(below < Some(1.0), "{below:?} at {zoom}");
        assert_eq!(board.state().rows[0].value, None);
    }
}

#[test]
fn escape_cancels_a_drag_on_a_node() {
    let mut board = node(["blend/mask.opacity", "blend/mask.below"].map(knob), 1.0);
    let at = middle(&board, "Opacity");
    press(&mut board, at);
    pull(&mut board, at - Vec2::new(60.0, 0.0));
    taken(&mut board);
    key(&mut board, Key::Escape);
    assert_eq!(taken(&mut board), [KnobEvent::Canceled]);
}

#[test]
fn a_drag_ends_when_its_node_has_disappeared() {
    let mut board = node(["blend/mask.opacity", "blend/mask.below"].map(knob), 1.0);
    let at = middle(&board, "Opacity");
    press(&mut board, at);
    pull(&mut board, at - Vec2::new(60.0, 0.0));
    taken(&mut board);
    board.state_mut().rows.remove(0);
    board.run_steps(3);
    assert_eq!(taken(&mut board), [KnobEvent::Ended]);
}

#[test]
fn numbers_switches_words_and_colors_are_set_on_nodes() {
    let rows = ["blend/mask.opacity", "effect/layer.color_on", "blend/mask.mode"];
    let mut board = node(rows.map(knob), 1.0);
    type_into(&mut board, "Opacity", "1/4");
    click(&mut board, "Color on");
    click(&mut board, "Mode");
    click(&mut board, "Screen");
    let expected = [set("opacity", 0.25), set("color_on", false), set("mode", "screen")];
    assert_eq!(taken(&mut board), expected);
}

#[test]
fn parameters_that_are_edited_in_the_panel_only_are_shown_on_nodes() {
    let rows = [
        "noise/simplex.stretch",
        "color/gradient.stops",
        "adjust/curve.points",
        "source/image.file",
    ];
    let mut rows = rows.map(knob).to_vec();
    let mut wired = knob("blend/mask.below");
    wired.wired = Some("Edges");
    rows.push(wired);
    let board = node(rows, 1.0);
    assert_eq!(board.get_by_label("Stretch").value().as_deref(), Some("1  1  1"));
    assert_eq!(board.get_by_label("Below").value().as_deref(), Some("from Edges"));
    for name in ["Stops", "Points", "File"] {
        assert!(board.query_by_label(name).is_some(), "{name}");
    }
}

#[test]
fn an_error_on_a_node_is_shown_beside_it_until_something_else_is_pressed() {
    let mut board = node([knob("blend/mask.opacity")], 1.0);
    type_into(&mut board, "Opacity", "1+");
    assert!(says(&board, "A number is missing"));
    let elsewhere = Pos2::new(300.0, 500.0);
    press(&mut board, elsewhere);
    release(&mut board, elsewhere);
    press(&mut board, elsewhere);
    release(&mut board, elsewhere);
    assert!(!says(&board, "A number is missing"));
    assert_eq!(taken(&mut board), []);
}

#[test]
fn the_menu_of_a_row_on_a_node_exposes_its_parameter() {
    let mut board = node(["blend/mask.opacity", "blend/mask.below"].map(knob), 1.0);
    board.get_by_label("Below").click_secondary();
    board.run();
    click(&mut board, "Expose parameter");
    let expected = KnobEvent::Expose {
        knob: "below".to_owned(),
    };
    assert_eq!(taken(&mut board), [expected]);
}
