//! Models that stand far from the middle of their scene, as parts of maps and buildings do: numbers of 32 bits would leave
//! little of their shape there, and of rays that start on it.

use glam::{DMat4, DVec3, Vec3};

use super::Piece;

/// A model that is this many times as far away as it is large is brought to the middle. Nearer, a place on it is known to
/// better than a hundred-thousandth of its size.
const FAR: f64 = 100.0;

/// What places pieces, each with what places it in the file, near the middle of the world, and where that is in the file's
/// own: zero, unless they are far away.
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
            // What is beyond all numbers is left out when it is placed.
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
