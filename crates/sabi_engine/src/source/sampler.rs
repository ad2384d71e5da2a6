//! Reads a model's picture at texture coordinates.

use sabi_image::{Picture, Pixels, linear_from_srgb};
use sabi_surface::model::{TextureRef, Wrap};

/// Taps along one side of a texel's footprint, at most.
const TAPS_LIMIT: u32 = 8;

/// What of a picture a texel of the atlas covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Footprint {
    /// Texture coordinates under the texel's center.
    pub(crate) uv: [f64; 2],
    /// How they change over one texel along the atlas' u, and along its v.
    pub(crate) steps: [[f64; 2]; 2],
}

/// A picture with its wrap and its transform.
pub(crate) struct Sampler {
    picture: Picture,
    /// Linear values of 8-bit codes.
    code_table: Option<[f32; 256]>,
    is_srgb: bool,
    wrap: [Wrap; 2],
    transform: [[f64; 3]; 2],
}

impl Sampler {
    /// A picture as a material uses it.
    pub(crate) fn new(picture: Picture, texture: &TextureRef, is_srgb: bool) -> Sampler {
        let linear = |code: usize| {
            let value = code as f32 / 255.0;
            if is_srgb { linear_from_srgb(value) } else { value }
        };
        let code_table = matches!(picture.pixels, Pixels::U8(_)).then(|| std::array::from_fn(linear));
        Sampler {
            code_table,
            is_srgb,
            wrap: texture.wrap,
            transform: texture.transform.map(|row| row.map(f64::from)),
            picture,
        }
    }

    /// Linear RGBA at the texture coordinates of its set, averaged over a texel of the atlas.
    pub(crate) fn sample(&self, at: &Footprint) -> [f32; 4] {
        let mut sum = [0.0_f32; 4];
        let taps = self.taps(at);
        for tap in 0..taps * taps {
            let offset = |index: u32| (f64::from(index) + 0.5) / f64::from(taps) - 0.5;
            let (x, y) = (offset(tap % taps), offset(tap / taps));
            let uv = std::array::from_fn(|axis| at.uv[axis] + at.steps[0][axis] * x + at.steps[1][axis] * y);
            let value = self.bilinear(uv);
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += value;
            }
        }
        let count = (taps * taps) as f32;
        sum.map(|sum| sum / count)
    }

    /// Taps a side: as many pixels of the picture as a texel covers.
    fn taps(&self, at: &Footprint) -> u32 {
        let side = |step: [f64; 2]| {
            let [u, v] = [self.picture.width, self.picture.height].map(f64::from);
            (step[0] * u).hypot(step[1] * v)
        };
        let larger = side(at.steps[0]).max(side(at.steps[1]));
        // A hair less than the next pixel is not one more.
        ((larger - 1e-6).ceil().max(1.0) as u32).min(TAPS_LIMIT)
    }

    fn bilinear(&self, [u, v]: [f64; 2]) -> [f32; 4] {
        let [u, v] = self.transform.map(|row| row[0] * u + row[1] * v + row[2]);
        let x = u * f64::from(self.picture.width) - 0.5;
        let y = v * f64::from(self.picture.height) - 0.5;
        let (column, row) = (x.floor(), y.floor());
        // A texel whose center is a pixel's center must give that pixel exactly, whatever the last bits say.
        let weight = |fraction: f64| {
            if !(1e-5..=1.0 - 1e-5).contains(&fraction) {
                fraction.round()
            } else {
                fraction
            }
        };
        let (wx, wy) = (weight(x - column) as f32, weight(y - row) as f32);
        let tap = |dx: i64, dy: i64| self.pixel(column as i64 + dx, row as i64 + dy);
        let mix = |a: [f32; 4], b: [f32; 4], t: f32| std::array::from_fn(|at| a[at] + (b[at] - a[at]) * t);
        let upper = if wx == 0.0 {
            tap(0, 0)
        } else {
            mix(tap(0, 0), tap(1, 0), wx)
        };
        if wy == 0.0 {
            return upper;
        }
        let lower = if wx == 0.0 {
            tap(0, 1)
        } else {
            mix(tap(0, 1), tap(1, 1), wx)
        };
        mix(upper, lower, wy)
    }

    fn pixel(&self, column: i64, row: i64) -> [f32; 4] {
        let x = wrapped(column, self.picture.width, self.wrap[0]);
        let y = wrapped(row, self.picture.height, self.wrap[1]);
        let channels = usize::from(self.picture.channels);
        let start = (y * self.picture.width as usize + x) * channels;
        let raw = |at: usize| self.value(start + at, at);
        match channels {
            1 => [raw(0), raw(0), raw(0), 1.0],
            2 => [raw(0), raw(0), raw(0), raw(1)],
            3 => [raw(0), raw(1), raw(2), 1.0],
            _ => [raw(0), raw(1), raw(2), raw(3)],
        }
    }

    /// One sample, linear; the last of two or four is alpha, which is never encoded.
    fn value(&self, index: usize, channel: usize) -> f32 {
        let is_alpha = matches!((self.picture.channels, channel), (2, 1) | (4, 3));
        let decode = |value: f32| {
            if self.is_srgb && !is_alpha {
                linear_from_srgb(value)
            } else {
                value
            }
        };
        match &self.picture.pixels {
            Pixels::U8(codes) => match &self.code_table {
                Some(table) if !is_alpha => table[usize::from(codes[index])],
                _ => f32::from(codes[index]) / 255.0,
            },
            Pixels::U16(codes) => decode(f32::from(codes[index]) / 65_535.0),
            Pixels::F32(values) => values[index],
        }
    }
}

fn wrapped(index: i64, size: u32, wrap: Wrap) -> usize {
    let size = i64::from(size);
    let inside = match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let folded = index.rem_euclid(2 * size);
            if folded < size { folded } else { 2 * size - 1 - folded }
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::{Wrap, wrapped};

    #[test]
    fn each_wrap_repeats_as_its_name_says() {
        let row = |wrap| (-2..5).map(|index| wrapped(index, 3, wrap)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 1, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [1, 0, 0, 1, 2, 2, 1]);
    }
}
