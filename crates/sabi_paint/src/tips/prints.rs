//! Prints: a fingertip.

use glam::DVec2;

use super::noise::{RandomSequence, noise_2, smooth_step};
use super::spot::Spot;

/// Ridges of a finger along a radius.
const RIDGES: f64 = 9.2;

/// Print of a fingertip that points to the left of a stroke: ridges that wind around a whorl and run out flat below it.
pub(super) fn fingerprint(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let hand = if dice.unit() < 0.5 { 1.0 } else { -1.0 };
    let core = DVec2::new(dice.between(0.02, 0.2), hand * dice.between(0.0, 0.08));
    let lean = hand * dice.between(0.1, 0.3);
    move |spot| {
        // Along the finger, and across it.
        let q = DVec2::new(spot.q.y, -spot.q.x);
        let mottled = 0.6 * noise_2(2.2 * q + offset, 1) + 0.4 * noise_2(5.5 * q + offset, 2);
        // Outline of the fingertip, pressed unevenly.
        let shape = 1.0 - (q.x / 0.95).powi(2) - (q.y / 0.7).powi(2);
        let outline = smooth_step(shape + 0.8 * (mottled - 0.5), 0.16, 0.14);
        if outline <= 0.0 {
            return 0.0;
        }
        let own = q - core;
        let own = DVec2::new(own.x, own.y - lean * own.x * own.x);
        // Circles around the core become arches that flatten below it.
        let below = smooth_step(-own.x, 0.3, 0.35);
        let (along, across) = (own.x * (1.0 - 0.1 * below), own.y * (1.15 - 0.62 * below));
        let warp = 0.2 * (noise_2(2.1 * q + offset, 3) - 0.5);
        let away = (along * along + across * across).sqrt();
        let angle = std::f64::consts::TAU * RIDGES * (away + warp);
        // The sine of the distance plus the angle around the core is a spiral.
        let around = own / (own.length_squared() + 4e-4).sqrt();
        let wave = angle.sin() * around.x + hand * angle.cos() * around.y;
        let shown = (1.5 - 2.6 * RIDGES * spot.texel).clamp(0.0, 1.0);
        let broken = noise_2(15.0 * q + offset, 4) - 0.5;
        let value = 0.5 * wave * shown + 0.75 * (mottled - 0.5) + 0.5 * broken * spot.shown(0.065);
        let ridge = smooth_step(value, -0.02, 0.16 + 0.3 * RIDGES * spot.texel);
        let grease = 0.14 * mottled;
        outline * (ridge * (0.55 + 0.6 * mottled).min(1.0)).max(grease) * spot.fall
    }
}
