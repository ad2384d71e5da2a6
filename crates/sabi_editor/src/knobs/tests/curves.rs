use super::*;

fn curve(points: &str) -> Board {
    let mut curve = knob("adjust/curve.points");
    curve.value = Some(json(points));
    board([curve])
}

/// Returns the position at which a point of the curve is grabbed, in a view from 0 to 1.
fn place(board: &Board, x: f32, y: f32) -> Pos2 {
    let view = board.get_by_label("Points").rect().shrink(7.0);
    Pos2::new(egui::lerp(view.x_range(), x), egui::lerp(view.bottom()..=view.top(), y))
}

fn points(board: &Board) -> Vec<[f64; 2]> {
    let held = current(board);
    let point = |point: &Value| {
        let numbers: Vec<f64> = point.as_list().unwrap().iter().filter_map(Value::as_number).collect();
        [numbers[0], numbers[1]]
    };
    held.as_list().unwrap().iter().map(point).collect()
}

fn assert_near(board: &Board, expected: &[[f64; 2]]) {
    let found = points(board);
    let is_near = |(found, expected): (&[f64; 2], &[f64; 2])| (0..2).all(|at| (found[at] - expected[at]).abs() < 0.006);
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(is_near),
        "{found:?} instead of {expected:?}"
    );
}

#[test]
fn a_point_is_dragged_past_another_one() {
    let mut board = curve("[[0, 0], [0.25, 0.5], [0.5, 0.5], [1, 1]]");
    let [from, to] = [place(&board, 0.25, 0.5), place(&board, 0.75, 0.25)];
    drag(&mut board, from, to - from);
    assert_near(&board, &[[0.0, 0.0], [0.5, 0.5], [0.75, 0.25], [1.0, 1.0]]);
    assert!(
        board
            .get_by_label("Points")
            .value()
            .unwrap()
            .starts_with("point 3 of 4")
    );
    let log = taken(&mut board);
    assert_eq!(
        (log.first(), log.last()),
        (Some(&KnobEvent::Began), Some(&KnobEvent::Ended))
    );
}

#[test]
fn a_double_click_adds_a_point_or_removes_one() {
    let mut board = curve("[[0, 0], [1, 1]]");
    let at = place(&board, 0.25, 0.75);
    double_click(&mut board, at);
    assert_near(&board, &[[0.0, 0.0], [0.25, 0.75], [1.0, 1.0]]);
    // A third click soon after the second would make a triple click.
    board.run_steps(60);
    let at = place(&board, 0.25, 0.75);
    double_click(&mut board, at);
    assert_near(&board, &[[0.0, 0.0], [1.0, 1.0]]);
}

#[test]
fn a_point_that_is_dragged_away_is_removed_unless_it_is_the_last_one() {
    let mut board = curve("[[0, 0], [1, 1]]");
    let at = place(&board, 1.0, 1.0);
    drag(&mut board, at, Vec2::new(0.0, 300.0));
    assert_near(&board, &[[0.0, 0.0]]);
    let at = place(&board, 0.0, 0.0);
    drag(&mut board, at, Vec2::new(0.0, 300.0));
    assert_near(&board, &[[0.0, 0.0]]);
}

#[test]
fn a_point_can_be_typed_beyond_the_usual_range_but_not_beyond_the_hard_one() {
    let mut board = curve("[[0, 0], [1, 1]]");
    type_into(&mut board, "Points X", "-1");
    type_into(&mut board, "Points Y", "99");
    assert_near(&board, &[[-1.0, 10.0], [1.0, 1.0]]);
}

#[test]
fn points_are_added_on_the_curve_and_removed_by_buttons() {
    let mut board = curve("[[0, 0], [1, 1]]");
    click(&mut board, "Points: add a point");
    assert_near(&board, &[[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]]);
    click(&mut board, "Points: take the point out");
    assert_near(&board, &[[0.0, 0.0], [1.0, 1.0]]);
}

#[test]
fn preset_shapes_are_curves_that_a_file_can_hold() {
    let mut board = curve("[[0, 0], [0.5, 0.25], [1, 1]]");
    click(&mut board, "Points: upside down");
    assert_near(&board, &[[0.0, 1.0], [0.5, 0.75], [1.0, 0.0]]);
    click(&mut board, "Points: a line");
    assert_near(&board, &[[0.0, 0.0], [1.0, 1.0]]);
    for name in ["Points: ease in and out", "Points: steps"] {
        click(&mut board, name);
        let found = points(&board);
        assert!(found.is_sorted_by(|left, right| left[0] <= right[0]), "{found:?}");
        assert!(found.len() <= 16, "{found:?}");
    }
}

#[test]
fn a_full_curve_says_so_instead_of_taking_another_point() {
    let full: Vec<String> = (0..16).map(|at| format!("[{}, 0.5]", f64::from(at) / 15.0)).collect();
    let mut board = curve(&format!("[{}]", full.join(", ")));
    let at = place(&board, 0.5, 0.9);
    double_click(&mut board, at);
    assert_eq!(taken(&mut board), []);
    assert!(says(&board, "no more than 16 points"));
}
