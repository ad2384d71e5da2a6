//! Sizes that a file claims, held against the limits before anything is allocated for them.

use super::MAX_TRIANGLES;
use super::error::Fault;

/// Memory of a triangle of a mesh at least: its corners, material and part, and half a vertex with a position, a normal, a tangent and
/// coordinates, as closed surfaces have.
const TRIANGLE_BYTES: u64 = 12 + 4 + 4 + 24;
/// Meshes that a triangle is in at a time: as the file has it, and placed in the scene.
const COPIES: u64 = 2;
/// Memory that an atlas keeps for a triangle: its neighbors, its chart and its corners.
const ATLAS_BYTES: u64 = 12 + 4 + 24;
/// Memory of a primitive, or of a mesh that is placed, besides its triangles: lists, names, a transform.
const PRIMITIVE_BYTES: u64 = 1024;
/// Primitives that take no memory worth counting.
const FEW_PRIMITIVES: u64 = 64;

/// Returns the bytes that a mesh of so many triangles takes once it is loaded, with what an atlas keeps for it.
pub fn mesh_bytes(triangles: u64) -> u64 {
    triangles.saturating_mul(TRIANGLE_BYTES + ATLAS_BYTES)
}

/// Checks that so many triangles, in so many primitives and placed meshes, can be held.
///
/// # Errors
/// They are more than are handled, or would take more than `memory_bytes`.
pub(super) fn check_size(triangles: u64, primitives: u64, memory_bytes: u64) -> Result<(), Fault> {
    if triangles > MAX_TRIANGLES {
        return Err(Fault::TooLarge(triangles));
    }
    let needed = triangles
        .saturating_mul(COPIES * TRIANGLE_BYTES + ATLAS_BYTES)
        .saturating_add(
            primitives
                .saturating_sub(FEW_PRIMITIVES)
                .saturating_mul(PRIMITIVE_BYTES),
        );
    match needed > memory_bytes {
        true => Err(Fault::memory(needed, memory_bytes)),
        false => Ok(()),
    }
}
