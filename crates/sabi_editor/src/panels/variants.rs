//! Variants: named sets of values, as cards with the model as it looked when they were saved. The card that is chosen is
//! shown, and changed by the knobs.

use egui::{Align2, Color32, FontId, Key, Rect, RichText, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::command::VariantCommand;
use sabi_editing::{OpenDocument, panel, shown_variant, variants};
use sabi_engine::catalog::label_of;

use crate::action::Action;
use crate::context::ViewContext;
use crate::theme::{Theme, space, type_size};

/// Width of a card, and height of its picture.
const SIDE: f32 = 84.0;
/// Height of the name below it.
const NAME: f32 = 18.0;

/// Variants of the shown graph.
#[derive(Default)]
pub(crate) struct Variants {
    /// Name that was typed for the next one.
    name: String,
    /// Variant that is being renamed.
    renaming: Option<Renaming>,
}

struct Renaming {
    name: String,
    to: String,
    is_new: bool,
}

impl Variants {
    /// Shows the variants of the shown graph and returns the requested action.
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
        let (document, theme) = (context.document, context.theme);
        let panel = panel::knobs(document);
        if panel.is_empty() {
            return None;
        }
        let mut action = None;
        ui.add_space(space::WIDE);
        ui.label(RichText::new("VARIANTS").size(type_size::SMALL).color(theme.quiet));
        let saved = document.graph().variants();
        if !saved.is_empty() {
            let shown = shown_variant::name(document);
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = Vec2::splat(space::USUAL);
                let own = variants::own_as_text(document);
                let base = Card {
                    name: None,
                    picture: context.pictures.find(ui.ctx(), context.file_or_empty(), &own),
                    is_shown: shown.is_none(),
                };
                action = base.show(ui, theme, self);
                for (name, values) in saved {
                    let text = variants::as_text(document, values);
                    let card = Card {
                        name: Some(name),
                        picture: context.pictures.find(ui.ctx(), context.file_or_empty(), &text),
                        is_shown: shown == Some(name),
                    };
                    action = card.show(ui, theme, self).or(action.take());
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

/// Card of a variant, or of the graph's own values.
struct Card<'a> {
    /// Name of the variant; `None` stands for the graph's own values.
    name: Option<&'a str>,
    picture: Option<egui::TextureId>,
    is_shown: bool,
}

impl Card<'_> {
    fn show(&self, ui: &mut Ui, theme: &Theme, variants: &mut Variants) -> Option<Action> {
        let (rect, response) = ui.allocate_exact_size(Vec2::new(SIDE, SIDE + NAME), Sense::click());
        response.widget_info(|| WidgetInfo::selected(WidgetType::Button, true, self.is_shown, self.label()));
        self.paint(ui, theme, rect, response.hovered() || response.has_focus());
        let mut action = response
            .clicked()
            .then(|| Action::edit(VariantCommand::Show(self.name.map(str::to_owned))));
        let Some(name) = self.name else {
            response.on_hover_text("Show the graph with its own values, as without a variant");
            return action;
        };
        let response = response.on_hover_text(format!("Show the variant '{}'", self.label()));
        response.context_menu(|ui| {
            if ui.button("Rename").clicked() {
                variants.renaming = Some(Renaming {
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

    fn label(&self) -> String {
        self.name.map_or_else(|| "Base".to_owned(), label_of)
    }

    fn paint(&self, ui: &Ui, theme: &Theme, rect: Rect, is_hovered: bool) {
        if !ui.is_rect_visible(rect) {
            return;
        }
        let fill = if is_hovered { theme.hovered } else { theme.raised };
        ui.painter().rect_filled(rect, space::CORNER, fill);
        let square = Rect::from_min_size(rect.min, Vec2::splat(SIDE)).shrink(3.0);
        match self.picture {
            Some(picture) => {
                let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                ui.painter().image(picture, square, whole, Color32::WHITE);
            }
            None => {
                let font = FontId::proportional(type_size::TITLE);
                let sign = if self.name.is_some() {
                    icon::SWATCHES
                } else {
                    icon::CUBE
                };
                ui.painter()
                    .text(square.center(), Align2::CENTER_CENTER, sign, font, theme.line);
            }
        }
        let room = rect.with_min_y(square.bottom()).shrink2(Vec2::new(4.0, 0.0));
        let color = if self.is_shown { theme.text } else { theme.quiet };
        let mut job =
            egui::text::LayoutJob::simple_singleline(self.label(), FontId::proportional(type_size::SMALL), color);
        job.wrap = egui::text::TextWrapping::truncate_at_width(room.width());
        let name = ui.painter().layout_job(job);
        let at = Align2::CENTER_CENTER.align_size_within_rect(name.size(), room);
        ui.painter().galley(at.min, name, color);
        if self.is_shown {
            let line = Stroke::new(1.5, theme.accent);
            ui.painter().rect_stroke(rect, space::CORNER, line, StrokeKind::Inside);
        }
    }
}

fn rename(ui: &mut Ui, renaming: &mut Option<Renaming>) -> Option<Action> {
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
    let Renaming { name, to, .. } = renaming.take()?;
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
