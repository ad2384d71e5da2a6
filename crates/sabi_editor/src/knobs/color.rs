//! Colors: a swatch that opens a picker, the code, and an eyedropper.

use egui::epaint::Hsva;
use egui::{Color32, Id, Key, Popup, PopupCloseBehavior, Rect, Sense, StrokeKind, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_graph::Value;

use super::boxes::cut_square;
use super::buttons::{focus_ring, sign_button};
use super::knob_ui::{DragValues, KnobUi};
use super::picker::{picker, remember};
use super::text_field::{FieldResult, KnobTextField};
use super::values::{code_of, color_of};
use super::{KnobEvent, KnobRow};
use crate::theme::space;

/// Width of the swatch beside the code.
const SWATCH: f32 = 44.0;

pub(super) fn show(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect, color: Color32) {
    let label = &row.knob.label;
    let drop = cut_square(&mut rect);
    let chosen = swatch_and_code(ui, knob_ui, row, id, rect, label, color);
    if let Some(color) = chosen {
        knob_ui.set(row, Value::Text(code_of(color)));
    }
    let name = format!("{label}: take from the model or the texture");
    if sign_button(ui, knob_ui, id.with("dropper"), drop, icon::EYEDROPPER, &name).clicked() {
        let knob = row.knob.name.clone();
        knob_ui.events.push(KnobEvent::Eyedropper { knob });
    }
}

/// Shows a swatch with the code of its color.
pub(super) fn swatch_and_code(
    ui: &mut Ui,
    knob_ui: &mut KnobUi<'_>,
    row: &KnobRow<'_>,
    id: Id,
    rect: Rect,
    name: &str,
    color: Color32,
) -> Option<Color32> {
    let left = rect.with_max_x(rect.left() + SWATCH.min(rect.width() / 3.0));
    let picked = swatch(ui, knob_ui, row, id.with("swatch"), left, name, color);
    let shown = if row.differs { String::new() } else { code_of(color) };
    let typed = knob_ui.field(
        ui,
        &KnobTextField {
            id: id.with("code"),
            rect: rect.with_min_x(left.right() + space::TIGHT / 2.0),
            name: &format!("{name}: code"),
            shown: &shown,
            hint: "mixed",
        },
    );
    match typed {
        FieldResult::Changed(text) => match color_of(&text) {
            Some(color) => Some(color),
            None => {
                let sentence =
                    format!("\"{text}\" is no color: write six digits of 0 to 9 and a to f, such as #6b3a1e.");
                knob_ui.fault(id, sentence);
                picked
            }
        },
        FieldResult::Editing | FieldResult::Unchanged => picked,
    }
}

/// Shows a swatch that opens a picker.
pub(super) fn swatch(
    ui: &Ui,
    knob_ui: &mut KnobUi<'_>,
    row: &KnobRow<'_>,
    id: Id,
    rect: Rect,
    name: &str,
    color: Color32,
) -> Option<Color32> {
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::ColorButton, ui.is_enabled(), name));
    ui.ctx().accesskit_node_builder(id, |node| {
        node.set_value(if row.differs { "mixed".into() } else { code_of(color) })
    });
    if ui.is_rect_visible(rect) {
        let painter = ui.painter();
        let line = if response.hovered() {
            knob_ui.theme.quiet
        } else {
            knob_ui.theme.line
        };
        painter.rect(rect, space::CORNER, color, (1.0, line), StrokeKind::Inside);
        if row.differs {
            // Half of the swatch shows that selected nodes differ.
            let half = rect.with_min_x(rect.center().x);
            painter.rect_filled(half.shrink(1.0), space::CORNER, knob_ui.theme.raised);
        }
        focus_ring(ui, knob_ui, &response);
    }
    let popup = Popup::menu(&response).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    popup.show(|ui| pick(ui, knob_ui, id, color))?.inner
}

fn pick(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, id: Id, color: Color32) -> Option<Color32> {
    // A gray has no hue, so the picker's own is kept while it gives this color.
    let kept = knob_ui
        .memory
        .picked
        .filter(|(of, kept)| *of == id && rgb(kept) == color);
    let mut picked = kept.map_or_else(|| Hsva::from_srgb([color.r(), color.g(), color.b()]), |(_, kept)| kept);
    let has_changed = picker(ui, &mut picked);
    knob_ui.mark_shown(ui.ctx(), id);
    let [is_down, is_up, is_canceled] = ui.input(|input| {
        let pointer = &input.pointer;
        [
            pointer.primary_down(),
            pointer.primary_released(),
            input.key_pressed(Key::Escape),
        ]
    });
    let is_entered = ui.input(|input| input.key_pressed(Key::Enter));
    if (is_up || is_entered) && kept.is_some() {
        remember(ui.ctx(), color);
    }
    if !has_changed || is_canceled {
        return None;
    }
    knob_ui.memory.picked = Some((id, picked));
    let origin = ui.input(|input| input.pointer.interact_pos());
    if let Some(origin) = origin.filter(|_| is_down && knob_ui.memory.drag.is_none()) {
        knob_ui.begin(ui.ctx(), id, DragValues::default(), origin);
    }
    Some(rgb(&picked))
}

fn rgb(picked: &Hsva) -> Color32 {
    let [r, g, b] = picked.to_srgb();
    Color32::from_rgb(r, g, b)
}
