//! Rest of skinned meshes: the one transform by which all joints place a mesh while its skeleton stands as it was bound.

use glam::{DMat3, DMat4};

use super::warnings::Warnings;

/// Largest relative difference between the transforms of joints at rest that rounding explains.
const SAME: f64 = 1e-3;

/// Placement of a mesh by one joint.
pub(super) struct Placement {
    pub(super) file_from_mesh: DMat4,
    /// Distance of the joint from the origin, the scale of the transform's rounding error.
    pub(super) reach: f64,
}

/// Returns the transform of the mesh `name`, which its joints place so, or `bound` where they stand in a pose or leave nothing of
/// it.
pub(super) fn file_from_bound(placements: &[Placement], bound: DMat4, name: &str, warnings: &mut Warnings) -> DMat4 {
    let [first, others @ ..] = placements else {
        return bound;
    };
    let is_usable = |placement: &Placement| {
        let matrix = placement.file_from_mesh;
        matrix.is_finite() && DMat3::from_mat4(matrix).determinant() != 0.0
    };
    if is_usable(first) && others.iter().all(|other| agree(first, other)) {
        warnings.add(format!("The skin of `{name}` is left out: it is taken at rest."));
        return first.file_from_mesh;
    }
    warnings.add(format!(
        "The skeleton of `{name}` stands in a pose; the mesh is taken as it was bound, without it."
    ));
    bound
}

/// Returns true if two joints place a mesh the same, up to rounding.
pub(super) fn agree(a: &Placement, b: &Placement) -> bool {
    let [a_turns, b_turns] = [a, b].map(|placement| DMat3::from_mat4(placement.file_from_mesh));
    let size = a_turns
        .to_cols_array()
        .into_iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let apart = a.file_from_mesh.w_axis - b.file_from_mesh.w_axis;
    a_turns.abs_diff_eq(b_turns, SAME * size) && apart.length() <= SAME * (a.reach + b.reach)
}
