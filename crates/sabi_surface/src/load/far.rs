//! Models far from the origin of their scene, such as parts of maps and buildings: 32-bit floats would lose their shape
//! there, and the rays that start on it.

use glam::{DMat4, DVec3, Vec3};

use super::Piece;

/// Ratio of distance to size from which on a model is moved to the origin. Below it positions are exact to better than a
/// hundred-thousandth of the model's size.
const FAR: f64 = 100.0;

/// Returns the transform that moves pieces near the origin, and the new origin in the file's own world: zero unless they are
/// far away. Each piece comes with its transform in the file.
pub(super) fn brought_near<'p>(
    world_from_file: DMat4,
    pieces: impl Iterator<Item = (&'p Piece, DMat4)>,
) -> (DMat4, [f64; 3]) {
    let middle = far_middle(pieces.map(|(piece, file_from_mesh)| (piece, world_from_file * file_from_mesh)));
    (DMat4::from_translation(-middle) * world_from_file, middle.to_array())
}

/// The middle of placed pieces where they all are far away, else zero.
fn far_middle<'p>(placed: impl Iterator<Item = (&'p Piece, DMat4)>) -> DVec3 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (piece, world_from_mesh) in placed {
        for at in &piece.positions {
            let at = world_from_mesh.transform_point3(Vec3::from(*at).as_dvec3());
            // Positions that are not finite are left out when pieces are placed.
            if at.abs().max_element() <= f64::from(f32::MAX) {
                (low, high) = (low.min(at), high.max(at));
            }
        }
    }
    let (middle, size) = ((low + high) / 2.0, (high - low).max_element());
    if size >= 0.0 && middle.length() > FAR * size {
        middle
    } else {
        DVec3::ZERO
    }
}
