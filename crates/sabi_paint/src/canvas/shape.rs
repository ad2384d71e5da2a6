//! How strong a brush is at a place around it.

use glam::{DMat2, DVec2, DVec3};

use super::painter::UsedBrush;
use crate::brush::{Brush, Tip};
use crate::picture::Stamped;

/// Size of the grain of chalk, as a share of the radius.
const GRAIN: f64 = 0.16;
/// Hairs across the brush.
const HAIRS: f64 = 22.0;
/// Drops of a stamp of splatter.
const DROPS: u32 = 18;
/// Cells of the dots of spray along a radius.
const DOTS: f64 = 14.0;

/// A place that is asked for.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// In the plane of the patch, from the start of the way.
    pub(super) plane: DVec2,
    /// Height over the plane.
    pub(super) rise: f64,
    /// In space, model units.
    pub(super) position: DVec3,
    /// Width of texels there, model units.
    pub(super) texel: f64,
}

/// A round brush on its way from one place to the next, or a stamp of any brush.
pub(super) enum Shape {
    /// The way of a round brush.
    Capsule {
        /// End in the plane; the start is the origin.
        end: DVec2,
        radii: [f64; 2],
        strengths: [f64; 2],
    },
    /// A single stamp.
    Stamp {
        /// Middle in the plane.
        middle: DVec2,
        radius: f64,
        strength: f64,
        /// Turns a way from the middle so that x lies along the tip.
        tip_from_plane: DMat2,
        /// Number of the stroke, and of the stamp in it.
        seeds: [u32; 2],
    },
}

impl Shape {
    /// What is drawn at a place.
    pub(super) fn drawn(&self, place: &Place, used: &UsedBrush) -> Stamped {
        if let (
            Shape::Stamp {
                middle,
                radius,
                strength,
                tip_from_plane,
                ..
            },
            Some((picture, part)),
        ) = (self, &used.picture)
        {
            let q = *tip_from_plane * (place.plane - *middle) / *radius;
            let near = 1.0 - (place.rise.abs() / *radius).min(1.0);
            let stamped = picture.at(q / used.half_sides(), place.texel / *radius, *part);
            return Stamped {
                strength: stamped.strength * strength * near,
                color: stamped.color.or(Some(used.brush.color)),
            };
        }
        Stamped {
            strength: self.strength(place, &used.brush),
            color: None,
        }
    }

    /// Strength at a place, 0 to 1.
    fn strength(&self, place: &Place, brush: &Brush) -> f64 {
        match self {
            Shape::Capsule { end, radii, strengths } => {
                let square = end.length_squared();
                let t = if square > 0.0 {
                    (place.plane.dot(*end) / square).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let mix = |[start, end]: [f64; 2]| start + t * (end - start);
                let distance = place.plane.distance(t * *end).hypot(place.rise);
                faded(distance, mix(*radii), place.texel, brush) * mix(*strengths)
            }
            Shape::Stamp {
                middle,
                radius,
                strength,
                tip_from_plane,
                seeds,
            } => {
                let way = *tip_from_plane * (place.plane - *middle);
                let distance = match brush.tip {
                    Tip::Square => way.abs().max_element().hypot(place.rise),
                    _ => way.length().hypot(place.rise),
                };
                let faded = faded(distance, *radius, place.texel, brush);
                if faded <= 0.0 {
                    return 0.0;
                }
                let q = way / *radius;
                faded * strength * tip(q, place, *radius, *seeds, brush)
            }
        }
    }
}

/// Strength by the distance from the middle. A border that is harder than texels can show becomes one texel wide, and a brush that
/// is thinner than a texel becomes faint.
fn faded(distance: f64, radius: f64, texel: f64, brush: &Brush) -> f64 {
    let band = (1.0 - f64::from(brush.hardness)) * radius;
    let fall = if band >= texel {
        brush.falloff(distance / radius)
    } else {
        ((radius - 0.5 * band - distance) / texel + 0.5).clamp(0.0, 1.0)
    };
    if texel > 2.0 * radius {
        fall * 2.0 * radius / texel
    } else {
        fall
    }
}

/// What a tip leaves of a stamp, 0 to 1, at a place given in radii along the tip.
fn tip(q: DVec2, place: &Place, radius: f64, [stroke, stamp]: [u32; 2], brush: &Brush) -> f64 {
    let softness = (place.texel / radius).max(0.02);
    match brush.tip {
        Tip::Round | Tip::Square => 1.0,
        Tip::Chalk => {
            let grain = place.position / (GRAIN * f64::from(brush.radius));
            let value = 0.65 * grain_noise(grain, 1) + 0.35 * grain_noise(2.3 * grain, 2);
            smooth_step(value, 0.45 + 0.2 * q.length(), 0.12)
        }
        Tip::Bristles => {
            let across = HAIRS * (q.y + 1.0);
            let hair = random(stroke, [across.floor() as i32, 7, 0]);
            let round = 1.0 - (2.0 * across.fract() - 1.0).powi(2);
            // Hairs lift off and touch again along the way.
            let touch = grain_noise(place.position / (0.6 * f64::from(brush.radius)) + 9.0 * hair, 3);
            round.sqrt() * smooth_step(hair + 0.5 * touch, 0.55, 0.2)
        }
        Tip::Splatter => {
            let drop = |index: u32| {
                let number = |salt: i32| random(stroke ^ stamp.wrapping_mul(0x9e37_79b9), [index as i32, salt, 1]);
                let angle = std::f64::consts::TAU * number(1);
                let away = number(2).sqrt() * 0.85;
                let middle = away * DVec2::new(angle.cos(), angle.sin());
                let own = 0.02 + 0.2 * number(3).powi(3) * (1.0 - 0.6 * away);
                ((own - q.distance(middle)) / softness + 0.5).clamp(0.0, 1.0)
            };
            (0..DROPS).map(drop).fold(0.0, f64::max)
        }
        Tip::Spray => {
            let cells = DOTS * q;
            let cell = cells.floor();
            let number = |salt: i32| {
                let seed = stroke ^ stamp.wrapping_mul(0x85eb_ca6b);
                random(seed, [cell.x as i32, cell.y as i32, salt])
            };
            let middle = cell + 0.25 + 0.5 * DVec2::new(number(1), number(2));
            let is_there = number(3) < 0.8 * (1.0 - q.length());
            let dot = ((0.3 - cells.distance(middle)) / (DOTS * softness) + 0.5).clamp(0.0, 1.0);
            if is_there { dot } else { 0.0 }
        }
    }
}

fn smooth_step(value: f64, middle: f64, half: f64) -> f64 {
    let t = ((value - middle + half) / (2.0 * half)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A random number of a cell, 0 to 1 (PCG in three dimensions: Jarzynski and Olano, "Hash functions for GPU rendering", 2020).
pub(super) fn random(seed: u32, cell: [i32; 3]) -> f64 {
    let mut v = cell.map(|number| {
        (number as u32)
            .wrapping_add(seed)
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223)
    });
    for _ in 0..2 {
        v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[2]));
        v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
        v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
        v = v.map(|number| number ^ (number >> 16));
    }
    f64::from(v[0]) / f64::from(u32::MAX)
}

/// Noise between 0 and 1 whose grains are about 1 wide: random values on a lattice, mixed smoothly.
fn grain_noise(place: DVec3, seed: u32) -> f64 {
    let cell = place.floor();
    let t = place - cell;
    let t = t * t * (3.0 - 2.0 * t);
    let corner = |offset: u32| {
        let at = [0, 1, 2].map(|axis| cell[axis] as i32 + (offset >> axis & 1) as i32);
        let weight = [0, 1, 2].map(|axis| {
            if offset >> axis & 1 == 1 {
                t[axis]
            } else {
                1.0 - t[axis]
            }
        });
        random(seed, at) * weight.iter().product::<f64>()
    };
    (0..8).map(corner).sum()
}
