//! Areas that a stroke fills.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use sabi_surface::NO_TWIN;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};
use sabi_surface::patch::PlacedTriangle;

use super::painter::Painter;
use super::remaining_paint::{RemainingPaint, left_of};
use super::sight::Sight;
use super::strengths::{AddedPaint, Strengths};
use super::texels::{At, SurfaceTexels, for_texels};
use super::used_brush::UsedBrush;
use crate::stroke::{Area, StrokePoint};
use crate::surface::PaintSurface;

/// Fill of texels by a stroke.
pub(super) struct Filler<'a> {
    pub(super) texels: SurfaceTexels<'a>,
    strengths: &'a mut Strengths,
    sight: &'a mut Sight,
    used: &'a UsedBrush,
    /// Normal of the surface at the first point of the stroke.
    normal: DVec3,
}

impl Filler<'_> {
    /// Fills a texel with a strength. Without its position, the limits of the brush are not applied.
    pub(super) fn add(&mut self, texel: usize, strength: f64, at: Option<&At>) {
        let count = self.strengths.texel_count();
        let left = match at.filter(|_| strength > 0.0) {
            Some(at) => {
                let surface = self.texels.surface;
                left_of(surface, self.sight, texel, count, at, self.used, self.normal)
            }
            None => RemainingPaint::ALL,
        };
        let added = AddedPaint {
            color: left.color.filter(|_| self.used.kept.colors),
            ..AddedPaint::at_most(strength * left.share)
        };
        self.strengths.add(texel, &added);
    }
}

impl<'a> Painter<'a> {
    /// Prepares to fill an area around the points of a stroke.
    pub(super) fn filler<'b>(&'b mut self, points: &[StrokePoint], used: &'b UsedBrush) -> Filler<'b> {
        let normal = points.first().map_or(DVec3::Y, |first| self.normal_under(first.site)); // Without points nothing is filled.
        Filler {
            texels: SurfaceTexels {
                surface: self.surface,
                atlas: self.atlas,
                ghosts: &self.ghosts,
            },
            strengths: &mut self.strengths,
            sight: &mut self.sight,
            used,
            normal,
        }
    }

    /// Fills the area that the points touch.
    pub(super) fn fill(&mut self, points: &[StrokePoint], area: Area, used: &UsedBrush) {
        let (surface, atlas) = (self.surface, self.atlas);
        let filled = triangles(surface, atlas, points, area, used.brush.side_degrees);
        let mut filler = self.filler(points, used);
        if area == Area::Gradient {
            let gradient = FillGradient::new(points);
            for_places(filler.texels, &filled, |texel, at| {
                filler.add(texel, gradient.at(at.position), Some(at));
            });
        } else if used.has_limits() {
            for_places(filler.texels, &filled, |texel, at| filler.add(texel, 1.0, Some(at)));
        } else {
            for_texels_of(atlas, &filled, |texel| filler.add(texel, 1.0, None));
        }
    }

    /// Fills some texels around the points of a stroke.
    pub(super) fn fill_texels(&mut self, points: &[StrokePoint], texels: &[usize], used: &UsedBrush) {
        let all = vec![true; self.surface.triangle_count()];
        let mut filler = self.filler(points, used);
        if !used.has_limits() {
            for texel in texels {
                filler.add(*texel, 1.0, None);
            }
            return;
        }
        for_places(filler.texels, &all, |texel, at| {
            if texels.binary_search(&texel).is_ok() {
                filler.add(texel, 1.0, Some(at));
            }
        });
    }
}

/// Strength along a straight line through space: 1 before its start and 0 behind its end; 1 everywhere for a single point.
struct FillGradient {
    start: DVec3,
    way: DVec3,
}

impl FillGradient {
    fn new(points: &[StrokePoint]) -> FillGradient {
        let position = |point: Option<&StrokePoint>| point.map_or(DVec3::ZERO, |point| point.site.position); // Without points nothing is filled.
        let start = position(points.first());
        FillGradient {
            way: position(points.last()) - start,
            start,
        }
    }

    fn at(&self, place: DVec3) -> f64 {
        let square = self.way.length_squared();
        if square <= 0.0 {
            return 1.0;
        }
        (1.0 - (place - self.start).dot(self.way) / square).clamp(0.0, 1.0)
    }
}

/// Calls `visit` for all texels of some triangles, including ghosts that show them, with their positions.
fn for_places(texels: SurfaceTexels<'_>, filled: &[bool], mut visit: impl FnMut(usize, &At)) {
    let surface = texels.surface;
    for triangle in 0..surface.triangle_count() as u32 {
        // Only positions in space are needed, so any plane may be used.
        let [a, b, c] = surface.connected().corners(triangle);
        let (x, height) = ((b - a).length(), (b - a).cross(c - a).length());
        if height <= 0.0 || !filled[triangle as usize] {
            continue;
        }
        let placed = PlacedTriangle {
            triangle,
            corners: [
                DVec2::ZERO,
                DVec2::new(x, 0.0),
                DVec2::new((c - a).dot(b - a) / x, height / x),
            ],
        };
        let all = [DVec2::NEG_INFINITY, DVec2::INFINITY];
        for_texels(texels, &placed, all, &mut visit);
    }
}

/// Calls `fill` for all texels of some triangles, including ghosts that show them.
fn for_texels_of(atlas: &Atlas, filled: &[bool], mut fill: impl FnMut(usize)) {
    for (texel, &owner) in atlas.owners.iter().enumerate() {
        if owner == EMPTY {
            continue;
        }
        let triangle = match owner & GHOST_BIT {
            0 => owner,
            _ => atlas.ghosts[(owner & !GHOST_BIT) as usize].target_triangle,
        };
        if filled[triangle as usize] {
            fill(texel);
        }
    }
}

/// Returns, for each triangle, true if it belongs to the area that the points touch. Must not be called for the way, its
/// inside, and single stamps.
fn triangles(
    surface: &PaintSurface<'_>,
    atlas: &Atlas,
    points: &[StrokePoint],
    area: Area,
    side_degrees: f32,
) -> Vec<bool> {
    let mesh = surface.mesh();
    let group = |triangle: usize| match area {
        Area::Way
        | Area::Ribbon
        | Area::Decal
        | Area::Label
        | Area::Inside
        | Area::Similar
        | Area::All
        | Area::Gradient
        | Area::Side => 0,
        Area::Part => mesh.triangle_part[triangle],
        Area::Piece => surface.index().pieces[triangle],
        Area::Chart => atlas.uv_chart(triangle),
        Area::Material => mesh.triangle_material[triangle],
    };
    let touched = || points.iter().map(|point| point.site.triangle);
    match area {
        Area::Way | Area::Ribbon | Area::Decal | Area::Label | Area::Inside | Area::Similar => {
            vec![false; surface.triangle_count()]
        }
        Area::All | Area::Gradient => vec![!points.is_empty(); surface.triangle_count()],
        Area::Side => side(surface, touched(), f64::from(side_degrees).to_radians().cos()),
        Area::Part | Area::Piece | Area::Chart | Area::Material => {
            let groups: BTreeSet<u32> = touched().map(|triangle| group(triangle as usize)).collect();
            (0..surface.triangle_count())
                .map(|triangle| groups.contains(&group(triangle)))
                .collect()
        }
    }
}

/// Returns the triangles that are reached across edges between triangles whose normals have at least this cosine.
fn side(surface: &PaintSurface<'_>, touched: impl Iterator<Item = u32>, least_cosine: f64) -> Vec<bool> {
    let connected = surface.connected();
    let mut is_reached = vec![false; surface.triangle_count()];
    let mut open: Vec<u32> = touched.collect();
    for triangle in &open {
        is_reached[*triangle as usize] = true;
    }
    while let Some(triangle) = open.pop() {
        let normal = connected.normal(triangle);
        for edge in 0..3 {
            let twin = connected.topology.twins[3 * triangle as usize + edge];
            if twin == NO_TWIN || is_reached[twin as usize / 3] {
                continue;
            }
            if connected.normal(twin / 3).dot(normal) >= least_cosine {
                is_reached[twin as usize / 3] = true;
                open.push(twin / 3);
            }
        }
    }
    is_reached
}
