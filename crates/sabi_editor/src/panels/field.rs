//! A line of text that is asked for once it is finished: by Enter, or by going elsewhere. Escape gives it up.

use egui::AsIdSalt;

use egui::{Key, TextEdit, Ui, WidgetInfo, WidgetType};

/// What a line of text is, and what it shows while nobody types.
pub(crate) struct Field<'a> {
    /// What it is called, to those who do not see it.
    pub(crate) name: &'a str,
    /// What stands there while it is empty.
    pub(crate) hint: &'a str,
    pub(crate) held: &'a str,
    pub(crate) width: f32,
}

impl Field<'_> {
    /// Shows the line; gives what was typed once that is finished and something else than before.
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
        let is_given_up = ui.input(|input| input.key_pressed(Key::Escape));
        (response.lost_focus() && !is_given_up && text != self.held).then_some(text)
    }
}
