//! PNG files: one filter choice for each row, compressed strip by strip on all cores, the same bytes whatever the cores.

use flate2::{Compress, Compression, FlushCompress, Status};
use rayon::prelude::*;

use crate::ImageError;

/// Format of a PNG file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PngOptions {
    /// 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha.
    pub channels: u8,
    /// Bits of a sample, 8 or 16.
    pub bits: u8,
    /// True if the file declares sRGB colors (an `sRGB` chunk, perceptual). Data maps declare no color space.
    pub srgb_chunk: bool,
}

/// Samples of a PNG file, row by row from the top, channels interleaved.
#[derive(Clone, Copy, Debug)]
pub enum PngData<'a> {
    /// For 8 bits.
    U8(&'a [u8]),
    /// For 16 bits, in native byte order; the file has them big-endian.
    U16(&'a [u16]),
}

/// Uncompressed bytes of a strip. Fixed, so that the file does not depend on the number of cores.
const STRIP_BYTES: usize = 512 * 1024;
/// Deflate's effort, 0..9.
const LEVEL: u32 = 3;
const ADLER_MODULUS: u32 = 65521;

/// A PNG file of the samples. No time, no text, no gamma: only what `options` ask for.
pub fn encode_png(width: u32, height: u32, data: PngData<'_>, options: PngOptions) -> Result<Vec<u8>, ImageError> {
    let refuse = |reason: String| ImageError::Encode { width, height, reason };
    check(width, height, data, options).map_err(refuse)?;
    let row_bytes = width as usize * usize::from(options.channels) * usize::from(options.bits / 8);
    let pixel_bytes = usize::from(options.channels) * usize::from(options.bits / 8);
    let stream = compress_rows(height as usize, row_bytes, pixel_bytes, data)
        .ok_or_else(|| refuse("the compressor gave up".into()))?;
    let mut file = Vec::with_capacity(stream.len() + 128);
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(match options.channels {
        1 => png::ColorType::Grayscale,
        2 => png::ColorType::GrayscaleAlpha,
        3 => png::ColorType::Rgb,
        _ => png::ColorType::Rgba,
    });
    encoder.set_depth(if options.bits == 16 {
        png::BitDepth::Sixteen
    } else {
        png::BitDepth::Eight
    });
    let write = || -> Result<(), png::EncodingError> {
        let mut writer = encoder.write_header()?;
        if options.srgb_chunk {
            // Written directly: the encoder would add gamma and primaries, which `sRGB` implies.
            writer.write_chunk(png::chunk::sRGB, &[0])?;
        }
        writer.write_chunk(png::chunk::IDAT, &stream)?;
        writer.finish()
    };
    write().map_err(|error| refuse(error.to_string()))?;
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

struct Strip {
    deflated: Vec<u8>,
    adler: u32,
    bytes: usize,
}

/// A zlib stream of all filtered rows: strips deflated apart, each ending at a byte border, and one checksum over all.
fn compress_rows(height: usize, row_bytes: usize, pixel_bytes: usize, data: PngData<'_>) -> Option<Vec<u8>> {
    let rows_per_strip = (STRIP_BYTES / (row_bytes + 1)).max(1);
    let strips = height.div_ceil(rows_per_strip);
    let deflated: Vec<Option<Strip>> = (0..strips)
        .into_par_iter()
        .map(|strip| {
            let first = strip * rows_per_strip;
            let filtered = filter_rows(
                first..(first + rows_per_strip).min(height),
                row_bytes,
                pixel_bytes,
                data,
            );
            Some(Strip {
                deflated: deflate(&filtered, strip + 1 == strips)?,
                adler: adler32(&filtered),
                bytes: filtered.len(),
            })
        })
        .collect();
    // Deflate with a 32 KiB window, checked header (RFC 1950).
    let mut stream = vec![0x78, 0x5e];
    let mut adler = 1;
    for strip in deflated {
        let strip = strip?;
        stream.extend_from_slice(&strip.deflated);
        adler = adler32_join(adler, strip.adler, strip.bytes);
    }
    stream.extend_from_slice(&adler.to_be_bytes());
    Some(stream)
}

fn deflate(bytes: &[u8], last: bool) -> Option<Vec<u8>> {
    let mut compress = Compress::new(Compression::new(LEVEL), false);
    let mut out = Vec::with_capacity(bytes.len() / 2 + 1024);
    let flush = if last {
        FlushCompress::Finish
    } else {
        FlushCompress::Sync
    };
    loop {
        let consumed = compress.total_in() as usize;
        let status = compress.compress_vec(bytes.get(consumed..)?, &mut out, flush).ok()?;
        let everything_in = compress.total_in() as usize == bytes.len();
        match status {
            Status::StreamEnd => return Some(out),
            // A sync flush is complete once it leaves room in the output.
            _ if !last && everything_in && out.len() < out.capacity() => return Some(out),
            _ => out.reserve(bytes.len() / 4 + 1024),
        }
    }
}

/// Rows with the filter byte in front. Each row takes the filter whose differences are smallest in sum, the usual guess
/// at what compresses best (PNG specification, 12.8).
fn filter_rows(rows: std::ops::Range<usize>, row_bytes: usize, pixel_bytes: usize, data: PngData<'_>) -> Vec<u8> {
    let mut out = Vec::with_capacity(rows.len() * (row_bytes + 1));
    let mut above = vec![0u8; row_bytes];
    let mut current = vec![0u8; row_bytes];
    if rows.start > 0 {
        copy_row(rows.start - 1, &mut above, data);
    }
    let mut trials = [const { Vec::new() }; 3];
    for row in rows {
        copy_row(row, &mut current, data);
        let (filter, best) = choose_filter(&current, &above, pixel_bytes, &mut trials);
        out.push(filter);
        out.extend_from_slice(best.map_or(&current[..], |index| &trials[index][..]));
        std::mem::swap(&mut above, &mut current);
    }
    out
}

fn copy_row(row: usize, bytes: &mut [u8], data: PngData<'_>) {
    match data {
        PngData::U8(samples) => bytes.copy_from_slice(&samples[row * bytes.len()..(row + 1) * bytes.len()]),
        PngData::U16(samples) => {
            let count = bytes.len() / 2;
            let source = &samples[row * count..(row + 1) * count];
            for (pair, sample) in bytes.chunks_exact_mut(2).zip(source) {
                pair.copy_from_slice(&sample.to_be_bytes());
            }
        }
    }
}

/// The filter's number in the file and which of `trials` holds the filtered row; none for the row as it is.
fn choose_filter(row: &[u8], above: &[u8], pixel_bytes: usize, trials: &mut [Vec<u8>; 3]) -> (u8, Option<usize>) {
    let [sub, up, paeth] = trials;
    for trial in [&mut *sub, &mut *up, &mut *paeth] {
        trial.resize(row.len(), 0);
    }
    let first = pixel_bytes.min(row.len());
    sub[..first].copy_from_slice(&row[..first]);
    for ((out, &byte), &left) in sub[first..].iter_mut().zip(&row[first..]).zip(row) {
        *out = byte.wrapping_sub(left);
    }
    for ((out, &byte), &over) in up.iter_mut().zip(row).zip(above) {
        *out = byte.wrapping_sub(over);
    }
    paeth[..first].copy_from_slice(&up[..first]);
    let neighbors = row.iter().zip(&above[first..]).zip(above);
    for ((out, &byte), ((&left, &over), &corner)) in paeth[first..].iter_mut().zip(&row[first..]).zip(neighbors) {
        *out = byte.wrapping_sub(paeth_predictor(left, over, corner));
    }
    // Filter numbers of the file format: 0 none, 1 left, 2 up, 4 Paeth. On a tie the lower one wins.
    let mut best = (cost(row), 0, None);
    for (index, (number, trial)) in [(1, &*sub), (2, &*up), (4, &*paeth)].into_iter().enumerate() {
        let cost = cost(trial);
        if cost < best.0 {
            best = (cost, number, Some(index));
        }
    }
    (best.1, best.2)
}

fn paeth_predictor(left: u8, over: u8, corner: u8) -> u8 {
    let (a, b, c) = (i16::from(left), i16::from(over), i16::from(corner));
    let (to_left, to_over, to_corner) = ((b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs());
    let over_or_corner = if to_over <= to_corner { over } else { corner };
    if to_left <= to_over && to_left <= to_corner {
        left
    } else {
        over_or_corner
    }
}

fn cost(bytes: &[u8]) -> u64 {
    bytes
        .chunks(4096)
        .map(|part| u64::from(part.iter().map(|&b| u32::from(b.min(b.wrapping_neg()))).sum::<u32>()))
        .sum()
}

fn adler32(bytes: &[u8]) -> u32 {
    let (mut low, mut high) = (1u32, 0u32);
    // The longest run after which neither sum can overflow (RFC 1950).
    for part in bytes.chunks(5552) {
        for &byte in part {
            low += u32::from(byte);
            high += low;
        }
        low %= ADLER_MODULUS;
        high %= ADLER_MODULUS;
    }
    high << 16 | low
}

/// Checksum of two runs of bytes from the checksum of each and the length of the second.
fn adler32_join(first: u32, second: u32, second_bytes: usize) -> u32 {
    let modulus = u64::from(ADLER_MODULUS);
    let (low_1, high_1) = (u64::from(first & 0xffff), u64::from(first >> 16));
    let (low_2, high_2) = (u64::from(second & 0xffff), u64::from(second >> 16));
    let low_1_less_one = low_1 + modulus - 1;
    let low = (low_1_less_one + low_2) % modulus;
    let high = (high_1 + high_2 + (second_bytes as u64 % modulus) * (low_1_less_one % modulus)) % modulus;
    (high as u32) << 16 | low as u32
}

#[cfg(test)]
mod tests;
