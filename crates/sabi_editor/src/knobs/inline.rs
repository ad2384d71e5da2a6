//! Rows on nodes: name and value in one bar.

use egui::{Align2, Color32, Id, Rect, Sense, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use sabi_editing::node_size::ROW_HEIGHT;
use sabi_graph::Value;
use sabi_nodes::kind::Role;

use super::bar::NumberBar;
use super::curve::CurveView;
use super::knob_ui::{KnobMemory, KnobUi};
use super::text_painting::write;
use super::values::{GradientStop, KnobValue, code_of, read, step_of, text_of};
use super::{KnobEvent, KnobRow, LengthUnits, choice, color, doc, numbers, row};
use crate::theme::{Theme, space, type_size};

/// Zoom below which a row is drawn as a plain block.
const LEGIBLE: f32 = 0.45;

/// Height of a row, a little less than the room that a node has for it.
const HEIGHT: f32 = ROW_HEIGHT - 2.0;

/// Returns whether the menu of a parameter on a node was asked for by a click in its row.
pub(crate) fn is_inline_menu_asked(ui: &Ui, row: Rect, zoom: f32) -> bool {
    zoom >= LEGIBLE && row::is_menu_asked(ui, row)
}

/// Shows a parameter on a node, and returns its events. The `ui` of each node needs an id of its own.
///
/// The state of drags and typing is kept in egui's memory for all nodes together. If the node of a drag does not exist any
/// more, the next row that is shown ends the drag.
pub(crate) fn knob_inline(ui: &mut Ui, theme: &Theme, row: &KnobRow<'_>, width: f32, zoom: f32) -> Vec<KnobEvent> {
    let id = ui.make_persistent_id(("inline", &row.knob.name));
    let kept = Id::new("what knobs on nodes remember");
    let memory = ui.data_mut(|data| data.remove_temp::<KnobMemory>(kept));
    // There is no state before the first row is shown.
    let mut memory = memory.unwrap_or_default();
    // Lengths on the model are shown in the panel only.
    let lengths = LengthUnits {
        model_units_per_working: 0.0,
        metres_per_model_unit: 0.0,
    };
    let mut knob_ui = KnobUi {
        zoom,
        ..KnobUi::new(theme, &mut memory, &lengths)
    };
    knob_ui.age_fault(ui.ctx(), id);
    let (_, rect) = ui.allocate_space(Vec2::new(width, HEIGHT * zoom));
    if zoom < LEGIBLE {
        ui.painter()
            .rect_filled(rect, f32::from(space::CORNER) * zoom, theme.raised);
    } else if let Some(from) = row.wired {
        named(ui, &knob_ui, row, id, rect, &format!("from {from}"), theme.quiet);
    } else {
        widget(ui, &mut knob_ui, row, id, rect);
    }
    if zoom >= LEGIBLE {
        row::menu(ui, &mut knob_ui, row, id, rect);
    }
    row::paste(ui, &mut knob_ui, row, id);
    knob_ui.finish(ui.ctx(), |dragged| {
        dragged == id.with("bar") || dragged == id.with("swatch")
    });
    if let Some(sentence) = knob_ui.fault_of(id) {
        let below = ui.interact(rect, id.with("fault"), Sense::hover());
        below.show_tooltip_text(egui::RichText::new(sentence).color(theme.fault));
    } else if zoom >= LEGIBLE {
        let over = ui.interact(rect, id.with("told"), Sense::hover());
        over.on_hover_ui(|ui| doc::show(ui, theme, row));
    }
    let events = knob_ui.events;
    ui.data_mut(|data| data.insert_temp(kept, memory));
    events
}

fn widget(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) {
    let held = read(row.knob, row.current());
    match (held, &row.knob.ty.role) {
        (Some(KnobValue::Numbers(held)), role) if row.knob.ty.components() == 1 => {
            let whole = numbers::bar_of(knob_ui, row, id, rect, held[0]);
            let bar = NumberBar {
                inside: &row.knob.label,
                is_filled: *role != Role::Seed,
                ..whole
            };
            numbers::one(ui, knob_ui, &bar);
        }
        (Some(KnobValue::Numbers(held)), _) => {
            let step = step_of(row.knob.ty.slider(), row.knob.ty.is_whole());
            let held = held.iter().take(row.knob.ty.components());
            let texts: Vec<String> = held.map(|number| text_of(*number, step)).collect();
            named(ui, knob_ui, row, id, rect, &texts.join("  "), knob_ui.theme.text);
        }
        (Some(KnobValue::On(is_on)), _) => {
            let size = Vec2::new(24.0, 13.0) * knob_ui.zoom;
            let inside = within(rect, knob_ui.zoom);
            let place = Align2::RIGHT_CENTER.align_size_within_rect(size, inside);
            label(ui, knob_ui, row, inside.with_max_x(place.left()));
            choice::switch(ui, knob_ui, row, id, place, is_on);
        }
        (Some(KnobValue::Text(word)), Role::Choice(words)) => {
            let response = ui.interact(rect, id.with("list"), Sense::click());
            let fill = if response.hovered() {
                knob_ui.theme.hovered
            } else {
                knob_ui.theme.raised
            };
            ui.painter().rect_filled(rect, space::CORNER, fill);
            value(
                ui,
                knob_ui,
                row,
                rect,
                &choice::word_label(row, word),
                knob_ui.theme.text,
            );
            choice::open_list(ui, knob_ui, row, &response, words, word);
        }
        (Some(KnobValue::Color(held)), _) => {
            let inside = within(rect, knob_ui.zoom);
            let size = Vec2::new(32.0, 14.0) * knob_ui.zoom;
            let place = Align2::RIGHT_CENTER.align_size_within_rect(size, inside);
            label(ui, knob_ui, row, inside.with_max_x(place.left()));
            let chosen = color::swatch(ui, knob_ui, row, id.with("swatch"), place, &row.knob.label, held);
            if let Some(color) = chosen {
                knob_ui.set(row, Value::Text(code_of(color)));
            }
        }
        (Some(KnobValue::Stops(stops)), _) => ramp(ui, knob_ui, row, id, rect, &stops),
        (Some(KnobValue::Points(points)), _) => line(ui, knob_ui, row, id, rect, &points),
        (Some(KnobValue::Text(text)), _) => named(ui, knob_ui, row, id, rect, text, knob_ui.theme.text),
        (None, _) => named(ui, knob_ui, row, id, rect, "cannot be read", knob_ui.theme.fault),
    }
}

fn within(rect: Rect, zoom: f32) -> Rect {
    rect.shrink2(Vec2::new(6.0 * zoom, 0.0))
}

fn label(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, rect: Rect) {
    let size = type_size::BODY * knob_ui.zoom;
    write(
        ui.painter(),
        rect,
        Align2::LEFT_CENTER,
        &row.knob.label,
        size,
        knob_ui.beside(),
    );
}

/// Draws the name on the left and a value on the right.
fn value(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, rect: Rect, text: &str, color: Color32) {
    let inside = within(rect, knob_ui.zoom);
    let size = type_size::BODY * knob_ui.zoom;
    let text = if row.differs { "mixed" } else { text };
    // Where there is little room, the value matters more than the name.
    let right = inside.with_min_x(inside.left() + inside.width() * 0.3);
    let taken = write(ui.painter(), right, Align2::RIGHT_CENTER, text, size, color);
    label(
        ui,
        knob_ui,
        row,
        inside.with_max_x(inside.right() - taken - space::TIGHT),
    );
}

/// Shows a parameter that is edited in the panel only.
fn named(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, text: &str, color: Color32) {
    let response = ui.interact(rect, id.with("shown"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, ui.is_enabled(), &row.knob.label));
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_value(text));
    value(ui, knob_ui, row, rect, text, color);
}

/// Right half of a row, for a picture of its value.
fn picture(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) -> Rect {
    named(ui, knob_ui, row, id, rect, "", knob_ui.theme.quiet);
    let inside = within(rect, knob_ui.zoom);
    inside
        .with_min_x(inside.center().x)
        .shrink2(Vec2::new(0.0, 3.0 * knob_ui.zoom))
}

fn ramp(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, stops: &[GradientStop]) {
    let place = picture(ui, knob_ui, row, id, rect);
    super::stops::paint_ramp(ui.painter(), place, stops);
}

fn line(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, points: &[[f64; 2]]) {
    let place = picture(ui, knob_ui, row, id, rect);
    ui.painter().rect_filled(place, space::CORNER, knob_ui.theme.canvas);
    let usual = row.knob.ty.soft.unwrap_or([0.0, 1.0]);
    let view = CurveView::of(place.shrink(2.0 * knob_ui.zoom), usual, points);
    view.draw(
        ui.painter(),
        points,
        Stroke::new(1.5 * knob_ui.zoom, knob_ui.theme.text),
    );
}
