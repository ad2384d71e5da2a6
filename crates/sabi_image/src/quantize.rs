//! Quantization of floats to integer codes: rounding half up, or with other thresholds for dithering.

use crate::blue_noise::DitherPattern;

/// Threshold of plain rounding, as a share of the distance to the next code.
const HALF: f64 = 0.5;

/// Returns the code of a value: clamped to 0..1, times 255, rounded half up. NaN gives 0.
pub fn quantize_u8(value: f32) -> u8 {
    rounded(level(value, 255.0)) as u8
}

/// Returns the code of a value: clamped to 0..1, times 65535, rounded half up. NaN gives 0.
pub fn quantize_u16(value: f32) -> u16 {
    rounded(level(value, 65535.0)) as u16
}

/// Returns a value in units of codes, before rounding: clamped to 0..1, times the highest code. NaN gives 0.
///
/// The result is a float, so that 0.7, which is not an exact float, gives 178.5 of 255 and is rounded up.
#[inline]
#[expect(
    clippy::manual_clamp,
    reason = "`clamp` keeps not-a-number, `max` takes the number of the two"
)]
pub fn level(value: f32, highest: f32) -> f32 {
    value.max(0.0).min(1.0) * highest
}

/// Returns the code of a level, rounded half up.
#[inline]
pub fn rounded(level: f32) -> u32 {
    code(level, HALF)
}

/// Returns the code of a level, which is never negative, so that truncation rounds down.
#[inline]
fn code(level: f32, threshold: f64) -> u32 {
    (f64::from(level) + threshold) as u32
}

/// Thresholds at which the levels of a row of pixels are rounded up. They are evenly distributed over the image, so that
/// gradients show no steps. A level that is exactly a code keeps that code.
#[derive(Clone, Copy, Debug)]
pub struct DitheredRow {
    /// Thresholds, which repeat along the row.
    thresholds: [f64; DitherPattern::SIDE],
}

impl DitheredRow {
    /// Creates the thresholds of a row for values of 8 bits, whose floats are exact except for rounding.
    pub fn new(pattern: DitherPattern, y: u32) -> DitheredRow {
        DitheredRow {
            thresholds: std::array::from_fn(|x| f64::from(pattern.threshold(x as u32, y))),
        }
    }

    /// Creates the thresholds of a row with a larger distance from 0 and 1: for 16 bits, and for values with the sRGB
    /// curve, which floats represent with a larger error.
    pub fn inner(pattern: DitherPattern, y: u32) -> DitheredRow {
        DitheredRow {
            thresholds: std::array::from_fn(|x| pattern.inner_threshold(x as u32, y)),
        }
    }

    /// Returns the code of the level of a pixel in the row.
    #[inline]
    pub fn code(&self, level: f32, x: usize) -> u32 {
        code(level, self.thresholds[x % DitherPattern::SIDE])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern() -> DitherPattern {
        DitherPattern::new(3, "roughness", 0)
    }

    #[test]
    fn halves_are_rounded_up_and_values_outside_are_clamped() {
        let cases = [
            (0.0, 0),
            (1.0, 255),
            (0.5, 128),
            (-3.0, 0),
            (9.0, 255),
            (f32::NAN, 0),
            (f32::INFINITY, 255),
        ];
        for (value, code) in cases {
            assert_eq!(quantize_u8(value), code, "{value}");
        }
        assert_eq!(quantize_u16(0.5), 32768);
        assert_eq!(quantize_u16(1.0), 65535);
        assert_eq!(quantize_u16(f32::NAN), 0);
    }

    #[test]
    fn dithering_does_not_change_exact_codes() {
        for y in 0..64 {
            let row = DitheredRow::new(pattern(), y);
            for code in 0..=255 {
                let exact = level(code as f32 / 255.0, 255.0);
                assert!((0..64).all(|x| row.code(exact, x) == code), "{code}");
            }
        }
    }

    #[test]
    fn dithering_of_16_bits_does_not_change_exact_codes() {
        for y in 0..16 {
            let row = DitheredRow::inner(pattern(), y);
            for code in (0..=65535).step_by(13) {
                let exact = level(code as f32 / 65535.0, 65535.0);
                assert!((0..16).all(|x| row.code(exact, x) == code), "{code}");
            }
        }
    }

    #[test]
    fn dithering_keeps_the_mean_and_changes_no_pixel_by_more_than_one_code() {
        for value in [0.1, 0.3333, 0.5, 0.7001953, 0.9] {
            let mut sum = 0.0;
            for y in 0..128 {
                let row = DitheredRow::new(pattern(), y);
                for x in 0..128 {
                    let code = f64::from(row.code(level(value, 255.0), x));
                    assert!((code - f64::from(value) * 255.0).abs() < 1.0);
                    sum += code;
                }
            }
            let mean = sum / (128.0 * 128.0);
            assert!((mean - f64::from(value) * 255.0).abs() < 0.01, "{value}: {mean}");
        }
    }
}
