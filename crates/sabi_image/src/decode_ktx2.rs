//! KTX2 textures (KTX File Format Specification 2.0): Basis Universal, which is converted to RGBA, and uncompressed 8-bit
//! texels. The first level becomes the image.

use std::io::Read;
use std::ops::Range;

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use ruzstd::StreamingDecoder;
use sabi_cancel::LookingReader;

use crate::error::damaged;
use crate::size_limits::{DecodedSize, check_size};
use crate::{DeclaredColorSpace, ImageError, Picture, PictureRemarks, Pixels};

pub(crate) const IDENTIFIER: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
const NAME: &str = "KTX2";

/// Offsets of the header's fields.
const VK_FORMAT: usize = 12;
const SIZE: [usize; 3] = [20, 24, 28];
const LAYERS: usize = 32;
const FACES: usize = 36;
const SCHEME: usize = 44;
const DESCRIPTOR: usize = 48;
const KEY_VALUES: Range<usize> = 56..64;
const GLOBAL_DATA: usize = 64;
const FIRST_LEVEL: usize = 80;
/// Offsets in the data format descriptor (Khronos Data Format Specification 1.3), after its total size.
const COLOR_MODEL: usize = 12;
const TRANSFER: usize = 14;
const TRANSFER_LINEAR: u8 = 1;
const TRANSFER_SRGB: u8 = 2;
/// Size of a Basis Universal block: 4 × 4 texels. In UASTC each block takes 16 bytes.
const BLOCK_SIDE: u64 = 4;
const UASTC_BLOCK_BYTES: u64 = 16;

/// Storage of the texels.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Texels {
    Etc1s,
    Uastc,
    /// This number of 8-bit channels.
    Plain(u8),
}

/// Supercompression of a level.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Scheme {
    None,
    BasisLz,
    Zstandard,
}

/// Header of a texture.
struct Ktx2Header {
    width: u32,
    height: u32,
    texels: Texels,
    scheme: Scheme,
    color_space: DeclaredColorSpace,
    /// Byte range of the first level in the file.
    level: Range<usize>,
}

/// Checks that [`decode_ktx2`] accepts the bytes, reading only the header.
pub(crate) fn check_ktx2(name: &str, bytes: &[u8]) -> Result<DecodedSize, ImageError> {
    let header = read_header(name, bytes)?;
    let channels = match header.texels {
        Texels::Etc1s | Texels::Uastc => 4,
        Texels::Plain(channels) => channels,
    };
    Ok(DecodedSize::of_pixels([header.width, header.height], channels.into()))
}

/// Decodes a KTX2 file to RGBA, or to RGB if that is stored.
pub(crate) fn decode_ktx2(name: &str, bytes: &[u8]) -> Result<Picture, ImageError> {
    let header = read_header(name, bytes)?;
    let (channels, samples) = match header.texels {
        Texels::Etc1s | Texels::Uastc => (4, transcoded(name, bytes)?),
        Texels::Plain(channels) => (channels, plain(name, &bytes[header.level.clone()], &header, channels)?),
    };
    Ok(Picture {
        width: header.width,
        height: header.height,
        channels,
        pixels: Pixels::U8(samples),
        color_space: header.color_space,
        remarks: PictureRemarks::default(),
    })
}

/// Returns a Basis Universal texture as RGBA.
fn transcoded(name: &str, bytes: &[u8]) -> Result<Vec<u8>, ImageError> {
    let contradiction = |_| damaged(name, NAME, "its contents contradict each other");
    // Remove keys and values: they are not needed for the texels and may be invalid.
    let mut file = bytes.to_vec();
    file[KEY_VALUES].fill(0);
    let texture = Transcoder::new(&file).map_err(contradiction)?;
    texture
        .transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE)
        .map_err(contradiction)
}

/// Returns the samples of uncompressed texels.
fn plain(name: &str, level: &[u8], header: &Ktx2Header, channels: u8) -> Result<Vec<u8>, ImageError> {
    let size = header.width as usize * header.height as usize * usize::from(channels);
    if header.scheme == Scheme::None {
        // The length was checked before.
        return Ok(level[..size].to_vec());
    }
    let frame = StreamingDecoder::new(LookingReader(level)).map_err(|error| damaged(name, NAME, error))?;
    let mut samples = Vec::new();
    let read = frame.take(size as u64).read_to_end(&mut samples);
    match read.map_err(|error| damaged(name, NAME, error))? {
        read if read == size => Ok(samples),
        _ => Err(damaged(name, NAME, "its first level ends too early")),
    }
}

/// Reads the little-endian 32-bit number at an offset.
fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_le_bytes(*word))
}

/// Reads the little-endian 64-bit number at an offset.
fn long(bytes: &[u8], at: usize) -> Option<u64> {
    let long = bytes.get(at..)?.first_chunk()?;
    Some(u64::from_le_bytes(*long))
}

/// Reads the range of the file whose start and length are stored at an offset of the header.
fn range(bytes: &[u8], at: usize) -> Option<Range<usize>> {
    let start = usize::try_from(long(bytes, at)?).ok()?;
    let end = start.checked_add(usize::try_from(long(bytes, at + 8)?).ok()?)?;
    (end <= bytes.len()).then_some(start..end)
}

/// Returns a lower bound for the bytes of the first level after decompression; 0 if there is none.
fn first_level_bytes(texels: Texels, [width, height]: [u32; 2]) -> u64 {
    let pixels = u64::from(width) * u64::from(height);
    match texels {
        Texels::Plain(channels) => pixels * u64::from(channels),
        Texels::Uastc => {
            let blocks = [width, height].map(|side| u64::from(side).div_ceil(BLOCK_SIDE));
            blocks[0] * blocks[1] * UASTC_BLOCK_BYTES
        }
        // A run of blocks can take less than a bit.
        Texels::Etc1s => 0,
    }
}

/// Returns the storage of the texels, given Vulkan's format number, the color model and the supercompression. The error is
/// a clause about what is not supported.
fn texels(format: u32, model: u8, scheme: Scheme) -> Result<Texels, String> {
    Ok(match (format, model, scheme) {
        // Vulkan's numbers for R8G8B8 and R8G8B8A8, UNORM and SRGB.
        (23 | 29, _, Scheme::None | Scheme::Zstandard) => Texels::Plain(3),
        (37 | 43, _, Scheme::None | Scheme::Zstandard) => Texels::Plain(4),
        (0, 163, Scheme::BasisLz) => Texels::Etc1s,
        (0, 166, Scheme::None | Scheme::Zstandard) => Texels::Uastc,
        (0, other, _) => return Err(format!("its texels are of the color model {other}")),
        (other, ..) => return Err(format!("its texels are of Vulkan's format {other}")),
    })
}

fn read_header(name: &str, bytes: &[u8]) -> Result<Ktx2Header, ImageError> {
    let cut_off = || damaged(name, NAME, "the file ends too early");
    let number = |at| word(bytes, at).ok_or_else(cut_off);
    let feature = |feature: String| ImageError::Feature {
        name: name.into(),
        format: "PNG",
        feature,
    };
    let [width, height, depth] = SIZE.map(number);
    let (width, height) = (width?, height?);
    check_size(name, width.into(), height.into(), 4)?;
    if width == 0 || height == 0 {
        return Err(damaged(name, NAME, "it has no pixels"));
    }
    if depth? > 0 || number(LAYERS)? > 1 || number(FACES)? != 1 {
        return Err(feature("it holds several pictures or a volume".into()));
    }
    let scheme = match number(SCHEME)? {
        0 => Scheme::None,
        1 => Scheme::BasisLz,
        2 => Scheme::Zstandard,
        other => return Err(feature(format!("it is compressed in the way {other} of KTX2"))),
    };
    let descriptor = number(DESCRIPTOR)? as usize;
    let byte = |at: usize| bytes.get(descriptor.checked_add(at)?).copied();
    let model = byte(COLOR_MODEL).ok_or_else(cut_off)?;
    let texels = texels(number(VK_FORMAT)?, model, scheme).map_err(feature)?;
    let level = range(bytes, FIRST_LEVEL).ok_or_else(cut_off)?;
    range(bytes, GLOBAL_DATA).ok_or_else(cut_off)?;
    let claimed = long(bytes, FIRST_LEVEL + 16).ok_or_else(cut_off)?;
    let size = first_level_bytes(texels, [width, height]);
    if scheme == Scheme::None && (level.len() as u64) < size {
        return Err(damaged(name, NAME, "its first level ends too early"));
    }
    // The decoder allocates as many bytes as the level declares.
    if scheme == Scheme::Zstandard && claimed != size {
        return Err(damaged(
            name,
            NAME,
            "the size of its first level contradicts its pixels",
        ));
    }
    Ok(Ktx2Header {
        width,
        height,
        texels,
        scheme,
        color_space: match byte(TRANSFER) {
            Some(TRANSFER_LINEAR) => DeclaredColorSpace::Linear,
            Some(TRANSFER_SRGB) => DeclaredColorSpace::Srgb,
            _ => DeclaredColorSpace::Unknown,
        },
        level,
    })
}

#[cfg(test)]
mod tests;
