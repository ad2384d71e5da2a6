//! A decal that is laid by a drag, which begins at its middle, and turns and sizes it. A click lays it upright on the
//! screen.

use egui::{Pos2, Vec2};
use glam::DVec3;
use sabi_engine::live::LiveModel;
use sabi_paint::{Brush, Eye, StrokePoint, decal_axes};
use sabi_surface::patch::Site;

use super::PaintView;
use crate::settings::brush::BrushChoices;

/// Length of a drag below which it is a click, in points.
const CLICK: f32 = 6.0;
/// Least half of the longer side of a decal that a click sets down, points on the screen.
const LEAST: f32 = 60.0;
/// Distance on the surface that is measured on the screen to find its scale, as a share of the model's largest side.
const PROBE: f64 = 1e-3;

/// A decal under the pointer.
pub(super) struct Decal {
    /// Place of its middle on the screen.
    middle: Pos2,
    /// Vectors on the screen of one model unit to the right and upward, in points; `None` where the view does not show
    /// them.
    axes: Option<[Vec2; 2]>,
    /// Vector of the drag, in points.
    way: Vec2,
}

impl Decal {
    /// A decal whose middle lies at a place of the model.
    pub(super) fn new(model: &LiveModel, canvas: &impl PaintView, placed: &StrokePoint, middle: Pos2) -> Decal {
        Decal {
            axes: axes_on_screen(model, canvas, placed, canvas.eye(model)),
            way: Vec2::ZERO,
            middle,
        }
    }

    /// Follows the pointer.
    pub(super) fn drag(&mut self, pointer: Pos2) {
        self.way = pointer - self.middle;
    }

    /// The brush with the size and the turn of the decal.
    pub(super) fn shape(&self, brush: Brush) -> Brush {
        let Some(axes) = self.axes else { return brush };
        if self.way.length() < CLICK {
            // To the right on the screen.
            let turn = turn_of(axes, Vec2::X).map_or(0.0, |[_, turn]| turn);
            // A brush is often too thin for a picture or a word.
            let scale = axes.map(Vec2::length).into_iter().fold(0.0, f32::max);
            let least = LEAST / scale;
            return Brush {
                radius: if least.is_finite() {
                    brush.radius.max(least)
                } else {
                    brush.radius
                },
                angle_degrees: wrapped(brush.angle_degrees + turn),
                ..brush
            };
        }
        match turn_of(axes, self.way) {
            Some([length, turn]) => Brush {
                radius: length,
                angle_degrees: wrapped(turn),
                ..brush
            },
            None => brush,
        }
    }
}

/// The brush with the size that it has on the screen at a place of the model, if its size is measured there.
pub(super) fn sized(
    brush: &BrushChoices,
    model: &LiveModel,
    canvas: &impl PaintView,
    placed: &StrokePoint,
) -> BrushChoices {
    let axes = axes_on_screen(model, canvas, placed, None).filter(|_| brush.is_on_screen);
    // The longer of both is not shortened by the slant of the surface.
    let scale = axes.map(|[right, up]| right.length().max(up.length()) * model.linked.largest_side as f32);
    match scale.filter(|scale| *scale > 0.0) {
        Some(scale) => BrushChoices {
            size: brush.points / scale,
            ..brush.clone()
        }
        .sanitized(),
        None => brush.clone(),
    }
}

/// Vectors on the screen of one model unit to the right and upward of a decal that is laid with this eye, in points.
pub(super) fn axes_on_screen(
    model: &LiveModel,
    canvas: &impl PaintView,
    placed: &StrokePoint,
    eye: Option<Eye>,
) -> Option<[Vec2; 2]> {
    let normal = DVec3::from(placed.normal.map(f64::from));
    let probe = PROBE * model.linked.largest_side;
    let seen = |offset: DVec3| {
        canvas.place(
            model,
            Site {
                position: placed.site.position + offset,
                ..placed.site
            },
        )
    };
    let middle = seen(DVec3::ZERO)?;
    let axis = |direction: DVec3| Some((seen(probe * direction)? - middle) / probe as f32);
    let [right, up] = decal_axes(placed, normal, eye);
    Some([axis(right)?, axis(up)?])
}

/// Length of a vector on the screen in model units, and its angle from the right in degrees, counterclockwise; `None`
/// where the surface is seen from its edge.
pub(super) fn turn_of([right, up]: [Vec2; 2], way: Vec2) -> Option<[f32; 2]> {
    let cross = |a: Vec2, b: Vec2| a.x * b.y - a.y * b.x;
    let area = cross(right, up);
    let (x, y) = (cross(way, up) / area, cross(right, way) / area);
    let found = [x.hypot(y), y.atan2(x).to_degrees()];
    found.iter().all(|value| value.is_finite()).then_some(found)
}

/// The angle from −180 to 180 degrees.
pub(super) fn wrapped(degrees: f32) -> f32 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use egui::vec2;

    use super::*;

    #[test]
    fn a_drag_gives_the_size_and_the_turn_of_a_decal_in_the_measure_of_the_surface() {
        // The surface leans back: a model unit is 100 points to the right and 50 points upward.
        let axes = [vec2(100.0, 0.0), vec2(0.0, -50.0)];
        assert_eq!(turn_of(axes, vec2(200.0, 0.0)), Some([2.0, 0.0]));
        assert_eq!(turn_of(axes, vec2(0.0, -50.0)), Some([1.0, 90.0]));
        assert_eq!(turn_of([Vec2::X, Vec2::X], Vec2::X), None);
        assert_eq!(wrapped(270.0), -90.0);
    }
}
