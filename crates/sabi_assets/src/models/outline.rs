//! Closed and open lines in a plane: rounding, offsetting, filling.

use std::f64::consts::TAU;

use glam::{DVec2, dvec2};

/// A corner of an outline before rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutlineCorner {
    /// Position in meters.
    pub(crate) at: DVec2,
    /// Radius of its rounding, in meters; 0 keeps it sharp.
    pub(crate) radius: f64,
    /// True if a chart border runs here.
    pub(crate) seam: bool,
}

/// A rounded outline: its points, and the numbers of those where a chart border runs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outline {
    /// Counter-clockwise when closed.
    pub(crate) points: Vec<DVec2>,
    /// Ascending.
    pub(crate) seams: Vec<usize>,
}

/// Rounds every corner with an arc of `segments` pieces.
pub(crate) fn rounded(turns: &[OutlineCorner], segments: usize, closed: bool) -> Outline {
    let count = turns.len();
    let mut outline = Outline::default();
    for (i, turn) in turns.iter().enumerate() {
        if turn.seam {
            outline.seams.push(outline.points.len());
        }
        let is_end = !closed && (i == 0 || i == count - 1);
        if turn.radius <= 0.0 || is_end {
            outline.points.push(turn.at);
        } else {
            let before = turns[(i + count - 1) % count].at;
            let after = turns[(i + 1) % count].at;
            outline
                .points
                .extend(arc(before, turn.at, after, turn.radius, segments));
        }
    }
    outline
}

/// The arc of a radius that touches both legs of a corner, from the first to the second.
fn arc(before: DVec2, corner: DVec2, after: DVec2, radius: f64, segments: usize) -> Vec<DVec2> {
    let (arrive, leave) = (
        (corner - before).normalize_or_zero(),
        (after - corner).normalize_or_zero(),
    );
    let turn = arrive.angle_to(leave);
    let start = corner - arrive * radius * (turn.abs() / 2.0).tan();
    let center = start + arrive.perp() * radius * turn.signum();
    (0..=segments)
        .map(|i| center + DVec2::from_angle(turn * i as f64 / segments as f64).rotate(start - center))
        .collect()
}

/// A rounded rectangle about the origin, its wide sides cut into `spans`; starts in the middle of the lower side, where
/// the chart border is least visible.
pub(crate) fn rounded_rectangle(width: f64, height: f64, radius: f64, spans: usize) -> Outline {
    rectangle(width, height, radius, spans, 3)
}

/// A [`rounded_rectangle`] with a choice of how many pieces each corner's arc has; 1 is a plain bevel.
pub(crate) fn rectangle(width: f64, height: f64, radius: f64, spans: usize, segments: usize) -> Outline {
    let (x, y) = (width / 2.0, height / 2.0);
    let corner = |x: f64, y: f64| OutlineCorner {
        at: dvec2(x, y),
        radius,
        seam: false,
    };
    let mut turns = vec![
        OutlineCorner {
            at: dvec2(0.0, -y),
            radius: 0.0,
            seam: true,
        },
        corner(x, -y),
        corner(x, y),
    ];
    let flat = width - 2.0 * radius;
    for i in 1..spans {
        turns.push(OutlineCorner {
            at: dvec2(flat / 2.0 - flat * i as f64 / spans as f64, y),
            radius: 0.0,
            seam: false,
        });
    }
    turns.extend([corner(-x, y), corner(-x, -y)]);
    rounded(&turns, segments, true)
}

/// A circle about the origin with one chart border at its lowest point.
pub(crate) fn circle(radius: f64, segments: usize) -> Outline {
    let points = (0..segments)
        .map(|i| DVec2::from_angle(TAU * (i as f64 / segments as f64 - 0.25)) * radius)
        .collect();
    Outline { points, seams: vec![0] }
}

/// Every point of a counter-clockwise outline moved outward by a distance, or inward when it is negative.
pub(crate) fn offset(points: &[DVec2], by: f64) -> Vec<DVec2> {
    let count = points.len();
    (0..count)
        .map(|i| {
            let arrive = (points[i] - points[(i + count - 1) % count]).normalize_or_zero();
            let leave = (points[(i + 1) % count] - points[i]).normalize_or_zero();
            let (one, other) = (-arrive.perp(), -leave.perp());
            points[i] + (one + other) / (1.0 + one.dot(other)).max(0.2) * by
        })
        .collect()
}

/// Triangles that fill a counter-clockwise outline without crossing: the best-shaped ear is cut first.
pub(crate) fn fill(points: &[DVec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let best = (0..left.len())
            .filter_map(|i| ear_quality(points, &left, i).map(|quality| (i, quality)))
            .reduce(|best, next| if next.1 > best.1 + 1e-9 { next } else { best });
        let Some((ear, _)) = best else { break };
        triangles.push(corners_at(&left, ear));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

fn corners_at(left: &[usize], i: usize) -> [usize; 3] {
    let count = left.len();
    [left[(i + count - 1) % count], left[i], left[(i + 1) % count]]
}

/// Computes the compactness of the ear at a place of the remaining outline (1 = equilateral); `None` if it is no ear.
fn ear_quality(points: &[DVec2], left: &[usize], i: usize) -> Option<f64> {
    let numbers = corners_at(left, i);
    let [a, b, c] = numbers.map(|number| points[number]);
    let double_area = (b - a).perp_dot(c - a);
    if double_area <= 1e-12 {
        return None;
    }
    let is_blocked = left
        .iter()
        .filter(|number| !numbers.contains(number))
        .map(|&number| points[number])
        .any(|p| (b - a).perp_dot(p - a) >= 0.0 && (c - b).perp_dot(p - b) >= 0.0 && (a - c).perp_dot(p - c) >= 0.0);
    let sides = (b - a).length_squared() + (c - b).length_squared() + (a - c).length_squared();
    (!is_blocked).then_some(double_area * 12f64.sqrt() / sides)
}
