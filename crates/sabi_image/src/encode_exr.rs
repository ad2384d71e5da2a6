//! OpenEXR files of 32-bit floats.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder,
    SmallVec, WritableImage,
};

use crate::ImageError;

/// An OpenEXR file of exact 32-bit floats with lossless ZIP compression. Each channel is its name (`Y`, or `R`, `G`, `B`)
/// and `width × height` values, row by row from the top. The file says nothing but its size and channels: no date, no
/// program's name.
pub fn encode_exr(width: u32, height: u32, channels: &[(&str, &[f32])]) -> Result<Vec<u8>, ImageError> {
    let refuse = |reason: String| ImageError::Encode { width, height, reason };
    if width == 0 || height == 0 || channels.is_empty() {
        return Err(refuse(
            "an OpenEXR file needs at least one pixel and one channel".into(),
        ));
    }
    let expected = u64::from(width) * u64::from(height);
    let mut list = SmallVec::new();
    for (name, samples) in channels {
        if samples.len() as u64 != expected {
            return Err(refuse(format!(
                "channel {name} has {} values instead of {expected}",
                samples.len()
            )));
        }
        let Some(text) = exr::prelude::Text::new_or_none(name) else {
            return Err(refuse(format!("\"{name}\" cannot name a channel of an OpenEXR file")));
        };
        list.push(AnyChannel::new(text, FlatSamples::F32(samples.to_vec())));
    }
    // The line order makes the file independent of which block is compressed first.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (width as usize, height as usize);
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(list));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| refuse(error.to_string()))?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Declared, Pixels, decode};

    #[test]
    fn floats_come_back_bit_for_bit() {
        let values: Vec<f32> = (0..37 * 21).map(|i| f32::from_bits(0x3a00_0000 + i * 61_681)).collect();
        let negative: Vec<f32> = values.iter().map(|value| -value).collect();
        let gray = decode("h.exr", &encode_exr(37, 21, &[("Y", &values)]).unwrap()).unwrap();
        assert_eq!((gray.width, gray.height, gray.channels), (37, 21, 1));
        assert_eq!(gray.color_space, Declared::Linear);
        assert_eq!(gray.pixels, Pixels::F32(values.clone()));
        let rgb = [("R", &values[..]), ("G", &negative[..]), ("B", &values[..])];
        let color = decode("c.exr", &encode_exr(37, 21, &rgb).unwrap()).unwrap();
        let expected = values.iter().zip(&negative).flat_map(|(&r, &g)| [r, g, r]).collect();
        assert_eq!((color.channels, color.pixels), (3, Pixels::F32(expected)));
    }

    #[test]
    fn the_bytes_are_the_same_twice_and_name_no_date_or_program() {
        let values: Vec<f32> = (0..300 * 200).map(|i| (i as f32 * 0.37).sin()).collect();
        let once = encode_exr(300, 200, &[("Y", &values)]).unwrap();
        assert_eq!(once, encode_exr(300, 200, &[("Y", &values)]).unwrap());
        let header = String::from_utf8_lossy(&once[..500]).into_owned();
        for word in ["capDate", "software", "owner", "comments"] {
            assert!(!header.contains(word), "{word}");
        }
    }

    #[test]
    fn a_wrong_number_of_values_is_a_sentence() {
        let error = encode_exr(4, 4, &[("Y", &[0.0; 15])]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "cannot encode a 4 × 4 picture: channel Y has 15 values instead of 16"
        );
        assert!(encode_exr(0, 4, &[("Y", &[])]).is_err());
    }
}
