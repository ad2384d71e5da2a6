//! Mip chain of a picture, in linear values.

use std::sync::Arc;

use rayon::prelude::*;
use sabi_image::{Picture, Pixels, TransferCurve};

/// Curve by which the codes of a picture are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PixelCurve {
    /// Codes are linear values.
    Linear,
    /// The curve of sRGB.
    Srgb,
    /// The curve of [`Picture::color_curve`].
    Declared,
}

/// Options for reading the values of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelReading {
    /// Curve of all channels except alpha.
    pub(crate) curve: PixelCurve,
    /// True if colors are weighted by alpha in averages, as is right for colors next to holes; false if alpha is an independent value.
    pub(crate) by_alpha: bool,
}

impl PixelReading {
    /// All combinations, each at the index of its number.
    pub(super) const ALL: [PixelReading; 6] = [
        PixelReading::of(PixelCurve::Linear, false),
        PixelReading::of(PixelCurve::Srgb, false),
        PixelReading::of(PixelCurve::Declared, false),
        PixelReading::of(PixelCurve::Linear, true),
        PixelReading::of(PixelCurve::Srgb, true),
        PixelReading::of(PixelCurve::Declared, true),
    ];

    const fn of(curve: PixelCurve, by_alpha: bool) -> PixelReading {
        PixelReading { curve, by_alpha }
    }

    /// Number of the way, below six.
    pub(super) fn number(self) -> usize {
        self.curve as usize + 3 * usize::from(self.by_alpha)
    }

    /// Returns the curve for a picture.
    fn curve_of(self, picture: &Picture) -> TransferCurve {
        match self.curve {
            PixelCurve::Linear => TransferCurve::Linear,
            PixelCurve::Srgb => TransferCurve::Srgb,
            PixelCurve::Declared => picture.color_curve(),
        }
    }

    /// Returns the same options with the declared curve of a picture replaced by its name where it has one, so that the same values
    /// have the same options.
    pub(super) fn named(self, picture: &Picture) -> PixelReading {
        let curve = match self.curve_of(picture) {
            TransferCurve::Linear => PixelCurve::Linear,
            TransferCurve::Srgb => PixelCurve::Srgb,
            TransferCurve::Power(_) => PixelCurve::Declared,
        };
        PixelReading { curve, ..self }
    }
}

/// Picture with copies of half, a quarter… its size, whose pixels are exact area averages. All values are linear, and
/// colors are never premultiplied by alpha.
#[derive(Clone)]
pub(crate) struct MipChain {
    picture: Arc<Picture>,
    /// Linear value of each 8-bit code.
    code_table: Option<[f32; 256]>,
    reading: PixelReading,
    curve: TransferCurve,
    smaller: Vec<Arc<MipLevel>>,
}

/// Smaller copy, linear RGBA.
struct MipLevel {
    size: [u32; 2],
    pixels: Vec<[f32; 4]>,
}

impl MipChain {
    /// Creates the chain of a picture without any smaller copies.
    pub(crate) fn new(picture: Arc<Picture>, reading: PixelReading) -> MipChain {
        let curve = reading.curve_of(&picture);
        let linear = |code: usize| curve.linear(code as f32 / 255.0);
        let code_table = matches!(picture.pixels, Pixels::U8(_)).then(|| std::array::from_fn(linear));
        MipChain {
            picture,
            code_table,
            reading,
            curve,
            smaller: Vec::new(),
        }
    }

    /// Builds the missing levels, down to the first one with at most `least` pixels along both sides. Returns the chain
    /// down to that level.
    pub(crate) fn down_to(&mut self, least: u32) -> MipChain {
        let is_small = |chain: &MipChain, level: usize| chain.size(level).iter().all(|side| *side <= least.max(1));
        while !is_small(self, self.last()) {
            let half = self.half();
            self.smaller.push(Arc::new(half));
        }
        let mut chain = self.clone();
        let enough = (0..self.last()).find(|level| is_small(self, *level));
        chain.smaller.truncate(enough.unwrap_or(self.last()));
        chain
    }

    /// Returns true if another chain shows the same picture with the same options.
    pub(super) fn is_same(&self, other: &MipChain) -> bool {
        Arc::ptr_eq(&self.picture, &other.picture) && self.reading == other.reading && self.last() == other.last()
    }

    /// Returns the values of the picture as the file stores them.
    pub(super) fn pixels(&self) -> &Pixels {
        &self.picture.pixels
    }

    /// Returns the number of channels of the picture.
    pub(super) fn channels(&self) -> usize {
        usize::from(self.picture.channels)
    }

    /// Returns the options for reading the values of the picture.
    pub(super) fn reading(&self) -> PixelReading {
        self.reading
    }

    /// Returns the index of the smallest level; 0 is the picture itself.
    pub(crate) fn last(&self) -> usize {
        self.smaller.len()
    }

    /// Returns the memory of the smaller copies, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let pixels = self.smaller.iter().map(|level| level.pixels.len());
        (pixels.sum::<usize>() * size_of::<[f32; 4]>()) as u64
    }

    /// Returns width and height of a level.
    pub(crate) fn size(&self, level: usize) -> [u32; 2] {
        match level.checked_sub(1) {
            None => [self.picture.width, self.picture.height],
            Some(at) => self.smaller[at].size,
        }
    }

    /// Returns the linear RGBA of a pixel. Gray is repeated, and a missing alpha is 1.
    pub(crate) fn pixel(&self, level: usize, x: usize, y: usize) -> [f32; 4] {
        let across = self.size(level)[0] as usize;
        if let Some(at) = level.checked_sub(1) {
            return self.smaller[at].pixels[y * across + x];
        }
        let channels = usize::from(self.picture.channels);
        let start = (y * across + x) * channels;
        let raw = |at: usize| self.value(start + at, at);
        match channels {
            1 => [raw(0), raw(0), raw(0), 1.0],
            2 => [raw(0), raw(0), raw(0), raw(1)],
            3 => [raw(0), raw(1), raw(2), 1.0],
            _ => [raw(0), raw(1), raw(2), raw(3)],
        }
    }

    /// Returns one linear sample. The last of two or four channels is alpha, which is never encoded. Non-finite values count as
    /// 0.
    fn value(&self, index: usize, channel: usize) -> f32 {
        let is_alpha = matches!((self.picture.channels, channel), (2, 1) | (4, 3));
        let decode = |value: f32| if is_alpha { value } else { self.curve.linear(value) };
        match &self.picture.pixels {
            Pixels::U8(codes) => match &self.code_table {
                Some(table) if !is_alpha => table[usize::from(codes[index])],
                _ => f32::from(codes[index]) / 255.0,
            },
            Pixels::U16(codes) => decode(f32::from(codes[index]) / 65_535.0),
            Pixels::F32(values) if values[index].is_finite() => decode(values[index]),
            Pixels::F32(_) => 0.0,
        }
    }

    /// Computes a level from one of exactly twice its size. This is the usual case, and much faster.
    fn half_of_even_size(&self, level: usize, size: [u32; 2]) -> MipLevel {
        let [width, height] = size.map(|side| side as usize);
        let mut pixels = vec![[0.0; 4]; width * height];
        pixels.par_chunks_mut(width).enumerate().for_each(|(row, line)| {
            for (column, pixel) in line.iter_mut().enumerate() {
                let at = |x: usize, y: usize| self.pixel(level, 2 * column + x, 2 * row + y);
                let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                *pixel = mean(four.map(|pixel| (pixel, 0.25)), self.reading.by_alpha);
            }
        });
        MipLevel { size, pixels }
    }

    /// Computes the next level, of half the size of the last one.
    fn half(&self) -> MipLevel {
        let level = self.last();
        let from = self.size(level);
        let size = from.map(|side| (side / 2).max(1));
        if from == size.map(|side| 2 * side) {
            self.half_of_even_size(level, size)
        } else {
            self.half_of_any_size(level, size)
        }
    }

    /// Computes a level from a larger one, using the covered share of each of its pixels.
    fn half_of_any_size(&self, level: usize, size: [u32; 2]) -> MipLevel {
        let from = self.size(level);
        let columns: Vec<PixelCoverage> = (0..size[0])
            .map(|at| PixelCoverage::new(at, size[0], from[0]))
            .collect();
        let pixels = (0..size[1]).into_par_iter().flat_map_iter(|row| {
            let rows = PixelCoverage::new(row, size[1], from[1]);
            let average = move |columns: &PixelCoverage| {
                let parts = rows.parts().flat_map(|(y, down)| {
                    let of_row = move |(x, across)| (self.pixel(level, x, y), down * across);
                    columns.parts().map(of_row)
                });
                mean(parts, self.reading.by_alpha)
            };
            columns.iter().map(average).collect::<Vec<_>>()
        });
        MipLevel {
            size,
            pixels: pixels.collect(),
        }
    }
}

/// Returns the mean of pixels with their shares of the area, which add up to 1. With `by_alpha`, colors are weighted by
/// alpha; if all pixels are transparent, colors are weighted equally.
fn mean(pixels: impl IntoIterator<Item = ([f32; 4], f32)>, by_alpha: bool) -> [f32; 4] {
    let mut sum = [0.0_f32; 4];
    let mut opaque = [0.0_f32; 3];
    for (pixel, share) in pixels {
        for (sum, value) in sum.iter_mut().zip(pixel) {
            *sum += value * share;
        }
        for (sum, value) in opaque.iter_mut().zip(pixel) {
            *sum += value * (share * pixel[3]);
        }
    }
    let alpha = sum[3];
    if by_alpha && alpha > 0.0 {
        let [red, green, blue] = opaque.map(|sum| sum / alpha);
        return [red, green, blue, alpha];
    }
    sum
}

/// Pixels of a row that one pixel of a smaller row covers: at most four, each with its weight.
#[derive(Clone, Copy)]
struct PixelCoverage {
    first: usize,
    weights: [f32; 4],
}

impl PixelCoverage {
    /// Computes the coverage of pixel `at` of a row of `size` pixels over a row of `from` pixels; the ratio is below 4.
    fn new(at: u32, size: u32, from: u32) -> PixelCoverage {
        let ratio = f64::from(from) / f64::from(size);
        let (low, high) = (f64::from(at) * ratio, f64::from(at + 1) * ratio);
        let first = low.floor();
        let weight = |part: usize| {
            let left = first + part as f64;
            ((left + 1.0).min(high) - left.max(low)).max(0.0) / ratio
        };
        PixelCoverage {
            first: first as usize,
            weights: std::array::from_fn(|part| {
                // Rounding must not lead to a pixel after the last one.
                if first + (part as f64) < f64::from(from) {
                    weight(part) as f32
                } else {
                    0.0
                }
            }),
        }
    }

    fn parts(self) -> impl Iterator<Item = (usize, f32)> {
        let parts = (0..4).map(move |part| (self.first + part, self.weights[part]));
        parts.filter(|(_, weight)| *weight > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use sabi_image::{DeclaredColorSpace, PictureRemarks};

    use super::*;

    const PLAIN: PixelReading = PixelReading::of(PixelCurve::Linear, false);

    #[test]
    fn clear_pixels_give_no_color_to_averages_of_opaque_ones() {
        // Red next to transparent black, and transparent white above transparent blue.
        let pixels = [
            [1.0, 0.0, 0.0, 1.0],
            [0.0; 4],
            [1.0, 1.0, 1.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ]
        .concat();
        for (size, last) in [([4, 1], [1.0, 0.0, 0.0, 0.25]), ([1, 4], [1.0, 0.0, 0.0, 0.25])] {
            let picture = Arc::new(Picture {
                width: size[0],
                height: size[1],
                channels: 4,
                pixels: Pixels::F32(pixels.clone()),
                color_space: DeclaredColorSpace::Linear,
                remarks: PictureRemarks::default(),
            });
            let levels = MipChain::new(picture.clone(), PixelReading::of(PixelCurve::Linear, true)).down_to(1);
            let second = if size[0] == 4 { (1, 0) } else { (0, 1) };
            assert_eq!(levels.pixel(1, 0, 0), [1.0, 0.0, 0.0, 0.5]);
            assert_eq!(levels.pixel(1, second.0, second.1), [0.5, 0.5, 1.0, 0.0]);
            assert_eq!(levels.pixel(2, 0, 0), last);
            // Each of the pixels averages three pixels, none of which has half of the area.
            let odd = Arc::new(Picture {
                width: 3,
                height: 1,
                channels: 4,
                pixels: Pixels::F32(pixels[..12].to_vec()),
                color_space: DeclaredColorSpace::Linear,
                remarks: PictureRemarks::default(),
            });
            let color = MipChain::new(odd, PixelReading::of(PixelCurve::Linear, true))
                .down_to(1)
                .pixel(1, 0, 0);
            assert_eq!(color[..3], [1.0, 0.0, 0.0]);
            // Colors are not weighted if alpha is an independent value.
            let plain = MipChain::new(picture, PLAIN).down_to(1);
            assert_eq!(plain.pixel(1, 0, 0), [0.5, 0.0, 0.0, 0.5]);
        }
    }

    #[test]
    fn a_declared_power_is_read_as_such_and_other_declared_curves_by_their_names() {
        let picture = |color_space: DeclaredColorSpace| {
            Arc::new(Picture {
                width: 1,
                height: 1,
                channels: 2,
                pixels: Pixels::U8(vec![51, 51]),
                color_space,
                remarks: PictureRemarks::default(),
            })
        };
        let declared = PixelReading::of(PixelCurve::Declared, false);
        let square = picture(DeclaredColorSpace::Power(2.0));
        assert_eq!(declared.named(&square), declared);
        let [red, _, _, alpha] = MipChain::new(square, declared).pixel(0, 0, 0);
        assert!((red - 0.04).abs() < 1e-6 && (alpha - 0.2).abs() < 1e-6, "{red} {alpha}");
        for (space, curve) in [
            (DeclaredColorSpace::Srgb, PixelCurve::Srgb),
            (DeclaredColorSpace::Unknown, PixelCurve::Srgb),
            (DeclaredColorSpace::Linear, PixelCurve::Linear),
        ] {
            assert_eq!(declared.named(&picture(space)).curve, curve, "{space:?}");
        }
        for (number, reading) in PixelReading::ALL.into_iter().enumerate() {
            assert_eq!(reading.number(), number);
        }
    }

    fn gray(size: [u32; 2], value: impl Fn(u32, u32) -> f32) -> Arc<Picture> {
        let samples = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        Arc::new(Picture {
            width: size[0],
            height: size[1],
            channels: 1,
            pixels: Pixels::F32(samples.map(|(x, y)| value(x, y)).collect()),
            color_space: DeclaredColorSpace::Linear,
            remarks: PictureRemarks::default(),
        })
    }

    #[test]
    fn every_level_has_the_mean_of_the_picture_whatever_its_size() {
        for size in [[64, 64], [37, 5], [1, 9], [3, 3], [1, 1]] {
            let picture = gray(size, |x, y| ((x * 7 + y * 13) % 11) as f32);
            let levels = MipChain::new(picture, PLAIN).down_to(1);
            let mean = |level: usize| {
                let [across, down] = levels.size(level).map(|side| side as usize);
                let all = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
                let sum: f64 = all.map(|(x, y)| f64::from(levels.pixel(level, x, y)[0])).sum();
                sum / (across * down) as f64
            };
            assert_eq!(levels.size(levels.last()), [1, 1]);
            for level in 1..=levels.last() {
                // Rounding of single precision, over a few levels.
                assert!((mean(level) - mean(0)).abs() < 1e-5, "level {level} of {size:?}");
            }
        }
    }

    #[test]
    fn what_is_no_number_counts_as_nothing() {
        let levels = MipChain::new(gray([2, 1], |x, _| if x == 0 { f32::NAN } else { 4.0 }), PLAIN).down_to(1);
        assert_eq!(levels.pixel(1, 0, 0)[0], 2.0);
    }

    #[test]
    fn levels_of_even_sizes_are_the_averages_of_any_other_size() {
        let value = |x: u32, y: u32| ((x * 7 + y * 13) % 31) as f32 / 31.0;
        let chain = MipChain::new(gray([8, 4], value), PLAIN);
        let fast = chain.half();
        let slow = chain.half_of_any_size(0, [4, 2]);
        assert_eq!((fast.size, fast.pixels), (slow.size, slow.pixels));
    }

    #[test]
    fn a_chain_ends_where_its_user_wants_it_and_shares_the_levels() {
        let mut all = MipChain::new(gray([16, 8], |x, _| x as f32), PLAIN);
        let [small, large] = [4, 8].map(|least| all.down_to(least));
        assert_eq!([small.last(), large.last(), all.last()], [2, 1, 2]);
        assert!(Arc::ptr_eq(&small.smaller[0], &large.smaller[0]));
    }
}
