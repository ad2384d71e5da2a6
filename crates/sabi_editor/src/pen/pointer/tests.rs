use egui::pos2;

use super::*;

fn moved(x: f32, pressure: f32) -> PenEvent {
    PenEvent::Moved {
        at: [x, 10.0],
        pressure: Some(pressure),
        tilt_degrees: Some([20.0, -10.0]),
    }
}

/// Events and places of the frames that these events of a pen are added to.
fn frames(pointer: &mut PenPointer, events: &[PenEvent]) -> Vec<(Vec<Event>, Vec<PenPlace>)> {
    pointer.receive(events.iter().copied());
    let mut frames = Vec::new();
    while pointer.has_waiting() {
        let mut raw = RawInput::default();
        let places = pointer.enter_frame(&mut raw, 1.0);
        frames.push((raw.events, places));
    }
    frames
}

fn names(events: &[Event]) -> Vec<String> {
    let name = |event: &Event| match event {
        Event::PointerMoved(at) => format!("at {}", at.x),
        Event::PointerButton {
            pos, button, pressed, ..
        } => {
            format!("{button:?} {} at {}", if *pressed { "down" } else { "up" }, pos.x)
        }
        Event::PointerGone => "gone".to_owned(),
        event => format!("{event:?}"),
    };
    events.iter().map(name).collect()
}

fn told(events: &[PenEvent]) -> Vec<Vec<String>> {
    let frames = frames(&mut PenPointer::default(), events);
    frames.iter().map(|(events, _)| names(events)).collect()
}

const NEAR: PenEvent = PenEvent::Near { is_eraser: false };

#[test]
fn a_touch_presses_at_its_place_and_each_press_or_release_ends_a_frame() {
    let events = [
        NEAR,
        moved(1.0, 0.0),
        PenEvent::Frame,
        PenEvent::Down,
        moved(2.0, 0.3),
        PenEvent::Frame,
        moved(3.0, 0.5),
        moved(4.0, 0.6),
        PenEvent::Up,
        PenEvent::Frame,
        moved(5.0, 0.0),
        PenEvent::Left,
    ];
    assert_eq!(
        told(&events),
        [
            vec!["at 1", "at 2", "Primary down at 2"],
            vec!["at 3", "at 4", "Primary up at 4"],
            vec!["at 5", "gone"],
        ]
    );
}

#[test]
fn a_touch_that_is_reported_after_its_place_presses_there() {
    assert_eq!(
        told(&[NEAR, moved(2.0, 0.3), PenEvent::Down, PenEvent::Frame, moved(9.0, 0.3)]),
        [vec!["at 2", "Primary down at 2"], vec!["at 9"]]
    );
    assert_eq!(
        told(&[NEAR, moved(2.0, 0.3), PenEvent::Down]),
        [["at 2", "Primary down at 2"]]
    );
    assert_eq!(
        told(&[NEAR, PenEvent::Down, PenEvent::Up, PenEvent::Frame]),
        [Vec::<String>::new()],
        "nowhere"
    );
}

#[test]
fn a_pen_that_leaves_releases_all_its_buttons() {
    let button = PenEvent::Button {
        is_first: true,
        is_pressed: true,
    };
    let mut pointer = PenPointer::default();
    let events = [
        NEAR,
        moved(1.0, 0.5),
        PenEvent::Down,
        PenEvent::Frame,
        button,
        moved(2.0, 0.5),
        PenEvent::Left,
    ];
    let frames = frames(&mut pointer, &events);
    assert_eq!(names(&frames[1].0), ["Secondary down at 1"]);
    assert_eq!(
        names(&frames[2].0),
        ["at 2", "Primary up at 2", "Secondary up at 2", "gone"]
    );
    assert!(!pointer.is_near() && pointer.place().is_none());
}

#[test]
fn each_place_has_its_own_pressure_and_tilt_and_the_end_of_the_pen() {
    let mut pointer = PenPointer::default();
    let events = [PenEvent::Near { is_eraser: true }, moved(1.0, 0.25), moved(2.0, 0.75)];
    let [(_, places)] = frames(&mut pointer, &events).try_into().expect("one frame");
    let state = |pressure| PenState {
        pressure,
        tilt_degrees: Some([20.0, -10.0]),
        is_eraser: true,
    };
    let expected = [(1.0, 0.25), (2.0, 0.75)].map(|(x, pressure)| PenPlace {
        at: pos2(x, 10.0),
        state: state(pressure),
    });
    assert_eq!(places, expected);
}

#[test]
fn a_pen_that_is_reported_near_again_goes_on_and_its_other_end_starts_anew() {
    let events = [
        NEAR,
        moved(1.0, 0.5),
        PenEvent::Down,
        PenEvent::Frame,
        NEAR,
        moved(2.0, 0.5),
    ];
    assert_eq!(told(&events), [vec!["at 1", "Primary down at 1"], vec!["at 2"]]);
    let other = [&events[..4], &[PenEvent::Near { is_eraser: true }, moved(3.0, 0.5)]].concat();
    assert_eq!(told(&other)[1..], [vec!["Primary up at 1"], vec!["at 3"]]);
}

#[test]
fn invalid_numbers_of_a_driver_leave_the_earlier_ones_and_others_are_clamped() {
    let mut pointer = PenPointer::default();
    let odd = |at, pressure, tilt| PenEvent::Moved {
        at,
        pressure: Some(pressure),
        tilt_degrees: Some(tilt),
    };
    let events = [
        NEAR,
        moved(1.0, 0.5),
        odd([f32::NAN, 3.0], 0.6, [1.0, 2.0]),
        odd([3e30, 3.0], 0.6, [1.0, 2.0]),
        odd([2.0, 10.0], f32::NAN, [f32::INFINITY, 2.0]),
        odd([3.0, 10.0], 7.0, [400.0, -400.0]),
        odd([4.0, 10.0], -7.0, [0.0, 0.0]),
    ];
    let [(events, places)] = frames(&mut pointer, &events).try_into().expect("one frame");
    assert_eq!(names(&events), ["at 1", "at 2", "at 3", "at 4"]);
    let states = places
        .iter()
        .map(|place| (place.state.pressure, place.state.tilt_degrees));
    let expected = [
        (0.5, Some([20.0, -10.0])),
        (0.6, Some([1.0, 2.0])),
        (1.0, Some([89.0, -89.0])),
        (0.0, Some([0.0, 0.0])),
    ];
    assert_eq!(states.collect::<Vec<_>>(), expected);
}

#[test]
fn a_tool_without_pressure_has_the_full_pressure_of_a_mouse() {
    let mut pointer = PenPointer::default();
    let plain = PenEvent::Moved {
        at: [1.0, 10.0],
        pressure: None,
        tilt_degrees: None,
    };
    let frames = frames(&mut pointer, &[NEAR, plain]);
    assert_eq!(frames[0].1[0].state, PenState::MOUSE);
}

#[test]
fn a_near_pen_alone_moves_the_pointer_and_a_mouse_can_release_its_own_buttons() {
    let button = |button, pressed| Event::PointerButton {
        pos: pos2(7.0, 10.0),
        button,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let system = [
        Event::PointerMoved(pos2(7.0, 10.0)),
        button(PointerButton::Primary, true),
        button(PointerButton::Primary, false),
        button(PointerButton::Middle, false),
        Event::PointerGone,
        Event::Copy,
    ];
    let mut pointer = PenPointer::default();
    let mut raw = RawInput {
        events: system.to_vec(),
        ..RawInput::default()
    };
    assert!(pointer.enter_frame(&mut raw, 1.0).is_empty());
    assert_eq!(raw.events, system, "none is near");
    frames(&mut pointer, &[NEAR, moved(1.0, 0.5), PenEvent::Down, PenEvent::Frame]);
    pointer.enter_frame(&mut raw, 1.0);
    assert_eq!(raw.events, [button(PointerButton::Middle, false), Event::Copy]);
}

#[test]
fn places_are_in_points_of_the_zoom() {
    let mut pointer = PenPointer::default();
    pointer.receive([NEAR, moved(20.0, 0.5)]);
    let places = pointer.enter_frame(&mut RawInput::default(), 2.0);
    assert_eq!(places[0].at, pos2(10.0, 5.0));
}

/// Names of the system's events that are kept in a frame at a time, seconds.
fn left_of(pointer: &mut PenPointer, time: f64, events: Vec<Event>) -> Vec<String> {
    let mut raw = RawInput {
        time: Some(time),
        events,
        ..RawInput::default()
    };
    pointer.enter_frame(&mut raw, 1.0);
    names(&raw.events)
}

#[test]
fn a_pen_lying_on_its_tablet_leaves_the_pointer_to_the_mouse_until_it_moves() {
    let mut pointer = PenPointer::default();
    let mouse = || vec![Event::PointerMoved(pos2(7.0, 7.0))];
    pointer.receive([NEAR, moved(1.0, 0.0)]);
    assert_eq!(left_of(&mut pointer, 0.0, mouse()), ["at 1"]);
    assert!(left_of(&mut pointer, 0.5, mouse()).is_empty() && !pointer.rests());
    assert_eq!(left_of(&mut pointer, 2.0, mouse()), ["at 7"]);
    assert!(pointer.rests());
    pointer.receive([moved(2.0, 0.0)]);
    assert_eq!(left_of(&mut pointer, 2.1, mouse()), ["at 2"]);
    pointer.receive([PenEvent::Down, moved(3.0, 0.5), PenEvent::Frame]);
    left_of(&mut pointer, 2.2, Vec::new());
    assert!(
        left_of(&mut pointer, 9.0, mouse()).is_empty(),
        "a pen that is held still draws on"
    );
}

#[test]
fn a_finger_that_touched_before_the_pen_came_is_lifted() {
    let mut pointer = PenPointer::default();
    pointer.receive([NEAR, moved(1.0, 0.0)]);
    let touch = |phase: TouchPhase| Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(1),
        phase,
        pos: pos2(5.0, 5.0),
        force: None,
    };
    let events = [TouchPhase::Start, TouchPhase::Move, TouchPhase::End]
        .map(touch)
        .to_vec();
    let left = left_of(&mut pointer, 0.0, events);
    assert!(left.len() == 2 && left[0].contains("End"), "{left:?}");
}
