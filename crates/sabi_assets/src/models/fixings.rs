//! Nails, rivets and other fixings of parts, and the small irregularities of hand work.

use glam::{DQuat, DVec2, DVec3, dvec2};

use super::charted_mesh::ChartedMesh;
use super::sweep::turned;

/// A flat dome about the y axis that sits on y = 0, its underside a little below: the head of a nail, rivet or bolt.
pub(crate) fn head(radius: f64, height: f64, segments: usize) -> ChartedMesh {
    let dome = [(0.0, 1.0), (0.55, 0.86), (0.9, 0.45), (1.0, 0.1)];
    let mut line: Vec<DVec2> = dome.iter().map(|&(out, up)| dvec2(out * radius, up * height)).collect();
    line.extend([dvec2(radius, -0.2 * height), dvec2(0.0, -0.2 * height)]);
    turned(&line, 4, segments)
}

/// The turn that takes y to a direction by the shortest way.
pub(crate) fn standing_on(normal: DVec3) -> DQuat {
    DQuat::from_rotation_arc(DVec3::Y, normal)
}

/// The turn that takes x to a direction and keeps y as far up as it can.
pub(crate) fn lying_along(direction: DVec3) -> DQuat {
    let z = direction.cross(DVec3::Y).normalize_or_zero();
    DQuat::from_mat3(&glam::DMat3::from_cols(direction, z.cross(direction), z))
}

/// A number in −1..1 that looks drawn by lot (a hash of the number: Wellons' lowbias32).
pub(crate) fn chance(number: u32) -> f64 {
    let mut x = number.wrapping_add(0x9e37_79b9);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^= x >> 16;
    f64::from(x) / f64::from(u32::MAX) * 2.0 - 1.0
}
