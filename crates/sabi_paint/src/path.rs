//! Paths: strokes whose way goes through a few knots and can be bent later.
//!
//! The knots and their handles are points on the surface, so that they are found again on a changed model like all points
//! of a stroke. Between two knots the way is a cubic Bézier curve in space, projected onto the surface part by part.

mod edges;
mod fit;
mod line;
#[cfg(test)]
mod tests;

use crate::path_form::PathForm;
use crate::pen::Touch;
use crate::stroke::{Stroke, StrokePoint};
use crate::surface::PaintSurface;
use glam::DVec3;
use sabi_surface::patch::Site;

pub use edges::EdgeKind;
use line::line_between;

/// Approximate maximum number of points of the whole way.
const PLACES_LIMIT: f64 = 200_000.0;
/// Maximum number of parts of the way between two knots.
const PARTS_LIMIT: usize = 4096;
/// Distance between two points, in multiples of the wanted step, from which on a straight line over the surface is
/// searched. If there is none, the way has a gap.
const JUMP: f64 = 1.5;
const GAP: f64 = 4.0;
/// Radius around a knot in which the normal of the surface is averaged, as a share of the distance to the next knot. With
/// this radius, a bevel does not count more than the board that it belongs to.
const AROUND: f64 = 0.25;
/// Height above and below the straight line between two knots in which the surface is searched, as a share of its length.
const ROOM: f64 = 0.15;
/// Distance of an automatic handle from its knot, as a share of the distance to the next knot.
const HANDLE: f64 = 1.0 / 3.0;

/// A path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// Its knots in order.
    pub knots: Vec<Knot>,
    /// True if the path returns from the last knot to the first.
    pub is_closed: bool,
}

/// A point through which a path passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// The place.
    pub place: StrokePoint,
    /// Bend of the path at this knot.
    pub bend: Bend,
}

/// Bend of a path at a knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bend {
    /// As smooth as the adjacent knots allow.
    Smooth,
    /// A corner.
    Corner,
    /// Toward handles before and after the knot.
    Handles([StrokePoint; 2]),
}

/// Maximum number of knots of a path. Nobody sets so many by hand.
const KNOTS_LIMIT: usize = 4096;

impl Stroke {
    /// Returns the path of the stroke; `None` if it was drawn by hand or has more than 4096 knots.
    pub fn as_path(&self) -> Option<Path> {
        let form = self.path.as_ref().filter(|form| form.knots.len() <= KNOTS_LIMIT)?;
        let mut places = self.points.iter().copied();
        let knots = form.knots.chars().map(|letter| {
            let place = places.next()?;
            let bend = match letter {
                's' => Bend::Smooth,
                'c' => Bend::Corner,
                'h' => Bend::Handles([places.next()?, places.next()?]),
                _ => return None,
            };
            Some(Knot { place, bend })
        });
        let knots = knots.collect::<Option<_>>()?;
        let is_closed = form.closed;
        places.next().is_none().then_some(Path { knots, is_closed })
    }
}

impl Path {
    /// Returns the points of the path as a stroke stores them, and its form.
    pub fn places(&self) -> (Vec<StrokePoint>, PathForm) {
        let mut points = Vec::new();
        let mut knots = String::new();
        for (index, knot) in self.knots.iter().enumerate() {
            points.push(StrokePoint {
                starts: index == 0,
                ..knot.place
            });
            knots.push(match knot.bend {
                Bend::Smooth => 's',
                Bend::Corner => 'c',
                Bend::Handles(handles) => {
                    points.extend(handles);
                    'h'
                }
            });
        }
        let closed = self.is_closed;
        (points, PathForm { knots, closed })
    }

    /// Returns the path with each point moved by a function. Knots for which it returns `None` are left out and counted. If
    /// it returns `None` for a handle, the bend becomes smooth.
    pub(crate) fn moved(&self, mut find: impl FnMut(&StrokePoint) -> Option<StrokePoint>) -> (Path, usize) {
        let knots: Vec<Knot> = self
            .knots
            .iter()
            .filter_map(|knot| {
                let place = find(&knot.place)?;
                let bend = match &knot.bend {
                    Bend::Handles([before, behind]) => match (find(before), find(behind)) {
                        (Some(before), Some(behind)) => Bend::Handles([before, behind]),
                        _ => Bend::Smooth,
                    },
                    bend => *bend,
                };
                Some(Knot { place, bend })
            })
            .collect();
        let lost = self.knots.len() - knots.len();
        let is_closed = self.is_closed;
        (Path { knots, is_closed }, lost)
    }

    /// Returns the number of ways from one knot to the next.
    pub fn span_count(&self) -> usize {
        match self.knots.len() {
            0 | 1 => 0,
            count if self.is_closed => count,
            count => count - 1,
        }
    }

    /// Returns the points of the way from a knot to the next, including both. Their distances are at most `step`, in model units.
    pub fn span(&self, surface: &PaintSurface<'_>, index: usize, step: f64) -> Vec<StrokePoint> {
        let count = self.knots.len();
        let (Some(from), Some(to)) = (self.knots.get(index), self.knots.get((index + 1) % count.max(1))) else {
            return Vec::new();
        };
        let controls = self.controls(index);
        let [a, .., b] = controls;
        let length = controls.windows(2).map(length_of).sum::<f64>();
        let parts = ((length / step).ceil() as usize).clamp(1, PARTS_LIMIT);
        let around = [from, to].map(|knot| surface.broad_normal(knot.place.site, AROUND * a.distance(b)));
        let depth = depth_of(a.distance(b), around);
        let normals = across(b - a, around);
        let mut points = vec![StrokePoint {
            starts: false,
            ..from.place
        }];
        for part in 1..parts {
            let share = part as f64 / parts as f64;
            let normal = normals[0].lerp(normals[1], share).normalize_or_zero();
            let touch = Touch::between([from.place.touch(), to.place.touch()], share as f32);
            let site = below(surface, bezier(controls, share), normal, depth);
            let point = site.and_then(|site| surface.point(site, touch, false));
            if let Some(point) = point {
                add_part(surface, point, step, &mut points);
            }
        }
        add_part(surface, to.place, step, &mut points);
        points
    }

    /// Returns the control points of the curve from a knot to the next.
    fn controls(&self, index: usize) -> [DVec3; 4] {
        let next = (index + 1) % self.knots.len();
        let [a, b] = [index, next].map(|knot| self.knots[knot].place.site.position);
        [a, self.handles(index)[1], self.handles(next)[0], b]
    }

    /// Returns the points of the whole way. Their distances are at most `step`, in model units.
    pub fn way(&self, surface: &PaintSurface<'_>, step: f64) -> Vec<StrokePoint> {
        let first = self.knots.first().map(|knot| StrokePoint {
            starts: true,
            ..knot.place
        });
        // Limits the number of points even for a very small step of a forged brush.
        let lengths = (0..self.span_count()).map(|index| self.controls(index).windows(2).map(length_of).sum::<f64>());
        let step = step.max(lengths.sum::<f64>() / PLACES_LIMIT);
        let mut way: Vec<StrokePoint> = first.into_iter().collect();
        for index in 0..self.span_count() {
            way.extend(self.span(surface, index, step).into_iter().skip(1));
        }
        way
    }

    /// Returns the positions in space of the handles before and after a knot: the given ones, or else the ones that
    /// follow from its bend.
    pub fn handles(&self, index: usize) -> [DVec3; 2] {
        let at = |index: usize| self.knots[index].place.site.position;
        let (own, count) = (at(index), self.knots.len());
        let neighbor = |is_there: bool, index: usize| is_there.then(|| at(index % count));
        let before = neighbor(count > 1 && (index > 0 || self.is_closed), index + count - 1);
        let behind = neighbor(count > 1 && (index + 1 < count || self.is_closed), index + 1);
        let toward = |neighbor: Option<DVec3>| neighbor.map_or(own, |place| own.lerp(place, HANDLE));
        match (self.knots[index].bend, before, behind) {
            (Bend::Handles([before, behind]), ..) => [before, behind].map(|handle| handle.site.position),
            (Bend::Smooth, Some(before), Some(behind)) => {
                let along = (behind - before).normalize_or_zero();
                let reach = |neighbor: DVec3| HANDLE * neighbor.distance(own);
                [own - reach(before) * along, own + reach(behind) * along]
            }
            _ => [toward(before), toward(behind)],
        }
    }
}

/// Returns unit normals for both ends of a way along which the surface between them is searched: perpendicular to the way
/// as far as possible.
fn across(chord: DVec3, around: [DVec3; 2]) -> [DVec3; 2] {
    let along = chord.normalize_or_zero();
    let across = around.map(|normal| (normal - normal.dot(along) * along).normalize_or_zero());
    match across.map(|normal| normal != DVec3::ZERO) {
        [true, true] => across,
        [true, false] => [across[0]; 2],
        [false, true] => [across[1]; 2],
        [false, false] => around,
    }
}

/// Returns the distance from the straight line between two points within which the surface between them is searched: that
/// of a round surface with these normals, and a margin.
fn depth_of(chord: f64, [from, to]: [DVec3; 2]) -> f64 {
    let angle = from.dot(to).clamp(-1.0, 1.0).acos();
    chord * ((0.25 * angle).tan() + ROOM)
}

/// Returns the outermost place of the surface near a position in space, as seen along a normal; `None` if no surface that
/// faces the normal is within `depth`, in model units.
fn below(surface: &PaintSurface<'_>, place: DVec3, normal: DVec3, depth: f64) -> Option<Site> {
    let origin = place + depth * normal;
    let ray = [origin, -normal].map(|vector| vector.as_vec3().to_array());
    let hit = surface.bvh().closest(ray[0], ray[1], (2.0 * depth) as f32);
    let site = hit.map(|hit| Site {
        triangle: hit.triangle,
        position: surface.mesh().position(hit.triangle, hit.barycentric.map(f64::from)),
    });
    let faces = |site: &Site| surface.connected().normal(site.triangle).dot(normal) > 0.0;
    site.filter(faces).or_else(|| surface.nearest(place, normal, depth))
}

/// Adds a point of a path. If the way to it is long, for example around a corner, points of the straight line over the
/// surface are added as well.
fn add_part(surface: &PaintSurface<'_>, to: StrokePoint, step: f64, points: &mut Vec<StrokePoint>) {
    let before = points[points.len() - 1];
    let jump = before.site.position.distance(to.site.position);
    if jump > JUMP * step {
        let line = line_between(surface, before.site, to.site, step);
        let between = line.into_iter().flatten();
        points.extend(between.filter_map(|site| surface.point(site, before.touch(), false)));
    }
    let before = points[points.len() - 1];
    let is_far = before.site.position.distance(to.site.position) > GAP * step;
    points.push(StrokePoint { starts: is_far, ..to });
}

fn length_of(pair: &[DVec3]) -> f64 {
    pair.iter()
        .zip(pair.iter().skip(1))
        .map(|(from, to)| from.distance(*to))
        .sum()
}

/// Returns a point of a cubic Bézier curve.
fn bezier([a, b, c, d]: [DVec3; 4], share: f64) -> DVec3 {
    let left = 1.0 - share;
    left * left * left * a + 3.0 * left * left * share * b + 3.0 * left * share * share * c + share * share * share * d
}

/// Returns the knot of a path at a site.
fn knot_at(surface: &PaintSurface<'_>, site: Site, bend: Bend) -> Option<Knot> {
    let place = surface.point(site, 1.0, false)?;
    Some(Knot { place, bend })
}
