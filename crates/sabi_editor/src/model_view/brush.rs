//! The brush in the viewport: the surface under the pointer, and the outline of the brush there.

use egui::{Color32, CursorIcon, Pos2, Rect, Response, Stroke, Ui, vec2};
use glam::{DMat4, DVec3, Vec3};
use sabi_engine::live::LiveModel;
use sabi_paint::{Action as BrushAction, Eye, SymmetryCopy};
use sabi_surface::patch::Site;
use sabi_view::{Camera, Lens, PickedPoint};

use super::navigation::{aspect, picked_by};
use super::{ModelView, Subject};
use crate::action::Action;
use crate::brush::{
    BrushTool, Handles, Mover, PaintSubject, PaintView, PlacedStencil, ShownPath, ShownStencil, action_of,
};
use crate::evaluation::ResultPicture;

/// Length of the arms of the cross at the place that is copied from, points.
const CROSS: f32 = 8.0;
/// Strength of the outline of a copy on another side of the model.
const COPY_STRENGTH: f32 = 0.6;
/// Corners of the outline.
const CORNERS: usize = 48;

/// The model as a camera sees it.
pub(super) struct SeenModel {
    pub(super) camera: Camera,
    pub(super) rect: Rect,
}

impl PaintView for SeenModel {
    fn site(&self, model: &LiveModel, at: Pos2) -> Option<Site> {
        let picked = picked_by(&self.camera, model, self.rect, at).filter(|_| self.rect.contains(at))?;
        Some(Site {
            triangle: picked.triangle,
            position: picked.position.as_dvec3(),
        })
    }

    fn eye(&self, model: &LiveModel) -> Option<Eye> {
        let placement = &model.placement;
        let middle = DVec3::from(placement.center);
        Some(match self.camera.lens {
            Lens::Perspective => {
                let place = middle + self.camera.eye().as_dvec3() / placement.scale;
                Eye::Place(place.as_vec3().to_array())
            }
            Lens::Orthographic => Eye::Toward((-self.camera.forward()).to_array()),
        })
    }

    fn stencil_view(&self) -> Option<Rect> {
        Some(self.rect)
    }

    fn stencil_map(&self, model: &LiveModel, stencil: &ShownStencil) -> Option<[[f64; 4]; 3]> {
        let placement = &model.placement;
        let view_from_model =
            DMat4::from_scale(DVec3::splat(placement.scale)) * DMat4::from_translation(-DVec3::from(placement.center));
        let [x, y, depth] = self.camera.picture_rows().map(|row| view_from_model.transpose() * row);
        let choices = &stencil.choices;
        let [left, low] = choices.middle.map(f64::from);
        let [x, y] = [x - left * depth, y - low * depth];
        let (sine, cosine) = f64::from(choices.angle_degrees).to_radians().sin_cos();
        let half_sides = stencil.picture.half_sides() * f64::from(choices.size);
        let rows = [
            (cosine * x + sine * y) / half_sides.x,
            (cosine * y - sine * x) / half_sides.y,
            depth,
        ];
        Some(rows.map(|row| row.to_array()))
    }

    fn place(&self, model: &LiveModel, site: Site) -> Option<Pos2> {
        let placement = &model.placement;
        let place = (site.position - DVec3::from(placement.center)) * placement.scale;
        self.on_screen(place.as_vec3())
    }
}

impl SeenModel {
    /// Place on the screen of a place in view space.
    fn on_screen(&self, place: Vec3) -> Option<Pos2> {
        let share = self.camera.project(place, aspect(self.rect))?;
        Some(self.rect.min + vec2(share.x * self.rect.width(), share.y * self.rect.height()))
    }

    /// A circle on the tangent plane, on the screen, or that of a copy on another side of the model.
    fn outline(&self, picked: &PickedPoint, radius: f32, copy: Option<&SymmetryCopy>) -> Vec<Pos2> {
        let (x, y) = picked.normal.any_orthonormal_pair();
        let corner = |index: usize| {
            let (sine, cosine) = (index as f32 / CORNERS as f32 * std::f32::consts::TAU).sin_cos();
            let place = picked.position_view + radius * (cosine * x + sine * y);
            self.on_screen(copy.map_or(place, |copy| copy.map(place.as_dvec3()).as_vec3()))
        };
        (0..=CORNERS).filter_map(corner).collect()
    }
}

impl ModelView {
    /// Lets the brush paint on the model. Returns whether the drag belongs to the brush.
    pub(super) fn paint_on(
        &mut self,
        ui: &Ui,
        response: &Response,
        rect: Rect,
        picture: &ResultPicture,
        subject: &Subject<'_>,
        actions: &mut Vec<Action>,
    ) -> bool {
        let canvas = SeenModel {
            camera: self.navigation.camera,
            rect,
        };
        self.brush
            .paint(ui, response, subject.painted, &picture.model, &canvas, actions)
    }

    /// Draws the frame and the handles of a marked decal. Returns whether the pointer is on a handle.
    fn show_handles(
        &self,
        ui: &Ui,
        seen: &SeenModel,
        picture: &ResultPicture,
        subject: &Subject<'_>,
        pointer: Pos2,
    ) -> bool {
        let marked = subject.painted.and_then(|painted| painted.decal.as_ref());
        let handles = marked.and_then(|marked| Handles::of(&picture.model, seen, &marked.stroke, marked.half_sides));
        let Some(handles) = handles else { return false };
        let accent = subject.theme.accent;
        let mut frame = handles.corners.to_vec();
        frame.push(handles.corners[0]);
        ui.painter()
            .add(egui::Shape::dashed_line(&frame, Stroke::new(1.2, accent), 6.0, 4.0));
        for handle in [handles.middle, handles.side] {
            let ring = Stroke::new(1.6, Color32::WHITE);
            ui.painter().circle(handle, 5.0, accent, ring);
        }
        handles.is_at(pointer)
    }

    /// Draws the marked path with its knots and handles.
    fn show_path(
        &self,
        ui: &Ui,
        seen: &SeenModel,
        picture: &ResultPicture,
        painted: &PaintSubject,
        subject: &Subject<'_>,
    ) {
        let stroke = painted.path.as_ref();
        if let Some(path) = stroke.and_then(|stroke| ShownPath::of(&picture.model, seen, stroke)) {
            path.show(ui.painter(), subject.theme.accent);
        }
    }

    /// Draws the handles of the marked strokes. Returns whether the pointer is on one.
    fn show_mover(
        &self,
        ui: &Ui,
        seen: &SeenModel,
        picture: &ResultPicture,
        subject: &Subject<'_>,
        pointer: Pos2,
    ) -> bool {
        let marked = subject
            .painted
            .map(|painted| painted.marked.as_slice())
            .filter(|_| self.brush.moves_marked());
        let Some(mover) = marked.and_then(|marked| Mover::of(&picture.model, seen, marked)) else {
            return false;
        };
        mover.show(ui.painter(), subject.theme.accent);
        mover.is_at(pointer)
    }

    /// Draws a cross at the place that strokes copy from.
    fn show_source(&self, ui: &Ui, seen: &SeenModel, picture: &ResultPicture, subject: &Subject<'_>) {
        let source = self.brush.source_on(&picture.model);
        let Some(at) = source.and_then(|source| seen.place(&picture.model, source.site)) else {
            return;
        };
        for arm in [vec2(CROSS, 0.0), vec2(0.0, CROSS)] {
            for (width, color) in [(3.0, Color32::from_black_alpha(120)), (1.4, subject.theme.accent)] {
                ui.painter()
                    .line_segment([at - arm, at + arm], Stroke::new(width, color));
            }
        }
    }

    /// Draws the stencil over the view, also while the pointer is elsewhere.
    pub(super) fn show_stencil(&mut self, ui: &Ui, rect: Rect, subject: &Subject<'_>) {
        let Some(stencil) = subject.painted.and_then(|painted| painted.stencil.as_ref()) else {
            return;
        };
        let texture = self.stencil_picture.of(ui, stencil);
        let placed = PlacedStencil::of(stencil, rect);
        let is_drawing = self.brush.pulled().is_some();
        placed.show(&ui.painter_at(rect), texture, subject.theme.accent, is_drawing);
    }

    /// Draws the outline of the brush on the surface under the pointer.
    pub(super) fn show_brush(&self, ui: &Ui, response: &Response, rect: Rect, subject: &Subject<'_>) {
        let (Some(painted), Some(picture)) = (subject.painted, &self.last) else {
            return;
        };
        let Some(pointer) = response.hover_pos().filter(|at| rect.contains(*at)) else {
            return;
        };
        let seen = SeenModel {
            camera: self.navigation.camera,
            rect,
        };
        // A drag that changes the size leaves the brush where it was, and a string pulls it behind the pointer.
        let at = self.brush.resized_at().or(self.brush.pulled()).unwrap_or(pointer);
        if painted.brush.lag > 0.0 && self.brush.pulled().is_some() {
            ui.painter()
                .line_segment([at, pointer], Stroke::new(1.0, subject.theme.accent));
        }
        if painted.brush.action == BrushAction::Clone {
            self.show_source(ui, &seen, picture, subject);
        }
        self.show_path(ui, &seen, picture, painted, subject);
        let is_on_mover = self.show_mover(ui, &seen, picture, subject, pointer);
        let stencil = painted.stencil.as_ref();
        let is_on_stencil = stencil.is_some_and(|stencil| PlacedStencil::of(stencil, rect).is_at(pointer));
        if self.show_handles(ui, &seen, picture, subject, pointer) || is_on_mover || is_on_stencil {
            response.clone().on_hover_cursor(CursorIcon::Grab);
            return;
        }
        let Some(picked) = picked_by(&seen.camera, &picture.model, rect, at) else {
            return;
        };
        response.clone().on_hover_cursor(CursorIcon::Crosshair);
        let linked = &picture.model.linked;
        let brush = BrushTool::brush_at(&painted.brush, &picture.model, &seen, at);
        let radius = f64::from(brush.size) * linked.largest_side * picture.model.placement.scale;
        let erases = action_of(&painted.brush, ui.input(|input| input.modifiers)) == BrushAction::Erase;
        let color = if erases { subject.theme.warning } else { Color32::WHITE };
        let hard = f64::from(painted.brush.hardness);
        let own = [(None, 1.0, 1.0), (None, hard, 0.45)];
        // Outlines at the places of the copies of the stroke.
        let copies = painted.brush.symmetry.copies();
        let copies = copies.iter().map(|copy| (Some(copy), 1.0, COPY_STRENGTH));
        for (copy, share, strength) in own.into_iter().chain(copies) {
            let corners = seen.outline(&picked, (share * radius) as f32, copy);
            for (width, color) in [
                (3.0, Color32::from_black_alpha(90)),
                (1.2, color.gamma_multiply(strength)),
            ] {
                for pair in corners.windows(2) {
                    ui.painter().line_segment([pair[0], pair[1]], Stroke::new(width, color));
                }
            }
        }
    }
}
