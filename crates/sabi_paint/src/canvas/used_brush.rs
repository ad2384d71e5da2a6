//! Brushes with the pictures and stencils that a stroke uses.

use std::sync::Arc;

use glam::DAffine3;

use super::sight::EyeLimits;
use super::strengths::KeptValues;
use crate::brush::Brush;
use crate::picture::{PicturePart, StampPicture};
use crate::site::LocatedStroke;
use crate::stencil::Stencil;
use crate::tips::Tip;

/// A stencil with its picture.
#[derive(Clone)]
pub(super) struct UsedStencil {
    pub(super) stencil: Stencil,
    pub(super) picture: Arc<StampPicture>,
}

impl UsedStencil {
    /// Returns the stencil for a copy of the stroke.
    pub(super) fn moved(&self, moved: &DAffine3) -> UsedStencil {
        UsedStencil {
            stencil: self.stencil.moved(moved),
            picture: Arc::clone(&self.picture),
        }
    }
}

/// A brush with everything that a stroke uses.
#[derive(Clone)]
pub(super) struct UsedBrush {
    pub(super) brush: Brush,
    /// Its picture, if it has one.
    pub(super) picture: Option<(Arc<StampPicture>, PicturePart)>,
    /// The stencil through which it paints, moved for a copy of the stroke.
    pub(super) stencil: Option<UsedStencil>,
    pub(super) watched: Option<EyeLimits>,
    /// True for a mirrored copy of the stroke.
    pub(super) is_mirrored: bool,
    pub(super) kept: KeptValues,
}

impl UsedBrush {
    /// Returns true if a stroke may have different strengths at the places of an area that it fills.
    pub(super) fn has_limits(&self) -> bool {
        self.stencil.is_some() || self.watched.is_some() || self.brush.limits.angle_degrees < 180.0
    }

    /// Returns the brush for one of the copies of a stroke.
    pub(super) fn on(&self, copy: &LocatedStroke) -> UsedBrush {
        UsedBrush {
            watched: EyeLimits::of(copy.eye, self.brush.limits),
            stencil: self.stencil.as_ref().map(|stencil| stencil.moved(&copy.moved)),
            is_mirrored: copy.is_mirrored,
            ..self.clone()
        }
    }

    /// Returns true if strokes are drawn as lines without separate stamps.
    pub(super) fn draws_line(&self) -> bool {
        let is_plain = self.brush.tip == Tip::Round && self.picture.is_none();
        is_plain && self.brush.flow >= 1.0 && self.brush.jitter == Default::default()
    }

    /// Returns true if overlapping stamps add up until they cover fully.
    pub(super) fn builds_up(&self) -> bool {
        self.picture.is_some() || self.brush.tip.builds_up()
    }

    /// Returns half of the width and of the height of a stamp in radii.
    pub(super) fn half_sides(&self) -> glam::DVec2 {
        match &self.picture {
            Some((picture, _)) => picture.half_sides(),
            None => glam::DVec2::ONE,
        }
    }

    /// Returns the largest distance from its middle that a stamp covers, in radii.
    pub(super) fn reach(&self) -> f64 {
        match self.picture {
            Some(_) => self.half_sides().length(),
            None if self.brush.tip == Tip::Square => std::f64::consts::SQRT_2,
            None => 1.0,
        }
    }
}
