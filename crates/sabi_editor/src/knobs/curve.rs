//! Curves: points that are dragged, the selected one in numbers, and presets.

mod shape;

use egui::{Id, Key, Modifiers, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo};
use egui_phosphor::regular as icon;

pub(super) use self::shape::CurveView;
use self::shape::height_at;
use super::KnobRow;
use super::bar::NumberBar;
use super::boxes::{cut_square, share_of, strip};
use super::buttons::{focus_ring, sign_button};
use super::keys::arrows;
use super::knob_ui::{Drag, DragValues, KnobUi};
use super::numbers::bar_of;
use super::values::{KnobValue, of_points, read, rounded, sort_keeping};
use crate::theme::space;

const HEIGHT: f32 = 140.0;
/// Margin for points at the borders, points.
const MARGIN: f32 = 7.0;
/// Distance at which the pointer takes a point, points.
const NEAR: f32 = 9.0;
/// Distance outside of the box at which a dragged point is removed, points.
const AWAY: f32 = 28.0;
const DIGITS: f64 = 0.001;
const STEP: f64 = 0.01;
/// Steps of the stairs preset.
const STAIRS: usize = 4;
/// Usual range of curves.
const USUAL: [f64; 2] = [0.0, 1.0];

pub(super) fn show(
    ui: &mut Ui,
    knob_ui: &mut KnobUi<'_>,
    row: &KnobRow<'_>,
    id: Id,
    rect: Rect,
    points: Vec<[f64; 2]>,
) {
    let mut curve = Curve {
        selected: knob_ui.selected(id, points.len()),
        room: row.knob.ty.components(),
        usual: row.knob.ty.soft.unwrap_or(USUAL),
        range: row.knob.ty.range.unwrap_or([f64::MIN, f64::MAX]),
        points,
    };
    let mut has_changed = curve.presets(ui, knob_ui, row, id, rect);
    let area = strip(ui, HEIGHT);
    let response = ui.interact(area, id.with("curve"), Sense::click_and_drag());
    let view = curve.view(knob_ui, row, &response);
    has_changed |= curve.dragged(knob_ui, row, &response, &view);
    has_changed |= curve.clicked(knob_ui, id, &response, &view);
    has_changed |= curve.keyed(ui, &response);
    curve.describe(ui, row, &response);
    if ui.is_rect_visible(area) {
        curve.paint(ui, knob_ui, &response, &view);
    }
    has_changed |= curve.numbers(ui, knob_ui, row, id);
    knob_ui.memory.selected = Some((id, curve.selected));
    if has_changed {
        knob_ui.set(row, of_points(&curve.points));
    }
}

struct Curve {
    points: Vec<[f64; 2]>,
    selected: usize,
    room: usize,
    usual: [f64; 2],
    range: [f64; 2],
}

impl Curve {
    /// Shown part of the plane. It stays the same during a drag, or the curve would move away from the pointer.
    fn view(&self, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, response: &Response) -> CurveView {
        let rect = response.rect.shrink(MARGIN);
        let dragged = knob_ui.memory.drag.as_ref().filter(|_| knob_ui.is_dragged(response.id));
        let at_first = dragged.and_then(|drag| read(row.knob, drag.values.all.as_ref()?));
        match at_first {
            Some(KnobValue::Points(points)) => CurveView::of(rect, self.usual, &points),
            _ => CurveView::of(rect, self.usual, &self.points),
        }
    }

    fn near(&self, view: &CurveView, place: Pos2) -> Option<usize> {
        let far = |at: &usize| view.place(self.points[*at]).distance(place);
        let nearest = (0..self.points.len()).min_by(|left, right| far(left).total_cmp(&far(right)))?;
        (far(&nearest) <= NEAR).then_some(nearest)
    }

    fn settled(&self, point: [f64; 2]) -> [f64; 2] {
        let [low, high] = self.range;
        point.map(|number| rounded(number, DIGITS).max(low).min(high))
    }

    fn add(&mut self, point: [f64; 2]) -> bool {
        if self.points.len() >= self.room {
            return false;
        }
        let point = self.settled(point);
        self.selected = self.points.partition_point(|other| other[0] <= point[0]);
        self.points.insert(self.selected, point);
        true
    }

    /// Adds a point on the curve, halfway to the next one.
    fn add_behind(&mut self) -> bool {
        let [x, _] = self.points[self.selected];
        let next = self
            .points
            .get(self.selected + 1)
            .map_or(self.usual[1], |point| point[0]);
        let middle = (x + next) / 2.0;
        self.add([middle, height_at(&self.points, middle)])
    }

    /// Removes the selected point, unless it is the only one. Returns whether it was removed.
    fn remove(&mut self) -> bool {
        if self.points.len() < 2 {
            return false;
        }
        self.points.remove(self.selected);
        self.selected = self.selected.saturating_sub(1);
        true
    }

    fn move_to(&mut self, point: [f64; 2]) {
        let [low, high] = self.range;
        self.points[self.selected] = point.map(|number| number.max(low).min(high));
        self.selected = sort_keeping(&mut self.points, self.selected, |point| point[0]);
    }

    fn full(&self) -> String {
        let room = self.room;
        format!("A curve holds no more than {room} points: take one out before you add another.")
    }

    fn dragged(&mut self, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, response: &Response, view: &CurveView) -> bool {
        let values_at = |origin: Pos2| {
            self.selected = self.near(view, origin)?;
            let [x, y] = self.points[self.selected];
            Some(DragValues {
                exact: [x, y, 0.0],
                index: self.selected,
                all: Some(of_points(&self.points)),
            })
        };
        let is_fine = response.ctx.input(|input| input.modifiers.shift);
        let Some((delta, drag)) = knob_ui.drag_delta(response, values_at) else {
            return false;
        };
        let speed = if is_fine { 0.1 } else { 1.0 };
        let [across, up] = view.scale();
        drag.values.exact[0] += f64::from(delta.x) * across * speed;
        drag.values.exact[1] -= f64::from(delta.y) * up * speed;
        self.take(row, drag, view)
    }

    /// Applies the whole drag to the points at its beginning.
    fn take(&mut self, row: &KnobRow<'_>, drag: &Drag, view: &CurveView) -> bool {
        let all = drag.values.all.as_ref();
        let Some(KnobValue::Points(points)) = all.and_then(|all| read(row.knob, all)) else {
            return false;
        };
        self.points = points;
        self.selected = drag.values.index.min(self.points.len() - 1);
        let is_away = !view.rect.expand(AWAY).contains(drag.place());
        if !(is_away && self.remove()) {
            let [x, y, _] = drag.values.exact;
            let inside = [x.clamp(view.x[0], view.x[1]), y.clamp(view.y[0], view.y[1])];
            self.move_to(self.settled(inside));
        }
        true
    }

    fn clicked(&mut self, knob_ui: &mut KnobUi<'_>, id: Id, response: &Response, view: &CurveView) -> bool {
        let Some(place) = response.interact_pointer_pos().filter(|_| response.clicked()) else {
            return false;
        };
        response.request_focus();
        match (self.near(view, place), response.double_clicked()) {
            (Some(near), false) => {
                self.selected = near;
                false
            }
            (Some(near), true) => {
                self.selected = near;
                self.remove()
            }
            (None, false) => false,
            (None, true) => {
                let is_added = self.add(view.point(place));
                if !is_added {
                    knob_ui.fault(id, self.full());
                }
                is_added
            }
        }
    }

    fn keyed(&mut self, ui: &Ui, response: &Response) -> bool {
        let [right, down] = arrows(ui, response);
        if !response.has_focus() {
            return false;
        }
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if pressed(Key::PageDown) {
            self.selected = (self.selected + 1).min(self.points.len() - 1);
        }
        if pressed(Key::PageUp) {
            self.selected = self.selected.saturating_sub(1);
        }
        if pressed(Key::Delete) || pressed(Key::Backspace) {
            return self.remove();
        }
        if pressed(Key::Insert) {
            return self.add_behind();
        }
        if right == 0.0 && down == 0.0 {
            return false;
        }
        let [x, y] = self.points[self.selected];
        self.move_to(self.settled([x + right * STEP, y - down * STEP]));
        true
    }

    fn describe(&self, ui: &Ui, row: &KnobRow<'_>, response: &Response) {
        let [x, y] = self.points[self.selected];
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), y, &row.knob.label));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            let count = self.points.len();
            let number = self.selected + 1;
            node.set_value(format!("point {number} of {count} at {x}, {y}"));
        });
    }

    fn presets(&mut self, ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) -> bool {
        let [low, high] = self.usual;
        let at = |x: f64, y: f64| [x, y].map(|share| low + share * (high - low));
        let stairs = STAIRS.min(self.room / 2).max(1);
        let stair = |step: usize| {
            let [begin, end] = [step, step + 1].map(|at| at as f64 / stairs as f64);
            let height = if stairs > 1 {
                step as f64 / (stairs - 1) as f64
            } else {
                0.5
            };
            [at(begin, height), at(end, height)].map(|point| self.settled(point))
        };
        let flipped = |[x, y]: &[f64; 2]| [*x, rounded(low + high - y, DIGITS)];
        let shapes = [
            ("a line", vec![at(0.0, 0.0), at(1.0, 1.0)]),
            (
                "ease in and out",
                [[0.0, 0.0], [0.25, 0.104], [0.75, 0.896], [1.0, 1.0]]
                    .map(|[x, y]| at(x, y))
                    .to_vec(),
            ),
            ("upside down", self.points.iter().map(flipped).collect()),
            ("steps", (0..stairs).flat_map(stair).collect()),
        ];
        let mut chosen = None;
        for (index, (what, points)) in shapes.into_iter().enumerate() {
            let place = Rect::from_min_size(
                rect.min + Vec2::new(index as f32 * (rect.height() + 2.0), 0.0),
                Vec2::splat(rect.height()),
            );
            let name = format!("{}: {what}", row.knob.label);
            let response = sign_button(ui, knob_ui, id.with(what), place, "", &name);
            let view = CurveView::of(place.shrink(5.0), self.usual, &points);
            view.draw(ui.painter(), &points, Stroke::new(1.5, knob_ui.theme.quiet));
            if response.clicked() && points.len() <= self.room {
                chosen = Some(points);
            }
        }
        let has_changed = chosen.is_some();
        if let Some(points) = chosen {
            self.selected = self.selected.min(points.len() - 1);
            self.points = points.iter().map(|point| self.settled(*point)).collect();
        }
        has_changed
    }

    /// Shows the selected point in numbers.
    fn numbers(&mut self, ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id) -> bool {
        let label = &row.knob.label;
        let mut rect = strip(ui, space::ROW);
        let remove = cut_square(&mut rect);
        let add = cut_square(&mut rect);
        let mut point = self.points[self.selected];
        let mut has_moved = false;
        for (axis, word) in ["X", "Y"].into_iter().enumerate() {
            let name = format!("{label} {word}");
            let whole = bar_of(knob_ui, row, id, share_of(rect, axis, 2), point[axis]);
            let bar = NumberBar {
                id: id.with(word),
                name: &name,
                inside: word,
                ends: self.usual,
                ..whole
            };
            if let Some(number) = bar.show(ui, knob_ui).value {
                point[axis] = number;
                has_moved = true;
            }
        }
        if has_moved {
            self.move_to(point);
        }
        let is_added = sign_button(
            ui,
            knob_ui,
            id.with("add"),
            add,
            icon::PLUS,
            &format!("{label}: add a point"),
        )
        .clicked();
        let has_room = !is_added || self.add_behind();
        if !has_room {
            knob_ui.fault(id, self.full());
        }
        let name = format!("{label}: take the point out");
        let is_removed = sign_button(ui, knob_ui, id.with("remove"), remove, icon::MINUS, &name).clicked();
        has_moved || is_added && has_room || is_removed && self.remove()
    }

    fn paint(&self, ui: &Ui, knob_ui: &KnobUi<'_>, response: &Response, view: &CurveView) {
        let theme = knob_ui.theme;
        let painter = ui.painter();
        painter.rect_filled(response.rect, space::CORNER, theme.canvas);
        for quarter in 0..=4 {
            let share = quarter as f32 / 4.0;
            let grid = (1.0, theme.grid);
            painter.vline(egui::lerp(view.rect.x_range(), share), view.rect.y_range(), grid);
            painter.hline(view.rect.x_range(), egui::lerp(view.rect.y_range(), share), grid);
        }
        painter.rect_stroke(response.rect, space::CORNER, (1.0, theme.line), StrokeKind::Inside);
        let inside = painter.with_clip_rect(response.rect.intersect(ui.clip_rect()));
        view.draw(&inside, &self.points, Stroke::new(2.0, theme.text));
        let pointed = response.hover_pos().and_then(|place| self.near(view, place));
        for (at, point) in self.points.iter().enumerate() {
            let is_selected = at == self.selected;
            let fill = if is_selected { theme.accent } else { theme.canvas };
            let line = if is_selected { theme.accent } else { theme.quiet };
            let radius = if pointed == Some(at) { 5.5 } else { 4.0 };
            inside.circle(view.place(*point), radius, fill, (1.5, line));
        }
        focus_ring(ui, knob_ui, response);
    }
}
