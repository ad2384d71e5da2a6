//! Projection of view space onto the picture, and rays through points of the picture.

use glam::{Mat4, Vec2, Vec3};

use super::{Camera, Lens, clamped_aspect};

/// Radius of the scene around the origin. Half the diagonal of the model's box is at most 0.87, and relief may rise above it.
const SCENE_RADIUS: f64 = 2.0;

/// A half-line in view space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, view units.
    pub origin: Vec3,
    /// Direction, unit length.
    pub direction: Vec3,
}

impl Camera {
    /// Matrix from view space to eye space: +X right, +Y up, looking along −Z.
    pub fn eye_from_view(&self) -> Mat4 {
        let turned = self.axes().transpose();
        let moved = turned * -self.eye_f64();
        let mut matrix = Mat4::from_mat3(turned.as_mat3());
        matrix.w_axis = moved.as_vec3().extend(1.0);
        matrix
    }

    /// Returns the projection of eye space with reversed depth: 1 at the near plane and 0 at the far plane. The planes
    /// enclose the scene. If the eye is inside the scene, the near plane is at a thousandth of the distance to the target.
    pub fn clip_from_eye(&self, aspect: f32) -> Mat4 {
        let camera = self.clamped();
        let aspect = clamped_aspect(aspect);
        let [near, far] = camera.depths();
        let half = camera.height_at_target() * 0.5;
        let columns = match camera.lens {
            Lens::Perspective => {
                let focal = camera.distance / half;
                let (scale, offset) = (near / (far - near), far * (near / (far - near)));
                [
                    [focal / aspect, 0.0, 0.0, 0.0],
                    [0.0, focal, 0.0, 0.0],
                    [0.0, 0.0, scale, -1.0],
                    [0.0, 0.0, offset, 0.0],
                ]
            }
            Lens::Orthographic => {
                let depth = (far - near).recip();
                [
                    [(half * aspect).recip(), 0.0, 0.0, 0.0],
                    [0.0, half.recip(), 0.0, 0.0],
                    [0.0, 0.0, depth, 0.0],
                    [0.0, 0.0, far * depth, 1.0],
                ]
            }
        };
        Mat4::from_cols_array_2d(&columns)
    }

    /// Returns the projection of view space: [`Camera::clip_from_eye`] after [`Camera::eye_from_view`].
    pub fn clip_from_view(&self, aspect: f32) -> Mat4 {
        self.clip_from_eye(aspect) * self.eye_from_view()
    }

    /// Returns the ray through a point of the viewport. With an orthographic lens it starts in front of the whole scene,
    /// since such a lens also shows what is behind the eye.
    pub fn ray(&self, pointer: Vec2, aspect: f32) -> Ray {
        let camera = self.clamped();
        let at = camera.offset_at_target(pointer, aspect);
        let beside = camera.right() * at.x + camera.up() * at.y;
        match camera.lens {
            Lens::Perspective => Ray {
                origin: camera.eye(),
                direction: (camera.forward() * camera.distance + beside).normalize(),
            },
            Lens::Orthographic => Ray {
                origin: camera.eye() + beside + camera.forward() * camera.depths()[0],
                direction: camera.forward(),
            },
        }
    }

    /// Returns the position of a point of view space in the viewport, 0 to 1 from the upper left corner and beyond;
    /// `None` if the point is behind the eye.
    pub fn project(&self, point: Vec3, aspect: f32) -> Option<Vec2> {
        let clip = self.clip_from_view(aspect) * point.extend(1.0);
        let pointer = Vec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5;
        (clip.w > 0.0 && pointer.is_finite()).then_some(pointer)
    }

    /// Returns the distances from the eye forward to the near and the far plane. With an orthographic lens they may be negative.
    fn depths(&self) -> [f32; 2] {
        let middle = self.eye_f64().dot(self.axes().z_axis);
        let [near, far] = [middle - SCENE_RADIUS, middle + SCENE_RADIUS];
        let depths = match self.lens {
            Lens::Perspective => {
                let near = near.max(f64::from(self.clamped().distance).min(1.0) * 1e-3);
                [near, far.max(near * 2.0)]
            }
            Lens::Orthographic => [near, far],
        };
        depths.map(|depth| depth as f32)
    }
}
