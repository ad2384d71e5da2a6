//! Finding the points of strokes again: on a changed model, and on the other side of a symmetric one.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use sabi_surface::patch::Site;

use crate::brush::{Symmetry, SymmetryCopy};
use crate::brush_limits::Eye;
use crate::path::Path;
use crate::pen::Touch;
use crate::stroke::{Stroke, StrokePoint};
use crate::surface::{PaintSurface, rightward};

/// Distance from the surface at which a point is lost, as a share of the brush's radius.
const TOLERANCE: f64 = 1.0;

/// Distance from the surface at which a point of a moved stroke is lost, as a share of its distance from the place at which
/// the stroke is held.
const CARRIED: f64 = 0.5;
/// Maximum distance between two points of a path, as a share of the brush's radius.
const PATH_STEP: f64 = 0.5;

/// Returns the stroke with its points on this surface, and the number of lost points, which are left out. A point is found
/// by the number of its triangle if the triangle is the same, by the triangle's content if it has another number, and
/// otherwise as the nearest place that faces the same way.
pub fn relocate(surface: &PaintSurface<'_>, stroke: &Stroke) -> (Stroke, usize) {
    let radius = f64::from(stroke.brush.radius);
    let Some(path) = stroke.as_path() else {
        let (points, lost) = relocate_points(surface, &stroke.points, radius);
        return (
            Stroke {
                points,
                ..stroke.clone()
            },
            lost,
        );
    };
    let (path, lost) = relocate_path(surface, &path, radius);
    let (points, form) = path.places();
    let found = Stroke {
        path: Some(form),
        points,
        ..stroke.clone()
    };
    (found, lost)
}

/// Moves a stroke from one place of the surface to another and turns it counter-clockwise as seen from outside. Each of its
/// points is put on the nearest place that faces the same way. Returns the stroke and the number of lost points.
pub fn carried(
    surface: &PaintSurface<'_>,
    stroke: &Stroke,
    [from, to]: [&StrokePoint; 2],
    turn_degrees: f64,
) -> (Stroke, usize) {
    let radius = f64::from(stroke.brush.bounded().radius);
    // The stroke may be older than the last change of the model.
    let (stroke, lost_before) = relocate(surface, stroke);
    let [Some(from), Some(to)] = [from, to].map(|point| current(surface, point, radius)) else {
        let count = stroke.points.len() + lost_before;
        return (nowhere(stroke), count);
    };
    let (stroke, from, to) = (&stroke, &from, &to);
    let [there, here] = [to, from].map(|point| frame(surface, point));
    let turn = there * DMat3::from_rotation_z(turn_degrees.to_radians()) * here.transpose();
    let mapped = |place: DVec3| to.site.position + turn * (place - from.site.position);
    let vector = |numbers: [f32; 3]| DVec3::from(numbers.map(f64::from));
    let find = |point: &StrokePoint| {
        let (near, far) = (
            TOLERANCE * radius,
            CARRIED * point.site.position.distance(from.site.position),
        );
        let (place, normal) = (mapped(point.site.position), turn * vector(point.normal));
        // Most points are near the surface, and searching far away takes long.
        let found = surface.nearest(place, normal, near);
        found.or_else(|| surface.nearest(place, normal, near + far))
    };
    let (points, path, lost) = match stroke.as_path() {
        Some(path) => {
            let (path, lost) = path.moved(|point| surface.point(find(point)?, turned(point, &turn), point.starts));
            let (points, form) = path.places();
            (points, Some(form), lost)
        }
        None => {
            let (mut points, lost) = moved(surface, &stroke.points, find);
            turn_shafts(&mut points, &turn);
            (points, None, lost)
        }
    };
    let keyed = points
        .iter()
        .filter_map(|point| surface.point(point.site, point.touch(), point.starts));
    let way = DAffine3::from_mat3_translation(turn, to.site.position - turn * from.site.position);
    let eye = stroke.eye.map(|eye| seen_from(eye, &way));
    let stencil = stroke.stencil.as_ref().map(|stencil| Arc::new(stencil.moved(&way)));
    let carried = Stroke {
        points: keyed.collect(),
        path,
        eye,
        stencil,
        ..stroke.clone()
    };
    (carried, lost + lost_before)
}

/// Returns the present position of a point; `None` if it is lost.
fn current(surface: &PaintSurface<'_>, point: &StrokePoint, radius: f64) -> Option<StrokePoint> {
    let site = site_of(surface, point, radius)?;
    surface.point(site, point.touch(), point.starts)
}

/// Returns the touch of the pen at a point that is rotated.
fn turned(point: &StrokePoint, turn: &DMat3) -> Touch {
    Touch {
        shaft: point.shaft.and_then(|shaft| shaft.turned(turn)),
        ..point.touch()
    }
}

/// Rotates the shafts of the pen at points that were moved.
fn turn_shafts(points: &mut [StrokePoint], turn: &DMat3) {
    for point in points {
        point.shaft = turned(point, turn).shaft;
    }
}

/// Returns an eye that is moved together with the model.
fn seen_from(eye: Eye, moved: &DAffine3) -> Eye {
    let vector = |numbers: [f32; 3]| DVec3::from(numbers.map(f64::from));
    match eye {
        Eye::Place(place) => Eye::Place(moved.transform_point3(vector(place)).as_vec3().to_array()),
        Eye::Toward(direction) => Eye::Toward(moved.transform_vector3(vector(direction)).as_vec3().to_array()),
    }
}

/// Returns the stroke without points.
fn nowhere(stroke: Stroke) -> Stroke {
    Stroke {
        points: Vec::new(),
        path: None,
        ..stroke
    }
}

/// Returns the directions at a point: to the right and upward as seen from outside, and away from the surface.
fn frame(surface: &PaintSurface<'_>, point: &StrokePoint) -> DMat3 {
    let normal = surface.smooth_normal_at(point.site);
    let right = rightward(normal);
    DMat3::from_cols(right, normal.cross(right), normal)
}

fn relocate_path(surface: &PaintSurface<'_>, path: &Path, radius: f64) -> (Path, usize) {
    path.moved(|point| current(surface, point, radius))
}

/// Returns the points that a stroke passes on this surface, and the number of its points that are lost.
pub(crate) fn passed(surface: &PaintSurface<'_>, stroke: &Stroke) -> (Vec<StrokePoint>, usize) {
    let radius = f64::from(stroke.brush.bounded().radius);
    let Some(path) = stroke.as_path() else {
        return relocate_points(surface, &stroke.points, radius);
    };
    let (path, lost) = relocate_path(surface, &path, radius);
    (path.way(surface, PATH_STEP * radius), lost)
}

/// Finds the points of a stroke with this radius on this surface, like [`relocate`].
pub(crate) fn relocate_points(
    surface: &PaintSurface<'_>,
    points: &[StrokePoint],
    radius: f64,
) -> (Vec<StrokePoint>, usize) {
    moved(surface, points, |point| site_of(surface, point, radius))
}

/// A stroke, or its copy on another side of the model.
#[derive(Clone)]
pub(crate) struct LocatedStroke {
    pub(crate) points: Vec<StrokePoint>,
    pub(crate) eye: Option<Eye>,
    /// Place that it copies from, if it does.
    pub(crate) source: Option<StrokePoint>,
    /// Transform from the stroke to the copy in model space.
    pub(crate) moved: DAffine3,
    /// True if it is mirrored, so that rotations are reversed.
    pub(crate) is_mirrored: bool,
}

/// Returns the copies of a stroke on the other sides of the model, without the stroke itself. Each point is put on the
/// nearest place that faces the same way, if it is nearer than the radius.
pub(crate) fn copies(
    surface: &PaintSurface<'_>,
    stroke: &LocatedStroke,
    symmetry: Symmetry,
    radius: f64,
) -> Vec<LocatedStroke> {
    let middle = surface.index().middle();
    let copy = |copy: SymmetryCopy| {
        let mapped = |numbers: [f32; 3]| copy.map(DVec3::from(numbers.map(f64::from)));
        let located = |point: &StrokePoint| {
            let position = middle + copy.map(point.site.position - middle);
            surface.nearest(position, mapped(point.normal), TOLERANCE * radius)
        };
        let turn = copy.matrix();
        let (mut points, _) = moved(surface, &stroke.points, located);
        turn_shafts(&mut points, &turn);
        let source = stroke
            .source
            .and_then(|source| moved(surface, &[source], located).0.pop());
        let eye = stroke.eye.map(|eye| match eye {
            Eye::Place(place) => {
                let place = DVec3::from(place.map(f64::from));
                Eye::Place((middle + copy.map(place - middle)).as_vec3().to_array())
            }
            Eye::Toward(direction) => Eye::Toward(mapped(direction).as_vec3().to_array()),
        });
        LocatedStroke {
            points,
            eye,
            source,
            moved: DAffine3::from_mat3_translation(turn, middle - turn * middle),
            is_mirrored: copy.is_mirrored(),
        }
    };
    symmetry.copies().into_iter().map(copy).collect()
}

/// Moves points to other sites. Returns them and the number of points without a site.
fn moved(
    surface: &PaintSurface<'_>,
    points: &[StrokePoint],
    site_of: impl Fn(&StrokePoint) -> Option<Site>,
) -> (Vec<StrokePoint>, usize) {
    let mut found: Vec<StrokePoint> = Vec::with_capacity(points.len());
    let mut lost = 0;
    let mut starts = false;
    for point in points {
        if surface.is_stopped() {
            break;
        }
        starts |= point.starts;
        match site_of(point) {
            Some(site) => {
                let normal = surface.connected().normal(site.triangle).as_vec3().to_array();
                found.push(StrokePoint {
                    site,
                    normal,
                    starts,
                    ..*point
                });
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
    let normal = DVec3::from(point.normal.map(f64::from));
    surface.nearest(point.site.position, normal, TOLERANCE * radius)
}
