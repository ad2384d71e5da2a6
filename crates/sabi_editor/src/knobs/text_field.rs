//! Text fields of one line.

use egui::text::{CCursor, CCursorRange};
use egui::{Align, Frame, Id, Key, Margin, Rect, Response, StrokeKind, TextEdit, Ui};

use super::knob_ui::{KnobUi, TypedText};
use crate::theme::{space, type_size};

/// Result of a text field in this frame.
#[derive(Debug, PartialEq)]
pub(super) enum FieldResult {
    /// The field is being edited, or was not changed at all.
    Editing,
    /// Left without a change.
    Unchanged,
    /// Left with this new text.
    Changed(String),
}

/// Text field of one line.
pub(super) struct KnobTextField<'f> {
    pub(super) id: Id,
    pub(super) rect: Rect,
    /// Accessible name.
    pub(super) name: &'f str,
    /// Text while nothing is typed.
    pub(super) shown: &'f str,
    /// Hint while there is no text.
    pub(super) hint: &'f str,
}

impl KnobUi<'_> {
    /// Opens a text field that is shown only while it has the keyboard.
    pub(super) fn open_field(&mut self, id: Id, text: String, is_selected: bool) {
        self.memory.typing = Some(TypedText {
            id,
            text,
            is_new: true,
            is_selected,
        });
    }

    pub(super) fn is_typing(&self, id: Id) -> bool {
        self.memory.typing.as_ref().is_some_and(|typing| typing.id == id)
    }

    /// Shows a text field.
    pub(super) fn field(&mut self, ui: &mut Ui, field: &KnobTextField<'_>) -> FieldResult {
        let mut typing = self.memory.typing.take_if(|typing| typing.id == field.id);
        let mut text = match &mut typing {
            Some(typing) => std::mem::take(&mut typing.text),
            None => field.shown.to_owned(),
        };
        let response = self.edit(ui, field, &mut text);
        let Some(mut typing) = typing else {
            if response.gained_focus() {
                select_all(&response, &text);
                self.open_field(field.id, text, true);
            }
            return FieldResult::Editing;
        };
        if typing.is_new {
            response.request_focus();
            if typing.is_selected {
                select_all(&response, &text);
            }
            typing.is_new = false;
        }
        if response.changed() {
            self.forget_fault();
        }
        if response.has_focus() {
            self.memory.typing = Some(TypedText { text, ..typing });
            return FieldResult::Editing;
        }
        // A field that lost the focus while it was not shown keeps its text.
        let is_accepted = response.lost_focus() && !ui.input(|input| input.key_pressed(Key::Escape));
        if is_accepted && text != field.shown {
            return FieldResult::Changed(text);
        }
        self.forget_fault();
        FieldResult::Unchanged
    }

    fn edit(&self, ui: &mut Ui, field: &KnobTextField<'_>, text: &mut String) -> Response {
        let theme = self.theme;
        let painter = ui.painter();
        let has_focus = ui.memory(|memory| memory.has_focus(field.id));
        painter.rect_filled(field.rect, space::CORNER, theme.raised);
        let line = if has_focus { theme.accent } else { theme.line };
        painter.rect_stroke(field.rect, space::CORNER, (1.0, line), StrokeKind::Inside);
        let hint = egui::RichText::new(field.hint).color(theme.quiet);
        let edit = TextEdit::singleline(text)
            .id(field.id)
            .frame(Frame::NONE.inner_margin(Margin::symmetric(6, 0)))
            .font(egui::FontId::proportional(type_size::BODY * self.zoom))
            .text_color(theme.text)
            .hint_text(hint)
            .vertical_align(Align::Center)
            .desired_width(field.rect.width())
            .min_size(field.rect.size());
        let response = ui.place(field.rect, edit);
        ui.ctx()
            .accesskit_node_builder(field.id, |node| node.set_label(field.name));
        response
    }
}

/// Selects all of the text, so that typing replaces it.
pub(crate) fn select_all(response: &Response, text: &str) {
    // A field has no state before it is shown for the first time.
    let mut state = TextEdit::load_state(&response.ctx, response.id).unwrap_or_default();
    let all = CCursorRange::two(CCursor::default(), CCursor::new(text.chars().count()));
    state.cursor.set_char_range(Some(all));
    state.store(&response.ctx, response.id);
}
