//! OpenEXR files with floats, compressed block by block on all cores. The bytes do not depend on the number of cores.
//!
//! The layout follows "OpenEXR File Layout" (openexr.com): one part, scan lines, ZIP.

use half::f16;
use rayon::prelude::*;
use zlib_rs::{DeflateConfig, ReturnCode, compress_bound, compress_slice};

use crate::ImageError;

/// Rows that ZIP compresses together.
const BLOCK_ROWS: usize = 16;
/// Compression level of deflate, 0..9: the lowest. Floats have few repetitions except for the padding, which this level
/// finds as well. Higher levels take twice the time for files that are smaller by a few percent.
const LEVEL: i32 = 1;
/// Maximum length of a name that every reader accepts, in bytes.
const LONGEST_NAME: usize = 31;
const MAGIC_AND_VERSION: [u8; 8] = [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
/// Constants of the file format.
const HALF: u32 = 1;
const FLOAT: u32 = 2;
const ZIP: u8 = 3;
const INCREASING_Y: u8 = 0;

/// Samples of an OpenEXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExrSamples {
    /// 16-bit floats, rounded and limited to ±65504.
    Half,
    /// 32-bit floats, unchanged.
    Float,
}

/// Encodes an OpenEXR file with lossless ZIP compression. Each channel consists of its name (`Y`, or `R`, `G`, `B`) and `width × height`
/// values, row by row from the top. The file contains only its size and channels, no date and no program name.
pub fn encode_exr(
    width: u32,
    height: u32,
    channels: &[(&str, &[f32])],
    samples: ExrSamples,
) -> Result<Vec<u8>, ImageError> {
    let refuse = |reason: String| ImageError::Encode { width, height, reason };
    check(width, height, channels).map_err(refuse)?;
    let mut sorted = channels.to_vec();
    sorted.sort_by_key(|(name, _)| *name);
    let (columns, rows) = (width as usize, height as usize);
    let blocks: Vec<Option<Vec<u8>>> = (0..rows.div_ceil(BLOCK_ROWS))
        .into_par_iter()
        .map(|block| {
            let first = block * BLOCK_ROWS;
            compress(columns, first..(first + BLOCK_ROWS).min(rows), &sorted, samples)
        })
        .collect();
    let mut file = header(width, height, &sorted, samples);
    let table = file.len();
    file.resize(table + 8 * blocks.len(), 0);
    for (index, block) in blocks.into_iter().enumerate() {
        let block = block.ok_or_else(|| refuse("the compressor gave up".into()))?;
        let offset = file.len() as u64;
        file[table + 8 * index..][..8].copy_from_slice(&offset.to_le_bytes());
        file.extend_from_slice(&((index * BLOCK_ROWS) as u32).to_le_bytes());
        file.extend_from_slice(&(block.len() as u32).to_le_bytes());
        file.extend_from_slice(&block);
    }
    Ok(file)
}

fn check(width: u32, height: u32, channels: &[(&str, &[f32])]) -> Result<(), String> {
    if width == 0 || height == 0 || channels.is_empty() {
        return Err("an OpenEXR file needs at least one pixel and one channel".into());
    }
    let expected = u64::from(width) * u64::from(height);
    for (name, samples) in channels {
        if samples.len() as u64 != expected {
            return Err(format!(
                "channel {name} has {} values instead of {expected}",
                samples.len()
            ));
        }
        if name.is_empty() || name.len() > LONGEST_NAME || name.contains('\0') {
            return Err(format!("\"{name}\" cannot name a channel of an OpenEXR file"));
        }
    }
    Ok(())
}

fn header(width: u32, height: u32, channels: &[(&str, &[f32])], samples: ExrSamples) -> Vec<u8> {
    let mut list = Vec::new();
    for (name, _) in channels {
        list.extend_from_slice(name.as_bytes());
        list.push(0);
        // Linear (not logarithmic) perception, and one sample for each pixel.
        let kind = match samples {
            ExrSamples::Half => HALF,
            ExrSamples::Float => FLOAT,
        };
        for number in [kind, 0, 1, 1] {
            list.extend_from_slice(&u32::to_le_bytes(number));
        }
    }
    list.push(0);
    let window = [0, 0, width - 1, height - 1].map(u32::to_le_bytes).concat();
    let one = 1.0_f32.to_le_bytes();
    let attributes: [(&str, &str, &[u8]); 8] = [
        ("channels", "chlist", &list),
        ("compression", "compression", &[ZIP]),
        ("dataWindow", "box2i", &window),
        ("displayWindow", "box2i", &window),
        ("lineOrder", "lineOrder", &[INCREASING_Y]),
        ("pixelAspectRatio", "float", &one),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &one),
    ];
    let mut header = MAGIC_AND_VERSION.to_vec();
    for (name, kind, value) in attributes {
        for word in [name, kind] {
            header.extend_from_slice(word.as_bytes());
            header.push(0);
        }
        header.extend_from_slice(&(value.len() as u32).to_le_bytes());
        header.extend_from_slice(value);
    }
    header.push(0);
    header
}

/// Converts a block to its form in the file: rows, each with one channel after the other; even bytes before odd ones; each
/// byte as its difference from the previous one; then deflated, unless that makes it longer.
fn compress(
    columns: usize,
    rows: std::ops::Range<usize>,
    channels: &[(&str, &[f32])],
    samples: ExrSamples,
) -> Option<Vec<u8>> {
    let mut plain = Vec::with_capacity(rows.len() * columns * channels.len() * 4);
    for row in rows {
        for (_, values) in channels {
            let row = &values[row * columns..(row + 1) * columns];
            match samples {
                ExrSamples::Float => plain.extend(row.iter().flat_map(|value| value.to_le_bytes())),
                ExrSamples::Half => plain.extend(row.iter().flat_map(|value| half(*value).to_le_bytes())),
            }
        }
    }
    let mut split = vec![0; plain.len()];
    let (even, odd) = split.split_at_mut(plain.len() / 2);
    for ((pair, even), odd) in plain.chunks_exact(2).zip(even).zip(odd) {
        (*even, *odd) = (pair[0], pair[1]);
    }
    let mut before = *split.first()?;
    for byte in &mut split[1..] {
        let value = *byte;
        *byte = value.wrapping_sub(before).wrapping_add(128);
        before = value;
    }
    let mut deflated = vec![0; compress_bound(split.len())];
    let (written, code) = compress_slice(&mut deflated, &split, DeflateConfig::new(LEVEL));
    let bytes = written.len();
    if code != ReturnCode::Ok {
        return None;
    }
    deflated.truncate(bytes);
    deflated.shrink_to_fit();
    Some(if deflated.len() < plain.len() { deflated } else { plain })
}

/// Converts a float to 16 bits. Infinities are avoided, since they would spoil filters of programs that read the file.
fn half(value: f32) -> f16 {
    f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DeclaredColorSpace, Pixels, decode};

    #[test]
    fn floats_are_restored_bit_for_bit() {
        let values: Vec<f32> = (0..37 * 21).map(|i| f32::from_bits(0x3a00_0000 + i * 61_681)).collect();
        let negative: Vec<f32> = values.iter().map(|value| -value).collect();
        let gray = decode(
            "h.exr",
            &encode_exr(37, 21, &[("Y", &values)], ExrSamples::Float).unwrap(),
        )
        .unwrap();
        assert_eq!((gray.width, gray.height, gray.channels), (37, 21, 1));
        assert_eq!(gray.color_space, DeclaredColorSpace::Linear);
        assert_eq!(gray.pixels, Pixels::F32(values.clone()));
        let rgb = [("R", &values[..]), ("G", &negative[..]), ("B", &values[..])];
        let color = decode("c.exr", &encode_exr(37, 21, &rgb, ExrSamples::Float).unwrap()).unwrap();
        let expected = values.iter().zip(&negative).flat_map(|(&r, &g)| [r, g, r]).collect();
        assert_eq!((color.channels, color.pixels), (3, Pixels::F32(expected)));
    }

    #[test]
    fn halves_are_rounded_to_even_and_stay_finite() {
        let values = [0.1, -2049.0, 1e20, f32::NEG_INFINITY, 6e-8, 0.0];
        let file = encode_exr(3, 2, &[("Y", &values)], ExrSamples::Half).unwrap();
        // IEEE 754 binary16: 10 bits behind the leading one, steps of 2⁻²⁴ below 2⁻¹⁴.
        let expected = vec![0.099_975_586, -2048.0, 65504.0, -65504.0, 2.0_f32.powi(-24), 0.0];
        assert_eq!(decode("h.exr", &file).unwrap().pixels, Pixels::F32(expected));
    }

    #[test]
    fn encoding_twice_gives_the_same_bytes_without_date_or_program_name() {
        let values: Vec<f32> = (0..300 * 200).map(|i| (i as f32 * 0.37).sin()).collect();
        let once = encode_exr(300, 200, &[("Y", &values)], ExrSamples::Float).unwrap();
        assert_eq!(
            once,
            encode_exr(300, 200, &[("Y", &values)], ExrSamples::Float).unwrap()
        );
        let header = String::from_utf8_lossy(&once[..500]).into_owned();
        for word in ["capDate", "software", "owner", "comments"] {
            assert!(!header.contains(word), "{word}");
        }
    }

    #[test]
    fn the_number_of_threads_changes_no_byte() {
        let values: Vec<f32> = (0..70 * 50).map(|i| (i as f32 * 0.37).sin()).collect();
        let encode = || {
            encode_exr(
                70,
                50,
                &[("R", &values), ("G", &values), ("B", &values)],
                ExrSamples::Float,
            )
            .unwrap()
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(pool.install(encode), encode());
    }

    #[test]
    fn noise_is_stored_uncompressed() {
        let mut state = 1_u32;
        let values: Vec<f32> = (0..40 * 40)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                // Any bits except those of infinity and NaN.
                f32::from_bits(state & 0xbfff_ffff)
            })
            .collect();
        let file = encode_exr(40, 40, &[("Y", &values)], ExrSamples::Float).unwrap();
        assert_eq!(decode("n.exr", &file).unwrap().pixels, Pixels::F32(values));
    }

    #[test]
    fn a_name_that_readers_would_refuse_is_an_error() {
        for name in ["", "a\0b", "a name of more than thirty-one bytes"] {
            let error = encode_exr(1, 1, &[(name, &[0.0])], ExrSamples::Float)
                .unwrap_err()
                .to_string();
            assert!(error.ends_with("cannot name a channel of an OpenEXR file"), "{error}");
        }
    }

    #[test]
    fn a_wrong_number_of_values_is_an_error() {
        let error = encode_exr(4, 4, &[("Y", &[0.0; 15])], ExrSamples::Float).unwrap_err();
        assert_eq!(
            error.to_string(),
            "cannot encode a 4 × 4 picture: channel Y has 15 values instead of 16"
        );
        assert!(encode_exr(0, 4, &[("Y", &[])], ExrSamples::Float).is_err());
    }
}
