//! Conversion of hand-drawn ways to paths.

use glam::DVec3;

use super::{Bend, Knot, Path};
use crate::stroke::{Area, Stroke};

/// Minimum change of direction at a knot that becomes a corner, as a cosine: 50°.
const CORNER_COSINE: f64 = 0.643;
/// Maximum distance of a fitted path from the drawn way, in radii of the brush.
const TOLERANCE: f64 = 0.25;

impl Path {
    /// Returns true if [`Path::of_stroke`] returns a path.
    pub fn follows(stroke: &Stroke) -> bool {
        let has_way = matches!(stroke.area, Area::Way | Area::Ribbon | Area::Inside);
        let is_one_run = !stroke.points.iter().skip(1).any(|point| point.starts);
        has_way && is_one_run && stroke.points.len() >= 2
    }

    /// Returns a path along the way of a stroke, with as few knots as possible. `None` for strokes without a way, and for
    /// strokes of several runs, since one path cannot follow them.
    pub fn of_stroke(stroke: &Stroke) -> Option<Path> {
        if !Path::follows(stroke) {
            return None;
        }
        let places: Vec<DVec3> = stroke.points.iter().map(|point| point.site.position).collect();
        let kept = simplified(&places, TOLERANCE * f64::from(stroke.brush.radius));
        let knots = kept.iter().map(|index| Knot {
            place: stroke.points[*index],
            bend: Bend::Smooth,
        });
        Some(Path {
            knots: knots.collect(),
            is_closed: stroke.area == Area::Inside,
        })
    }
}

/// Returns the indices of the points that a polyline needs in order to stay within a distance of all points (Douglas and
/// Peucker, "Algorithms for the reduction of the number of points required to represent a digitized line", 1973). The first
/// and the last point are included.
pub(super) fn simplified(places: &[DVec3], tolerance: f64) -> Vec<usize> {
    let mut is_kept = vec![false; places.len()];
    let mut open = Vec::new();
    if let Some(last) = places.len().checked_sub(1) {
        (is_kept[0], is_kept[last]) = (true, true);
        open.push((0, last));
    }
    while let Some((first, last)) = open.pop() {
        let (from, way) = (places[first], places[last] - places[first]);
        let square = way.length_squared();
        let distance = |index: usize| {
            let share = if square > 0.0 {
                ((places[index] - from).dot(way) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            places[index].distance(from + share * way)
        };
        let farthest = (first + 1..last).map(|index| (distance(index), index));
        let farthest = farthest.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        if let Some((distance, index)) = farthest.filter(|(distance, _)| *distance > tolerance) {
            is_kept[index] = distance > tolerance;
            open.extend([(first, index), (index, last)]);
        }
    }
    (0..places.len()).filter(|index| is_kept[*index]).collect()
}

/// Returns the bend at a point between two others: a corner if the direction changes sharply.
pub(super) fn bend_between(before: DVec3, at: DVec3, behind: DVec3) -> Bend {
    let cosine = (at - before).normalize_or_zero().dot((behind - at).normalize_or_zero());
    if cosine < CORNER_COSINE {
        Bend::Corner
    } else {
        Bend::Smooth
    }
}
