//! Steps that were done; a click goes to one.

use egui::{RichText, ScrollArea, Ui};

use crate::action::Action;
use crate::context::{View, ViewContext};

/// Panel of the steps that were done and undone.
pub(crate) struct HistoryPanel;

impl View for HistoryPanel {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let theme = context.theme;
        let session = &context.document.session;
        let done: Vec<&str> = session.undo_names().collect();
        let undone: Vec<&str> = session.redo_names().rev().collect();
        if done.is_empty() && undone.is_empty() {
            ui.colored_label(theme.quiet, "Nothing was changed yet.");
            return actions;
        }
        let row = ui.spacing().interact_size.y;
        let area = ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true);
        area.show_rows(ui, row, done.len() + undone.len() + 1, |ui, rows| {
            for at in rows {
                let (name, is_done) = match at.checked_sub(1) {
                    None => ("Start", true),
                    Some(at) if at < done.len() => (done[at], true),
                    Some(at) => (undone[at - done.len()], false),
                };
                let text = RichText::new(name).color(if is_done { theme.text } else { theme.quiet });
                if ui.selectable_label(at == done.len(), text).clicked() {
                    actions.push(Action::Steps(at as i32 - done.len() as i32));
                }
            }
        });
        actions
    }
}
