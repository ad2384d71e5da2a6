//! Wrap modes of new maps.

use sabi_surface::model::Model;

/// Maximum distance of UVs outside of the unit square that still counts as its edge.
const EDGE: f32 = 1e-4;
/// glTF's wrap modes.
pub(super) const CLAMP_TO_EDGE: u32 = 33071;
pub(super) const REPEAT: u32 = 10497;

/// Returns the wrap mode of each material. Maps repeat if UVs leave the unit square. In other cases repeating would mix
/// values of opposite edges.
pub(super) fn wraps(model: &Model) -> Vec<u32> {
    let mesh = &model.mesh;
    let mut wraps = vec![CLAMP_TO_EDGE; model.materials.len()];
    for (corners, material) in mesh.triangles.iter().zip(&mesh.triangle_material) {
        let mut uvs = corners.iter().filter_map(|vertex| mesh.uvs.get(*vertex as usize));
        let leaves = uvs.any(|uv| !uv.iter().all(|at| (-EDGE..=1.0 + EDGE).contains(at)));
        if let Some(wrap) = wraps.get_mut(*material as usize).filter(|_| leaves) {
            *wrap = REPEAT;
        }
    }
    wraps
}
