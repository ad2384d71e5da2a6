//! Three soft boxes in a black room: even light with clear, straight reflections for glossy things.

use glam::{DVec3, dvec2, dvec3};

use super::lamps::Lamp;
use super::smooth;

/// A wide box above, and a tall one on either side.
const LAMPS: [Lamp; 3] = [
    Lamp {
        toward: dvec3(0.0, 1.0, 0.25),
        half: dvec2(0.85, 0.5),
        corner: 0.04,
        edge: 0.03,
        vignette: 0.25,
        turn: 0.0,
        color: dvec3(6.0, 6.0, 6.0),
    },
    Lamp {
        toward: dvec3(-1.0, 0.1, 0.35),
        half: dvec2(0.32, 0.85),
        corner: 0.04,
        edge: 0.03,
        vignette: 0.3,
        turn: 0.0,
        color: dvec3(7.6, 7.4, 7.1),
    },
    Lamp {
        toward: dvec3(1.0, 0.12, -0.1),
        half: dvec2(0.2, 0.9),
        corner: 0.04,
        edge: 0.03,
        vignette: 0.3,
        turn: 0.0,
        color: dvec3(5.0, 5.2, 5.6),
    },
];

/// Light from a direction: a dark room whose floor shines faintly.
pub(super) fn light(to: DVec3) -> DVec3 {
    let wall = dvec3(0.055, 0.056, 0.06);
    let floor = dvec3(0.16, 0.16, 0.165) * (0.4 + 0.6 * smooth(-0.3, -1.0, to.y));
    let room = wall.lerp(floor, smooth(0.0, -0.3, to.y));
    room + LAMPS.iter().map(|lamp| lamp.light(to)).sum::<DVec3>()
}
