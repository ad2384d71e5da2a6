//! The area inside of an outline, as seen by the artist.

use glam::{DVec2, DVec3};
use sabi_surface::patch::{PlacedTriangle, axes};

use super::texels::{At, SurfaceTexels, for_texels};
use crate::brush_limits::Eye;
use crate::stroke::StrokePoint;

/// Depth in front of and behind the outline that is filled, as a share of its width.
const DEPTH: f64 = 0.25;
/// Maximum number of corners of an outline. Of longer outlines, only every n-th corner is used.
const MOST_CORNERS: usize = 1024;
/// Minimum distance in front of the eye, as a share of the distance to the outline.
const LEAST_DEPTH: f64 = 1e-3;

/// An outline in the plane perpendicular to the view.
struct FillOutline {
    view: PlaneView,
    corners: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
    /// Range of depths along the view that is filled.
    depths: [f64; 2],
}

/// The view onto a plane.
struct PlaneView {
    /// Position of the eye; `None` without perspective.
    eye: Option<DVec3>,
    /// Direction of the view.
    ahead: DVec3,
    x: DVec3,
    y: DVec3,
    /// Depth of the plane.
    depth: f64,
}

impl PlaneView {
    fn new(points: &[StrokePoint], eye: Option<Eye>) -> Option<PlaneView> {
        let vector = |numbers: [f32; 3]| DVec3::from(numbers.map(f64::from));
        let middle = points.iter().map(|point| point.site.position).sum::<DVec3>() / points.len() as f64;
        let normal = points.iter().map(|point| vector(point.normal)).sum::<DVec3>();
        let (eye, ahead) = match eye {
            Some(Eye::Place(place)) => (Some(vector(place)), middle - vector(place)),
            Some(Eye::Toward(direction)) => (None, -vector(direction)),
            // In the 2D view no side of the model is in front, so the outline is seen straight from above.
            None => (None, -normal),
        };
        let ahead = ahead.try_normalize()?;
        let (x, y) = axes(-ahead, ahead.any_orthonormal_vector());
        let mut view = PlaneView {
            eye,
            ahead,
            x,
            y,
            depth: 0.0,
        };
        view.depth = view.depth_of(middle);
        Some(view)
    }

    fn depth_of(&self, place: DVec3) -> f64 {
        (place - self.eye.unwrap_or(DVec3::ZERO)).dot(self.ahead) // Without perspective, depths are measured from the origin.
    }

    /// Projects a place onto the plane; `None` if it is behind the eye.
    fn seen(&self, place: DVec3) -> Option<DVec2> {
        let Some(eye) = self.eye else {
            return Some(DVec2::new(place.dot(self.x), place.dot(self.y)));
        };
        let depth = self.depth_of(place);
        let way = (place - eye) * (self.depth / depth);
        (depth > LEAST_DEPTH * self.depth).then(|| DVec2::new(way.dot(self.x), way.dot(self.y)))
    }

    /// Returns true if a surface faces the eye.
    fn faces(&self, place: DVec3, normal: DVec3) -> bool {
        let way = self.eye.map_or(-self.ahead, |eye| eye - place);
        normal.dot(way) > 0.0
    }
}

impl FillOutline {
    /// Returns `None` if the points enclose no area.
    fn new(points: &[StrokePoint], eye: Option<Eye>) -> Option<FillOutline> {
        if points.len() < 3 {
            return None;
        }
        let view = PlaneView::new(points, eye)?;
        // The number of corners is limited, since every texel is compared with every corner.
        let step = points.len().div_ceil(MOST_CORNERS);
        let corners = points.iter().step_by(step);
        let corners: Vec<DVec2> = corners.filter_map(|point| view.seen(point.site.position)).collect();
        let low = corners.iter().copied().reduce(DVec2::min)?;
        let high = corners.iter().copied().reduce(DVec2::max)?;
        let depths = points.iter().map(|point| view.depth_of(point.site.position));
        let (near, far) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), depth| {
            (near.min(depth), far.max(depth))
        });
        let margin = DEPTH * (high - low).max_element();
        Some(FillOutline {
            depths: [near - margin, far + margin],
            view,
            corners,
            low,
            high,
        })
    }

    /// Returns the share of a texel of this width that is inside, 0 to 1.
    fn cover(&self, place: DVec2, width: f64) -> f64 {
        let margin = DVec2::splat(width);
        if place.cmplt(self.low - margin).any() || place.cmpgt(self.high + margin).any() {
            return 0.0;
        }
        let (mut is_inside, mut square) = (false, f64::INFINITY);
        let mut from = self.corners[self.corners.len() - 1];
        for to in &self.corners {
            let side = *to - from;
            let t = ((place - from).dot(side) / side.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            square = square.min(place.distance_squared(from + t * side));
            let crosses = (from.y > place.y) != (to.y > place.y);
            if crosses && place.x < from.x + (place.y - from.y) / (to.y - from.y) * side.x {
                is_inside = !is_inside;
            }
            from = *to;
        }
        let distance = if is_inside { square.sqrt() } else { -square.sqrt() };
        (distance / width + 0.5).clamp(0.0, 1.0)
    }
}

/// Calls `fill` for all texels inside of the outline through some points, as seen from an eye, with their strength. Only
/// surfaces that face the eye and are not far in front of or behind the outline are filled.
pub(super) fn for_outline(
    texels: SurfaceTexels<'_>,
    points: &[StrokePoint],
    eye: Option<Eye>,
    mut fill: impl FnMut(usize, f64, &At),
) {
    let Some(outline) = FillOutline::new(points, eye) else {
        return;
    };
    let surface = texels.surface;
    let view = &outline.view;
    for triangle in 0..surface.triangle_count() as u32 {
        let corners = surface.connected().corners(triangle);
        if !view.faces(corners[0], surface.connected().normal(triangle)) {
            continue;
        }
        let seen = corners.map(|corner| view.seen(corner));
        let [Some(a), Some(b), Some(c)] = seen else { continue };
        let is_beside = a.max(b).max(c).cmplt(outline.low).any() || a.min(b).min(c).cmpgt(outline.high).any();
        if is_beside {
            continue;
        }
        // Only positions in space are needed, so any plane may be used.
        let placed = PlacedTriangle {
            triangle,
            corners: [a, b, c],
        };
        let all = [DVec2::NEG_INFINITY, DVec2::INFINITY];
        for_texels(texels, &placed, all, |texel, at| {
            let depth = view.depth_of(at.position);
            let is_near = outline.depths[0] <= depth && depth <= outline.depths[1];
            if let Some(place) = view.seen(at.position).filter(|_| is_near) {
                fill(texel, outline.cover(place, at.width), at);
            }
        });
    }
}
