//! Areas of triangles, in space and in the plane.

use glam::DVec2;

use crate::model::Mesh;

/// Returns the area of a triangle in space; 0 if it is within the rounding error of its positions.
pub(super) fn area(mesh: &Mesh, triangle: u32) -> f64 {
    let [a, b, c] = mesh.corners(triangle);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let twice = (b - a).cross(c - a).length();
    if twice > longest * longest * 1e-9 {
        twice / 2.0
    } else {
        0.0
    }
}

/// Area of a triangle in the plane.
pub(super) fn flat_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a).abs() / 2.0
}
