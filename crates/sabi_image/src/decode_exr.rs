//! OpenEXR files: one layer, at full resolution.

use std::io::Cursor;

use exr::image::{FlatSamples, Image, Layer, Layers};
use exr::meta::MetaData;
use exr::meta::attribute::IntegerBounds;
use exr::meta::header::Header;
use exr::prelude::{AnyChannels, ReadChannels as _, ReadLayers as _};
use sabi_cancel::LookingReader;

use crate::error::damaged;
use crate::exr_layers::{ExrLayer, ExrPart, layers};
use crate::size_limits::{DecodedSize, MAX_DECODED_BYTES, check_size};
use crate::{DeclaredColorSpace, ImageError, Picture, PictureRemarks, Pixels};

const FORMAT: &str = "OpenEXR";
const DEEP: &str = "it holds deep samples, several for each pixel";
/// Replacement for infinity: the largest half float, since most files use half floats.
const LARGEST_HALF: f32 = 65504.0;

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

/// Size and layers of the image in a file, according to its headers.
struct Headers {
    size: DecodedSize,
    /// Layers that form an image. The default layer is the first.
    layers: Vec<ExrLayer>,
}

/// Rejects unsupported files, reading only their headers.
pub(crate) fn check_exr(name: &str, bytes: &[u8]) -> Result<DecodedSize, ImageError> {
    read_headers(name, bytes).map(|headers| headers.size)
}

/// Reads the headers of a file, and rejects unsupported ones.
fn read_headers(name: &str, bytes: &[u8]) -> Result<Headers, ImageError> {
    // The flag for files with deep parts (OpenEXR file layout, version field, bit 11).
    if bytes.get(5).is_some_and(|flags| flags & 0x08 != 0) {
        return Err(unsupported(name, DEEP));
    }
    check_lengths(name, bytes)?;
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|error| explain(name, error))?;
    if meta.headers.is_empty() {
        return Err(damaged(name, FORMAT, "it has no layer"));
    }
    let mut all_bytes = 0;
    for header in &meta.headers {
        all_bytes += check_header(name, header)?;
    }
    // All layers of a file are decoded together.
    if all_bytes > MAX_DECODED_BYTES {
        return Err(unsupported(name, "its layers take more than 1 GiB together"));
    }
    let pixels = |header: &Header| header.layer_size.area() as u64;
    Ok(Headers {
        size: DecodedSize {
            // All channels are decoded, although at most four of them are used.
            bytes: all_bytes,
            pixels: meta.headers.iter().map(pixels).max().unwrap_or(0), // There is at least one layer.
        },
        layers: layers_of(name, &parts_of(&meta))?,
    })
}

/// Lists the names of the layers of a file that form an image, the default layer first, reading only its header.
pub(crate) fn exr_layer_names(name: &str, bytes: &[u8]) -> Result<Vec<String>, ImageError> {
    let headers = read_headers(name, bytes)?;
    Ok(headers.layers.into_iter().map(|layer| layer.name).collect())
}

/// Decodes the display window of a layer, or of the default layer. Pixels of the window that the file does not contain are 0.
pub(crate) fn decode_exr(name: &str, bytes: &[u8], asked: Option<&str>) -> Result<Picture, ImageError> {
    check_exr(name, bytes)?;
    // Decode on this thread: a panic in a worker thread of the decoder could not be caught.
    let image: Image<Layers<AnyChannels<FlatSamples>>> = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(LookingReader(Cursor::new(bytes)))
        .map_err(|error| explain(name, error))?;
    let parts: Vec<ExrPart> = image.layer_data.iter().map(part_of_decoded).collect();
    let layers = layers_of(name, &parts)?;
    let layer = match asked {
        None => layers.first(),
        Some(asked) => find_layer(&layers, asked),
    };
    let layer = layer.ok_or_else(|| no_layer(name, asked, &layers))?;
    Ok(compose(
        &image.layer_data[layer.part],
        image.attributes.display_window,
        &layer.channels,
    ))
}

/// Finds a layer by its name, or by its name ignoring case.
fn find_layer<'l>(layers: &'l [ExrLayer], asked: &str) -> Option<&'l ExrLayer> {
    let exact = layers.iter().find(|layer| layer.name == asked);
    exact.or_else(|| layers.iter().find(|layer| layer.name.eq_ignore_ascii_case(asked)))
}

fn no_layer(name: &str, asked: Option<&str>, layers: &[ExrLayer]) -> ImageError {
    ImageError::Layer {
        name: name.into(),
        asked: asked.unwrap_or_default().into(), // Without a requested layer the default one is shown, so this is not used.
        layers: layers.iter().map(|layer| layer.name.clone()).collect(),
    }
}

fn explain(name: &str, error: exr::error::Error) -> ImageError {
    match error {
        exr::error::Error::NotSupported(what) => unsupported(name, what.as_ref()),
        error => damaged(name, FORMAT, error),
    }
}

fn unsupported(name: &str, feature: &str) -> ImageError {
    ImageError::Feature {
        name: name.into(),
        format: FORMAT,
        feature: feature.into(),
    }
}

/// Most attributes of all headers of a file.
const MOST_ATTRIBUTES: usize = 10_000;
/// Most bytes of a list of channels, each of which takes about 20.
const MOST_CHANNEL_BYTES: usize = 1 << 18;

/// Rejects files with very many attributes or channels, each of which takes many times its bytes in memory (OpenEXR file layout:
/// after the version, attributes of a name, a type, a size and as many bytes, and an empty name behind each header). What is damaged
/// is told when it is read.
fn check_lengths(name: &str, bytes: &[u8]) -> Result<(), ImageError> {
    // The flag of files with several parts (version field, bit 12), whose headers end with an empty one.
    let has_parts = bytes.get(5).is_some_and(|flags| flags & 0x10 != 0);
    let mut rest = bytes.get(8..).unwrap_or_default(); // A file without a version is damaged.
    let (mut count, mut in_header) = (0, false);
    while let Some((attribute, behind)) = split_word(rest) {
        if attribute.is_empty() {
            if !has_parts || !in_header {
                break;
            }
            (rest, in_header) = (behind, false);
            continue;
        }
        let Some((kind, behind)) = split_word(behind) else {
            break;
        };
        let Some((size, behind)) = behind.split_first_chunk::<4>() else {
            break;
        };
        let size = u32::from_le_bytes(*size) as usize;
        if kind == b"chlist" && size > MOST_CHANNEL_BYTES {
            return Err(unsupported(name, "it has too many channels"));
        }
        let Some(behind) = behind.get(size..) else { break };
        (rest, count, in_header) = (behind, count + 1, true);
        if count > MOST_ATTRIBUTES {
            return Err(unsupported(name, "it has more than 10000 attributes"));
        }
    }
    Ok(())
}

/// Splits bytes at the first zero, which ends a text.
fn split_word(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|byte| *byte == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

/// Rejects unsupported layers. Returns the size of the decoded layer in bytes.
fn check_header(name: &str, header: &Header) -> Result<u64, ImageError> {
    if header.deep {
        return Err(unsupported(name, DEEP));
    }
    let window = header.shared_attributes.display_window.size;
    let data = header.layer_size;
    check_size(name, window.0 as u64, window.1 as u64, 16)?;
    let pixel_bytes = header.channels.bytes_per_pixel.max(1) as u64;
    check_size(name, data.0 as u64, data.1 as u64, pixel_bytes)?;
    if window.0 == 0 || window.1 == 0 {
        return Err(damaged(name, FORMAT, "it has no pixels"));
    }
    if header
        .channels
        .list
        .iter()
        .any(|channel| channel.sampling.0 != 1 || channel.sampling.1 != 1)
    {
        return Err(unsupported(
            name,
            "its color channels have fewer pixels than its brightness",
        ));
    }
    Ok(data.0 as u64 * data.1 as u64 * pixel_bytes)
}

/// Returns the parts of a file according to its headers.
fn parts_of(meta: &MetaData) -> Vec<ExrPart> {
    let parts = meta.headers.iter().map(|header| ExrPart {
        name: header.own_attributes.layer_name.as_ref().map(ToString::to_string),
        channels: header
            .channels
            .list
            .iter()
            .map(|channel| channel.name.to_string())
            .collect(),
    });
    parts.collect()
}

/// Converts a decoded layer to a part.
fn part_of_decoded(layer: &FlatLayer) -> ExrPart {
    let channels = layer.channel_data.list.iter();
    ExrPart {
        name: layer.attributes.layer_name.as_ref().map(ToString::to_string),
        channels: channels.map(|channel| channel.name.to_string()).collect(),
    }
}

/// Returns the layers that form an image, the default layer first.
///
/// # Errors
/// There is none.
fn layers_of(name: &str, parts: &[ExrPart]) -> Result<Vec<ExrLayer>, ImageError> {
    let layers = layers(parts);
    match layers.is_empty() {
        true => Err(unsupported(name, "it has no channels")),
        false => Ok(layers),
    }
}

fn compose(layer: &FlatLayer, window: IntegerBounds, picked: &[Option<usize>]) -> Picture {
    let (width, height) = (window.size.0, window.size.1);
    // Offset of the data window in the display window.
    let corner_x = i64::from(layer.attributes.layer_position.0) - i64::from(window.position.0);
    let corner_y = i64::from(layer.attributes.layer_position.1) - i64::from(window.position.1);
    let columns = overlap(corner_x, layer.size.0, width);
    let rows = overlap(corner_y, layer.size.1, height);
    let channels = picked.len();
    let mut samples = vec![0.0f32; width * height * channels];
    let there = picked
        .iter()
        .enumerate()
        .filter_map(|(offset, index)| Some((offset, (*index)?)));
    for (offset, index) in there {
        let source = &layer.channel_data.list[index].sample_data;
        for y in rows.clone() {
            let source_row = (y as i64 - corner_y) as usize * layer.size.0;
            for x in columns.clone() {
                let value = sample(source, source_row + (x as i64 - corner_x) as usize);
                samples[(y * width + x) * channels + offset] = value;
            }
        }
    }
    let replaced = make_finite(&mut samples, channels);
    Picture {
        width: width as u32,
        height: height as u32,
        channels: channels as u8,
        pixels: Pixels::F32(samples),
        color_space: DeclaredColorSpace::Linear,
        remarks: PictureRemarks {
            values: replaced.into_iter().collect(),
            color: Vec::new(),
        },
    }
}

fn overlap(corner: i64, length: usize, window: usize) -> std::ops::Range<usize> {
    let end = (corner + length as i64).clamp(0, window as i64) as usize;
    (corner.clamp(0, window as i64) as usize).min(end)..end
}

fn sample(samples: &FlatSamples, index: usize) -> f32 {
    match samples {
        FlatSamples::F16(list) => list.get(index).map_or(0.0, |value| value.to_f32()),
        // Pixels outside of the data window are 0.
        FlatSamples::F32(list) => list.get(index).copied().unwrap_or(0.0),
        FlatSamples::U32(list) => list.get(index).map_or(0.0, |&value| value as f32),
    }
}

/// Replaces NaN and infinity, which renderers write and any filter would spread. Returns a clause with the number of such pixels.
fn make_finite(samples: &mut [f32], channels: usize) -> Option<String> {
    let mut pixels = 0_usize;
    for pixel in samples.chunks_exact_mut(channels) {
        pixels += usize::from(pixel.iter().any(|value| !value.is_finite()));
        for value in pixel.iter_mut().filter(|value| !value.is_finite()) {
            *value = match *value {
                f32::INFINITY => LARGEST_HALF,
                f32::NEG_INFINITY => -LARGEST_HALF,
                _ => 0.0,
            };
        }
    }
    let pixels = match pixels {
        0 => return None,
        1 => "1 pixel".to_owned(),
        more => format!("{more} pixels"),
    };
    Some(format!(
        "has {pixels} with infinite or undefined numbers; infinite ones count as {LARGEST_HALF} and undefined ones as 0, so save it again \
         without them"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn very_many_attributes_or_channels_are_refused_before_they_are_read() {
        let attribute = |kind: &str, size: usize| {
            let start = [b"a\0", kind.as_bytes(), b"\0", &(size as u32).to_le_bytes()].concat();
            [start, vec![1; size]].concat()
        };
        let file = |flags: u8, headers: &[u8]| [&[0x76, 0x2f, 0x31, 1, 2, flags, 0, 0], headers].concat();
        let told = |bytes: &[u8]| check_lengths("a.exr", bytes).map_err(|error| error.to_string());
        let many = attribute("int", 4).repeat(MOST_ATTRIBUTES + 1);
        assert!(
            told(&file(0, &many))
                .unwrap_err()
                .contains("more than 10000 attributes")
        );
        assert_eq!(
            told(&file(0, &many[..many.len() - 1])),
            Ok(()),
            "the last one is cut off"
        );
        let channels = attribute("chlist", MOST_CHANNEL_BYTES + 1);
        assert!(told(&file(0, &channels)).unwrap_err().contains("too many channels"));
        // Pixels begin behind the first header, or behind an empty one where there are parts.
        let behind = [attribute("int", 4), vec![0], channels].concat();
        assert_eq!(told(&file(0, &behind)), Ok(()));
        assert!(told(&file(0x10, &behind)).is_err());
        for bytes in [&b""[..], b"v/1", b"v/1\x01\x02\0\0\0abc"] {
            assert_eq!(told(bytes), Ok(()));
        }
    }

    #[test]
    fn the_data_is_placed_according_to_its_window() {
        assert_eq!(overlap(-2, 5, 10), 0..3);
        assert_eq!(overlap(8, 5, 10), 8..10);
        assert_eq!(overlap(20, 5, 10), 10..10);
        assert_eq!(overlap(-9, 5, 10), 0..0);
    }
}
