//! Radiance HDR files, including the variants of the header that programs really write, and all eight orientations
//! (Radiance file formats, Ward 1997).

use std::io::{Cursor, Read};

use image::ImageDecoder as _;
use image::codecs::hdr::HdrDecoder;
use sabi_cancel::LookingReader;

use crate::error::damaged;
use crate::size_limits::{DecodedSize, check_size};
use crate::{DeclaredColorSpace, ImageError, Picture, PictureRemarks, Pixels};

const FORMAT: &str = "HDR";
/// Bytes of a decoded pixel.
const PIXEL_BYTES: u64 = 12;
/// Maximum length of a line of the header.
const LONGEST_LINE: usize = 1 << 16;

/// Direction of rows or columns, and their number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct HdrAxis {
    is_y: bool,
    /// True if rows or columns run up or to the left.
    is_reversed: bool,
    length: u32,
}

/// A file whose header was read.
#[derive(Debug)]
pub(crate) struct HdrFile<'b> {
    /// Axis from scanline to scanline, then the axis along a scanline.
    axes: [HdrAxis; 2],
    scanlines: &'b [u8],
}

impl<'b> HdrFile<'b> {
    /// Reads the header: the signature `#?` with the name of any program, and lines that end in LF or CR LF.
    ///
    /// # Errors
    /// The header is damaged, the picture is too large, or its colors are not red, green and blue.
    pub(crate) fn open(name: &str, bytes: &'b [u8]) -> Result<HdrFile<'b>, ImageError> {
        let mut rest = bytes;
        loop {
            let line = next_line(&mut rest).ok_or_else(|| damaged(name, FORMAT, "its header has no end"))?;
            if line.is_empty() {
                break;
            }
            let line = String::from_utf8_lossy(line);
            let format = line.split_once('=').filter(|(key, _)| key.trim() == "FORMAT");
            if let Some((_, format)) = format.filter(|(_, format)| format.trim() != "32-bit_rle_rgbe") {
                return Err(ImageError::Feature {
                    name: name.into(),
                    format: FORMAT,
                    feature: format!("its pixels are {}, not 32-bit_rle_rgbe", format.trim()),
                });
            }
        }
        let resolution = next_line(&mut rest).ok_or_else(|| damaged(name, FORMAT, "it has no line with its size"))?;
        let resolution = String::from_utf8_lossy(resolution);
        let axes = axes_of(&resolution)
            .ok_or_else(|| damaged(name, FORMAT, format!("`{}` is no size", resolution.trim_end())))?;
        let file = HdrFile { axes, scanlines: rest };
        let [width, height] = file.size();
        check_size(name, width.into(), height.into(), PIXEL_BYTES)?;
        match width == 0 || height == 0 {
            true => Err(damaged(name, FORMAT, "it has no pixels")),
            false => Ok(file),
        }
    }

    /// Returns width and height.
    fn size(&self) -> [u32; 2] {
        let [outer, inner] = self.axes.map(|axis| axis.length);
        if self.axes[0].is_y {
            [inner, outer]
        } else {
            [outer, inner]
        }
    }

    /// Returns the memory of the decoded pixels.
    pub(crate) fn decoded_size(&self) -> DecodedSize {
        DecodedSize::of_pixels(self.size(), PIXEL_BYTES)
    }

    /// Decodes the scanlines and brings the image to the normal orientation.
    pub(crate) fn decode(&self, name: &str) -> Result<Picture, ImageError> {
        let explain = |error: image::ImageError| damaged(name, FORMAT, error);
        let [outer, inner] = self.axes.map(|axis| axis.length);
        let header = format!("#?RADIANCE\n\n-Y {outer} +X {inner}\n");
        let decoder = HdrDecoder::new(LookingReader(Cursor::new(header).chain(self.scanlines))).map_err(explain)?;
        // The size is within the limit of decoded images, which `open` has checked.
        let mut samples = vec![0.0_f32; outer as usize * inner as usize * 3];
        decoder
            .read_image(bytemuck::cast_slice_mut(&mut samples))
            .map_err(explain)?;
        let [width, height] = self.size();
        Ok(Picture {
            width,
            height,
            channels: 3,
            pixels: Pixels::F32(self.upright(samples)),
            color_space: DeclaredColorSpace::Linear,
            remarks: PictureRemarks::default(),
        })
    }

    /// Returns the samples in rows from the top, each from left to right.
    fn upright(&self, samples: Vec<f32>) -> Vec<f32> {
        let [outer, inner] = self.axes;
        if outer.is_y && !outer.is_reversed && !inner.is_reversed {
            return samples;
        }
        let [width, height] = self.size().map(|side| side as usize);
        let place = |axis: HdrAxis, at: usize| {
            if axis.is_reversed {
                axis.length as usize - 1 - at
            } else {
                at
            }
        };
        let pixels = (0..width * height).flat_map(|pixel| {
            let (x, y) = (pixel % width, pixel / width);
            let (line, column) = if outer.is_y { (y, x) } else { (x, y) };
            let from = place(outer, line) * inner.length as usize + place(inner, column);
            [0, 1, 2].map(|channel| samples[3 * from + channel])
        });
        pixels.collect()
    }
}

/// Takes the next line without its line end. Returns `None` if the text ends before the line end or the line is too long.
fn next_line<'b>(rest: &mut &'b [u8]) -> Option<&'b [u8]> {
    let end = rest.iter().take(LONGEST_LINE).position(|byte| *byte == b'\n')?;
    let line = &rest[..end];
    *rest = &rest[end + 1..];
    Some(line.strip_suffix(b"\r").unwrap_or(line))
}

/// Reads the axes from a line such as `-Y 512 +X 1024`: −Y means down and +X to the right.
fn axes_of(line: &str) -> Option<[HdrAxis; 2]> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [first, first_length, second, second_length] = *words.as_slice() else {
        return None;
    };
    let axis = |word: &str, length: &str| {
        let (is_y, is_reversed) = match word {
            "-Y" => (true, false),
            "+Y" => (true, true),
            "+X" => (false, false),
            "-X" => (false, true),
            _ => return None,
        };
        Some(HdrAxis {
            is_y,
            is_reversed,
            length: length.parse().ok()?,
        })
    };
    let axes = [axis(first, first_length)?, axis(second, second_length)?];
    (axes[0].is_y != axes[1].is_y).then_some(axes)
}

#[cfg(test)]
mod tests {
    use crate::{ImageError, Pixels, decode, decoded_size};

    /// Creates an image of 2 × 1 pixels, (1, 0.5, 0.25) and (2, 0, 0), with this header.
    fn file(header: &str, size: &str) -> Vec<u8> {
        let mut bytes = format!("{header}{size}\n").into_bytes();
        bytes.extend([128, 64, 32, 129, 128, 0, 0, 130]);
        bytes
    }

    const LEFT: [f32; 3] = [1.0, 0.5, 0.25];
    const RIGHT: [f32; 3] = [2.0, 0.0, 0.0];

    fn samples(bytes: &[u8]) -> ([u32; 2], Vec<f32>) {
        let picture = decode("a.hdr", bytes).unwrap();
        let Pixels::F32(values) = picture.pixels else { panic!() };
        ([picture.width, picture.height], values)
    }

    #[test]
    fn headers_of_all_programs_and_line_ends_are_read() {
        for header in [
            "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n",
            "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n",
            "#?AUTOPANO\n# made by hand\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n",
            "#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n",
            "#?RGBE\nFORMAT = 32-bit_rle_rgbe \nEXPOSURE=no number\n\n",
        ] {
            let end = if header.contains('\r') {
                "-Y 1 +X 2\r"
            } else {
                "-Y 1 +X 2"
            };
            assert_eq!(
                samples(&file(header, end)),
                ([2, 1], [LEFT, RIGHT].concat()),
                "{header:?}"
            );
        }
    }

    #[test]
    fn images_are_brought_upright_from_every_orientation() {
        for (size, expected) in [
            ("-Y 1 +X 2", ([2, 1], [LEFT, RIGHT])),
            ("+Y 1 +X 2", ([2, 1], [LEFT, RIGHT])),
            ("-Y 1 -X 2", ([2, 1], [RIGHT, LEFT])),
            ("+Y 2 +X 1", ([1, 2], [RIGHT, LEFT])),
            ("-Y 2 +X 1", ([1, 2], [LEFT, RIGHT])),
            // Columns from left to right, each from the top.
            ("+X 2 -Y 1", ([2, 1], [LEFT, RIGHT])),
            ("-X 2 +Y 1", ([2, 1], [RIGHT, LEFT])),
            ("+X 1 +Y 2", ([1, 2], [RIGHT, LEFT])),
        ] {
            let (pixels, values) = expected;
            assert_eq!(
                samples(&file("#?RADIANCE\n\n", size)),
                (pixels, values.concat()),
                "{size}"
            );
        }
    }

    #[test]
    fn damage_unsupported_colors_and_huge_sizes_give_different_errors() {
        let why = |bytes: &[u8]| decode("a.hdr", bytes).unwrap_err();
        let xyze = why(&file("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", "-Y 1 +X 2"));
        assert!(matches!(xyze, ImageError::Feature { .. }), "{xyze}");
        for size in ["-Y 1", "-Y 1 +Y 2", "-Y a +X 2", "-Y 0 +X 2"] {
            let error = why(&file("#?RADIANCE\n\n", size));
            assert!(matches!(error, ImageError::Damaged { .. }), "{size}: {error}");
        }
        assert!(matches!(
            why(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"),
            ImageError::Damaged { .. }
        ));
        let huge = decoded_size("a.hdr", &file("#?RADIANCE\n\n", "-Y 16384 +X 16384")).unwrap_err();
        assert!(matches!(huge, ImageError::TooLarge { .. }), "{huge}");
    }
}
