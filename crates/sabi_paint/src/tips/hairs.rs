//! Hairs: bristles, the dry brush, scuffs and lint.

use glam::DVec2;

use super::noise::{
    RandomSequence, block, noise_2, noise_3, numbers, random, seed_of, smooth_step, stretched_noise, toward,
};
use super::spot::Spot;

/// Hairs across the bristles.
const HAIRS: f64 = 22.0;
/// Hairs across a dry brush.
const DRY_HAIRS: f64 = 46.0;
/// Layers of fine scratches in a scuff: rows along a radius, scratches along a radius and how they are turned, radians.
const SCUFFS: [(f64, f64, f64); 5] = [
    (21.0, 1.1, 0.02),
    (31.0, 1.6, -0.06),
    (43.0, 1.3, 0.05),
    (16.0, 2.1, -0.12),
    (57.0, 2.4, 0.0),
];
/// Hairs in a stamp of lint, and the straight parts of each.
const LINT: [usize; 2] = [7, 16];

/// Returns the mean over a texel of the strength of hairs at a position across them, given in hairs: that of the hair
/// there, and of the next one if the texel overlaps it.
fn over_hairs(across: f64, texel: f64, hair: impl Fn(i32) -> f64) -> f64 {
    let (cell, half) = (across.floor(), 0.5 * texel.clamp(1e-6, 1.0));
    let own = across - cell;
    let (step, reach) = if own < 0.5 {
        (-1, half - own)
    } else {
        (1, half - (1.0 - own))
    };
    let first = hair(cell as i32);
    if reach <= 0.0 {
        return first;
    }
    first + 0.5 * reach / half * (hair(cell as i32 + step) - first)
}

/// Hairs that draw separate lines along the stroke.
pub(super) fn bristles([stroke, _]: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    move |spot| {
        let across = HAIRS * (spot.q.y + 1.0);
        let round = 1.0 - (2.0 * (across - across.floor()) - 1.0).powi(2);
        let inked = over_hairs(across, HAIRS * spot.texel, |index| {
            let hair = random(stroke, [index, 7, 0]);
            // Hairs lift off and touch the surface again along the way.
            let touch = noise_3(spot.model / 0.6 + 9.0 * hair, 3);
            smooth_step(hair + 0.5 * touch, 0.55, 0.2)
        });
        // If gaps between hairs are too small for the texels, their mean is used.
        let gaps = spot.shown(1.0 / HAIRS);
        let round = std::f64::consts::FRAC_PI_4 + gaps * (round.max(0.0).sqrt() - std::f64::consts::FRAC_PI_4);
        spot.fall * round * inked
    }
}

/// Streaks of a brush that has hardly any paint left: tufts of hairs that skip over the grain of the surface.
pub(super) fn dry_brush([stroke, _]: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    move |spot| {
        let across = DRY_HAIRS * (spot.q.y + 1.0);
        let tufts = stretched_noise(DVec2::new(0.37, 4.3 * spot.q.y), stroke);
        let tooth = (noise_3(spot.model / 0.045, 6) - 0.5) * spot.shown(0.045);
        over_hairs(across, DRY_HAIRS * spot.texel, |index| {
            let [hair, side, _] = numbers(stroke, [index, 3, 1]);
            let off = across - f64::from(index) - 0.5 - 0.3 * (side - 0.5);
            let round = 0.5 + spot.shown(1.0 / DRY_HAIRS) * (0.5 - 2.0 * off.abs()).max(-0.5);
            let touch = noise_3(spot.model / 0.5 + 7.0 * hair, 5);
            let value = 0.3 * hair + 0.75 * tufts + 0.75 * touch + 0.4 * tooth + 0.12 * round;
            spot.crumbled(value, [1.0, 1.42], 0.05, 0.08)
        })
    }
}

/// Worn patch of many short, fine scratches that run the same way.
pub(super) fn scuffs(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let seed = seed_of(seeds);
    let offset = dice.offset();
    let layers = SCUFFS.map(|(rows, columns, turn)| (rows, columns, toward(turn + dice.between(-0.03, 0.03))));
    move |spot| {
        let mut most: f64 = 0.0;
        for (salt, (rows, columns, axis)) in layers.into_iter().enumerate() {
            let along = axis.rotate(spot.q);
            let across = rows * along.y;
            let row = across.floor();
            let shift = random(seed, [row as i32, salt as i32, 3]);
            let cells = columns * along.x + shift;
            let column = cells.floor();
            let [start, length, wide] = numbers(seed, [row as i32, column as i32, 4 + salt as i32]);
            let length = 0.2 + 0.78 * length * length;
            let start = start * (1.0 - length);
            let middle = DVec2::new((column + start + 0.5 * length - shift) / columns, (row + 0.5) / rows);
            let worn = 1.25 - 1.45 * middle.length();
            if wide > worn {
                continue;
            }
            // The way along a scratch, -1 to 1.
            let t = 2.0 * (cells - column - start) / length - 1.0;
            let taper = 1.0 - t * t;
            if taper <= 0.0 {
                continue;
            }
            let half = (0.09 + 0.27 * wide * wide) * taper.sqrt() / rows;
            // If rows are too small for the texels, their mean is used.
            let mean = 2.0 * half * rows;
            let line = mean + spot.shown(1.0 / rows) * (spot.line((across - row - 0.5).abs() / rows, half) - mean);
            most = most.max(line * (0.55 + 0.6 * (worn - wide)).min(1.0) * (0.45 + 0.55 * taper));
        }
        let haze = noise_2(3.0 * spot.q + offset, 7) * stretched_noise(DVec2::new(2.0, 17.0) * spot.q + offset, 8);
        let haze = 0.5 * haze * (1.0 - 1.3 * spot.q.length()).max(0.0);
        (most + (1.0 - most) * haze) * spot.fall
    }
}

/// A hair of lint as a line of straight parts, within a disk.
struct Hair {
    middle: DVec2,
    reach: f64,
    half: f64,
    strength: f64,
    /// 1 divided by the squared length of a part.
    scale: f64,
    places: [DVec2; LINT[1] + 1],
}

fn hair(dice: &mut RandomSequence) -> Hair {
    let from = dice.in_disk(0.75);
    let length = 0.35 + 1.1 * dice.unit() * dice.unit();
    let mut angle = std::f64::consts::TAU * dice.unit();
    // Bends that grow along the hair make it curl.
    let (bend, curl) = (dice.between(-0.19, 0.19), dice.between(-0.032, 0.032));
    let mut at = from;
    let mut places: [DVec2; LINT[1] + 1] = std::array::from_fn(|index| {
        let here = at;
        angle += bend + curl * index as f64;
        at += length / LINT[1] as f64 * toward(angle);
        here
    });
    // A hair that extends beyond the border is made smaller.
    while places.iter().any(|place| place.length() > 0.95) {
        places = places.map(|place| from + 0.9 * (place - from));
    }
    let middle = places.iter().sum::<DVec2>() / places.len() as f64;
    let reach = places.iter().map(|place| place.distance(middle)).fold(0.0, f64::max);
    Hair {
        middle,
        reach,
        half: dice.between(0.004, 0.008),
        strength: dice.between(0.55, 1.0),
        scale: 1.0 / places[0].distance_squared(places[1]).max(1e-12),
        places,
    }
}

/// Distance to the line between two places.
fn distance_to(place: DVec2, from: DVec2, to: DVec2) -> f64 {
    let (own, way) = (place - from, to - from);
    let t = (own.dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    own.distance(t * way)
}

/// Household dust: curled hairs, crumbs and thin fluff.
pub(super) fn lint(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let seed = seed_of(seeds);
    let offset = dice.offset();
    let hairs: [Hair; LINT[0]] = std::array::from_fn(|_| hair(&mut dice));
    move |spot| {
        let mut most: f64 = 0.0;
        for hair in &hairs {
            let reach = hair.reach + hair.half + spot.texel;
            if spot.q.distance_squared(hair.middle) > reach * reach {
                continue;
            }
            let parts = hair.places.windows(2);
            let square = parts
                .map(|ends| {
                    let (own, way) = (spot.q - ends[0], ends[1] - ends[0]);
                    own.distance_squared((own.dot(way) * hair.scale).clamp(0.0, 1.0) * way)
                })
                .fold(f64::INFINITY, f64::min);
            most = most.max(hair.strength * spot.line(square.sqrt(), hair.half));
        }
        for (salt, scale) in [(1, 5.0), (2, 11.0)] {
            let cells = scale * spot.q;
            for cell in block(cells) {
                let [x, y, z] = numbers(seed, [cell.x as i32, cell.y as i32, salt]);
                let middle = cell + DVec2::new(x, y);
                if cells.distance_squared(middle) > 0.4 || z > 1.6 * (1.0 - middle.length() / (0.93 * scale)) {
                    continue;
                }
                // Most are short fibers, some are crumbs.
                let way = DVec2::new((97.0 * x).fract() - 0.5, (89.0 * y).fract() - 0.5);
                let is_crumb = z < 0.2;
                let to = if is_crumb { 0.2 * way } else { way };
                let half = if is_crumb { 0.14 * (0.3 + 4.0 * z) } else { 0.028 };
                let distance = distance_to(cells, middle - 0.7 * to, middle + 0.7 * to) / scale;
                let tone = if is_crumb { 0.95 } else { 0.75 - 0.4 * z };
                most = most.max(tone * spot.line(distance, half / scale));
            }
        }
        let place = spot.q + offset;
        let heap = smooth_step(noise_2(1.9 * place, 3) - 0.5 * spot.q.length(), 0.3, 0.35);
        let cloud = 0.6 * noise_2(5.0 * place, 5) + 0.4 * noise_2(17.0 * place, 4);
        let fluff = 0.7 * heap * cloud * (1.0 - spot.q.length_squared()).max(0.0);
        (most + (1.0 - most) * fluff) * spot.fall
    }
}
