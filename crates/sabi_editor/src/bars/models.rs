//! The strip of models above the viewport, and the menu of how their files are read.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use egui::containers::menu::MenuButton;
use egui::emath::Numeric;
use egui::{Button, DragValue, Margin, RichText, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_engine::{Overlap, Up};

use super::{bar, stay_open};
use crate::action::{Action, ModelAction};
use crate::context::ViewContext;
use crate::import_options::{ImportOptions, LAST_UV, SCALES};
use crate::paths::file_stem;
use crate::settings::MOST_MODELS;

/// Strip of the models that the graph is tried on.
pub(crate) fn models(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    egui::Panel::top("models")
        .frame(bar(context.theme.panel, Margin::symmetric(6, 3)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                strip(ui, context, &mut actions);
                let add = ui
                    .button(icon::PLUS)
                    .on_hover_text(format!("Add a model, up to {MOST_MODELS}"));
                add.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Add a model"));
                if add.clicked() {
                    actions.push(Action::Model(ModelAction::Ask));
                }
                options(ui, context, &mut actions);
            });
        });
    actions
}

fn strip(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let requested = context.evaluation.model.file();
    let known = context.settings.models.iter().map(PathBuf::as_path);
    // A model joins the list once it could be read, and has its place there from the beginning.
    let new = (!known.clone().any(|model| model == requested)).then_some(requested);
    for model in known.chain(new) {
        let is_shown = requested == model;
        let name = format!("{} {}", icon::CUBE, file_stem(model));
        let response = ui.selectable_label(is_shown, name);
        if response.clicked() {
            actions.push(Action::Model(ModelAction::Show(model.to_owned())));
        }
        response.on_hover_text(model.display().to_string()).context_menu(|ui| {
            if ui.button("Remove from the list").clicked() {
                actions.push(Action::Model(ModelAction::Remove(model.to_owned())));
            }
        });
    }
}

fn options(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let reading = context.evaluation.model.import_options();
    let is_usual = reading == ImportOptions::default();
    let theme = context.theme;
    let color = if is_usual { theme.text } else { theme.accent };
    let sign = RichText::new(icon::SLIDERS_HORIZONTAL).color(color);
    let menu = MenuButton::from_button(Button::new(sign).frame(false)).config(stay_open());
    let (button, _) = menu.ui(ui, |ui| import_menu(ui, reading, actions));
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "How the model is read"));
    button.on_hover_text("How the model is read: its upright axis, UVs and lengths");
}

/// Menu of what the file of a model leaves open.
fn import_menu(ui: &mut Ui, now: ImportOptions, actions: &mut Vec<Action>) {
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
    if now != ImportOptions::default() && ui.button("As the file has it").clicked() {
        wanted = ImportOptions::default();
    }
    if wanted != now {
        actions.push(Action::Model(ModelAction::Read(wanted)));
    }
}

/// Field of a number that is used once its drag ends, since the model is read again for it.
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
