//! Texels of a triangle.

use glam::{DMat2, DVec2, DVec3};
use sabi_surface::Groups;
use sabi_surface::atlas::Atlas;
use sabi_surface::model::Mesh;
use sabi_surface::patch::PlacedTriangle;

use crate::surface::PaintSurface;

/// Margin in texels around a triangle's corners within which it may own texels. The middle of a texel is inside its
/// triangle, except for rounding and thin charts.
const MARGIN: f64 = 1.5;

/// Returns the ghosts that show each triangle.
pub(super) fn ghosts_of_triangles(atlas: &Atlas) -> Groups {
    Groups::new(atlas.triangle_chart.len(), |member| {
        for (index, ghost) in atlas.ghosts.iter().enumerate() {
            member(ghost.target_triangle as usize, index as u32);
        }
    })
}

/// Map from texels of a triangle's chart to the plane of a patch.
struct PlaneFromTexel {
    /// A corner, in texels of the page.
    texel: DVec2,
    /// Maps a step in texels to the weights of the second and the third corner.
    weights: DMat2,
    /// The first corner in the plane, and the offsets of the other corners.
    place: DVec2,
    linear: DMat2,
}

impl PlaneFromTexel {
    /// Returns `None` for a triangle without area in the texture.
    fn new(mesh: &Mesh, atlas: &Atlas, placed: &PlacedTriangle) -> Option<PlaneFromTexel> {
        let chart = &atlas.charts[atlas.triangle_chart[placed.triangle as usize] as usize];
        let size = f64::from(atlas.size);
        let uvs = mesh.triangles[placed.triangle as usize].map(|vertex| {
            let [u, v] = mesh.uvs[vertex as usize].map(f64::from);
            size * DVec2::new(u, v)
        });
        let weights = DMat2::from_cols(uvs[1] - uvs[0], uvs[2] - uvs[0]).inverse();
        let [a, b, c] = placed.corners;
        let offset = DVec2::new(f64::from(chart.texel_from_uv[0]), f64::from(chart.texel_from_uv[1]));
        weights.is_finite().then_some(PlaneFromTexel {
            texel: uvs[0] + offset,
            weights,
            place: a,
            linear: DMat2::from_cols(b - a, c - a),
        })
    }

    /// Returns the weights of the second and the third corner at a position on the page.
    fn weights(&self, texel: DVec2) -> DVec2 {
        self.weights * (texel - self.texel)
    }

    /// Width of a texel, model units.
    fn width(&self) -> f64 {
        let steps = self.linear * self.weights;
        steps.x_axis.length().max(steps.y_axis.length())
    }

    /// Returns the range of texels that may be within a box of the plane.
    fn texels_of(&self, low: DVec2, high: DVec2) -> [DVec2; 2] {
        let inverse = (self.linear * self.weights).inverse();
        if !inverse.is_finite() {
            return [DVec2::NEG_INFINITY, DVec2::INFINITY];
        }
        let corners = [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)];
        let corners = corners.map(|corner| self.texel + inverse * (corner - self.place));
        let low = corners.iter().fold(DVec2::INFINITY, |low, corner| low.min(*corner));
        let high = corners
            .iter()
            .fold(DVec2::NEG_INFINITY, |high, corner| high.max(*corner));
        [low, high]
    }
}

/// Returns the width of the texels of a triangle in model units; zero for a triangle without area in the texture.
pub(super) fn texel_width(mesh: &Mesh, atlas: &Atlas, placed: &PlacedTriangle) -> f64 {
    PlaneFromTexel::new(mesh, atlas, placed).map_or(0.0, |map| map.width())
}

/// Position of a texel.
pub(super) struct At {
    /// Position in the plane of the patch.
    pub(super) plane: DVec2,
    /// Position in space in model units.
    pub(super) position: DVec3,
    /// Width of texels there in model units.
    pub(super) width: f64,
    /// Triangle, and the weights of its second and third corner.
    pub(super) triangle: u32,
    pub(super) weights: DVec2,
}

/// A surface with its texels: those that each triangle owns, and the ghosts that show it.
#[derive(Clone, Copy)]
pub(super) struct SurfaceTexels<'a> {
    pub(super) surface: &'a PaintSurface<'a>,
    pub(super) atlas: &'a Atlas,
    /// Ghosts that show each triangle ([`ghosts_of_triangles`]).
    pub(super) ghosts: &'a Groups,
}

/// Calls `paint` for each texel within a box of the plane that a placed triangle owns, and for each ghost that shows such a
/// texel, with the index of the texel.
pub(super) fn for_texels(
    texels: SurfaceTexels<'_>,
    placed: &PlacedTriangle,
    [low, high]: [DVec2; 2],
    mut paint: impl FnMut(usize, &At),
) {
    let (surface, atlas) = (texels.surface.connected(), texels.atlas);
    let [a, b, c] = placed.corners;
    let (least, most) = (a.min(b).min(c), a.max(b).max(c));
    if least.cmpgt(high).any() || most.cmplt(low).any() {
        return;
    }
    let Some(map) = PlaneFromTexel::new(surface.mesh, atlas, placed) else {
        return;
    };
    let width = map.width();
    let [first, second, third] = surface.corners(placed.triangle);
    let at = |texel: DVec2| {
        let weights = map.weights(texel);
        At {
            plane: map.place + map.linear * weights,
            position: first + weights.x * (second - first) + weights.y * (third - first),
            width,
            triangle: placed.triangle,
            weights,
        }
    };
    let page = atlas.charts[atlas.triangle_chart[placed.triangle as usize] as usize].page;
    let corners = atlas.triangle_texels[placed.triangle as usize].map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
    let [in_low, in_high] = map.texels_of(low, high);
    let from = in_low
        .max(corners[0].min(corners[1]).min(corners[2]) - MARGIN)
        .floor()
        .max(DVec2::ZERO);
    let far = in_high.min(corners[0].max(corners[1]).max(corners[2]) + MARGIN).ceil();
    let [columns, rows] = atlas.page_size;
    let to = far.min(DVec2::new(f64::from(columns), f64::from(rows)));
    for row in from.y as u32..to.y.max(0.0) as u32 {
        let start = (page as usize * rows as usize + row as usize) * columns as usize;
        for column in from.x as u32..to.x.max(0.0) as u32 {
            let index = start + column as usize;
            if atlas.owners[index] == placed.triangle {
                let texel = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                paint(index, &at(texel));
            }
        }
    }
    for ghost in texels.ghosts.members(placed.triangle as usize) {
        let ghost = &atlas.ghosts[*ghost as usize];
        let [x, y, page] = ghost.texel.map(|number| number as usize);
        let target = DVec2::new(f64::from(ghost.target_texel[0]), f64::from(ghost.target_texel[1]));
        paint((page * rows as usize + y) * columns as usize + x, &at(target));
    }
}
