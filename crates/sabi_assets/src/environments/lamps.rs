//! Lamps with flat fronts, such as soft boxes and windows.

use glam::{DVec2, DVec3, dvec2};

use super::smooth;

/// A lamp with a flat front, on the sphere.
pub(super) struct Lamp {
    /// Direction toward its middle.
    pub(super) toward: DVec3,
    /// Half its width and height at a distance of 1.
    pub(super) half: DVec2,
    /// By which its corners are rounded.
    pub(super) corner: f64,
    /// Over which its edge fades.
    pub(super) edge: f64,
    /// By how much its border is darker than its middle, where the bulb is.
    pub(super) vignette: f64,
    /// By which it is turned around its middle, radians.
    pub(super) turn: f64,
    pub(super) color: DVec3,
}

impl Lamp {
    /// Light from a direction.
    pub(super) fn light(&self, to: DVec3) -> DVec3 {
        let toward = self.toward.normalize();
        let ahead = to.dot(toward);
        if ahead <= 0.05 {
            return DVec3::ZERO;
        }
        let across = DVec3::Y.cross(toward).normalize();
        let place = dvec2(to.dot(across), to.dot(toward.cross(across))) / ahead;
        let place = DVec2::from_angle(self.turn).rotate(place);
        // Distance from a rounded rectangle, below 0 inside.
        let beyond = place.abs() - self.half + self.corner;
        let distance = beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0) - self.corner;
        let front = smooth(0.5 * self.edge, -0.5 * self.edge, distance);
        let middle = 1.0 - self.vignette * (place / self.half).length_squared().min(2.0) * 0.5;
        self.color * front * middle
    }
}
