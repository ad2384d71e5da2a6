//! Unit vectors of normals and tangents.

use glam::{DVec3, Vec3};

/// Returns the vector with unit length; `None` if it has no direction.
pub(super) fn unit(vector: DVec3) -> Option<[f32; 3]> {
    // Divide by the largest component first, so that tiny and huge vectors keep their direction.
    let largest = vector.abs().max_element();
    if !(vector.is_finite() && largest > 0.0) {
        return None;
    }
    Some((vector / largest).normalize().as_vec3().into())
}

/// Returns a unit vector perpendicular to the unit vector `normal`.
pub(super) fn perpendicular(normal: [f32; 3]) -> [f32; 3] {
    Vec3::from(normal).any_orthonormal_pair().0.into()
}
