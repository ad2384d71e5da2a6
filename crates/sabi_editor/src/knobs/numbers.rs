//! Numbers: one bar for each, a dial for an angle, a ball for a direction, dice for a seed.

use std::f64::consts::TAU;
use std::hash::{BuildHasher, RandomState};

use egui::{Id, Rect, Sense, Ui, Vec2};
use egui_phosphor::regular as icon;
use sabi_engine::catalog::{Knob, KnobRole};

use super::bar::Bar;
use super::boxes::{cut_square, share_of};
use super::buttons::sign_button;
use super::knob_ui::{Grip, KnobUi};
use super::length::Measure;
use super::values::{of_numbers, rounded};
use super::{KnobEvent, KnobRow, direction};

/// Names of the components of a vector.
const AXES: [&str; 4] = ["X", "Y", "Z", "W"];
/// Greatest rolled seed, short enough to be read out.
const SEEDS: u64 = 10_000;
/// Seeds that a drag over the whole bar goes through, since seeds have no range.
const SEEDS_OF_A_WAY: f64 = 50.0;
/// Degrees that the dial snaps to while Ctrl is held.
const DETENT: f64 = 15.0;

pub(super) fn show(ui: &mut Ui, ask: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, numbers: [f64; 4]) {
    match (&row.knob.ty.role, row.knob.ty.components()) {
        (KnobRole::Seed, _) => seed(ui, ask, row, id, rect, numbers[0]),
        (KnobRole::Angle, 1) => angle(ui, ask, row, id, rect, numbers[0]),
        (_, 1) => {
            let bar = bar_of(ask, row, id, rect, numbers[0]);
            one(ui, ask, &bar);
        }
        _ => several(ui, ask, row, id, rect, numbers),
    }
}

/// Bar for the only number of a parameter.
pub(super) fn bar_of<'a>(ask: &KnobUi<'_>, row: &'a KnobRow<'a>, row_id: Id, rect: Rect, value: f64) -> Bar<'a> {
    Bar {
        id: row_id.with("bar"),
        row_id,
        row,
        rect,
        name: &row.knob.label,
        inside: "",
        value,
        ends: ends(row.knob),
        range: row.knob.ty.range,
        is_whole: row.knob.ty.is_whole(),
        measure: match row.knob.ty.role {
            KnobRole::Angle => Measure::Degrees,
            KnobRole::Length => Measure::Length(ask.lengths),
            _ => Measure::Plain,
        },
        is_filled: true,
    }
}

/// Shows the bar of the only number of a parameter, and asks for changes.
pub(super) fn one(ui: &mut Ui, ask: &mut KnobUi<'_>, bar: &Bar<'_>) {
    let asked = number(ui, ask, bar);
    if let Some(number) = asked {
        ask.set(bar.row, of_numbers(&[number]));
    }
}

/// Shows a number; a length is also shown on the model while it is pointed at.
fn number(ui: &mut Ui, ask: &mut KnobUi<'_>, bar: &Bar<'_>) -> Option<f64> {
    let answer = bar.show(ui, ask);
    if answer.is_held && matches!(bar.measure, Measure::Length(_)) {
        let length = answer.asked.unwrap_or(bar.value);
        ask.events.push(KnobEvent::ShowLength(length));
    }
    answer.asked
}

/// Values at both ends of the bar.
fn ends(knob: &Knob) -> [f64; 2] {
    match (knob.ty.soft.or(knob.ty.range), &knob.ty.role) {
        (None, KnobRole::Angle) => [-180.0, 180.0],
        (None, _) if direction::is_one(knob) => [-1.0, 1.0],
        _ => knob.ty.slider(),
    }
}

fn several(ui: &mut Ui, ask: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, mut numbers: [f64; 4]) {
    let count = row.knob.ty.components().min(AXES.len());
    let mut asked = false;
    for (at, axis) in AXES.iter().enumerate().take(count) {
        let name = format!("{} {axis}", row.knob.label);
        let whole = bar_of(ask, row, id, share_of(rect, at, count), numbers[at]);
        let bar = Bar {
            id: id.with(at),
            name: &name,
            inside: axis,
            ..whole
        };
        if let Some(number) = number(ui, ask, &bar) {
            numbers[at] = number;
            asked = true;
        }
    }
    if asked {
        ask.set(row, of_numbers(&numbers[..count]));
    }
    if direction::is_one(row.knob) {
        direction::show(ui, ask, row, id, rect, [numbers[0], numbers[1], numbers[2]]);
    }
}

fn angle(ui: &mut Ui, ask: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect, degrees: f64) {
    let face = cut_square(&mut rect);
    let bar = bar_of(ask, row, id, rect, degrees);
    one(ui, ask, &bar);
    if let Some(turned) = dial(ui, ask, row, id.with("dial"), face, degrees) {
        ask.set(row, of_numbers(&[turned]));
    }
}

/// Shows a dial; 0 points to the right, and angles grow counterclockwise.
fn dial(ui: &Ui, ask: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, face: Rect, degrees: f64) -> Option<f64> {
    // The keyboard uses the bar beside it.
    let response = ui.interact(face, id, Sense::DRAG);
    let [is_fine, is_held_by_detents] =
        ui.input(|input| [input.modifiers.shift, input.modifiers.command || input.modifiers.ctrl]);
    let middle = face.center();
    if ui.is_rect_visible(face) {
        let theme = ask.theme;
        let radius = face.width() / 2.0 - 2.0;
        let ground = if response.hovered() {
            theme.hovered
        } else {
            theme.raised
        };
        let turned = degrees.to_radians();
        let hand = Vec2::new(turned.cos() as f32, -turned.sin() as f32) * (radius - 3.0);
        let painter = ui.painter();
        painter.circle(middle, radius, ground, (1.0, theme.line));
        painter.line_segment([middle, middle + hand], (1.5, theme.text));
        painter.circle_filled(middle + hand, 2.0, theme.accent);
    }
    let (way, drag) = ask.pull(&response, |_| Some(Grip::of([degrees, 0.0, 0.0])))?;
    let now = drag.place() - middle;
    let turn = f64::from((now - way).angle() - now.angle());
    // The shorter way around, so that a drag can pass 180°.
    let turn = turn - (turn / TAU).round() * TAU;
    let speed = if is_fine { 0.1 } else { 1.0 };
    let [low, high] = row.knob.ty.range.unwrap_or([f64::MIN, f64::MAX]);
    let exact = (drag.grip.exact[0] + turn.to_degrees() * speed).max(low).min(high);
    drag.grip.exact[0] = exact;
    let step = match (is_held_by_detents, is_fine) {
        (true, _) => DETENT,
        (false, true) => 0.1,
        (false, false) => 1.0,
    };
    Some(rounded(exact, step).max(low).min(high))
}

fn seed(ui: &mut Ui, ask: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect, seed: f64) {
    let label = &row.knob.label;
    let highest = f64::from(u32::MAX);
    let [dice, more, less] = std::array::from_fn(|_| cut_square(&mut rect));
    let whole = bar_of(ask, row, id, rect, seed);
    let bar = Bar {
        ends: [0.0, SEEDS_OF_A_WAY],
        range: Some([0.0, highest]),
        is_whole: true,
        is_filled: false,
        ..whole
    };
    one(ui, ask, &bar);
    let steps = [
        (less, "less", icon::MINUS, -1.0, format!("{label}: one less")),
        (more, "more", icon::PLUS, 1.0, format!("{label}: one more")),
    ];
    for (place, salt, sign, step, name) in steps {
        if sign_button(ui, ask, id.with(salt), place, sign, &name).clicked() {
            let next = (seed + step).clamp(0.0, highest);
            ask.set(row, of_numbers(&[next]));
        }
    }
    let name = format!("{label}: another one by chance");
    if sign_button(ui, ask, id.with("dice"), dice, icon::DICE_FIVE, &name).clicked() {
        ask.set(row, of_numbers(&[rolled_unlike(seed)]));
    }
}

/// Random seed that differs from the last one.
fn rolled_unlike(seed: f64) -> f64 {
    loop {
        let rolled = (RandomState::new().hash_one(0) % SEEDS) as f64;
        if rolled != seed {
            return rolled;
        }
    }
}
