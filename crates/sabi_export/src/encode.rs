//! Encoding of packed components as a file.

mod code_rows;
mod plane;

use std::borrow::Cow;

use rayon::prelude::*;
use sabi_image::{ExrSamples, ImageError, PngData, PngOptions, encode_exr, encode_png, encode_tga};

use self::code_rows::code_rows;
pub(crate) use self::plane::{CodeMapping, ComponentPlane, planes};
use crate::preset::MapFormat;

/// Number of rows that are encoded together. It is large enough that the rows above and below, which dithering needs, take
/// little extra time.
const BLOCK_ROWS: usize = 32;

/// Encoding of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FileEncoding {
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    pub(crate) format: MapFormat,
    /// True if the sRGB curve is applied to all components, except the last of two or four.
    pub(crate) is_srgb: bool,
}

/// The bytes of a file of one to four components.
pub(crate) fn encode(planes: &[ComponentPlane<'_>], encoding: FileEncoding) -> Result<Vec<u8>, ImageError> {
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
        MapFormat::Png { bits: 16 } => png(PngData::Rows(&|rows, bytes| {
            code_rows::<[u8; 2]>(planes, encoding.size, encoding.is_srgb, rows, bytes.as_chunks_mut().0);
        })),
        MapFormat::Png { .. } => png(PngData::Rows(&|rows, bytes| {
            code_rows(planes, encoding.size, encoding.is_srgb, rows, bytes)
        })),
        MapFormat::Tga => encode_tga(width, height, planes.len() as u8, &codes_8(planes, encoding)),
        MapFormat::ExrHalf | MapFormat::Exr => {
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
                MapFormat::ExrHalf => ExrSamples::Half,
                _ => ExrSamples::Float,
            };
            encode_exr(width, height, &channels, samples)
        }
    }
}

/// Values of a component as floats, row by row from the top.
fn floats<'a>(plane: &ComponentPlane<'a>, [width, height]: [u32; 2]) -> Cow<'a, [f32]> {
    if let ComponentPlane::Channel {
        pixels,
        codes: CodeMapping::Range(_) | CodeMapping::Unit | CodeMapping::Signed,
        is_inverted: false,
        ..
    } = plane
        && pixels.components == 1
    {
        return Cow::Borrowed(&pixels.data);
    }
    let mut values = vec![0.0; width as usize * height as usize];
    let block_pixels = BLOCK_ROWS * width.max(1) as usize;
    let blocks = values.par_chunks_mut(block_pixels).enumerate();
    blocks.for_each(|(block, values)| {
        let first = block * block_pixels;
        plane.floats(first..first + values.len(), values);
    });
    Cow::Owned(values)
}

/// 8-bit codes, components interleaved.
pub(crate) fn codes_8(planes: &[ComponentPlane<'_>], encoding: FileEncoding) -> Vec<u8> {
    let [width, height] = encoding.size.map(|side| side as usize);
    let row_bytes = width * planes.len().max(1);
    let mut codes = vec![0; row_bytes * height];
    let blocks = codes.par_chunks_mut(BLOCK_ROWS * row_bytes.max(1)).enumerate();
    blocks.for_each(|(block, codes)| {
        let first = block * BLOCK_ROWS;
        code_rows(
            planes,
            encoding.size,
            encoding.is_srgb,
            first..(first + BLOCK_ROWS).min(height),
            codes,
        );
    });
    codes
}

#[cfg(test)]
mod tests;
