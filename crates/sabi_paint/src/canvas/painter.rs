//! Painting of strokes on a canvas.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use sabi_surface::Groups;
use sabi_surface::atlas::Atlas;

use super::Canvas;
use super::outlines::for_outline;
use super::patches::Patches;
use super::sight::Sight;
use super::similar::similar_texels;
use super::strengths::{KeptValues, LaidStroke, Strengths};
use super::texels::{SurfaceTexels, ghosts_of_triangles};
use super::used_brush::{UsedBrush, UsedStencil};
use crate::brush::Brush;
use crate::picture::PicturePart;
use crate::site::{LocatedStroke, copies, passed};
use crate::stencil::Stencil;
use crate::stroke::{Area, Stroke, StrokePoint};
use crate::supplies::Supplies;
use crate::surface::PaintSurface;
use crate::way::{WayPoint, way_of};

/// Maximum length of a part of a way, as a share of the brush's radius. A part is a straight line on the unfolded surface.
const PART: f64 = 0.5;

/// Paints strokes on canvases of one atlas.
pub struct Painter<'a> {
    pub(super) surface: &'a PaintSurface<'a>,
    pub(super) atlas: &'a Atlas,
    pub(super) supplies: Supplies<'a>,
    pub(super) ghosts: Groups,
    pub(super) patches: Patches<'a>,
    pub(super) strengths: Strengths,
    pub(super) sight: Sight,
}

impl<'a> Painter<'a> {
    /// Creates a painter for an atlas of a surface.
    pub fn new(surface: &'a PaintSurface<'a>, atlas: &'a Atlas, supplies: Supplies<'a>) -> Painter<'a> {
        Painter {
            ghosts: ghosts_of_triangles(atlas),
            patches: Patches::new(surface, atlas),
            strengths: Strengths::new(atlas.owners.len()),
            sight: Sight::default(),
            supplies,
            surface,
            atlas,
        }
    }

    /// Paints a stroke on a canvas with its own strength, ignoring the opacity of its group. Returns the number of its
    /// points that the model no longer has.
    pub fn paint(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        if stroke.changes_paint() {
            return self.adjust(canvas, stroke);
        }
        if stroke.area == Area::Similar {
            return self.fill_similar(canvas, stroke);
        }
        let laid = self.lay(stroke, canvas.layers().direction);
        laid.onto(canvas, stroke);
        laid.lost
    }

    /// Returns the paint of a stroke that does not depend on existing paint. With `keeps_direction`, it includes directions.
    pub fn lay(&mut self, stroke: &Stroke, keeps_direction: bool) -> LaidStroke {
        let (points, lost) = passed(self.surface, stroke);
        let mut kept = KeptValues {
            directions: keeps_direction,
            colors: false,
        };
        if let Some(used) = self.used(stroke, kept).filter(|_| !points.is_empty()) {
            kept = used.kept;
            self.begin(kept);
            for copy in self.with_copies(points, None, stroke, &used.brush) {
                self.sight.clear();
                self.draw(&copy, stroke.area, &used.on(&copy));
            }
        }
        self.laid(stroke, kept, lost)
    }

    /// Ends a stroke, and returns its paint.
    pub(super) fn laid(&mut self, stroke: &Stroke, kept: KeptValues, lost: usize) -> LaidStroke {
        let mut laid = self.strengths.take(kept, lost);
        if let Some(input) = self.supplies.input.filter(|_| stroke.copies_in_place()) {
            laid.copy(input);
        }
        laid
    }

    /// Prepares for a stroke for which these values are kept.
    pub(super) fn begin(&mut self, kept: KeptValues) {
        self.strengths.prepare(kept);
        self.strengths.forget_grains();
        self.sight.clear();
    }

    /// Returns the brush of a stroke; `None` if the stroke leaves nothing, since it is hidden, or since its picture or the
    /// result that it copies is missing.
    pub(super) fn used(&self, stroke: &Stroke, kept: KeptValues) -> Option<UsedBrush> {
        let brush = stroke.brush.bounded();
        let picture = match &brush.picture {
            Some(tip) => Some((Arc::clone(self.supplies.pictures.get(&tip.picture)?), tip.part)),
            None => None,
        };
        let stencil = match &stroke.stencil {
            Some(stencil) => Some(UsedStencil {
                picture: Arc::clone(self.supplies.pictures.get(&stencil.picture.picture)?),
                stencil: Stencil::clone(stencil),
            }),
            None => None,
        };
        let is_colored = stroke
            .stencil
            .as_ref()
            .is_some_and(|stencil| stencil.picture.part == PicturePart::Colors);
        if stroke.copies_in_place() && self.supplies.input.is_none() {
            return None;
        }
        let kept = KeptValues {
            // Areas are filled with the color of the brush, since no picture is stamped on them.
            colors: is_colored
                || (matches!(picture, Some((_, PicturePart::Colors)))
                    || (stroke.area == Area::Way && brush.jitter.changes_color()))
                    && (matches!(stroke.area, Area::Way | Area::Ribbon) || stroke.area.is_single()),
            ..kept
        };
        (!stroke.leaves_nothing()).then_some(UsedBrush {
            watched: None,
            is_mirrored: false,
            stencil,
            brush,
            picture,
            kept,
        })
    }

    /// Returns a stroke and its copies on other sides of the model.
    pub(super) fn with_copies(
        &self,
        points: Vec<StrokePoint>,
        source: Option<StrokePoint>,
        stroke: &Stroke,
        brush: &Brush,
    ) -> Vec<LocatedStroke> {
        let own = LocatedStroke {
            points,
            eye: stroke.eye,
            source,
            moved: DAffine3::IDENTITY,
            is_mirrored: false,
        };
        let others = copies(self.surface, &own, brush.symmetry, f64::from(brush.radius));
        std::iter::once(own).chain(others).collect()
    }

    fn draw(&mut self, stroke: &LocatedStroke, area: Area, used: &UsedBrush) {
        let points = stroke.points.as_slice();
        match area {
            Area::Way | Area::Ribbon | Area::Decal | Area::Label => {}
            Area::Inside => return self.draw_inside(stroke, used),
            _ => return self.fill(points, area, used),
        }
        if area.is_single() {
            return self.draw_single(stroke, area, used);
        }
        let way = self.way_of(points, &used.brush);
        if area == Area::Ribbon {
            return self.draw_ribbon(&way, used);
        }
        self.draw_way(way, used);
    }

    /// Fills the areas around the points of a stroke that have similar paint. Returns the number of points that the model no longer has.
    fn fill_similar(&mut self, canvas: &mut Canvas, stroke: &Stroke) -> usize {
        let (points, lost) = passed(self.surface, stroke);
        let mut kept = KeptValues {
            directions: false,
            colors: false,
        };
        if let Some(used) = self.used(stroke, kept).filter(|_| !points.is_empty()) {
            kept = used.kept;
            self.strengths.prepare(kept);
            for copy in self.with_copies(points, None, stroke, &used.brush) {
                self.sight.clear();
                let texels = similar_texels(self.surface, self.atlas, canvas, &copy.points, used.brush.tolerance);
                self.fill_texels(&copy.points, &texels, &used.on(&copy));
            }
        }
        let laid = self.strengths.take(kept, lost);
        laid.onto(canvas, stroke);
        lost
    }

    /// Fills the area inside of the way of a stroke.
    fn draw_inside(&mut self, stroke: &LocatedStroke, used: &UsedBrush) {
        let mut filler = self.filler(&stroke.points, used);
        for_outline(filler.texels, &stroke.points, stroke.eye, |texel, cover, at| {
            filler.add(texel, cover, Some(at));
        });
    }

    /// The surface with its texels and their ghosts.
    pub(super) fn texels(&self) -> SurfaceTexels<'_> {
        SurfaceTexels {
            surface: self.surface,
            atlas: self.atlas,
            ghosts: &self.ghosts,
        }
    }

    pub(super) fn way_of(&self, points: &[StrokePoint], brush: &Brush) -> Vec<WayPoint> {
        way_of(self.surface, points, PART * f64::from(brush.radius))
    }
}

/// Returns the unit direction in model space from one point to another; zero if they are the same.
pub(super) fn direction(from: &WayPoint, to: &WayPoint) -> DVec3 {
    (to.site.position - from.site.position).normalize_or_zero()
}
