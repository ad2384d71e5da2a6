//! A photographer's studio: a dark, warm room with soft boxes.

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::smooth;

/// A lamp with a flat front, on the sphere.
struct Lamp {
    /// Direction toward its middle.
    toward: DVec3,
    /// Half its width and height at a distance of 1.
    half: DVec2,
    /// By which its corners are rounded.
    corner: f64,
    /// Over which its edge fades.
    edge: f64,
    /// By how much its border is darker than its middle, where the bulb is.
    vignette: f64,
    /// By which it is turned around its middle, radians.
    turn: f64,
    color: DVec3,
}

impl Lamp {
    fn light(&self, to: DVec3) -> DVec3 {
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

/// A large soft box before the model, left and high; a tall strip at its right; a smaller one behind it; a wide one above.
const LAMPS: [Lamp; 4] = [
    Lamp {
        toward: dvec3(-0.72, 0.55, 0.62),
        half: dvec2(0.5, 0.42),
        corner: 0.07,
        edge: 0.05,
        vignette: 0.45,
        turn: 0.1,
        color: dvec3(15.5, 14.6, 13.4),
    },
    Lamp {
        toward: dvec3(1.0, 0.16, 0.16),
        half: dvec2(0.12, 0.72),
        corner: 0.05,
        edge: 0.04,
        vignette: 0.35,
        turn: -0.06,
        color: dvec3(8.2, 8.7, 9.4),
    },
    Lamp {
        toward: dvec3(0.5, 0.42, -0.86),
        half: dvec2(0.3, 0.2),
        corner: 0.05,
        edge: 0.04,
        vignette: 0.4,
        turn: -0.12,
        color: dvec3(12.0, 12.4, 13.0),
    },
    Lamp {
        toward: dvec3(0.06, 1.0, -0.12),
        half: dvec2(0.46, 0.36),
        corner: 0.1,
        edge: 0.12,
        vignette: 0.6,
        turn: 0.0,
        color: dvec3(4.2, 4.05, 3.9),
    },
];

const WALL: DVec3 = dvec3(0.15, 0.136, 0.124);
const FLOOR: DVec3 = dvec3(0.22, 0.2, 0.18);

/// Walls get darker upward and, away from the lamps, to the back; the floor has a pool of light under the model.
fn room(to: DVec3) -> DVec3 {
    let side = 0.8 + 0.2 * (to.z - 0.5 * to.x);
    let wall = WALL * side * (1.0 - 0.6 * smooth(-0.1, 0.9, to.y));
    // Lamps shine on the wall behind them and around.
    let glow = |toward: DVec3, width: f64| ((to.dot(toward.normalize()) - 1.0) / width).exp();
    let glows = dvec3(0.3, 0.28, 0.255) * glow(LAMPS[0].toward, 0.12)
        + dvec3(0.14, 0.15, 0.165) * glow(LAMPS[1].toward, 0.08)
        + dvec3(0.22, 0.225, 0.235) * glow(LAMPS[2].toward, 0.07);
    // The floor is a plane below the eye and runs up into the wall in a curve.
    let place = dvec2(to.x, to.z) / (-to.y).max(0.05);
    let pool = (-(place - dvec2(-0.25, 0.3)).length_squared() / 1.6).exp();
    let floor = FLOOR * (0.4 + 1.9 * pool);
    (wall + glows).lerp(floor, smooth(-0.04, -0.42, to.y))
}

/// Light from a direction.
pub(super) fn light(to: DVec3) -> DVec3 {
    room(to) + LAMPS.iter().map(|lamp| lamp.light(to)).sum::<DVec3>()
}
