//! Small buttons beside values.

use egui::{Align2, Id, Rect, Response, Sense, StrokeKind, Ui, WidgetInfo, WidgetType};

use super::KnobRow;
use super::knob_ui::KnobUi;
use super::text_painting::write;
use crate::theme::{space, type_size};

/// Button with a sign; `name` is its tooltip and accessible name.
pub(super) fn sign_button(ui: &Ui, knob_ui: &KnobUi<'_>, id: Id, rect: Rect, sign: &str, name: &str) -> Response {
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let color = if response.hovered() {
            knob_ui.theme.text
        } else {
            knob_ui.theme.quiet
        };
        if response.hovered() {
            ui.painter().rect_filled(rect, space::CORNER, knob_ui.theme.hovered);
        }
        focus_ring(ui, knob_ui, &response);
        write(
            ui.painter(),
            rect,
            Align2::CENTER_CENTER,
            sign,
            type_size::HEADING * knob_ui.zoom,
            color,
        );
    }
    response.on_hover_text(name)
}

/// State of one of several words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WordState {
    Unchosen,
    /// Chosen, and the default.
    Default,
    /// Chosen in place of the default.
    Chosen,
}

impl WordState {
    pub(super) fn of(row: &KnobRow<'_>, is_held: bool) -> WordState {
        match (is_held && !row.differs, row.is_changed()) {
            (false, _) => WordState::Unchosen,
            (true, false) => WordState::Default,
            (true, true) => WordState::Chosen,
        }
    }
}

/// Button with one of several words.
pub(super) fn word_button(
    ui: &Ui,
    knob_ui: &KnobUi<'_>,
    id: Id,
    rect: Rect,
    word: &str,
    chosen: WordState,
) -> Response {
    let response = ui.interact(rect, id, Sense::click());
    if ui.is_rect_visible(rect) {
        let theme = knob_ui.theme;
        let (fill, color) = match chosen {
            WordState::Chosen => (theme.raised.lerp_to_gamma(theme.accent, 0.42), theme.text),
            WordState::Default => (theme.raised.lerp_to_gamma(theme.quiet, 0.32), theme.text),
            WordState::Unchosen if response.hovered() => (theme.hovered, theme.text),
            WordState::Unchosen => (theme.raised, theme.quiet),
        };
        ui.painter().rect_filled(rect, space::CORNER, fill);
        focus_ring(ui, knob_ui, &response);
        let size = type_size::BODY * knob_ui.zoom;
        write(ui.painter(), rect.shrink(2.0), Align2::CENTER_CENTER, word, size, color);
    }
    response
}

/// Draws the mark of the widget that has the keyboard.
pub(super) fn focus_ring(ui: &Ui, knob_ui: &KnobUi<'_>, response: &Response) {
    if response.has_focus() {
        let line = (1.0, knob_ui.theme.accent);
        ui.painter()
            .rect_stroke(response.rect, space::CORNER, line, StrokeKind::Inside);
    }
}
