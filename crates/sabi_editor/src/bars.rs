//! The bars around the panels: menus, models, the path into groups, and the status.

mod document;
mod menus;
mod models;
mod status;
mod trust;

use egui::containers::menu::MenuConfig;
use egui::{Color32, Frame, Margin, PopupCloseBehavior, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::command::NavigationCommand;

use sabi_editing::navigation;

use crate::action::{Action, FileAction};
use crate::context::ViewContext;
use crate::paths::file_name;
pub(crate) use document::{LARGEST_SIZE, SIZES as WORKING_SIZES};
#[cfg(test)]
pub(crate) use menus::{ARRANGE, EDIT};
pub(crate) use menus::{marked_name, top};
pub(crate) use models::models;
pub(crate) use status::status;
pub(crate) use trust::trust;

/// Path into groups above the canvas, while a group is shown.
pub(crate) fn path(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    let path = navigation::breadcrumb(context.document);
    if path.is_empty() {
        return actions;
    }
    egui::Panel::top("path")
        .frame(bar(context.theme.panel, Margin::symmetric(8, 3)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                if ui.link("Graph").clicked() {
                    actions.push(Action::edit(NavigationCommand::LeaveTo(0)));
                }
                for (depth, (_, title)) in path.iter().enumerate() {
                    ui.label(icon::CARET_RIGHT);
                    if depth + 1 == path.len() {
                        ui.strong(title);
                    } else if ui.link(title).clicked() {
                        actions.push(Action::edit(NavigationCommand::LeaveTo(depth + 1)));
                    }
                }
            });
        });
    actions
}

/// Question about which graph to keep, while another program has changed the file of the open one.
pub(crate) fn foreign_file(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    let Some(file) = context.document.session.file().filter(|_| context.is_file_foreign) else {
        return actions;
    };
    let name = file_name(file);
    egui::Panel::top("outside")
        .frame(bar(context.theme.panel, Margin::symmetric(8, 4)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                let sentence = format!("{} Another program has written {name}.", icon::WARNING);
                ui.label(RichText::new(sentence).color(context.theme.warning));
                let reload = ui.button("Reload the file");
                if reload.on_hover_text("Undo brings back what is here now").clicked() {
                    actions.push(Action::File(FileAction::Reload));
                }
                let keep = ui.button("Keep the open graph");
                let backup = match context.settings.backups {
                    0 => "Saving puts it in the place of the other, of which no backup is kept".to_owned(),
                    _ => format!("Saving puts it in the place of the other, which stays beside it as {name}.bak"),
                };
                if keep.on_hover_text(backup).clicked() {
                    actions.push(Action::File(FileAction::KeepOpen));
                }
            });
        });
    actions
}

/// Menu that stays open after a click in it, since several of its entries are often chosen in a row.
pub(crate) fn stay_open() -> MenuConfig {
    MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside)
}

fn bar(fill: Color32, margin: Margin) -> Frame {
    Frame::new().fill(fill).inner_margin(margin)
}
