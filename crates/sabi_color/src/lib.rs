//! Color encoding: the sRGB transfer functions of IEC 61966-2-1, exact and piecewise, luminance and Oklab.
//!
//! All crates decode and encode sRGB here, so that a code means the same linear value everywhere:
//!
//! ```
//! use sabi_color::{linear_from_srgb8, srgb8_from_linear};
//!
//! let linear = linear_from_srgb8([107, 58, 30]);
//! assert_eq!(linear.map(srgb8_from_linear), [107, 58, 30]);
//! ```

mod oklab;

use std::array;
use std::sync::OnceLock;

pub use oklab::oklab_from_linear;

/// Encodes one linear value: 12.92 × v up to 0.0031308, then 1.055 × v^(1/2.4) − 0.055. Negative values stay on the linear part,
/// values above 1 continue along the curve. Values of half floats between 2⁻¹⁴ and 1 come from a table, since whole pictures of
/// them are encoded.
pub fn srgb_from_linear(linear: f32) -> f32 {
    static OF_HALVES: OnceLock<Vec<f32>> = OnceLock::new();
    let encoded = |linear: f32| srgb_from_linear_f64(f64::from(linear)) as f32;
    let bits = linear.to_bits();
    if bits.is_multiple_of(HALF_STEP) && (LOWEST_HALF..=HIGHEST_HALF).contains(&bits) {
        let halves = (LOWEST_HALF..=HIGHEST_HALF).step_by(HALF_STEP as usize);
        let table = OF_HALVES.get_or_init(|| halves.map(|bits| encoded(f32::from_bits(bits))).collect());
        table[((bits - LOWEST_HALF) / HALF_STEP) as usize]
    } else {
        encoded(linear)
    }
}

/// Bits of the floats between which [`srgb_from_linear`] has its table: the smallest normal half float, and 1; and the step from
/// one half float to the next.
const LOWEST_HALF: u32 = (1.0_f32 / 16384.0).to_bits();
const HIGHEST_HALF: u32 = 1.0_f32.to_bits();
const HALF_STEP: u32 = 1 << 13;

/// Decodes one value, the inverse of [`srgb_from_linear`].
pub fn linear_from_srgb(encoded: f32) -> f32 {
    linear_from_srgb_f64(f64::from(encoded)) as f32
}

/// Encodes one value in double precision, see [`srgb_from_linear`].
pub fn srgb_from_linear_f64(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// Decodes one value in double precision, the inverse of [`srgb_from_linear_f64`].
pub fn linear_from_srgb_f64(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// Decodes the 8-bit codes of a color. The values come from a table, since whole pictures are decoded with it.
pub fn linear_from_srgb8(codes: [u8; 3]) -> [f32; 3] {
    static LINEAR: OnceLock<[f32; 256]> = OnceLock::new();
    let linear = LINEAR.get_or_init(|| array::from_fn(|code| linear_from_srgb_f64(code as f64 / 255.0) as f32));
    codes.map(|code| linear[usize::from(code)])
}

/// Luminance of a linear color with the primaries of Rec. 709, like `luminance` in `lib/core.wgsl`.
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Bits of a float below the leading ones that pick a slot of the table.
const SLOT_SHIFT: u32 = 16;

/// For 8-bit encoding without a power for each sample: `thresholds[k]` is the smallest float whose code is above `k`, and
/// `first` holds a code to start from for each value of a float's upper 16 bits.
struct Encoder8 {
    thresholds: [f32; 256],
    first: Vec<u8>,
}

fn encoder8() -> &'static Encoder8 {
    static ENCODER: OnceLock<Encoder8> = OnceLock::new();
    ENCODER.get_or_init(|| {
        let mut thresholds = [f32::INFINITY; 256];
        for (code, threshold) in thresholds.iter_mut().enumerate().take(255) {
            *threshold = smallest_above(code as u8);
        }
        let slots = (1.0f32.to_bits() >> SLOT_SHIFT) as usize + 1;
        let mut first = vec![0u8; slots];
        let mut code = 0usize;
        for (slot, start) in first.iter_mut().enumerate() {
            let lowest = f32::from_bits((slot as u32) << SLOT_SHIFT);
            while lowest >= thresholds[code] {
                code += 1;
            }
            *start = code as u8;
        }
        Encoder8 { thresholds, first }
    })
}

/// The smallest float whose encoded value, times 255, rounds to more than `code`.
fn smallest_above(code: u8) -> f32 {
    let is_above = |value: f32| srgb_from_linear_f64(f64::from(value)) * 255.0 >= f64::from(code) + 0.5;
    let (mut below, mut above) = (0u32, 1.0f32.to_bits());
    while above - below > 1 {
        let middle = below + (above - below) / 2;
        if is_above(f32::from_bits(middle)) {
            above = middle
        } else {
            below = middle
        }
    }
    f32::from_bits(above)
}

/// Encodes one linear value as an 8-bit code: clamped to 0..1, encoded, times 255, rounded half up; not-a-number gives 0. The
/// result is exact: the value is compared with the thresholds at which the code changes.
pub fn srgb8_from_linear(linear: f32) -> u8 {
    if linear.is_nan() || linear <= 0.0 {
        return 0;
    }
    if linear >= 1.0 {
        return 255;
    }
    let encoder = encoder8();
    let mut code = encoder.first[(linear.to_bits() >> SLOT_SHIFT) as usize];
    while linear >= encoder.thresholds[usize::from(code)] {
        code += 1;
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_has_its_known_points() {
        assert_eq!(srgb_from_linear(0.0), 0.0);
        assert_eq!(srgb_from_linear(1.0), 1.0);
        assert_eq!(linear_from_srgb(1.0), 1.0);
        assert!((srgb_from_linear(0.5) - 0.735_357).abs() < 1e-6);
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-6);
        assert!((srgb_from_linear(0.003_130_8) - 0.040_449_94).abs() < 1e-7);
        assert!((srgb_from_linear(0.18) - 0.461_356).abs() < 1e-6);
    }

    #[test]
    fn the_curve_and_its_inverse_undo_each_other() {
        for step in 0..=1000 {
            let value = step as f32 / 1000.0;
            assert!(
                (linear_from_srgb(srgb_from_linear(value)) - value).abs() < 2e-7,
                "{value}"
            );
        }
    }

    #[test]
    fn the_8_bit_table_agrees_with_the_formula_everywhere() {
        let formula = |value: f32| {
            let scaled = srgb_from_linear_f64(f64::from(value.clamp(0.0, 1.0))) * 255.0 + 0.5;
            scaled.floor() as u8
        };
        let mut bits = 0u32;
        while bits <= 1.0f32.to_bits() {
            let value = f32::from_bits(bits);
            assert_eq!(srgb8_from_linear(value), formula(value), "{value}");
            bits += 9973;
        }
        for code in 0..255u8 {
            let edge = smallest_above(code);
            assert_eq!(srgb8_from_linear(edge), code + 1);
            assert_eq!(srgb8_from_linear(f32::from_bits(edge.to_bits() - 1)), code);
        }
    }

    #[test]
    fn every_8_bit_code_survives_decoding_and_encoding() {
        for code in 0..=255u8 {
            let linear = linear_from_srgb_f64(f64::from(code) / 255.0) as f32;
            assert_eq!(srgb8_from_linear(linear), code);
        }
    }

    #[test]
    fn values_out_of_range_are_clamped_and_not_a_number_is_0() {
        assert_eq!(srgb8_from_linear(-1.0), 0);
        assert_eq!(srgb8_from_linear(7.0), 255);
        assert_eq!(srgb8_from_linear(f32::INFINITY), 255);
        assert_eq!(srgb8_from_linear(f32::NEG_INFINITY), 0);
        assert_eq!(srgb8_from_linear(f32::NAN), 0);
    }
}
