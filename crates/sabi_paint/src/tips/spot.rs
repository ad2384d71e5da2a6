//! A place that a tip is asked for.

use glam::{DVec2, DVec3};

use super::noise::smooth_step;

/// A place within a stamp. Lengths are shares of the stamp's radius.
#[derive(Clone, Copy)]
pub(crate) struct Spot {
    /// Offset from the middle of the stamp, x along the tip.
    pub(crate) q: DVec2,
    /// Position in the model divided by the radius of the brush at full pressure.
    pub(crate) model: DVec3,
    /// Unit normal of the surface.
    pub(crate) normal: DVec3,
    /// Grain of the model there ([`crate::tips::Tip::grain`]); 0 for tips without one.
    pub(crate) grain: f64,
    /// Width of a texel, above 0.
    pub(crate) texel: f64,
    /// Strength that the hardness of the brush leaves here, 0 at the border to 1.
    pub(crate) fall: f64,
}

/// Share of a detail of this width that texels can show, 1 for a wide one.
pub(super) fn shown(width: f64, texel: f64) -> f64 {
    (2.0 - 2.0 * texel / width).clamp(0.0, 1.0)
}

impl Spot {
    /// Covered share of the texel in a shape whose border is `inside` away, below 0 for a place outside of it.
    pub(super) fn edge(&self, inside: f64) -> f64 {
        (inside / self.texel + 0.5).clamp(0.0, 1.0)
    }

    /// Covered share of the texel at a distance from the middle of a line that is `half` wide to each side. A line thinner than
    /// a texel becomes faint instead.
    pub(super) fn line(&self, distance: f64, half: f64) -> f64 {
        let wide = half.max(0.5 * self.texel);
        self.edge(wide - distance) * (half / wide)
    }

    /// Covered share of the texel at a distance from the middle of a disk; a disk smaller than a texel becomes faint.
    pub(super) fn disk(&self, distance: f64, radius: f64) -> f64 {
        let wide = radius.max(0.5 * self.texel);
        self.edge(wide - distance) * (radius / wide) * (radius / wide)
    }

    /// Share of a detail of this width that texels can show, 1 for a wide one.
    pub(super) fn shown(&self, width: f64) -> f64 {
        shown(width, self.texel)
    }

    /// Grain above a threshold that rises from `middle` to `border` as the brush fades, so that the border crumbles instead of
    /// growing faint. `grain` is the width of the finest grains.
    pub(super) fn crumbled(&self, value: f64, [middle, border]: [f64; 2], half: f64, grain: f64) -> f64 {
        let threshold = border + (middle - border) * self.fall;
        let half = half + 0.2 * self.texel / grain;
        smooth_step(value, threshold, half) * (6.0 * self.fall).min(1.0)
    }
}
