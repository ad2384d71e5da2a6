//! Variants: named sets of values, as cards with pictures of the open model. The chosen variant is shown, and the knobs
//! change it.

use egui::{Key, RichText, TextureId, Ui, Vec2, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::command::VariantCommand;
use sabi_editing::{OpenDocument, exposed_knobs, shown_variant, variants};
use sabi_nodes::label_of;

use super::card::{Card, CardSize};
use crate::action::Action;
use crate::choice_previews::PreviewChoice;
use crate::context::ViewContext;
use crate::theme::{space, type_size};

/// Variants of the shown graph.
#[derive(Default)]
pub(crate) struct Variants {
    /// Name that was typed for the next one.
    name: String,
    /// Variant that is being renamed.
    renaming: Option<VariantRename>,
    size: CardSize,
}

struct VariantRename {
    name: String,
    to: String,
    is_new: bool,
}

impl Variants {
    /// Shows the variants of the shown graph and returns the requested action.
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
        let (document, theme) = (context.document, context.theme);
        let panel = exposed_knobs::knobs(document);
        if panel.is_empty() {
            return None;
        }
        let mut action = None;
        ui.add_space(space::WIDE);
        ui.horizontal(|ui| {
            ui.label(RichText::new("VARIANTS").size(type_size::SMALL).color(theme.quiet));
            if !document.graph().variants().is_empty() {
                self.size.switch(ui);
            }
        });
        let saved = document.graph().variants();
        if !saved.is_empty() {
            let shown = shown_variant::name(document);
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = Vec2::splat(space::USUAL);
                let base = VariantCard {
                    name: None,
                    text: variants::own_as_text(document),
                    is_shown: shown.is_none(),
                };
                action = base.show(ui, context, self);
                for (name, values) in saved {
                    let card = VariantCard {
                        name: Some(name),
                        text: variants::as_text(document, values),
                        is_shown: shown == Some(name),
                    };
                    action = card.show(ui, context, self).or(action.take());
                }
            });
            if let Some(name) = shown {
                let sentence = format!("Changes apply to the variant '{}' only.", label_of(name));
                ui.add(egui::Label::new(RichText::new(sentence).color(theme.quiet)).wrap());
            }
        }
        let renamed = rename(ui, &mut self.renaming);
        let saved = save(ui, document, self);
        renamed.or(saved).or(action)
    }
}

/// Variant, or the graph's own values, as a card.
struct VariantCard<'a> {
    /// Name of the variant; `None` stands for the graph's own values.
    name: Option<&'a str>,
    /// Text that identifies it for its saved picture.
    text: String,
    is_shown: bool,
}

impl VariantCard<'_> {
    fn show(&self, ui: &mut Ui, context: &ViewContext<'_>, variants: &mut Variants) -> Option<Action> {
        let label = self.name.map_or_else(|| "Base".to_owned(), label_of);
        let card = Card {
            label: &label,
            picture: self.picture(ui, context),
            sign: if self.name.is_some() {
                icon::SWATCHES
            } else {
                icon::CUBE
            },
            is_shown: self.is_shown,
            size: variants.size,
        };
        let text = match self.name {
            None => "Show the graph with its own values, as without a variant".to_owned(),
            Some(_) => format!("Show the variant '{label}'"),
        };
        let response = card.show(ui, context.theme, &text);
        let mut action = response
            .clicked()
            .then(|| Action::edit(VariantCommand::Show(self.name.map(str::to_owned))));
        let Some(name) = self.name else {
            return action;
        };
        response.context_menu(|ui| {
            if ui.button("Rename").clicked() {
                variants.renaming = Some(VariantRename {
                    name: name.to_owned(),
                    to: name.to_owned(),
                    is_new: true,
                });
            }
            if ui.button("Update to the present values").clicked() {
                action = Some(Action::SaveVariant(name.to_owned()));
            }
            if ui.button("Remove").clicked() {
                action = Some(Action::edit(VariantCommand::Remove(name.to_owned())));
            }
        });
        action
    }

    /// Picture of the variant on the open model; until that is drawn, the picture from when the variant was shown last.
    fn picture(&self, ui: &Ui, context: &ViewContext<'_>) -> Option<TextureId> {
        let tried = context.choice_previews.find(PreviewChoice::Variant {
            place: format!("{:?}", context.document.shown()),
            instance: None,
            name: self.name.map(str::to_owned),
        });
        tried.or_else(|| context.pictures.find(ui.ctx(), context.file_or_empty(), &self.text))
    }
}

fn rename(ui: &mut Ui, renaming: &mut Option<VariantRename>) -> Option<Action> {
    let open = renaming.as_mut()?;
    let edit = egui::TextEdit::singleline(&mut open.to).desired_width(f32::INFINITY);
    let field = ui.add(edit);
    field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "New name of the variant"));
    if std::mem::take(&mut open.is_new) {
        field.request_focus();
    }
    if !field.lost_focus() {
        return None;
    }
    let is_canceled = ui.input(|input| input.key_pressed(Key::Escape));
    let VariantRename { name, to, .. } = renaming.take()?;
    (!is_canceled && name != to).then(|| Action::edit(VariantCommand::Rename { name, to }))
}

/// Row that saves the present values.
fn save(ui: &mut Ui, document: &OpenDocument, variants: &mut Variants) -> Option<Action> {
    let row = egui::vec2(ui.available_width(), space::ROW);
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.allocate_ui_with_layout(row, layout, |ui| {
        let name = &mut variants.name;
        let is_known = document.graph().variants().contains_key(name.trim());
        let verb = if is_known { "Replace" } else { "Save" };
        let can_save = !name.trim().is_empty();
        let save = ui.add_enabled(can_save, egui::Button::new(verb));
        let tooltip = "Saves the present values with a picture of the model";
        let is_clicked = save.on_hover_text(tooltip).clicked();
        let edit = egui::TextEdit::singleline(name)
            .hint_text("Name of a variant")
            .desired_width(ui.available_width() - space::USUAL);
        let field = ui.add(edit);
        field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Name of a variant"));
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        (can_save && (is_entered || is_clicked)).then(|| Action::SaveVariant(std::mem::take(name)))
    })
    .inner
}
