//! The menu of what holds for all of a graph.

use egui::{DragValue, RichText, Ui, UiBuilder};
use sabi_graph::Fit;

use super::Editor;
use crate::model_view::staying;
use crate::theme::type_size;

/// Sizes that are offered to work at.
const SIZES: [u32; 5] = [256, 512, 1024, 2048, 4096];

impl Editor {
    /// How finely the graph is worked on; a click opens the rest.
    pub(super) fn measures(&mut self, ui: &mut Ui) {
        // By a name of its own: it stays open whatever comes and goes beside it.
        let named = UiBuilder::new().id(egui::Id::new("measures of the graph"));
        ui.scope_builder(named, |ui| self.measures_menu(ui));
    }

    fn measures_menu(&mut self, ui: &mut Ui) {
        let size = self.stage.size();
        let words = RichText::new(format!("{size} texels"))
            .size(type_size::SMALL)
            .color(self.theme.quiet);
        let button = egui::Button::new(words).frame(false);
        egui::containers::menu::MenuButton::from_button(button)
            .config(staying())
            .ui(ui, |ui| {
                self.sizes(ui, size);
                ui.separator();
                self.fits(ui);
                ui.separator();
                self.seed(ui);
            });
    }

    fn sizes(&mut self, ui: &mut Ui, size: u32) {
        ui.label("Texels along a side while working");
        for offered in SIZES {
            if ui.radio(offered == size, format!("{offered} × {offered}")).clicked() {
                self.document.set_size(offered);
                ui.close();
            }
        }
    }

    fn fits(&mut self, ui: &mut Ui) {
        let fit = self.document.contents().fit;
        ui.label("A length of 1 in the graph is");
        let mut wanted = fit;
        ui.radio_value(&mut wanted, Fit::Unit, "the largest side of the model");
        ui.radio_value(&mut wanted, Fit::Metres, "a metre");
        ui.horizontal(|ui| {
            let mut length = if let Fit::Length(length) = fit { length } else { 0.1 };
            let is_length = matches!(fit, Fit::Length(_));
            let chosen = ui.radio(is_length, "as many metres as").clicked();
            let field = DragValue::new(&mut length).speed(0.01).range(1e-4..=1e4);
            let is_changed = ui.add_enabled(is_length, field).changed();
            if chosen || is_changed {
                wanted = Fit::Length(length);
            }
        });
        if wanted != fit {
            self.document.set_fit(wanted);
        }
    }

    fn seed(&mut self, ui: &mut Ui) {
        let mut seed = self.document.contents().seed;
        ui.horizontal(|ui| {
            let label = ui.label("Seed of the graph");
            if ui.add(DragValue::new(&mut seed)).labelled_by(label.id).changed() {
                self.document.set_seed(seed);
            }
        });
    }
}
