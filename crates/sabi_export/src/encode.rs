//! Encoding of packed components as a file.

use std::borrow::Cow;

use rayon::prelude::*;
use sabi_image::{
    Dither, DitherPattern, ExrSamples, ImageError, PngData, PngOptions, encode_exr, encode_png, encode_tga,
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
    /// Components of unit vectors that point anywhere, −1..1, also in floats; a vector without a direction is the middle code.
    Direction,
    /// −1..1; floats are written as they are.
    Signed,
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
        /// Arrangement of the noise, if gradients are dithered.
        dither: Option<DitherPattern>,
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
}

/// All components of a channel, without dithering.
pub(crate) fn planes(pixels: &ChannelPixels, codes: Codes) -> Vec<Plane<'_>> {
    let plane = |index| Plane::Channel {
        pixels,
        index,
        codes,
        is_inverted: false,
        dither: None,
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
        Format::Png { bits: 16 } => png(PngData::Rows(&|y, row| {
            code_row(planes, encoding, y, row.as_chunks_mut().0, |place, plane, is_color| {
                code_16(place, plane, is_color).to_be_bytes()
            });
        })),
        Format::Png { .. } => png(PngData::Rows(&|y, row| code_row(planes, encoding, y, row, code_8))),
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
        codes: Codes::Range(_) | Codes::Unit | Codes::Signed,
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
    let [width, height] = encoding.size.map(|side| side as usize);
    let row_bytes = width * planes.len().max(1);
    let mut codes = vec![0; row_bytes * height];
    let rows = codes.par_chunks_mut(row_bytes.max(1)).enumerate();
    rows.for_each(|(y, row)| code_row(planes, encoding, y, row, code_8));
    codes
}

/// 8-bit code of a pixel of a component.
fn code_8(place: Place, plane: &Plane<'_>, is_color: bool) -> u8 {
    let unit = plane.unit(place.pixel);
    let dither = plane.dither(place, is_color, 255.0);
    match (is_color, dither) {
        (true, Dither::Off) => srgb8_from_linear(unit),
        (true, dither) => dither.quantize_curved_u8(curved(unit, true), place.x, place.y),
        (false, dither) => dither.quantize_u8(unit, place.x, place.y),
    }
}

/// 16-bit code of a pixel of a component.
fn code_16(place: Place, plane: &Plane<'_>, is_color: bool) -> u16 {
    let dither = plane.dither(place, is_color, 65535.0);
    dither.quantize_u16(curved(plane.unit(place.pixel), is_color), place.x, place.y)
}

/// Value as whole numbers hold it: after the sRGB curve for colors.
fn curved(unit: f32, is_color: bool) -> f32 {
    if is_color {
        srgb_from_linear(unit.clamp(0.0, 1.0))
    } else {
        unit
    }
}

/// Pixel of a file.
#[derive(Clone, Copy)]
struct Place {
    x: u32,
    y: u32,
    pixel: usize,
    size: [u32; 2],
}

impl Place {
    /// Returns the pixels beside, above and below.
    fn neighbors(self) -> impl Iterator<Item = usize> {
        let [width, height] = self.size;
        let sides = [
            (self.x > 0).then(|| self.pixel - 1),
            (self.x + 1 < width).then(|| self.pixel + 1),
            (self.y > 0).then(|| self.pixel - width as usize),
            (self.y + 1 < height).then(|| self.pixel + width as usize),
        ];
        sides.into_iter().flatten()
    }
}

/// Fills a row with the codes of its pixels, components interleaved.
fn code_row<T>(
    planes: &[Plane<'_>],
    encoding: Encoding,
    y: usize,
    row: &mut [T],
    code: impl Fn(Place, &Plane<'_>, bool) -> T,
) {
    let width = encoding.size[0] as usize;
    let count = planes.len().max(1);
    for (x, codes) in row.chunks_exact_mut(count).enumerate() {
        let place = Place {
            x: x as u32,
            y: y as u32,
            pixel: y * width + x,
            size: encoding.size,
        };
        for (at, (slot, plane)) in codes.iter_mut().zip(planes).enumerate() {
            // Alpha is linear beside colors, too.
            let is_color = encoding.is_srgb && (at < 3 && !(count == 2 && at == 1));
            *slot = code(place, plane, is_color);
        }
    }
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
            ..
        } = self
        else {
            return self.float(pixel);
        };
        let values = values(pixels, pixel);
        let unit = match codes {
            Codes::Unit => values[*index],
            Codes::Direction => direction(values)[*index] * 0.5 + 0.5,
            Codes::Signed => values[*index] * 0.5 + 0.5,
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
                ..
            } => {
                let value = values(pixels, pixel)[*index];
                if *is_inverted { low + high - value } else { value }
            }
            Plane::Channel {
                pixels,
                index,
                codes: codes @ (Codes::Direction | Codes::Signed),
                is_inverted,
                ..
            } => {
                let values = values(pixels, pixel);
                let value = match codes {
                    Codes::Direction => direction(values)[*index],
                    _ => values[*index],
                };
                if *is_inverted { -value } else { value }
            }
            Plane::Channel { .. } => self.unit(pixel),
        }
    }

    /// Returns how a pixel is rounded to one of `highest` + 1 codes: dithered where the slope to a neighbor is less than two
    /// codes. An area of one value would only get noise; so would an edge, whose pixels differ by more.
    fn dither(&self, place: Place, is_color: bool, highest: f32) -> Dither {
        let Plane::Channel {
            dither: Some(pattern), ..
        } = self
        else {
            return Dither::Off;
        };
        let value = |pixel| curved(self.unit(pixel), is_color).clamp(0.0, 1.0) * highest;
        let own = value(place.pixel);
        let is_gentle = |other: usize| {
            let step = (value(other) - own).abs();
            step > 0.0 && step < 2.0
        };
        if place.neighbors().any(is_gentle) {
            Dither::BlueNoise(*pattern)
        } else {
            Dither::Off
        }
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

/// A vector of unit length, or 0 where it has no direction.
fn direction(values: &[f32]) -> [f32; 3] {
    let [x, y, z] = match values {
        [x, y, z] => [*x, *y, *z],
        _ => [0.0; 3],
    };
    let length = (x * x + y * y + z * z).sqrt();
    match length > 1e-6 && length.is_finite() {
        true => [x, y, z].map(|part| part / length),
        false => [0.0; 3],
    }
}

#[cfg(test)]
mod tests;
