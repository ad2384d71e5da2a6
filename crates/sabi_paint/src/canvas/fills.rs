//! Areas that a stroke fills.

use std::collections::BTreeSet;

use glam::DVec2;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};
use sabi_surface::patch::PlacedTriangle;
use sabi_surface::{Groups, NO_TWIN};

use super::Canvas;
use super::texels::for_texels;
use crate::stroke::{Area, StrokePoint};
use crate::surface::PaintSurface;

/// Calls `fill` for all texels, ghosts included, with the strength of a gradient there: 1 before the first of the places and 0
/// behind the last, straight through space; 1 everywhere for a single place.
pub(super) fn for_gradient(
    (surface, atlas, ghosts): (&PaintSurface<'_>, &Atlas, &Groups),
    points: &[StrokePoint],
    mut fill: impl FnMut(usize, f64),
) {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return;
    };
    let way = last.site.position - first.site.position;
    let square = way.length_squared();
    for triangle in 0..surface.triangle_count() as u32 {
        // Any plane will do, since places in space are asked for.
        let [a, b, c] = surface.connected().corners(triangle);
        let (x, height) = ((b - a).length(), (b - a).cross(c - a).length());
        if height <= 0.0 {
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
        for_texels((surface.connected(), atlas, ghosts), &placed, all, |texel, at| {
            let share = if square > 0.0 {
                (at.position - first.site.position).dot(way) / square
            } else {
                0.0
            };
            fill(texel, (1.0 - share).clamp(0.0, 1.0));
        });
    }
}

/// Texels of the connected area around some places whose cover differs from theirs by no more than a tolerance, ghosts that show
/// them included. It goes on over seams through ghosts.
pub(super) fn similar_texels(
    (surface, atlas): (&PaintSurface<'_>, &Atlas),
    canvas: &Canvas,
    points: &[StrokePoint],
    tolerance: f32,
) -> Vec<usize> {
    let [columns, rows] = atlas.page_size.map(|side| side as usize);
    let cover = |texel: usize| canvas.texel(texel).cover;
    let mut is_filled = vec![false; atlas.owners.len()];
    for point in points {
        let Some(start) = texel_at(surface, atlas, point) else {
            continue;
        };
        let wanted = cover(start);
        let mut open = vec![start];
        is_filled[start] = true;
        while let Some(texel) = open.pop() {
            let (x, y) = (texel % columns, texel / columns % rows);
            let beside = [
                (x > 0).then(|| texel - 1),
                (x + 1 < columns).then(|| texel + 1),
                (y > 0).then(|| texel - columns),
                (y + 1 < rows).then(|| texel + columns),
            ];
            for next in beside.into_iter().flatten().filter_map(|next| shown_by(atlas, next)) {
                if !is_filled[next] && (cover(next) - wanted).abs() <= tolerance {
                    open.push(next);
                }
                // The texels of its border, too: no fringe is left before the paint that it ends at.
                is_filled[next] = true;
            }
        }
    }
    let shows_filled = |texel: &usize| shown_by(atlas, *texel).is_some_and(|shown| is_filled[shown]);
    (0..atlas.owners.len()).filter(shows_filled).collect()
}

/// The texel that a texel shows: itself, or the one beyond a seam for a ghost; none for an empty one.
fn shown_by(atlas: &Atlas, texel: usize) -> Option<usize> {
    let owner = *atlas.owners.get(texel)?;
    if owner == EMPTY {
        return None;
    }
    if owner & GHOST_BIT == 0 {
        return Some(texel);
    }
    let ghost = &atlas.ghosts[(owner & !GHOST_BIT) as usize];
    let page = atlas.charts[atlas.triangle_chart[ghost.target_triangle as usize] as usize].page;
    let target = texel_of(atlas, page, ghost.target_texel.map(f64::from));
    target.filter(|target| atlas.owners[*target] & GHOST_BIT == 0)
}

/// Index of the texel that a place of a page lies in.
fn texel_of(atlas: &Atlas, page: u32, [x, y]: [f64; 2]) -> Option<usize> {
    let [columns, rows] = atlas.page_size.map(|side| side as usize);
    let is_inside = x >= 0.0 && y >= 0.0 && x < columns as f64 && y < rows as f64;
    is_inside.then(|| (page as usize * rows + y as usize) * columns + x as usize)
}

/// The texel that shows a place of the surface.
fn texel_at(surface: &PaintSurface<'_>, atlas: &Atlas, point: &StrokePoint) -> Option<usize> {
    let triangle = point.site.triangle;
    let chart = &atlas.charts[*atlas.triangle_chart.get(triangle as usize)? as usize];
    let mesh = surface.mesh();
    let weights = surface.weights(point.site);
    let shares = [1.0 - weights.x - weights.y, weights.x, weights.y];
    let corners = mesh.triangles[triangle as usize].into_iter().zip(shares);
    let uv = corners.fold([0.0; 2], |[u, v], (vertex, share)| {
        let own = mesh.uvs[vertex as usize].map(f64::from);
        [u + share * own[0], v + share * own[1]]
    });
    let place = [0, 1].map(|axis| f64::from(atlas.size) * uv[axis] + f64::from(chart.texel_from_uv[axis]));
    texel_of(atlas, chart.page, place).and_then(|texel| shown_by(atlas, texel))
}

/// Calls `fill` for all texels of the area that places touch, ghosts that show it included. The way, its inside and single stamps
/// are no such areas.
pub(super) fn for_texels_of(
    surface: &PaintSurface<'_>,
    atlas: &Atlas,
    points: &[StrokePoint],
    (area, side_degrees): (Area, f32),
    mut fill: impl FnMut(usize),
) {
    let filled = triangles(surface, atlas, points, (area, side_degrees));
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

/// True for each triangle of the area.
fn triangles(
    surface: &PaintSurface<'_>,
    atlas: &Atlas,
    points: &[StrokePoint],
    (area, side_degrees): (Area, f32),
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
        Area::Chart => atlas.triangle_chart[triangle],
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

/// Triangles that are reached over edges between triangles whose normals have at least this cosine.
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
