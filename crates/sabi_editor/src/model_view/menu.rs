//! The menus of the viewport: what is shown, camera, channels, light and overlays.

use egui::containers::menu::MenuButton;
use egui::{Rect, Ui, UiBuilder, vec2};
use egui_phosphor::regular as icon;
use sabi_engine::built_in_environments;
use sabi_engine::view::{Lines, Mode};

use super::{ModelView, Subject, showing, toggle_lines};
use crate::action::Action;
use crate::bars::stay_open;
use crate::evaluation::Evaluation;
use crate::settings::viewport::{BACKGROUNDS, EXPOSURE_STOPS, STRENGTH, TRANSFORMS, TURN_DEGREES};

/// Channels and modes that the model can be shown in, with their titles.
const MODES: [(&str, Mode); 14] = [
    ("Material", Mode::Material),
    ("Base color", Mode::BaseColor),
    ("Opacity", Mode::Opacity),
    ("Roughness", Mode::Roughness),
    ("Metallic", Mode::Metallic),
    ("Occlusion", Mode::Occlusion),
    ("Height", Mode::Height),
    ("Normal", Mode::Normal),
    ("Normal on the model", Mode::ModelNormal),
    ("Emission", Mode::Emission),
    ("Checker", Mode::Checker),
    ("Density of texels", Mode::Density),
    ("Facing", Mode::Facing),
    ("Clay", Mode::Clay),
];

/// Shows the menus. Returns the chosen environment, and adds actions for all other requests.
pub(super) fn show(
    view: &mut ModelView,
    ui: &mut Ui,
    rect: Rect,
    evaluation: &Evaluation,
    subject: &Subject<'_>,
    actions: &mut Vec<Action>,
) -> Option<String> {
    let strip = Rect::from_min_size(rect.min + vec2(6.0, 6.0), vec2(rect.width() - 12.0, 24.0));
    let mut chosen = None;
    ui.scope_builder(UiBuilder::new().max_rect(strip), |ui| {
        // On two rows in a narrow panel.
        ui.horizontal_wrapped(|ui| {
            let mode = MODES
                .iter()
                .find(|(_, mode)| *mode == view.shot.mode)
                .map_or("Material", |(name, _)| name);
            ui.menu_button(format!("{} Preview", icon::CROSSHAIR), |ui| {
                showing::menu(view, ui, subject, actions)
            });
            ui.menu_button(format!("{} Camera", icon::VIDEO_CAMERA), |ui| {
                showing::viewpoints(ui, subject, actions)
            });
            ui.menu_button(format!("{} {mode}", icon::SPHERE), |ui| {
                for (name, mode) in MODES {
                    ui.selectable_value(&mut view.shot.mode, mode, name);
                }
            });
            let light_menu = MenuButton::new(format!("{} Light", icon::SUN)).config(stay_open());
            light_menu.ui(ui, |ui| chosen = light(view, ui));
            let more_menu = MenuButton::new(format!("{} Overlays", icon::EYE)).config(stay_open());
            more_menu.ui(ui, |ui| more(view, ui, evaluation));
            if view.comparison.share.is_some() && subject.locked.is_none() {
                ui.colored_label(subject.theme.warning, "Lock a node (P) to compare with it");
            }
        });
    });
    if let Some(choice) = &chosen {
        view.environment.choose(choice);
    }
    chosen
}

fn light(view: &mut ModelView, ui: &mut Ui) -> Option<String> {
    let mut chosen = None;
    for name in built_in_environments() {
        let label = name.replace('_', " ");
        if ui.selectable_label(view.environment.choice() == name, label).clicked() {
            chosen = Some(name.to_owned());
        }
    }
    if let Some(fault) = &view.environment.fault {
        ui.label(fault);
    }
    ui.separator();
    ui.add(
        egui::Slider::new(&mut view.shot.environment_turn_degrees, TURN_DEGREES)
            .text("Turn")
            .suffix("°"),
    );
    ui.add(egui::Slider::new(&mut view.shot.environment_strength, STRENGTH).text("Strength"));
    ui.add(egui::Slider::new(&mut view.shot.exposure_stops, EXPOSURE_STOPS).text("Exposure"));
    ui.separator();
    view.lights.menu(ui);
    ui.separator();
    for (_, name, transform) in TRANSFORMS {
        ui.selectable_value(&mut view.shot.transform, transform, name);
    }
    chosen
}

fn more(view: &mut ModelView, ui: &mut Ui, evaluation: &Evaluation) {
    for (name, lines) in [("Triangles", Lines::Wires), ("Seams", Lines::Seams)] {
        let mut is_shown = view.shot.lines.contains(&lines);
        if ui.checkbox(&mut is_shown, name).changed() {
            toggle_lines(&mut view.shot, lines);
        }
    }
    ui.checkbox(&mut view.shot.has_relief, "Relief");
    ui.separator();
    for (_, name, background) in BACKGROUNDS {
        ui.selectable_value(&mut view.shot.background, background, name);
    }
    let quality = sabi_engine::view::Quality::of(evaluation.gpu().summary().kind);
    if let Some(remark) = quality.remark() {
        ui.separator();
        ui.set_max_width(260.0);
        ui.weak(remark);
    }
}
