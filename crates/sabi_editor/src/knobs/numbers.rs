//! Numbers: one bar for each, a dial for an angle, a ball for a direction, dice for a seed.

use std::f64::consts::TAU;
use std::hash::{BuildHasher, RandomState};

use egui::{Id, Rect, Sense, Ui, Vec2};
use egui_phosphor::regular as icon;
use sabi_engine::catalog::Knob;
use sabi_nodes::kind::Role;

use super::bar::NumberBar;
use super::boxes::{cut_square, share_of};
use super::buttons::sign_button;
use super::knob_ui::{DragValues, KnobUi};
use super::length::Quantity;
use super::values::{of_numbers, rounded};
use super::{KnobEvent, KnobRow, direction};

/// Names of the components of a vector.
const AXES: [&str; 4] = ["X", "Y", "Z", "W"];
/// Limit of random seeds, which are short enough to read aloud.
const SEEDS: u64 = 10_000;
/// Number of seeds that a drag over the whole bar goes through, since seeds have no range.
const SEEDS_OF_A_BAR: f64 = 50.0;
/// Degrees that the dial snaps to while Ctrl is held.
const SNAP_DEGREES: f64 = 15.0;

pub(super) fn show(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, numbers: [f64; 4]) {
    match (&row.knob.ty.role, row.knob.ty.components()) {
        (Role::Seed, _) => seed(ui, knob_ui, row, id, rect, numbers[0]),
        (Role::Angle, 1) => angle(ui, knob_ui, row, id, rect, numbers[0]),
        (_, 1) => {
            let bar = bar_of(knob_ui, row, id, rect, numbers[0]);
            one(ui, knob_ui, &bar);
        }
        _ => several(ui, knob_ui, row, id, rect, numbers),
    }
}

/// Bar for the only number of a parameter.
pub(super) fn bar_of<'a>(
    knob_ui: &KnobUi<'_>,
    row: &'a KnobRow<'a>,
    row_id: Id,
    rect: Rect,
    value: f64,
) -> NumberBar<'a> {
    NumberBar {
        id: row_id.with("bar"),
        row_id,
        row,
        rect,
        name: &row.knob.label,
        inside: "",
        value,
        ends: ends(row.knob),
        range: row.knob.ty.limits(),
        is_whole: row.knob.ty.is_whole(),
        measure: match row.knob.ty.role {
            Role::Angle => Quantity::Degrees,
            Role::Length => Quantity::Length(knob_ui.lengths),
            _ => Quantity::Plain,
        },
        is_filled: true,
    }
}

/// Shows the bar of the only number of a parameter, and requests changes.
pub(super) fn one(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, bar: &NumberBar<'_>) {
    if let Some(number) = number(ui, knob_ui, bar) {
        knob_ui.set(bar.row, of_numbers(&[number]));
    }
}

/// Shows a number; a length is also shown on the model while it is pointed at.
fn number(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, bar: &NumberBar<'_>) -> Option<f64> {
    let response = bar.show(ui, knob_ui);
    if response.is_active && matches!(bar.measure, Quantity::Length(_)) {
        let length = response.value.unwrap_or(bar.value);
        knob_ui.events.push(KnobEvent::ShowLength(length));
    }
    response.value
}

/// Values at both ends of the bar.
fn ends(knob: &Knob) -> [f64; 2] {
    match (knob.ty.soft.or(knob.ty.range), &knob.ty.role) {
        (None, Role::Angle) => [-180.0, 180.0],
        (None, _) if direction::is_one(knob) => [-1.0, 1.0],
        _ => knob.ty.slider(),
    }
}

fn several(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, mut numbers: [f64; 4]) {
    let count = row.knob.ty.components().min(AXES.len());
    let mut has_changed = false;
    for (at, axis) in AXES.iter().enumerate().take(count) {
        let name = format!("{} {axis}", row.knob.label);
        let whole = bar_of(knob_ui, row, id, share_of(rect, at, count), numbers[at]);
        let bar = NumberBar {
            id: id.with(at),
            name: &name,
            inside: axis,
            ..whole
        };
        if let Some(number) = number(ui, knob_ui, &bar) {
            numbers[at] = number;
            has_changed = true;
        }
    }
    if has_changed {
        knob_ui.set(row, of_numbers(&numbers[..count]));
    }
    if direction::is_one(row.knob) {
        direction::show(ui, knob_ui, row, id, rect, [numbers[0], numbers[1], numbers[2]]);
    }
}

fn angle(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect, degrees: f64) {
    let face = cut_square(&mut rect);
    let bar = bar_of(knob_ui, row, id, rect, degrees);
    one(ui, knob_ui, &bar);
    if let Some(turned) = dial(ui, knob_ui, row, id.with("dial"), face, degrees) {
        knob_ui.set(row, of_numbers(&[turned]));
    }
}

/// Shows a dial; 0 points to the right, and angles grow counterclockwise.
fn dial(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, face: Rect, degrees: f64) -> Option<f64> {
    // The keyboard uses the bar beside it.
    let response = ui.interact(face, id, Sense::DRAG);
    let [is_fine, snaps] = ui.input(|input| [input.modifiers.shift, input.modifiers.command || input.modifiers.ctrl]);
    let middle = face.center();
    if ui.is_rect_visible(face) {
        let theme = knob_ui.theme;
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
    let (delta, drag) = knob_ui.drag_delta(&response, |_| Some(DragValues::of([degrees, 0.0, 0.0])))?;
    let now = drag.place() - middle;
    let turn = f64::from((now - delta).angle() - now.angle());
    // The shorter way around, so that a drag can pass 180°.
    let turn = turn - (turn / TAU).round() * TAU;
    let speed = if is_fine { 0.1 } else { 1.0 };
    let exact = row.knob.ty.nearest(drag.values.exact[0] + turn.to_degrees() * speed);
    drag.values.exact[0] = exact;
    let step = match (snaps, is_fine) {
        (true, _) => SNAP_DEGREES,
        (false, true) => 0.1,
        (false, false) => 1.0,
    };
    Some(row.knob.ty.nearest(rounded(exact, step)))
}

fn seed(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect, seed: f64) {
    let label = &row.knob.label;
    let [dice, more, less] = std::array::from_fn(|_| cut_square(&mut rect));
    let whole = bar_of(knob_ui, row, id, rect, seed);
    let bar = NumberBar {
        ends: [0.0, SEEDS_OF_A_BAR],
        is_filled: false,
        ..whole
    };
    one(ui, knob_ui, &bar);
    let steps = [
        (less, "less", icon::MINUS, -1.0, format!("{label}: one less")),
        (more, "more", icon::PLUS, 1.0, format!("{label}: one more")),
    ];
    for (place, salt, sign, step, name) in steps {
        if sign_button(ui, knob_ui, id.with(salt), place, sign, &name).clicked() {
            let next = row.knob.ty.nearest(seed + step);
            knob_ui.set(row, of_numbers(&[next]));
        }
    }
    let name = format!("{label}: random seed");
    if sign_button(ui, knob_ui, id.with("dice"), dice, icon::DICE_FIVE, &name).clicked() {
        knob_ui.set(row, of_numbers(&[random_seed_other_than(seed)]));
    }
}

/// Random seed that differs from the last one.
fn random_seed_other_than(seed: f64) -> f64 {
    loop {
        let random = (RandomState::new().hash_one(0) % SEEDS) as f64;
        if random != seed {
            return random;
        }
    }
}
