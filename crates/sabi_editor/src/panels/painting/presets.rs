//! Brushes that are kept: those of the program and the artist's own.

use egui::{Button, Image, TextEdit, Ui, vec2};
use egui_phosphor::regular as icon;

use super::swatches::{SWATCH, Swatches};
use crate::action::{Action, PaintAction};
use crate::context::ViewContext;

/// The name that is typed for a brush, and the words that brushes are searched by.
#[derive(Default)]
pub(super) struct PresetName {
    name: String,
    query: String,
}

/// Shows the kept brushes.
pub(super) fn show(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    swatches: &mut Swatches,
    typed: &mut PresetName,
) -> Vec<Action> {
    let mut actions = Vec::new();
    ui.add(TextEdit::singleline(&mut typed.query).hint_text("Search brushes"));
    let query = typed.query.trim().to_lowercase();
    let found = context
        .brushes
        .brushes
        .iter()
        .filter(|kept| kept.name.to_lowercase().contains(&query));
    for kept in found {
        ui.horizontal(|ui| {
            let size = vec2(0.7 * SWATCH[0] as f32, 0.7 * SWATCH[1] as f32);
            let swatch = swatches.of(ui, context, &kept.brush.brush(1.0));
            let button = match swatch {
                Some(texture) => Button::image_and_text(Image::new((texture, size)), kept.name.as_str()),
                None => Button::new(kept.name.as_str()),
            };
            if ui.add(button.selected(kept.brush == context.settings.brush)).clicked() {
                actions.push(Action::Paint(PaintAction::UseKept(Box::new(kept.clone()))));
            }
            let Some(file) = &kept.file else { return };
            if ui
                .small_button(icon::TRASH)
                .on_hover_text("Remove this brush")
                .clicked()
            {
                actions.push(Action::Paint(PaintAction::RemoveKept(file.clone())));
            }
        });
    }
    ui.horizontal(|ui| {
        let field = TextEdit::singleline(&mut typed.name)
            .hint_text("Name")
            .desired_width(110.0);
        ui.add(field);
        let keep = ui.add_enabled(!typed.name.trim().is_empty(), Button::new("Keep this brush"));
        if keep.clicked() {
            actions.push(Action::Paint(PaintAction::Keep(std::mem::take(&mut typed.name))));
        }
        if ui
            .button("Open…")
            .on_hover_text("A brush that somebody gave you")
            .clicked()
        {
            actions.push(Action::Paint(PaintAction::AskForBrush));
        }
    });
    actions
}
