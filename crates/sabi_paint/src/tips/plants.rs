//! Plants: leaves, moss and lichen.

use glam::{DVec2, DVec3};

use super::noise::{RandomSequence, noise_2, noise_3, place_in, smooth_step, turned};
use super::spot::Spot;

/// Leaves of a stamp.
const LEAVES: usize = 4;
/// Rosettes of a stamp of lichen.
const ROSETTES: usize = 8;
/// Tufts of moss along a radius.
const TUFTS: f64 = 9.0;

/// A leaf with its stem along its axis.
struct Leaf {
    middle: DVec2,
    axis: DVec2,
    /// Half of its length.
    half: f64,
    /// Half of its width, as a share of half the length.
    wide: f64,
    bow: f64,
}

impl Leaf {
    fn new(index: usize, dice: &mut RandomSequence) -> Leaf {
        let half = [0.5, 0.36, 0.27, 0.2][index] * dice.between(0.85, 1.1);
        let around = std::f64::consts::TAU * (index as f64 / LEAVES as f64 + dice.between(0.0, 0.16));
        let middle = (0.94 - 1.3 * half) * dice.between(0.75, 1.0) * super::noise::toward(around);
        Leaf {
            middle,
            axis: dice.direction(),
            half,
            wide: dice.between(0.4, 0.62),
            bow: dice.between(-0.22, 0.22),
        }
    }

    /// Distance of a place from the border, above 0 inside of the leaf, the strength there, and that of the stem.
    fn at(&self, spot: &Spot) -> Option<(f64, f64, f64)> {
        let own = spot.q - self.middle;
        if own.length_squared() > 1.7 * self.half * self.half {
            return None;
        }
        let s = own.dot(self.axis) / self.half;
        let y = own.dot(self.axis.perp()) / self.half - self.bow * (1.0 - s * s);
        let width = texel_of(spot, self.half);
        let stem = spot.line(y.abs() * self.half, 0.011) * spot.edge(0.28 * self.half - (s + 1.0).abs() * self.half);
        if s.abs() >= 1.0 {
            return Some((-1.0, 0.0, if s < 0.0 { stem } else { 0.0 }));
        }
        // Round at the stem, pointed at the end, with small teeth.
        let teeth = 1.0 + 0.09 * ((7.5 * (s + 1.0)).fract() - 0.6);
        let border = 0.9 * self.wide * (1.0 + s).sqrt() * (1.0 - s) * (1.0 + 0.25 * s) * teeth;
        let inside = (border - y.abs()) * self.half;
        let shown = spot.shown(0.14 * self.half);
        let vein = |distance: f64, half: f64| ((half - distance) / width.max(0.02) + 0.5).clamp(0.0, 1.0);
        let middle_vein = vein(y.abs(), 0.035 * (1.2 - s));
        let sides = (5.5 * (s - 0.85 * y.abs()) + 20.0).fract();
        let side_vein = vein((sides - 0.5).abs() / 5.5, 0.014) * smooth_step(border - y.abs(), 0.06, 0.05);
        let veins = middle_vein.max(0.75 * side_vein) * shown;
        Some((inside, 1.0 - 0.72 * veins, stem))
    }
}

/// Width of a texel in the frame of a leaf.
fn texel_of(spot: &Spot, half: f64) -> f64 {
    spot.texel / half
}

/// A few fallen leaves with veins, each above the ones before it.
pub(super) fn leaves(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let offset = dice.offset();
    let leaves: [Leaf; LEAVES] = std::array::from_fn(|index| Leaf::new(index, &mut dice));
    move |spot| {
        let mottled = noise_2(7.0 * spot.q + offset, 1);
        let mut strength: f64 = 0.0;
        for leaf in &leaves {
            let Some((inside, tone, stem)) = leaf.at(spot) else {
                continue;
            };
            // A gap keeps a leaf apart from the one below it.
            strength *= 1.0 - spot.edge(inside + 0.025);
            let body = spot.edge(inside) * tone * (0.72 + 0.45 * mottled).min(1.0);
            strength = strength.max(body).max(stem);
        }
        strength * spot.fall
    }
}

/// Cushions of moss, made of small tufts, that stay where they are on the model.
pub(super) fn moss() -> impl Fn(&Spot) -> f64 {
    |spot| {
        let ground = noise_3(2.9 * spot.model, 31);
        let grown = (ground - 0.86 + 0.52 * spot.fall) / 0.36 + 0.5;
        if grown <= 0.0 || spot.fall <= 0.0 {
            return 0.0;
        }
        // Leaves stand out of the tufts on all sides.
        let leaf = (noise_3(36.0 * spot.model, 32) - 0.5) * spot.shown(0.028);
        let cells = TUFTS * turned(spot.model);
        let first = (cells - 0.5).floor();
        let mut highest: f64 = 0.0;
        for index in 0..8 {
            let corner = [index & 1, index >> 1 & 1, index >> 2 & 1].map(f64::from);
            let cell = first + DVec3::from(corner);
            let place = place_in(33, cell);
            let middle = cell + 0.2 + 0.6 * place;
            if middle.distance_squared(cells) > 0.85 {
                continue;
            }
            let own = place.dot(DVec3::new(13.0, 7.0, 5.0)).fract();
            // Tufts grow smaller toward the border instead of being cut there.
            let radius = 0.7 * smooth_step(grown - 0.7 * own, 0.3, 0.4);
            if radius < 0.1 {
                continue;
            }
            let share = middle.distance(cells) / radius - 0.8 * leaf;
            let edge = spot.edge((1.0 - share) * radius / TUFTS);
            let dome = 0.2 + 0.8 * (1.0 - share * share).max(0.0).sqrt();
            highest = highest.max(edge * dome * (0.6 + 0.4 * own));
        }
        highest * (0.9 + 1.1 * leaf) * (6.0 * spot.fall).min(1.0)
    }
}

/// A rosette of lichen.
struct Rosette {
    middle: DVec2,
    radius: f64,
    offset: DVec2,
}

impl Rosette {
    fn strength(&self, spot: &Spot, granules: f64) -> f64 {
        let own = spot.q - self.middle;
        let away = own.length();
        if away > 1.15 * self.radius + spot.texel {
            return 0.0;
        }
        let toward = own / away.max(1e-9);
        let size = (self.radius / 0.4).sqrt();
        let lobes =
            0.66 * noise_2(2.4 * size * toward + self.offset, 1) + 0.34 * noise_2(4.6 * size * toward + self.offset, 2);
        let border = self.radius * (0.62 + 0.66 * lobes) + 0.03 * self.radius * (granules - 0.5);
        let inside = border - away;
        let t = (away / border.max(1e-6)).min(1.0);
        // Lobes are split from the rim inward.
        let split = smooth_step(
            noise_2(6.0 * size * toward + self.offset, 3) + 0.8 * (1.0 - t),
            0.41,
            0.07,
        );
        let rim = smooth_step(t, 0.8, 0.13) * (0.55 + 0.9 * granules).min(1.0);
        let crust = smooth_step(granules, 0.6 - 0.26 * t, 0.22) * (0.2 + 0.5 * t);
        spot.edge(inside) * crust.max(rim * split)
    }
}

/// Rosettes of lichen: pale, lobed rims around a crumbling middle.
pub(super) fn lichen(seeds: [u32; 2]) -> impl Fn(&Spot) -> f64 {
    let mut dice = RandomSequence::new(seeds);
    let grain = dice.offset();
    let rosettes: [Rosette; ROSETTES] = std::array::from_fn(|index| {
        let radius = [0.46, 0.3, 0.24, 0.17, 0.13, 0.1, 0.075, 0.06][index] * dice.between(0.8, 1.15);
        let away = (0.95 - 1.15 * radius) * if index == 0 { 0.5 } else { 1.0 } * dice.between(0.55, 1.0);
        Rosette {
            middle: away * dice.direction(),
            radius,
            offset: dice.offset(),
        }
    });
    move |spot| {
        let place = spot.q + grain;
        let fine = noise_2(47.0 * place, 5) - 0.5;
        let granules = 0.5 * noise_2(23.0 * place, 4) + 0.5 * (0.5 + 1.4 * fine * spot.shown(0.022));
        let strengths = rosettes.iter().map(|rosette| rosette.strength(spot, granules));
        strengths.fold(0.0, f64::max) * spot.fall
    }
}
