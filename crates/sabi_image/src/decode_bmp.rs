//! Rare kinds of BMP files are rewritten as simple ones for the decoder of the `image` crate, which does not read bit masks
//! with alpha and fails at runs that continue beyond the end of a row (BITMAPINFOHEADER, Win32; bitmap compression, Win32).

use std::borrow::Cow;

use crate::ImageError;
use crate::size_limits::check_size;

const FILE_HEADER_BYTES: usize = 14;
/// Size of a header without bit masks.
const INFO_HEADER_BYTES: u32 = 40;
/// Size of the header whose last four numbers are bit masks for red, green, blue and alpha.
const MASKS_HEADER_BYTES: u32 = 56;
/// Size of the header of OS/2 2.x, whose fields from the compression on have other meanings.
const OS2_HEADER_BYTES: [std::ops::RangeInclusive<u32>; 2] = [16..=39, 57..=64];

/// Values of the compression field.
const PLAIN: u32 = 0;
const RUNS_OF_8_BITS: u32 = 1;
const RUNS_OF_4_BITS: u32 = 2;
const BIT_MASKS: u32 = 3;
const BIT_MASKS_WITH_ALPHA: u32 = 6;

/// Returns the file in a form that the decoder accepts.
///
/// # Errors
/// The file is valid but of a kind that is not supported. Damage is reported later by the decoder.
pub(crate) fn plain<'b>(name: &str, bytes: &'b [u8]) -> Result<Cow<'b, [u8]>, ImageError> {
    let unread = |feature: String| {
        Err(ImageError::Feature {
            name: name.into(),
            format: "BMP",
            feature,
        })
    };
    let size = bytes.get(FILE_HEADER_BYTES..FILE_HEADER_BYTES + 4);
    let size = size.and_then(|size| size.try_into().ok()).map(u32::from_le_bytes);
    if size.is_some_and(|size| OS2_HEADER_BYTES.iter().any(|sizes| sizes.contains(&size))) {
        return unread("it has the header of OS/2 2.x, which is not read".to_owned());
    }
    let Some(header) = BmpHeader::read(bytes) else {
        return Ok(Cow::Borrowed(bytes));
    };
    match header.compression {
        PLAIN | BIT_MASKS if header.bits == 64 => unread("it has 64 bits a pixel, which are not read".to_owned()),
        PLAIN | BIT_MASKS => Ok(Cow::Borrowed(bytes)),
        RUNS_OF_8_BITS | RUNS_OF_4_BITS => header.without_runs(name, bytes),
        // The masks are at the same place as in the larger header.
        BIT_MASKS_WITH_ALPHA if header.size == INFO_HEADER_BYTES => {
            let mut rewritten = bytes.to_vec();
            rewritten[14..18].copy_from_slice(&MASKS_HEADER_BYTES.to_le_bytes());
            rewritten[30..34].copy_from_slice(&BIT_MASKS.to_le_bytes());
            Ok(Cow::Owned(rewritten))
        }
        kind => {
            let kind = match kind {
                4 => "JPEG".to_owned(),
                5 => "PNG".to_owned(),
                11..=13 => "of inks (CMYK)".to_owned(),
                kind => format!("of type {kind}"),
            };
            unread(format!("its pixels are {kind}, which is not read in a BMP file"))
        }
    }
}

/// Size, kind and place of the pixels, as declared in the file.
struct BmpHeader {
    /// Size of the header that follows the file header, in bytes.
    size: u32,
    width: u32,
    height: u32,
    bits: u16,
    compression: u32,
    /// Offset of the pixels in the file.
    pixels_at: usize,
    /// Offset of the palette in the file.
    palette_at: usize,
}

impl BmpHeader {
    /// Reads a header that has a compression field. Returns `None` if the header is older, truncated, or has impossible sizes.
    fn read(bytes: &[u8]) -> Option<BmpHeader> {
        let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
        let size = word(14).filter(|size| *size >= INFO_HEADER_BYTES)?;
        Some(BmpHeader {
            size,
            width: word(18)?,
            height: word(22)?,
            bits: (word(26)? >> 16) as u16,
            compression: word(30)?,
            pixels_at: word(10)? as usize,
            palette_at: FILE_HEADER_BYTES + size as usize,
        })
    }

    /// Returns the file with each pixel as a code of 8 bits. Pixels that no run covers have the first color of the palette.
    /// A run ends at the end of its row, and missing data is allowed, as in the systems from which the format comes.
    fn without_runs<'b>(&self, name: &str, bytes: &'b [u8]) -> Result<Cow<'b, [u8]>, ImageError> {
        // A negative height means rows from the top, which is not possible with runs.
        if self.height > i32::MAX as u32 {
            return Ok(Cow::Borrowed(bytes));
        }
        check_size(name, self.width.into(), self.height.into(), 3)?;
        let is_wide = self.compression == RUNS_OF_8_BITS;
        let (Some(palette), Some(runs)) = (bytes.get(self.palette_at..self.pixels_at), bytes.get(self.pixels_at..))
        else {
            return Ok(Cow::Borrowed(bytes));
        };
        if self.bits != if is_wide { 8 } else { 4 } {
            return Ok(Cow::Borrowed(bytes));
        }
        let codes = self.codes(runs, is_wide);
        let row_bytes = (self.width as usize).next_multiple_of(4);
        let colors = (palette.len() / 4).min(256);
        let head = FILE_HEADER_BYTES + INFO_HEADER_BYTES as usize + 4 * colors;
        let mut plain = Vec::with_capacity(head + row_bytes * self.height as usize);
        plain.extend(b"BM");
        for word in [(head + row_bytes * self.height as usize) as u32, 0, head as u32] {
            plain.extend(word.to_le_bytes());
        }
        let planes_and_bits = 1 | 8 << 16;
        for word in [
            INFO_HEADER_BYTES,
            self.width,
            self.height,
            planes_and_bits,
            PLAIN,
            0,
            0,
            0,
            colors as u32,
            0,
        ] {
            plain.extend(word.to_le_bytes());
        }
        plain.extend(&palette[..4 * colors]);
        for row in codes.chunks_exact(self.width.max(1) as usize) {
            plain.extend(row);
            plain.resize(plain.len() + row_bytes - row.len(), 0);
        }
        Ok(Cow::Owned(plain))
    }

    /// Returns the codes of all pixels, row by row from the bottom.
    fn codes(&self, runs: &[u8], is_wide: bool) -> Vec<u8> {
        let (width, height) = (self.width as usize, self.height as usize);
        let mut codes = vec![0; width * height];
        let (mut x, mut y) = (0, 0);
        let mut rest = runs;
        while let [count, value, behind @ ..] = rest {
            rest = behind;
            let mut put = |x: usize, code: u8| {
                if x < width && y < height {
                    codes[y * width + x] = code;
                }
            };
            // With 4 bits, a run alternates between two colors.
            let half = |byte: u8, at: usize| if at.is_multiple_of(2) { byte >> 4 } else { byte & 15 };
            match (*count, *value) {
                (0, 0) => (x, y) = (0, y + 1),
                (0, 1) => break,
                (0, 2) => {
                    let [right, up, behind @ ..] = rest else { break };
                    (x, y) = (x + usize::from(*right), y + usize::from(*up));
                    rest = behind;
                }
                (0, length) => {
                    let length = usize::from(length);
                    let taken = if is_wide { length } else { length.div_ceil(2) };
                    for at in 0..length {
                        let Some(byte) = rest.get(if is_wide { at } else { at / 2 }) else {
                            break;
                        };
                        put(x + at, if is_wide { *byte } else { half(*byte, at) });
                    }
                    x += length;
                    // Data is padded to 16-bit words. The default stands for the end of the data.
                    rest = rest.get(taken.next_multiple_of(2)..).unwrap_or_default(); // The data end.
                }
                (length, value) => {
                    for at in 0..usize::from(length) {
                        put(x + at, if is_wide { value } else { half(value, at) });
                    }
                    x += usize::from(length);
                }
            }
        }
        codes
    }
}

#[cfg(test)]
mod tests {
    use crate::{ImageError, Pixels, decode};

    /// Creates a file from a header, the bytes after it, and pixels.
    fn file(size: [u32; 2], bits: u32, compression: u32, behind_header: &[u8], pixels: &[u8]) -> Vec<u8> {
        let head = 54 + behind_header.len();
        let mut bytes = b"BM".to_vec();
        let length = (head + pixels.len()) as u32;
        for word in [
            length,
            0,
            head as u32,
            40,
            size[0],
            size[1],
            1 | bits << 16,
            compression,
            0,
            2835,
            2835,
            0,
            0,
        ] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(behind_header);
        bytes.extend(pixels);
        bytes
    }

    /// Black, red, green and white, as blue, green, red.
    const PALETTE: [u8; 16] = [0, 0, 0, 0, 0, 0, 255, 0, 0, 255, 0, 0, 255, 255, 255, 0];
    const K: [u8; 3] = [0, 0, 0];
    const R: [u8; 3] = [255, 0, 0];
    const G: [u8; 3] = [0, 255, 0];
    const W: [u8; 3] = [255, 255, 255];

    fn codes(bytes: &[u8]) -> Vec<u8> {
        match decode("a.bmp", bytes).unwrap().pixels {
            Pixels::U8(values) => values,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn runs_end_with_their_row_and_skipped_pixels_have_the_first_color() {
        // From the bottom: a run of five in a row of three, then a step to the right, a single pixel, and the end.
        let eight = [5, 1, 0, 0, 0, 2, 1, 0, 1, 2, 0, 1];
        assert_eq!(
            codes(&file([3, 2], 8, 1, &PALETTE, &eight)),
            [K, G, K, R, R, R].concat()
        );
        // Three single codes, padded to a word, then a run that alternates between two colors.
        let four = [0, 3, 0x12, 0x30, 0, 0, 3, 0x31, 0, 0, 0, 1];
        assert_eq!(codes(&file([3, 2], 4, 2, &PALETTE, &four)), [W, R, W, R, G, W].concat());
        // Pixels for which there is no data.
        assert_eq!(
            codes(&file([3, 2], 8, 1, &PALETTE, &[1, 3])),
            [K, K, K, W, K, K].concat()
        );
    }

    #[test]
    fn masks_with_one_for_alpha_are_read() {
        let masks = [0xff_u32, 0xff00, 0xff_0000, 0xff00_0000]
            .map(u32::to_le_bytes)
            .concat();
        let picture = decode("a.bmp", &file([1, 1], 32, 6, &masks, &[10, 20, 30, 40])).unwrap();
        assert_eq!(
            (picture.channels, picture.pixels),
            (4, Pixels::U8(vec![10, 20, 30, 40]))
        );
    }

    #[test]
    fn unsupported_kinds_are_not_reported_as_damaged() {
        for (bits, compression) in [(24, 4), (24, 5), (32, 11), (64, 0), (24, 99)] {
            let error = decode("a.bmp", &file([1, 1], bits, compression, &[], &[0; 8])).unwrap_err();
            assert!(
                matches!(error, ImageError::Feature { .. }),
                "{bits}, {compression}: {error}"
            );
        }
        let mut os2 = file([1, 1], 24, 0, &[0; 24], &[0; 4]);
        for size in [16, 64] {
            os2[14] = size;
            let error = decode("a.bmp", &os2).unwrap_err();
            assert_eq!(
                error.to_string(),
                "a.bmp cannot be used: it has the header of OS/2 2.x, which is not read; save it again as a plain BMP file",
                "{size}"
            );
        }
    }
}
