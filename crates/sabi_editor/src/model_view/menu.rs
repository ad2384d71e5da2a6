//! The menus of the viewport: subject, camera, channels, light and overlays.

use egui::containers::menu::MenuButton;
use egui::{Rect, Ui, UiBuilder, Vec2, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;
use sabi_engine::opening::environment::built_in_environments;
use sabi_view::{Camera, Lines};

use super::channels::{CHANNELS, MODEL_MODES};
use super::saved_picture::{LARGEST, SIZES};
use super::{ModelView, Subject, channels, saved_views, subject_menus, toggle_lines};
use crate::action::{Action, FileAction};
use crate::bars::stay_open;
use crate::evaluation::Evaluation;
use crate::settings::viewport::{BACKGROUNDS, BLOOM, EXPOSURE_STOPS, STRENGTH, TRANSFORMS, TURN_DEGREES};

/// Margin around the menus, points.
const MARGIN: f32 = 6.0;
/// Focal lengths that can be chosen, as on a picture of 36 × 24 mm.
const LENSES: std::ops::RangeInclusive<f32> = 18.0..=200.0;

/// Shows the menus. Returns the chosen environment, and adds actions for all other requests.
pub(super) fn show(
    view: &mut ModelView,
    ui: &mut Ui,
    rect: Rect,
    evaluation: &Evaluation,
    subject: &Subject<'_>,
    actions: &mut Vec<Action>,
) -> Option<String> {
    let strip = Rect::from_min_size(rect.min + Vec2::splat(MARGIN), vec2(rect.width() - 2.0 * MARGIN, 24.0));
    let mut chosen = None;
    let menus = ui.scope_builder(UiBuilder::new().max_rect(strip), |ui| {
        // On two rows in a narrow panel.
        ui.horizontal_wrapped(|ui| {
            ui.menu_button(format!("{} Preview", icon::CROSSHAIR), |ui| {
                subject_menus::menu(view, ui, subject, actions)
            });
            ui.menu_button(format!("{} Camera", icon::VIDEO_CAMERA), |ui| {
                subject_menus::viewpoints(ui, subject, actions);
                lens(&mut view.navigation.camera, ui);
            });
            let views_menu = MenuButton::new(format!("{} Views", icon::BOOKMARK_SIMPLE)).config(stay_open());
            views_menu.ui(ui, |ui| {
                saved_views::menu(view, ui, subject, actions);
                ui.separator();
                picture(view, ui, actions);
            });
            let mode = channels::title(view.shot.mode);
            ui.menu_button(format!("{} {mode}", icon::SPHERE), |ui| {
                for (name, mode) in CHANNELS {
                    ui.selectable_value(&mut view.shot.mode, mode, name);
                }
                ui.separator();
                for (name, mode) in MODEL_MODES {
                    ui.selectable_value(&mut view.shot.mode, mode, name);
                }
            });
            let light_menu = MenuButton::new(format!("{} Light", icon::SUN)).config(stay_open());
            light_menu.ui(ui, |ui| chosen = light(view, ui));
            let more_menu = MenuButton::new(format!("{} Overlays", icon::EYE)).config(stay_open());
            more_menu.ui(ui, |ui| more(view, ui, evaluation));
            if view.comparison.share.is_some() && subject.pinned.is_none() {
                ui.colored_label(subject.theme.warning, "Pin a node (P) to compare with it");
            }
        });
    });
    view.menus_height = menus.response.rect.bottom() + MARGIN - rect.top();
    if let Some(choice) = &chosen {
        view.environment.choose(choice);
    }
    chosen
}

/// Focal length of the camera.
fn lens(camera: &mut Camera, ui: &mut Ui) {
    ui.separator();
    let mut millimeters = camera.focal_length_mm();
    let slider = egui::Slider::new(&mut millimeters, LENSES)
        .text("Lens")
        .suffix(" mm")
        .integer();
    if ui.add(slider).changed() {
        camera.set_focal_length(millimeters);
    }
}

/// Size of a saved picture, and the entry that saves it.
fn picture(view: &mut ModelView, ui: &mut Ui, actions: &mut Vec<Action>) {
    let size = &mut view.saved_picture.size;
    ui.horizontal(|ui| {
        for (side, name) in size.iter_mut().zip(["Width", "Height"]) {
            let field = ui.add(egui::DragValue::new(side).range(16..=LARGEST).suffix(" px"));
            field.widget_info(|| WidgetInfo::labeled(WidgetType::DragValue, true, name));
        }
        egui::ComboBox::from_id_salt("sizes of pictures")
            .selected_text("Sizes")
            .show_ui(ui, |ui| {
                for offered in SIZES {
                    ui.selectable_value(size, offered, format!("{} × {}", offered[0], offered[1]));
                }
            });
    });
    let save = ui.add_enabled(
        !view.saved_picture.is_busy(),
        egui::Button::new("Save a picture of the view…"),
    );
    if save.clicked() {
        actions.push(Action::File(FileAction::AskForPicture));
        ui.close();
    }
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
    ui.add(egui::Slider::new(&mut view.shot.bloom, BLOOM).text("Bloom"))
        .on_hover_text("Glow around highlights and emission: the share of the light above white that spreads.");
    ui.separator();
    view.lights.menu(ui);
    ui.separator();
    for (_, name, transform) in TRANSFORMS {
        ui.selectable_value(&mut view.shot.transform, transform, name);
    }
    chosen
}

fn more(view: &mut ModelView, ui: &mut Ui, evaluation: &Evaluation) {
    for (name, lines) in [("Wireframe", Lines::Wires), ("Seams", Lines::Seams)] {
        let mut is_shown = view.shot.lines.contains(&lines);
        if ui.checkbox(&mut is_shown, name).changed() {
            toggle_lines(&mut view.shot, lines);
        }
    }
    ui.checkbox(&mut view.shot.has_ground, "Shade on the ground");
    ui.checkbox(&mut view.shot.has_relief, "Relief");
    ui.separator();
    ui.weak("Background");
    for (_, name, background) in BACKGROUNDS {
        ui.selectable_value(&mut view.shot.background, background, name);
    }
    let quality = sabi_view::Quality::of(evaluation.gpu().summary().kind);
    if let Some(remark) = quality.remark() {
        ui.separator();
        ui.set_max_width(260.0);
        // Labels of menus are justified, which would spread the words of a sentence.
        ui.with_layout(egui::Layout::top_down(egui::Align::Min), |ui| ui.weak(remark));
    }
}
