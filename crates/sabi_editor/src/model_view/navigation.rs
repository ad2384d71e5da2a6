//! Navigation in the viewport: the camera, set up for each model and moved by drags and the wheel.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::{Pos2, Rect, Response, Ui};
use glam::Vec2;
use sabi_engine::live::LiveModel;
use sabi_view::{Camera, PickedPoint, Viewpoint, aspect_of, pick};

use crate::mouse::DragAction;

/// Time after the last movement until the picture is drawn at full quality.
pub(super) const REST: Duration = Duration::from_millis(180);

/// Smallest change of a view's aspect for which the camera moves.
pub(super) const SAME_ASPECT: f32 = 1e-3;

/// Camera of the viewport.
pub(crate) struct Navigation {
    pub(crate) camera: Camera,
    /// File of the model that the camera was set up for.
    framed: Option<PathBuf>,
    /// Camera as it was set up last, with the aspect of the view then.
    set_up: Option<(Camera, f32)>,
    moved: Option<Instant>,
}

impl Navigation {
    pub(super) fn new() -> Navigation {
        let diagonal = [glam::Vec3::splat(-0.5), glam::Vec3::splat(0.5)];
        Navigation {
            camera: Camera::seen_from(Viewpoint::THREE_QUARTER, &diagonal, 1.0),
            framed: None,
            set_up: None,
            moved: None,
        }
    }

    /// Sets up the camera for a new model, and again when the shape of the view changes, until the user moves the
    /// camera.
    pub(super) fn frame_new(&mut self, model: &LiveModel, rect: Rect) {
        let file = model.linked.model.files.first();
        let is_new = file.is_none() || self.framed.as_ref() != file;
        let aspect = aspect(rect);
        let is_reshaped = self
            .set_up
            .is_some_and(|(_, before)| (before - aspect).abs() > SAME_ASPECT);
        if is_new || is_reshaped && self.is_untouched() {
            let points = model.placement.points_in_view(&model.linked.model.mesh);
            self.camera = Camera::seen_from(Viewpoint::THREE_QUARTER, &points, aspect);
            self.framed = file.cloned();
            self.set_up = Some((self.camera, aspect));
        }
    }

    /// Returns whether the camera is where it was set up.
    pub(super) fn is_untouched(&self) -> bool {
        self.set_up.is_some_and(|(camera, _)| camera == self.camera)
    }

    /// Moves the camera by the wheel and by a drag, which may turn the light instead.
    pub(super) fn drag(
        &mut self,
        ui: &Ui,
        response: &Response,
        rect: Rect,
        action: Option<DragAction>,
        light_turn_degrees: &mut f32,
    ) {
        let (delta, scroll) = ui.input(|input| (input.pointer.delta(), input.smooth_scroll_delta().y));
        let size = Vec2::new(rect.width(), rect.height());
        let drag = Vec2::new(delta.x, delta.y);
        let before = (self.camera, *light_turn_degrees);
        match action.filter(|_| delta != egui::Vec2::ZERO) {
            Some(DragAction::Orbit) => self.camera.orbit(drag, size),
            Some(DragAction::Pan) => self.camera.pan(drag, size),
            Some(DragAction::Zoom) => self.camera.zoom((-delta.y * 0.01).exp()),
            Some(DragAction::Light) => *light_turn_degrees += delta.x / rect.width().max(1.0) * 360.0,
            _ => {}
        }
        let pointer = response.hover_pos();
        if let Some(at) = pointer.filter(|_| scroll != 0.0 && response.contains_pointer()) {
            self.camera
                .zoom_at(share(rect, at), aspect(rect), (scroll * 0.0025).exp());
        }
        if before != (self.camera, *light_turn_degrees) {
            self.mark_moved();
        }
    }

    /// Surface point under a place of the screen.
    pub(super) fn picked(&self, model: &LiveModel, rect: Rect, at: Pos2) -> Option<PickedPoint> {
        picked_by(&self.camera, model, rect, at)
    }

    /// Notes that the camera or the light was moved now.
    pub(super) fn mark_moved(&mut self) {
        self.moved = Some(Instant::now());
    }

    /// Returns whether the camera or the light was moved a short time ago.
    pub(super) fn is_moving(&self) -> bool {
        self.moved.is_some_and(|moved| moved.elapsed() < REST)
    }
}

/// Surface point of a model that a camera sees at a place of the screen.
pub(super) fn picked_by(camera: &Camera, model: &LiveModel, rect: Rect, at: Pos2) -> Option<PickedPoint> {
    let linked = &model.linked;
    let bvh = linked.bvh.get()?;
    let ray = camera.ray(share(rect, at), aspect(rect));
    pick(bvh, &linked.model.mesh, &linked.atlas, ray, &model.placement)
}

pub(super) fn aspect(rect: Rect) -> f32 {
    aspect_of(Vec2::new(rect.width(), rect.height()))
}

/// Place on the screen as a share of the picture.
fn share(rect: Rect, at: Pos2) -> Vec2 {
    let share = (at - rect.min) / rect.size();
    Vec2::new(share.x, share.y)
}
