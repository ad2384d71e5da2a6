use super::*;

/// Numbers of drags that began, values that were set, and drags that ended in a log.
fn borders(log: &[KnobEvent]) -> (usize, usize, usize) {
    let count = |what: fn(&KnobEvent) -> bool| log.iter().filter(|event| what(event)).count();
    (
        count(|event| *event == KnobEvent::Began),
        count(|event| matches!(event, KnobEvent::Set { .. })),
        count(|event| *event == KnobEvent::Ended),
    )
}

fn opacity() -> Board {
    let mut opacity = knob("blend/mask.opacity");
    opacity.value = Some(Value::Number(0.5));
    board([opacity])
}

#[test]
fn a_drag_is_one_step_from_began_to_ended() {
    let mut board = opacity();
    let at = middle(&board, "Opacity");
    drag(&mut board, at, Vec2::new(40.0, 0.0));
    let log = taken(&mut board);
    assert_eq!(borders(&log), (1, 2, 1), "{log:?}");
    assert_eq!(
        (log.first(), log.last()),
        (Some(&KnobEvent::Began), Some(&KnobEvent::Ended))
    );
}

#[test]
fn a_click_is_no_drag_and_sets_nothing() {
    let mut board = opacity();
    click(&mut board, "Opacity");
    assert_eq!(taken(&mut board), []);
}

#[test]
fn a_drag_goes_on_outside_the_window_and_ends_once() {
    let mut board = opacity();
    let at = middle(&board, "Opacity");
    press(&mut board, at);
    pull(&mut board, at + Vec2::new(10.0, 0.0));
    board.remove_cursor();
    board.run();
    assert_eq!(borders(&taken(&mut board)), (1, 1, 0));
    let outside = at + Vec2::new(20.0, -400.0);
    pull(&mut board, outside);
    assert_eq!(borders(&taken(&mut board)), (0, 1, 0));
    board.remove_cursor();
    release(&mut board, outside);
    board.run();
    assert_eq!(borders(&taken(&mut board)), (0, 0, 1));
}

#[test]
fn escape_cancels_a_drag() {
    let mut board = opacity();
    let at = middle(&board, "Opacity");
    press(&mut board, at);
    pull(&mut board, at + Vec2::new(30.0, 0.0));
    taken(&mut board);
    key(&mut board, Key::Escape);
    assert_eq!(taken(&mut board), [KnobEvent::Canceled]);
    // Later movement of the pointer is no drag any more.
    pull(&mut board, at + Vec2::new(60.0, 0.0));
    release(&mut board, at + Vec2::new(60.0, 0.0));
    assert_eq!(taken(&mut board), []);
}

#[test]
fn a_drag_ends_when_its_row_has_disappeared() {
    let mut board = opacity();
    let at = middle(&board, "Opacity");
    press(&mut board, at);
    pull(&mut board, at + Vec2::new(30.0, 0.0));
    taken(&mut board);
    board.state_mut().rows.clear();
    board.run();
    assert_eq!(taken(&mut board), [KnobEvent::Ended]);
}

#[test]
fn the_same_value_is_not_requested_twice() {
    let mut board = opacity();
    let at = middle(&board, "Opacity");
    press(&mut board, at);
    for right in [9000.0, 9100.0, 9200.0] {
        pull(&mut board, at + Vec2::new(right, 0.0));
    }
    release(&mut board, at);
    assert_eq!(taken(&mut board)[..2], [KnobEvent::Began, set("opacity", 1.0)]);
}
