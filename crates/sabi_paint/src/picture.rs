//! Pictures that brushes stamp: their names, and their pixels at any size.

mod mip_level;
mod name;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use sabi_image::{DeclaredColorSpace, ImageError, Picture, PictureRemarks, Pixels, decode};
use serde::{Deserialize, Serialize};

use mip_level::MipLevel;
pub use name::{NoPictureName, PictureName};

/// Largest side of a picture in pixels. Larger pictures are halved until they fit.
const SIDE_LIMIT: u32 = 4096;
/// Maximum number of pixels of a picture that is read.
const PIXEL_LIMIT: u64 = 1 << 26;

/// Pictures by their names.
pub type StampPictures = BTreeMap<PictureName, Arc<StampPicture>>;

/// A picture as the tip of a brush.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureTip {
    /// The picture.
    pub picture: PictureName,
    /// The part of it that is stamped.
    pub part: PicturePart,
}

/// Part of a picture that is stamped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PicturePart {
    /// Its own colors, with its alpha as the strength.
    #[default]
    Colors,
    /// The brush's color, with the picture's alpha as the strength.
    Alpha,
    /// The brush's color, strong where the picture is light.
    Light,
    /// The brush's color, strong where the picture is dark.
    Dark,
}

impl PicturePart {
    /// All parts with their titles.
    pub const ALL: [(PicturePart, &'static str); 4] = [
        (PicturePart::Colors, "Its colors"),
        (PicturePart::Alpha, "Its alpha"),
        (PicturePart::Light, "Its light parts"),
        (PicturePart::Dark, "Its dark parts"),
    ];
}

/// Error of a picture that cannot be stamped.
#[derive(Debug, thiserror::Error)]
pub enum StampPictureError {
    /// The file is not a picture that can be read.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The picture has too many pixels.
    #[error("a picture of {0} × {1} pixels is too large for a brush, which takes up to 8192 × 8192")]
    TooLarge(u32, u32),
}

/// A picture that is ready to be stamped, with reduced copies for large texels.
#[derive(Clone, Debug, PartialEq)]
pub struct StampPicture {
    /// Copies from the full size to a single pixel, each half as large as the one before.
    levels: Vec<MipLevel>,
    /// The part that the artist most likely wants to stamp.
    likely: PicturePart,
}

/// Left and right ends of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureEnds {
    /// Nothing is stamped beyond the ends.
    Cut,
    /// The picture is repeated beyond the ends.
    Joined,
}

/// A pixel of a picture of a stroke or of a stamp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SwatchPixel {
    /// 0 to 1.
    pub strength: f32,
    /// Linear color from the picture; `None` if the brush's color is used.
    pub color: Option<[f32; 3]>,
}

/// Strength and color of a stamp at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StampSample {
    /// 0 to 1.
    pub(crate) strength: f64,
    /// Linear color; `None` if the brush's color is stamped.
    pub(crate) color: Option<[f32; 3]>,
}

impl StampPicture {
    /// Reads a picture. `name` is the name of its file, from which the format is determined.
    ///
    /// # Errors
    /// The bytes are no picture, or it is too large.
    pub fn read(name: &str, bytes: &[u8]) -> Result<StampPicture, StampPictureError> {
        let picture = decode(name, bytes)?;
        if u64::from(picture.width) * u64::from(picture.height) > PIXEL_LIMIT {
            return Err(StampPictureError::TooLarge(picture.width, picture.height));
        }
        Ok(StampPicture::new(&picture))
    }

    /// Prepares a decoded picture.
    pub fn new(picture: &Picture) -> StampPicture {
        let mut level = MipLevel::new(picture);
        let likely = level.likely_part();
        while level.size.iter().any(|side| *side > SIDE_LIMIT as usize) {
            level = level.halved();
        }
        let mut levels = vec![level];
        while let Some(last) = levels.last().filter(|last| last.size != [1, 1]) {
            let next = last.halved();
            levels.push(next);
        }
        StampPicture { levels, likely }
    }

    /// Returns width and height in pixels after the reduction.
    pub fn size(&self) -> [usize; 2] {
        self.levels.first().map_or([1, 1], |level| level.size)
    }

    /// Returns the part that the artist most likely wants: the colors of a picture that has colors, the alpha of one with
    /// transparent parts, the dark parts of a drawing on white, and the light parts of others.
    pub fn likely_part(&self) -> PicturePart {
        self.likely
    }

    /// Creates a picture of shapes from the alpha of each pixel, row by row from the top.
    pub fn of_alpha([width, height]: [usize; 2], alpha: &[u8]) -> StampPicture {
        StampPicture::new(&Picture {
            width: width as u32,
            height: height as u32,
            channels: 2,
            pixels: Pixels::U8(alpha.iter().flat_map(|alpha| [255, *alpha]).collect()),
            color_space: DeclaredColorSpace::Srgb,
            remarks: PictureRemarks::default(),
        })
    }

    /// Returns the stamp of a part of the picture with its width and height, pixel by pixel from the upper left one. The
    /// largest copy whose sides have at most `side` pixels is used.
    pub fn shown(&self, part: PicturePart, side: usize) -> ([usize; 2], Vec<SwatchPixel>) {
        let fits = |level: &&MipLevel| level.size.iter().all(|own| *own <= side.max(1));
        let Some(level) = self.levels.iter().find(fits) else {
            return ([0, 0], Vec::new());
        };
        let pixels = level.pixels.iter().map(|pixel| {
            let stamped = part_of(pixel.map(|channel| f64::from(channel) / f64::from(u16::MAX)), part);
            SwatchPixel {
                strength: stamped.strength as f32,
                color: stamped.color,
            }
        });
        (level.size, pixels.collect())
    }

    /// Returns half of the width and of the height, where the longer side is 2.
    pub fn half_sides(&self) -> DVec2 {
        let [width, height] = self.size().map(|side| side as f64);
        DVec2::new(width, height) / width.max(height)
    }

    /// Returns the picture at a position: x from −1 (left) to 1 (right), y from −1 (bottom) to 1 (top). `width` is that of
    /// a texel, in the same units along the longer side. Nothing is stamped outside, except if the ends are joined.
    pub(crate) fn at(&self, place: DVec2, width: f64, part: PicturePart, ends: PictureEnds) -> StampSample {
        // The border is one texel wide, independent of the number of pixels of the picture.
        let inside = (1.0 - place.abs()) * self.half_sides() / width + 0.5;
        let inside = inside.clamp(DVec2::ZERO, DVec2::ONE);
        let inside = match ends {
            PictureEnds::Cut => inside.x * inside.y,
            PictureEnds::Joined => inside.y,
        };
        let pixels = self.filtered(place, width, ends);
        part_of(pixels.map(|channel| channel * inside), part)
    }

    /// Returns the channels at a position, interpolated between the two copies whose pixel widths are nearest to that of a texel.
    fn filtered(&self, place: DVec2, width: f64, ends: PictureEnds) -> [f64; 5] {
        let longer = self.size().into_iter().max().unwrap_or(1) as f64; // A size always has two sides.
        let fine = (0.5 * width * longer).max(1.0).log2();
        let last = self.levels.len() - 1;
        let lower = (fine.floor() as usize).min(last);
        let share = (fine - lower as f64).clamp(0.0, 1.0);
        let first = self.levels[lower].at(place, ends);
        if share <= 0.0 || lower == last {
            return first;
        }
        let second = self.levels[lower + 1].at(place, ends);
        std::array::from_fn(|channel| first[channel] + share * (second[channel] - first[channel]))
    }
}

/// Returns the stamp of a part of a picture from the channels of a pixel.
fn part_of([red, green, blue, alpha, light]: [f64; 5], part: PicturePart) -> StampSample {
    let of_light = |light: f64| StampSample {
        strength: light.clamp(0.0, 1.0),
        color: None,
    };
    match part {
        PicturePart::Alpha => of_light(alpha),
        PicturePart::Light => of_light(light),
        PicturePart::Dark => of_light(alpha - light),
        PicturePart::Colors => StampSample {
            color: (alpha > 0.0).then(|| [red, green, blue].map(|channel| (channel / alpha).min(1.0) as f32)),
            ..of_light(alpha)
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of RGBA pixels in rows of `width`.
    fn picture(width: u32, pixels: &[[u8; 4]]) -> StampPicture {
        StampPicture::new(&Picture {
            width,
            height: pixels.len() as u32 / width,
            channels: 4,
            pixels: Pixels::U8(pixels.as_flattened().to_vec()),
            color_space: DeclaredColorSpace::Unknown,
            remarks: PictureRemarks::default(),
        })
    }

    const RED: [u8; 4] = [255, 0, 0, 255];
    const CLEAR: [u8; 4] = [255, 255, 255, 0];

    #[test]
    fn a_picture_is_stamped_upright_and_nothing_is_stamped_outside() {
        let halves = picture(2, &[RED, CLEAR, [0, 0, 255, 255], [0, 255, 0, 255]]);
        let at = |x: f64, y: f64| halves.at(DVec2::new(x, y), 0.01, PicturePart::Colors, PictureEnds::Cut);
        assert_eq!(
            at(-0.5, 0.5),
            StampSample {
                strength: 1.0,
                color: Some([1.0, 0.0, 0.0])
            }
        );
        assert_eq!(at(0.5, 0.5).strength, 0.0);
        assert_eq!(at(0.5, -0.5).color, Some([0.0, 1.0, 0.0]));
        assert_eq!(at(1.6, 0.0).strength, 0.0);
    }

    #[test]
    fn transparent_pixels_do_not_color_their_neighbors() {
        let edge = picture(2, &[RED, CLEAR]).at(DVec2::ZERO, 0.01, PicturePart::Colors, PictureEnds::Cut);
        assert!((edge.strength - 0.5).abs() < 1e-4);
        assert_eq!(edge.color, Some([1.0, 0.0, 0.0]));
    }

    #[test]
    fn wide_texels_have_the_mean_of_the_pixels_that_they_cover() {
        let board: Vec<[u8; 4]> = (0..64)
            .map(|at| if (at / 8 + at) % 2 == 0 { RED } else { CLEAR })
            .collect();
        let seen = picture(8, &board).at(DVec2::new(0.1, 0.2), 1.0, PicturePart::Alpha, PictureEnds::Cut);
        assert!((seen.strength - 0.5).abs() < 1e-3);
    }

    #[test]
    fn the_likely_part_of_labels_stencils_drawings_and_scans_is_found() {
        let (white, black) = ([255; 4], [0, 0, 0, 255]);
        assert_eq!(picture(2, &[RED, white]).likely_part(), PicturePart::Colors);
        assert_eq!(picture(2, &[black, CLEAR]).likely_part(), PicturePart::Alpha);
        assert_eq!(picture(3, &[black, white, white]).likely_part(), PicturePart::Dark);
        assert_eq!(picture(3, &[black, black, white]).likely_part(), PicturePart::Light);
    }

    #[test]
    fn light_and_dark_parts_add_up_to_the_alpha() {
        let gray = picture(1, &[[128, 128, 128, 255]]);
        let of = |part| gray.at(DVec2::ZERO, 0.1, part, PictureEnds::Cut).strength;
        assert!((of(PicturePart::Light) - 128.0 / 255.0).abs() < 1e-4);
        assert!((of(PicturePart::Light) + of(PicturePart::Dark) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_long_picture_keeps_its_aspect_ratio() {
        assert_eq!(picture(4, &[RED; 8]).half_sides(), DVec2::new(1.0, 0.5));
    }
}
