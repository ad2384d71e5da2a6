//! The ground below a model: how much of the sky is visible from it, past the model.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::bvh::Bvh;
use crate::model::Mesh;

/// Number of places along a side of the square.
const SIDE: usize = 128;
/// Number of rays for each place.
const RAYS: usize = 64;
/// Angle from a ray to the next one around the vertical: the golden angle, which distributes any number of rays evenly.
const GOLDEN_ANGLE: f32 = 2.399_963_2;

/// Openness of the ground below a model, over a square around the vertical axis through the middle of the model's box.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Height of the ground, which is that of the lowest vertex, in model units.
    pub height: f32,
    /// Half the side of the square, model units.
    pub radius: f32,
    /// Places along a side.
    pub side: usize,
    /// Cosine-weighted share of the sky that is open, row by row along +Z, within a row along +X.
    pub openness: Vec<f32>,
}

impl Ground {
    /// Computes the openness of the ground with rays; `None` for a mesh without extent.
    pub fn of(mesh: &Mesh, bvh: &Bvh) -> Option<Ground> {
        let used = mesh.triangles.iter().flatten();
        let places = used.filter_map(|vertex| mesh.positions.get(*vertex as usize));
        let places = places.map(|place| Vec3::from(*place)).filter(|place| place.is_finite());
        let [low, high] = places.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], place| {
            [low.min(place), high.max(place)]
        });
        let size = high - low;
        let largest = size.max_element();
        if !(largest.is_finite() && largest > 0.0) {
            return None;
        }
        let center = 0.5 * (low + high);
        let radius = 0.5 * Vec2::new(size.x, size.z).length() + 0.7 * largest;
        // Start below the lowest faces, so that the ground under them is covered.
        let start = low.y - 1e-3 * largest;
        let open_at = |index: usize| {
            let [x, z] = [index % SIDE, index / SIDE].map(|at| (at as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0);
            let origin = [center.x + x * radius, start, center.z + z * radius];
            // Neighbors use different rotations, so that no pattern of rays is visible.
            let turn = (index as f32 * 0.618_034).fract() * TAU;
            let is_open = |ray: &usize| {
                let share = (*ray as f32 + 0.5) / RAYS as f32;
                let (sin, cos) = (turn + *ray as f32 * GOLDEN_ANGLE).sin_cos();
                let flat = share.sqrt();
                !bvh.any(origin, [flat * cos, (1.0 - share).sqrt(), flat * sin], 4.0 * radius)
            };
            (0..RAYS).filter(is_open).count() as f32 / RAYS as f32
        };
        let found: Vec<f32> = (0..SIDE * SIDE).into_par_iter().map(open_at).collect();
        Some(Ground {
            height: low.y,
            radius,
            side: SIDE,
            openness: smoothed(&found),
        })
    }
}

/// Returns the mean over 3 × 3 places with binomial weights, which removes the noise of the rays.
fn smoothed(values: &[f32]) -> Vec<f32> {
    let at = |x: usize, z: usize| values[z.min(SIDE - 1) * SIDE + x.min(SIDE - 1)];
    let row = |x: usize, z: usize| 0.25 * at(x.saturating_sub(1), z) + 0.5 * at(x, z) + 0.25 * at(x + 1, z);
    let mean = |index: usize| {
        let (x, z) = (index % SIDE, index / SIDE);
        0.25 * row(x, z.saturating_sub(1)) + 0.5 * row(x, z) + 0.25 * row(x, z + 1)
    };
    (0..SIDE * SIDE).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A horizontal square of side 2 at a height, and one triangle of no area on the ground.
    fn roof(height: f32) -> Mesh {
        Mesh {
            positions: vec![
                [-1.0, height, -1.0],
                [1.0, height, -1.0],
                [1.0, height, 1.0],
                [-1.0, height, 1.0],
                [0.0; 3],
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 4, 4]],
            ..Mesh::default()
        }
    }

    #[test]
    fn a_square_above_the_ground_covers_the_share_of_the_sky_that_geometry_gives() {
        let mesh = roof(1.0);
        let ground = Ground::of(&mesh, &Bvh::build(&mesh)).unwrap();
        let middle = ground.openness[(SIDE / 2) * SIDE + SIDE / 2];
        // View factor from a small area to a parallel square of half side 1 at distance 1, straight above.
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let covered = 4.0 / TAU * 2.0 * half * half.atan();
        assert!(
            (middle - (1.0 - covered)).abs() < 0.03,
            "{middle} is not {}",
            1.0 - covered
        );
        assert!(ground.openness[0] > 0.93, "{}", ground.openness[0]);
        assert_eq!(ground.height, 0.0);
    }

    #[test]
    fn a_mesh_without_extent_has_no_ground() {
        let mesh = Mesh::default();
        assert_eq!(Ground::of(&mesh, &Bvh::build(&mesh)), None);
    }
}
