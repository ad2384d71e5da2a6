//! Straight lines over the surface.

use glam::DVec2;
use sabi_surface::patch::{PlacedTriangle, Site, Unfolder};

use crate::surface::PaintSurface;

/// Maximum distance to which the surface around a line is unfolded, as a share of the straight distance between its ends.
const REACH: f64 = 3.0;

/// Returns sites on the straight line over the surface from one site to another, without its ends. Their distances are at most `step`, in
/// model units. The line is straight on the unfolded surface. `None` if the surface does not connect the two directly.
pub(super) fn line_between(surface: &PaintSurface<'_>, from: Site, to: Site, step: f64) -> Option<Vec<Site>> {
    let connected = surface.connected();
    let way = to.position - from.position;
    let mut patch = Vec::new();
    let mut unfolder = Unfolder::new(surface.triangle_count());
    unfolder.unfold(connected, from, way, REACH * way.length(), &mut patch);
    let last = patch.iter().find(|placed| placed.triangle == to.triangle)?;
    let end = last.place_of(connected.corners(to.triangle), to.position)?;
    let parts = (end.length() / step).ceil().max(1.0) as usize;
    let site = |part: usize| {
        let place = end * (part as f64 / parts as f64);
        let (placed, weights) = patch
            .iter()
            .find_map(|placed| Some((placed, weights_in(placed, place)?)))?;
        let [a, b, c] = connected.corners(placed.triangle);
        Some(Site {
            triangle: placed.triangle,
            position: a + weights.x * (b - a) + weights.y * (c - a),
        })
    };
    (1..parts).map(site).collect()
}

/// Returns the weights of the second and the third corner of a triangle in the plane at a position inside it; `None` outside of it.
fn weights_in(placed: &PlacedTriangle, place: DVec2) -> Option<DVec2> {
    let [a, b, c] = placed.corners;
    let (ab, ac, way) = (b - a, c - a, place - a);
    let area = ab.perp_dot(ac);
    let weights = DVec2::new(way.perp_dot(ac), ab.perp_dot(way)) / area;
    let is_inside = weights.min_element() >= -1e-9 && weights.x + weights.y <= 1.0 + 1e-9;
    (area != 0.0 && is_inside).then_some(weights)
}
