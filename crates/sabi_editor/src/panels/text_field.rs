//! Text fields whose text is used once they are finished, by Enter or by leaving them. Escape cancels.

use egui::AsIdSalt;

use egui::{Key, TextEdit, Ui, WidgetInfo, WidgetType};

/// Text field of one line.
pub(crate) struct TextField<'a> {
    /// Accessible name.
    pub(crate) name: &'a str,
    /// Hint while it is empty.
    pub(crate) hint: &'a str,
    pub(crate) held: &'a str,
    pub(crate) width: f32,
}

impl TextField<'_> {
    /// Shows the field. Returns the text once it is finished and has changed.
    pub(crate) fn show(&self, ui: &mut Ui, id: impl AsIdSalt) -> Option<String> {
        let id = ui.make_persistent_id(id);
        let typed: Option<String> = ui.data(|data| data.get_temp(id));
        let mut text = typed.unwrap_or_else(|| self.held.to_owned());
        let edit = TextEdit::singleline(&mut text)
            .id(id)
            .hint_text(self.hint)
            .desired_width(self.width);
        let response = ui.add(edit);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, ui.is_enabled(), self.name));
        if response.has_focus() {
            ui.data_mut(|data| data.insert_temp(id, text));
            return None;
        }
        ui.data_mut(|data| data.remove_temp::<String>(id));
        let is_canceled = ui.input(|input| input.key_pressed(Key::Escape));
        (response.lost_focus() && !is_canceled && text != self.held).then_some(text)
    }
}
