//! Decoding of image files to a [`Picture`].

use std::borrow::Cow;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use sabi_cancel::{LookingReader, is_canceled};

use self::alpha::with_straight_alpha;
use crate::declared_color::declared_by_png;
use crate::decode_bmp;
use crate::decode_exr::{check_exr, decode_exr, exr_layer_names};
use crate::decode_hdr::HdrFile;
use crate::decode_ktx2::{self, check_ktx2, decode_ktx2};
use crate::error::damaged;
use crate::size_limits::{DecodedSize, MAX_DECODED_BYTES, check_size};
use crate::{DeclaredColorSpace, ImageError, Picture, PictureRemarks, Pixels};

/// Maximum compression ratio of deflate (RFC 1951: 258 bytes from 2 bits).
const DEFLATE_BEST_RATIO: u64 = 1032;
/// Maximum number of pixels for each byte of a JPEG: at least a bit for each 8 × 8 block (ITU-T T.81: no Huffman code is shorter).
const JPEG_PIXELS_A_BYTE: u64 = 8 * 8 * 8;
/// Maximum number of pixels for each byte of a TGA: a run of 128 pixels takes two bytes.
const TGA_PIXELS_A_BYTE: u64 = 64;

/// Decodes a PNG, JPEG, WebP, TGA, BMP, Radiance HDR, OpenEXR or KTX2 file. The format is recognized by the content (TGA,
/// which has no signature, by the extension of the name). `name` is used in messages. Sizes are checked before memory is
/// allocated. If an OpenEXR file has several layers, the first of [`layer_names`] is read. Ends early once it is canceled
/// ([`sabi_cancel`]), but not within a JPEG or Basis Universal picture.
pub fn decode(name: &str, bytes: &[u8]) -> Result<Picture, ImageError> {
    decode_chosen(name, bytes, None)
}

/// Decodes one layer of an OpenEXR file, which is given by one of the [`layer_names`]. Otherwise like [`decode`].
///
/// # Errors
/// The file has no such layer.
pub fn decode_layer(name: &str, bytes: &[u8], layer: &str) -> Result<Picture, ImageError> {
    decode_chosen(name, bytes, Some(layer))
}

fn decode_chosen(name: &str, bytes: &[u8], layer: Option<&str>) -> Result<Picture, ImageError> {
    guarded(name, bytes, |format| match (format, layer) {
        (ImageFileFormat::Exr, layer) => decode_exr(name, bytes, layer),
        (_, Some(asked)) => Err(ImageError::Layer {
            name: name.into(),
            asked: asked.into(),
            layers: Vec::new(),
        }),
        (ImageFileFormat::Png, None) => decode_png(name, bytes),
        (ImageFileFormat::Ktx2, None) => decode_ktx2(name, bytes),
        (ImageFileFormat::Hdr, None) => HdrFile::open(name, bytes)?.decode(name),
        (ImageFileFormat::Other(format), None) => decode_other(name, bytes, format),
    })
}

/// Lists the layers of an OpenEXR file, reading only its header. The layer that [`decode`] reads is the first. Files of other formats have
/// no layers. A layer consists of the channels of a part with a common prefix: color, a luminance, a vector (X, Y, Z) or a single channel.
/// Colors without a prefix come first, then layers with names of a finished image, such as `beauty` and `Combined`.
pub fn layer_names(name: &str, bytes: &[u8]) -> Result<Vec<String>, ImageError> {
    guarded(name, bytes, |format| match format {
        ImageFileFormat::Exr => exr_layer_names(name, bytes),
        ImageFileFormat::Png | ImageFileFormat::Ktx2 | ImageFileFormat::Hdr | ImageFileFormat::Other(_) => {
            Ok(Vec::new())
        }
    })
}

/// Checks that [`decode`] accepts the bytes, reading only the header. No pixels are decoded. The errors are those of [`decode`].
pub fn check_header(name: &str, bytes: &[u8]) -> Result<(), ImageError> {
    decoded_size(name, bytes).map(drop)
}

/// Returns the number of pixels, and the size of the decoded image in bytes, reading only the header. The errors are those of [`decode`].
pub fn decoded_size(name: &str, bytes: &[u8]) -> Result<DecodedSize, ImageError> {
    guarded(name, bytes, |format| match format {
        ImageFileFormat::Png => {
            let reader = open_png(name, bytes)?;
            let info = reader.info();
            let (color, depth) = reader.output_color_type();
            let pixel_bytes = color.samples() as u64 * sample_bytes(depth);
            Ok(DecodedSize::of_pixels([info.width, info.height], pixel_bytes))
        }
        ImageFileFormat::Exr => check_exr(name, bytes),
        ImageFileFormat::Ktx2 => check_ktx2(name, bytes),
        ImageFileFormat::Hdr => Ok(HdrFile::open(name, bytes)?.decoded_size()),
        ImageFileFormat::Other(format) => {
            let plain = plain_of(name, bytes, format)?;
            let decoder = open_other(name, &plain, format)?;
            let (width, height) = decoder.dimensions();
            let pixel_bytes = u64::from(decoder.color_type().bytes_per_pixel());
            Ok(DecodedSize::of_pixels([width, height], pixel_bytes))
        }
    })
}

/// Calls `read` with the format of the bytes. A panic in a decoder of another crate becomes an error.
fn guarded<T>(
    name: &str,
    bytes: &[u8],
    read: impl FnOnce(ImageFileFormat) -> Result<T, ImageError>,
) -> Result<T, ImageError> {
    let format = recognize(name, bytes)?;
    match catch_unwind(AssertUnwindSafe(|| read(format))) {
        Ok(read) => read,
        Err(payload) if is_canceled(payload.as_ref()) => resume_unwind(payload),
        Err(_) => Err(damaged(name, format.name(), "its contents contradict each other")),
    }
}

#[derive(Clone, Copy)]
enum ImageFileFormat {
    Png,
    Exr,
    Ktx2,
    Hdr,
    /// Format that the `image` crate decodes.
    Other(ImageFormat),
}

impl ImageFileFormat {
    fn name(self) -> &'static str {
        match self {
            ImageFileFormat::Png => "PNG",
            ImageFileFormat::Exr => "OpenEXR",
            ImageFileFormat::Ktx2 => "KTX2",
            ImageFileFormat::Hdr => "HDR",
            ImageFileFormat::Other(ImageFormat::Jpeg) => "JPEG",
            ImageFileFormat::Other(ImageFormat::WebP) => "WebP",
            ImageFileFormat::Other(ImageFormat::Tga) => "TGA",
            ImageFileFormat::Other(ImageFormat::Bmp) => "BMP",
            ImageFileFormat::Other(_) => "picture",
        }
    }
}

/// Signatures of common files that are not supported, so that the message can name them.
const FOREIGN: [(usize, &[u8], &str); 31] = [
    (0, b"GIF8", "a GIF picture"),
    (0, b"II*\0", "a TIFF picture"),
    (0, b"MM\0*", "a TIFF picture"),
    (0, b"II+\0", "a BigTIFF picture"),
    (0, b"MM\0+", "a BigTIFF picture"),
    (0, b"8BPS", "a Photoshop document"),
    (0, b"DDS ", "a DDS texture"),
    (0, b"\xabKTX", "a KTX texture of version 1"),
    (0, b"\0\0\x01\0", "an icon"),
    (0, b"%PDF", "a PDF document"),
    (0, b"<svg", "an SVG drawing"),
    (4, b"ftypavif", "an AVIF picture"),
    (4, b"ftypheic", "an HEIC picture"),
    (4, b"ftypmif1", "an HEIF picture"),
    (0, b"\0\0\0\x0cjP  ", "a JPEG 2000 picture"),
    (0, b"\xff\x4f\xff\x51", "a JPEG 2000 picture"),
    (0, b"\0\0\0\x0cJXL ", "a JPEG XL picture"),
    (0, b"\xff\x0a", "a JPEG XL picture"),
    (0, b"gimp xcf", "a GIMP document"),
    (0, b"qoif", "a QOI picture"),
    (0, b"SDPX", "a DPX picture"),
    (0, b"XPDS", "a DPX picture"),
    (0, b"\x01\xda", "an SGI picture"),
    (0, b"\x0a\x05\x01", "a PCX picture"),
    (0, b"P5\n", "a PGM picture"),
    (0, b"P6\n", "a PPM picture"),
    (0, b"PF\n", "a PFM picture"),
    (0, b"Pf\n", "a PFM picture"),
    (0, b"PK\x03\x04", "an archive (zip)"),
    (0, b"<!DOCTYPE", "a web page"),
    (0, b"<html", "a web page"),
];
/// First bytes of the text that Git LFS checks out in place of a file that was not fetched (Git LFS specification, "The Pointer").
const GIT_LFS_POINTER: &[u8] = b"version https://git-lfs";
/// Bytes of a drawing in XML among which its root is looked for.
const ROOT_WITHIN: usize = 1024;

/// Returns the kind of a file that is not read, with its article; none for an unknown one.
fn foreign_kind(bytes: &[u8]) -> Option<&'static str> {
    let start = &bytes[..bytes.len().min(ROOT_WITHIN)];
    if start.starts_with(b"<?xml") && start.windows(4).any(|root| root == b"<svg") {
        return Some("an SVG drawing");
    }
    if bytes.starts_with(b"BA") && bytes.get(14..16) == Some(b"BM") {
        return Some("an array of OS/2 bitmaps");
    }
    let mut marks = FOREIGN.iter();
    let found = marks.find(|(at, mark, _)| bytes.get(*at..).is_some_and(|rest| rest.starts_with(mark)));
    found.map(|(_, _, kind)| *kind)
}

/// Returns true for bytes that may be a TGA: its kinds of color map and of pixels have few values (Truevision TGA 2.0, C.2).
fn is_tga(bytes: &[u8]) -> bool {
    matches!(bytes, [_, 0 | 1, 1..=3 | 9..=11, ..])
}

fn recognize(name: &str, bytes: &[u8]) -> Result<ImageFileFormat, ImageError> {
    if bytes.is_empty() {
        return Err(ImageError::Empty { name: name.into() });
    }
    let is_webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let format = match bytes {
        [0x89, b'P', b'N', b'G', ..] => ImageFileFormat::Png,
        [0x76, 0x2f, 0x31, 0x01, ..] => ImageFileFormat::Exr,
        [0xff, 0xd8, 0xff, ..] => ImageFileFormat::Other(ImageFormat::Jpeg),
        [b'#', b'?', ..] => ImageFileFormat::Hdr,
        _ if bytes.starts_with(decode_ktx2::IDENTIFIER) => ImageFileFormat::Ktx2,
        _ if is_webp => ImageFileFormat::Other(ImageFormat::WebP),
        [b'B', b'M', ..] if bytes.len() >= 26 => ImageFileFormat::Other(ImageFormat::Bmp),
        _ => {
            // A mark of two bytes may be the beginning of a TGA, which has none.
            if name.to_ascii_lowercase().ends_with(".tga") && is_tga(bytes) {
                return Ok(ImageFileFormat::Other(ImageFormat::Tga));
            }
            if bytes.starts_with(GIT_LFS_POINTER) {
                return Err(ImageError::Pointer { name: name.into() });
            }
            let kind = foreign_kind(bytes).unwrap_or("no picture of a known kind");
            return Err(ImageError::Unsupported {
                name: name.into(),
                kind: kind.into(),
            });
        }
    };
    Ok(format)
}

/// Opens a PNG and reads everything before its pixels.
fn open_png<'b>(name: &str, bytes: &'b [u8]) -> Result<png::Reader<LookingReader<Cursor<&'b [u8]>>>, ImageError> {
    let damaged = |error: png::DecodingError| damaged(name, "PNG", error);
    let limits = png::Limits {
        bytes: MAX_DECODED_BYTES as usize,
    };
    let mut decoder = png::Decoder::new_with_limits(LookingReader(Cursor::new(bytes)), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    // A small profile may unpack to gigabytes. `declared_by_png` reads the beginning.
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(damaged)?;
    let (width, height) = (header.width, header.height);
    check_size(name, width.into(), height.into(), header.bytes_per_pixel() as u64)?;
    let reader = decoder.read_info().map_err(damaged)?;
    let (color, depth) = reader.output_color_type();
    let pixel_bytes = color.samples() as u64 * sample_bytes(depth);
    check_size(name, width.into(), height.into(), pixel_bytes)?;
    // A pixel of the file may take only a single bit.
    let least_bytes = u64::from(width) * u64::from(height) / 8 / DEFLATE_BEST_RATIO;
    if (bytes.len() as u64) < least_bytes {
        return Err(self::damaged(name, "PNG", "the file ends too early"));
    }
    Ok(reader)
}

/// Returns the size of a sample in bytes after expansion to whole bytes.
fn sample_bytes(depth: png::BitDepth) -> u64 {
    if depth == png::BitDepth::Sixteen { 2 } else { 1 }
}

/// Decodes a PNG. One whose last chunk (`IEND`, which is always the same) is missing and whose pixels are all there is read as a whole one.
fn decode_png(name: &str, bytes: &[u8]) -> Result<Picture, ImageError> {
    const END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";
    decode_png_with_end(name, bytes).or_else(|error| match bytes.ends_with(END) {
        true => Err(error),
        false => decode_png_with_end(name, &[bytes, END].concat()).map_err(|_| error),
    })
}

fn decode_png_with_end(name: &str, bytes: &[u8]) -> Result<Picture, ImageError> {
    let mut reader = open_png(name, bytes)?;
    let (width, height) = (reader.info().width, reader.info().height);
    let declared = declared_by_png(reader.info(), bytes);
    let (color, depth) = reader.output_color_type();
    let channels = color.samples() as u8;
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| damaged(name, "PNG", "its size makes no sense"))?;
    let mut samples = vec![0u8; size];
    reader
        .next_frame(&mut samples)
        .map_err(|error| damaged(name, "PNG", error))?;
    let pixels = if sample_bytes(depth) == 2 {
        Pixels::U16(
            samples
                .chunks_exact(2)
                .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
                .collect(),
        )
    } else {
        Pixels::U8(samples)
    };
    Ok(Picture {
        width,
        height,
        channels,
        pixels,
        color_space: declared.space,
        remarks: declared.remarks,
    })
}

/// Converts an error of the `image` crate's decoders.
fn explain_other(name: &str, format: ImageFormat, error: image::ImageError) -> ImageError {
    let format = ImageFileFormat::Other(format).name();
    match error {
        image::ImageError::Unsupported(what) => ImageError::Feature {
            name: name.into(),
            format,
            feature: what.to_string(),
        },
        error => damaged(name, format, error),
    }
}

/// Opens an image of another format and reads everything before its pixels.
fn open_other<'b>(name: &str, bytes: &'b [u8], format: ImageFormat) -> Result<impl ImageDecoder + 'b, ImageError> {
    let format_name = ImageFileFormat::Other(format).name();
    if format == ImageFormat::Jpeg
        && let Some(feature) = jpeg_kind::unread_feature(bytes)
    {
        return Err(ImageError::Feature {
            name: name.into(),
            format: format_name,
            feature,
        });
    }
    if format == ImageFormat::Jpeg && !jpeg_is_complete(bytes) {
        return Err(damaged(name, format_name, "the file ends too early"));
    }
    let mut reader = ImageReader::with_format(LookingReader(Cursor::new(bytes)), format);
    // Sizes are checked below, with a clearer message. This limits the memory that the decoder itself allocates.
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(2 * MAX_DECODED_BYTES);
    reader.limits(limits);
    let decoder = reader
        .into_decoder()
        .map_err(|error| explain_other(name, format, error))?;
    let (width, height) = decoder.dimensions();
    check_size(
        name,
        width.into(),
        height.into(),
        u64::from(decoder.color_type().bytes_per_pixel()),
    )?;
    if width == 0 || height == 0 {
        return Err(damaged(name, format_name, "it has no pixels"));
    }
    let pixels_a_byte = match format {
        ImageFormat::Jpeg => JPEG_PIXELS_A_BYTE,
        ImageFormat::Tga => TGA_PIXELS_A_BYTE,
        _ => u64::MAX,
    };
    if (bytes.len() as u64) < u64::from(width) * u64::from(height) / pixels_a_byte {
        return Err(damaged(name, format_name, "the file ends too early"));
    }
    Ok(decoder)
}

/// Returns the bytes of a file in a form that the decoder of its format accepts.
fn plain_of<'b>(name: &str, bytes: &'b [u8], format: ImageFormat) -> Result<Cow<'b, [u8]>, ImageError> {
    match format {
        ImageFormat::Bmp => decode_bmp::plain(name, bytes),
        _ => Ok(Cow::Borrowed(bytes)),
    }
}

fn decode_other(name: &str, bytes: &[u8], format: ImageFormat) -> Result<Picture, ImageError> {
    let bytes = &plain_of(name, bytes, format)?;
    let decoder = open_other(name, bytes, format)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|error| explain_other(name, format, error))?;
    let (width, height) = (picture.width(), picture.height());
    let (picture, remark) = with_straight_alpha(bytes, format, picture);
    let channels = picture.color().channel_count();
    let pixels = samples_of(picture).map_err(|feature| ImageError::Feature {
        name: name.into(),
        format: ImageFileFormat::Other(format).name(),
        feature,
    })?;
    Ok(Picture {
        width,
        height,
        channels,
        pixels,
        color_space: DeclaredColorSpace::Unknown,
        remarks: PictureRemarks {
            values: remark.map(str::to_owned).into_iter().collect(),
            color: Vec::new(),
        },
    })
}

/// Returns the samples unchanged, or the name of their kind where it is not read.
fn samples_of(picture: DynamicImage) -> Result<Pixels, String> {
    Ok(match picture {
        DynamicImage::ImageLuma8(samples) => Pixels::U8(samples.into_raw()),
        DynamicImage::ImageLumaA8(samples) => Pixels::U8(samples.into_raw()),
        DynamicImage::ImageRgb8(samples) => Pixels::U8(samples.into_raw()),
        DynamicImage::ImageRgba8(samples) => Pixels::U8(samples.into_raw()),
        DynamicImage::ImageLuma16(samples) => Pixels::U16(samples.into_raw()),
        DynamicImage::ImageLumaA16(samples) => Pixels::U16(samples.into_raw()),
        DynamicImage::ImageRgb16(samples) => Pixels::U16(samples.into_raw()),
        DynamicImage::ImageRgba16(samples) => Pixels::U16(samples.into_raw()),
        DynamicImage::ImageRgb32F(samples) => Pixels::F32(samples.into_raw()),
        DynamicImage::ImageRgba32F(samples) => Pixels::F32(samples.into_raw()),
        other => return Err(format!("its pixels are of the kind {:?}", other.color())),
    })
}

/// Returns whether the end-of-image marker follows the last scan. Decoders fill missing data with gray and report no error.
fn jpeg_is_complete(bytes: &[u8]) -> bool {
    let last = |mark: [u8; 2]| bytes.windows(2).rposition(|pair| pair == mark);
    last([0xff, 0xd9]).is_some_and(|end| last([0xff, 0xda]).is_none_or(|scan| scan < end))
}

mod alpha;
mod jpeg_kind;
#[cfg(test)]
mod odd_kinds;
#[cfg(test)]
mod tests;
