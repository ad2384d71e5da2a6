//! Groups whose library has a newer version: pictures of the model before and after an update, and the buttons that
//! update.

use egui::{RichText, Ui, Vec2};
use egui_phosphor::regular as icon;
use sabi_editing::command::GroupCommand;

use super::card::{Card, CardSize};
use crate::action::Action;
use crate::choice_previews::PreviewChoice;
use crate::context::ViewContext;
use crate::theme::space;

/// Shows all groups with a newer version; nothing where there are none.
pub(super) fn all(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let outdated = context.outdated_groups();
    let mut commands = Vec::new();
    let text = match outdated.as_slice() {
        [] => return Vec::new(),
        [_] => "The library has a newer version of a group.".to_owned(),
        several => format!("The library has newer versions of {} groups.", several.len()),
    };
    let text = format!("{} {text}", icon::ARROWS_CLOCKWISE);
    ui.add(egui::Label::new(RichText::new(text).color(context.theme.warning)).wrap());
    before_and_after(ui, context, &outdated);
    ui.horizontal_wrapped(|ui| {
        for group in &outdated {
            let update = ui.button(format!("Update {group}"));
            if update.on_hover_text(KEEPS_VALUES).clicked() {
                commands.push(GroupCommand::Update(vec![group.clone()]));
            }
        }
        commands.extend(update_all(ui, &outdated));
    });
    ui.separator();
    commands.into_iter().map(Action::edit).collect()
}

/// Shows that a group has a newer version; nothing where it has none.
pub(super) fn of_group(ui: &mut Ui, context: &ViewContext<'_>, group: &str) -> Option<GroupCommand> {
    let outdated = context.outdated_groups();
    if !outdated.iter().any(|name| name == group) {
        return None;
    }
    ui.colored_label(context.theme.warning, "The library has a newer version.");
    before_and_after(ui, context, &[group.to_owned()]);
    let mut command = None;
    ui.horizontal_wrapped(|ui| {
        if ui.button("Update").on_hover_text(KEEPS_VALUES).clicked() {
            command = Some(GroupCommand::Update(vec![group.to_owned()]));
        }
        command = update_all(ui, &outdated).or(command.take());
    });
    command
}

const KEEPS_VALUES: &str = "Keeps the values of the parameters";

fn update_all(ui: &mut Ui, outdated: &[String]) -> Option<GroupCommand> {
    let is_wanted = outdated.len() > 1 && ui.button(format!("Update all {}", outdated.len())).clicked();
    is_wanted.then(|| GroupCommand::Update(outdated.to_vec()))
}

/// The model as it looks now, and as it looks once these groups are updated.
fn before_and_after(ui: &mut Ui, context: &ViewContext<'_>, groups: &[String]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(space::USUAL);
        for (is_after, label) in [(false, "Before"), (true, "After")] {
            let card = Card {
                label,
                picture: context.choice_previews.find(PreviewChoice::Update {
                    groups: groups.to_vec(),
                    is_after,
                }),
                sign: icon::CUBE,
                is_shown: false,
                size: CardSize::Large,
            };
            let text = match is_after {
                false => "The model as it is",
                true => "The model with the newer version",
            };
            card.show(ui, context.theme, text);
        }
    });
}
