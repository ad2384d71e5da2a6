//! Lays strokes on a canvas.

use std::sync::Arc;

use glam::DVec3;
use sabi_surface::Groups;
use sabi_surface::atlas::Atlas;

use super::Canvas;
use super::fills::{for_gradient, for_texels_of, similar_texels};
use super::outlines::for_outline;
use super::patches::Patches;
use super::sight::{Sight, Watched};
use super::strengths::{Added, Kept, LaidStroke, Strengths};
use super::texels::ghosts_of_triangles;
use crate::brush::Brush;
use crate::picture::{PicturePart, StampPicture, StampPictures};
use crate::site::{LocatedStroke, copies, passed};
use crate::stroke::{Area, Stroke, StrokePoint};
use crate::surface::PaintSurface;
use crate::tips::Tip;
use crate::way::{WayPoint, way_of};

/// Longest part of a way, as a share of the brush's radius: a part is a straight line on the unfolded surface.
const PART: f64 = 0.5;

/// Lays strokes on canvases of one atlas.
pub struct Painter<'a> {
    pub(super) surface: &'a PaintSurface<'a>,
    pub(super) atlas: &'a Atlas,
    pictures: &'a StampPictures,
    pub(super) ghosts: Groups,
    pub(super) patches: Patches<'a>,
    pub(super) strengths: Strengths,
    pub(super) sight: Sight,
}

/// A brush as it is used on a stroke.
pub(super) struct UsedBrush {
    pub(super) brush: Brush,
    /// Its picture, if it has one.
    pub(super) picture: Option<(Arc<StampPicture>, PicturePart)>,
    pub(super) watched: Option<Watched>,
    /// True on a copy of the stroke in a mirror.
    pub(super) is_mirrored: bool,
    pub(super) kept: Kept,
}

impl UsedBrush {
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

impl<'a> Painter<'a> {
    /// Prepares for an atlas of a surface. Strokes whose picture is not among `pictures` leave nothing.
    pub fn new(surface: &'a PaintSurface<'a>, atlas: &'a Atlas, pictures: &'a StampPictures) -> Painter<'a> {
        Painter {
            ghosts: ghosts_of_triangles(atlas),
            patches: Patches::new(surface, atlas),
            strengths: Strengths::new(atlas.owners.len()),
            sight: Sight::default(),
            pictures,
            surface,
            atlas,
        }
    }

    /// Lays a stroke on a canvas, and returns how many of its places the model does not have any more.
    pub fn paint(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        if stroke.action.adjusts() {
            return self.adjust(canvas, stroke);
        }
        if stroke.area == Area::Similar {
            return self.fill_similar(canvas, stroke);
        }
        let laid = self.lay(stroke, canvas.layers().direction);
        laid.onto(canvas, stroke);
        laid.lost
    }

    /// Paint of a stroke that does not depend on the paint below, with its directions if they are kept.
    pub fn lay(&mut self, stroke: &Stroke, keeps_direction: bool) -> LaidStroke {
        let (points, lost) = passed(self.surface, stroke);
        let mut kept = Kept {
            directions: keeps_direction,
            colors: false,
        };
        if let Some(mut used) = self.used(stroke, kept).filter(|_| !points.is_empty()) {
            kept = used.kept;
            self.strengths.prepare(kept);
            self.strengths.forget_grains();
            for copy in self.with_copies((points, None), stroke, &used.brush) {
                used.watched = Watched::of(copy.eye, used.brush.limits);
                used.is_mirrored = copy.is_mirrored;
                self.sight.clear();
                self.draw(&copy, stroke.area, &used);
            }
        }
        self.strengths.take(kept, lost)
    }

    /// The brush of a stroke; none if the stroke leaves nothing, since it is hidden or lacks its picture.
    pub(super) fn used(&self, stroke: &Stroke, kept: Kept) -> Option<UsedBrush> {
        let brush = Brush {
            opacity: stroke.opacity(),
            ..stroke.brush.bounded()
        };
        let picture = match &brush.picture {
            Some(tip) => Some((Arc::clone(self.pictures.get(&tip.picture)?), tip.part)),
            None => None,
        };
        let kept = Kept {
            // Areas are filled with the color of the brush, since no picture is stamped there.
            colors: (matches!(picture, Some((_, PicturePart::Colors)))
                || (stroke.area == Area::Way && brush.jitter.changes_color()))
                && (matches!(stroke.area, Area::Way | Area::Ribbon) || stroke.area.is_single()),
            ..kept
        };
        (!stroke.leaves_nothing()).then_some(UsedBrush {
            watched: None,
            is_mirrored: false,
            brush,
            picture,
            kept,
        })
    }

    /// A stroke with its copies on other sides of the model.
    pub(super) fn with_copies(
        &self,
        (points, source): (Vec<StrokePoint>, Option<StrokePoint>),
        stroke: &Stroke,
        brush: &Brush,
    ) -> Vec<LocatedStroke> {
        let own = LocatedStroke {
            points,
            eye: stroke.eye,
            source,
            is_mirrored: false,
        };
        let others = copies(self.surface, &own, brush.symmetry, f64::from(brush.radius));
        std::iter::once(own).chain(others).collect()
    }

    fn draw(&mut self, stroke: &LocatedStroke, area: Area, used: &UsedBrush) {
        let points = stroke.points.as_slice();
        let (surface, atlas, ghosts) = (self.surface, self.atlas, &self.ghosts);
        let side_degrees = used.brush.side_degrees;
        let strengths = &mut self.strengths;
        let mut fill = |texel: usize, drawn: f64| {
            strengths.add(texel, &Added::at_most(drawn));
        };
        match area {
            Area::Way | Area::Ribbon | Area::Decal | Area::Label => {}
            Area::Inside => return self.draw_inside(stroke, used),
            Area::Gradient => return for_gradient((surface, atlas, ghosts), points, fill),
            _ => return for_texels_of(surface, atlas, points, (area, side_degrees), |texel| fill(texel, 1.0)),
        }
        if area.is_single() {
            return self.draw_single(points, area, used);
        }
        let way = self.way_of(points, &used.brush);
        if area == Area::Ribbon {
            return self.draw_ribbon(&way, used);
        }
        let brush = &used.brush;
        let is_round = brush.tip == Tip::Round && used.picture.is_none();
        if brush.flow >= 1.0 && is_round && brush.jitter == Default::default() {
            self.draw_line(&way, used);
        } else {
            self.draw_stamps(&way, used);
        }
    }

    /// Fills the areas around the places of a stroke that are painted as they are; returns how many of them are lost.
    fn fill_similar(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        let (points, lost) = passed(self.surface, stroke);
        let kept = Kept {
            directions: false,
            colors: false,
        };
        if let Some(used) = self.used(stroke, kept).filter(|_| !points.is_empty()) {
            self.strengths.prepare(kept);
            let place = (self.surface, self.atlas);
            for copy in self.with_copies((points, None), stroke, &used.brush) {
                for texel in similar_texels(place, canvas, &copy.points, used.brush.tolerance) {
                    self.strengths.add(texel, &Added::at_most(1.0));
                }
            }
        }
        let laid = self.strengths.take(kept, lost);
        laid.onto(canvas, stroke);
        lost
    }

    /// Fills what lies inside of the way of a stroke.
    fn draw_inside(&mut self, stroke: &LocatedStroke, used: &UsedBrush) {
        let (surface, atlas, ghosts) = (self.surface, self.atlas, &self.ghosts);
        let (strengths, sight) = (&mut self.strengths, &mut self.sight);
        let count = strengths.texel_count();
        let outline = (stroke.points.as_slice(), stroke.eye);
        for_outline((surface, atlas, ghosts), outline, |texel, cover, at| {
            let share = match &used.watched {
                Some(watched) if cover > 0.0 => sight.share(surface, (texel, count), at, watched),
                _ => 1.0,
            };
            strengths.add(texel, &Added::at_most(cover * share));
        });
    }

    pub(super) fn way_of(&self, points: &[StrokePoint], brush: &Brush) -> Vec<WayPoint> {
        way_of(self.surface, points, PART * f64::from(brush.radius))
    }
}

/// Unit direction in model space from one place to another; zero for one place.
pub(super) fn direction(from: &WayPoint, to: &WayPoint) -> DVec3 {
    (to.site.position - from.site.position).normalize_or_zero()
}
