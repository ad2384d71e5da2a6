//! OpenEXR files: RGBA or luminance of the first layer, at full resolution.

use std::io::Cursor;

use exr::image::{FlatSamples, Image, Layer};
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{AnyChannels, ReadChannels as _, ReadLayers as _};

use crate::decode::{check_size, damaged};
use crate::{Declared, ImageError, Picture, Pixels};

const FORMAT: &str = "OpenEXR";

type FlatLayer = Image<Layer<AnyChannels<FlatSamples>>>;

/// What is shown is the display window; pixels of it that the file does not have are 0.
pub(crate) fn decode_exr(name: &str, bytes: &[u8]) -> Result<Picture, ImageError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|error| damaged(name, FORMAT, error))?;
    let header = meta
        .headers
        .first()
        .ok_or_else(|| damaged(name, FORMAT, "it has no layer"))?;
    check_header(name, header)?;
    // One thread: a slip in a worker of the decoder could not be caught.
    let image: FlatLayer = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| explain(name, error))?;
    compose(name, &image)
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

fn check_header(name: &str, header: &Header) -> Result<(), ImageError> {
    if header.deep {
        return Err(unsupported(name, "it holds deep samples, several for each pixel"));
    }
    let window = header.shared_attributes.display_window.size;
    let data = header.layer_size;
    check_size(name, window.0 as u64, window.1 as u64, 16)?;
    check_size(
        name,
        data.0 as u64,
        data.1 as u64,
        header.channels.bytes_per_pixel.max(1) as u64,
    )?;
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
    Ok(())
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

fn compose(name: &str, image: &FlatLayer) -> Result<Picture, ImageError> {
    let layer = &image.layer_data;
    let names: Vec<String> = layer
        .channel_data
        .list
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    let picked = pick_channels(&names).ok_or_else(|| {
        unsupported(
            name,
            &format!("none of its channels ({}) is R, G, B or Y", names.join(", ")),
        )
    })?;
    let window = image.attributes.display_window;
    let (width, height) = (window.size.0, window.size.1);
    // Where the data's corner lies in the window.
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
    Ok(Picture {
        width: width as u32,
        height: height as u32,
        channels: channels as u8,
        pixels: Pixels::F32(samples),
        color_space: Declared::Linear,
    })
}

fn overlap(corner: i64, length: usize, window: usize) -> std::ops::Range<usize> {
    let end = (corner + length as i64).clamp(0, window as i64) as usize;
    (corner.clamp(0, window as i64) as usize).min(end)..end
}

fn sample(samples: &FlatSamples, index: usize) -> f32 {
    match samples {
        FlatSamples::F16(list) => list.get(index).map_or(0.0, |value| value.to_f32()),
        FlatSamples::F32(list) => list.get(index).copied().unwrap_or(0.0),
        FlatSamples::U32(list) => list.get(index).map_or(0.0, |&value| value as f32),
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
    fn the_data_lies_where_its_window_says() {
        assert_eq!(overlap(-2, 5, 10), 0..3);
        assert_eq!(overlap(8, 5, 10), 8..10);
        assert_eq!(overlap(20, 5, 10), 10..10);
        assert_eq!(overlap(-9, 5, 10), 0..0);
    }
}
