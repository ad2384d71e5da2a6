//! Models that stand far from the middle of their scene, as parts of maps and buildings do: numbers of 32 bits would leave
//! little of their shape there, and of rays that start on it.

use glam::{DMat4, DVec3, Vec3};

use super::Piece;

/// A model that is this many times as far away as it is large is brought to the middle. Nearer, a place on it is known to
/// better than a hundred-thousandth of its size.
const FAR: f64 = 100.0;

/// The middle of placed pieces where they all are far away, else zero.
pub(super) fn far_middle<'p>(placed: impl Iterator<Item = (&'p Piece, DMat4)>) -> DVec3 {
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
