//! Curves as nodes read them, drawn into a box.

use egui::epaint::{CubicBezierShape, PathStroke};
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke};
use sabi_engine::catalog::curve_points;

/// Distance of points below which they make a step.
const STEP_WIDTH: f64 = 1e-6;

/// Part of the plane that a rectangle shows.
#[derive(Clone, Copy, Debug)]
pub(in crate::knobs) struct View {
    pub(in crate::knobs) rect: Rect,
    pub(in crate::knobs) x: [f64; 2],
    pub(in crate::knobs) y: [f64; 2],
}

impl View {
    /// A view of all points and of the usual range.
    pub(in crate::knobs) fn of(rect: Rect, usual: [f64; 2], points: &[[f64; 2]]) -> View {
        let ends = |axis: usize| {
            let all = points.iter().map(|point| point[axis]);
            let [low, high] = all.fold(usual, |[low, high], number| [low.min(number), high.max(number)]);
            if high - low > 1e-9 {
                [low, high]
            } else {
                [low - 0.5, low + 0.5]
            }
        };
        View {
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
        let read = slopes(points);
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

/// x, y and slope of each point.
fn slopes(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let singles: Vec<[f32; 2]> = points.iter().map(|point| point.map(|number| number as f32)).collect();
    let read = curve_points(&singles, singles.len());
    let (read, _) = read.as_chunks::<4>();
    read.iter()
        .map(|point| [point[0], point[1], point[2]].map(f64::from))
        .collect()
}

/// Value of the curve: constant outside, a cubic Hermite segment between two points.
pub(super) fn height_at(points: &[[f64; 2]], x: f64) -> f64 {
    let read = slopes(points);
    let after = read.partition_point(|point| point[0] <= x);
    let (Some(left), Some(right)) = (read.get(after.saturating_sub(1)), read.get(after).or(read.last())) else {
        return 0.0;
    };
    let width = right[0] - left[0];
    if width < STEP_WIDTH || x <= left[0] {
        return left[1];
    }
    let step = x - left[0];
    let share = step / width;
    let secant = (right[1] - left[1]) / width;
    let bend = 3.0 * secant - 2.0 * left[2] - right[2];
    let twist = left[2] + right[2] - 2.0 * secant;
    left[1] + step * (left[2] + share * (bend + share * twist))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_through_its_points_and_is_held_outside() {
        let points = [[0.2, 0.1], [0.5, 0.9], [0.8, 0.4]];
        for [x, y] in points {
            assert!((height_at(&points, x) - y).abs() < 1e-6);
        }
        assert!((height_at(&points, 0.0) - 0.1).abs() < 1e-6);
        assert!((height_at(&points, 1.0) - 0.4).abs() < 1e-6);
    }

    #[test]
    fn a_line_stays_one_and_a_step_jumps() {
        let line = [[0.0, 0.0], [1.0, 1.0]];
        assert!((height_at(&line, 0.3) - 0.3).abs() < 1e-6);
        let step = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [1.0, 1.0]];
        assert!(height_at(&step, 0.4999).abs() < 1e-6);
        assert!((height_at(&step, 0.5) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_view_leads_back_to_where_it_came_from() {
        let rect = Rect::from_min_size(Pos2::new(10.0, 20.0), egui::vec2(200.0, 100.0));
        let view = View::of(rect, [0.0, 1.0], &[[-1.0, 3.0]]);
        let [x, y] = view.point(view.place([0.25, 1.5]));
        assert!((x - 0.25).abs() < 1e-4 && (y - 1.5).abs() < 1e-4);
        assert_eq!((view.x, view.y), ([-1.0, 1.0], [0.0, 3.0]));
    }
}
