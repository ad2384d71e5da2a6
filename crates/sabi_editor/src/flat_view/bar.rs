//! The bar above the texture: the title of the result, and choices of what is shown of it.

use egui::{Align, Label, Layout, RichText, Ui, UiBuilder, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;
use sabi_engine::live::{InspectedResult, LiveModel};

use super::{FlatView, FlatViewSubject};
use crate::evaluation::Evaluation;
use crate::theme::space;

/// Least width of the title, and width of the switches with the size of the texture, points.
const LEAST_TITLE: f32 = 80.0;
const SWITCHES: f32 = 180.0;
/// Widths of the menus of texture sets and of planes, points; longer names are cut off.
const SETS: f32 = 130.0;
const PLANES: f32 = 100.0;
/// Widths of the switch of all components, and of one component, points.
const ALL_COMPONENTS: f32 = 44.0;
const COMPONENT: f32 = 26.0;

/// Part of the bar that chooses what is shown.
#[derive(Clone, Copy)]
enum Choice {
    Sets,
    Planes,
    Components,
}

impl FlatView {
    /// Shows the bar above the picture, on as many rows as its contents need. Returns whether the pin was clicked.
    pub(super) fn bar(
        &mut self,
        ui: &mut Ui,
        evaluation: &Evaluation,
        subject: &FlatViewSubject<'_>,
        values: Option<&InspectedResult>,
    ) -> bool {
        let model = evaluation.model.received.as_deref();
        let choices = self.choices(model, values);
        let width = ui.available_width();
        let all: f32 = choices.iter().map(|(_, width)| width + space::USUAL).sum();
        let has_one_row = width >= LEAST_TITLE + SWITCHES + all;
        let rows = if has_one_row {
            Vec::new()
        } else {
            rows_of(&choices, width)
        };
        let mut unpins = false;
        let row = vec2(width, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(row, Layout::right_to_left(Align::Center), |ui| {
            if let Some(values) = values {
                ui.scope_builder(named("switches"), |ui| {
                    ui.toggle_value(&mut self.has_wires, "UV");
                    ui.toggle_value(&mut self.is_tiled, "Tile");
                    ui.colored_label(subject.theme.quiet, format!("{0} × {0}", values.size));
                });
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if subject.is_pinned {
                    let pin = ui.selectable_label(true, icon::PUSH_PIN);
                    let pin = pin.on_hover_text("Pinned; click to unpin");
                    pin.widget_info(|| WidgetInfo::selected(WidgetType::Button, true, true, "Unpin"));
                    unpins = pin.clicked();
                }
                ui.scope(|ui| {
                    let menus = if has_one_row { all } else { 0.0 };
                    ui.set_max_width((ui.available_width() - menus).max(0.0));
                    ui.add(Label::new(RichText::new(subject.title).strong()).truncate());
                });
                if has_one_row {
                    self.choose(ui, &choices, model, values);
                }
            });
        });
        for row in rows {
            ui.horizontal(|ui| self.choose(ui, &row, model, values));
        }
        unpins
    }

    /// Choices that there are, with their widths.
    fn choices(&mut self, model: Option<&LiveModel>, values: Option<&InspectedResult>) -> Vec<(Choice, f32)> {
        let planes = values.map_or(0, |values| values.planes.len());
        self.plane = self.plane.min(planes.saturating_sub(1));
        let components = values.and_then(|values| values.planes.get(self.plane));
        let components = components.map_or(0, |plane| plane.components);
        let sets = model.map_or(0, |model| model.sets.len());
        let width = ALL_COMPONENTS + components as f32 * (COMPONENT + space::USUAL);
        let all = [
            (sets > 1, Choice::Sets, SETS),
            (planes > 1, Choice::Planes, PLANES),
            (components > 1, Choice::Components, width),
        ];
        let shown = all.into_iter().filter(|(is_shown, ..)| *is_shown);
        shown.map(|(_, choice, width)| (choice, width)).collect()
    }

    /// Shows choices beside each other.
    fn choose(
        &mut self,
        ui: &mut Ui,
        choices: &[(Choice, f32)],
        model: Option<&LiveModel>,
        values: Option<&InspectedResult>,
    ) {
        for (choice, _) in choices {
            match (choice, model, values) {
                (Choice::Sets, Some(model), _) => {
                    ui.scope_builder(named("sets"), |ui| self.sets(ui, model));
                }
                (Choice::Planes, _, Some(values)) => {
                    ui.scope_builder(named("planes"), |ui| self.planes(ui, values));
                }
                (Choice::Components, _, Some(values)) => {
                    ui.scope_builder(named("components"), |ui| self.components(ui, values));
                }
                // A choice is listed only if there is a model or a result to choose from.
                (Choice::Sets, None, _) | (Choice::Planes | Choice::Components, _, None) => {}
            }
        }
    }

    /// Menu of the texture sets.
    fn sets(&mut self, ui: &mut Ui, model: &LiveModel) {
        let Some(shown) = model.set(self.set).filter(|_| model.sets.len() > 1) else {
            return;
        };
        let menu = egui::ComboBox::from_id_salt("texture set").width(SETS);
        let menu = menu.truncate().selected_text(shown.title());
        let menu = menu.show_ui(ui, |ui| {
            for set in &model.sets {
                if ui.selectable_label(set.key == shown.key, set.title()).clicked() {
                    self.set = Some(set.key);
                }
            }
        });
        let words = format!("Texture set: {}", shown.title());
        let hint = "Texture set that is shown here and in flat pictures of nodes";
        let menu = menu.response.on_hover_text(hint);
        menu.widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, &words));
    }

    /// Menu of the planes.
    fn planes(&mut self, ui: &mut Ui, values: &InspectedResult) {
        let title = |at: usize| plane_names(values.planes[at].name).0;
        let menu = egui::ComboBox::from_id_salt("plane").width(PLANES).truncate();
        let menu = menu.selected_text(title(self.plane)).show_ui(ui, |ui| {
            for at in 0..values.planes.len() {
                ui.selectable_value(&mut self.plane, at, title(at));
            }
        });
        menu.response.on_hover_text(title(self.plane));
    }

    /// Switches of the components of the plane that is shown.
    fn components(&mut self, ui: &mut Ui, values: &InspectedResult) {
        let Some(plane) = values.planes.get(self.plane) else {
            return;
        };
        let (_, meanings) = plane_names(plane.name);
        ui.selectable_value(&mut self.component, None, "RGB");
        for (at, name) in ["R", "G", "B", "A"].iter().enumerate().take(plane.components) {
            let button = ui.selectable_value(&mut self.component, Some(at), *name);
            if let Some(meaning) = meanings.get(at) {
                button.on_hover_text(*meaning);
            }
        }
    }
}

/// Title of a plane of a result, and what its components are, by the name of the plane.
fn plane_names(plane: &str) -> (&str, &'static [&'static str]) {
    match plane.trim_end_matches('.') {
        "" => ("Color", &["Red", "Green", "Blue"]),
        "color" => ("Base color", &["Red", "Green", "Blue", "Opacity"]),
        "surface" => (
            "Roughness, metallic, occlusion",
            &["Roughness", "Metallic", "Occlusion"],
        ),
        "height" => ("Height", &["Height"]),
        "slope" => ("Slope", &["Along x", "Along y", "Along z"]),
        "emission" => ("Emission", &["Red", "Green", "Blue"]),
        "coat" => ("Coat", &["Share", "Roughness"]),
        "anisotropy" => ("Anisotropy", &["Along x", "Along y", "Along z"]),
        "sheen" => ("Sheen", &["Red", "Green", "Blue", "Roughness"]),
        "subsurface" => ("Subsurface", &["Red", "Green", "Blue", "Transmission"]),
        other => (other, &[]),
    }
}

/// Builder of a part of the bar. It has an id of its own, so that its clicks do not depend on what appears beside it.
fn named(name: &str) -> UiBuilder {
    UiBuilder::new().id(egui::Id::new(("texture", name)))
}

/// Divides choices into rows of a width, each with as many of them as fit.
fn rows_of(choices: &[(Choice, f32)], width: f32) -> Vec<Vec<(Choice, f32)>> {
    let mut rows: Vec<Vec<(Choice, f32)>> = Vec::new();
    let mut left = 0.0;
    for (choice, own) in choices {
        match rows.last_mut().filter(|_| *own <= left) {
            Some(row) => row.push((*choice, *own)),
            None => {
                rows.push(vec![(*choice, *own)]);
                left = width;
            }
        }
        left -= own + space::USUAL;
    }
    rows
}
