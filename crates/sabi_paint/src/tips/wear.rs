//! Damage by tools and weather: scratches, gouges, flakes and pits.

use glam::DVec2;

use super::noise::{RandomSequence, block, noise_2, numbers, seed_of, smooth_step, stretched_noise, toward};
use super::spot::Spot;

/// Scratches of a stamp.
const SCRATCHES: usize = 14;
/// Cells of the chips beside a groove along a radius.
const CHIPS_BESIDE: f64 = 7.0;
/// Chips of paint along a radius.
const CHIPS: f64 = 4.9;
/// Pits along a radius, small ones last, and the largest share of the room that one fills.
const PITS: [(f64, f64); 3] = [(3.1, 0.4), (6.3, 0.46), (14.0, 0.48)];

/// A scratch with tapered ends.
struct Scratch {
    from: DVec2,
    axis: DVec2,
    length: f64,
    half: f64,
    strength: f64,
    /// Height of its bow, as a share of the length.
    bow: f64,
    /// True if the deepest place is near the start.
    is_heavy_first: bool,
}

/// Thin scratches of different length and depth that run nearly the same way.
pub(super) fn scratches(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let scratches: [Scratch; SCRATCHES] = std::array::from_fn(|index| {
        let spread = if index % 5 == 4 { 0.7 } else { 0.13 };
        let axis = toward(dice.between(-spread, spread));
        let middle = DVec2::new(dice.between(-0.3, 0.3), 1.5 * (dice.unit() - 0.5));
        let room = 0.93 - middle.length();
        let size = 1.0 - index as f64 / SCRATCHES as f64;
        let length = 2.0 * (room * dice.between(0.75, 1.0)).min(0.1 + 0.9 * size * size);
        Scratch {
            from: middle - 0.5 * length * axis,
            axis,
            length,
            half: 0.006 + 0.011 * size * dice.unit(),
            strength: dice.between(0.6, 1.0),
            bow: dice.between(-0.03, 0.03),
            is_heavy_first: dice.unit() < 0.5,
        }
    });
    move |spot| {
        let mut most: f64 = 0.0;
        for (index, scratch) in scratches.iter().enumerate() {
            let own = spot.q - scratch.from;
            let t = own.dot(scratch.axis) / scratch.length;
            if !(0.0..1.0).contains(&t) {
                continue;
            }
            let bow = 4.0 * scratch.bow * scratch.length * t * (1.0 - t);
            let off = (own.dot(scratch.axis.perp()) - bow).abs();
            if off > 2.0 * scratch.half + spot.texel {
                continue;
            }
            let from_heavy = if scratch.is_heavy_first { t } else { 1.0 - t };
            let taper = (from_heavy * 14.0).min(1.0) * (1.0 - from_heavy);
            let along = DVec2::new(9.0 * t * scratch.length, 3.7 * index as f64) + offset;
            let rough = noise_2(along, 1);
            // Skips where the tool jumped.
            let touch = smooth_step(noise_2(0.6 * along, 2) + 0.6 * taper, 0.42, 0.12);
            let half = scratch.half * (0.5 + 0.6 * taper.sqrt()) * (0.6 + 0.8 * rough);
            most = most.max(spot.line(off, half) * touch * scratch.strength * (0.6 + 0.4 * taper.sqrt()));
        }
        most * spot.fall
    }
}

/// A single groove with torn edges, deepest along its middle, with chips broken out beside it.
pub(super) fn gouge(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let seed = seed_of(seeds);
    let lean = dice.between(-0.35, 0.35);
    let wide = dice.between(0.1, 0.15);
    move |spot| {
        let q = spot.q;
        let along = q.x / 0.95;
        let room = 1.0 - along * along;
        if room <= 0.0 {
            return 0.0;
        }
        let middle = 0.16 * (noise_2(DVec2::new(1.3 * q.x, 0.0) + offset, 1) - 0.5);
        let side = q.y - middle * room;
        // Deeper toward one end, and each edge torn in its own way.
        let room = room * (0.85 + lean * along);
        let edge = if side < 0.0 { 17.0 } else { 31.0 };
        let at = DVec2::new(4.2 * q.x, edge) + offset;
        // Creased noise has the sharp teeth of a torn edge.
        let teeth = (noise_2(1.9 * at, 3) - 0.5).abs() + 0.5 * (noise_2(4.7 * at, 4) - 0.5).abs();
        let swell = noise_2(0.5 * at, 2);
        let half = wide * room * (0.1 + 2.4 * swell * swell + 1.5 * teeth);
        let inside = half - side.abs();
        let groove = spot.edge(inside);
        // Ridges along the groove, as a hard corner leaves them.
        let ridges = stretched_noise(DVec2::new(1.7, 34.0) * DVec2::new(q.x, side) + offset, 5);
        let depth = (inside / half.max(1e-6)).clamp(0.0, 1.0).sqrt();
        let tone = 0.4 + 0.6 * depth * smooth_step(ridges + 0.3 * depth, 0.55, 0.22);
        // Sharp chips broken out beside the groove.
        let cells = CHIPS_BESIDE * q;
        let mut chips: f64 = 0.0;
        for cell in block(cells) {
            let [x, y, z] = numbers(seed, [cell.x as i32, cell.y as i32, 2]);
            let at = cell + DVec2::new(x, y);
            let left = 1.0 - at.x.abs() / CHIPS_BESIDE - 2.4 * at.y.abs() / CHIPS_BESIDE;
            let skew = 1.6 * ((13.0 * z).fract() - 0.5);
            let own = cells - at;
            let off = DVec2::new(own.x + skew * own.y, own.y - 0.3 * skew * own.x).abs();
            let inside = 0.6 * left * (1.1 - z) - off.x - (0.6 + z) * off.y;
            chips = chips.max(spot.edge(inside / CHIPS_BESIDE) * (0.9 - 0.4 * z));
        }
        (groove * tone).max(chips * spot.shown(0.04)) * spot.fall
    }
}

/// Paint that came off in chips with straight, sharp edges, some down to the primer only.
pub(super) fn flakes(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let (seed, offset) = (seed_of(seeds), dice.offset());
    move |spot| {
        let place = 13.0 * spot.q + offset;
        let warp = DVec2::new(noise_2(place, 1), noise_2(place, 2)) - 0.5;
        let cells = CHIPS * (spot.q + 0.018 * warp);
        let home = cells.floor();
        // The nearest chip that is gone and the nearest that holds.
        let mut gone = (f64::INFINITY, DVec2::ZERO, 0.0);
        let mut held = (f64::INFINITY, DVec2::ZERO);
        for index in 0..9 {
            let cell = home + DVec2::new(f64::from(index % 3 - 1), f64::from(index / 3 - 1));
            let [x, y, z] = numbers(seed, [cell.x as i32, cell.y as i32, 1]);
            let middle = cell + DVec2::new(x, y);
            let square = middle.distance_squared(cells);
            let left = 1.0 - middle.length() / (0.86 * CHIPS);
            if z < 1.35 * left {
                if square < gone.0 {
                    gone = (square, middle, z);
                }
            } else if square < held.0 {
                held = (square, middle);
            }
        }
        if gone.0 == f64::INFINITY {
            return 0.0;
        }
        // Distance to the edge between the two, which is the line at the same distance from both.
        let inside = if held.0 == f64::INFINITY {
            1.0
        } else {
            0.5 * (held.0 - gone.0) / held.1.distance(gone.1) / CHIPS
        };
        let tone = [1.0, 0.62, 0.86, 1.0, 0.74][(gone.2 * 97.0) as usize % 5];
        // A bright lip where the paint stands off.
        let lip = 1.0 - smooth_step(inside, 0.035, 0.02 + spot.texel);
        spot.edge(inside) * (tone + (1.0 - tone) * lip) * (4.0 * spot.fall).min(1.0)
    }
}

/// Pits of corrosion in clusters: bowls of all sizes, small ones around large ones.
pub(super) fn pits(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let (seed, offset) = (seed_of(seeds), dice.offset());
    move |spot| {
        let place = 6.0 * spot.q + offset;
        let warp = DVec2::new(noise_2(place, 1), noise_2(place, 2)) - 0.5;
        let bent = spot.q + 0.11 * warp;
        let crowded = 3.4 * (noise_2(2.3 * spot.q + offset, 3) - 0.43);
        let mut deepest: f64 = 0.0;
        for (salt, (scale, size)) in PITS.into_iter().enumerate() {
            let cells = scale * bent;
            for cell in block(cells) {
                let [x, y, z] = numbers(seed, [cell.x as i32, cell.y as i32, 1 + salt as i32]);
                let middle = cell + DVec2::new(x, y);
                if z > crowded + 0.22 || cells.distance_squared(middle) > 0.25 {
                    continue;
                }
                let left = (0.9 - middle.length() / scale).clamp(0.0, 1.0);
                // Pits shrink where there are few.
                let grown = (crowded + 0.22) * (3.0 * left).min(1.0) - z;
                if grown <= 0.0 {
                    continue;
                }
                let radius = size * (0.3 + grown).min(1.0) * (3.0 * grown).min(1.0) / scale;
                let away = cells.distance(middle) / scale;
                let bowl = (1.0 - away / radius.max(1e-6)).max(0.0);
                let depth = 0.5 + 0.5 * smooth_step(bowl, 0.35, 0.33);
                deepest = deepest.max(spot.disk(away, radius) * depth);
            }
        }
        deepest * spot.fall
    }
}
