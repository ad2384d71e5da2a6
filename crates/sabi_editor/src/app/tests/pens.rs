//! Pens: recorded logs of their events, played into the window.

use egui::{PointerButton, RawInput};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use sabi_paint::{Action as BrushAction, Fade, StrokePoint};

use super::Window;
use super::painting::painting_on;
use crate::dock::Panel;
use crate::pen::PenEvent;

/// Time of a frame, milliseconds.
const FRAME: f32 = 1000.0 / 60.0;

/// Events of a log with their times, milliseconds. A line without numbers has the time of the next place where the pen
/// comes near or touches, and that of the last place otherwise.
fn read(log: &str) -> Vec<(f32, PenEvent)> {
    let mut events: Vec<(f32, PenEvent)> = Vec::new();
    let mut unplaced = 0;
    for line in log.lines().filter(|line| !line.starts_with('#')) {
        let event = match line {
            "near" => PenEvent::Near { is_eraser: false },
            "near eraser" => PenEvent::Near { is_eraser: true },
            "down" => PenEvent::Down,
            "up" => PenEvent::Up,
            "left" => PenEvent::Left,
            numbers => {
                let numbers = numbers
                    .split(' ')
                    .map(|number| number.parse::<f32>().expect("a number"));
                let [time, x, y, pressure, tilt_x, tilt_y] =
                    numbers.collect::<Vec<_>>().try_into().expect("six numbers");
                let first = events.len() - unplaced;
                events[first..].iter_mut().for_each(|(unknown, _)| *unknown = time);
                unplaced = 0;
                let moved = PenEvent::Moved {
                    at: [x, y],
                    pressure: Some(pressure),
                    tilt_degrees: Some([tilt_x, tilt_y]),
                };
                events.push((time, moved));
                events.push((time, PenEvent::Frame));
                continue;
            }
        };
        let time = events.last().map_or(0.0, |(time, _)| *time);
        events.push((time, event));
        // These two events take the time of the next place; others keep the time of the last place.
        unplaced += usize::from(matches!(event, PenEvent::Near { .. } | PenEvent::Down));
    }
    events
}

/// A log in which only each `step`th place of the pen on the tablet is left, besides the last one.
fn thinned(log: &str, step: usize) -> String {
    let mut number = 0;
    let lines: Vec<&str> = log.lines().collect();
    let kept = lines.iter().enumerate().filter(|(index, line)| {
        let is_place = line.starts_with(|first: char| first.is_ascii_digit());
        let is_last = lines.get(index + 1) == Some(&"up");
        number += usize::from(is_place);
        !is_place || is_last || number % step == 1 % step
    });
    kept.map(|(_, line)| *line).collect::<Vec<_>>().join("\n")
}

impl Window {
    /// Draws a frame in which a tablet sends events, and further frames until the window has received all of them.
    /// Places are relative to the middle of the model.
    fn pen_frame(&mut self, events: &[PenEvent]) {
        let middle = self.editor().shell.dock.rects[&Panel::Viewport].center();
        let placed = events.iter().map(|event| match event {
            PenEvent::Moved {
                at: [x, y],
                pressure,
                tilt_degrees,
            } => PenEvent::Moved {
                at: [x + middle.x, y + middle.y],
                pressure: *pressure,
                tilt_degrees: *tilt_degrees,
            },
            event => *event,
        });
        self.harness.state_mut().pens.receive(placed.collect::<Vec<_>>());
        loop {
            let mut raw = RawInput::default();
            self.harness.state_mut().pens.enter_frame(&mut raw, 1.0);
            self.harness.input_mut().events.extend(raw.events);
            self.harness.step();
            if !self.editor().pens.has_waiting() {
                return;
            }
        }
    }

    /// Plays a log, at the speed of [`FRAME`].
    fn play(&mut self, log: &str) {
        let events = read(log);
        let mut rest = events.as_slice();
        let mut time = 0.0;
        while !rest.is_empty() {
            time += FRAME;
            let count = rest.iter().take_while(|(at, _)| *at < time).count();
            let (now, later) = rest.split_at(count);
            self.pen_frame(&now.iter().map(|(_, event)| *event).collect::<Vec<_>>());
            rest = later;
        }
        self.settle();
    }

    /// Scrolls to a widget of a panel, and clicks it.
    fn unfold(&mut self, name: &str) {
        self.harness.get_by_label(name).scroll_to_me();
        self.settle();
        self.click(name);
    }

    /// Points of the strokes of the mask.
    fn penned(&self) -> Vec<Vec<StrokePoint>> {
        let list = self.list("mask").unwrap_or_default(); // Nothing is painted yet.
        list.strokes.iter().map(|stroke| stroke.points.clone()).collect()
    }
}

/// Angle between a pen and the normal of the surface in degrees, and the direction along the surface in which it leans.
fn lean(point: &StrokePoint) -> (f64, DVec3) {
    let shaft = point.shaft.expect("a pen that leans").direction();
    let normal = DVec3::from(point.normal.map(f64::from));
    let up = shaft.dot(normal);
    (
        up.clamp(-1.0, 1.0).acos().to_degrees(),
        (shaft - up * normal).normalize_or_zero(),
    )
}

const STROKE: &str = include_str!("pens/stroke.txt");

#[test]
fn the_pressure_and_the_tilt_of_a_recorded_pen_are_stored_at_each_place() {
    let mut window = painting_on("mask");
    window.play(STROKE);
    let [points] = window.penned().try_into().expect("one stroke");
    let camera = window.editor().views.model.navigation.camera;
    let [right, up] = [camera.right(), camera.up()].map(glam::Vec3::as_dvec3);
    let last = points.len() - 1;
    assert!(last > 15, "{last}");
    for (index, point) in points.iter().enumerate() {
        let share = index as f64 / last as f64;
        let expected = 0.2 + 0.6 * share;
        assert!(
            (f64::from(point.pressure) - expected).abs() < 0.05,
            "{index}: {} for {expected}",
            point.pressure
        );
        let (angle, toward) = lean(point);
        assert!(
            (angle - 40.0 * share).abs() < 3.0,
            "{index}: {angle} for {}",
            40.0 * share
        );
        if angle > 10.0 {
            assert!(
                toward.dot(right) > 0.5 && toward.dot(up).abs() < 0.2,
                "{index}: {toward}"
            );
        }
    }
    assert_eq!(window.steps(), 1);
}

#[test]
fn thirty_events_a_second_give_the_same_stroke_as_two_hundred_and_forty() {
    let [many, few] = [1, 8].map(|step| {
        let mut window = painting_on("mask");
        window.play(&thinned(STROKE, step));
        let [points] = window.penned().try_into().expect("one stroke");
        points
    });
    let reach = many[0].site.position.distance(many[many.len() - 1].site.position);
    assert!(many.len().abs_diff(few.len()) <= 2, "{} {}", many.len(), few.len());
    for point in &few {
        let place = |other: &&StrokePoint| other.site.position.distance(point.site.position);
        let near = many
            .iter()
            .min_by(|a, b| place(a).total_cmp(&place(b)))
            .expect("places");
        assert!(place(&near) < 0.03 * reach, "{} of {reach}", place(&near));
        assert!(
            (near.pressure - point.pressure).abs() < 0.05,
            "{} {}",
            near.pressure,
            point.pressure
        );
        assert!((lean(near).0 - lean(point).0).abs() < 3.0);
    }
}

#[test]
fn wrong_numbers_of_a_driver_give_a_stroke_whose_numbers_are_in_range() {
    let mut window = painting_on("mask");
    window.play(include_str!("pens/odd.txt"));
    let [points] = window.penned().try_into().expect("one stroke");
    assert!(points.len() > 15, "{}", points.len());
    for point in &points {
        assert!((0.0..=1.0).contains(&point.pressure) && point.site.position.is_finite());
        assert!(lean(point).0 <= 91.0);
    }
    let pressures = || points.iter().map(|point| point.pressure);
    // The stroke's points lie between the places with wrong numbers, so that the extremes are not reached exactly.
    assert!(pressures().any(|pressure| pressure > 0.8) && pressures().any(|pressure| pressure < 0.25));
    assert!(
        !points.iter().skip(1).any(|point| point.starts),
        "one way without a jump"
    );
}

#[test]
fn a_pen_that_leaves_ends_its_stroke_and_a_mouse_then_has_full_pressure() {
    let mut window = painting_on("mask");
    window.play(include_str!("pens/leaves.txt"));
    let [points] = window.penned().try_into().expect("one stroke");
    assert!(points.len() > 5 && points.iter().all(|point| (point.pressure - 0.5).abs() < 0.01));
    assert_eq!(window.steps(), 1);
    let way = window.way();
    window.drag_along(&way, PointerButton::Primary, egui::Modifiers::NONE);
    let [_, by_mouse] = window.penned().try_into().expect("two strokes");
    assert!(
        by_mouse
            .iter()
            .all(|point| point.pressure == 1.0 && point.shaft.is_none())
    );
}

#[test]
fn two_dabs_within_a_slow_frame_are_two_strokes() {
    let mut window = painting_on("mask");
    let events: Vec<PenEvent> = read(include_str!("pens/dabs.txt"))
        .into_iter()
        .map(|(_, event)| event)
        .collect();
    window.pen_frame(&events);
    window.settle();
    assert_eq!(window.penned().len(), 2);
    assert_eq!(window.steps(), 2);
}

#[test]
fn the_eraser_end_of_a_pen_erases() {
    let mut window = painting_on("mask");
    window.play(include_str!("pens/eraser.txt"));
    let list = window.list("mask").expect("strokes");
    assert_eq!(
        list.strokes.iter().map(|stroke| stroke.action).collect::<Vec<_>>(),
        [BrushAction::Erase]
    );
    assert_eq!(window.editor().shell.settings.brush.action, BrushAction::Paint);
}

#[test]
fn the_panel_says_that_pens_are_looked_for_and_can_flip_the_curve_of_a_fade() {
    let mut window = painting_on("mask");
    window.open(Panel::Parameters);
    window.unfold("Pen");
    assert!(window.says("Pens are looked for") && window.says("Tilt") && window.says("Pressure"));
    let fade = window.editor().shell.settings.brush.fade;
    window.harness.state_mut().shell.settings.brush.fade = Fade::Curve(fade.curve());
    window.unfold("Stamps");
    window.unfold("Fade: upside down");
    let Fade::Curve(curve) = window.editor().shell.settings.brush.fade else {
        panic!("the brush fades along its curve");
    };
    let points = curve.points();
    assert_eq!([points[0], points[points.len() - 1]], [[0.0, 0.0], [1.0, 1.0]]);
}
