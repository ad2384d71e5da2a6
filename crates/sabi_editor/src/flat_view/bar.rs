//! The bar above the texture: what is shown of which result.

use egui::{Align, Label, Layout, RichText, Ui, UiBuilder, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;
use sabi_engine::{Inspected, LiveModel};

use super::{FlatView, Subject};
use crate::evaluation::Evaluation;

/// Least width of the panel for a bar of one row, points.
const ONE_ROW: f32 = 480.0;
/// Widths of the menus of texture sets and of planes, and least width of the title, points.
const SETS: f32 = 60.0;
const PLANES: f32 = 220.0;
const LEAST_TITLE: f32 = 60.0;

impl FlatView {
    /// Shows the bar above the picture, on two rows in a narrow panel. Returns whether the pin was clicked.
    pub(super) fn bar(
        &mut self,
        ui: &mut Ui,
        evaluation: &Evaluation,
        subject: &Subject<'_>,
        values: Option<&Inspected>,
    ) -> bool {
        let is_narrow = ui.available_width() < ONE_ROW;
        let mut unpins = false;
        // With ids of their own, they take clicks whatever appears and disappears beside them.
        let named = |name: &str| UiBuilder::new().id(egui::Id::new(("texture", name)));
        let row = vec2(ui.available_width(), ui.spacing().interact_size.y);
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
                    let menus = if is_narrow { SETS } else { SETS + PLANES };
                    ui.set_max_width((ui.available_width() - menus).max(LEAST_TITLE));
                    ui.add(Label::new(RichText::new(subject.title).strong()).truncate());
                });
                if let Some(model) = &evaluation.model.received {
                    self.sets(ui, model);
                }
                if let Some(values) = values.filter(|_| !is_narrow) {
                    ui.scope_builder(named("planes"), |ui| self.planes(ui, values));
                }
            });
        });
        if let Some(values) = values.filter(|_| is_narrow) {
            ui.horizontal(|ui| ui.scope_builder(named("planes"), |ui| self.planes(ui, values)));
        }
        unpins
    }

    /// Menu of the texture sets.
    fn sets(&mut self, ui: &mut Ui, model: &LiveModel) {
        let Some(shown) = model.set(self.set).filter(|_| model.sets.len() > 1) else {
            return;
        };
        let menu = egui::ComboBox::from_id_salt("texture set").selected_text(shown.title());
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

    /// Menus of the planes and of the components.
    fn planes(&mut self, ui: &mut Ui, values: &Inspected) {
        self.plane = self.plane.min(values.planes.len().saturating_sub(1));
        if values.planes.len() > 1 {
            let name = |at: usize| match values.planes[at].name.trim_end_matches('.') {
                "" => "color",
                name => name,
            };
            egui::ComboBox::from_id_salt("plane")
                .selected_text(name(self.plane))
                .show_ui(ui, |ui| {
                    for at in 0..values.planes.len() {
                        ui.selectable_value(&mut self.plane, at, name(at));
                    }
                });
        }
        let components = values.planes.get(self.plane).map_or(0, |plane| plane.components);
        if components > 1 {
            ui.selectable_value(&mut self.component, None, "RGB");
            for (at, name) in ["R", "G", "B", "A"].iter().enumerate().take(components) {
                ui.selectable_value(&mut self.component, Some(at), *name);
            }
        }
    }
}
