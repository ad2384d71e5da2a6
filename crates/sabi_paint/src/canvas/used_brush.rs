//! A brush as it is used on a stroke.

use std::sync::Arc;

use glam::DAffine3;

use super::sight::Watched;
use super::strengths::Kept;
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
    /// The stencil before a copy of the stroke.
    pub(super) fn moved(&self, moved: &DAffine3) -> UsedStencil {
        UsedStencil {
            stencil: self.stencil.moved(moved),
            picture: Arc::clone(&self.picture),
        }
    }
}

/// A brush as it is used on a stroke.
#[derive(Clone)]
pub(super) struct UsedBrush {
    pub(super) brush: Brush,
    /// Its picture, if it has one.
    pub(super) picture: Option<(Arc<StampPicture>, PicturePart)>,
    /// The stencil that it paints through, before the stroke or its copy.
    pub(super) stencil: Option<UsedStencil>,
    pub(super) watched: Option<Watched>,
    /// True on a copy of the stroke in a mirror.
    pub(super) is_mirrored: bool,
    pub(super) kept: Kept,
}

impl UsedBrush {
    /// True if a stroke is not the same at all places of an area that it fills.
    pub(super) fn has_limits(&self) -> bool {
        self.stencil.is_some() || self.watched.is_some() || self.brush.limits.angle_degrees < 180.0
    }

    /// The brush of a stroke on one of its copies.
    pub(super) fn on(&self, copy: &LocatedStroke) -> UsedBrush {
        UsedBrush {
            watched: Watched::of(copy.eye, self.brush.limits),
            stencil: self.stencil.as_ref().map(|stencil| stencil.moved(&copy.moved)),
            is_mirrored: copy.is_mirrored,
            ..self.clone()
        }
    }

    /// True if its strokes are drawn as lines without single stamps.
    pub(super) fn draws_line(&self) -> bool {
        let is_plain = self.brush.tip == Tip::Round && self.picture.is_none();
        is_plain && self.brush.flow >= 1.0 && self.brush.jitter == Default::default()
    }

    /// True if stamps that lie on each other add up until they cover.
    pub(super) fn builds_up(&self) -> bool {
        self.picture.is_some() || self.brush.tip.builds_up()
    }

    /// Half of the width and of the height of a stamp, in radii.
    pub(super) fn half_sides(&self) -> glam::DVec2 {
        match &self.picture {
            Some((picture, _)) => picture.half_sides(),
            None => glam::DVec2::ONE,
        }
    }

    /// Farthest that a stamp reaches, in radii.
    pub(super) fn reach(&self) -> f64 {
        match self.picture {
            Some(_) => self.half_sides().length(),
            None if self.brush.tip == Tip::Square => std::f64::consts::SQRT_2,
            None => 1.0,
        }
    }
}
