//! Choice of the preset, and the files that it writes.

use egui::{ComboBox, Grid, Label, RichText, ScrollArea, Ui};
use sabi_engine::baking::preset_description::{PresetDescription, PresetFileDescription, describe_preset};
use sabi_engine::baking::presets::{ListedPreset, default_preset_folder, export_presets};

use crate::theme::{Theme, space};

/// Presets as they were found when the menu was last opened.
#[derive(Default)]
pub(super) struct PresetMenu {
    found: Vec<ListedPreset>,
}

impl PresetMenu {
    /// Row of a grid with the choice; returns the chosen name.
    pub(super) fn show(&mut self, chosen: &str, ui: &mut Ui) -> Option<String> {
        if self.found.is_empty() {
            self.read();
        }
        let mut wanted = chosen.to_owned();
        ui.label("Preset");
        let listed = self.found.iter().find(|listed| listed.name == chosen);
        // High enough for all presets that come with Sabi: an entry that fades at the edge looks as if it could not be
        // chosen.
        let menu = ComboBox::from_id_salt("preset").height(400.0);
        let menu = menu.selected_text(listed.map_or(chosen, title));
        let shown = menu.show_ui(ui, |ui| {
            for listed in &self.found {
                let about = match &listed.preset {
                    Ok(preset) => &preset.about,
                    Err(fault) => fault,
                };
                let label = ui.selectable_value(&mut wanted, listed.name.clone(), title(listed));
                label.on_hover_text(about);
            }
        });
        if shown.response.clicked() {
            // Files of the user's own may have been added.
            self.read();
        }
        ui.end_row();
        (wanted != chosen).then_some(wanted)
    }

    /// Shows the files of the chosen preset with the channels that each is packed from, or the reason that it cannot be
    /// used.
    pub(super) fn files(&self, chosen: &str, ui: &mut Ui, theme: &Theme) {
        let Some(listed) = self.found.iter().find(|listed| listed.name == chosen) else {
            let why = format!("There is no preset '{chosen}' any more; choose another one.");
            ui.colored_label(theme.fault, why);
            return;
        };
        let preset = match &listed.preset {
            Ok(preset) => describe_preset(preset),
            Err(fault) => {
                ui.colored_label(theme.fault, fault);
                return;
            }
        };
        if !preset.left_out.is_empty() {
            let channels = preset.left_out.join(", ").replace('_', " ");
            let label = ui.label(RichText::new(format!("Leaves out: {channels}")).color(theme.quiet));
            label.on_hover_text(
                "What this preset is for has no place for these; an export warns where the material has them",
            );
        }
        ui.collapsing(format!("Files for {}", title(listed)), |ui| {
            ui.add(Label::new(RichText::new(&preset.about).color(theme.quiet)).wrap());
            // A long list of channels does not widen the panel.
            ScrollArea::horizontal().show(ui, |ui| table(&preset, ui, theme));
        });
    }

    fn read(&mut self) {
        self.found = export_presets(default_preset_folder().as_deref());
    }
}

/// Title of a preset: the name of the program that it is for, as that program writes it. The user's own presets have
/// the names of their files.
fn title(listed: &ListedPreset) -> &str {
    match (listed.name.as_str(), &listed.file) {
        ("raw", None) => "Raw channels",
        ("mesh", None) => "Mesh maps",
        ("gltf", None) => "glTF",
        ("unreal", None) => "Unreal",
        ("unity", None) => "Unity",
        ("godot", None) => "Godot",
        ("blender", None) => "Blender",
        ("materialx", None) => "MaterialX",
        ("usd", None) => "USD",
        (other, _) => other,
    }
}

/// Files with the channels that each is packed from, and documents.
fn table(preset: &PresetDescription, ui: &mut Ui, theme: &Theme) {
    let grid = Grid::new("files of the preset").num_columns(2);
    grid.spacing([space::USUAL, space::TIGHT]).show(ui, |ui| {
        for file in &preset.files {
            let name = file.map.as_deref().or(file.outputs).unwrap_or("outputs");
            ui.label(format!("{name}.{}", file.ending)).on_hover_text(details(file));
            ui.colored_label(theme.quiet, file.packing());
            ui.end_row();
        }
        for document in &preset.documents {
            let name = ui.label(format!("(model).{}", document.ending));
            name.on_hover_text("A document that names the maps; it has the name of the model");
            ui.colored_label(theme.quiet, document.about);
            ui.end_row();
        }
    });
}

/// Format and condition of a file.
fn details(file: &PresetFileDescription) -> String {
    let color = if file.color_space == "srgb" {
        ", sRGB"
    } else {
        ", linear"
    };
    let size = file
        .size
        .as_ref()
        .map_or(String::new(), |size| format!(", {size} pixels"));
    let (bits, engine) = (file.bits, file.engine_format);
    let normalized = if file.normalize { ", as 0 to 1" } else { "" };
    format!(
        "{bits} bits{color}{normalized}{size}; {engine} in an engine; written: {}",
        file.when
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_that_comes_with_sabi_has_a_title() {
        for listed in export_presets(None) {
            assert_ne!(title(&listed), listed.name);
        }
    }
}
