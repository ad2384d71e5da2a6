//! Gradients: a ramp with stops that are dragged, the selected one in numbers, and a menu of gradients to begin with.

pub(super) mod presets;

use egui::{
    Align2, Color32, Id, Key, Mesh, Modifiers, Painter, Pos2, Rect, Response, Rgba, Sense, Shape, StrokeKind, Ui, Vec2,
    WidgetInfo,
};
use egui_phosphor::regular as icon;
use sabi_nodes::kind::WrittenStop;

use super::bar::NumberBar;
use super::boxes::{cut_square, strip};
use super::buttons::{focus_ring, sign_button};
use super::color::swatch_and_code;
use super::keys::arrows;
use super::knob_ui::{Drag, DragValues, KnobUi};
use super::numbers::bar_of;
use super::text_painting::write;
use super::values::{GradientStop, KnobValue, of_stops, read, rounded, sort_keeping};
use super::{KnobEvent, KnobRow};
use crate::theme::{space, type_size};
use presets::PresetChoice;

const RAMP: f32 = 20.0;
const HANDLES: f32 = 13.0;
/// Distance at which the pointer takes a stop, points.
const NEAR: f32 = 7.0;
/// Distance from the ramp at which a dragged stop is removed, points.
const AWAY: f32 = 28.0;
/// Rounding of positions, and the step of an arrow key.
const DIGITS: f64 = 0.001;
const STEP: f64 = 0.01;

pub(super) fn show(
    ui: &mut Ui,
    knob_ui: &mut KnobUi<'_>,
    row: &KnobRow<'_>,
    id: Id,
    rect: Rect,
    stops: Vec<GradientStop>,
) {
    let mut gradient = Gradient {
        selected: knob_ui.selected(id, stops.len()),
        room: row.knob.ty.components(),
        stops,
    };
    let mut has_changed = gradient.buttons(ui, knob_ui, row, id, rect);
    let area = strip(ui, RAMP + HANDLES);
    let ramp = Ramp(
        area.with_max_y(area.top() + RAMP)
            .shrink2(Vec2::new(HANDLES / 2.0, 0.0)),
    );
    let response = ui.interact(area, id.with("ramp"), Sense::click_and_drag());
    has_changed |= gradient.dragged(knob_ui, row, &response, &ramp);
    has_changed |= gradient.clicked(knob_ui, id, &response, &ramp);
    has_changed |= gradient.keyed(ui, &response);
    gradient.describe(ui, row, &response);
    if ui.is_rect_visible(area) {
        gradient.paint(ui, knob_ui, &response, &ramp);
    }
    has_changed |= gradient.numbers(ui, knob_ui, row, id);
    knob_ui.memory.selected = Some((id, gradient.selected));
    if has_changed {
        knob_ui.set(row, of_stops(&gradient.stops));
    }
}

impl KnobUi<'_> {
    /// Index of the selected one of several stops or points.
    pub(super) fn selected(&self, id: Id, count: usize) -> usize {
        let selected = self.memory.selected.filter(|(of, _)| *of == id);
        selected.map_or(0, |(_, at)| at.min(count.saturating_sub(1)))
    }
}

/// Rectangle in which colors are drawn by their position.
struct Ramp(Rect);

impl Ramp {
    fn x(&self, at: f64) -> f32 {
        egui::lerp(self.0.x_range(), at as f32)
    }

    fn at(&self, x: f32) -> f64 {
        rounded(f64::from((x - self.0.left()) / self.0.width()), DIGITS).clamp(0.0, 1.0)
    }
}

struct Gradient {
    stops: Vec<GradientStop>,
    selected: usize,
    room: usize,
}

impl Gradient {
    fn near(&self, ramp: &Ramp, place: Pos2) -> Option<usize> {
        let far = |at: &usize| (ramp.x(self.stops[*at].at) - place.x).abs();
        let nearest = (0..self.stops.len()).min_by(|left, right| far(left).total_cmp(&far(right)))?;
        (far(&nearest) <= NEAR).then_some(nearest)
    }

    fn add(&mut self, at: f64) -> bool {
        if self.stops.len() >= self.room {
            return false;
        }
        let color = color_at(&self.stops, at);
        self.selected = self.stops.partition_point(|stop| stop.at <= at);
        self.stops.insert(self.selected, GradientStop { at, color });
        true
    }

    /// Removes the selected stop, unless it is the only one. Returns whether it was removed.
    fn remove(&mut self) -> bool {
        if self.stops.len() < 2 {
            return false;
        }
        self.stops.remove(self.selected);
        self.selected = self.selected.saturating_sub(1);
        true
    }

    fn move_to(&mut self, at: f64) {
        self.stops[self.selected].at = at.clamp(0.0, 1.0);
        self.selected = sort_keeping(&mut self.stops, self.selected, |stop| stop.at);
    }

    fn full(&self) -> String {
        let room = self.room;
        format!("A gradient holds no more than {room} stops: take one out before you add another.")
    }

    fn dragged(&mut self, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, response: &Response, ramp: &Ramp) -> bool {
        let values_at = |origin: Pos2| {
            self.selected = match self.near(ramp, origin) {
                Some(near) => near,
                None if self.add(ramp.at(origin.x)) => self.selected,
                None => return None,
            };
            Some(DragValues {
                exact: [self.stops[self.selected].at, 0.0, 0.0],
                index: self.selected,
                all: Some(of_stops(&self.stops)),
            })
        };
        let Some((delta, drag)) = knob_ui.drag_delta(response, values_at) else {
            return false;
        };
        drag.values.exact[0] += f64::from(delta.x / ramp.0.width());
        self.take(row, drag, response.rect)
    }

    /// Applies the whole drag to the stops at its beginning.
    fn take(&mut self, row: &KnobRow<'_>, drag: &Drag, area: Rect) -> bool {
        let all = drag.values.all.as_ref();
        let Some(KnobValue::Stops(stops)) = all.and_then(|all| read(row.knob, all)) else {
            return false;
        };
        self.stops = stops;
        self.selected = drag.values.index.min(self.stops.len() - 1);
        let y = drag.place().y;
        let is_away = y < area.top() - AWAY || y > area.bottom() + AWAY;
        if !(is_away && self.remove()) {
            self.move_to(rounded(drag.values.exact[0], DIGITS));
        }
        true
    }

    fn clicked(&mut self, knob_ui: &mut KnobUi<'_>, id: Id, response: &Response, ramp: &Ramp) -> bool {
        let Some(place) = response.interact_pointer_pos().filter(|_| response.clicked()) else {
            return false;
        };
        response.request_focus();
        if let Some(near) = self.near(ramp, place) {
            self.selected = near;
            return false;
        }
        let is_added = self.add(ramp.at(place.x));
        if !is_added {
            knob_ui.fault(id, self.full());
        }
        is_added
    }

    fn keyed(&mut self, ui: &Ui, response: &Response) -> bool {
        let [right, down] = arrows(ui, response);
        if !response.has_focus() {
            return false;
        }
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if pressed(Key::PageDown) {
            self.selected = (self.selected + 1).min(self.stops.len() - 1);
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
        let steps = right - down;
        if steps != 0.0 {
            let at = self.stops[self.selected].at;
            self.move_to(rounded(at + steps * STEP, DIGITS));
        }
        steps != 0.0
    }

    /// Adds a stop halfway to the next one.
    fn add_behind(&mut self) -> bool {
        let at = self.stops[self.selected].at;
        let next = self.stops.get(self.selected + 1).map_or(1.0, |stop| stop.at);
        self.add(rounded((at + next) / 2.0, DIGITS))
    }

    fn describe(&self, ui: &Ui, row: &KnobRow<'_>, response: &Response) {
        let stop = self.stops[self.selected];
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), stop.at, &row.knob.label));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            let count = self.stops.len();
            let number = self.selected + 1;
            node.set_value(format!("stop {number} of {count} at {}", stop.at));
        });
    }

    fn buttons(&mut self, ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect) -> bool {
        let label = &row.knob.label;
        let [choose, remove, add, turn] = std::array::from_fn(|_| cut_square(&mut rect));
        let button = |salt: &str, place, sign, what: &str| {
            sign_button(ui, knob_ui, id.with(salt), place, sign, &format!("{label}: {what}")).clicked()
        };
        let is_turned = button("turn", turn, icon::ARROWS_LEFT_RIGHT, "turn around");
        let is_added = button("add", add, icon::PLUS, "add a stop");
        let is_removed = button("remove", remove, icon::MINUS, "take the stop out");
        let name = format!("{label}: presets and pictures");
        let chooser = sign_button(ui, knob_ui, id.with("presets"), choose, icon::SWATCHES, &name);
        let is_chosen = match presets::menu(&chooser, knob_ui) {
            Some(PresetChoice::Preset(preset)) => {
                self.stops.clone_from(&preset.stops);
                self.selected = 0;
                true
            }
            Some(PresetChoice::Picture) => {
                let knob = row.knob.name.clone();
                knob_ui.events.push(KnobEvent::PickGradient { knob });
                false
            }
            None => false,
        };
        let count = format!("{} stops", self.stops.len());
        let text = if row.differs { "mixed" } else { &count };
        write(
            ui.painter(),
            rect,
            Align2::LEFT_CENTER,
            text,
            type_size::BODY,
            knob_ui.theme.quiet,
        );
        if is_turned {
            self.stops.reverse();
            for stop in &mut self.stops {
                stop.at = rounded(1.0 - stop.at, DIGITS / 10.0);
            }
            self.selected = self.stops.len() - 1 - self.selected;
        }
        let has_room = !is_added || self.add_behind();
        if !has_room {
            knob_ui.fault(id, self.full());
        }
        is_chosen || is_turned || is_added && has_room || is_removed && self.remove()
    }

    /// Shows the color and the position of the selected stop.
    fn numbers(&mut self, ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id) -> bool {
        let label = &row.knob.label;
        let rect = strip(ui, space::ROW);
        let middle = rect.left() + rect.width() * 0.58;
        let stop = self.stops[self.selected];
        let left = rect.with_max_x(middle - space::TIGHT);
        let color = swatch_and_code(ui, knob_ui, row, id, left, &format!("{label}: color"), stop.color);
        if let Some(color) = color {
            self.stops[self.selected].color = color;
        }
        let name = format!("{label}: position");
        let whole = bar_of(knob_ui, row, id, rect.with_min_x(middle), stop.at);
        let bar = NumberBar {
            name: &name,
            inside: "At",
            ends: [0.0, 1.0],
            range: Some([0.0, 1.0]),
            ..whole
        };
        let moved = bar.show(ui, knob_ui).value;
        if let Some(at) = moved {
            self.move_to(at);
        }
        color.is_some() || moved.is_some()
    }

    fn paint(&self, ui: &Ui, knob_ui: &KnobUi<'_>, response: &Response, ramp: &Ramp) {
        let theme = knob_ui.theme;
        let painter = ui.painter();
        let whole = ramp.0.expand2(Vec2::new(HANDLES / 2.0, 0.0));
        let [first, last] = [0.0, 1.0].map(|at| color_at(&self.stops, at));
        painter.rect_filled(whole.with_max_x(whole.center().x), space::CORNER, first);
        painter.rect_filled(whole.with_min_x(whole.center().x), space::CORNER, last);
        paint_ramp(painter, ramp.0.shrink2(Vec2::new(0.0, 1.0)), &self.stops);
        painter.rect_stroke(whole, space::CORNER, (1.0, theme.line), StrokeKind::Inside);
        for (at, stop) in self.stops.iter().enumerate() {
            let is_selected = at == self.selected;
            let line = if is_selected { theme.accent } else { theme.quiet };
            let tip = Pos2::new(ramp.x(stop.at), ramp.0.bottom() - 3.0);
            let [half, height] = [HANDLES / 2.0 - 1.0, HANDLES + 2.0];
            let marker = [[0.0, 0.0], [half, 5.0], [half, height], [-half, height], [-half, 5.0]];
            let marker = marker.map(|[x, y]| tip + Vec2::new(x, y)).to_vec();
            let width = if is_selected { 2.0 } else { 1.0 };
            painter.add(Shape::convex_polygon(marker, stop.color, (width, line)));
        }
        focus_ring(ui, knob_ui, response);
    }
}

/// Color at a position, mixed in linear light as nodes do.
fn color_at(stops: &[GradientStop], at: f64) -> Color32 {
    let after = stops.partition_point(|stop| stop.at <= at);
    let (Some(left), Some(right)) = (stops.get(after.saturating_sub(1)), stops.get(after).or(stops.last())) else {
        return Color32::TRANSPARENT;
    };
    let share = ((at - left.at) / (right.at - left.at).max(1e-6)).clamp(0.0, 1.0) as f32;
    Color32::from(egui::lerp(Rgba::from(left.color)..=Rgba::from(right.color), share))
}

/// Fills a rectangle with a gradient as a file holds it.
pub(crate) fn paint_gradient(painter: &Painter, rect: Rect, stops: &[WrittenStop]) {
    let stops: Vec<GradientStop> = stops.iter().map(GradientStop::of).collect();
    paint_ramp(painter, rect, &stops);
}

/// Fills a rectangle with a gradient, in pieces short enough to look like linear light.
pub(super) fn paint_ramp(painter: &Painter, rect: Rect, stops: &[GradientStop]) {
    const PARTS: u32 = 48;
    let even = (0..=PARTS).map(|part| f64::from(part) / f64::from(PARTS));
    // Two stops at one position make an edge.
    let own = stops.iter().flat_map(|stop| [stop.at - 1e-6, stop.at]);
    let mut places: Vec<f64> = even.chain(own).collect();
    places.sort_by(f64::total_cmp);
    let mut mesh = Mesh::default();
    for (at, place) in places.iter().enumerate() {
        let x = egui::lerp(rect.x_range(), *place as f32);
        for y in [rect.top(), rect.bottom()] {
            mesh.colored_vertex(Pos2::new(x, y), color_at(stops, *place));
        }
        if at > 0 {
            let corner = 2 * at as u32;
            mesh.add_triangle(corner - 2, corner - 1, corner);
            mesh.add_triangle(corner - 1, corner, corner + 1);
        }
    }
    painter.add(mesh);
}
