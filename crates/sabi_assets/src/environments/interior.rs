//! A living room in the evening: warm walls, a wooden floor, two windows to a blue sky and two lamps.

use glam::{DVec3, dvec2, dvec3};

use super::clouds::clouds;
use super::lamps::Lamp;
use super::smooth;

/// Two windows at the left, a standing lamp before the model at the right, and a ceiling lamp.
const LAMPS: [Lamp; 4] = [
    Lamp {
        toward: dvec3(-1.0, 0.22, 0.1),
        half: dvec2(0.3, 0.42),
        corner: 0.01,
        edge: 0.02,
        vignette: 0.1,
        turn: 0.0,
        color: dvec3(6.2, 7.4, 9.6),
    },
    Lamp {
        toward: dvec3(-0.75, 0.2, 0.95),
        half: dvec2(0.3, 0.42),
        corner: 0.01,
        edge: 0.02,
        vignette: 0.1,
        turn: 0.0,
        color: dvec3(5.6, 6.8, 9.0),
    },
    Lamp {
        toward: dvec3(0.8, 0.28, 0.75),
        half: dvec2(0.13, 0.16),
        corner: 0.06,
        edge: 0.05,
        vignette: 0.5,
        turn: 0.0,
        color: dvec3(30.0, 19.5, 9.6),
    },
    Lamp {
        toward: dvec3(0.25, 1.0, -0.2),
        half: dvec2(0.3, 0.3),
        corner: 0.3,
        edge: 0.06,
        vignette: 0.5,
        turn: 0.0,
        color: dvec3(10.5, 7.6, 4.6),
    },
];

/// Light from a direction.
pub(super) fn light(to: DVec3) -> DVec3 {
    let wall = dvec3(0.52, 0.4, 0.27) * (0.75 + 0.25 * clouds(dvec2(to.x - to.z, 2.0 * to.y), 2));
    let ceiling = dvec3(0.62, 0.5, 0.37);
    let boards = (12.0 * to.x / (-to.y).max(0.1)).floor();
    let floor = dvec3(0.24, 0.13, 0.065) * (0.75 + 0.35 * (0.618 * boards).rem_euclid(1.0));
    let upper = wall.lerp(ceiling, smooth(0.5, 0.62, to.y));
    let room = upper.lerp(floor, smooth(-0.28, -0.36, to.y));
    // Walls are brighter around the lamps.
    let glow = |lamp: &Lamp| 0.05 * lamp.color * ((to.dot(lamp.toward.normalize()) - 1.0) / 0.14).exp();
    room + LAMPS.iter().map(|lamp| lamp.light(to) + glow(lamp)).sum::<DVec3>()
}
