//! The surface around a stamp, unfolded into a plane.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use sabi_surface::atlas::Atlas;
use sabi_surface::patch::{PlacedTriangle, Site, Unfolder, axes};

use super::texels::texel_width;
use crate::surface::PaintSurface;

/// Minimum cosine between the normal of the surface under the brush and that of another piece that it paints.
const LEAST_FACING: f64 = 0.5;

/// Distances from the middle of a label in its plane, as a share of those in space. A label that reaches halfway around a
/// bottle has 1.57; below 1 is room for coarse triangles.
const PLACED: std::ops::Range<f64> = 0.93..1.6;

/// Minimum cosine between the direction in which a stamp is projected and the normal of a triangle that it paints, about 75°.
const LEAST_THROWN: f64 = 0.25;

/// A triangle in the plane of a patch, or next to it.
#[derive(Clone, Copy)]
pub(super) struct LaidTriangle {
    pub(super) placed: PlacedTriangle,
    /// Its height above the plane.
    pub(super) rise: f64,
    /// True if it belongs to another piece than the one under the brush. Its points may be farther away in space than in the plane.
    pub(super) is_other: bool,
}

/// Unfolds patches of a surface. Keeps its memory from patch to patch.
pub(super) struct Patches<'a> {
    surface: &'a PaintSurface<'a>,
    atlas: &'a Atlas,
    unfolder: Unfolder,
    patch: Vec<PlacedTriangle>,
    near: Vec<u32>,
    /// The patch that was laid last.
    pub(super) laid: Vec<LaidTriangle>,
}

/// Description of the patch to unfold.
#[derive(Clone, Copy)]
pub(super) struct PatchRequest {
    pub(super) from: Site,
    pub(super) to: Option<Site>,
    /// Direction of the x axis of the plane on the surface.
    pub(super) ahead: DVec3,
    pub(super) radius: f64,
    /// True if other pieces nearby are included.
    pub(super) reaches_pieces: bool,
}

/// The plane of a patch: the end of the way in it, and the area that a stamp can reach.
pub(super) struct PatchPlane {
    /// The end of the way; its start is the origin. Also the origin if the surface does not lead to the end.
    pub(super) end: DVec2,
    pub(super) reach: f64,
}

impl<'a> Patches<'a> {
    pub(super) fn new(surface: &'a PaintSurface<'a>, atlas: &'a Atlas) -> Patches<'a> {
        Patches {
            unfolder: Unfolder::new(surface.triangle_count()),
            patch: Vec::new(),
            near: Vec::new(),
            laid: Vec::new(),
            surface,
            atlas,
        }
    }

    /// Unfolds the surface around a way from one site to another, or around a single site.
    pub(super) fn lay(&mut self, wanted: PatchRequest) -> PatchPlane {
        let connected = self.surface.connected();
        let PatchRequest { from, ahead, .. } = wanted;
        let chord = wanted.to.map_or(0.0, |to| from.position.distance(to.position));
        self.unfolder.unfold(connected, from, ahead, 0.0, &mut self.patch);
        // Adds half a texel to the radius, for the border of a hard brush.
        let mesh = self.surface.mesh();
        let texel = self
            .patch
            .first()
            .map_or(0.0, |first| texel_width(mesh, self.atlas, first));
        let reach = 1.01 * wanted.radius + 0.5 * texel;
        self.unfolder
            .unfold(connected, from, ahead, reach + 1.5 * chord, &mut self.patch);
        let end = wanted.to.and_then(|to| {
            let placed = self.patch.iter().find(|placed| placed.triangle == to.triangle)?;
            placed.place_of(connected.corners(to.triangle), to.position)
        });
        self.laid.clear();
        let unfolded = self.patch.iter().map(|placed| LaidTriangle {
            placed: *placed,
            rise: 0.0,
            is_other: false,
        });
        self.laid.extend(unfolded);
        if wanted.reaches_pieces {
            self.lay_other_pieces(from, ahead, reach + chord);
        }
        PatchPlane {
            end: end.unwrap_or(DVec2::ZERO),
            reach,
        }
    }

    /// Drops triangles of the last patch that lie in a wrong place of its plane. The unfolding of a bent surface overlaps
    /// itself: what it comes to around a bump lies where other triangles lie too. Such a triangle is nearer to the middle
    /// in the plane than in space, which no way along a surface can be, or much farther.
    pub(super) fn drop_misplaced(&mut self, from: Site) {
        let connected = self.surface.connected();
        let is_placed = |laid: &LaidTriangle| {
            let in_space = connected.corners(laid.placed.triangle).iter().sum::<DVec3>() / 3.0 - from.position;
            let in_plane = laid.placed.corners.iter().sum::<DVec2>() / 3.0;
            // The middle of a large triangle under the label may be anywhere.
            laid.placed.triangle == from.triangle || PLACED.contains(&(in_plane.length() / in_space.length()))
        };
        self.laid.retain(is_placed);
    }

    /// Projects the surface around a site along a normal onto the plane perpendicular to it. Includes triangles that face the normal and
    /// are not farther from the plane than the radius. Includes only the site's own piece, unless other pieces are wanted.
    pub(super) fn project(&mut self, wanted: PatchRequest, normal: DVec3) -> PatchPlane {
        let connected = self.surface.connected();
        let index = self.surface.index();
        let site = wanted.from;
        let reach = 1.05 * wanted.radius;
        let (x, y) = axes(normal, wanted.ahead);
        let own = index.pieces[site.triangle as usize];
        index.near(site.position - reach, site.position + reach, &mut self.near);
        self.laid.clear();
        for &triangle in &self.near {
            let is_meant = wanted.reaches_pieces || index.pieces[triangle as usize] == own;
            if !is_meant || connected.normal(triangle).dot(normal) < LEAST_THROWN {
                continue;
            }
            let offsets = connected.corners(triangle).map(|corner| corner - site.position);
            let heights = offsets.map(|offset| offset.dot(normal));
            let nearest = heights[0].min(heights[1]).min(heights[2]).max(0.0);
            let farthest = heights[0].max(heights[1]).max(heights[2]).min(0.0);
            // This is the height above the plane that is nearest to it: 0 for a triangle that crosses the plane.
            let rise = nearest + farthest;
            if rise.abs() < wanted.radius {
                let corners = offsets.map(|offset| DVec2::new(offset.dot(x), offset.dot(y)));
                let placed = PlacedTriangle { triangle, corners };
                self.laid.push(LaidTriangle {
                    placed,
                    rise: 0.0,
                    is_other: false,
                });
            }
        }
        PatchPlane {
            end: DVec2::ZERO,
            reach,
        }
    }

    /// Adds other pieces near a site to the plane, so that a stroke continues over the joint of two boards. Each piece is
    /// unfolded from its nearest place on, rotated to be flat, at the height of that place above the plane. Pieces that
    /// face away there, for example the other side of a wall, are not added.
    fn lay_other_pieces(&mut self, site: Site, ahead: DVec3, reach: f64) {
        let index = self.surface.index();
        if index.piece_count < 2 {
            return;
        }
        let connected = self.surface.connected();
        let normal = connected.normal(site.triangle);
        let (x, y) = axes(normal, ahead);
        index.near(site.position - reach, site.position + reach, &mut self.near);
        let mut nearest: BTreeMap<u32, (f64, u32, DVec3)> = BTreeMap::new();
        for &triangle in &self.near {
            let piece = index.pieces[triangle as usize];
            if piece == index.pieces[site.triangle as usize] || connected.normal(triangle).dot(normal) < LEAST_FACING {
                continue;
            }
            let place = connected.nearest_in(triangle, site.position);
            let distance = place.distance(site.position);
            let is_nearer = nearest.get(&piece).is_none_or(|(least, ..)| distance < *least);
            if distance < reach && is_nearer {
                nearest.insert(piece, (distance, triangle, place));
            }
        }
        for (_, triangle, place) in nearest.into_values() {
            let offset = place - site.position;
            let middle = DVec2::new(offset.dot(x), offset.dot(y));
            let (own_x, own_y) = axes(connected.normal(triangle), x);
            let corners = connected.corners(triangle).map(|corner| {
                let own = corner - place;
                middle + DVec2::new(own.dot(own_x), own.dot(own_y))
            });
            self.patch.clear();
            let from = PlacedTriangle { triangle, corners };
            // The rim of a piece is unfolded last. Unfolding across the rim first would put the front of the piece in a wrong place.
            let faces = |triangle: u32| connected.normal(triangle).dot(normal) >= LEAST_FACING;
            self.unfolder.grow(connected, from, reach, &mut self.patch, faces);
            let rise = offset.dot(normal);
            self.laid.extend(self.patch.iter().map(|placed| LaidTriangle {
                placed: *placed,
                rise,
                is_other: true,
            }));
        }
    }
}
