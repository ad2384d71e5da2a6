//! A path over the surface toward a point in space.

use glam::DVec3;

use super::{ConnectedMesh, Site};
use crate::atlas::topology::NO_TWIN;

/// Maximum number of triangles that a walk enters.
const STEPS_LIMIT: usize = 4096;
/// Maximum number of triangles that are examined around a corner, where many are equally near to the point.
const CORNER_LIMIT: usize = 64;

/// Walks from a site to the nearest point of the connected surface to a target, going from triangle to triangle as long as the distance
/// decreases. The result is the foot of the perpendicular from the target to the surface, or a point on the border.
pub fn walk(surface: ConnectedMesh<'_>, from: Site, target: DVec3) -> Site {
    let mut site = Site {
        position: surface.nearest_in(from.triangle, target),
        ..from
    };
    for _ in 0..STEPS_LIMIT {
        match nearer(surface, site, target) {
            Some(next) => site = next,
            None => break,
        }
    }
    site
}

/// Returns a point nearer to the target, on a neighbor of the site's triangle or beyond triangles that are equally near.
fn nearer(surface: ConnectedMesh<'_>, site: Site, target: DVec3) -> Option<Site> {
    let least = site.position.distance_squared(target);
    let mut seen = vec![site.triangle];
    let mut at = 0;
    while at < seen.len() {
        for edge in 0..3 {
            let twin = surface.topology.twins[3 * seen[at] as usize + edge];
            if twin == NO_TWIN || seen.contains(&(twin / 3)) {
                continue;
            }
            let triangle = twin / 3;
            let position = surface.nearest_in(triangle, target);
            let distance = position.distance_squared(target);
            if distance < least * (1.0 - 1e-12) {
                return Some(Site { triangle, position });
            }
            // Around a corner, the triangles that touch it are equally near until one of them leads closer.
            if position.distance_squared(site.position) <= 1e-18 * (least + f64::MIN_POSITIVE)
                && seen.len() < CORNER_LIMIT
            {
                seen.push(triangle);
            }
        }
        at += 1;
    }
    None
}

impl ConnectedMesh<'_> {
    /// The place in a triangle nearest to a point (Ericson, "Real-Time Collision Detection", 5.1.5).
    pub fn nearest_in(&self, triangle: u32, p: DVec3) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        let (ab, ac) = (b - a, c - a);
        let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
        if d1 <= 0.0 && d2 <= 0.0 {
            return a;
        }
        let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
        if d3 >= 0.0 && d4 <= d3 {
            return b;
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return a + ab * (d1 / (d1 - d3));
        }
        let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
        if d6 >= 0.0 && d5 <= d6 {
            return c;
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return a + ac * (d2 / (d2 - d6));
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
            return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
        }
        let sum = va + vb + vc;
        if sum == 0.0 {
            return a;
        }
        a + ab * (vb / sum) + ac * (vc / sum)
    }
}
