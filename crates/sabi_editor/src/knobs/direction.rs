//! Directions: a ball that is turned by drags, and the six directions of the axes.

use egui::{Id, Pos2, Rect, Response, Sense, Shape, Ui, Vec2, WidgetInfo, WidgetType, accesskit};
use glam::{DQuat, DVec3};
use sabi_engine::catalog::Knob;
use sabi_nodes::kind::Role;

use super::KnobRow;
use super::boxes::share_of;
use super::buttons::{WordState, focus_ring, word_button};
use super::keys::arrows;
use super::knob_ui::{DragValues, KnobUi};
use super::text_painting::write;
use super::values::{of_numbers, rounded};
use crate::theme::{Theme, space, type_size};

const BALL: f32 = 68.0;
/// Degrees of an arrow key.
const STEP: f64 = 5.0;
/// Digits of directions.
const DIGITS: f64 = 1e-4;
const WAYS: [(&str, DVec3); 6] = [
    ("+X", DVec3::X),
    ("+Y", DVec3::Y),
    ("+Z", DVec3::Z),
    ("−X", DVec3::NEG_X),
    ("−Y", DVec3::NEG_Y),
    ("−Z", DVec3::NEG_Z),
];

/// Returns whether a parameter is a direction: a plain vector of three components with a name such as `direction`.
pub(super) fn is_one(knob: &Knob) -> bool {
    knob.ty.components() == 3
        && knob.ty.role == Role::Plain
        && matches!(knob.name.as_str(), "toward" | "direction" | "along" | "axis")
}

/// View of the ball: a little from above and from the side, so that no axis is seen as a point.
struct BallView {
    middle: Pos2,
    radius: f32,
    right: DVec3,
    up: DVec3,
    back: DVec3,
}

impl BallView {
    fn of(ball: Rect) -> BallView {
        let back = DVec3::new(0.5, 0.42, 0.76).normalize();
        let right = DVec3::Y.cross(back).normalize();
        BallView {
            middle: ball.center(),
            radius: ball.width() / 2.0 - 2.0,
            right,
            up: back.cross(right),
            back,
        }
    }

    /// Place of a point of the unit ball in the view, and whether it is on the near side.
    fn place(&self, point: DVec3) -> (Pos2, bool) {
        let across = Vec2::new(point.dot(self.right) as f32, -point.dot(self.up) as f32);
        (self.middle + across * self.radius, point.dot(self.back) >= 0.0)
    }

    /// Direction after a turn of the ball by these radians to the right and down.
    fn turned(&self, direction: DVec3, right: f64, down: f64) -> DVec3 {
        let turn = DQuat::from_axis_angle(self.up, right) * DQuat::from_axis_angle(self.right, down);
        (turn * direction).normalize_or(DVec3::Y)
    }
}

pub(super) fn show(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, column: Rect, numbers: [f64; 3]) {
    // A direction without a length points up, as nodes read it.
    let direction = DVec3::from(numbers).normalize_or(DVec3::Y);
    let (_, strip) = ui.allocate_space(Vec2::new(ui.available_width(), BALL));
    let strip = strip.with_min_x(column.left());
    let ball = Rect::from_min_size(strip.min, Vec2::splat(BALL));
    let chosen = turn(ui, knob_ui, row, id.with("ball"), ball, direction);
    let buttons = strip.with_min_x(ball.right() + space::USUAL);
    let chosen = chosen.or_else(|| ways(ui, knob_ui, row, id, buttons, direction));
    if let Some(direction) = chosen {
        let digits = direction.to_array().map(|number| rounded(number, DIGITS));
        knob_ui.set(row, of_numbers(&digits));
    }
}

fn ways(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, within: Rect, now: DVec3) -> Option<DVec3> {
    let height = space::ROW;
    let top = within.center().y - height - 1.0;
    let mut chosen = None;
    for (at, (word, way)) in WAYS.iter().enumerate() {
        let line = within.with_min_y(top + (height + 2.0) * (at / 3) as f32);
        let rect = share_of(line.with_max_y(line.top() + height), at % 3, 3);
        let is_chosen = !row.differs && way.dot(now) > 1.0 - 1e-6;
        let response = word_button(ui, knob_ui, id.with(word), rect, word, WordState::of(row, is_chosen));
        response.widget_info(|| {
            let name = format!("{} {word}", row.knob.label);
            WidgetInfo::selected(WidgetType::RadioButton, ui.is_enabled(), is_chosen, name)
        });
        if response.clicked() {
            chosen = Some(*way);
        }
    }
    chosen
}

fn turn(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, ball: Rect, direction: DVec3) -> Option<DVec3> {
    let response = ui.interact(ball, id, Sense::click_and_drag());
    let view = BallView::of(ball);
    response.widget_info(|| {
        let name = format!("{} as a ball", row.knob.label);
        WidgetInfo::labeled(WidgetType::Other, ui.is_enabled(), name)
    });
    ui.ctx()
        .accesskit_node_builder(id, |node| node.set_role(accesskit::Role::Group));
    if ui.is_rect_visible(ball) {
        paint(ui, knob_ui, &response, &view, direction);
    }
    if response.clicked() {
        response.request_focus();
    }
    let speed = if ui.input(|input| input.modifiers.shift) {
        0.1
    } else {
        1.0
    };
    if let Some((delta, drag)) = knob_ui.drag_delta(&response, |_| Some(DragValues::of(direction.to_array()))) {
        let [right, down] = [delta.x, delta.y].map(|way| f64::from(way / view.radius) * speed);
        let turned = view.turned(DVec3::from(drag.values.exact), right, down);
        drag.values.exact = turned.to_array();
        return Some(turned);
    }
    let [right, down] = arrows(ui, &response);
    let [right, down] = [right, down].map(|steps| (steps * STEP).to_radians());
    (right != 0.0 || down != 0.0).then(|| view.turned(direction, right, down))
}

fn paint(ui: &Ui, knob_ui: &KnobUi<'_>, response: &Response, view: &BallView, direction: DVec3) {
    let theme = knob_ui.theme;
    let painter = ui.painter();
    let ground = if response.hovered() {
        theme.hovered
    } else {
        theme.raised
    };
    painter.circle(view.middle, view.radius, ground, (1.0, theme.line));
    rings(ui, theme, view);
    for (name, axis) in [("X", DVec3::X), ("Y", DVec3::Y), ("Z", DVec3::Z)] {
        let (place, _) = view.place(axis * 0.86);
        let around = Rect::from_center_size(place, Vec2::splat(12.0));
        write(
            painter,
            around,
            egui::Align2::CENTER_CENTER,
            name,
            type_size::SMALL - 1.5,
            theme.quiet,
        );
    }
    let (tip, is_near) = view.place(direction);
    if is_near {
        painter.line_segment([view.middle, tip], (2.0, theme.accent));
        painter.circle_filled(tip, 4.0, theme.accent);
    } else {
        // A direction that points away from the eye is drawn through the ball.
        let dim = theme.accent.gamma_multiply(0.6);
        painter.line_segment([view.middle, tip], (1.0, dim));
        painter.circle(tip, 3.5, ground, (1.5, dim));
    }
    focus_ring(ui, knob_ui, response);
}

/// Draws the near halves of the three circles between the axes.
fn rings(ui: &Ui, theme: &Theme, view: &BallView) {
    const PARTS: usize = 40;
    let line = theme.quiet.gamma_multiply(0.45);
    for (one, other) in [(DVec3::X, DVec3::Z), (DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z)] {
        let point = |part: usize| {
            let turn = std::f64::consts::TAU * part as f64 / PARTS as f64;
            view.place(one * turn.cos() + other * turn.sin())
        };
        let parts = (0..PARTS).filter_map(|part| {
            let [(begin, is_begin_near), (end, is_end_near)] = [point(part), point(part + 1)];
            (is_begin_near && is_end_near).then(|| Shape::line_segment([begin, end], (1.0, line)))
        });
        ui.painter().extend(parts);
    }
}
