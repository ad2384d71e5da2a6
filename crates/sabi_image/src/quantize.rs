//! Quantization of floats to integer codes: rounding half up, and dithering.

use crate::blue_noise::DitherPattern;

/// Variation of rounding from pixel to pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Dither {
    /// Every pixel rounds half up.
    #[default]
    Off,
    /// Pixels round at thresholds spread evenly over the picture, so that gradients show no steps. A value that is a code
    /// stays that code.
    BlueNoise(DitherPattern),
}

/// Code of a value: clamped to 0..1, times 255, rounded half up; not-a-number gives 0.
pub fn quantize_u8(value: f32) -> u8 {
    quantize(value, 255.0, 0.5) as u8
}

/// Code of a value: clamped to 0..1, times 65535, rounded half up; not-a-number gives 0.
pub fn quantize_u16(value: f32) -> u16 {
    quantize(value, 65535.0, 0.5) as u16
}

impl Dither {
    /// 8-bit code of a value at a pixel, as [`quantize_u8`] where this is [`Dither::Off`].
    pub fn quantize_u8(self, value: f32, x: u32, y: u32) -> u8 {
        match self {
            Dither::Off => quantize_u8(value),
            Dither::BlueNoise(pattern) => quantize(value, 255.0, f64::from(pattern.threshold(x, y))) as u8,
        }
    }

    /// 16-bit code of a value at a pixel, as [`quantize_u16`] where this is [`Dither::Off`].
    pub fn quantize_u16(self, value: f32, x: u32, y: u32) -> u16 {
        match self {
            Dither::Off => quantize_u16(value),
            Dither::BlueNoise(pattern) => quantize(value, 65535.0, pattern.inner_threshold(x, y)) as u16,
        }
    }

    /// 8-bit code of a value after the sRGB curve, as [`Dither::quantize_u8`]; thresholds keep away from the ends by more than
    /// the error of that curve in floats.
    pub fn quantize_curved_u8(self, value: f32, x: u32, y: u32) -> u8 {
        match self {
            Dither::Off => quantize_u8(value),
            Dither::BlueNoise(pattern) => quantize(value, 255.0, pattern.inner_threshold(x, y)) as u8,
        }
    }
}

/// The product is rounded to a float, so that 0.7, which is no exact float, gives 178.5 and rounds up.
fn quantize(value: f32, highest: f32, threshold: f64) -> u32 {
    // `clamp` keeps not-a-number.
    let unit = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
    // Never negative, so that cutting off is rounding down.
    ((f64::from(unit * highest) + threshold) as u32).min(highest as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blue_noise() -> Dither {
        Dither::BlueNoise(DitherPattern::new(3, "roughness", 0))
    }

    #[test]
    fn halves_round_up_and_ends_are_clamped() {
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
    fn dithering_leaves_every_exact_code_alone() {
        for code in 0..=255u8 {
            let value = f32::from(code) / 255.0;
            for place in 0..4096 {
                assert_eq!(blue_noise().quantize_u8(value, place % 64, place / 64), code);
            }
        }
    }

    #[test]
    fn dithering_of_16_bits_leaves_every_exact_code_alone() {
        for code in (0..=65535_u16).step_by(13) {
            let value = f32::from(code) / 65535.0;
            for place in 0..256 {
                assert_eq!(blue_noise().quantize_u16(value, place % 16, place / 16), code);
            }
        }
    }

    #[test]
    fn dithering_keeps_the_mean_and_moves_no_pixel_by_more_than_one_code() {
        for value in [0.1, 0.3333, 0.5, 0.7001953, 0.9] {
            let mut sum = 0.0;
            for y in 0..128 {
                for x in 0..128 {
                    let code = f64::from(blue_noise().quantize_u8(value, x, y));
                    assert!((code - f64::from(value) * 255.0).abs() < 1.0);
                    sum += code;
                }
            }
            let mean = sum / (128.0 * 128.0);
            assert!((mean - f64::from(value) * 255.0).abs() < 0.01, "{value}: {mean}");
        }
    }
}
