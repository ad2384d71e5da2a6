//! Ways in which a brush fades toward its border.

use sabi_curve::{value_at, with_slopes};
use serde::{Deserialize, Serialize};

/// Resolution of the numbers of a curve: steps from 0 to 1.
const STEPS: f64 = 1000.0;

/// Way in which a brush fades from its hard part to its border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fade {
    /// Softly at both ends.
    #[default]
    Smooth,
    /// Linearly, as a cone.
    Linear,
    /// Slowly at first, as a dome.
    Round,
    /// Quickly at first, as a spike.
    Sharp,
    /// As the artist has drawn it.
    Curve(FadeCurve),
}

impl Fade {
    /// All ways except curves, with their titles.
    pub const ALL: [(Fade, &'static str); 4] = [
        (Fade::Smooth, "Smooth"),
        (Fade::Linear, "Cone"),
        (Fade::Round, "Dome"),
        (Fade::Sharp, "Spike"),
    ];

    pub(crate) fn is_usual(&self) -> bool {
        *self == Fade::Smooth
    }

    /// Returns the fade as a curve. For the other ways, the curve is an approximation.
    pub fn curve(&self) -> FadeCurve {
        match self {
            Fade::Curve(curve) => *curve,
            fade => FadeCurve::new([0.0, 0.25, 0.5, 0.75, 0.95, 1.0].map(|x| [x, fade.at(1.0 - x)])),
        }
    }

    /// Returns the strength at a share of the way from the border (0) to the hard part (1).
    pub(crate) fn at(&self, share: f64) -> f64 {
        match self {
            Fade::Smooth => share * share * (3.0 - 2.0 * share),
            Fade::Linear => share,
            Fade::Round => (share * (2.0 - share)).sqrt(),
            Fade::Sharp => share * share * share,
            Fade::Curve(curve) => curve.at(1.0 - share),
        }
    }

    /// Returns true if the strength at the border is above 0, so that the brush ends abruptly.
    pub(crate) fn is_cut(&self) -> bool {
        matches!(self, Fade::Curve(curve) if curve.at(1.0) > 0.0)
    }
}

/// Curve of the strength over the way from the hard part of a brush (0) to its border (1). It never overshoots its points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct FadeCurve {
    count: usize,
    /// Position, strength and slope of each point.
    points: [[f64; 3]; FadeCurve::ROOM],
}

impl FadeCurve {
    /// Maximum number of points of a curve.
    pub const ROOM: usize = 8;

    /// Creates the curve through points of position and strength, in any order. Numbers are rounded to thousandths from 0
    /// to 1. Points with NaN, and points beyond the maximum number, are left out. Without points, the curve is a line.
    pub fn new(points: impl IntoIterator<Item = [f64; 2]>) -> FadeCurve {
        let numbers = points
            .into_iter()
            .filter(|point| point.iter().all(|number| number.is_finite()));
        let bounded = numbers.map(|point| point.map(|number| (number.clamp(0.0, 1.0) * STEPS).round() / STEPS));
        let mut kept: Vec<[f64; 2]> = bounded.take(FadeCurve::ROOM).collect();
        if kept.is_empty() {
            kept = vec![[0.0, 1.0], [1.0, 0.0]];
        }
        kept.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let mut points = [[0.0; 3]; FadeCurve::ROOM];
        for (point, known) in points.iter_mut().zip(with_slopes(&kept)) {
            *point = known;
        }
        let count = kept.len();
        FadeCurve { count, points }
    }

    /// Returns its points, each with its strength, sorted by position.
    pub fn points(&self) -> Vec<[f64; 2]> {
        self.used().iter().map(|[way, strength, _]| [*way, *strength]).collect()
    }

    fn used(&self) -> &[[f64; 3]] {
        &self.points[..self.count]
    }

    /// Returns the strength at a share of the way to the border.
    fn at(&self, way: f64) -> f64 {
        value_at(self.used(), way).clamp(0.0, 1.0)
    }
}

impl From<Vec<[f64; 2]>> for FadeCurve {
    fn from(points: Vec<[f64; 2]>) -> FadeCurve {
        FadeCurve::new(points)
    }
}

impl From<FadeCurve> for Vec<[f64; 2]> {
    fn from(curve: FadeCurve) -> Vec<[f64; 2]> {
        curve.points()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fades_lead_from_zero_to_one_and_differ_in_between() {
        for (fade, name) in Fade::ALL {
            assert_eq!([fade.at(0.0), fade.at(1.0)], [0.0, 1.0], "{name}");
            assert!(!fade.is_cut(), "{name}");
        }
        let middle = Fade::ALL.map(|(fade, _)| fade.at(0.25));
        assert!(
            middle[2] > middle[1] && middle[1] > middle[0] && middle[0] > middle[3],
            "{middle:?}"
        );
    }

    #[test]
    fn a_drawn_curve_starts_as_the_fade_that_it_replaces() {
        for (fade, name) in Fade::ALL {
            let drawn = Fade::Curve(fade.curve());
            assert_eq!([drawn.at(0.0), drawn.at(1.0)], [0.0, 1.0], "{name}");
            assert!(
                (0..=20).all(|step| (drawn.at(f64::from(step) / 20.0) - fade.at(f64::from(step) / 20.0)).abs() < 0.1),
                "{name}"
            );
            assert_eq!(drawn.curve(), fade.curve(), "{name}");
        }
    }

    #[test]
    fn a_curve_leads_from_the_hard_part_to_the_border_and_may_end_abruptly() {
        let fade = Fade::Curve(FadeCurve::new([[0.0, 0.2], [0.5, 1.0], [1.0, 0.4]]));
        assert_eq!([fade.at(1.0), fade.at(0.5), fade.at(0.0)], [0.2, 1.0, 0.4]);
        assert!(fade.is_cut());
    }

    #[test]
    fn earlier_fades_are_written_as_before_and_a_curve_as_its_points() {
        for (fade, text) in [
            (Fade::Linear, r#""linear""#),
            (
                Fade::Curve(FadeCurve::new([[1.0, 0.0], [0.0, 1.0], [0.25, 0.5]])),
                r#"{"curve":[[0.0,1.0],[0.25,0.5],[1.0,0.0]]}"#,
            ),
        ] {
            assert_eq!(serde_json::to_string(&fade).unwrap(), text);
            assert_eq!(serde_json::from_str::<Fade>(text).unwrap(), fade);
        }
    }

    #[test]
    fn a_forged_curve_is_bounded_when_it_is_read() {
        let many: Vec<[f64; 2]> = (0..100_000).map(|index| [f64::from(index), -7.0]).collect();
        for points in [
            many,
            vec![],
            vec![[f64::NAN, 0.5], [0.5, f64::INFINITY]],
            vec![[1e300, -1e300]],
        ] {
            let curve = FadeCurve::from(points);
            let read = curve.points();
            assert!(!read.is_empty() && read.len() <= FadeCurve::ROOM);
            assert!(read.as_flattened().iter().all(|number| (0.0..=1.0).contains(number)));
            assert!((0..=10).all(|step| (0.0..=1.0).contains(&curve.at(f64::from(step) / 10.0))));
        }
        assert_eq!(FadeCurve::from(Vec::new()).points(), [[0.0, 1.0], [1.0, 0.0]]);
    }
}
