//! Choices: switches, a few words side by side, or a list that opens.

use egui::{Align2, Id, Key, Modifiers, Popup, Rect, Response, ScrollArea, Sense, Ui, Vec2, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_graph::Value;
use sabi_nodes::label_of;

use super::KnobRow;
use super::boxes::share_of;
use super::buttons::{WordState, focus_ring, word_button};
use super::keys::lock_arrow_keys;
use super::knob_ui::KnobUi;
use super::text_painting::{width, write};
use crate::theme::{space, type_size};

/// Most words that are shown side by side.
const MOST_BESIDE: usize = 3;
/// Size of a switch.
const SWITCH: Vec2 = Vec2::new(28.0, 15.0);
/// Greatest height of the list, points.
const HIGHEST_LIST: f32 = 320.0;

/// Shows a switch.
pub(super) fn toggle(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, is_on: bool) {
    let place = Rect::from_center_size(
        egui::pos2(rect.left() + SWITCH.x * knob_ui.zoom / 2.0, rect.center().y),
        SWITCH * knob_ui.zoom,
    );
    switch(ui, knob_ui, row, id, place, is_on);
}

/// Shows a switch of a size.
pub(super) fn switch(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, place: Rect, is_on: bool) {
    let response = ui.interact(place, id.with("switch"), Sense::click());
    response.widget_info(|| match row.differs {
        // Nodes with different values have a switch in between.
        true => WidgetInfo::labeled(WidgetType::Checkbox, ui.is_enabled(), &row.knob.label),
        false => WidgetInfo::selected(WidgetType::Checkbox, ui.is_enabled(), is_on, &row.knob.label),
    });
    if ui.is_rect_visible(place) {
        let theme = knob_ui.theme;
        let at = match row.differs {
            true => 0.5,
            false => ui.ctx().animate_bool_responsive(response.id, is_on),
        };
        let radius = place.height() / 2.0;
        let off = if response.hovered() {
            theme.hovered
        } else {
            theme.raised
        };
        let fill = if row.differs {
            off
        } else {
            off.lerp_to_gamma(theme.accent, at)
        };
        let line = theme.line.lerp_to_gamma(theme.accent, at);
        let painter = ui.painter();
        painter.rect(place, radius, fill, (1.0, line), egui::StrokeKind::Inside);
        let x = egui::lerp(place.left() + radius..=place.right() - radius, at);
        let knob = theme.quiet.lerp_to_gamma(theme.on_accent, at);
        painter.circle_filled(egui::pos2(x, place.center().y), radius - 3.0 * knob_ui.zoom, knob);
        if response.has_focus() {
            painter.rect_stroke(place.expand(2.0), radius, (1.0, theme.accent), egui::StrokeKind::Inside);
        }
    }
    if response.clicked() {
        // Nodes with different values are all switched on by a click.
        knob_ui.set(row, Value::Bool(row.differs || !is_on));
    }
}

/// Shows a choice of words.
pub(super) fn choice(
    ui: &mut Ui,
    knob_ui: &mut KnobUi<'_>,
    row: &KnobRow<'_>,
    id: Id,
    rect: Rect,
    words: &[String],
    chosen: &str,
) {
    let room = rect.width() / words.len().max(1) as f32 - space::USUAL - 2.0;
    let fits = |word: &String| width(ui.painter(), &label_of(word), type_size::BODY) < room;
    if words.len() <= MOST_BESIDE && words.iter().all(fits) {
        beside(ui, knob_ui, row, id, rect, words, chosen);
    } else {
        list(ui, knob_ui, row, id, rect, words, chosen);
    }
}

fn beside(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, words: &[String], chosen: &str) {
    let group = ui.interact(rect, id.with("words"), Sense::hover());
    group.widget_info(|| WidgetInfo::labeled(WidgetType::RadioGroup, ui.is_enabled(), &row.knob.label));
    ui.ctx()
        .accesskit_node_builder(group.id, |node| node.set_value(said(row, chosen)));
    for (at, word) in words.iter().enumerate() {
        let is_chosen = !row.differs && word == chosen;
        let name = word_label(row, word);
        let place = share_of(rect, at, words.len());
        let response = word_button(ui, knob_ui, id.with(word), place, &name, WordState::of(row, is_chosen));
        response.widget_info(|| WidgetInfo::selected(WidgetType::RadioButton, ui.is_enabled(), is_chosen, &name));
        if response.clicked() {
            knob_ui.set(row, Value::Text(word.clone()));
        }
    }
}

/// Label of a word. An instance without a variant shows the group as its card "Base" does.
pub(super) fn word_label(row: &KnobRow<'_>, word: &str) -> String {
    match (row.knob.name.as_str(), word) {
        ("variant", "none") => "Base".to_owned(),
        _ => label_of(word),
    }
}

fn said(row: &KnobRow<'_>, chosen: &str) -> String {
    match row.differs {
        true => "mixed".to_owned(),
        false => word_label(row, chosen),
    }
}

fn list(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, words: &[String], chosen: &str) {
    let response = ui.interact(rect, id.with("list"), Sense::click());
    if ui.is_rect_visible(rect) {
        let theme = knob_ui.theme;
        let fill = if response.hovered() {
            theme.hovered
        } else {
            theme.raised
        };
        ui.painter().rect_filled(rect, space::CORNER, fill);
        focus_ring(ui, knob_ui, &response);
        let within = rect.shrink2(Vec2::new(space::USUAL, 0.0));
        let body = type_size::BODY;
        let caret = write(
            ui.painter(),
            within,
            Align2::RIGHT_CENTER,
            icon::CARET_DOWN,
            body,
            theme.quiet,
        );
        let rest = within.with_max_x(within.right() - caret - space::TIGHT);
        let color = if row.differs { theme.quiet } else { theme.text };
        write(ui.painter(), rest, Align2::LEFT_CENTER, &said(row, chosen), body, color);
    }
    open_list(ui, knob_ui, row, &response, words, chosen);
}

/// Shows a widget that opens the list, and steps through it by keys while it is closed.
pub(super) fn open_list(
    ui: &Ui,
    knob_ui: &mut KnobUi<'_>,
    row: &KnobRow<'_>,
    response: &Response,
    words: &[String],
    chosen: &str,
) {
    response.widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, ui.is_enabled(), &row.knob.label));
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_value(said(row, chosen)));
    let popup = Popup::menu(response).width(response.rect.width());
    let mut new = match popup.is_open() {
        true => None,
        false => stepped(ui, response, words, chosen),
    };
    popup.show(|ui| {
        ui.set_min_width(response.rect.width().max(80.0));
        ScrollArea::vertical().max_height(HIGHEST_LIST).show(ui, |ui| {
            for word in words {
                let is_chosen = !row.differs && word == chosen;
                let item = ui.selectable_label(is_chosen, word_label(row, word));
                if response.clicked() && word == chosen {
                    // The list has the keyboard while it is open.
                    item.request_focus();
                }
                if item.clicked() {
                    new = Some(word.clone());
                    response.request_focus();
                }
            }
        });
    });
    if let Some(word) = new {
        knob_ui.set(row, Value::Text(word));
    }
}

/// Word before or after the chosen one, as the arrow keys ask.
fn stepped(ui: &Ui, response: &Response, words: &[String], chosen: &str) -> Option<String> {
    if !response.has_focus() {
        return None;
    }
    lock_arrow_keys(ui, response);
    let steps = ui.input_mut(|input| {
        input.count_and_consume_key(Modifiers::NONE, Key::ArrowDown) as isize
            - input.count_and_consume_key(Modifiers::NONE, Key::ArrowUp) as isize
    });
    let at = words.iter().position(|word| word == chosen)?;
    let last = words.len().checked_sub(1)?;
    let next = at.saturating_add_signed(steps).min(last);
    (next != at).then(|| words[next].clone())
}
