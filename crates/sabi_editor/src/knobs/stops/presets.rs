//! Gradients to begin with, as strips in a menu, and the entry that picks one from a picture.

use std::sync::OnceLock;

use egui::{
    Align2, Id, Popup, PopupCloseBehavior, Rect, Response, ScrollArea, Sense, Ui, Vec2, WidgetInfo, WidgetType,
};
use egui_phosphor::regular as icon;
use sabi_nodes::typed_color;
use serde::Deserialize;

use super::paint_ramp;
use crate::knobs::buttons::focus_ring;
use crate::knobs::knob_ui::KnobUi;
use crate::knobs::text_painting::write;
use crate::knobs::values::{GradientStop, color_of};
use crate::theme::{space, type_size};

/// Size of the menu and width of its strips, points.
const MENU: Vec2 = Vec2::new(300.0, 380.0);
const STRIP: f32 = 128.0;

/// A gradient to begin with.
pub(in crate::knobs) struct GradientPreset {
    /// Title that it is listed under.
    pub(in crate::knobs) group: String,
    pub(in crate::knobs) name: String,
    pub(in crate::knobs) stops: Vec<GradientStop>,
}

/// Choice in the menu.
pub(super) enum PresetChoice {
    Preset(&'static GradientPreset),
    /// Pick a gradient from a picture.
    Picture,
}

/// A preset in its file.
#[derive(Deserialize)]
struct WrittenPreset {
    group: String,
    name: String,
    stops: Vec<(f64, String)>,
}

/// The gradients of `assets/gradients/presets.json`, by group.
pub(in crate::knobs) fn presets() -> &'static [GradientPreset] {
    static PRESETS: OnceLock<Vec<GradientPreset>> = OnceLock::new();
    PRESETS.get_or_init(|| {
        let text = include_str!("../../../../../assets/gradients/presets.json");
        read(text).unwrap_or_default() // A test reads the file, so it has no faults.
    })
}

fn read(text: &str) -> Result<Vec<GradientPreset>, String> {
    let written: Vec<WrittenPreset> = serde_json::from_str(text).map_err(|error| error.to_string())?;
    let preset = |preset: WrittenPreset| {
        let stop = |(at, code): &(f64, String)| {
            let color = typed_color(code).and(color_of(code));
            let color = color.ok_or_else(|| format!("'{code}' of '{}' is no color", preset.name))?;
            Ok(GradientStop { at: *at, color })
        };
        let stops = preset
            .stops
            .iter()
            .map(stop)
            .collect::<Result<Vec<GradientStop>, String>>()?;
        Ok(GradientPreset {
            group: preset.group,
            name: preset.name,
            stops,
        })
    };
    written.into_iter().map(preset).collect()
}

/// Shows the menu of a button.
pub(super) fn menu(button: &Response, knob_ui: &KnobUi<'_>) -> Option<PresetChoice> {
    let popup = Popup::menu(button).close_behavior(PopupCloseBehavior::CloseOnClick);
    popup.show(|ui| entries(ui, knob_ui, button.id))?.inner
}

fn entries(ui: &mut Ui, knob_ui: &KnobUi<'_>, id: Id) -> Option<PresetChoice> {
    ui.set_width(MENU.x);
    let mut chosen = None;
    let pick = entry(ui, knob_ui, id.with("picture"), "Pick from a picture…");
    let place = pick.rect.with_max_x(pick.rect.left() + STRIP);
    let size = type_size::HEADING;
    write(
        ui.painter(),
        place,
        Align2::CENTER_CENTER,
        icon::IMAGE,
        size,
        knob_ui.theme.text,
    );
    if pick.clicked() {
        chosen = Some(PresetChoice::Picture);
    }
    ui.separator();
    ScrollArea::vertical().max_height(MENU.y).show(ui, |ui| {
        let mut group = "";
        for preset in presets() {
            if preset.group != group {
                group = &preset.group;
                ui.label(
                    egui::RichText::new(group)
                        .size(type_size::SMALL)
                        .color(knob_ui.theme.quiet),
                );
            }
            let response = entry(ui, knob_ui, id.with(&preset.name), &preset.name);
            let strip = strip_of(response.rect);
            if ui.is_rect_visible(strip) {
                paint_ramp(ui.painter(), strip, &preset.stops);
            }
            if response.clicked() {
                chosen = Some(PresetChoice::Preset(preset));
            }
        }
    });
    chosen
}

fn strip_of(entry: Rect) -> Rect {
    entry.with_max_x(entry.left() + STRIP).shrink(3.0)
}

/// Shows the name of an entry, with room for a strip before it.
fn entry(ui: &mut Ui, knob_ui: &KnobUi<'_>, id: Id, name: &str) -> Response {
    let (_, rect) = ui.allocate_space(Vec2::new(ui.available_width(), space::ROW));
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        if response.hovered() {
            ui.painter().rect_filled(rect, space::CORNER, knob_ui.theme.hovered);
        }
        let words = rect.with_min_x(rect.left() + STRIP + space::USUAL);
        let size = type_size::BODY;
        write(ui.painter(), words, Align2::LEFT_CENTER, name, size, knob_ui.theme.text);
        focus_ring(ui, knob_ui, &response);
    }
    response
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_preset_is_read_has_a_name_of_its_own_and_fits_into_a_gradient() {
        let presets = read(include_str!("../../../../../assets/gradients/presets.json")).expect("a file of presets");
        assert!(presets.len() >= 16, "{}", presets.len());
        let names: BTreeSet<&str> = presets.iter().map(|preset| preset.name.as_str()).collect();
        assert_eq!(names.len(), presets.len());
        for GradientPreset { name, stops, .. } in &presets {
            assert!((2..=16).contains(&stops.len()), "{name}");
            assert_eq!((stops[0].at, stops[stops.len() - 1].at), (0.0, 1.0), "{name}");
            assert!(stops.is_sorted_by(|left, right| left.at < right.at), "{name}");
        }
    }

    #[test]
    fn a_group_of_presets_is_listed_once() {
        let groups: Vec<&str> = presets().iter().map(|preset| preset.group.as_str()).collect();
        let mut listed = groups.clone();
        listed.dedup();
        assert_eq!(listed.len(), groups.iter().collect::<BTreeSet<_>>().len());
    }
}
