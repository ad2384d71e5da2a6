//! Curves as nodes read them, drawn into a box.

use egui::epaint::{CubicBezierShape, PathStroke};
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke};
use sabi_curve::{value_at, with_slopes};

/// Distance of points below which they make a step.
const STEP_WIDTH: f64 = 1e-6;

/// Part of the plane that a rectangle shows.
#[derive(Clone, Copy, Debug)]
pub(in crate::knobs) struct CurveView {
    pub(in crate::knobs) rect: Rect,
    pub(in crate::knobs) x: [f64; 2],
    pub(in crate::knobs) y: [f64; 2],
}

impl CurveView {
    /// A view of all points and of the usual range.
    pub(in crate::knobs) fn of(rect: Rect, usual: [f64; 2], points: &[[f64; 2]]) -> CurveView {
        let ends = |axis: usize| {
            let all = points.iter().map(|point| point[axis]);
            let [low, high] = all.fold(usual, |[low, high], number| [low.min(number), high.max(number)]);
            if high - low > 1e-9 {
                [low, high]
            } else {
                [low - 0.5, low + 0.5]
            }
        };
        CurveView {
            rect,
            x: ends(0),
            y: ends(1),
        }
    }

    pub(in crate::knobs) fn place(&self, [x, y]: [f64; 2]) -> Pos2 {
        let share = |number: f64, [low, high]: [f64; 2]| ((number - low) / (high - low)) as f32;
        Pos2::new(
            egui::lerp(self.rect.x_range(), share(x, self.x)),
            egui::lerp(self.rect.bottom()..=self.rect.top(), share(y, self.y)),
        )
    }

    pub(in crate::knobs) fn point(&self, place: Pos2) -> [f64; 2] {
        let across = f64::from((place.x - self.rect.left()) / self.rect.width());
        let up = f64::from((self.rect.bottom() - place.y) / self.rect.height());
        let between = |share: f64, [low, high]: [f64; 2]| low + share.clamp(0.0, 1.0) * (high - low);
        [between(across, self.x), between(up, self.y)]
    }

    /// Length along each axis of one point of the screen.
    pub(in crate::knobs) fn scale(&self) -> [f64; 2] {
        [
            (self.x[1] - self.x[0]) / f64::from(self.rect.width()),
            (self.y[1] - self.y[0]) / f64::from(self.rect.height()),
        ]
    }

    /// Draws the curve through points as nodes evaluate it.
    pub(in crate::knobs) fn draw(&self, painter: &Painter, points: &[[f64; 2]], line: Stroke) {
        let read = with_slopes(points);
        let (Some([first_x, first_y, _]), Some([last_x, last_y, _])) = (read.first(), read.last()) else {
            return;
        };
        // Constant before the first point and after the last one.
        let held = [
            [[self.x[0], *first_y], [*first_x, *first_y]],
            [[*last_x, *last_y], [self.x[1], *last_y]],
        ];
        let held = held.map(|ends| Shape::line_segment(ends.map(|end| self.place(end)), line));
        let pieces = read.windows(2).map(|ends| self.piece(ends[0], ends[1], line));
        painter.extend(held.into_iter().chain(pieces));
    }

    /// Cubic with given slopes at its ends, as a Bézier curve.
    fn piece(&self, [x, y, slope]: [f64; 3], [end_x, end_y, end_slope]: [f64; 3], line: Stroke) -> Shape {
        let width = end_x - x;
        if width < STEP_WIDTH {
            return Shape::line_segment([self.place([x, y]), self.place([end_x, end_y])], line);
        }
        let third = width / 3.0;
        let corners = [
            [x, y],
            [x + third, y + slope * third],
            [end_x - third, end_y - end_slope * third],
            [end_x, end_y],
        ];
        let corners = corners.map(|corner| self.place(corner));
        CubicBezierShape::from_points_stroke(corners, false, Color32::TRANSPARENT, PathStroke::from(line)).into()
    }
}

/// Value of the curve through points.
pub(super) fn height_at(points: &[[f64; 2]], x: f64) -> f64 {
    value_at(&with_slopes(points), x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_of_a_curve_is_the_same_after_a_way_to_the_screen_and_back() {
        let rect = Rect::from_min_size(Pos2::new(10.0, 20.0), egui::vec2(200.0, 100.0));
        let view = CurveView::of(rect, [0.0, 1.0], &[[-1.0, 3.0]]);
        let [x, y] = view.point(view.place([0.25, 1.5]));
        assert!((x - 0.25).abs() < 1e-4 && (y - 1.5).abs() < 1e-4);
        assert_eq!((view.x, view.y), ([-1.0, 1.0], [0.0, 3.0]));
    }
}
