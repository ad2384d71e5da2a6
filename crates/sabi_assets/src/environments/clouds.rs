//! Smooth noise on a plane, for clouds, for ground and for what stands at the horizon.

use glam::{DVec2, DVec3};

/// A number from 0 to 1 for a corner of a grid.
fn corner(x: i64, y: i64) -> f64 {
    // Wellons, Prospecting for Hash Functions: lowbias32.
    let mut hash = (x as u32).wrapping_mul(0x9e37_79b9) ^ (y as u32).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x7feb_352d);
    hash = (hash ^ (hash >> 15)).wrapping_mul(0x846c_a68b);
    f64::from(hash ^ (hash >> 16)) / f64::from(u32::MAX)
}

fn one_octave(at: DVec2) -> f64 {
    let (cell, inside) = (at.floor(), at - at.floor());
    // Perlin 2002, Improving Noise: no crease shows at the cells' borders.
    let fade = inside * inside * inside * (inside * (inside * 6.0 - 15.0) + 10.0);
    let corner = |x: f64, y: f64| corner((cell.x + x) as i64, (cell.y + y) as i64);
    let low = corner(0.0, 0.0) + fade.x * (corner(1.0, 0.0) - corner(0.0, 0.0));
    let high = corner(0.0, 1.0) + fade.x * (corner(1.0, 1.0) - corner(0.0, 1.0));
    low + fade.y * (high - low)
}

/// Noise of some octaves, from -1 to 1 with a mean of 0; each is turned against the one before, so that no grid shows.
pub(super) fn clouds(at: DVec2, octaves: u32) -> f64 {
    let (mut sum, mut total, mut weight, mut at) = (0.0, 0.0, 1.0, at);
    for _ in 0..octaves {
        sum += weight * (2.0 * one_octave(at) - 1.0);
        total += weight;
        weight *= 0.5;
        at = DVec2::from_angle(0.6).rotate(at) * 2.03 + DVec2::new(17.3, -9.1);
    }
    sum / total
}

/// Height of hills or woods at an azimuth, as the sine of the angle; `height` is the mean, `size` their number in a
/// quarter turn.
pub(super) fn skyline(to: DVec3, size: f64, height: f64) -> f64 {
    let around = DVec2::new(to.x, to.z).normalize_or(DVec2::X);
    height * (1.0 + 0.9 * clouds(around * size + size, 4))
}
