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
    /// A single value everywhere, 0..1.
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
mod tests;
