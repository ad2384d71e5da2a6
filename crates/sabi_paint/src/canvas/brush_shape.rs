//! Strength of a brush at a place around it.

use glam::{DMat2, DVec2, DVec3};

use super::used_brush::UsedBrush;
use crate::brush::Brush;
use crate::picture::{PictureEnds, StampSample};
pub(super) use crate::tips::random;
use crate::tips::{Spot, Stamp, Tip};

/// Minimum width of a border, as a share of the radius: paint by hand is not sharper.
pub(super) const LEAST_TEXEL: f64 = 0.008;

/// A place whose strength is wanted.
#[derive(Clone, Copy)]
pub(super) struct ShapeSample {
    /// Position in the plane of the patch, relative to the start of the way.
    pub(super) plane: DVec2,
    /// Height above the plane.
    pub(super) rise: f64,
    /// Distance in space from the middle of the stamp or from the line, if the distance in the plane may be smaller; otherwise 0.
    pub(super) apart: f64,
    /// Position in space in model units.
    pub(super) position: DVec3,
    /// Grain of the model for the tip.
    pub(super) grain: f64,
    /// Unit normal of the triangle there.
    pub(super) normal: DVec3,
    /// Width of texels there, model units.
    pub(super) texel: f64,
}

/// A round brush on its way from one point to the next, or a stamp of any brush.
pub(super) enum BrushShape {
    /// A round brush on its way.
    Capsule {
        /// End in the plane; the start is the origin.
        end: DVec2,
        radii: [f64; 2],
        strengths: [f64; 2],
        hardnesses: [f64; 2],
    },
    /// A single stamp.
    Stamp {
        /// Middle in the plane.
        middle: DVec2,
        radius: f64,
        strength: f64,
        hardness: f64,
        /// Rotates an offset from the middle so that x is along the tip.
        tip_from_plane: DMat2,
        stamp: Stamp,
    },
}

impl BrushShape {
    /// Returns the greatest strength anywhere.
    pub(super) fn most(&self) -> f64 {
        match self {
            BrushShape::Capsule { strengths, .. } => strengths[0].max(strengths[1]),
            BrushShape::Stamp { strength, .. } => *strength,
        }
    }

    /// Returns strength and color at a place.
    pub(super) fn drawn(&self, place: &ShapeSample, used: &UsedBrush) -> StampSample {
        if let (
            BrushShape::Stamp {
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
            let near = near * ((used.reach() * radius - place.apart) / place.texel + 0.5).clamp(0.0, 1.0);
            let stamped = picture.at(q / used.half_sides(), place.texel / *radius, *part, PictureEnds::Cut);
            return StampSample {
                strength: stamped.strength * strength * near,
                color: stamped.color.or(Some(used.brush.color)),
            };
        }
        StampSample {
            strength: self.strength(place, &used.brush),
            color: None,
        }
    }

    /// Returns the strength at a place, 0 to 1.
    fn strength(&self, place: &ShapeSample, brush: &Brush) -> f64 {
        match self {
            BrushShape::Capsule {
                end,
                radii,
                strengths,
                hardnesses,
            } => {
                let square = end.length_squared();
                let t = if square > 0.0 {
                    (place.plane.dot(*end) / square).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let mix = |[start, end]: [f64; 2]| start + t * (end - start);
                let distance = beside(place.plane.distance_squared(t * *end), place.rise).max(place.apart);
                faded(distance, mix(*radii), place.texel, brush, mix(*hardnesses)) * mix(*strengths)
            }
            BrushShape::Stamp {
                middle,
                radius,
                strength,
                hardness,
                tip_from_plane,
                stamp,
            } => {
                let way = *tip_from_plane * (place.plane - *middle);
                let to_middle = match brush.tip {
                    Tip::Square => beside(way.abs().max_element().powi(2), place.rise),
                    _ => beside(way.length_squared(), place.rise),
                };
                let distance = to_middle.max(place.apart);
                let fall = faded(distance, *radius, place.texel, brush, *hardness);
                let spot = Spot {
                    q: way / *radius,
                    model: place.position / f64::from(brush.radius),
                    normal: place.normal,
                    grain: place.grain,
                    texel: (place.texel / *radius).max(LEAST_TEXEL),
                    fall,
                };
                strength * stamp.strength(&spot)
            }
        }
    }
}

/// Returns the distance, given the square of the distance in the plane and the height above the plane. Square roots give
/// the same bits on every machine, unlike `hypot`.
fn beside(square: f64, rise: f64) -> f64 {
    (square + rise * rise).sqrt()
}

/// Returns the strength at a distance from the middle. A border that is sharper than texels can show becomes one texel
/// wide, and a brush that is thinner than a texel becomes faint.
pub(super) fn faded(distance: f64, radius: f64, texel: f64, brush: &Brush, hardness: f64) -> f64 {
    let band = (1.0 - hardness) * radius;
    let fall = if band >= texel {
        let fall = brush.falloff_of(distance / radius, hardness);
        if brush.fade.is_cut() {
            fall * ((radius - distance) / texel).clamp(0.0, 1.0)
        } else {
            fall
        }
    } else {
        ((radius - 0.5 * band - distance) / texel + 0.5).clamp(0.0, 1.0)
    };
    if texel > 2.0 * radius {
        fall * 2.0 * radius / texel
    } else {
        fall
    }
}

/// Returns the grain of the model for the tip of a brush, at a place with texels of this width; 0 for tips without grain.
pub(super) fn grain_at(brush: &Brush, position: DVec3, width: f64) -> f64 {
    let radius = f64::from(brush.radius);
    let of = |grain: fn(DVec3, f64) -> f64| grain(position / radius, (width / radius).max(LEAST_TEXEL));
    brush.tip.grain().map_or(0.0, of) // Other tips do not use the grain.
}
