//! Camera: orbit, pan, zoom and focus.
//!
//! Three spaces: *view* space is that of the model (+Y up, centered, largest side 1), *eye* space is the camera's own
//! (+X right, +Y up, looking along −Z), *clip* space is wgpu's. Depth is reversed: the near plane has depth 1, the
//! far plane 0, which spends the precision of a 32-bit depth buffer evenly; compare with `Greater` and clear to 0.

mod projection;
mod viewpoint;

#[cfg(test)]
mod tests;

use glam::{DMat3, DVec2, DVec3, DVec4, Vec2, Vec3};

pub use projection::Ray;
pub use viewpoint::{Viewpoint, ViewpointError};

/// Range of distances to the target, in view units: for smaller distances single precision does not suffice, and from
/// larger ones the model is a dot.
const DISTANCES: [f32; 2] = [1e-3, 100.0];
/// Largest coordinate of the target along each axis, view units: the model is near the origin.
const FARTHEST_TARGET: f32 = 10.0;
/// Range of the vertical field of view.
const FOV_Y_DEGREES: [f32; 2] = [1.0, 120.0];
/// Largest share of the longer and of the shorter side of the picture that a framed model fills.
const FRAMED_SHARES: [f64; 2] = [0.84, 0.74];
/// Height of the film to which focal lengths refer.
const FILM_HEIGHT_MM: f32 = 24.0;
/// Angle of an orbit by a drag across the height of the viewport: half a turn.
const ORBIT_DEGREES: f32 = 180.0;

/// Projection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lens {
    /// Perspective.
    #[default]
    Perspective,
    /// Orthographic, with the size that the perspective lens gives at the target.
    Orthographic,
}

/// Orbit camera without roll.
///
/// Its fields may hold any numbers. Every method clamps them first, so that no input leads to NaN in a matrix or a ray.
/// Lengths are view units. A `pointer` is a place in the viewport, 0 to 1 from its upper left corner; an `aspect` is the
/// viewport's width for one height, see [`aspect_of`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Point that the camera looks at and orbits.
    pub target: Vec3,
    /// Side of the model that faces the camera: 0 is +Z, the front in glTF (the camera looks along −Z); 90 is +X.
    pub yaw_degrees: f32,
    /// Elevation: 90 looks straight down at the target, −90 straight up. Values are limited to this range.
    pub pitch_degrees: f32,
    /// Distance from the eye to the target.
    pub distance: f32,
    /// Vertical field of view. For an orthographic lens, the angle that the visible height spans at the target.
    pub fov_y_degrees: f32,
    /// Perspective or orthographic. Switching keeps the size at the target.
    pub lens: Lens,
}

impl Default for Camera {
    /// Returns a camera in front, at a distance at which any model fits into a square picture.
    fn default() -> Self {
        Camera {
            target: Vec3::ZERO,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance: 5.4,
            // Corresponds to a lens of 70 mm on a picture of 36 × 24 mm.
            fov_y_degrees: 19.5,
            lens: Lens::Perspective,
        }
    }
}

impl Camera {
    /// Returns a camera at a viewpoint that frames these points, for example the vertices of a model.
    pub fn seen_from(viewpoint: Viewpoint, points: &[Vec3], aspect: f32) -> Camera {
        let mut camera = Camera {
            yaw_degrees: viewpoint.yaw_degrees,
            pitch_degrees: viewpoint.pitch_degrees,
            ..Camera::default()
        };
        camera.frame(points, aspect);
        camera.distance *= viewpoint.distance;
        camera.clamped()
    }

    /// Returns the focal length that has the camera's field of view on a picture of 36 × 24 mm.
    pub fn focal_length_mm(&self) -> f32 {
        (0.5 * f64::from(FILM_HEIGHT_MM) / self.half_tangent()) as f32
    }

    /// Sets the focal length, and moves the camera so that the target keeps its size in the picture.
    pub fn set_focal_length(&mut self, millimeters: f32) {
        let height = self.height_at_target();
        let fov_y_degrees = 2.0 * (0.5 * FILM_HEIGHT_MM / millimeters).atan().to_degrees();
        *self = Camera { fov_y_degrees, ..*self }.clamped();
        self.distance = height / (2.0 * self.half_tangent() as f32);
        *self = self.clamped();
    }

    /// Orbits by a drag: dragging right turns the near side to the right, dragging down shows more from above.
    pub fn orbit(&mut self, drag_px: Vec2, viewport_px: Vec2) {
        let degrees = drag_px / viewport_px.y * ORBIT_DEGREES;
        if degrees.is_finite() {
            self.turn(-degrees.x);
            self.pitch_degrees += degrees.y;
            *self = self.clamped();
        }
    }

    /// Turns around the vertical axis through the target. A positive angle shows more of the right side.
    pub fn turn(&mut self, yaw_degrees: f32) {
        if yaw_degrees.is_finite() {
            // Both angles are wrapped before they are added, since a small angle would be lost when added to a large one.
            self.yaw_degrees = wrapped(self.yaw_degrees) + wrapped(yaw_degrees);
        }
        *self = self.clamped();
    }

    /// Moves sideways by a drag. The point under the pointer in the plane of the target stays under it.
    pub fn pan(&mut self, drag_px: Vec2, viewport_px: Vec2) {
        self.pan_holding(self.target, drag_px, viewport_px);
    }

    /// Moves sideways by a drag. `point`, for example one picked under the pointer, stays under it.
    pub fn pan_holding(&mut self, point: Vec3, drag_px: Vec2, viewport_px: Vec2) {
        *self = self.clamped();
        let depth = (point - self.eye()).dot(self.forward());
        let height = match self.lens {
            Lens::Perspective if depth > 0.0 => self.height_at_target() * depth / self.distance,
            _ => self.height_at_target(),
        };
        let drag = drag_px / viewport_px.y * height;
        let target = self.target - self.right() * drag.x + self.up() * drag.y;
        if target.is_finite() {
            self.target = target;
            *self = self.clamped();
        }
    }

    /// Moves toward the target. A factor of 2 doubles its size in the picture.
    pub fn zoom(&mut self, factor: f32) {
        self.zoom_toward(self.target, factor);
    }

    /// Moves toward the point under the pointer in the plane of the target. The point stays under the pointer.
    pub fn zoom_at(&mut self, pointer: Vec2, aspect: f32, factor: f32) {
        let camera = self.clamped();
        let at = camera.offset_at_target(pointer, aspect);
        self.zoom_toward(camera.target + camera.right() * at.x + camera.up() * at.y, factor);
    }

    /// Moves toward a point, for example the one under the pointer. The point keeps its position in the picture.
    pub fn zoom_toward(&mut self, point: Vec3, factor: f32) {
        *self = self.clamped();
        if !(factor.is_finite() && factor > 0.0 && point.is_finite()) {
            return;
        }
        let distance = (self.distance / factor).clamp(DISTANCES[0], DISTANCES[1]);
        let target = point + (self.target - point) * (distance / self.distance);
        if target.is_finite() {
            self.target = target;
            self.distance = distance;
            *self = self.clamped();
        }
    }

    /// Moves the target to a point and keeps the distance. With a `normal`, the camera looks straight at the surface there.
    pub fn focus(&mut self, point: Vec3, normal: Option<Vec3>) {
        if point.is_finite() {
            self.target = point;
        }
        if let Some(toward) = normal.and_then(Vec3::try_normalize) {
            self.pitch_degrees = toward.y.clamp(-1.0, 1.0).asin().to_degrees();
            // The normal of a floor or a ceiling defines no yaw.
            if toward.x.hypot(toward.z) > 1e-4 {
                self.yaw_degrees = toward.x.atan2(toward.z).to_degrees();
            }
        }
        *self = self.clamped();
    }

    /// Moves the target so that the points are in the middle of the picture, and the eye to the distance at which the
    /// picture shows all of them with a margin. If all points are in one place, the distance is kept.
    pub fn frame(&mut self, points: &[Vec3], aspect: f32) {
        *self = self.clamped();
        let aspect = f64::from(clamped_aspect(aspect));
        let eye_from_view = self.axes().transpose();
        let [longer, shorter] = FRAMED_SHARES;
        let (share_x, share_y) = if aspect >= 1.0 {
            (longer, shorter)
        } else {
            (shorter, longer)
        };
        let slope = DVec2::new(share_x * aspect, share_y) * self.half_tangent();
        // With a perspective lens, a point is inside if `x + slope × z ≤ middle + slope × distance`, and likewise for the other sides.
        let lens = match self.lens {
            Lens::Perspective => 1.0,
            Lens::Orthographic => 0.0,
        };
        let (mut high, mut low) = (DVec2::NEG_INFINITY, DVec2::NEG_INFINITY);
        let mut depths = [f64::INFINITY, f64::NEG_INFINITY];
        for point in points.iter().filter(|point| point.is_finite()) {
            let at = eye_from_view * point.as_dvec3();
            let nearer = slope * (at.z * lens);
            high = high.max(at.truncate() + nearer);
            low = low.max(nearer - at.truncate());
            depths = [depths[0].min(at.z), depths[1].max(at.z)];
        }
        if !(high.is_finite() && low.is_finite()) {
            return;
        }
        let middle = (high - low) * 0.5;
        // The distance is measured from the plane through the origin of view space. The target moves to the middle of the points.
        let distance = ((high + low) * 0.5 / slope).max_element();
        let depth = 0.5 * (depths[0] + depths[1]);
        self.target = (self.axes() * middle.extend(depth)).as_vec3();
        let distance = distance - depth * lens;
        if distance > 1e-9 {
            self.distance = distance as f32;
        }
        *self = self.clamped();
    }

    /// Returns the part of a picture of this size that shows a box in view space, given by two corners: the left, upper,
    /// right and lower border in pixels, with a margin of one pixel. `None` if a part of the box is behind the eye.
    pub fn part_of_picture(&self, [low, high]: [Vec3; 2], [width, height]: [u32; 2]) -> Option<[u32; 4]> {
        let rows = self.picture_rows();
        let half = 0.5 * f64::from(height);
        let mut part = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for corner in 0..8 {
            let side = |bit: usize| if corner >> bit & 1 == 1 { high[bit] } else { low[bit] };
            let corner = DVec3::new(f64::from(side(0)), f64::from(side(1)), f64::from(side(2))).extend(1.0);
            let [x, y, depth] = rows.map(|row| row.dot(corner));
            if depth <= 1e-6 {
                return None;
            }
            let at = [0.5 * f64::from(width) + half * x / depth, half - half * y / depth];
            part = [
                part[0].min(at[0]),
                part[1].min(at[1]),
                part[2].max(at[0]),
                part[3].max(at[1]),
            ];
        }
        let within = |at: f64, most: u32| at.clamp(0.0, f64::from(most)) as u32;
        Some([
            within((part[0] - 1.0).floor(), width),
            within((part[1] - 1.0).floor(), height),
            within((part[2] + 1.0).ceil(), width),
            within((part[3] + 1.0).ceil(), height),
        ])
    }

    /// Returns rows that map a point of view space (with a fourth component of 1) to its position to the right and up, both multiplied by
    /// the depth, and to the depth. Positions divided by the depth are relative to the middle of the picture, in units of half its height.
    pub fn picture_rows(&self) -> [DVec4; 3] {
        let axes = self.axes();
        let eye = self.eye_f64();
        let row = |axis: DVec3| axis.extend(-axis.dot(eye));
        let depth = match self.lens {
            Lens::Perspective => self.half_tangent() * row(-axes.z_axis),
            Lens::Orthographic => DVec4::new(0.0, 0.0, 0.0, 0.5 * f64::from(self.height_at_target())),
        };
        [row(axes.x_axis), row(axes.y_axis), depth]
    }

    /// Position of the eye, view space.
    pub fn eye(&self) -> Vec3 {
        self.eye_f64().as_vec3()
    }

    /// Viewing direction, unit length, view space.
    pub fn forward(&self) -> Vec3 {
        -self.axes().z_axis.as_vec3()
    }

    /// Direction to the right in the picture, unit length, view space.
    pub fn right(&self) -> Vec3 {
        self.axes().x_axis.as_vec3()
    }

    /// Direction up in the picture, unit length, view space.
    pub fn up(&self) -> Vec3 {
        self.axes().y_axis.as_vec3()
    }

    /// Returns the height of the picture at the target, in view units.
    pub fn height_at_target(&self) -> f32 {
        let camera = self.clamped();
        (2.0 * f64::from(camera.distance) * camera.half_tangent()) as f32
    }

    /// Returns the camera with all numbers clamped to their ranges.
    fn clamped(&self) -> Camera {
        let at = self.target.to_array();
        Camera {
            target: at
                .map(|at| clamped_or(at, [-FARTHEST_TARGET, FARTHEST_TARGET], 0.0))
                .into(),
            yaw_degrees: wrapped(self.yaw_degrees),
            pitch_degrees: clamped_or(self.pitch_degrees, [-90.0, 90.0], 0.0),
            distance: clamped_or(self.distance, DISTANCES, Camera::default().distance),
            fov_y_degrees: clamped_or(self.fov_y_degrees, FOV_Y_DEGREES, Camera::default().fov_y_degrees),
            lens: self.lens,
        }
    }

    /// Returns right, up and backward in view space. They are computed from the angles, so that looking straight down is no special case.
    fn axes(&self) -> DMat3 {
        let camera = self.clamped();
        let (sin_yaw, cos_yaw) = f64::from(camera.yaw_degrees).to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = f64::from(camera.pitch_degrees).to_radians().sin_cos();
        DMat3::from_cols(
            DVec3::new(cos_yaw, 0.0, -sin_yaw),
            DVec3::new(-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch),
            DVec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch),
        )
    }

    fn eye_f64(&self) -> DVec3 {
        let camera = self.clamped();
        camera.target.as_dvec3() + camera.axes().z_axis * f64::from(camera.distance)
    }

    fn half_tangent(&self) -> f64 {
        (f64::from(self.clamped().fov_y_degrees) * 0.5).to_radians().tan()
    }

    /// Returns the offset of the pointer from the target in the plane through the target, in view units to the right and up.
    fn offset_at_target(&self, pointer: Vec2, aspect: f32) -> Vec2 {
        let pointer = pointer.to_array().map(|at| clamped_or(at, [-100.0, 100.0], 0.5) - 0.5);
        Vec2::new(pointer[0] * clamped_aspect(aspect), -pointer[1]) * self.height_at_target()
    }
}

/// Returns width divided by height of a viewport, or 1 for a viewport without area.
pub fn aspect_of(viewport_px: Vec2) -> f32 {
    clamped_aspect(viewport_px.x / viewport_px.y)
}

fn clamped_aspect(aspect: f32) -> f32 {
    if aspect.is_finite() && aspect > 0.0 {
        aspect.clamp(1e-2, 1e2)
    } else {
        1.0
    }
}

/// Clamps a number. Returns `otherwise` for NaN.
fn clamped_or(value: f32, [low, high]: [f32; 2], otherwise: f32) -> f32 {
    if value.is_nan() {
        otherwise
    } else {
        value.clamp(low, high)
    }
}

/// Returns the same direction in the range from −180 to 180 degrees.
fn wrapped(degrees: f32) -> f32 {
    if !degrees.is_finite() {
        return 0.0;
    }
    let turned = degrees % 360.0;
    if turned >= 180.0 {
        turned - 360.0
    } else if turned < -180.0 {
        turned + 360.0
    } else {
        turned
    }
}
