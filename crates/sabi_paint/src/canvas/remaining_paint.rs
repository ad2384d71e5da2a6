//! Share of a stroke that remains at a texel after the limits of its brush and its stencil.

use glam::DVec3;

use super::sight::Sight;
use super::texels::At;
use super::used_brush::{UsedBrush, UsedStencil};
use crate::picture::PictureEnds;
use crate::surface::PaintSurface;

/// Share and color of a stroke that remain at a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RemainingPaint {
    /// Share of the strength, 0 to 1.
    pub(super) share: f64,
    /// Linear color, if the stencil provides one.
    pub(super) color: Option<[f32; 3]>,
}

impl RemainingPaint {
    /// The full strength, in the color of the brush.
    pub(super) const ALL: RemainingPaint = RemainingPaint {
        share: 1.0,
        color: None,
    };
}

/// Returns the share and color of a stroke at a texel. `normal` is that of the surface under the middle of the stamp,
/// `count` the number of texels of the atlas.
pub(super) fn left_of(
    surface: &PaintSurface<'_>,
    sight: &mut Sight,
    texel: usize,
    count: usize,
    at: &At,
    used: &UsedBrush,
    normal: DVec3,
) -> RemainingPaint {
    let limits = used.brush.limits;
    let mut left = RemainingPaint::ALL;
    if let Some(used) = &used.stencil {
        left = used.left_at(at, surface.connected().normal(at.triangle));
    }
    if limits.angle_degrees < 180.0 && left.share > 0.0 {
        let own = surface.smooth_normal(at.triangle, at.weights);
        left.share *= limits.of_angle(own.dot(normal));
    }
    if let Some(watched) = used.watched.as_ref().filter(|_| left.share > 0.0) {
        left.share *= sight.share(surface, texel, count, at, watched);
    }
    left
}

impl UsedStencil {
    /// Returns the share and color that the stencil leaves at a texel of a surface with this normal. Outside of its picture
    /// the share is 0.
    fn left_at(&self, at: &At, normal: DVec3) -> RemainingPaint {
        let Some(behind) = self.stencil.behind(at.position) else {
            return RemainingPaint {
                share: 0.0,
                color: None,
            };
        };
        let width = behind.width(at.width, normal, self.picture.half_sides());
        let width = width.max(f64::MIN_POSITIVE);
        let seen = self
            .picture
            .at(behind.place, width, self.stencil.picture.part, PictureEnds::Cut);
        RemainingPaint {
            share: seen.strength,
            color: seen.color,
        }
    }
}
