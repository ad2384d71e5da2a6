//! The models that the graph is tried on, and how their files are read.

use std::ops::RangeInclusive;
use std::path::Path;

use egui::containers::menu::MenuButton;
use egui::emath::Numeric;
use egui::{DragValue, Frame, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_engine::{Overlap, Up};

use super::Editor;
use crate::action::Action;
use crate::files::in_whole_folder;
use crate::model_view::staying;
use crate::reading::{LAST_UV, Reading, SCALES};
use crate::settings::MOST_MODELS;

impl Editor {
    /// Takes another model, and remembers it on the strip.
    pub(crate) fn take_model(&mut self, path: &Path) {
        let path = in_whole_folder(path);
        self.stage.take_model(&path, self.settings.reading(&path));
        self.remember_model();
    }

    /// Reads the model otherwise, now and from now on.
    pub(super) fn read_model(&mut self, reading: Reading) {
        let file = self.stage.model_file().to_owned();
        self.settings.remember_reading(&file, reading);
        self.stage.take_model(&file, reading);
    }

    /// Puts the model that is shown on the strip.
    pub(super) fn remember_model(&mut self) {
        let model = self.stage.model_file().to_owned();
        let models = &mut self.settings.models;
        if !models.contains(&model) {
            models.push(model);
        }
        if models.len() > MOST_MODELS {
            models.remove(0);
        }
    }

    /// The models that the graph is tried on.
    pub(super) fn model_strip(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let frame = Frame::new()
            .fill(self.theme.panel)
            .inner_margin(egui::Margin::symmetric(6, 3));
        egui::Panel::top("models")
            .frame(frame)
            .show_separator_line(false)
            .show(ui, |ui| {
                ui.horizontal(|ui| {
                    let mut gone = None;
                    for (at, model) in self.settings.models.iter().enumerate() {
                        let name = model.file_stem().unwrap_or_default().to_string_lossy();
                        let is_shown = self.stage.model_file() == model;
                        let response = ui.selectable_label(is_shown, format!("{} {name}", icon::CUBE));
                        if response.clicked() {
                            actions.push(Action::TakeModel(model.clone()));
                        }
                        response.on_hover_text(model.display().to_string()).context_menu(|ui| {
                            if ui.button("Take off the strip").clicked() {
                                gone = Some(at);
                            }
                        });
                    }
                    if let Some(at) = gone {
                        self.settings.models.remove(at);
                    }
                    let add = ui
                        .button(icon::PLUS)
                        .on_hover_text(format!("Add a model, up to {MOST_MODELS}"));
                    add.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, "Add a model"));
                    if add.clicked() {
                        self.files.ask_for_model();
                    }
                    let reading = self.stage.reading();
                    let is_usual = reading == Reading::default();
                    let color = if is_usual { self.theme.text } else { self.theme.accent };
                    let sign = RichText::new(icon::SLIDERS_HORIZONTAL).color(color);
                    let sign = egui::Button::new(sign).frame(false);
                    let menu = MenuButton::from_button(sign).config(staying());
                    let (button, _) = menu.ui(ui, |ui| reading_menu(ui, reading, actions));
                    button.widget_info(|| {
                        egui::WidgetInfo::labeled(egui::WidgetType::Button, true, "How the model is read")
                    });
                    button.on_hover_text("How the model is read: its upright axis, UVs and lengths");
                });
            });
    }
}

/// What files leave open.
fn reading_menu(ui: &mut Ui, now: Reading, actions: &mut Vec<Action>) {
    let mut wanted = now;
    ui.label("Upright in the file is");
    ui.horizontal(|ui| {
        for (axis, name) in [(Up::Y, "+Y"), (Up::Z, "+Z"), (Up::X, "+X")] {
            ui.radio_value(&mut wanted.up, axis, name);
        }
    });
    wanted.uv = settled(ui, "UV set", now.uv, 0..=LAST_UV, 0.05);
    let scales = SCALES[0]..=SCALES[1];
    wanted.scale = settled(ui, "Lengths are multiplied by", now.scale, scales, 0.01);
    ui.separator();
    ui.label("Where UVs lie over one another the maps have");
    for (overlap, name) in [
        (Overlap::First, "what the first of them gets"),
        (Overlap::Merge, "the mean of all"),
        (Overlap::Unwrap, "places of their own, on a second UV set"),
    ] {
        ui.radio_value(&mut wanted.overlap, overlap, name);
    }
    if now != Reading::default() && ui.button("As the file has it").clicked() {
        wanted = Reading::default();
    }
    if wanted != now {
        actions.push(Action::ReadModel(wanted));
    }
}

/// A number that counts once it is let go of, since the model is read anew for it.
fn settled<N: Numeric + Send + Sync>(ui: &mut Ui, name: &str, now: N, range: RangeInclusive<N>, speed: f64) -> N {
    let id = ui.id().with(name);
    let mut held = ui.data(|data| data.get_temp(id)).unwrap_or(now);
    let field = DragValue::new(&mut held).range(range).speed(speed);
    let row = ui.horizontal(|ui| {
        let label = ui.label(name);
        ui.add(field.update_while_editing(false)).labelled_by(label.id)
    });
    if row.inner.dragged() {
        ui.data_mut(|data| data.insert_temp(id, held));
        return now;
    }
    ui.data_mut(|data| data.remove::<N>(id));
    held
}
