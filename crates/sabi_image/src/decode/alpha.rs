//! Fourth bytes of TGA and BMP files that are no alpha.

use image::{DynamicImage, ImageFormat};

/// Meaning of the alpha of a TGA, from its extension area (Truevision TGA 2.0, field 24: attributes type).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TgaAlpha {
    /// Types 0 to 2: there is none, or its data are undefined.
    Unusable,
    /// Type 3.
    Straight,
    /// Type 4: colors are multiplied by alpha.
    Premultiplied,
    /// The file has no extension area, or one with a reserved type.
    Undeclared,
}

impl TgaAlpha {
    fn of(bytes: &[u8]) -> TgaAlpha {
        const FOOTER_BYTES: usize = 26;
        const SIGNATURE: &[u8] = b"TRUEVISION-XFILE.\0";
        const SIGNATURE_AT: usize = 8;
        const ATTRIBUTES_TYPE: usize = 494;
        let declared = || {
            let footer = bytes.get(bytes.len().checked_sub(FOOTER_BYTES)?..)?;
            let offset = u32::from_le_bytes(*footer.first_chunk()?) as usize;
            let is_signed = footer.get(SIGNATURE_AT..)? == SIGNATURE;
            // Offset 0 means that there is no extension area. It begins with its size.
            let area = bytes.get(offset..).filter(|_| is_signed && offset != 0)?;
            let size = usize::from(u16::from_le_bytes(*area.first_chunk()?));
            area.get(ATTRIBUTES_TYPE).filter(|_| size > ATTRIBUTES_TYPE)
        };
        match declared() {
            Some(0..=2) => TgaAlpha::Unusable,
            Some(3) => TgaAlpha::Straight,
            Some(4) => TgaAlpha::Premultiplied,
            _ => TgaAlpha::Undeclared,
        }
    }
}

/// Clause about alpha that is 0 everywhere.
const ALL_ZERO: &str = "has an alpha of 0 everywhere, so it is taken as opaque";

/// Returns a picture with straight alpha, or without alpha where the file has none, and a clause about alpha that was dropped although
/// the file does not call it unusable. Many programs write 0 in the fourth bytes of opaque pictures; others write alpha and say in the
/// descriptor of a TGA that there is none.
pub(super) fn with_straight_alpha(
    bytes: &[u8],
    format: ImageFormat,
    picture: DynamicImage,
) -> (DynamicImage, Option<&'static str>) {
    const TGA_DESCRIPTOR: usize = 17;
    let alpha = match format {
        ImageFormat::Tga => TgaAlpha::of(bytes),
        ImageFormat::Bmp => TgaAlpha::Undeclared,
        _ => return (picture, None),
    };
    match alpha {
        TgaAlpha::Unusable => (opaque(picture), None),
        TgaAlpha::Straight => (picture, None),
        TgaAlpha::Premultiplied => (divided_by_alpha(picture), None),
        TgaAlpha::Undeclared if is_zero_everywhere(&picture) => {
            let says_none =
                format == ImageFormat::Tga && bytes.get(TGA_DESCRIPTOR).is_some_and(|byte| byte & 0x0f == 0);
            (opaque(picture), (!says_none).then_some(ALL_ZERO))
        }
        TgaAlpha::Undeclared => (picture, None),
    }
}

/// Returns true if a picture has alpha that is 0 in all pixels.
fn is_zero_everywhere(picture: &DynamicImage) -> bool {
    match picture {
        DynamicImage::ImageLumaA8(samples) => samples.pixels().all(|pixel| pixel.0[1] == 0),
        DynamicImage::ImageRgba8(samples) => samples.pixels().all(|pixel| pixel.0[3] == 0),
        _ => false,
    }
}

fn opaque(picture: DynamicImage) -> DynamicImage {
    match picture {
        DynamicImage::ImageLumaA8(_) => DynamicImage::ImageLuma8(picture.into_luma8()),
        DynamicImage::ImageRgba8(_) => DynamicImage::ImageRgb8(picture.into_rgb8()),
        other => other,
    }
}

/// Divides colors by alpha. Where alpha is 0 they stay as they are.
fn divided_by_alpha(mut picture: DynamicImage) -> DynamicImage {
    let divide = |pixel: &mut [u8]| {
        if let Some((alpha, colors)) = pixel.split_last_mut().filter(|(alpha, _)| **alpha > 0) {
            let alpha = u32::from(*alpha);
            for color in colors {
                *color = ((u32::from(*color) * 255 + alpha / 2) / alpha).min(255) as u8;
            }
        }
    };
    match &mut picture {
        DynamicImage::ImageLumaA8(samples) => samples.pixels_mut().for_each(|pixel| divide(&mut pixel.0)),
        DynamicImage::ImageRgba8(samples) => samples.pixels_mut().for_each(|pixel| divide(&mut pixel.0)),
        _ => {}
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::ALL_ZERO;
    use crate::{Pixels, decode};

    /// Returns a TGA of two pixels from the top left with 8 bits of alpha, and its extension area where there is one.
    fn tga(alphas: [u8; 2], attributes_type: Option<u8>) -> Vec<u8> {
        let mut file = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28];
        file.extend([30, 20, 10, alphas[0], 60, 50, 40, alphas[1]]);
        if let Some(kind) = attributes_type {
            let at = file.len() as u32;
            let mut area = vec![0; 495];
            area[..2].copy_from_slice(&495_u16.to_le_bytes());
            area[494] = kind;
            file.extend(area);
            file.extend(at.to_le_bytes());
            file.extend([0; 4]);
            file.extend(b"TRUEVISION-XFILE.\0");
        }
        file
    }

    fn read(alphas: [u8; 2], attributes_type: Option<u8>) -> (Vec<u8>, Vec<String>) {
        let picture = decode("a.tga", &tga(alphas, attributes_type)).unwrap();
        match picture.pixels {
            Pixels::U8(values) => (values, picture.remarks.values),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_attributes_type_of_a_tga_says_what_its_alpha_means() {
        let opaque = vec![10, 20, 30, 40, 50, 60];
        for kind in 0..=2 {
            assert_eq!(read([128, 0], Some(kind)), (opaque.clone(), vec![]), "{kind}");
        }
        let straight = vec![10, 20, 30, 128, 40, 50, 60, 0];
        for kind in [None, Some(3), Some(9)] {
            assert_eq!(read([128, 0], kind), (straight.clone(), vec![]), "{kind:?}");
        }
        // 10, 20 and 30 of 128 are 19.9, 39.8 and 59.8 of 255; 60 of 50 is more than all.
        let divided = vec![20, 40, 60, 128, 204, 255, 255, 50];
        assert_eq!(read([128, 50], Some(4)), (divided, vec![]));
    }

    #[test]
    fn alpha_of_0_everywhere_is_opaque_with_a_remark_unless_it_is_declared() {
        let opaque = vec![10, 20, 30, 40, 50, 60];
        assert_eq!(read([0, 0], None), (opaque, vec![ALL_ZERO.to_owned()]));
        let clear = vec![10, 20, 30, 0, 40, 50, 60, 0];
        assert_eq!(read([0, 0], Some(3)), (clear, vec![]));
    }
}
