//! Grains: chalk, sponge and spray.

use glam::{DVec2, DVec3};

use super::noise::{RandomSequence, block, noise_2, noise_3, numbers, seed_of};
use super::spot::{Spot, shown};

/// Width of the grains of chalk.
const GRAIN: f64 = 0.16;
/// Sizes of pores of a sponge: number of cells along a radius, and the largest radius of a pore, in cells.
const PORES: [(f64, f64); 3] = [(3.4, 0.42), (6.7, 0.46), (14.0, 0.4)];
/// Sizes of dots of spray, the finest last: number of cells for dots along a radius, and the share of cells with a dot
/// in the middle.
const DOTS: [(f64, f64); 3] = [(9.0, 0.35), (17.0, 0.8), (27.0, 0.9)];

/// Chalk, whose strength depends on the grain of the surface.
pub(super) fn chalk() -> impl Fn(&Spot) -> f64 {
    |spot| spot.crumbled(spot.grain, [0.45, 0.85], 0.045, 0.3 * GRAIN)
}

/// Returns the grain of the surface for chalk, which keeps its place on the model. The position and the width of a texel
/// are in radii of the brush.
pub(super) fn chalk_grain(model: DVec3, texel: f64) -> f64 {
    let place = model / GRAIN;
    let fine = (noise_3(6.9 * place, 3) - 0.5) * shown(0.15 * GRAIN, texel);
    0.55 * noise_3(place, 1) + 0.45 * noise_3(2.6 * place, 2) + 0.32 * fine
}

/// Print of a sponge: walls between pores of several sizes.
pub(super) fn sponge(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let (seed, offset) = (seed_of(seeds), dice.offset());
    move |spot| {
        let place = spot.q + offset;
        let warp = DVec2::new(noise_2(7.0 * place, 1), noise_2(7.0 * place, 2)) - 0.5;
        let bent = place + 0.07 * warp;
        let mut wall: f64 = 1.0;
        for (salt, (scale, size)) in PORES.into_iter().enumerate() {
            let cells = scale * bent;
            for cell in block(cells) {
                let [x, y, z] = numbers(seed, [cell.x as i32, cell.y as i32, 11 + salt as i32]);
                let radius = size * (0.3 + 0.7 * z);
                let distance = cells.distance(cell + DVec2::new(x, y));
                wall = wall.min((distance - radius) / (scale * 0.035));
            }
        }
        let pressed = 0.6 * noise_2(1.9 * place, 3) + 0.4 * noise_2(5.3 * place, 4);
        let value = pressed + 0.2 * wall.clamp(-1.6, 0.6);
        spot.crumbled(value, [0.46, 0.86], 0.045, 0.08)
    }
}

/// Fine dots, fewer toward the border.
pub(super) fn spray(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let seed = seed_of(seeds);
    move |spot| {
        let mut most: f64 = 0.0;
        for (salt, (scale, share)) in DOTS.into_iter().enumerate() {
            let cells = scale * spot.q;
            for cell in block(cells) {
                let [x, y, z] = numbers(seed, [cell.x as i32, cell.y as i32, 1 + salt as i32]);
                let middle = cell + DVec2::new(x, y);
                if z > share || cells.distance_squared(middle) > 0.25 {
                    continue;
                }
                // Keeps the dot inside of the border, whatever the hardness.
                let left = 1.0 - middle.length() / (0.97 * scale);
                let is_there = z < share * left * (2.0 - left).max(0.0) * left.max(0.0).sqrt();
                if !is_there {
                    continue;
                }
                // The remainder of the third number is random, too.
                let size = z / (share * left);
                let radius = (0.1 + 0.28 * size * size) / scale;
                most = most.max(spot.disk(cells.distance(middle) / scale, radius));
            }
        }
        most * spot.fall.sqrt()
    }
}
