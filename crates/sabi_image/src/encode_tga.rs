//! Truevision TGA files of 8 bits.

use image::codecs::tga::TgaEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::ImageError;

/// Encodes a TGA file with run-length compression. `codes` has one, three or four components for each of `width × height`
/// pixels, row by row from the top, interleaved. The format cannot declare a color space.
pub fn encode_tga(width: u32, height: u32, channels: u8, codes: &[u8]) -> Result<Vec<u8>, ImageError> {
    let refuse = |reason: String| ImageError::Encode { width, height, reason };
    let color = match channels {
        1 => ExtendedColorType::L8,
        3 => ExtendedColorType::Rgb8,
        4 => ExtendedColorType::Rgba8,
        _ => return Err(refuse(format!("a TGA file has 1, 3 or 4 components, not {channels}"))),
    };
    let expected = u64::from(width) * u64::from(height) * u64::from(channels);
    if codes.len() as u64 != expected || expected == 0 {
        return Err(refuse(format!("it has {} codes instead of {expected}", codes.len())));
    }
    // The header stores sizes with 16 bits.
    if width.max(height) > u32::from(u16::MAX) {
        return Err(refuse(format!("a TGA file has at most {} pixels a side", u16::MAX)));
    }
    let mut file = Vec::new();
    let written = TgaEncoder::new(&mut file).write_image(codes, width, height, color);
    written.map_err(|error| refuse(error.to_string()))?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pixels, decode};

    #[test]
    fn codes_are_restored_exactly_from_the_top() {
        for channels in [1_u8, 3, 4] {
            let codes: Vec<u8> = (0..5 * 3 * u32::from(channels))
                .map(|at| (at * 37 % 256) as u8)
                .collect();
            let picture = decode("a.tga", &encode_tga(5, 3, channels, &codes).unwrap()).unwrap();
            assert_eq!((picture.width, picture.height, picture.channels), (5, 3, channels));
            assert_eq!(picture.pixels, Pixels::U8(codes));
        }
    }

    #[test]
    fn sizes_and_channels_that_the_format_cannot_hold_are_errors() {
        let told = |channels: u8, codes: &[u8]| encode_tga(2, 1, channels, codes).unwrap_err().to_string();
        assert_eq!(
            told(2, &[0; 4]),
            "cannot encode a 2 × 1 picture: a TGA file has 1, 3 or 4 components, not 2"
        );
        assert_eq!(
            told(3, &[0; 4]),
            "cannot encode a 2 × 1 picture: it has 4 codes instead of 6"
        );
    }
}
