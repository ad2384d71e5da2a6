//! Recentering of models far from the origin of their scene, such as parts of maps and buildings. At that distance 32-bit
//! floats are too coarse for their shape and for rays that start on them.

use glam::{DMat4, DVec3};

use super::Submesh;
use super::arealess::corners_with_area;

/// Ratio of distance to size above which a model is moved to the origin. Below it positions are exact to better than a
/// hundred-thousandth of the model's size.
const FAR: f64 = 100.0;

/// Returns the transform that moves submeshes near the origin, and the new origin in the file's world: zero unless they are
/// far away. Each submesh comes with its transform in the file.
pub(super) fn brought_near<'p>(
    world_from_file: DMat4,
    submeshes: impl Iterator<Item = (&'p Submesh, DMat4)>,
) -> (DMat4, [f64; 3]) {
    let placed = submeshes.map(|(submesh, file_from_mesh)| (submesh, world_from_file * file_from_mesh));
    let points = placed.flat_map(|(submesh, world_from_mesh)| corners_with_area(submesh, world_from_mesh));
    let middle = far_middle(points);
    (DMat4::from_translation(-middle) * world_from_file, middle.to_array())
}

/// Returns the center of the bounding box of points if it is far away, else zero.
pub(super) fn far_middle(points: impl Iterator<Item = DVec3>) -> DVec3 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for at in points {
        // Positions that are not finite are removed when submeshes are placed.
        if at.is_finite() && at.abs().max_element() <= f64::from(f32::MAX) {
            (low, high) = (low.min(at), high.max(at));
        }
    }
    let (middle, size) = ((low + high) / 2.0, (high - low).max_element());
    if size >= 0.0 && middle.length() > FAR * size {
        middle
    } else {
        DVec3::ZERO
    }
}
