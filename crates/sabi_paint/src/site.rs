//! Finds the places of strokes again on a changed model.

use glam::DVec3;
use sabi_surface::patch::Site;

use crate::stroke::{Stroke, StrokePoint};
use crate::surface::PaintSurface;

/// Places farther than this share of the brush's radius from the surface are lost.
const TOLERANCE: f64 = 1.0;
/// Least cosine between the normal of a place and that of the triangle that it may move to.
const LEAST_COSINE: f64 = 0.3;

/// The stroke with its places on this surface: by number where the triangle is the same, by content where it has another
/// number, and else the nearest place that faces the same way. Places that are lost are left out, and counted.
pub fn relocate(surface: &PaintSurface<'_>, stroke: &Stroke) -> (Vec<StrokePoint>, usize) {
    let mut found: Vec<StrokePoint> = Vec::with_capacity(stroke.points.len());
    let mut lost = 0;
    let mut starts = false;
    for point in &stroke.points {
        starts |= point.starts;
        match site_of(surface, point, f64::from(stroke.brush.radius)) {
            Some(site) => {
                found.push(StrokePoint { site, starts, ..*point });
                starts = false;
            }
            None => {
                lost += 1;
                starts = true;
            }
        }
    }
    (found, lost)
}

fn site_of(surface: &PaintSurface<'_>, point: &StrokePoint, radius: f64) -> Option<Site> {
    let triangle = point.site.triangle;
    let is_same =
        (triangle as usize) < surface.triangle_count() && surface.triangle_key(triangle) == point.triangle_key;
    let same = if is_same {
        Some(triangle)
    } else {
        surface.triangle_of_key(point.triangle_key)
    };
    if let Some(triangle) = same {
        return Some(Site { triangle, ..point.site });
    }
    nearest(surface, point, TOLERANCE * radius)
}

/// The nearest place within a distance that faces the same way.
fn nearest(surface: &PaintSurface<'_>, point: &StrokePoint, tolerance: f64) -> Option<Site> {
    let normal = DVec3::from(point.normal.map(f64::from));
    let mut best: Option<(f64, Site)> = None;
    for triangle in 0..surface.triangle_count() as u32 {
        let limit = best.map_or(tolerance, |(distance, _)| distance);
        let corners = surface.connected().corners(triangle);
        let low = corners[0].min(corners[1]).min(corners[2]) - limit;
        let high = corners[0].max(corners[1]).max(corners[2]) + limit;
        if point.site.position.cmplt(low).any() || point.site.position.cmpgt(high).any() {
            continue;
        }
        if surface.connected().normal(triangle).dot(normal) < LEAST_COSINE {
            continue;
        }
        let position = surface.connected().nearest_in(triangle, point.site.position);
        let distance = position.distance(point.site.position);
        if distance < limit || (best.is_none() && distance <= tolerance) {
            best = Some((distance, Site { triangle, position }));
        }
    }
    best.map(|(_, site)| site)
}
