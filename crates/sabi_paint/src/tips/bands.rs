//! Bands: a weld, stitches, a rope, and rivets. As ribbons they continue without a gap from each stamp to the next.

use std::f64::consts::PI;

use glam::DVec2;

use super::noise::{RandomSequence, noise_2};
use super::spot::Spot;

/// Ripples of a weld and strands of a rope along a stamp. They are whole numbers, so that the next stamp continues them.
const RIPPLES: f64 = 3.0;
const STRANDS: f64 = 2.0;
/// Half of the width of a weld, and of a rope.
const WELD: f64 = 0.68;
const ROPE: f64 = 0.46;
/// Half of the length of a stitch, and of its thickness.
const STITCH: [f64; 2] = [0.48, 0.2];
/// Radius of a rivet.
const RIVET: f64 = 0.46;

/// Height of a round bar across its width, 0 at its sides and 1 in its middle.
fn round(across: f64, half: f64) -> f64 {
    (1.0 - (across / half).powi(2)).max(0.0).sqrt()
}

/// Weld: a bead of overlapping ripples.
pub(super) fn weld(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let lean = dice.between(-0.5, 0.5);
    move |spot| {
        let q = spot.q;
        // This is 0 at the ends, so that the next stamp continues.
        let own = 1.0 - q.x * q.x;
        let rough = noise_2(4.0 * q + offset, 1) - 0.5;
        let half = WELD * (1.0 + 0.3 * own * rough);
        let across = q.y / half;
        let bow = 0.55 * across * across + 0.12 * own * (lean + rough);
        let phase = 0.5 * RIPPLES * (q.x + 1.0) + bow;
        let ripple = phase - phase.floor();
        // Steep where a ripple overlaps the previous one, and flatter on the other side.
        let shape = (8.0 * ripple).min(1.0) * (1.0 - 0.75 * ripple);
        let grain = 0.3 * own * (noise_2(13.0 * q + offset, 2) - 0.5) * spot.shown(0.08);
        let height = round(q.y, half) * (0.62 + 0.38 * shape + grain);
        height * spot.edge(half - q.y.abs()) * spot.fall
    }
}

/// A stitch of thread.
pub(super) fn stitches(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let lean = dice.between(-0.22, 0.22);
    let [x, y] = [dice.between(-0.08, 0.08), dice.between(-0.07, 0.07)];
    let length = STITCH[0] * dice.between(0.86, 1.1);
    move |spot| {
        let q = spot.q - DVec2::new(x, y);
        let q = DVec2::new(q.x, q.y - lean * q.x);
        let beyond = (q.x.abs() - length).max(0.0);
        let distance = (beyond * beyond + q.y * q.y).sqrt();
        // Threads are twisted.
        let twist = 0.14 * (PI * (9.0 * q.x + 5.0 * q.y)).sin() * spot.shown(0.11);
        let height = 0.55 + (0.45 + twist) * round(distance, STITCH[1]);
        height.min(1.0) * spot.edge(STITCH[1] - distance) * spot.fall
    }
}

/// Rope of twisted strands.
pub(super) fn rope(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let sag = dice.between(-0.2, 0.2);
    move |spot| {
        let own = 1.0 - spot.q.x * spot.q.x;
        let q = DVec2::new(spot.q.x, spot.q.y - sag * own);
        let phase = 0.5 * STRANDS * (q.x + 1.0) + 0.75 * q.y / ROPE;
        let strand = (PI * phase).sin().abs().sqrt();
        let fibers = noise_2(DVec2::new(3.0 * phase, 17.0 * (q.y - 0.4 * q.x)) + offset, 1) - 0.5;
        let height = 0.3 + 0.7 * strand + 0.6 * own * fibers * spot.shown(0.06);
        round(q.y, ROPE) * height.clamp(0.0, 1.0) * spot.fall
    }
}

/// A rivet.
pub(super) fn rivets(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let middle = dice.in_disk(0.035);
    let radius = RIVET * dice.between(0.95, 1.05);
    let offset = dice.offset();
    let worn = dice.between(0.1, 0.3);
    move |spot| {
        let distance = (spot.q - middle).length();
        let wear = worn * (noise_2(5.0 * spot.q + offset, 1) - 0.5);
        let height = 0.5 + (0.5 + wear) * round(distance, radius);
        height.min(1.0) * spot.edge(radius - distance) * spot.fall
    }
}
