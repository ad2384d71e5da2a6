//! Segments in a plane.

use glam::DVec2;

/// Distance from a point to a segment.
pub(crate) fn distance_to_segment(point: DVec2, ends: [DVec2; 2]) -> f64 {
    let along = ends[1] - ends[0];
    let square = along.length_squared();
    let t = if square > 0.0 {
        ((point - ends[0]).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(ends[0] + t * along)
}
