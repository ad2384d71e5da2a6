//! A gray day over open country.

use glam::{DVec3, dvec2, dvec3};

use super::clouds::{clouds, skyline};
use super::smooth;

const SKY: DVec3 = dvec3(0.93, 0.99, 1.1);
/// Share of the light that earth reflects.
const EARTH: DVec3 = dvec3(0.215, 0.178, 0.135);
const GRASS: DVec3 = dvec3(0.155, 0.15, 0.09);

/// The sky grows three times brighter from the horizon to the zenith (Moon and Spencer 1942; CIE S 011, type 16), and what
/// lies under it is lit by 7/9 of the zenith.
pub(super) fn light(to: DVec3) -> DVec3 {
    let up = to.y.max(0.0);
    let layer = dvec2(to.x, to.z) / (up + 0.22);
    let thickness = clouds(layer * 0.55, 3) * smooth(0.0, 0.35, to.y);
    let sky = SKY * (1.0 + 2.0 * up) / 3.0 * (1.0 + 0.3 * thickness);
    // Thinner clouds let a warmer light through.
    let sky = sky * dvec3(1.0 + 0.03 * thickness, 1.0, 1.0 - 0.03 * thickness);
    // Woods far away, and nearer ones.
    let edge = 0.004;
    let above = [(2.6, 0.05, 0.55), (4.3, 0.026, 0.3)]
        .into_iter()
        .fold(sky, |behind, (size, height, share)| {
            let top = skyline(to, size, height);
            let woods = SKY * dvec3(0.3, 0.33, 0.31) * share;
            let misty = woods.lerp(sky, 0.3 + 0.25 * smooth(top, -0.01, to.y));
            behind.lerp(misty, smooth(top + edge, top - edge, to.y))
        });
    if to.y >= edge {
        return above;
    }
    let place = dvec2(to.x, to.z) / (-to.y).max(0.02);
    let patches = clouds(place * 0.4 + dvec2(40.0, 3.0), 3);
    let cover = EARTH.lerp(GRASS, smooth(-0.25, 0.3, patches));
    let mottled = 1.0 + 0.25 * clouds(place * 1.9, 2) * smooth(0.05, 0.3, -to.y);
    // Below the viewer, the model hides a part of the sky.
    let open = 1.0 - 0.45 * smooth(-0.55, -1.0, to.y);
    let ground = cover * SKY * (7.0 / 9.0) * mottled * open;
    // Far ground fades into the air.
    let haze = (to.y.min(0.0) / 0.05).exp();
    ground
        .lerp(sky * 0.93, 0.85 * haze)
        .lerp(sky, smooth(-0.012, 0.012, to.y))
}
