//! Curves between an exposed knob and the parameters that it sets.

use crate::Value;

/// Maximum number of points of a curve.
const POINT_LIMIT: usize = 64;

/// Curve from the value of an exposed knob to the value of a parameter: straight lines between points, constant before the
/// first point and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct KnobCurve {
    points: Vec<[f64; 2]>,
}

impl KnobCurve {
    /// Creates a curve through points (knob value, parameter value). Returns `None` unless there are 2 to 64 points with
    /// ascending knob values, all of them numbers that a file can hold.
    pub fn new(points: Vec<[f64; 2]>) -> Option<KnobCurve> {
        let points: Option<Vec<[f64; 2]>> = points
            .iter()
            .map(|[knob, value]| Some([crate::canonical_number(*knob)?, crate::canonical_number(*value)?]))
            .collect();
        let points = points.filter(|points| (2..=POINT_LIMIT).contains(&points.len()))?;
        let grows = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        grows.then_some(KnobCurve { points })
    }

    /// Returns the points, each as knob value and parameter value.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Returns the value of the parameter for a value of the knob. Values other than numbers are returned unchanged.
    pub fn apply(&self, knob: &Value) -> Value {
        match knob.as_number() {
            Some(number) => Value::Number(interpolated(self.points.iter().copied(), number)),
            None => knob.clone(),
        }
    }

    /// Returns the knob value that gives a value of the parameter: the first one on the curve, or the nearest end of the curve.
    pub fn invert(&self, value: &Value) -> Value {
        let Some(number) = value.as_number() else {
            return value.clone();
        };
        let crossed = self.points.windows(2).find(|pair| {
            let [low, high] = [pair[0][1].min(pair[1][1]), pair[0][1].max(pair[1][1])];
            (low..=high).contains(&number)
        });
        let knob = match crossed {
            Some([a, b]) if a[1] < b[1] => interpolated([[a[1], a[0]], [b[1], b[0]]].into_iter(), number),
            Some([a, b]) if a[1] > b[1] => interpolated([[b[1], b[0]], [a[1], a[0]]].into_iter(), number),
            Some(flat) => flat[0][0],
            None => {
                let distance = |point: &&[f64; 2]| (point[1] - number).abs();
                let nearest = self.points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
                nearest.map_or(number, |point| point[0])
            }
        };
        Value::Number(knob)
    }

    /// Returns the curve that applies this curve and then `next`. It is exact at the points of this curve.
    pub fn then(&self, next: &KnobCurve) -> KnobCurve {
        let through = |[knob, value]: &[f64; 2]| [*knob, interpolated(next.points.iter().copied(), *value)];
        KnobCurve {
            points: self.points.iter().map(through).collect(),
        }
    }
}

/// Interpolates linearly at `x` between points sorted by their first number.
fn interpolated(points: impl Iterator<Item = [f64; 2]>, x: f64) -> f64 {
    let mut before: Option<[f64; 2]> = None;
    for [at, value] in points {
        if x <= at {
            return match before {
                Some([start, low]) => low + (value - low) * (x - start) / (at - start),
                None => value,
            };
        }
        before = Some([at, value]);
    }
    before.map_or(x, |[_, value]| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[[f64; 2]]) -> KnobCurve {
        KnobCurve::new(points.to_vec()).unwrap()
    }

    #[test]
    fn a_curve_runs_straight_between_its_points_and_flat_outside() {
        let curve = curve(&[[0.0, 10.0], [0.5, 20.0], [1.0, 0.0]]);
        for (knob, value) in [(-1.0, 10.0), (0.25, 15.0), (0.5, 20.0), (0.75, 10.0), (2.0, 0.0)] {
            assert_eq!(curve.apply(&Value::Number(knob)), Value::Number(value));
        }
        assert_eq!(curve.apply(&Value::from("soft")), Value::from("soft"));
    }

    #[test]
    fn a_curve_is_inverted_where_it_first_has_the_value() {
        let curve = curve(&[[0.0, 10.0], [0.5, 20.0], [1.0, 0.0]]);
        for (value, knob) in [(15.0, 0.25), (20.0, 0.5), (5.0, 0.875), (30.0, 0.5), (-3.0, 1.0)] {
            assert_eq!(curve.invert(&Value::Number(value)), Value::Number(knob));
        }
    }

    #[test]
    fn a_curve_needs_two_points_whose_knob_values_grow() {
        for points in [
            vec![],
            vec![[0.0, 1.0]],
            vec![[0.0, 1.0], [0.0, 2.0]],
            vec![[0.0, 1.0], [f64::NAN, 2.0]],
        ] {
            assert_eq!(KnobCurve::new(points), None);
        }
    }

    #[test]
    fn curves_one_after_the_other_are_one_curve() {
        let both = curve(&[[0.0, 0.0], [1.0, 2.0]]).then(&curve(&[[0.0, 5.0], [2.0, 9.0]]));
        assert_eq!(both.points(), [[0.0, 5.0], [1.0, 9.0]]);
    }
}
