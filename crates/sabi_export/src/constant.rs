//! Constant channels: a number in the report instead of a map.

use std::fmt;

use rayon::prelude::*;
use sabi_color::srgb_from_linear;
use schemars::JsonSchema;
use serde::Serialize;

use crate::layout::{Cover, SetLayout};
use crate::{Channel, ChannelPixels};

/// The value of a constant channel, linear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ConstantValue {
    /// Value of a channel with one component.
    Number(f32),
    /// Value of a color or a normal.
    Triple([f32; 3]),
}

impl ConstantValue {
    /// The neutral value of a channel.
    pub(crate) fn neutral(channel: &Channel) -> ConstantValue {
        match *channel.neutral() {
            [x, y, z] => ConstantValue::Triple([x, y, z]),
            // A channel has at least one component.
            ref other => ConstantValue::Number(other[0]),
        }
    }

    /// A component of it; a number is the same in all.
    pub(crate) fn component(self, index: usize) -> f32 {
        match self {
            ConstantValue::Number(number) => number,
            // Values have at most three components.
            ConstantValue::Triple(values) => values[index.min(2)],
        }
    }
}

impl fmt::Display for ConstantValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConstantValue::Number(number) => write!(f, "{number}"),
            ConstantValue::Triple([x, y, z]) => write!(f, "{x}, {y}, {z}"),
        }
    }
}

/// Lowest and highest value of each component.
pub(crate) type Bounds = ([f32; 3], [f32; 3]);

/// Bounds of a channel's pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Survey {
    /// Bounds over the owned pixels; `None` if there are none.
    pub(crate) bounds: Option<Bounds>,
    /// Number of values that were NaN or infinite.
    pub(crate) not_finite: u64,
}

const NOTHING: Bounds = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
/// Pixels of one parallel task.
const PART: usize = 1 << 14;

/// Replaces values that are not finite by the channel's neutral value, and finds the bounds.
pub(crate) fn survey(channel: &Channel, layout: &SetLayout, pixels: &mut ChannelPixels) -> Survey {
    match channel.neutral() {
        [neutral] => survey_of([*neutral], layout, &mut pixels.data),
        [x, y, z] => survey_of([*x, *y, *z], layout, &mut pixels.data),
        _ => Survey {
            bounds: None,
            not_finite: 0,
        },
    }
}

fn survey_of<const N: usize>(neutral: [f32; N], layout: &SetLayout, data: &mut [f32]) -> Survey {
    let parts = data.par_chunks_mut(PART * N).zip(layout.cover.par_chunks(PART));
    let part = |(data, cover): (&mut [f32], &[Cover])| {
        let mut not_finite = 0;
        let (mut low, mut high) = NOTHING;
        for (values, &cover) in data.as_chunks_mut::<N>().0.iter_mut().zip(cover) {
            for (at, value) in values.iter_mut().enumerate() {
                if !value.is_finite() {
                    *value = neutral[at];
                    not_finite += 1;
                }
                if cover == Cover::Owned {
                    low[at] = low[at].min(*value);
                    high[at] = high[at].max(*value);
                }
            }
        }
        (low, high, not_finite)
    };
    let each = |pick: fn(f32, f32) -> f32, a: [f32; 3], b: [f32; 3]| std::array::from_fn(|at| pick(a[at], b[at]));
    let join = |a: ([f32; 3], [f32; 3], u64), b: ([f32; 3], [f32; 3], u64)| {
        (each(f32::min, a.0, b.0), each(f32::max, a.1, b.1), a.2 + b.2)
    };
    let (low, high, not_finite) = parts.map(part).reduce(|| (NOTHING.0, NOTHING.1, 0), join);
    Survey {
        bounds: (low[0] <= high[0]).then_some((low, high)),
        not_finite,
    }
}

/// Returns the value of a channel whose owned pixels all are within half a step of its file's precision. Of normals, only
/// the flat one counts. A set without owned pixels has the neutral value.
pub(crate) fn constant_value(channel: &Channel, bounds: Option<Bounds>) -> Option<ConstantValue> {
    let Some((low, high)) = bounds else {
        return Some(ConstantValue::neutral(channel));
    };
    let components = channel.components();
    let same = (0..components).all(|index| is_same(channel, index, low[index], high[index], high));
    let middle = |index: usize| {
        if low[index] == high[index] {
            low[index]
        } else {
            low[index] + (high[index] - low[index]) / 2.0
        }
    };
    let value = |index: usize| match channel {
        Channel::Height | Channel::Mask(_) | Channel::Vector(_) | Channel::Normal | Channel::Anisotropy => {
            middle(index)
        }
        Channel::Mesh(map) if !map.is_color() => middle(index),
        // All other channels were stored as half floats.
        _ => shortest_near(middle(index)),
    };
    match (same, channel, components) {
        (false, ..) => None,
        (true, Channel::Normal, _) => Some(ConstantValue::Triple([0.0, 0.0, 1.0])),
        (true, _, 3) => Some(ConstantValue::Triple(std::array::from_fn(value))),
        _ => Some(ConstantValue::Number(value(0))),
    }
}

/// Returns the decimal number with the fewest digits within one step of a half float. Drivers may round either way when
/// they store a half float, so 0.7 may be read back as 0.69970703 or 0.70019531, and both mean 0.7.
fn shortest_near(value: f32) -> f32 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    // A half float has 10 bits after the leading one. Below 2⁻¹⁴ the steps do not get smaller.
    let step = 2.0_f64.powi((f64::from(value).abs().log2().floor() as i32).max(-14) - 10);
    let decimal = |digits: usize| format!("{value:.digits$e}").parse::<f32>().ok();
    let near = |short: &f32| (f64::from(*short) - f64::from(value)).abs() <= step && *short != 0.0;
    // If no short number is near, the exact value is used.
    (0..8).filter_map(decimal).find(near).unwrap_or(value)
}

fn is_same(channel: &Channel, component: usize, low: f32, high: f32, all_high: [f32; 3]) -> bool {
    let in_unit = |value: f32| value.clamp(0.0, 1.0);
    let spread = match channel {
        Channel::Normal => {
            let flat = channel.neutral()[component];
            let step = 2.0 / 65535.0;
            return (low - flat).abs() <= step / 2.0 && (high - flat).abs() <= step / 2.0;
        }
        // Files may contain floats, so only rounding differences are ignored.
        Channel::Height | Channel::Vector(_) => return is_same_float(low, high),
        Channel::Mesh(map) if !map.is_color() => return is_same_float(low, high),
        Channel::Emission | Channel::Color(_) if all_high.iter().any(|&value| value > 1.0) => {
            return high - low <= high.abs().max(low.abs()) / 2048.0;
        }
        color if color.is_color() => srgb_from_linear(in_unit(high)) - srgb_from_linear(in_unit(low)),
        Channel::Mask(_) => return in_unit(high) - in_unit(low) <= 0.5 / 65535.0,
        _ => in_unit(high) - in_unit(low),
    };
    spread <= 0.5 / 255.0
}

/// Returns true if the bounds differ only by rounding.
fn is_same_float(low: f32, high: f32) -> bool {
    high - low <= 1e-6 * low.abs().max(high.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::{NONE, SetKey};

    /// Two owned pixels, a ghost and an empty one.
    fn layout() -> SetLayout {
        SetLayout {
            key: SetKey {
                material: 0,
                uv_tile: [0, 0],
                udim: None,
            },
            size: 2,
            source: vec![0, 1, 2, NONE],
            cover: vec![Cover::Owned, Cover::Owned, Cover::Ghost, Cover::Empty],
            shared: Vec::new(),
            collisions: 0,
        }
    }

    fn of(channel: Channel, a: &[f32], b: &[f32]) -> Option<ConstantValue> {
        let other = vec![9.0; a.len()];
        let data = [a, b, &other, &other].concat();
        let mut pixels = ChannelPixels {
            components: a.len(),
            data,
        };
        constant_value(&channel, survey(&channel, &layout(), &mut pixels).bounds)
    }

    #[test]
    fn a_value_is_reported_as_it_was_set_however_a_driver_rounds_halves() {
        // A half float keeps 10 of the 23 bits that an f32 has behind its leading one.
        let cut = |value: f32| f32::from_bits(value.to_bits() & !0x1fff);
        let rounded = |value: f32| f32::from_bits((value.to_bits() + 0x1000) & !0x1fff);
        for hundredths in 1..=100u16 {
            let set = f32::from(hundredths) / 100.0;
            for stored in [cut(set), rounded(set)] {
                assert_eq!(
                    of(Channel::Roughness, &[stored], &[stored]),
                    Some(ConstantValue::Number(set)),
                    "{stored}"
                );
            }
        }
        for (stored, told) in [
            (0.699_707_03, 0.7),
            (0.0, 0.0),
            (0.333_251_95, 0.3333),
            (1234.0, 1234.0),
            (-0.25, -0.25),
        ] {
            assert_eq!(shortest_near(stored), told);
        }
        let [dark, bright] = [cut(0.007), rounded(0.509)];
        let color = of(Channel::BaseColor, &[dark, bright, 1.0], &[dark, bright, 1.0]);
        assert_eq!(color, Some(ConstantValue::Triple([0.007, 0.509, 1.0])));
        let height = of(Channel::Height, &[0.699_707_03], &[0.699_707_03]);
        assert_eq!(height, Some(ConstantValue::Number(0.699_707_03)), "a float all the way");
    }

    #[test]
    fn a_channel_is_constant_within_half_a_step_of_its_file() {
        assert_eq!(of(Channel::Roughness, &[0.7], &[0.7]), Some(ConstantValue::Number(0.7)));
        assert!(of(Channel::Roughness, &[0.7], &[0.7 + 0.4 / 255.0]).is_some());
        assert_eq!(of(Channel::Roughness, &[0.7], &[0.7 + 0.6 / 255.0]), None);
        assert!(
            of(Channel::Roughness, &[1.0], &[3.0]).is_some(),
            "both are 1 in the file"
        );
        assert_eq!(of(Channel::Mask("m".into()), &[0.7], &[0.7001]), None, "16 bits");
        assert_eq!(of(Channel::Height, &[0.0], &[1e-7]), None, "floats");
        assert_eq!(of(Channel::Height, &[-2.5], &[-2.5]), Some(ConstantValue::Number(-2.5)));
    }

    #[test]
    fn colors_are_compared_as_they_are_encoded() {
        let gray = ConstantValue::Triple([0.5; 3]);
        assert_eq!(of(Channel::BaseColor, &[0.5; 3], &[0.5; 3]), Some(gray));
        assert_eq!(
            of(Channel::BaseColor, &[0.0; 3], &[0.0003; 3]),
            None,
            "dark steps are small in light"
        );
        assert!(of(Channel::BaseColor, &[0.9; 3], &[0.901; 3]).is_some());
        assert_eq!(
            of(Channel::Emission, &[4.0, 0.0, 0.0], &[5.0, 0.0, 0.0]),
            None,
            "beyond 1 it is a float map"
        );
    }

    #[test]
    fn only_the_flat_normal_is_constant() {
        let flat = Some(ConstantValue::Triple([0.0, 0.0, 1.0]));
        assert_eq!(of(Channel::Normal, &[0.0, 0.0, 1.0], &[1e-6, 0.0, 1.0]), flat);
        assert_eq!(of(Channel::Normal, &[0.6, 0.0, 0.8], &[0.6, 0.0, 0.8]), None);
    }

    #[test]
    fn a_set_without_pixels_has_the_neutral_value() {
        let mut empty = layout();
        empty.cover.fill(Cover::Empty);
        let mut pixels = ChannelPixels {
            components: 1,
            data: vec![3.0; 4],
        };
        let found = survey(&Channel::Occlusion, &empty, &mut pixels);
        assert_eq!(
            constant_value(&Channel::Occlusion, found.bounds),
            Some(ConstantValue::Number(1.0))
        );
    }
}
