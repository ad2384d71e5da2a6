//! The strip of models above the viewport, and the menu of how their files are read.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use egui::containers::menu::MenuButton;
use egui::emath::Numeric;
use egui::{Button, Checkbox, DragValue, Margin, RichText, ScrollArea, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_engine::opening::linked_model::Overlap;
use sabi_surface::atlas::Udim;
use sabi_surface::load::{PartChoice, Up};
use sabi_surface::model::FilePart;

use super::{bar, stay_open};
use crate::action::{Action, ModelAction};
use crate::context::ViewContext;
use crate::dock::Panel;
use crate::files::examples;
use crate::import_options::{ImportOptions, LAST_SCENE, LAST_UV, SCALES, SMOOTH_ANGLES, USUAL_SMOOTH_ANGLE};
use crate::model_warnings;
use crate::paths::file_stem;
use crate::theme::space;

/// Width of the buttons and the badge after the models, and of the one for those that do not fit, points.
const OTHER_BUTTONS: f32 = 8.0 * space::ROW;
const MORE: f32 = 2.0 * space::ROW;
/// Height of the list of models that can be shown beside the main one, points.
const LONGEST_MENU: f32 = 420.0;

/// Strip of the models that the graph is tried on.
pub(crate) fn models(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    egui::Panel::top("models")
        .frame(bar(context.theme.panel, Margin::symmetric(6, 3)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                strip(ui, context, &mut actions);
                let add = ui.button(icon::PLUS).on_hover_text("Add a model");
                add.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Add a model"));
                if add.clicked() {
                    actions.push(Action::Model(ModelAction::Ask));
                }
                beside(ui, context, &mut actions);
                options(ui, context, &mut actions);
                // The last of the row, so that no button or open menu moves away from the pointer when it appears.
                let model = &context.evaluation.model;
                if model_warnings::badge(ui, context.theme, &file_stem(model.file()), model.warnings()) {
                    actions.push(Action::ShowPanel(Panel::Problems));
                }
            });
        });
    actions
}

/// The models, as many as there is room for. The others are in a menu; the shown one never is.
fn strip(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let requested = context.evaluation.model.file();
    let known = context.models.iter().map(PathBuf::as_path);
    // A model joins the list once it was read, but is shown at its place there from the beginning.
    let new = (!known.clone().any(|model| model == requested)).then_some(requested);
    let mut models: Vec<&Path> = known.chain(new).collect();
    let room = ui.available_width() - OTHER_BUTTONS;
    let widths: Vec<f32> = models.iter().map(|model| entry_width(ui, model)).collect();
    let mut count = fitting(&widths, room);
    if count < models.len() {
        count = fitting(&widths, room - MORE).max(1);
        if let Some(at) = models[count..].iter().position(|model| *model == requested) {
            models.swap(count - 1, count + at);
        }
    }
    for model in &models[..count] {
        entry(ui, model, requested, actions);
    }
    if count < models.len() {
        let more = format!("{} {}", models.len() - count, icon::CARET_DOWN);
        let (button, _) = MenuButton::new(more).ui(ui, |ui| {
            for model in &models[count..] {
                entry(ui, model, requested, actions);
            }
        });
        button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "More models"));
        button.on_hover_text("More models");
    }
}

/// Number of entries from the first on that fit into a width.
fn fitting(widths: &[f32], room: f32) -> usize {
    let mut left = room;
    let fits = widths.iter().take_while(|width| {
        left -= **width;
        left >= 0.0
    });
    fits.count()
}

fn entry_name(model: &Path) -> String {
    format!("{} {}", icon::CUBE, file_stem(model))
}

/// Width of a model's entry with the space after it.
fn entry_width(ui: &Ui, model: &Path) -> f32 {
    let font = egui::TextStyle::Button.resolve(ui.style());
    let galley = ui
        .painter()
        .layout_no_wrap(entry_name(model), font, egui::Color32::WHITE);
    galley.size().x + 2.0 * ui.spacing().button_padding.x + ui.spacing().item_spacing.x
}

fn entry(ui: &mut Ui, model: &Path, shown: &Path, actions: &mut Vec<Action>) {
    let response = ui.selectable_label(model == shown, entry_name(model));
    if response.clicked() {
        actions.push(Action::Model(ModelAction::Show(model.to_owned())));
    }
    response.on_hover_text(model.display().to_string()).context_menu(|ui| {
        if ui.button("Remove from the list").clicked() {
            actions.push(Action::Model(ModelAction::Remove(model.to_owned())));
        }
    });
}

/// Button of the menu of models that are shown beside the main one.
fn beside(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let count = context.row.beside().len();
    let theme = context.theme;
    let color = if count == 0 { theme.text } else { theme.accent };
    let sign = match count {
        0 => icon::SQUARES_FOUR.to_owned(),
        _ => format!("{} {}", icon::SQUARES_FOUR, count + 1),
    };
    let button = Button::new(RichText::new(sign).color(color));
    let menu = MenuButton::from_button(button).config(stay_open());
    let (button, _) = menu.ui(ui, |ui| beside_menu(ui, context, actions));
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Models side by side"));
    button.on_hover_text("Models side by side, each with this graph");
}

/// Menu of the models that can be shown beside the main one: those of the strip, then Sabi's own, then any file.
fn beside_menu(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let main = context.evaluation.model.file();
    let own: Vec<PathBuf> = context.examples.into_iter().flat_map(examples::models).collect();
    let known = context.models.iter().map(PathBuf::as_path);
    let beside = context.row.beside().iter().map(|evaluation| evaluation.model.file());
    // A file that could not be read is not on the strip.
    let beside = beside.filter(|model| !own.iter().any(|own| own == model));
    let mut models: Vec<&Path> = Vec::new();
    for model in known.chain(beside).filter(|model| *model != main) {
        if !models.contains(&model) {
            models.push(model);
        }
    }
    let is_named = |file: &Path| {
        let mut named = models.iter().chain([&main]);
        named.any(|model| model.file_name() == file.file_name())
    };
    let own: Vec<&Path> = own
        .iter()
        .map(PathBuf::as_path)
        .filter(|file| !is_named(file))
        .collect();
    ui.weak("Beside the first model");
    ScrollArea::vertical().max_height(LONGEST_MENU).show(ui, |ui| {
        for model in models {
            beside_entry(ui, context, model, actions);
        }
        if !own.is_empty() {
            ui.separator();
            for model in own {
                beside_entry(ui, context, model, actions);
            }
        }
    });
    ui.separator();
    if ui.button("A file…").clicked() {
        actions.push(Action::Model(ModelAction::AskBeside));
        ui.close();
    }
}

/// Check box of a model that can be shown beside the main one.
fn beside_entry(ui: &mut Ui, context: &ViewContext<'_>, model: &Path, actions: &mut Vec<Action>) {
    let is_beside = context.row.contains(model);
    let mut wanted = is_beside;
    let entry = ui.checkbox(&mut wanted, file_stem(model).into_owned());
    entry.on_hover_text(model.display().to_string());
    match (is_beside, wanted) {
        (false, true) => actions.push(Action::Model(ModelAction::ShowBeside(model.to_owned()))),
        (true, false) => actions.push(Action::Model(ModelAction::RemoveBeside(model.to_owned()))),
        _ => {}
    }
}

fn options(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let model = &context.evaluation.model;
    let reading = model.import_options();
    let is_usual = *reading == ImportOptions::default();
    let theme = context.theme;
    let color = if is_usual { theme.text } else { theme.accent };
    let sign = RichText::new(icon::SLIDERS_HORIZONTAL).color(color);
    let menu = MenuButton::from_button(Button::new(sign).frame(false)).config(stay_open());
    let (button, _) = menu.ui(ui, |ui| {
        import_menu(ui, reading, model.file_parts(), actions);
    });
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "How the model is read"));
    button.on_hover_text("Import settings: up axis, UVs, scale, parts");
}

/// Menu of the import options of a model.
fn import_menu(ui: &mut Ui, now: &ImportOptions, parts: &[FilePart], actions: &mut Vec<Action>) {
    let mut wanted = now.clone();
    ui.label("Up axis");
    ui.horizontal(|ui| {
        for (axis, name) in [(Up::Y, "+Y"), (Up::Z, "+Z"), (Up::X, "+X")] {
            ui.radio_value(&mut wanted.up, axis, name);
        }
    });
    wanted.uv = settled(ui, "UV set", now.uv, 0..=LAST_UV, 0.05);
    let scales = SCALES[0]..=SCALES[1];
    wanted.scale = settled(ui, "Scale", now.scale, scales, 0.01);
    let mut is_smoothed = now.smooth.is_some();
    ui.checkbox(&mut is_smoothed, "Smooth the faces")
        .on_hover_text("Rounds the shading of faceted models, in place of the normals in the file.");
    wanted.smooth = is_smoothed.then(|| {
        let degrees = now.smooth.unwrap_or(USUAL_SMOOTH_ANGLE);
        settled(ui, "Up to, degrees", degrees, SMOOTH_ANGLES, 1.0)
    });
    ui.checkbox(&mut wanted.turn_faces, "Turn faces that are inside out")
        .on_hover_text("Faces against those around them, and those of closed bodies that look inward.");
    let mut is_scene_chosen = now.scene.is_some();
    ui.checkbox(&mut is_scene_chosen, "Choose another scene of the file")
        .on_hover_text("Takes a scene of a glTF file by its number, in place of the one that the file names.");
    // The first scene is the one that most files name.
    wanted.scene = is_scene_chosen.then(|| settled(ui, "Scene", now.scene.unwrap_or(0), 0..=LAST_SCENE, 0.05));
    ui.separator();
    ui.label("UVs in several tiles");
    for (udim, name) in [
        (Udim::Auto, "As they look"),
        (Udim::On, "UDIM: maps for each tile"),
        (Udim::Off, "A texture that repeats"),
    ] {
        ui.radio_value(&mut wanted.udim, udim, name);
    }
    ui.separator();
    ui.label("Where UVs overlap");
    for (overlap, name) in [
        (Overlap::Auto, "Use the first, and unwrap what repeats often"),
        (Overlap::First, "Use the first"),
        (Overlap::Merge, "Take the average"),
        (Overlap::Unwrap, "Unwrap to a new UV set"),
    ] {
        ui.radio_value(&mut wanted.overlap, overlap, name);
    }
    if let Some(choice) = part_list(ui, parts) {
        wanted.parts = choice;
    }
    if *now != ImportOptions::default() && ui.button("Reset").clicked() {
        wanted = ImportOptions::default();
    }
    if wanted != *now {
        actions.push(Action::Model(ModelAction::Read(wanted)));
    }
}

/// Height of the list of parts, points.
const LONGEST_PARTS: f32 = 160.0;

/// List of the parts of a file, each with a check box; returns the choice once one is clicked.
fn part_list(ui: &mut Ui, parts: &[FilePart]) -> Option<PartChoice> {
    let mut names: Vec<&str> = Vec::new();
    let mut known: BTreeSet<&str> = BTreeSet::new();
    let mut taken: BTreeSet<&str> = BTreeSet::new();
    let mut usual: BTreeSet<&str> = BTreeSet::new();
    for part in parts {
        let name = part.name.as_str();
        if known.insert(name) {
            names.push(name);
        }
        taken.extend(part.left_out.is_none().then_some(name));
        usual.extend(part.is_usual.then_some(name));
    }
    // A file of one part leaves nothing to choose.
    if names.len() < 2 {
        return None;
    }
    ui.separator();
    ui.label("Parts");
    let mut clicked = None;
    let height = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt("parts")
        .max_height(LONGEST_PARTS)
        .show_rows(ui, height, names.len(), |ui, rows| {
            for name in &names[rows] {
                let mut is_taken = taken.contains(name);
                // At least one part stays: a model without parts cannot be shown.
                let is_last = is_taken && taken.len() == 1;
                let entry = ui.add_enabled(!is_last, Checkbox::new(&mut is_taken, *name));
                if entry.changed() {
                    clicked = Some((*name, is_taken));
                }
            }
        });
    let (name, is_taken) = clicked?;
    if is_taken {
        taken.insert(name);
    } else {
        taken.remove(name);
    }
    Some(choice_of(&names, &taken, &usual))
}

/// Shortest choice that gives the `taken` parts, where an empty choice gives the `usual` ones.
fn choice_of(names: &[&str], taken: &BTreeSet<&str>, usual: &BTreeSet<&str>) -> PartChoice {
    let listed = |is_listed: &dyn Fn(&str) -> bool| -> Vec<String> {
        let names = names.iter().filter(|name| is_listed(name));
        names.map(|name| (*name).to_owned()).collect()
    };
    if taken.is_subset(usual) {
        return PartChoice {
            parts: Vec::new(),
            without: listed(&|name| usual.contains(name) && !taken.contains(name)),
        };
    }
    if taken.len() == names.len() {
        return PartChoice::all();
    }
    PartChoice {
        parts: listed(&|name| taken.contains(name)),
        without: Vec::new(),
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
