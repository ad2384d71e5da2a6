//! A clear evening: a low sun, a sky after Preetham, hills and dry ground.

use std::f64::consts::PI;

use glam::{DVec3, dvec2, dvec3};

use super::clouds::{clouds, skyline};
use super::smooth;

/// Left of the model and before it, 14 degrees high.
const SUN: DVec3 = dvec3(-0.78, 0.2419, 0.577);
/// Half of what the sun's disk is wide: about three times the true sun, so that it covers some pixels.
const SUN_RADIUS: f64 = 0.75 * PI / 180.0;
/// Haze: 2 is very clear, 10 is fog.
const TURBIDITY: f64 = 2.6;
/// Irradiance of a surface that faces the sun, in units of the irradiance of the ground from the sky.
const SUN_SHARE: f64 = 3.6;
/// The sun's light behind so much air.
const SUN_COLOR: DVec3 = dvec3(1.36, 0.95, 0.5);
/// Light that falls on the ground from the sky, kilocandela a square meter times pi, about.
const SKY_IRRADIANCE: f64 = 8.5;

/// Perez' five numbers for luminance and the chromaticities x and y, as slope and offset over turbidity (Preetham, Shirley
/// and Smits 1999, A Practical Analytic Model for Daylight, appendix A.2).
const PEREZ: [[[f64; 2]; 5]; 3] = [
    [
        [0.1787, -1.4630],
        [-0.3554, 0.4275],
        [-0.0227, 5.3251],
        [0.1206, -2.5771],
        [-0.0670, 0.3703],
    ],
    [
        [-0.0193, -0.2592],
        [-0.0665, 0.0008],
        [-0.0004, 0.2125],
        [-0.0641, -0.8989],
        [-0.0033, 0.0452],
    ],
    [
        [-0.0167, -0.2608],
        [-0.0950, 0.0092],
        [-0.0079, 0.2102],
        [-0.0441, -1.6537],
        [-0.0109, 0.0529],
    ],
];

/// Chromaticities of the zenith: powers of turbidity from the second down, for each powers of the sun's angle from the
/// zenith from the third down (the same appendix).
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ],
    [
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ],
];

fn polynomial(factors: &[f64], x: f64) -> f64 {
    factors.iter().fold(0.0, |sum, factor| sum * x + factor)
}

/// Light of the sky above the horizon, kilocandela a square meter in sRGB's primaries.
fn sky(to: DVec3) -> DVec3 {
    let (sun_angle, between) = (SUN.y.acos(), to.dot(SUN.normalize()).clamp(-1.0, 1.0).acos());
    let up = to.y.max(0.02);
    let shape = |numbers: &[[f64; 2]; 5], cos: f64, between: f64| {
        let [a, b, c, d, e] = numbers.map(|line| polynomial(&line, TURBIDITY));
        (1.0 + a * (b / cos).exp()) * (1.0 + c * (d * between).exp() + e * between.cos().powi(2))
    };
    let chi = (4.0 / 9.0 - TURBIDITY / 120.0) * (PI - 2.0 * sun_angle);
    let bright = (4.0453 * TURBIDITY - 4.9710) * chi.tan() - 0.2155 * TURBIDITY + 2.4192;
    let chroma = ZENITH.map(|rows| polynomial(&rows.map(|row| polynomial(&row, sun_angle)), TURBIDITY));
    let zenith = [bright, chroma[0], chroma[1]];
    let [luminance, x, y] = [0, 1, 2].map(|at| {
        let numbers = &PEREZ[at];
        zenith[at] * shape(numbers, up, between) / shape(numbers, 1.0, sun_angle)
    });
    let xyz = dvec3(x / y, 1.0, (1.0 - x - y) / y) * luminance;
    // IEC 61966-2-1.
    dvec3(
        xyz.dot(dvec3(3.2406, -1.5372, -0.4986)),
        xyz.dot(dvec3(-0.9689, 1.8758, 0.0415)),
        xyz.dot(dvec3(0.0557, -0.2040, 1.0570)),
    )
    .max(DVec3::ZERO)
}

/// The sun's disk with a soft edge.
fn sun(to: DVec3) -> DVec3 {
    let sun = SUN.normalize();
    // Near the sun, the cosine says little about the angle.
    let angle = to.cross(sun).length().atan2(to.dot(sun));
    let disk = smooth(1.25 * SUN_RADIUS, 0.75 * SUN_RADIUS, angle);
    let solid = PI * SUN_RADIUS * SUN_RADIUS;
    SUN_COLOR * (disk * SUN_SHARE * SKY_IRRADIANCE / solid)
}

/// Dry ground, in sun and sky.
fn ground(to: DVec3) -> DVec3 {
    let place = dvec2(to.x, to.z) / (-to.y).max(0.015);
    let patches = smooth(-0.3, 0.35, clouds(place * 0.32, 3));
    let cover = dvec3(0.27, 0.2, 0.13).lerp(dvec3(0.19, 0.17, 0.085), patches);
    let grain = 1.0 + 0.22 * clouds(place * 1.7 + 5.0, 3) * smooth(0.04, 0.25, -to.y);
    let light = SUN_COLOR * (SUN_SHARE * SUN.y) + dvec3(0.82, 0.98, 1.3);
    // The shadow of whatever is lit falls below it, away from the sun.
    let shadow = (-(place - dvec2(0.45, -0.33)).length_squared() / 0.8).exp();
    cover * light * (SKY_IRRADIANCE / PI) * grain * (1.0 - 0.5 * shadow)
}

/// Light from a direction.
pub(super) fn light(to: DVec3) -> DVec3 {
    let level = dvec3(to.x, 0.02, to.z).normalize();
    let air = sky(level);
    let far = air * dvec3(0.5, 0.5, 0.56);
    let near = air * dvec3(0.27, 0.25, 0.24);
    let mut color = sky(to) + sun(to);
    let edge = 0.004;
    for (top, hill) in [(skyline(to, 1.9, 0.085), far), (skyline(to, 3.7, 0.034), near)] {
        // Toward its foot a hill fades into the haze.
        let hazed = hill.lerp(air * 0.8, 0.45 * smooth(top, -0.01, to.y));
        color = color.lerp(hazed, smooth(top + edge, top - edge, to.y));
    }
    let haze = 0.75 * (to.y.min(0.0) / 0.045).exp();
    color.lerp(ground(to).lerp(air * 0.62, haze), smooth(edge, -edge, to.y))
}
