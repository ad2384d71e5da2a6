//! The stencil, as it is kept between runs.

use std::ops::RangeInclusive;

use sabi_paint::PictureTip;
use serde::{Deserialize, Serialize};

/// Limits of the size of a stencil: half of its longer side, in halves of the height of the view.
pub(crate) const SIZES: RangeInclusive<f32> = 0.02..=10.0;
/// Limits of the place of its middle, in halves of the height of the view.
const PLACES: RangeInclusive<f32> = -20.0..=20.0;

/// Picture over the view, through which strokes are painted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct StencilChoices {
    /// True while strokes are painted through it.
    pub(crate) is_used: bool,
    pub(crate) picture: Option<PictureTip>,
    /// Place of its middle from that of the view, to the right and up, in halves of the height of the view.
    pub(crate) middle: [f32; 2],
    /// Half of its longer side, in the same measure.
    pub(crate) size: f32,
    /// Turn, counter-clockwise.
    pub(crate) angle_degrees: f32,
}

impl Default for StencilChoices {
    fn default() -> StencilChoices {
        StencilChoices {
            is_used: false,
            picture: None,
            middle: [0.0; 2],
            size: 0.6,
            angle_degrees: 0.0,
        }
    }
}

impl StencilChoices {
    /// The stencil with another picture, over the middle of the view.
    pub(crate) fn with_picture(picture: PictureTip) -> StencilChoices {
        StencilChoices {
            is_used: true,
            picture: Some(picture),
            ..StencilChoices::default()
        }
    }

    /// The stencil in the middle of the view again, upright.
    pub(crate) fn centered(&self) -> StencilChoices {
        StencilChoices {
            is_used: self.is_used,
            picture: self.picture.clone(),
            ..StencilChoices::default()
        }
    }

    /// The stencil with every number in its limits, whatever a file holds.
    pub(crate) fn sanitized(self) -> StencilChoices {
        let usual = StencilChoices::default();
        let within = |value: f32, usual: f32, limits: RangeInclusive<f32>| match value.is_finite() {
            true => value.clamp(*limits.start(), *limits.end()),
            false => usual,
        };
        StencilChoices {
            middle: self.middle.map(|place| within(place, 0.0, PLACES)),
            size: within(self.size, usual.size, SIZES),
            angle_degrees: within(self.angle_degrees, 0.0, -180.0..=180.0),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stencil_of_a_damaged_file_has_every_number_in_its_limits() {
        let odd = StencilChoices {
            middle: [f32::NAN, 1e9],
            size: 0.0,
            angle_degrees: 900.0,
            ..StencilChoices::default()
        };
        let sane = odd.sanitized();
        assert_eq!(
            (sane.middle, sane.size, sane.angle_degrees),
            ([0.0, *PLACES.end()], *SIZES.start(), 180.0)
        );
    }
}
