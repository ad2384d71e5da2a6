//! Areas that a stroke fills.

use std::collections::BTreeSet;

use glam::DVec2;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};
use sabi_surface::patch::PlacedTriangle;
use sabi_surface::{Groups, NO_TWIN};

use super::texels::for_texels;
use crate::stroke::{Area, StrokePoint};
use crate::surface::PaintSurface;

/// Cosine of the angle between two triangles beyond which a side ends: 30°.
const LEAST_COSINE: f64 = 0.866_025_403_784_438_6;

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

/// Calls `fill` for all texels of the area that places touch, ghosts that show it included. The way, its inside and single stamps
/// are no such areas.
pub(super) fn for_texels_of(
    surface: &PaintSurface<'_>,
    atlas: &Atlas,
    points: &[StrokePoint],
    area: Area,
    mut fill: impl FnMut(usize),
) {
    let filled = triangles(surface, atlas, points, area);
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
fn triangles(surface: &PaintSurface<'_>, atlas: &Atlas, points: &[StrokePoint], area: Area) -> Vec<bool> {
    let mesh = surface.mesh();
    let group = |triangle: usize| match area {
        Area::Way
        | Area::Ribbon
        | Area::Decal
        | Area::Label
        | Area::Inside
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
        Area::Way | Area::Ribbon | Area::Decal | Area::Label | Area::Inside => vec![false; surface.triangle_count()],
        Area::All | Area::Gradient => vec![!points.is_empty(); surface.triangle_count()],
        Area::Side => side(surface, touched()),
        Area::Part | Area::Piece | Area::Chart | Area::Material => {
            let groups: BTreeSet<u32> = touched().map(|triangle| group(triangle as usize)).collect();
            (0..surface.triangle_count())
                .map(|triangle| groups.contains(&group(triangle)))
                .collect()
        }
    }
}

/// Triangles that are reached over soft edges.
fn side(surface: &PaintSurface<'_>, touched: impl Iterator<Item = u32>) -> Vec<bool> {
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
            if connected.normal(twin / 3).dot(normal) >= LEAST_COSINE {
                is_reached[twin as usize / 3] = true;
                open.push(twin / 3);
            }
        }
    }
    is_reached
}
