//! Curves through points, with slopes that keep them from overshooting.

/// Distance in x below which two points make a step.
const STEP_WIDTH: f64 = 1e-6;

/// Points of a curve with the slopes there (x, y, slope); x has to be ascending.
///
/// The slopes are those of M. Steffen, "A simple method for monotonic interpolation in one dimension", Astronomy and
/// Astrophysics 239 (1990): with them, cubic pieces rise and fall only where the points do. Two points at one x are a
/// step: one curve ends at the first, and another starts at the second.
pub fn with_slopes(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let runs = points.chunk_by(|left, right| right[0] - left[0] >= STEP_WIDTH);
    let slopes = runs.flat_map(slopes);
    points
        .iter()
        .zip(slopes)
        .map(|([x, y], slope)| [*x, *y, slope])
        .collect()
}

/// Value at `x` of a curve from [`with_slopes`]: constant outside of its points, a cubic Hermite segment between two of them, and 0
/// without points.
pub fn value_at(curve: &[[f64; 3]], x: f64) -> f64 {
    let after = curve.partition_point(|point| point[0] <= x);
    let (Some(left), Some(right)) = (curve.get(after.saturating_sub(1)), curve.get(after).or(curve.last())) else {
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

/// Slopes at the points of a run without steps.
fn slopes(run: &[[f64; 2]]) -> Vec<f64> {
    let pieces: Vec<LineSegment> = run
        .windows(2)
        .map(|ends| LineSegment::between(ends[0], ends[1]))
        .collect();
    let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else {
        return vec![0.0; run.len()];
    };
    let inner = pieces.windows(2).map(|sides| inner_slope(sides[0], sides[1]));
    let ends = match pieces.as_slice() {
        [first, second, ..] => {
            let before_last = pieces[pieces.len() - 2];
            [end_slope(*first, *second), end_slope(*last, before_last)]
        }
        _ => [first.slope, last.slope],
    };
    std::iter::once(ends[0])
        .chain(inner)
        .chain(std::iter::once(ends[1]))
        .collect()
}

/// Straight line from a point to the next.
#[derive(Clone, Copy, Debug)]
struct LineSegment {
    width: f64,
    slope: f64,
}

impl LineSegment {
    fn between(left: [f64; 2], right: [f64; 2]) -> LineSegment {
        let width = right[0] - left[0];
        LineSegment {
            width,
            slope: (right[1] - left[1]) / width,
        }
    }
}

/// The slope of the parabola through three points, at the middle one, as far as the curve stays monotonic (Steffen's
/// equation 11).
fn inner_slope(left: LineSegment, right: LineSegment) -> f64 {
    if left.slope * right.slope <= 0.0 {
        return 0.0;
    }
    let parabola = (left.slope * right.width + right.slope * left.width) / (left.width + right.width);
    let steepest = left.slope.abs().min(right.slope.abs()).min(0.5 * parabola.abs());
    2.0 * steepest.copysign(parabola)
}

/// The slope of the parabola through three points, at an outer one, as far as the curve stays monotonic (Steffen's
/// equations 24 to 27).
fn end_slope(own: LineSegment, next: LineSegment) -> f64 {
    let share = own.width / (own.width + next.width);
    let parabola = own.slope * (1.0 + share) - next.slope * share;
    if parabola * own.slope <= 0.0 {
        0.0
    } else {
        parabola.abs().min(2.0 * own.slope.abs()).copysign(own.slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slopes(points: &[[f64; 2]]) -> Vec<f64> {
        with_slopes(points).iter().map(|point| point[2]).collect()
    }

    fn height_at(points: &[[f64; 2]], x: f64) -> f64 {
        value_at(&with_slopes(points), x)
    }

    #[test]
    fn points_on_a_line_have_its_slope() {
        assert_eq!(slopes(&[[0.0, 0.0], [1.0, 1.0]]), [1.0, 1.0]);
        assert_eq!(slopes(&[[0.0, 3.0], [0.25, 2.5], [1.0, 1.0]]), [-2.0; 3]);
    }

    #[test]
    fn a_curve_is_level_where_it_turns_and_where_it_is_held() {
        let found = slopes(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.5], [3.0, 0.5], [4.0, 2.0]]);
        assert_eq!(found[1..4], [0.0; 3]);
    }

    #[test]
    fn no_slope_is_steeper_than_twice_the_flatter_piece() {
        let found = slopes(&[[0.0, 0.0], [1.0, 0.1], [2.0, 10.0], [2.5, 10.1]]);
        // Half of the parabola's slope would be steeper; at the ends it would overshoot to the other side.
        assert_eq!(found[0], 0.0);
        for (slope, flatter) in found[1..3].iter().zip([0.1, 0.2]) {
            assert!((slope - 2.0 * flatter).abs() < 1e-5, "{found:?}");
        }
    }

    #[test]
    fn two_points_at_one_place_are_a_step_between_two_curves() {
        let found = slopes(&[[0.0, 0.0], [0.5, 0.5], [0.5, 1.0], [1.0, 0.0]]);
        assert_eq!(found, [1.0, 1.0, -2.0, -2.0]);
    }

    #[test]
    fn a_curve_goes_through_its_points_and_is_held_outside() {
        let points = [[0.2, 0.1], [0.5, 0.9], [0.8, 0.4]];
        for [x, y] in points {
            assert!((height_at(&points, x) - y).abs() < 1e-6);
        }
        assert!((height_at(&points, 0.0) - 0.1).abs() < 1e-6);
        assert!((height_at(&points, 1.0) - 0.4).abs() < 1e-6);
        assert_eq!(height_at(&[], 0.5), 0.0);
    }

    #[test]
    fn a_line_stays_one_and_a_step_jumps() {
        let line = [[0.0, 0.0], [1.0, 1.0]];
        assert!((height_at(&line, 0.3) - 0.3).abs() < 1e-6);
        let step = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [1.0, 1.0]];
        assert!(height_at(&step, 0.4999).abs() < 1e-6);
        assert!((height_at(&step, 0.5) - 1.0).abs() < 1e-6);
    }
}
