//! The way of a stroke over the surface.

use glam::DVec3;
use sabi_surface::patch::{Site, walk};

use crate::pen::{PenPose, Touch};
use crate::stroke::StrokePoint;
use crate::surface::PaintSurface;

/// Most parts of the way between two points of a stroke.
const PARTS_LIMIT: usize = 1024;

/// Most places along a stroke, and most stamps.
const PLACES_LIMIT: f64 = 400_000.0;

/// Least way between two places, as a share of the longest, where it is nearly straight.
const THIN: f64 = 0.6;
/// Cosine of a turn, 10°, and difference of pressure or tilt from which on a place is kept.
const STRAIGHT_COSINE: f64 = 0.985;
const EVEN: f32 = 0.02;

/// A place on the way of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WayPoint {
    pub(crate) site: Site,
    pub(crate) pose: PenPose,
    /// True if a way leads here from the place before.
    pub(crate) is_joined: bool,
    /// True where the stroke starts or jumps. Otherwise a place that is not joined lies beyond a joint, as on the next board.
    pub(crate) starts: bool,
}

/// The way through the points of a stroke, in parts no longer than `step`, model units: a Catmull-Rom curve in space
/// (centripetal, so that it has no loops), laid on the surface part by part. It is nearly the same for many points as for few.
pub(crate) fn way_of(surface: &PaintSurface<'_>, points: &[StrokePoint], step: f64) -> Vec<WayPoint> {
    // However small a forged brush is.
    let step = step.max(length_of(points.iter().map(|point| point.site.position)) / PLACES_LIMIT);
    let mut way: Vec<WayPoint> = Vec::new();
    for run in points.chunk_by(|_, next| !next.starts) {
        let Some(first) = run.first() else { continue };
        way.push(WayPoint {
            site: first.site,
            pose: posed(surface, first.site, first.touch()),
            is_joined: false,
            starts: true,
        });
        for index in 1..run.len() {
            if surface.is_stopped() {
                break;
            }
            add_span(surface, run, index, step, &mut way);
        }
    }
    thinned(way, THIN * step)
}

/// Length of the straight lines between places, one after another.
fn length_of(places: impl Iterator<Item = DVec3>) -> f64 {
    let mut before = None;
    places
        .map(|place| {
            before
                .replace(place)
                .map_or(0.0, |before: DVec3| before.distance(place))
        })
        .sum()
}

/// The way without places that are nearer than `least` to the one before, where it is nearly straight and even there: a hand that is
/// asked often paints no slower.
fn thinned(way: Vec<WayPoint>, least: f64) -> Vec<WayPoint> {
    let mut kept: Vec<WayPoint> = Vec::with_capacity(way.len());
    for (index, point) in way.iter().enumerate() {
        let next = way.get(index + 1).filter(|next| next.is_joined);
        let (Some(last), Some(next)) = (kept.last(), next) else {
            kept.push(*point);
            continue;
        };
        let [to, on] = [
            point.site.position - last.site.position,
            next.site.position - point.site.position,
        ];
        let is_straight = to.normalize_or_zero().dot(on.normalize_or_zero()) > STRAIGHT_COSINE;
        let is_even = point.pose.is_near(&last.pose, EVEN);
        if !(point.is_joined && is_straight && is_even && to.length() < least) {
            kept.push(*point);
        }
    }
    kept
}

/// Adds the way from the point before `index` to that point.
fn add_span(surface: &PaintSurface<'_>, run: &[StrokePoint], index: usize, step: f64, way: &mut Vec<WayPoint>) {
    let at = |index: usize| run[index].site.position;
    let (from, to) = (at(index - 1), at(index));
    let chord = from.distance(to);
    if chord <= 0.0 {
        return;
    }
    let before = if index >= 2 { at(index - 2) } else { 2.0 * from - to };
    let after = if index + 1 < run.len() {
        at(index + 1)
    } else {
        2.0 * to - from
    };
    let parts = ((chord / step).ceil() as usize).clamp(1, PARTS_LIMIT);
    let mut site = run[index - 1].site;
    for part in 1..=parts {
        let share = part as f64 / parts as f64;
        let target = curve([before, from, to, after], share);
        site = walk(surface.connected(), site, target);
        let touch = Touch::between([run[index - 1].touch(), run[index].touch()], share as f32);
        if part < parts {
            way.push(WayPoint {
                site,
                pose: posed(surface, site, touch),
                is_joined: true,
                starts: false,
            });
            continue;
        }
        // The point itself lies elsewhere where the way came to a gap.
        let missed = site.position.distance(to);
        way.push(WayPoint {
            site: run[index].site,
            pose: posed(surface, run[index].site, touch),
            is_joined: missed <= 0.25 * chord / parts as f64 + 1e-9 * chord,
            starts: false,
        });
    }
}

/// A place on the centripetal Catmull-Rom curve between the second and the third of four places (Barry and Goldman, "A
/// recursive evaluation algorithm for a class of Catmull-Rom splines", 1988).
fn curve(places: [DVec3; 4], share: f64) -> DVec3 {
    let [a, b, c, d] = places;
    let time = |from: DVec3, to: DVec3| from.distance(to).sqrt();
    let (first, middle, last) = (time(a, b), time(b, c), time(c, d));
    if first <= 0.0 || middle <= 0.0 || last <= 0.0 {
        return b.lerp(c, share);
    }
    let [t1, t2, t3] = [first, first + middle, first + middle + last];
    let t = t1 + share * middle;
    let between = |from: DVec3, to: DVec3, start: f64, end: f64| from.lerp(to, (t - start) / (end - start));
    let [ab, bc, cd] = [between(a, b, 0.0, t1), between(b, c, t1, t2), between(c, d, t2, t3)];
    between(between(ab, bc, 0.0, t2), between(bc, cd, t1, t3), t1, t2)
}

/// The pen over the surface at a site.
fn posed(surface: &PaintSurface<'_>, site: Site, touch: Touch) -> PenPose {
    touch.over(|| surface.smooth_normal_at(site))
}

/// Places along a way, `spacing` apart by the length of the way, the first one at its start. `spacing` gives the distance to
/// the next place from the pen, model units.
pub(crate) fn spaced(way: &[WayPoint], spacing: impl Fn(&PenPose) -> f64) -> Vec<WayPoint> {
    let least = length_of(way.iter().map(|point| point.site.position)) / PLACES_LIMIT;
    let spacing = |pose: &PenPose| spacing(pose).max(least);
    let mut stamps: Vec<WayPoint> = Vec::new();
    let mut left = 0.0;
    for (index, point) in way.iter().enumerate() {
        if !point.is_joined {
            stamps.push(*point);
            left = spacing(&point.pose);
            continue;
        }
        let before = &way[index - 1];
        let length = before.site.position.distance(point.site.position);
        let mut passed = left;
        while passed <= length && length > 0.0 {
            let share = passed / length;
            // Parts of the way are short, so the nearer end's triangle holds the place closely enough.
            let near = if share < 0.5 { before } else { point };
            let pose = PenPose::between([before.pose, point.pose], share as f32);
            stamps.push(WayPoint {
                site: Site {
                    triangle: near.site.triangle,
                    position: before.site.position.lerp(point.site.position, share),
                },
                pose,
                is_joined: true,
                starts: false,
            });
            passed += spacing(&pose).max(1e-3 * length);
        }
        left = passed - length;
    }
    stamps
}
