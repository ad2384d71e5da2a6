//! Checks the sizes that a file declares against the limits before anything is allocated.

use super::MAX_TRIANGLES;
use super::error::ModelFault;

/// Minimum memory of a triangle of a mesh: its corners, material and part, and half a vertex with position, normal, tangent
/// and coordinates, as in closed surfaces.
const TRIANGLE_BYTES: u64 = 12 + 4 + 4 + 24;
/// Number of copies of a triangle that exist at the same time: as in the file, and placed in the scene.
const COPIES: u64 = 2;
/// Memory that an atlas keeps for a triangle: its neighbors, its chart and its corners.
const ATLAS_BYTES: u64 = 12 + 4 + 24;
/// Memory of a primitive, or of a placed mesh, in addition to its triangles: lists, names, a transform.
const PRIMITIVE_BYTES: u64 = 1024;
/// Number of primitives whose memory is negligible.
const FEW_PRIMITIVES: u64 = 64;

/// Returns the bytes that a mesh of so many triangles takes once it is loaded, with what an atlas keeps for it.
pub fn mesh_bytes(triangles: u64) -> u64 {
    triangles.saturating_mul(TRIANGLE_BYTES + ATLAS_BYTES)
}

/// Checks that so many triangles, in so many primitives and placed meshes, can be held.
///
/// # Errors
/// There are too many, or they would take more than `memory_bytes`.
pub(super) fn check_size(triangles: u64, primitives: u64, memory_bytes: u64) -> Result<(), ModelFault> {
    if triangles > MAX_TRIANGLES {
        return Err(ModelFault::TooLarge(triangles));
    }
    let needed = triangles
        .saturating_mul(COPIES * TRIANGLE_BYTES + ATLAS_BYTES)
        .saturating_add(
            primitives
                .saturating_sub(FEW_PRIMITIVES)
                .saturating_mul(PRIMITIVE_BYTES),
        );
    match needed > memory_bytes {
        true => Err(ModelFault::memory(needed, memory_bytes)),
        false => Ok(()),
    }
}
