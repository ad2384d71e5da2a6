//! PNG files, compressed strip by strip on all cores. The bytes do not depend on the number of cores.
//!
//! [`Rows`] provides the bytes in the order of the file, a sample of the rows decides the [`method::Method`], and each
//! strip of rows is filtered and deflated separately and becomes an `IDAT` chunk. The strips form one zlib stream (RFC
//! 1950): all but the last end at a byte boundary, and the checksum at the end is combined from their checksums.

mod choice;
mod filter;
mod method;
mod rows;
mod strip;

use std::fmt;
use std::ops::Range;

use rayon::prelude::*;
use zlib_rs::adler32::adler32_combine;
use zlib_rs::crc32::crc32;

use self::choice::chosen_method;
use self::rows::Rows;
use self::strip::Strip;
use crate::ImageError;

/// Format of a PNG file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PngOptions {
    /// Number of channels: 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha.
    pub channels: u8,
    /// Bits of a sample, 8 or 16.
    pub bits: u8,
    /// True if the file declares sRGB colors (an `sRGB` chunk, perceptual). Data maps declare no color space.
    pub srgb_chunk: bool,
}

/// Samples of a PNG file, row by row from the top, channels interleaved.
#[derive(Clone, Copy)]
pub enum PngData<'a> {
    /// For 8 bits.
    U8(&'a [u8]),
    /// For 16 bits, in native byte order; the file has them big-endian.
    U16(&'a [u16]),
    /// For 8 or 16 bits: rows that are computed in parts, so that the samples are never completely in memory. The function
    /// fills in the bytes of the rows with these numbers, 16 bits big-endian. It may be called several times for a row.
    Rows(&'a (dyn Fn(Range<usize>, &mut [u8]) + Sync)),
}

impl fmt::Debug for PngData<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            PngData::U8(_) => "samples of 8 bits",
            PngData::U16(_) => "samples of 16 bits",
            PngData::Rows(_) => "rows",
        })
    }
}

/// Size of a strip in bytes. It is fixed, so that the file does not depend on the number of cores.
const STRIP_BYTES: usize = 512 * 1024;
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// Length, name and checksum of a chunk.
const CHUNK_FRAME_BYTES: usize = 12;
/// Deflate with a window of 32 KiB, checked header (RFC 1950).
const ZLIB_HEADER: [u8; 2] = [0x78, 0x5e];

/// Encodes a PNG file. It contains no time, text or gamma, only what `options` require.
pub fn encode_png(width: u32, height: u32, data: PngData<'_>, options: PngOptions) -> Result<Vec<u8>, ImageError> {
    let refuse = |reason: String| ImageError::Encode { width, height, reason };
    check(width, height, data, options).map_err(refuse)?;
    let rows = Rows::new(width, height, data, options);
    let strips = compress(&rows).ok_or_else(|| refuse("the compressor gave up".into()))?;
    let deflated: usize = strips
        .iter()
        .map(|strip| strip.deflated.len() + CHUNK_FRAME_BYTES)
        .sum();
    let mut file = Vec::with_capacity(deflated + 128);
    file.extend_from_slice(&SIGNATURE);
    push_chunk(&mut file, *b"IHDR", &header(width, height, options));
    if options.srgb_chunk {
        // Gamma and primaries are omitted, since `sRGB` implies them. 0 means perceptual.
        push_chunk(&mut file, *b"sRGB", &[0]);
    }
    for strip in strips {
        push_checked_chunk(&mut file, *b"IDAT", &strip.deflated, strip.crc);
    }
    push_chunk(&mut file, *b"IEND", &[]);
    Ok(file)
}

fn check(width: u32, height: u32, data: PngData<'_>, options: PngOptions) -> Result<(), String> {
    if width == 0 || height == 0 {
        return Err("a PNG file needs at least one pixel".into());
    }
    if !(1..=4).contains(&options.channels) {
        return Err(format!("a PNG file has 1 to 4 channels, not {}", options.channels));
    }
    let (bits, samples) = match data {
        PngData::U8(samples) => (8, samples.len()),
        PngData::U16(samples) => (16, samples.len()),
        PngData::Rows(_) if matches!(options.bits, 8 | 16) => return Ok(()),
        PngData::Rows(_) => return Err(format!("a PNG file has 8 or 16 bits, not {}", options.bits)),
    };
    if bits != options.bits {
        return Err(format!("{} bits were asked for and {bits} bits given", options.bits));
    }
    let expected = u64::from(width) * u64::from(height) * u64::from(options.channels);
    if samples as u64 != expected {
        return Err(format!("{samples} samples were given instead of {expected}"));
    }
    Ok(())
}

/// Returns the content of `IHDR`: size, bit depth and color type; deflate, filters by row, not interlaced.
fn header(width: u32, height: u32, options: PngOptions) -> [u8; 13] {
    let color = match options.channels {
        1 => 0,
        2 => 4,
        3 => 2,
        _ => 6,
    };
    let [a, b, c, d] = width.to_be_bytes();
    let [e, f, g, h] = height.to_be_bytes();
    [a, b, c, d, e, f, g, h, options.bits, color, 0, 0, 0]
}

/// Compresses the strips of an image. The first starts the zlib stream and the last ends it.
fn compress(rows: &Rows<'_>) -> Option<Vec<Strip>> {
    let method = chosen_method(rows)?;
    let rows_per_strip = (STRIP_BYTES / (rows.row_bytes + 1)).max(1);
    let count = rows.height.div_ceil(rows_per_strip);
    let strip = |index: usize| {
        let first = index * rows_per_strip;
        let block = rows.block(first..(first + rows_per_strip).min(rows.height));
        let mut strip = Strip::new(&block, method)?;
        if index == 0 {
            strip.deflated.splice(..0, ZLIB_HEADER);
        }
        strip.crc = crc32(crc32(0, b"IDAT"), &strip.deflated);
        Some(strip)
    };
    let mut strips = (0..count).into_par_iter().map(strip).collect::<Option<Vec<Strip>>>()?;
    let adler = strips.iter().fold(1, |adler, strip| {
        adler32_combine(adler, strip.adler, strip.filtered_bytes)
    });
    let last = strips.last_mut()?;
    let adler = adler.to_be_bytes();
    last.deflated.extend_from_slice(&adler);
    last.crc = crc32(last.crc, &adler);
    Some(strips)
}

fn push_chunk(file: &mut Vec<u8>, name: [u8; 4], content: &[u8]) {
    push_checked_chunk(file, name, content, crc32(crc32(0, &name), content));
}

fn push_checked_chunk(file: &mut Vec<u8>, name: [u8; 4], content: &[u8], crc: u32) {
    file.extend_from_slice(&(content.len() as u32).to_be_bytes());
    file.extend_from_slice(&name);
    file.extend_from_slice(content);
    file.extend_from_slice(&crc.to_be_bytes());
}

#[cfg(test)]
mod tests;
