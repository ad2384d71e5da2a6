//! Rows on nodes: name and value in one bar.

use egui::{Align2, Color32, Id, Rect, Sense, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use sabi_editing::node_size::ROW_HEIGHT;
use sabi_engine::catalog::{KnobRole, label_of};
use sabi_graph::Value;

use super::bar::Bar;
use super::curve::View;
use super::knob_ui::{KnobMemory, KnobUi};
use super::text_painting::write;
use super::values::{Held, Stop, code_of, read, step_of, text_of};
use super::{KnobEvent, KnobRow, Lengths, choice, color, doc, numbers};
use crate::theme::{Theme, space, type_size};

/// Zoom below which a row is drawn as a plain block.
const LEGIBLE: f32 = 0.45;

/// Height of a row, a little less than the room that a node has for it.
const HEIGHT: f32 = ROW_HEIGHT - 2.0;

/// Shows a parameter on a node, and gives what it asks for. The `ui` of each node needs an id of its own.
///
/// The state of drags and typing is kept in egui's memory for all nodes together. Where the node of a drag is gone, the next
/// row that is shown ends the drag.
pub(crate) fn knob_inline(ui: &mut Ui, theme: &Theme, row: &KnobRow<'_>, width: f32, zoom: f32) -> Vec<KnobEvent> {
    let id = ui.make_persistent_id(("inline", &row.knob.name));
    let kept = Id::new("what knobs on nodes remember");
    let memory = ui.data_mut(|data| data.remove_temp::<KnobMemory>(kept));
    // There is no state before the first row is shown.
    let mut memory = memory.unwrap_or_default();
    // Lengths on the model are shown in the panel only.
    let lengths = Lengths {
        model_units_per_working: 0.0,
        metres_per_model_unit: 0.0,
    };
    let mut ask = KnobUi {
        zoom,
        ..KnobUi::new(theme, &mut memory, &lengths)
    };
    ask.age_fault(ui.ctx(), id);
    let (_, rect) = ui.allocate_space(Vec2::new(width, HEIGHT * zoom));
    if zoom < LEGIBLE {
        ui.painter()
            .rect_filled(rect, f32::from(space::CORNER) * zoom, theme.raised);
    } else if let Some(from) = row.wired {
        named(ui, &ask, row, id, rect, &format!("from {from}"), theme.quiet);
    } else {
        widget(ui, &mut ask, row, id, rect);
    }
    ask.finish(ui.ctx(), |dragged| {
        dragged == id.with("bar") || dragged == id.with("swatch")
    });
    if let Some(sentence) = ask.fault_of(id) {
        let below = ui.interact(rect, id.with("fault"), Sense::hover());
        below.show_tooltip_text(egui::RichText::new(sentence).color(theme.fault));
    } else if zoom >= LEGIBLE {
        let over = ui.interact(rect, id.with("told"), Sense::hover());
        over.on_hover_ui(|ui| doc::show(ui, theme, row));
    }
    let events = ask.events;
    ui.data_mut(|data| data.insert_temp(kept, memory));
    events
}

fn widget(ui: &mut Ui, ask: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) {
    let held = read(row.knob, row.held());
    match (held, &row.knob.ty.role) {
        (Some(Held::Numbers(held)), role) if row.knob.ty.components() == 1 => {
            let whole = numbers::bar_of(ask, row, id, rect, held[0]);
            let is_seed = *role == KnobRole::Seed;
            let bar = Bar {
                inside: &row.knob.label,
                is_filled: !is_seed,
                range: if is_seed {
                    Some([0.0, f64::from(u32::MAX)])
                } else {
                    whole.range
                },
                ..whole
            };
            numbers::one(ui, ask, &bar);
        }
        (Some(Held::Numbers(held)), _) => {
            let step = step_of(row.knob.ty.slider(), row.knob.ty.is_whole());
            let held = held.iter().take(row.knob.ty.components());
            let texts: Vec<String> = held.map(|number| text_of(*number, step)).collect();
            named(ui, ask, row, id, rect, &texts.join("  "), ask.theme.text);
        }
        (Some(Held::On(is_on)), _) => {
            let size = Vec2::new(24.0, 13.0) * ask.zoom;
            let inside = within(rect, ask.zoom);
            let place = Align2::RIGHT_CENTER.align_size_within_rect(size, inside);
            label(ui, ask, row, inside.with_max_x(place.left()));
            choice::switch(ui, ask, row, id, place, is_on);
        }
        (Some(Held::Text(word)), KnobRole::Choice(words)) => {
            let response = ui.interact(rect, id.with("list"), Sense::click());
            let fill = if response.hovered() {
                ask.theme.hovered
            } else {
                ask.theme.raised
            };
            ui.painter().rect_filled(rect, space::CORNER, fill);
            value(ui, ask, row, rect, &label_of(word), ask.theme.text);
            choice::open_list(ui, ask, row, &response, words, word);
        }
        (Some(Held::Color(held)), _) => {
            let inside = within(rect, ask.zoom);
            let size = Vec2::new(32.0, 14.0) * ask.zoom;
            let place = Align2::RIGHT_CENTER.align_size_within_rect(size, inside);
            label(ui, ask, row, inside.with_max_x(place.left()));
            let asked = color::swatch(ui, ask, row, id.with("swatch"), place, &row.knob.label, held);
            if let Some(color) = asked {
                ask.set(row, Value::Text(code_of(color)));
            }
        }
        (Some(Held::Stops(stops)), _) => ramp(ui, ask, row, id, rect, &stops),
        (Some(Held::Points(points)), _) => line(ui, ask, row, id, rect, &points),
        (Some(Held::Text(text)), _) => named(ui, ask, row, id, rect, text, ask.theme.text),
        (None, _) => named(ui, ask, row, id, rect, "cannot be read", ask.theme.fault),
    }
}

fn within(rect: Rect, zoom: f32) -> Rect {
    rect.shrink2(Vec2::new(6.0 * zoom, 0.0))
}

fn label(ui: &Ui, ask: &KnobUi<'_>, row: &KnobRow<'_>, rect: Rect) {
    let size = type_size::BODY * ask.zoom;
    write(
        ui.painter(),
        rect,
        Align2::LEFT_CENTER,
        &row.knob.label,
        size,
        ask.beside(),
    );
}

/// Draws the name on the left and a value on the right.
fn value(ui: &Ui, ask: &KnobUi<'_>, row: &KnobRow<'_>, rect: Rect, text: &str, color: Color32) {
    let inside = within(rect, ask.zoom);
    let size = type_size::BODY * ask.zoom;
    let text = if row.differs { "several" } else { text };
    // Where there is little room, the value matters more than the name.
    let right = inside.with_min_x(inside.left() + inside.width() * 0.3);
    let taken = write(ui.painter(), right, Align2::RIGHT_CENTER, text, size, color);
    label(ui, ask, row, inside.with_max_x(inside.right() - taken - space::TIGHT));
}

/// Shows a parameter that is edited in the panel only.
fn named(ui: &Ui, ask: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, text: &str, color: Color32) {
    let response = ui.interact(rect, id.with("shown"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, ui.is_enabled(), &row.knob.label));
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_value(text));
    value(ui, ask, row, rect, text, color);
}

/// Right half of a row, for a picture of its value.
fn picture(ui: &Ui, ask: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) -> Rect {
    named(ui, ask, row, id, rect, "", ask.theme.quiet);
    let inside = within(rect, ask.zoom);
    inside
        .with_min_x(inside.center().x)
        .shrink2(Vec2::new(0.0, 3.0 * ask.zoom))
}

fn ramp(ui: &Ui, ask: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, stops: &[Stop]) {
    let place = picture(ui, ask, row, id, rect);
    super::stops::paint_ramp(ui.painter(), place, stops);
}

fn line(ui: &Ui, ask: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, points: &[[f64; 2]]) {
    let place = picture(ui, ask, row, id, rect);
    ui.painter().rect_filled(place, space::CORNER, ask.theme.canvas);
    let usual = row.knob.ty.soft.unwrap_or([0.0, 1.0]);
    let view = View::of(place.shrink(2.0 * ask.zoom), usual, points);
    view.draw(ui.painter(), points, Stroke::new(1.5 * ask.zoom, ask.theme.text));
}
