//! OpenEXR files: RGBA or luminance of one layer, at full resolution.

use std::io::Cursor;

use exr::image::{FlatSamples, Image, Layer, Layers};
use exr::meta::MetaData;
use exr::meta::attribute::IntegerBounds;
use exr::meta::header::Header;
use exr::prelude::{AnyChannels, ReadChannels as _, ReadLayers as _};

use crate::error::damaged;
use crate::size_limits::{DecodedSize, MAX_DECODED_BYTES, check_size};
use crate::{Declared, ImageError, Picture, Pixels};

const FORMAT: &str = "OpenEXR";
const DEEP: &str = "it holds deep samples, several for each pixel";
/// Replacement for infinity: the largest half float, which most files use.
const LARGEST_HALF: f32 = 65504.0;

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

/// Rejects unsupported files by their headers alone.
pub(crate) fn check_exr(name: &str, bytes: &[u8]) -> Result<DecodedSize, ImageError> {
    // The flag of files with deep parts (OpenEXR file layout, version field, bit 11).
    if bytes.get(5).is_some_and(|flags| flags & 0x08 != 0) {
        return Err(unsupported(name, DEEP));
    }
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
    let channels = |header: &Header| {
        header
            .channels
            .list
            .iter()
            .map(|channel| channel.name.to_string())
            .collect()
    };
    let names: Vec<Vec<String>> = meta.headers.iter().map(channels).collect();
    picked_of(name, &names)?;
    let pixels = |header: &Header| header.layer_size.area() as u64;
    Ok(DecodedSize {
        // All channels are decoded, and four of them become the picture.
        bytes: all_bytes,
        pixels: meta.headers.iter().map(pixels).max().unwrap_or(0), // There is a layer.
    })
}

/// Decodes the display window; pixels of it that the file does not have are 0.
pub(crate) fn decode_exr(name: &str, bytes: &[u8]) -> Result<Picture, ImageError> {
    check_exr(name, bytes)?;
    // One thread: a panic in a worker thread of the decoder could not be caught.
    let image: Image<Layers<AnyChannels<FlatSamples>>> = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| explain(name, error))?;
    let names: Vec<Vec<String>> = image.layer_data.iter().map(channel_names).collect();
    let (layer, picked) = picked_of(name, &names)?;
    Ok(compose(
        &image.layer_data[layer],
        image.attributes.display_window,
        &picked,
    ))
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

/// Rejects unsupported layers; returns the bytes that the layer takes.
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

fn channel_names(layer: &FlatLayer) -> Vec<String> {
    let channels = layer.channel_data.list.iter();
    channels.map(|channel| channel.name.to_string()).collect()
}

/// The layer and its channels that make the picture.
fn picked_of(name: &str, names: &[Vec<String>]) -> Result<(usize, Vec<usize>), ImageError> {
    pick_layer(names).ok_or_else(|| {
        let all: Vec<&str> = names.iter().flatten().map(String::as_str).collect();
        unsupported(
            name,
            &format!("none of its channels ({}) is R, G, B or Y", all.join(", ")),
        )
    })
}

/// The first layer in color, else the first that makes a picture at all (depth often comes first), with its channels.
fn pick_layer(names: &[Vec<String>]) -> Option<(usize, Vec<usize>)> {
    let pictures = || {
        let picked = names.iter().map(|names| pick_channels(names));
        picked.enumerate().filter_map(|(layer, picked)| Some((layer, picked?)))
    };
    pictures()
        .find(|(_, picked)| picked.len() >= 3)
        .or_else(|| pictures().next())
}

/// Channels of the picture in their order, as indices into the layer's list.
fn pick_channels(names: &[String]) -> Option<Vec<usize>> {
    // `layer.R` counts as `R` when the file has no plain one.
    let find = |wanted: &str| {
        let plain = names.iter().position(|name| name.eq_ignore_ascii_case(wanted));
        plain.or_else(|| names.iter().position(|name| name.rsplit('.').next() == Some(wanted)))
    };
    let color = match (find("R"), find("G"), find("B"), find("Y")) {
        (Some(r), Some(g), Some(b), _) => vec![r, g, b],
        (_, _, _, Some(y)) => vec![y],
        // A lone channel of any name, and the single color of a mask.
        (Some(only), None, None, _) | (None, Some(only), None, _) | (None, None, Some(only), _) => vec![only],
        _ if names.len() == 1 => return Some(vec![0]),
        _ => return None,
    };
    Some(color.into_iter().chain(find("A")).collect())
}

fn compose(layer: &FlatLayer, window: IntegerBounds, picked: &[usize]) -> Picture {
    let (width, height) = (window.size.0, window.size.1);
    // Offset of the data window in the display window.
    let corner_x = i64::from(layer.attributes.layer_position.0) - i64::from(window.position.0);
    let corner_y = i64::from(layer.attributes.layer_position.1) - i64::from(window.position.1);
    let columns = overlap(corner_x, layer.size.0, width);
    let rows = overlap(corner_y, layer.size.1, height);
    let channels = picked.len();
    let mut samples = vec![0.0f32; width * height * channels];
    for (offset, &index) in picked.iter().enumerate() {
        let source = &layer.channel_data.list[index].sample_data;
        for y in rows.clone() {
            let source_row = (y as i64 - corner_y) as usize * layer.size.0;
            for x in columns.clone() {
                let value = sample(source, source_row + (x as i64 - corner_x) as usize);
                samples[(y * width + x) * channels + offset] = value;
            }
        }
    }
    Picture {
        width: width as u32,
        height: height as u32,
        channels: channels as u8,
        pixels: Pixels::F32(samples),
        color_space: Declared::Linear,
    }
}

fn overlap(corner: i64, length: usize, window: usize) -> std::ops::Range<usize> {
    let end = (corner + length as i64).clamp(0, window as i64) as usize;
    (corner.clamp(0, window as i64) as usize).min(end)..end
}

/// Returns a finite sample: renderers write NaN and infinity, which any filter would spread.
fn sample(samples: &FlatSamples, index: usize) -> f32 {
    let value = match samples {
        FlatSamples::F16(list) => list.get(index).map_or(0.0, |value| value.to_f32()),
        // Pixels outside of the data window are 0.
        FlatSamples::F32(list) => list.get(index).copied().unwrap_or(0.0),
        FlatSamples::U32(list) => list.get(index).map_or(0.0, |&value| value as f32),
    };
    match value {
        _ if value.is_nan() => 0.0,
        f32::INFINITY => LARGEST_HALF,
        f32::NEG_INFINITY => -LARGEST_HALF,
        value => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_found_by_name_in_any_layer() {
        let pick = |names: &[&str]| pick_channels(&names.iter().map(ToString::to_string).collect::<Vec<_>>());
        assert_eq!(pick(&["A", "B", "G", "R"]), Some(vec![3, 2, 1, 0]));
        assert_eq!(pick(&["diffuse.B", "diffuse.G", "diffuse.R"]), Some(vec![2, 1, 0]));
        assert_eq!(pick(&["A", "Y", "Z"]), Some(vec![1, 0]));
        assert_eq!(pick(&["depth"]), Some(vec![0]));
        assert_eq!(pick(&["id", "depth"]), None);
    }

    #[test]
    fn a_layer_in_color_goes_before_depth_and_masks() {
        let pick = |layers: &[&[&str]]| {
            let names: Vec<Vec<String>> = layers
                .iter()
                .map(|names| names.iter().map(ToString::to_string).collect())
                .collect();
            pick_layer(&names)
        };
        assert_eq!(
            pick(&[&["Z"], &["B", "G", "R"], &["R", "G", "B"]]),
            Some((1, vec![2, 1, 0]))
        );
        assert_eq!(pick(&[&["id", "object"], &["Z"]]), Some((1, vec![0])));
        assert_eq!(pick(&[&["id", "object"]]), None);
    }

    #[test]
    fn the_data_lies_where_its_window_says() {
        assert_eq!(overlap(-2, 5, 10), 0..3);
        assert_eq!(overlap(8, 5, 10), 8..10);
        assert_eq!(overlap(20, 5, 10), 10..10);
        assert_eq!(overlap(-9, 5, 10), 0..0);
    }
}
