//! The pixels of a picture at one size.

use glam::DVec2;
use sabi_color::srgb_from_linear;
use sabi_image::{Picture, TransferCurve};

use super::{PictureEnds, PicturePart};

/// Channels of a pixel: linear red, green and blue times alpha, alpha, and encoded lightness times alpha.
type Pixel = [u16; 5];

/// A picture at one size.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MipLevel {
    /// Pixels across and down.
    pub(super) size: [usize; 2],
    /// Row by row from the top.
    pub(super) pixels: Vec<Pixel>,
}

/// A pixel from its linear channels.
fn pixel([red, green, blue, alpha]: [f32; 4], is_coded: bool) -> Pixel {
    let alpha = if alpha.is_finite() { alpha.clamp(0.0, 1.0) } else { 0.0 };
    let coded = |channel: f32| if is_coded { srgb_from_linear(channel) } else { channel };
    // Rec. 709 luma of the encoded values.
    let light = 0.2126 * coded(red) + 0.7152 * coded(green) + 0.0722 * coded(blue);
    [red, green, blue, 1.0, light].map(|channel| {
        let channel = if channel.is_finite() {
            channel.clamp(0.0, 1.0)
        } else {
            0.0
        };
        (channel * alpha * f32::from(u16::MAX)).round() as u16
    })
}

impl MipLevel {
    /// Converts a decoded picture at its full size. Colors are read as it declares.
    pub(super) fn new(picture: &Picture) -> MipLevel {
        let curve = picture.color_curve();
        let is_coded = curve != TransferCurve::Linear;
        let linear = picture.linear_rgba(curve).rgba;
        MipLevel {
            size: [picture.width, picture.height].map(|side| side.max(1) as usize),
            pixels: linear.iter().map(|linear| pixel(*linear, is_coded)).collect(),
        }
    }

    /// Returns the picture at half the size. Pixels are means of four pixels, or of two if only one row or column is left.
    pub(super) fn halved(&self) -> MipLevel {
        let size = self.size.map(|side| (side / 2).max(1));
        let pixels = (0..size[0] * size[1]).map(|index| {
            let (x, y) = (index % size[0], index / size[0]);
            let near = |at: usize, side: usize| [(2 * at).min(side - 1), (2 * at + 1).min(side - 1)];
            let (columns, rows) = (near(x, self.size[0]), near(y, self.size[1]));
            std::array::from_fn(|channel| {
                let value = |x: usize, y: usize| u32::from(self.pixels[y * self.size[0] + x][channel]);
                let sum: u32 = rows.iter().flat_map(|y| columns.map(|x| value(x, *y))).sum();
                ((sum + 2) / 4) as u16
            })
        });
        MipLevel {
            pixels: pixels.collect(),
            size,
        }
    }

    /// Returns the channels at a position, interpolated from four pixels. Outside, the pixels of the border are used.
    pub(super) fn at(&self, place: DVec2, ends: PictureEnds) -> [f64; 5] {
        let [width, height] = self.size.map(|side| side as f64);
        let at = 0.5 * (DVec2::new(place.x, -place.y) + 1.0) * DVec2::new(width, height) - 0.5;
        let corner = at.floor();
        let share = at - corner;
        let mut sum = [0.0; 5];
        for offset in 0..4_u32 {
            let step = DVec2::new(f64::from(offset & 1), f64::from(offset >> 1));
            let mut from = corner + step;
            if ends == PictureEnds::Joined {
                from.x = from.x.rem_euclid(width);
            }
            let from = from.clamp(DVec2::ZERO, DVec2::new(width - 1.0, height - 1.0));
            let weights = step * share + (1.0 - step) * (1.0 - share);
            let weight = weights.x * weights.y / f64::from(u16::MAX);
            let pixel = &self.pixels[from.y as usize * self.size[0] + from.x as usize];
            for (sum, channel) in sum.iter_mut().zip(pixel) {
                *sum += weight * f64::from(*channel);
            }
        }
        sum
    }

    pub(super) fn likely_part(&self) -> PicturePart {
        let has = |test: &dyn Fn(&Pixel) -> bool| self.pixels.iter().any(test);
        let is_colored = has(&|[red, green, blue, ..]| red.abs_diff(*green).max(green.abs_diff(*blue)) > u16::MAX / 20);
        if is_colored {
            return PicturePart::Colors;
        }
        if has(&|[.., alpha, _]| *alpha < u16::MAX / 10 * 9) {
            return PicturePart::Alpha;
        }
        let light = self.pixels.iter().filter(|[.., light]| *light > u16::MAX / 2).count();
        if 2 * light > self.pixels.len() {
            PicturePart::Dark
        } else {
            PicturePart::Light
        }
    }
}
