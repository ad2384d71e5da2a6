//! A photographer's studio: a dark, warm room with soft boxes.

use glam::{DVec3, dvec2, dvec3};

use super::lamps::Lamp;
use super::smooth;

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
