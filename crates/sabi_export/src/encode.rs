//! Encoding of packed components as a file.

use std::borrow::Cow;

use rayon::prelude::*;
use sabi_image::{
    Dither, ExrSamples, ImageError, PngData, PngOptions, encode_exr, encode_png, encode_tga, quantize_u8, quantize_u16,
    srgb_from_linear, srgb8_from_linear,
};

use crate::ChannelPixels;
use crate::preset::Format;

/// Meaning of the values of a channel between 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Codes {
    /// 0..1.
    Unit,
    /// Components of unit vectors, −1..1: 0 is the middle code rounded up. Normals never point inward.
    Normal {
        /// True if green means downward.
        is_down: bool,
    },
    /// From the lowest to the highest value of the set; the report has them. Floats are written as they are.
    Range([f32; 2]),
}

/// Component of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Plane<'a> {
    /// A component of a channel.
    Channel {
        pixels: &'a ChannelPixels,
        index: usize,
        codes: Codes,
        is_inverted: bool,
    },
    /// One value everywhere, 0..1.
    Constant(f32),
}

/// Encoding of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Encoding {
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    pub(crate) format: Format,
    /// True if components but the last of two or four go through the sRGB curve.
    pub(crate) is_srgb: bool,
    pub(crate) is_dithered: bool,
}

/// All components of a channel.
pub(crate) fn planes(pixels: &ChannelPixels, codes: Codes) -> Vec<Plane<'_>> {
    let plane = |index| Plane::Channel {
        pixels,
        index,
        codes,
        is_inverted: false,
    };
    (0..pixels.components).map(plane).collect()
}

/// The bytes of a file of one to four components.
pub(crate) fn encode(planes: &[Plane<'_>], encoding: Encoding) -> Result<Vec<u8>, ImageError> {
    let [width, height] = encoding.size;
    let png = |data: PngData<'_>| {
        let options = PngOptions {
            channels: planes.len() as u8,
            bits: encoding.format.bits(),
            srgb_chunk: encoding.is_srgb,
        };
        encode_png(width, height, data, options)
    };
    match encoding.format {
        Format::Png { bits: 16 } => png(PngData::U16(&codes_16(planes, encoding))),
        Format::Png { .. } => png(PngData::U8(&codes_8(planes, encoding))),
        Format::Tga => encode_tga(width, height, planes.len() as u8, &codes_8(planes, encoding)),
        Format::ExrHalf | Format::Exr => {
            let values: Vec<Cow<'_, [f32]>> = planes.iter().map(|plane| floats(plane, encoding.size)).collect();
            let names: &[&str] = match planes.len() {
                1 => &["Y"],
                2 => &["Y", "A"],
                3 => &["R", "G", "B"],
                _ => &["R", "G", "B", "A"],
            };
            let channels: Vec<(&str, &[f32])> =
                names.iter().copied().zip(values.iter().map(|plane| &**plane)).collect();
            let samples = match encoding.format {
                Format::ExrHalf => ExrSamples::Half,
                _ => ExrSamples::Float,
            };
            encode_exr(width, height, &channels, samples)
        }
    }
}

/// Values of a component as floats, row by row from the top.
fn floats<'a>(plane: &Plane<'a>, [width, height]: [u32; 2]) -> Cow<'a, [f32]> {
    if let Plane::Channel {
        pixels,
        codes: Codes::Range(_) | Codes::Unit,
        is_inverted: false,
        ..
    } = plane
        && pixels.components == 1
    {
        return Cow::Borrowed(&pixels.data);
    }
    let pixels = width as usize * height as usize;
    (0..pixels).into_par_iter().map(|pixel| plane.float(pixel)).collect()
}

/// 8-bit codes, components interleaved.
pub(crate) fn codes_8(planes: &[Plane<'_>], encoding: Encoding) -> Vec<u8> {
    coded(planes, encoding, |unit, is_color, dither, x, y| {
        match (is_color, dither) {
            (true, _) => srgb8_from_linear(unit),
            (false, Dither::Off) => quantize_u8(unit),
            (false, dither) => dither.quantize_u8(unit, x, y),
        }
    })
}

/// 16-bit codes, components interleaved.
fn codes_16(planes: &[Plane<'_>], encoding: Encoding) -> Vec<u16> {
    coded(planes, encoding, |unit, is_color, dither, x, y| {
        let unit = if is_color {
            srgb_from_linear(unit.clamp(0.0, 1.0))
        } else {
            unit
        };
        match dither {
            Dither::Off => quantize_u16(unit),
            dither => dither.quantize_u16(unit, x, y),
        }
    })
}

fn coded<T: Copy + Default + Send>(
    planes: &[Plane<'_>],
    encoding: Encoding,
    code: impl Fn(f32, bool, Dither, u32, u32) -> T + Sync,
) -> Vec<T> {
    let [width, height] = encoding.size.map(|side| side as usize);
    let count = planes.len().max(1);
    let mut out = vec![T::default(); width * height * count];
    out.par_chunks_mut((width * count).max(1))
        .enumerate()
        .for_each(|(y, row)| {
            for (x, codes) in row.chunks_exact_mut(count).enumerate() {
                for (at, (slot, plane)) in codes.iter_mut().zip(planes).enumerate() {
                    // Alpha is linear beside colors, too.
                    let is_color = encoding.is_srgb && (at < 3 && !(count == 2 && at == 1));
                    let dither = match encoding.is_dithered && plane.is_on_a_gradient([x, y], width) {
                        true => Dither::Ordered,
                        false => Dither::Off,
                    };
                    *slot = code(plane.unit(y * width + x), is_color, dither, x as u32, y as u32);
                }
            }
        });
    out
}

impl Plane<'_> {
    /// Value of a pixel for whole numbers, 0..1. Inversions and turns of green happen here, before rounding: a flat normal stays
    /// the middle code.
    fn unit(&self, pixel: usize) -> f32 {
        let Plane::Channel {
            pixels,
            index,
            codes,
            is_inverted,
        } = self
        else {
            return self.float(pixel);
        };
        let values = values(pixels, pixel);
        let unit = match codes {
            Codes::Unit => values[*index],
            Codes::Normal { is_down } => normal(values, *is_down)[*index] * 0.5 + 0.5,
            Codes::Range([low, high]) if high > low => (values[*index] - low) / (high - low),
            Codes::Range(_) => 0.0,
        };
        if *is_inverted { 1.0 - unit } else { unit }
    }

    /// Value of a pixel for floats.
    fn float(&self, pixel: usize) -> f32 {
        match self {
            Plane::Constant(value) => *value,
            Plane::Channel {
                pixels,
                index,
                codes: Codes::Range([low, high]),
                is_inverted,
            } => {
                let value = values(pixels, pixel)[*index];
                if *is_inverted { low + high - value } else { value }
            }
            Plane::Channel { .. } => self.unit(pixel),
        }
    }

    /// Returns true if a neighbor has another value. An area of one value would only get noise from dithering.
    fn is_on_a_gradient(&self, [x, y]: [usize; 2], width: usize) -> bool {
        let Plane::Channel { pixels, .. } = self else {
            return false;
        };
        let pixel = y * width + x;
        let own = values(pixels, pixel);
        let differs = |other: usize| {
            let start = other * pixels.components;
            let other = pixels.data.get(start..start + pixels.components);
            other.is_some_and(|other| other != own)
        };
        (x > 0 && differs(pixel - 1))
            || (x + 1 < width && differs(pixel + 1))
            || (y > 0 && differs(pixel - width))
            || differs(pixel + width)
    }
}

/// Values of a pixel.
fn values(pixels: &ChannelPixels, pixel: usize) -> &[f32] {
    &pixels.data[pixel * pixels.components..][..pixels.components]
}

/// A normal of unit length: padding, 16-bit storage and smaller maps may have bent it. One that points inward, which maps of
/// two channels cannot hold, is tilted up to the surface. A vector without a direction is the flat normal.
fn normal(values: &[f32], is_down: bool) -> [f32; 3] {
    let [x, y, z] = match values {
        [x, y, z] => [*x, *y, z.max(0.0)],
        _ => [0.0; 3],
    };
    let length = (x * x + y * y + z * z).sqrt();
    let [x, y, z] = match length > 1e-6 && length.is_finite() {
        true => [x, y, z].map(|part| part / length),
        false => [0.0, 0.0, 1.0],
    };
    [x, if is_down { -y } else { y }, z]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use sabi_image::{Pixels, decode};

    use super::*;

    const UP: Codes = Codes::Normal { is_down: false };
    const DOWN: Codes = Codes::Normal { is_down: true };

    fn codes_of(data: Vec<f32>, components: usize, size: u32, codes: Codes, bits: u8, is_dithered: bool) -> Pixels {
        let pixels = ChannelPixels { components, data };
        let encoding = Encoding {
            size: [size; 2],
            format: Format::Png { bits },
            is_srgb: false,
            is_dithered,
        };
        let file = encode(&planes(&pixels, codes), encoding).unwrap();
        decode("a.png", &file).unwrap().pixels
    }

    #[test]
    fn the_flat_normal_is_the_middle_code_rounded_up() {
        let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, UP, 16, false);
        assert_eq!(flat, Pixels::U16(vec![32768, 32768, 65535]));
        let long = codes_of(vec![0.0, -3.0, 0.0], 3, 1, UP, 16, false);
        assert_eq!(long, Pixels::U16(vec![32768, 0, 32768]), "unit length");
        let broken = codes_of(vec![0.0; 3], 3, 1, UP, 16, false);
        assert_eq!(broken, Pixels::U16(vec![32768, 32768, 65535]));
    }

    /// The largest angle between unit vectors and what their codes stand for, degrees.
    fn largest_turn(bits: u8) -> f64 {
        let size = 64_u32;
        let vectors: Vec<[f32; 3]> = (0..size * size)
            .map(|i| {
                // Evenly over the half sphere, by the golden angle.
                let z = 1.0 - (f64::from(i) + 0.5) / f64::from(size * size);
                let (around, across) = (2.399_963_229_728_653 * f64::from(i), (1.0 - z * z).sqrt());
                [across * around.cos(), across * around.sin(), z].map(|part| part as f32)
            })
            .collect();
        let codes: Vec<f64> = match codes_of(vectors.concat(), 3, size, UP, bits, false) {
            Pixels::U8(codes) => codes.into_iter().map(|code| f64::from(code) / 255.0).collect(),
            Pixels::U16(codes) => codes.into_iter().map(|code| f64::from(code) / 65535.0).collect(),
            Pixels::F32(_) => panic!("whole numbers"),
        };
        let turn = |(vector, code): (&[f32; 3], &[f64])| {
            let was = DVec3::from(vector.map(f64::from));
            let is = DVec3::from_slice(code) * 2.0 - 1.0;
            (was.dot(is) / (was.length_squared() * is.length_squared()).sqrt())
                .clamp(-1.0, 1.0)
                .acos()
        };
        let turns = vectors.iter().zip(codes.chunks_exact(3)).map(turn);
        turns.fold(0.0, f64::max).to_degrees()
    }

    #[test]
    fn normals_come_back_from_their_codes_as_exactly_as_the_bits_allow() {
        // Half a step of each component, √3/255 and √3/65535 as a vector; and what acos loses near 1.
        let half_step = |codes: f64| (3.0_f64.sqrt() / codes).to_degrees();
        let (at_8, at_16) = (largest_turn(8), largest_turn(16));
        assert!(at_8 < half_step(255.0), "{at_8}");
        assert!(at_16 < half_step(65535.0) + 1e-5, "{at_16}");
        assert!(at_16 < 0.01);
    }

    #[test]
    fn the_flat_normal_is_128_128_255_in_8_bits() {
        let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, UP, 8, false);
        assert_eq!(flat, Pixels::U8(vec![128, 128, 255]));
    }

    #[test]
    fn heights_span_their_range() {
        let codes = codes_of(vec![-1.0, 3.0, 1.0, 0.0], 1, 2, Codes::Range([-1.0, 3.0]), 16, false);
        assert_eq!(codes, Pixels::U16(vec![0, 65535, 32768, 16384]));
    }

    #[test]
    fn areas_of_one_value_are_not_dithered_and_gradients_are() {
        let size = 32u32;
        let flat = codes_of(vec![0.7001953; 1024], 1, size, Codes::Unit, 8, true);
        assert_eq!(flat, Pixels::U8(vec![179; 1024]));
        let ramp: Vec<f32> = (0..1024).map(|i| 0.5 + (i % 32) as f32 * 1e-4).collect();
        let Pixels::U8(codes) = codes_of(ramp.clone(), 1, size, Codes::Unit, 8, true) else {
            panic!("8 bits")
        };
        for (code, value) in codes.iter().zip(&ramp) {
            assert!((f32::from(*code) - value * 255.0).abs() < 1.0);
        }
        let mean = codes.iter().map(|&code| f64::from(code)).sum::<f64>() / 1024.0;
        let exact = ramp.iter().map(|&value| f64::from(value) * 255.0).sum::<f64>() / 1024.0;
        assert!((mean - exact).abs() < 0.05, "{mean} {exact}");
    }

    #[test]
    fn green_that_means_downward_is_the_mirror_of_green_that_means_upward() {
        let tilted = |y: f32| vec![0.3, y, (1.0 - 0.09 - y * y).sqrt()];
        for bits in [8, 16] {
            for y in [0.0, 0.25, -0.7] {
                let down = codes_of(tilted(y), 3, 1, DOWN, bits, false);
                assert_eq!(down, codes_of(tilted(-y), 3, 1, UP, bits, false), "{bits} bits, {y}");
            }
        }
        let flat = codes_of(vec![0.0, 0.0, 1.0], 3, 1, DOWN, 8, false);
        assert_eq!(flat, Pixels::U8(vec![128, 128, 255]), "no tilt by rounding");
    }

    #[test]
    fn normals_never_point_inward() {
        let inward = codes_of(vec![0.6, 0.0, -0.8], 3, 1, UP, 8, false);
        assert_eq!(
            inward,
            Pixels::U8(vec![255, 128, 128]),
            "along the surface, of unit length"
        );
        let under = codes_of(vec![0.0, 0.0, -1.0], 3, 1, UP, 8, false);
        assert_eq!(under, Pixels::U8(vec![128, 128, 255]));
    }

    #[test]
    fn inversions_and_constants_are_packed_beside_channels() {
        let pixels = ChannelPixels {
            components: 1,
            data: vec![0.25, 1.0],
        };
        let of = |is_inverted| Plane::Channel {
            pixels: &pixels,
            index: 0,
            codes: Codes::Unit,
            is_inverted,
        };
        let encoding = Encoding {
            size: [2, 1],
            format: Format::Png { bits: 8 },
            is_srgb: true,
            is_dithered: false,
        };
        let codes = codes_8(
            &[of(false), Plane::Constant(0.5), Plane::Constant(0.0), of(true)],
            encoding,
        );
        assert_eq!(codes, [137, 188, 0, 191, 255, 188, 0, 0], "alpha is linear");
    }

    #[test]
    fn floats_are_exact() {
        let pixels = ChannelPixels {
            components: 1,
            data: vec![0.1, -7.25, f32::MIN_POSITIVE, 1e20],
        };
        let encoding = |format| Encoding {
            size: [2, 2],
            format,
            is_srgb: false,
            is_dithered: false,
        };
        let heights = planes(&pixels, Codes::Range([-7.25, 1e20]));
        let file = encode(&heights, encoding(Format::Exr)).unwrap();
        assert_eq!(decode("a.exr", &file).unwrap().pixels, Pixels::F32(pixels.data.clone()));
        let half = encode(&planes(&pixels, Codes::Unit), encoding(Format::ExrHalf)).unwrap();
        let expected = vec![0.099_975_586, -7.25, 0.0, 65504.0];
        assert_eq!(decode("a.exr", &half).unwrap().pixels, Pixels::F32(expected));
    }
}
