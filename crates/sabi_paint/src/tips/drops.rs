//! Water and paint that was thrown or ran down: splatter, drips, leaks and rings.

use glam::DVec2;

use super::noise::{RandomSequence, noise_2, smooth_step, stretched_noise};
use super::spot::Spot;

/// Drops of a stamp of splatter.
const DROPS: usize = 44;
/// Runs of a stamp of drips.
const RUNS: usize = 7;
/// Streaks of a stamp of leaks.
const STREAKS: usize = 18;
/// Width over which touching drops flow together.
const MELT: f64 = 0.07;

/// A drop, elongated if it moved along the surface.
struct Drop {
    from: DVec2,
    way: DVec2,
    /// 1 divided by the squared length of the way.
    scale: f64,
    radius: f64,
}

/// Drops of a throw: a few large ones, satellites around those, and fine ones everywhere.
fn thrown(dice: &mut RandomSequence) -> [Drop; DROPS] {
    let mut large = [(DVec2::ZERO, 0.0); 4];
    std::array::from_fn(|index| {
        let around = large[(4.0 * dice.unit()) as usize % 4];
        let (middle, radius) = match index {
            0..4 => {
                let size = [0.19, 0.12, 0.085, 0.06][index] * dice.between(0.7, 1.15);
                (dice.in_disk(0.7 - 0.5 * size), size)
            }
            4..20 => {
                let radius = 0.012 + 0.036 * dice.unit().powi(2);
                let away = around.1 * dice.between(1.15, 2.6) + radius;
                (around.0 + away * dice.direction(), radius)
            }
            _ => (dice.in_disk(0.95), 0.008 + 0.035 * dice.unit().powi(4)),
        };
        if index < 4 {
            large[index] = (middle, radius);
        }
        let middle = middle.clamp_length_max(0.95 - radius);
        let room = (0.95 - radius - middle.length()).max(0.0);
        let flown = if dice.unit() < 0.4 {
            dice.between(0.6, 2.6) * radius
        } else {
            0.0
        };
        let way = middle.normalize_or_zero() * flown.min(room);
        Drop {
            from: middle,
            way,
            scale: 1.0 / way.length_squared().max(1e-12),
            radius,
        }
    })
}

/// Drops of different sizes.
pub(super) fn splatter(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let drops = thrown(&mut dice);
    move |spot| {
        let place = 4.3 * spot.q + offset;
        let warp = DVec2::new(noise_2(place, 1), noise_2(place, 2)) - 0.5;
        let q = spot.q + 0.055 * warp;
        let mut most: f64 = 0.0;
        for drop in &drops {
            let own = q - drop.from;
            let t = (own.dot(drop.way) * drop.scale).clamp(0.0, 1.0);
            let off = (own - t * drop.way).length_squared();
            let radius = drop.radius * (1.0 - 0.65 * t);
            let reach = radius + spot.texel;
            if off < reach * reach {
                most = most.max(spot.disk(off.sqrt(), radius));
            }
        }
        // Drops are dense nearly up to the border.
        most * (4.0 * spot.fall).min(1.0)
    }
}

/// Returns the smaller of two distances, smoothed where they are similar, so that shapes merge (Quilez, "Smooth minimum").
fn melted(a: f64, b: f64) -> f64 {
    let h = (MELT - (a - b).abs()).max(0.0) / MELT;
    a.min(b) - 0.25 * MELT * h * h
}

/// A run of paint: a thin trail from `start` down to a drop at `end`.
struct PaintRun {
    y: f64,
    start: f64,
    end: f64,
    half: f64,
    drop: f64,
}

/// Runs that hang down from a wet edge, each with a drop at its end.
pub(super) fn drips(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let runs: [PaintRun; RUNS] = std::array::from_fn(|index| {
        let y = 1.36 * ((index as f64 + dice.between(0.1, 0.9)) / RUNS as f64 - 0.5);
        let half = dice.between(0.014, 0.034);
        let drop = half * dice.between(1.5, 2.1) + 0.008;
        let start = dice.between(-0.72, -0.6);
        let lowest = (0.9 - y * y).sqrt() - drop;
        let end = start + (lowest - start) * (0.14 + 0.86 * dice.unit() * dice.unit().sqrt());
        PaintRun {
            y,
            start,
            end,
            half,
            drop,
        }
    });
    let beads: [(DVec2, f64); 6] = std::array::from_fn(|index| {
        let y = 1.2 * ((index as f64 + dice.unit()) / 6.0 - 0.5);
        (DVec2::new(dice.between(-0.7, -0.58), y), dice.between(0.04, 0.115))
    });
    move |spot| {
        let q = spot.q;
        let mut distance = f64::INFINITY;
        let mut tone: f64 = 0.0;
        for (middle, radius) in &beads {
            distance = melted(distance, q.distance(*middle) - radius);
        }
        tone = tone.max(1.0 - 3.0 * (q.x + 0.5).max(0.0));
        let sway = 0.05 * (noise_2(DVec2::new(1.9 * q.x, 1.2 * q.y) + offset, 1) - 0.5);
        for run in &runs {
            let y = q.y - run.y - sway;
            if y.abs() > 0.3 {
                continue;
            }
            let x = q.x.clamp(run.start, run.end);
            // Wide where it leaves the edge and thinnest above the drop.
            let t = (x - run.start) / (run.end - run.start);
            let half = run.half * (0.75 + 1.1 * (1.0 - 4.0 * t).max(0.0));
            distance = melted(distance, DVec2::new(q.x - x, y).length() - half);
            let below = q.x - run.end;
            // The drop is elongated upward.
            let below = if below < 0.0 { 0.55 * below } else { below };
            distance = melted(distance, DVec2::new(below, y).length() - run.drop);
            if y.abs() < 2.0 * run.drop {
                tone = tone.max(1.0 - 3.5 * (run.end - q.x - run.drop).abs());
            }
        }
        spot.edge(-distance) * (0.72 + 0.28 * tone.clamp(0.0, 1.0)) * spot.fall
    }
}

/// A streak that dirty water leaves below a joint.
struct Streak {
    y: f64,
    start: f64,
    length: f64,
    half: f64,
    strength: f64,
}

/// Streaks of rain and rust: dense and narrow where they start, wider and fainter below.
pub(super) fn leaks(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let streaks: [Streak; STREAKS] = std::array::from_fn(|_| {
        let y = dice.between(-0.8, 0.8);
        let room = (0.94 - y * y).sqrt();
        let start = -room + 0.3 * dice.unit() * dice.unit() * room;
        let long = dice.unit();
        Streak {
            y,
            start,
            length: (room - start) * (0.22 + 0.78 * long),
            half: 0.02 + 0.15 * dice.unit() * dice.unit() * (1.0 - 0.6 * y.abs()),
            strength: 0.55 + 0.45 * long,
        }
    });
    move |spot| {
        let q = spot.q;
        let sway = 0.035 * (noise_2(DVec2::new(1.3 * q.x, 2.5 * q.y) + offset, 1) - 0.5);
        let mut clear = 1.0;
        for streak in &streaks {
            let t = (q.x - streak.start) / streak.length;
            let y = (q.y - streak.y - sway).abs();
            if !(0.0..1.0).contains(&t) {
                continue;
            }
            let own = streak.half * (t / 0.3).min(1.0).sqrt() * (0.6 + 0.4 * t);
            // At least as wide as a texel, and fainter instead.
            let half = own.max(0.8 * spot.texel);
            if y > half {
                continue;
            }
            let profile = (1.0 - (y / half) * (y / half)) * (own / half);
            let faded = (1.0 - t) * (1.0 - 0.4 * t) * (t / 0.06).min(1.0);
            clear *= 1.0 - (streak.strength * profile * faded).min(0.97);
        }
        // Rows of several widths, so that no regular lattice is visible.
        let rows = |wide: f64, seed: u32| {
            let place = DVec2::new(0.9 + 0.02 * wide, wide) * (q + DVec2::new(0.0, sway));
            (stretched_noise(place + offset, seed) - 0.5) * spot.shown(1.0 / wide)
        };
        let streaky = 0.5 + 0.36 * rows(15.0, 2) + 0.36 * rows(37.0, 3) + 0.28 * rows(83.0, 4);
        let grit = noise_2(30.0 * q + offset, 5) - 0.5;
        let wet = 1.0 - clear;
        // Thin water divides into threads; dense water does not.
        let threads = smooth_step(streaky + 0.08 * grit * spot.shown(0.033), 0.56 - 0.42 * wet, 0.2);
        (wet * (0.25 + 0.95 * threads)).min(1.0) * spot.fall
    }
}

/// Edge of a puddle that dried: an uneven closed line in terms of the direction from the middle.
struct Tide {
    middle: DVec2,
    radius: f64,
    width: f64,
    strength: f64,
    seed: u32,
}

/// Stain of water that dried: a dark rim, sharp on the outside, with paler rims of earlier puddles within.
pub(super) fn ring(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let tides: [Tide; 3] = std::array::from_fn(|index| {
        let share = [1.0, 0.8, 0.5][index] * dice.between(0.86, 1.0);
        let radius = 0.84 * share;
        Tide {
            middle: dice.in_disk(0.5 * (0.86 - radius)),
            radius,
            width: dice.between(0.06, 0.11),
            strength: [1.1, 0.5, 0.36][index] * dice.between(0.75, 1.0),
            seed: index as u32 + 1,
        }
    });
    move |spot| {
        let q = spot.q;
        let mottled = 0.6 * noise_2(3.1 * q + offset, 11) + 0.4 * noise_2(9.0 * q + offset, 12);
        let ragged = 0.022 * (noise_2(14.0 * q + offset, 13) - 0.5);
        let mut clear = 1.0;
        for tide in &tides {
            let own = q - tide.middle;
            let away = own.length();
            if away > 1.16 * tide.radius + spot.texel {
                continue;
            }
            let body = 0.16 * mottled;
            if away < 0.5 * tide.radius {
                clear *= 1.0 - tide.strength * body;
                continue;
            }
            let toward = own / away.max(1e-9);
            let bulge = 0.3 * (noise_2(0.9 * toward + offset, tide.seed) - 0.5)
                + 0.09 * (noise_2(2.6 * toward + offset, tide.seed) - 0.5);
            let inside = tide.radius * (0.94 + bulge) - away + ragged;
            if inside < -spot.texel {
                continue;
            }
            let left = (1.0 - inside.max(0.0) / (tide.width * (0.5 + mottled))).max(0.0);
            let rim = left * left * (0.65 + 1.0 * mottled).min(1.0);
            clear *= 1.0 - (spot.edge(inside) * tide.strength * (rim + (1.0 - rim) * body)).min(1.0);
        }
        (1.0 - clear) * spot.fall
    }
}
