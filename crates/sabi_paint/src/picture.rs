//! Pictures that brushes stamp: their names, and their pixels at any size.

mod level;
mod name;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use sabi_image::{Declared, ImageError, Picture, Pixels, decode};
use serde::{Deserialize, Serialize};

use level::Level;
pub use name::{NoPictureName, PictureName};

/// Largest side of a picture that is kept, pixels; larger ones are halved until they fit.
const SIDE_LIMIT: u32 = 4096;
/// Most pixels of a picture that is read.
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
    /// Its own colors, as strong as it is opaque.
    #[default]
    Colors,
    /// The brush's color, as strong as the picture is opaque.
    Alpha,
    /// The brush's color, as strong as the picture is light.
    Light,
    /// The brush's color, as strong as the picture is dark.
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

/// A picture that no brush can stamp.
#[derive(Debug, thiserror::Error)]
pub enum StampPictureError {
    /// No picture that is read.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Too many pixels.
    #[error("a picture of {0} × {1} pixels is too large for a brush, which takes up to 8192 × 8192")]
    TooLarge(u32, u32),
}

/// A picture that is ready to be stamped, with smaller copies for far away.
#[derive(Clone, Debug, PartialEq)]
pub struct StampPicture {
    /// From the full size to a single pixel, each half as large as the one before.
    levels: Vec<Level>,
    /// The part of it that an artist means most likely.
    likely: PicturePart,
}

/// Left and right ends of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// Nothing is stamped beyond them.
    Cut,
    /// The picture begins again there.
    Joined,
}

/// A pixel of a picture of a stroke or of a stamp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SwatchPixel {
    /// 0 to 1.
    pub strength: f32,
    /// Linear color that a picture brings; none where it is the brush's.
    pub color: Option<[f32; 3]>,
}

/// A place of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stamped {
    /// 0 to 1.
    pub(crate) strength: f64,
    /// Linear color; none where the brush's own is stamped.
    pub(crate) color: Option<[f32; 3]>,
}

impl StampPicture {
    /// Reads a picture. `name` is that of its file, for the kind of file.
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
        let is_coded = match picture.color_space {
            Declared::Srgb => true,
            Declared::Linear => false,
            Declared::Unknown => !matches!(picture.pixels, Pixels::F32(_)),
        };
        let mut level = Level::new(picture, is_coded);
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

    /// Pixels across and down, as far as they are kept.
    pub fn size(&self) -> [usize; 2] {
        self.levels.first().map_or([1, 1], |level| level.size)
    }

    /// The part that an artist means most likely: the colors of a picture that has any, the alpha of one that has holes, the dark
    /// parts of a drawing on white, and the light parts of others.
    pub fn likely_part(&self) -> PicturePart {
        self.likely
    }

    /// A picture of shapes: how opaque each pixel is, row by row from the top.
    pub fn of_alpha([width, height]: [usize; 2], alpha: &[u8]) -> StampPicture {
        StampPicture::new(&Picture {
            width: width as u32,
            height: height as u32,
            channels: 2,
            pixels: Pixels::U8(alpha.iter().flat_map(|alpha| [255, *alpha]).collect()),
            color_space: Declared::Srgb,
        })
    }

    /// Stamp of a part of the picture, pixel by pixel from the upper left one, at the largest size of its copies whose sides are no
    /// longer than a number of pixels; with its width and height.
    pub fn shown(&self, part: PicturePart, side: usize) -> ([usize; 2], Vec<SwatchPixel>) {
        let fits = |level: &&Level| level.size.iter().all(|own| *own <= side.max(1));
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

    /// Half of the width and of the height, where the longer side is 2.
    pub fn half_sides(&self) -> DVec2 {
        let [width, height] = self.size().map(|side| side as f64);
        DVec2::new(width, height) / width.max(height)
    }

    /// The picture at a place: x from −1 at its left to 1 at its right, y from −1 at its foot to 1 at its top. `width` is that of
    /// a texel in the same measure along the longer side. Nothing is stamped outside, but for ends that are joined.
    pub(crate) fn at(&self, place: DVec2, width: f64, part: PicturePart, ends: Ends) -> Stamped {
        // The border is one texel wide, however few pixels the picture has.
        let inside = (1.0 - place.abs()) * self.half_sides() / width + 0.5;
        let inside = inside.clamp(DVec2::ZERO, DVec2::ONE);
        let inside = match ends {
            Ends::Cut => inside.x * inside.y,
            Ends::Joined => inside.y,
        };
        let pixels = self.filtered(place, width, ends);
        part_of(pixels.map(|channel| channel * inside), part)
    }

    /// The channels at a place, between the two copies whose pixels are nearest to a texel in width.
    fn filtered(&self, place: DVec2, width: f64, ends: Ends) -> [f64; 5] {
        let longer = self.size().into_iter().max().unwrap_or(1) as f64; // Two sides.
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

/// Stamp of a part of a picture, from the channels of a pixel.
fn part_of([red, green, blue, alpha, light]: [f64; 5], part: PicturePart) -> Stamped {
    let of_light = |light: f64| Stamped {
        strength: light.clamp(0.0, 1.0),
        color: None,
    };
    match part {
        PicturePart::Alpha => of_light(alpha),
        PicturePart::Light => of_light(light),
        PicturePart::Dark => of_light(alpha - light),
        PicturePart::Colors => Stamped {
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
            color_space: Declared::Unknown,
        })
    }

    const RED: [u8; 4] = [255, 0, 0, 255];
    const CLEAR: [u8; 4] = [255, 255, 255, 0];

    #[test]
    fn a_picture_is_stamped_upright_and_empty_outside() {
        let halves = picture(2, &[RED, CLEAR, [0, 0, 255, 255], [0, 255, 0, 255]]);
        let at = |x: f64, y: f64| halves.at(DVec2::new(x, y), 0.01, PicturePart::Colors, Ends::Cut);
        assert_eq!(
            at(-0.5, 0.5),
            Stamped {
                strength: 1.0,
                color: Some([1.0, 0.0, 0.0])
            }
        );
        assert_eq!(at(0.5, 0.5).strength, 0.0);
        assert_eq!(at(0.5, -0.5).color, Some([0.0, 1.0, 0.0]));
        assert_eq!(at(1.6, 0.0).strength, 0.0);
    }

    #[test]
    fn clear_pixels_lend_no_color_to_their_neighbors() {
        let edge = picture(2, &[RED, CLEAR]).at(DVec2::ZERO, 0.01, PicturePart::Colors, Ends::Cut);
        assert!((edge.strength - 0.5).abs() < 1e-4);
        assert_eq!(edge.color, Some([1.0, 0.0, 0.0]));
    }

    #[test]
    fn wide_texels_see_the_mean_of_what_they_cover() {
        let board: Vec<[u8; 4]> = (0..64)
            .map(|at| if (at / 8 + at) % 2 == 0 { RED } else { CLEAR })
            .collect();
        let seen = picture(8, &board).at(DVec2::new(0.1, 0.2), 1.0, PicturePart::Alpha, Ends::Cut);
        assert!((seen.strength - 0.5).abs() < 1e-3);
    }

    #[test]
    fn the_likely_part_is_that_of_labels_stencils_drawings_and_scans() {
        let (white, black) = ([255; 4], [0, 0, 0, 255]);
        assert_eq!(picture(2, &[RED, white]).likely_part(), PicturePart::Colors);
        assert_eq!(picture(2, &[black, CLEAR]).likely_part(), PicturePart::Alpha);
        assert_eq!(picture(3, &[black, white, white]).likely_part(), PicturePart::Dark);
        assert_eq!(picture(3, &[black, black, white]).likely_part(), PicturePart::Light);
    }

    #[test]
    fn light_and_dark_parts_add_up_to_the_alpha() {
        let gray = picture(1, &[[128, 128, 128, 255]]);
        let of = |part| gray.at(DVec2::ZERO, 0.1, part, Ends::Cut).strength;
        assert!((of(PicturePart::Light) - 128.0 / 255.0).abs() < 1e-4);
        assert!((of(PicturePart::Light) + of(PicturePart::Dark) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_long_picture_keeps_its_sides() {
        assert_eq!(picture(4, &[RED; 8]).half_sides(), DVec2::new(1.0, 0.5));
    }
}
