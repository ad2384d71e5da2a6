//! What was done, step by step; a click goes there.

use egui::{RichText, Ui};

use crate::action::Action;
use crate::app::Editor;
use crate::theme::Theme;

pub(crate) fn show(editor: &Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let done: Vec<&str> = editor.document.session.undo_names().collect();
    let undone: Vec<&str> = editor.document.session.redo_names().rev().collect();
    if done.is_empty() && undone.is_empty() {
        ui.colored_label(theme.quiet, "Nothing was changed yet.");
        return;
    }
    let row = ui.spacing().interact_size.y;
    let area = egui::ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true);
    area.show_rows(ui, row, done.len() + undone.len() + 1, |ui, rows| {
        for at in rows {
            let (name, is_done) = match at.checked_sub(1) {
                None => ("As it was opened", true),
                Some(at) if at < done.len() => (done[at], true),
                Some(at) => (undone[at - done.len()], false),
            };
            let text = RichText::new(name).color(if is_done { theme.text } else { theme.quiet });
            if ui.selectable_label(at == done.len(), text).clicked() {
                actions.push(Action::Steps(at as i32 - done.len() as i32));
            }
        }
    });
}
