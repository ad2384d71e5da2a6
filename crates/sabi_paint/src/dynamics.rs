//! Random differences within a stroke.

use serde::{Deserialize, Serialize};

/// Random differences between the stamps of a stroke, the same each time it is painted. Differences of the color are not
/// written to files if they are 0, so that strokes from before they existed keep the names of their versions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Jitter {
    /// Distance from the way, as a share of the radius.
    pub place: f32,
    /// Largest reduction of a stamp's size, as a share of the radius.
    pub size: f32,
    /// Largest rotation to either side in degrees.
    pub angle_degrees: f32,
    /// Largest reduction of a stamp's strength, as a share of the strength.
    pub flow: f32,
    /// Largest change of the hue to either side, as a share of the whole circle.
    #[serde(skip_serializing_if = "is_none")]
    pub hue: f32,
    /// Largest change of the saturation to either side, as a share of its range.
    #[serde(skip_serializing_if = "is_none")]
    pub saturation: f32,
    /// Largest change of the value to either side, as a share of its range.
    #[serde(skip_serializing_if = "is_none")]
    pub value: f32,
}

fn is_none(share: &f32) -> bool {
    *share == 0.0
}

impl Jitter {
    /// Returns the differences with every number in its range. NaN becomes 0.
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

    /// Returns true if stamps differ in color.
    pub(crate) fn changes_color(&self) -> bool {
        self.hue > 0.0 || self.saturation > 0.0 || self.value > 0.0
    }

    /// Returns a linear color, changed by three random numbers from −1 to 1.
    pub(crate) fn color(&self, color: [f32; 3], [hue, saturation, value]: [f64; 3]) -> [f32; 3] {
        let [own_hue, own_saturation, own_value] = hsv(color.map(f64::from));
        let changed = |own: f64, most: f32, number: f64| (own + f64::from(most) * number * own).clamp(0.0, 1.0);
        let hue = (own_hue + f64::from(self.hue) * hue).rem_euclid(1.0);
        let saturation = changed(own_saturation, self.saturation, saturation);
        let value = changed(own_value, self.value, value);
        from_hsv([hue, saturation, value]).map(|channel| channel as f32)
    }
}

/// Returns hue as a share of the circle, saturation and value of a color (Smith, "Color gamut transform pairs", 1978).
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_color_converted_to_hue_saturation_and_value_and_back_is_the_same() {
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
    fn differences_of_zero_are_not_written_to_files() {
        let text = serde_json::to_string(&Jitter::default()).unwrap();
        assert_eq!(text, r#"{"place":0.0,"size":0.0,"angle_degrees":0.0,"flow":0.0}"#);
    }
}
