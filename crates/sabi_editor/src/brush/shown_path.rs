//! A path on the screen: its line, its knots and their handles.

use egui::{Color32, Painter, Pos2, Rect, StrokeKind, Vec2};
use glam::DVec3;
use sabi_engine::live::LiveModel;
use sabi_paint::{Bend, Path, Stroke, StrokePoint, relocate};

use super::PaintView;
use super::under::on_surface;

/// Distance from the middle of a handle within which it is taken, points.
const NEAR: f32 = 9.0;
/// Distance from the line of a path within which a press inserts a knot, in points.
const NEAR_WAY: f32 = 6.0;
/// Distance between a knot and the visible surface there from which on the knot is hidden, as a share of the model's
/// largest side.
const HIDDEN: f64 = 0.01;
/// Distance between two drawn points of a path, as a share of the model's largest side.
const STEP: f64 = 0.01;
/// Most points of a path that are drawn.
const SHOWN_LIMIT: f64 = 2000.0;

/// A path of a stroke on the screen.
pub(crate) struct ShownPath {
    pub(super) path: Path,
    /// Knots of the path with their handles; `None` for knots that are not seen.
    knots: Vec<Option<ShownKnot>>,
    /// Drawn points of the line between two knots, for each such pair.
    spans: Vec<Vec<ShownPlace>>,
}

/// Point of the line on the screen.
#[derive(Clone, Copy)]
struct ShownPlace {
    at: Pos2,
    /// True if the surface there faces the eye.
    is_front: bool,
    /// True if the view shows the line from the point before to this one.
    is_joined: bool,
}

/// A knot on the screen.
#[derive(Clone, Copy)]
struct ShownKnot {
    place: Pos2,
    is_corner: bool,
    /// Handles before and behind it, where it has any.
    handles: Option<[Pos2; 2]>,
}

/// Part of a path that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathPart {
    Knot(usize),
    /// The handle before or behind a knot.
    Handle(usize, usize),
    /// Both handles, pulled out of a knot.
    Pull(usize),
}

impl ShownPath {
    /// A path as a view shows it; `None` for other strokes.
    pub(crate) fn of(model: &LiveModel, canvas: &impl PaintView, stroke: &Stroke) -> Option<ShownPath> {
        on_surface(model, |surface| {
            let path = relocate(surface, stroke).0.as_path()?;
            let knots = (0..path.knots.len()).map(|index| shown_knot(model, canvas, &path, index));
            let step = step_of(model, &path);
            let spans = (0..path.span_count()).map(|index| {
                let places = path.span(surface, index, step);
                let mut before = None;
                let seen = places.iter().filter_map(|place| {
                    let from = before.replace(place.site);
                    Some(ShownPlace {
                        at: canvas.place(model, place.site)?,
                        is_front: is_toward(model, canvas, place),
                        is_joined: from.is_some_and(|from| canvas.joins(model, [from, place.site])),
                    })
                });
                seen.collect()
            });
            Some(ShownPath {
                knots: knots.collect(),
                spans: spans.collect(),
                path,
            })
        })
    }

    /// The part under a place of the screen: handles lie over knots.
    pub(super) fn part_at(&self, at: Pos2) -> Option<(PathPart, Vec2)> {
        let seen = || {
            self.knots
                .iter()
                .enumerate()
                .filter_map(|(index, knot)| Some((index, (*knot)?)))
        };
        let handles = seen().flat_map(|(index, knot)| {
            let handles = knot.handles.into_iter().flatten().enumerate();
            handles.map(move |(side, place)| (PathPart::Handle(index, side), place))
        });
        let knots = seen().map(|(index, knot)| (PathPart::Knot(index), knot.place));
        let mut parts = handles.chain(knots);
        let near = parts.find(|(_, place)| place.distance(at) <= NEAR)?;
        Some((near.0, near.1 - at))
    }

    /// Index of the pair of knots between which the line is under a place of the screen.
    pub(super) fn span_at(&self, at: Pos2) -> Option<usize> {
        self.spans.iter().position(|span| {
            span.windows(2).any(|pair| {
                let (from, way) = (pair[0].at, pair[1].at - pair[0].at);
                let share = ((at - from).dot(way) / way.length_sq().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
                let is_seen = pair[0].is_front && pair[1].is_joined;
                is_seen && at.distance(from + share * way) <= NEAR_WAY
            })
        })
    }

    /// Draws the path: faint where the surface faces away.
    pub(crate) fn show(&self, painter: &Painter, accent: Color32) {
        for span in &self.spans {
            for pair in span.windows(2).filter(|pair| pair[1].is_joined) {
                let share = if pair[0].is_front { 1.0 } else { 0.25 };
                for (width, color) in [(3.0, Color32::from_black_alpha(110)), (1.4, accent)] {
                    let line = egui::Stroke::new(width, color.gamma_multiply(share));
                    painter.line_segment([pair[0].at, pair[1].at], line);
                }
            }
        }
        let ring = egui::Stroke::new(1.5, Color32::WHITE);
        for knot in self.knots.iter().flatten() {
            for handle in knot.handles.into_iter().flatten() {
                painter.line_segment([knot.place, handle], egui::Stroke::new(1.0, Color32::WHITE));
                painter.circle(handle, 3.5, accent, ring);
            }
            if knot.is_corner {
                let square = Rect::from_center_size(knot.place, Vec2::splat(8.0));
                painter.rect(square, 0.0, accent, ring, StrokeKind::Middle);
            } else {
                painter.circle(knot.place, 4.5, accent, ring);
            }
        }
    }
}

fn shown_knot(model: &LiveModel, canvas: &impl PaintView, path: &Path, index: usize) -> Option<ShownKnot> {
    let knot = &path.knots[index];
    let place = canvas.place(model, knot.place.site)?;
    let seen = canvas.site(model, place)?;
    if seen.position.distance(knot.place.site.position) > HIDDEN * model.linked.largest_side {
        return None;
    }
    let handles = match &knot.bend {
        Bend::Handles([before, behind]) => Some([canvas.place(model, before.site)?, canvas.place(model, behind.site)?]),
        Bend::Smooth | Bend::Corner => None,
    };
    Some(ShownKnot {
        place,
        is_corner: knot.bend == Bend::Corner,
        handles,
    })
}

/// Distance between two drawn points of a path, in model units.
fn step_of(model: &LiveModel, path: &Path) -> f64 {
    let knots = path.knots.windows(2);
    let length: f64 = knots
        .map(|pair| pair[0].place.site.position.distance(pair[1].place.site.position))
        .sum();
    (STEP * model.linked.largest_side).max(length / SHOWN_LIMIT)
}

/// Returns true if the surface faces the eye at a place; in a view of the texture it always does.
fn is_toward(model: &LiveModel, canvas: &impl PaintView, point: &StrokePoint) -> bool {
    let normal = DVec3::from(point.normal.map(f64::from));
    canvas
        .eye(model)
        .is_none_or(|eye| eye.way_from(point.site.position).dot(normal) > 0.0)
}
