//! Differences within a stroke: how a stamp fades, what is random, and what the pressure of a pen changes.

use serde::{Deserialize, Serialize};

/// Way in which a brush fades from its hard part to its border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fade {
    /// Softly at both ends.
    #[default]
    Smooth,
    /// Evenly, as a cone.
    Linear,
    /// Slowly first, as a dome.
    Round,
    /// At once, as a spike.
    Sharp,
}

impl Fade {
    /// All of them with their titles.
    pub const ALL: [(Fade, &'static str); 4] = [
        (Fade::Smooth, "Smooth"),
        (Fade::Linear, "Cone"),
        (Fade::Round, "Dome"),
        (Fade::Sharp, "Spike"),
    ];

    pub(crate) fn is_usual(&self) -> bool {
        *self == Fade::Smooth
    }

    /// Strength at a share of the way from the border, 0, to the hard part, 1.
    pub(crate) fn at(self, share: f64) -> f64 {
        match self {
            Fade::Smooth => share * share * (3.0 - 2.0 * share),
            Fade::Linear => share,
            Fade::Round => (share * (2.0 - share)).sqrt(),
            Fade::Sharp => share * share * share,
        }
    }
}

/// Random differences between the stamps of a stroke, the same each time it is drawn. Those of the color are left out of files where
/// they are 0, so that strokes from before they were there keep the names of their versions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Jitter {
    /// Distance from the way, as a share of the radius.
    pub place: f32,
    /// Share of the radius that a stamp may be smaller.
    pub size: f32,
    /// Largest turn to either side, degrees.
    pub angle_degrees: f32,
    /// Share of the strength that a stamp may be fainter.
    pub flow: f32,
    /// Largest change of the hue to either side, as a share of the whole circle.
    #[serde(skip_serializing_if = "is_none")]
    pub hue: f32,
    /// Largest change of the saturation and of the value to either side, as a share of all of it.
    #[serde(skip_serializing_if = "is_none")]
    pub saturation: f32,
    /// As for the saturation.
    #[serde(skip_serializing_if = "is_none")]
    pub value: f32,
}

fn is_none(share: &f32) -> bool {
    *share == 0.0
}

impl Jitter {
    /// The differences with every number in its range; those that are none become 0.
    pub(crate) fn bounded(&self) -> Jitter {
        let within = |value: f32, most: f32| if value.is_finite() { value.clamp(0.0, most) } else { 0.0 };
        Jitter {
            place: within(self.place, 4.0),
            size: within(self.size, 1.0),
            angle_degrees: within(self.angle_degrees, 180.0),
            flow: within(self.flow, 1.0),
            hue: within(self.hue, 0.5),
            saturation: within(self.saturation, 1.0),
            value: within(self.value, 1.0),
        }
    }

    /// True if stamps differ in color.
    pub(crate) fn changes_color(&self) -> bool {
        self.hue > 0.0 || self.saturation > 0.0 || self.value > 0.0
    }

    /// A linear color, changed by three random numbers from −1 to 1.
    pub(crate) fn color(&self, color: [f32; 3], [hue, saturation, value]: [f64; 3]) -> [f32; 3] {
        let [own_hue, own_saturation, own_value] = hsv(color.map(f64::from));
        let changed = |own: f64, most: f32, number: f64| (own + f64::from(most) * number * own).clamp(0.0, 1.0);
        let hue = (own_hue + f64::from(self.hue) * hue).rem_euclid(1.0);
        let saturation = changed(own_saturation, self.saturation, saturation);
        let value = changed(own_value, self.value, value);
        from_hsv([hue, saturation, value]).map(|channel| channel as f32)
    }
}

/// Hue as a share of the circle, saturation and value of a color (Smith, "Color gamut transform pairs", 1978).
fn hsv([red, green, blue]: [f64; 3]) -> [f64; 3] {
    let (most, least) = (red.max(green).max(blue), red.min(green).min(blue));
    let range = most - least;
    if range <= 0.0 {
        return [0.0, 0.0, most];
    }
    let hue = if most == red {
        (green - blue) / range
    } else if most == green {
        2.0 + (blue - red) / range
    } else {
        4.0 + (red - green) / range
    };
    [(hue / 6.0).rem_euclid(1.0), range / most, most]
}

fn from_hsv([hue, saturation, value]: [f64; 3]) -> [f64; 3] {
    [5.0, 3.0, 1.0].map(|offset| {
        let k = (offset + 6.0 * hue) % 6.0;
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    })
}

/// Usual bend of the curve between pressure and its effect: none.
const STRAIGHT: f32 = 0.5;

/// What the pressure of a pen changes: 0 not at all, 1 in proportion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Pressure {
    /// The radius.
    pub radius: f32,
    /// The strength.
    pub flow: f32,
    /// The distance of stamps from the way. Left out of files where it is 0.
    #[serde(skip_serializing_if = "is_none")]
    pub scatter: f32,
    /// The hardness: a light touch is softer. Left out of files where it is 0.
    #[serde(skip_serializing_if = "is_none")]
    pub hardness: f32,
    /// Bend of the curve between pressure and effect: 0.5 is straight, more has a light touch count more, less a heavy one. Left out of
    /// files where it is straight.
    #[serde(skip_serializing_if = "is_straight")]
    pub bend: f32,
}

fn is_straight(bend: &f32) -> bool {
    *bend == STRAIGHT
}

impl Default for Pressure {
    fn default() -> Pressure {
        Pressure {
            radius: 0.0,
            flow: 1.0,
            scatter: 0.0,
            hardness: 0.0,
            bend: STRAIGHT,
        }
    }
}

impl Pressure {
    /// Every number in its range; those that are none become usual ones.
    pub(crate) fn bounded(&self) -> Pressure {
        let usual = Pressure::default();
        let within = |value: f32, usual: f32, [low, high]: [f32; 2]| match value.is_finite() {
            true => value.clamp(low, high),
            false => usual,
        };
        Pressure {
            radius: within(self.radius, usual.radius, [0.0, 1.0]),
            flow: within(self.flow, usual.flow, [0.0, 1.0]),
            scatter: within(self.scatter, usual.scatter, [0.0, 1.0]),
            hardness: within(self.hardness, usual.hardness, [0.0, 1.0]),
            bend: within(self.bend, usual.bend, [0.05, 0.95]),
        }
    }

    /// Effect of a pressure, both 0 to 1 (the bias of Schlick, "Fast alternatives to Perlin's bias and gain functions", 1994).
    pub fn effect(&self, pressure: f32) -> f64 {
        let (pressure, bend) = (f64::from(pressure.clamp(0.0, 1.0)), f64::from(self.bend));
        pressure / ((1.0 / bend - 2.0) * (1.0 - pressure) + 1.0)
    }

    /// Share that is left of a value which the pressure changes by an amount.
    pub(crate) fn share(&self, amount: f32, pressure: f32) -> f64 {
        (1.0 - f64::from(amount) * (1.0 - self.effect(pressure))).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fades_lead_from_nothing_to_all_and_differ_in_between() {
        for (fade, name) in Fade::ALL {
            assert_eq!([fade.at(0.0), fade.at(1.0)], [0.0, 1.0], "{name}");
        }
        let middle = Fade::ALL.map(|(fade, _)| fade.at(0.25));
        assert!(
            middle[2] > middle[1] && middle[1] > middle[0] && middle[0] > middle[3],
            "{middle:?}"
        );
    }

    #[test]
    fn the_curve_of_a_pen_is_straight_unless_it_is_bent() {
        let straight = Pressure::default();
        assert!((0..=10).all(|tenth| (straight.effect(tenth as f32 / 10.0) - f64::from(tenth) / 10.0).abs() < 1e-6));
        let light = Pressure { bend: 0.8, ..straight };
        assert!((light.effect(0.5) - 0.8).abs() < 1e-6, "{}", light.effect(0.5));
        assert_eq!([light.effect(0.0), light.effect(1.0)], [0.0, 1.0]);
    }

    #[test]
    fn a_color_comes_back_from_hue_saturation_and_value() {
        for color in [
            [0.2, 0.5, 0.9],
            [0.9, 0.1, 0.1],
            [0.3, 0.3, 0.3],
            [0.0, 0.0, 0.0],
            [0.4, 0.8, 0.2],
        ] {
            let back = from_hsv(hsv(color));
            assert!(
                color.iter().zip(back).all(|(one, other)| (one - other).abs() < 1e-12),
                "{color:?} {back:?}"
            );
        }
        let third = Jitter {
            hue: 1.0 / 3.0,
            ..Jitter::default()
        };
        let turned = third.color([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert!((turned[1] - 1.0).abs() < 1e-6 && turned[0] < 1e-6, "{turned:?}");
    }

    #[test]
    fn what_is_as_before_is_left_out_of_files() {
        let text = serde_json::to_string(&(Jitter::default(), Pressure::default())).unwrap();
        assert_eq!(
            text,
            r#"[{"place":0.0,"size":0.0,"angle_degrees":0.0,"flow":0.0},{"radius":0.0,"flow":1.0}]"#
        );
    }
}
