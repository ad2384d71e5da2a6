//! Decoded images and their conversion to linear values.

use std::sync::OnceLock;

use rayon::prelude::*;
use sabi_color::{linear_from_srgb, linear_from_srgb_f64};

/// Color space that a file declares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeclaredColorSpace {
    /// Encoded with the sRGB curve.
    Srgb,
    /// Proportional to light.
    Linear,
    /// Light is the code to the power of this exponent.
    Power(f32),
    /// No color space is declared, as in most files, or one that is not applied.
    Unknown,
}

impl DeclaredColorSpace {
    /// Returns true if two color spaces are the same up to rounding in files.
    pub(crate) fn is_near(self, other: DeclaredColorSpace) -> bool {
        match (self, other) {
            (DeclaredColorSpace::Power(left), DeclaredColorSpace::Power(right)) => (left - right).abs() < 0.005,
            (left, right) => left == right,
        }
    }
}

/// Curve by which codes become linear values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransferCurve {
    /// Codes are linear values.
    Linear,
    /// The curve of sRGB.
    Srgb,
    /// The code to the power of this exponent.
    Power(f32),
}

impl TransferCurve {
    /// Returns the linear value of a code from 0 to 1.
    pub fn linear(self, code: f32) -> f32 {
        match self {
            TransferCurve::Linear => code,
            TransferCurve::Srgb => linear_from_srgb(code),
            TransferCurve::Power(exponent) => code.max(0.0).powf(exponent),
        }
    }
}

/// Samples of an image, row by row from the top, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// 8-bit codes; 255 stands for 1.
    U8(Vec<u8>),
    /// 16-bit codes in native byte order; 65535 stands for 1.
    U16(Vec<u16>),
    /// The numbers themselves.
    F32(Vec<f32>),
}

/// A decoded image.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of channels: 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha (not premultiplied, except in OpenEXR files,
    /// whose values are kept).
    pub channels: u8,
    /// `width × height × channels` samples.
    pub pixels: Pixels,
    /// Color space that the file declares.
    pub color_space: DeclaredColorSpace,
    /// Deviations from what the file says.
    pub remarks: PictureRemarks,
}

/// Deviations of a picture from what its file says, as clauses that follow the name of the file: `has an alpha of 0 everywhere…`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PictureRemarks {
    /// Clauses that matter to all uses.
    pub values: Vec<String>,
    /// Clauses that matter where the color space of the file counts.
    pub color: Vec<String>,
}

/// An image as linear RGBA.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPicture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Pixels, row by row from the top. Gray is repeated, and a missing alpha is 1.
    pub rgba: Vec<[f32; 4]>,
}

/// Values of all 8-bit codes, without and with the sRGB curve.
struct Table8 {
    plain: [f32; 256],
    srgb: [f32; 256],
}

fn table8() -> &'static Table8 {
    static TABLE: OnceLock<Table8> = OnceLock::new();
    TABLE.get_or_init(|| Table8 {
        plain: std::array::from_fn(|code| (code as f64 / 255.0) as f32),
        srgb: std::array::from_fn(|code| linear_from_srgb_f64(code as f64 / 255.0) as f32),
    })
}

/// Returns the values of all 16-bit codes, correctly rounded.
fn table16(linear: impl Fn(f64) -> f64) -> Vec<f32> {
    (0..=65535u32)
        .map(|code| linear(f64::from(code) / 65535.0) as f32)
        .collect()
}

fn plain16() -> &'static [f32] {
    static TABLE: OnceLock<Vec<f32>> = OnceLock::new();
    TABLE.get_or_init(|| table16(|code| code))
}

fn srgb16() -> &'static [f32] {
    static TABLE: OnceLock<Vec<f32>> = OnceLock::new();
    TABLE.get_or_init(|| table16(linear_from_srgb_f64))
}

impl Picture {
    /// Returns the curve of the colors: the one that the file declares, else that of sRGB, or none for floating-point numbers.
    pub fn color_curve(&self) -> TransferCurve {
        match (self.color_space, &self.pixels) {
            (DeclaredColorSpace::Linear, _) | (DeclaredColorSpace::Unknown, Pixels::F32(_)) => TransferCurve::Linear,
            (DeclaredColorSpace::Srgb, _) | (DeclaredColorSpace::Unknown, _) => TransferCurve::Srgb,
            (DeclaredColorSpace::Power(exponent), _) => TransferCurve::Power(exponent),
        }
    }

    /// Returns the image as linear RGBA. The curve applies to all channels but alpha. Codes are converted by tables of correctly rounded
    /// values, so that 255 and 65535 are exactly 1.
    pub fn linear_rgba(&self, curve: TransferCurve) -> LinearPicture {
        let channels = usize::from(self.channels);
        let power = |exponent: f32| move |code: f64| code.powf(f64::from(exponent));
        let rgba = match &self.pixels {
            Pixels::U8(samples) => {
                let table = table8();
                let color = match curve {
                    TransferCurve::Linear => table.plain,
                    TransferCurve::Srgb => table.srgb,
                    TransferCurve::Power(exponent) => {
                        std::array::from_fn(|code| power(exponent)(code as f64 / 255.0) as f32)
                    }
                };
                spread(
                    samples,
                    channels,
                    |code| color[usize::from(code)],
                    |code| table.plain[usize::from(code)],
                )
            }
            Pixels::U16(samples) => {
                let plain = plain16();
                let own;
                let color = match curve {
                    TransferCurve::Linear => plain,
                    TransferCurve::Srgb => srgb16(),
                    TransferCurve::Power(exponent) => {
                        own = table16(power(exponent));
                        &own
                    }
                };
                spread(
                    samples,
                    channels,
                    |code| color[usize::from(code)],
                    |code| plain[usize::from(code)],
                )
            }
            Pixels::F32(samples) => spread(samples, channels, |value| curve.linear(value), |value| value),
        };
        LinearPicture {
            width: self.width,
            height: self.height,
            rgba,
        }
    }
}

fn spread<T: Copy + Sync>(
    samples: &[T],
    channels: usize,
    color: impl Fn(T) -> f32 + Sync,
    alpha: impl Fn(T) -> f32 + Sync,
) -> Vec<[f32; 4]> {
    samples
        .par_chunks_exact(channels.max(1))
        .with_min_len(4096)
        .map(|pixel| match *pixel {
            [gray] => [color(gray), color(gray), color(gray), 1.0],
            [gray, a] => [color(gray), color(gray), color(gray), alpha(a)],
            [r, g, b] => [color(r), color(g), color(b), 1.0],
            [r, g, b, a, ..] => [color(r), color(g), color(b), alpha(a)],
            [] => [0.0, 0.0, 0.0, 1.0],
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(channels: u8, pixels: Pixels) -> Picture {
        Picture {
            width: 1,
            height: 1,
            channels,
            pixels,
            color_space: DeclaredColorSpace::Unknown,
            remarks: PictureRemarks::default(),
        }
    }

    #[test]
    fn every_code_gives_the_correctly_rounded_value_of_the_formula() {
        for code in 0..=255u8 {
            let linear = picture(1, Pixels::U8(vec![code])).linear_rgba(TransferCurve::Srgb).rgba[0][0];
            assert_eq!(linear, linear_from_srgb_f64(f64::from(code) / 255.0) as f32);
            let plain = picture(1, Pixels::U8(vec![code]))
                .linear_rgba(TransferCurve::Linear)
                .rgba[0][0];
            assert_eq!(plain, (f64::from(code) / 255.0) as f32);
        }
        for code in (0..=65535u16).step_by(7) {
            let plain = picture(1, Pixels::U16(vec![code]))
                .linear_rgba(TransferCurve::Linear)
                .rgba[0][0];
            assert_eq!(plain, (f64::from(code) / 65535.0) as f32);
        }
        assert_eq!(
            picture(1, Pixels::U16(vec![65535]))
                .linear_rgba(TransferCurve::Srgb)
                .rgba[0],
            [1.0; 4]
        );
    }

    #[test]
    fn gray_is_repeated_and_the_curve_is_not_applied_to_alpha() {
        let half = linear_from_srgb_f64(128.0 / 255.0) as f32;
        assert_eq!(
            picture(1, Pixels::U8(vec![128])).linear_rgba(TransferCurve::Srgb).rgba[0],
            [half, half, half, 1.0]
        );
        let alpha = (64.0f64 / 255.0) as f32;
        assert_eq!(
            picture(2, Pixels::U8(vec![128, 64]))
                .linear_rgba(TransferCurve::Srgb)
                .rgba[0],
            [half, half, half, alpha]
        );
        assert_eq!(
            picture(4, Pixels::U8(vec![255, 128, 0, 64]))
                .linear_rgba(TransferCurve::Srgb)
                .rgba[0],
            [1.0, half, 0.0, alpha]
        );
        assert_eq!(
            picture(3, Pixels::F32(vec![2.0, -1.0, 0.5]))
                .linear_rgba(TransferCurve::Linear)
                .rgba[0],
            [2.0, -1.0, 0.5, 1.0]
        );
    }

    #[test]
    fn a_power_applies_to_colors_and_not_to_alpha() {
        let square = TransferCurve::Power(2.0);
        let half = (0.5_f64 * 0.5) as f32;
        assert_eq!(
            picture(2, Pixels::F32(vec![0.5, 0.5])).linear_rgba(square).rgba[0],
            [half, half, half, 0.5]
        );
        let eight = picture(1, Pixels::U8(vec![51])).linear_rgba(square).rgba[0][0];
        let sixteen = picture(1, Pixels::U16(vec![13107])).linear_rgba(square).rgba[0][0];
        assert_eq!([eight, sixteen], [0.04; 2]);
    }
}
