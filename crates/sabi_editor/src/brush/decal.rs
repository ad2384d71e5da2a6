//! A decal that is dragged out: set down where the drag begins, upright on the screen, and turned and sized by its way.

use egui::{Pos2, Vec2};
use glam::DVec3;
use sabi_engine::live::LiveModel;
use sabi_paint::{Brush, StrokePoint, rightward};
use sabi_surface::patch::Site;

use super::Canvas;
use crate::settings::brush::BrushChoices;

/// Way of a drag below which it is a click, points.
const CLICK: f32 = 6.0;
/// Way on the surface by which the scale of the screen is found, as a share of the model's largest side.
const PROBE: f64 = 1e-3;

/// A decal under the pointer.
pub(super) struct Decal {
    /// Place of its middle on the screen.
    middle: Pos2,
    /// Ways on the screen for one model unit to its right and upward; none where the view does not show them.
    axes: Option<[Vec2; 2]>,
    /// Way of the drag.
    way: Vec2,
}

impl Decal {
    /// A decal whose middle lies at a place of the model.
    pub(super) fn new(model: &LiveModel, canvas: &impl Canvas, placed: &StrokePoint, middle: Pos2) -> Decal {
        Decal {
            axes: axes_on_screen(model, canvas, placed),
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
            return Brush {
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
    canvas: &impl Canvas,
    placed: &StrokePoint,
) -> BrushChoices {
    let axes = axes_on_screen(model, canvas, placed).filter(|_| brush.is_on_screen);
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

/// Ways on the screen for one model unit to the right and upward of a decal.
pub(super) fn axes_on_screen(model: &LiveModel, canvas: &impl Canvas, placed: &StrokePoint) -> Option<[Vec2; 2]> {
    let normal = DVec3::from(placed.normal.map(f64::from));
    let right = rightward(normal);
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
    Some([axis(right)?, axis(normal.cross(right))?])
}

/// Length of a way on the screen in model units, and its turn from the right, degrees counter-clockwise; none where the surface is
/// seen from its edge.
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
