//! Views of the model that are kept in the graph: a camera by a name.

use std::collections::BTreeMap;

use egui::{Button, TextEdit, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use glam::Vec3;
use sabi_editing::command::DocumentCommand;
use sabi_graph::SavedView;
use sabi_view::{Camera, Lens};

use super::{ModelView, Subject};
use crate::action::Action;

/// View of a camera, as graphs keep it.
fn view_of(camera: &Camera) -> SavedView {
    SavedView {
        target: camera.target.to_array().map(f64::from),
        yaw: f64::from(camera.yaw_degrees),
        pitch: f64::from(camera.pitch_degrees),
        distance: f64::from(camera.distance),
        is_parallel: camera.lens == Lens::Orthographic,
        extra: BTreeMap::new(),
    }
}

/// Camera with a view, and the field of view of another one.
fn camera_of(view: &SavedView, other: &Camera) -> Camera {
    Camera {
        target: Vec3::from_array(view.target.map(|x| x as f32)),
        yaw_degrees: view.yaw as f32,
        pitch_degrees: view.pitch as f32,
        distance: view.distance as f32,
        lens: if view.is_parallel {
            Lens::Orthographic
        } else {
            Lens::Perspective
        },
        fov_y_degrees: other.fov_y_degrees,
    }
}

/// Shows the views that are kept, and a field to keep this one.
pub(super) fn menu(view: &mut ModelView, ui: &mut Ui, subject: &Subject<'_>, actions: &mut Vec<Action>) {
    for (name, kept) in subject.views {
        ui.horizontal(|ui| {
            if ui.button(format!("{} {name}", icon::BOOKMARK_SIMPLE)).clicked() {
                view.navigation.camera = camera_of(kept, &view.navigation.camera);
                view.navigation.mark_moved();
                ui.close();
            }
            let forget = ui.small_button(icon::X).on_hover_text("Delete this view");
            forget.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("Delete {name}")));
            if forget.clicked() {
                actions.push(Action::edit(DocumentCommand::ForgetView(name.clone())));
            }
        });
    }
    ui.horizontal(|ui| {
        let free = (1..).map(|number| format!("View {number}"));
        let offered = free
            .into_iter()
            .find(|name| !subject.views.contains_key(name))
            .unwrap_or_default(); // There is always one.
        let field = TextEdit::singleline(&mut view.name_of_view)
            .hint_text(&offered)
            .desired_width(110.0);
        let field = ui.add(field);
        field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Name of the view"));
        if ui.add(Button::new("Save this view")).clicked() {
            let typed = std::mem::take(&mut view.name_of_view);
            let name = Some(typed.trim().to_owned())
                .filter(|name| !name.is_empty())
                .unwrap_or(offered);
            let kept = view_of(&view.navigation.camera);
            actions.push(Action::edit(DocumentCommand::KeepView(name, kept)));
            ui.close();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_is_restored_from_its_saved_view() {
        let camera = Camera {
            target: Vec3::new(0.25, -0.5, 0.125),
            yaw_degrees: 40.0,
            pitch_degrees: 25.0,
            distance: 1.5,
            lens: Lens::Orthographic,
            ..Camera::default()
        };
        assert_eq!(camera_of(&view_of(&camera), &Camera::default()), camera);
    }
}
