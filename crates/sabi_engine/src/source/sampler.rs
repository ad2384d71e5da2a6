//! Sampler of a picture, averaged over the footprint of a texel.

use sabi_surface::model::Wrap;

use super::mip_chain::MipChain;

/// Maximum taps along one side of a footprint.
const TAPS_LIMIT: f64 = 16.0;

/// Mip chain with its wrap mode.
#[derive(Clone)]
pub(crate) struct Sampler {
    levels: MipChain,
    wrap: [Wrap; 2],
}

/// Area of a picture that a texel of the atlas covers, in texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Footprint {
    /// Texture coordinates of the texel's center.
    pub(crate) uv: [f64; 2],
    /// Change of the coordinates over one texel along the u and the v of the atlas.
    pub(crate) steps: [[f64; 2]; 2],
}

impl Footprint {
    /// Applies the transform of a texture, given by rows.
    pub(crate) fn through(&self, transform: &[[f64; 3]; 2]) -> Footprint {
        let step = |[u, v]: [f64; 2]| transform.map(|row| row[0] * u + row[1] * v);
        let start = step(self.uv);
        Footprint {
            uv: [start[0] + transform[0][2], start[1] + transform[1][2]],
            steps: self.steps.map(step),
        }
    }

    /// Returns the lengths of the steps in pixels of a picture.
    fn steps_px(&self, size: [u32; 2]) -> [f64; 2] {
        self.steps
            .map(|[u, v]| (u * f64::from(size[0])).hypot(v * f64::from(size[1])))
    }
}

impl Sampler {
    pub(crate) fn new(levels: MipChain, wrap: [Wrap; 2]) -> Sampler {
        Sampler { levels, wrap }
    }

    /// Averages linear RGBA over a footprint: taps on a grid, at the level whose pixels are at most half as large as the shorter
    /// side of the footprint; bilinear where the picture is magnified.
    pub(crate) fn sample(&self, footprint: &Footprint) -> [f32; 4] {
        let sides = footprint.steps_px(self.levels.size(0));
        let (short, long) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
        let finest = (short / 2.0).max(long / TAPS_LIMIT).max(1.0);
        // Rounding must not turn a footprint of two pixels into a finer level.
        let level = ((finest + 1e-9).log2().floor() as usize).min(self.levels.last());
        let pixel = (1_u64 << level.min(63)) as f64;
        let taps = sides.map(|side| ((side / pixel - 1e-6).ceil()).clamp(1.0, TAPS_LIMIT) as u32);
        let mut sum = [0.0_f32; 4];
        for tap in 0..taps[0] * taps[1] {
            let share = |index: u32, of: u32| (f64::from(index) + 0.5) / f64::from(of) - 0.5;
            let [along, across] = [share(tap % taps[0], taps[0]), share(tap / taps[0], taps[1])];
            let at = std::array::from_fn(|axis| {
                footprint.uv[axis] + along * footprint.steps[0][axis] + across * footprint.steps[1][axis]
            });
            let value = self.bilinear(level, at);
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += value;
            }
        }
        let count = (taps[0] * taps[1]) as f32;
        sum.map(|sum| sum / count)
    }

    fn bilinear(&self, level: usize, [u, v]: [f64; 2]) -> [f32; 4] {
        let [across, down] = self.levels.size(level);
        let x = u * f64::from(across) - 0.5;
        let y = v * f64::from(down) - 0.5;
        let (column, row) = (x.floor(), y.floor());
        // A texel at the center of a pixel must give that pixel exactly, despite rounding.
        let weight = |fraction: f64| {
            if !(1e-5..=1.0 - 1e-5).contains(&fraction) {
                fraction.round()
            } else {
                fraction
            }
        };
        let (wx, wy) = (weight(x - column) as f32, weight(y - row) as f32);
        let tap = |dx: i64, dy: i64| {
            let x = wrapped((column as i64).saturating_add(dx), across, self.wrap[0]);
            let y = wrapped((row as i64).saturating_add(dy), down, self.wrap[1]);
            self.levels.pixel(level, x, y)
        };
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
    use std::sync::Arc;

    use sabi_image::{Declared, Picture, Pixels};

    use super::*;

    #[test]
    fn each_wrap_repeats_as_its_name_says() {
        let row = |wrap| (-2..5).map(|index| wrapped(index, 3, wrap)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 1, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [1, 0, 0, 1, 2, 2, 1]);
    }

    /// Cells of light and dark, finer and finer towards one corner: what aliases when it is read too thinly.
    fn cells(size: u32) -> Vec<u8> {
        let code = |x: u32, y: u32| {
            let wave = (f64::from(x * x) / f64::from(size) * 1.3).sin() * (f64::from(y * y) / f64::from(size)).cos();
            if wave > 0.2 { 230 } else { 20 }
        };
        (0..size * size).map(|at| code(at % size, at / size)).collect()
    }

    fn sampler(size: u32, codes: Vec<u8>) -> Sampler {
        let picture = Picture {
            width: size,
            height: size,
            channels: 1,
            pixels: Pixels::U8(codes),
            color_space: Declared::Unknown,
        };
        Sampler::new(MipChain::new(Arc::new(picture), false).down_to(1), [Wrap::Repeat; 2])
    }

    /// Root of the mean square between what is read and the mean over each texel's own pixels.
    fn error(picture: u32, texels: u32) -> f64 {
        let codes = cells(picture);
        let sampler = sampler(picture, codes.clone());
        let side = f64::from(picture) / f64::from(texels);
        let mean = |x: u32, y: u32| {
            let [mut sum, mut weights] = [0.0; 2];
            let share = |at: u32, pixel: u32| {
                let [low, high] = [f64::from(at) * side, f64::from(at + 1) * side];
                (f64::from(pixel + 1).min(high) - f64::from(pixel).max(low)).max(0.0)
            };
            let span = |at: u32| (f64::from(at) * side) as u32..((f64::from(at + 1) * side).ceil() as u32).min(picture);
            for row in span(y) {
                for column in span(x) {
                    let weight = share(x, column) * share(y, row);
                    sum += weight * f64::from(codes[(row * picture + column) as usize]) / 255.0;
                    weights += weight;
                }
            }
            sum / weights
        };
        let texel = 1.0 / f64::from(texels);
        let mut squares = 0.0;
        for at in 0..texels * texels {
            let (x, y) = (at % texels, at / texels);
            let footprint = Footprint {
                uv: [(f64::from(x) + 0.5) * texel, (f64::from(y) + 0.5) * texel],
                steps: [[texel, 0.0], [0.0, texel]],
            };
            squares += (f64::from(sampler.sample(&footprint)[0]) - mean(x, y)).powi(2);
        }
        (squares / f64::from(texels * texels)).sqrt()
    }

    #[test]
    fn a_texel_holds_the_mean_of_what_it_covers() {
        // Where a texel covers a power of two, its pixels are averaged exactly, up to rounding of single precision; else
        // taps blur by a part of a pixel.
        for (picture, texels, most) in [(1024, 128, 1e-6), (512, 512, 1e-6), (512, 64, 1e-6), (600, 100, 0.02)] {
            let error = error(picture, texels);
            assert!(error < most, "{picture} to {texels}: {error}");
        }
    }

    #[test]
    fn a_slanted_footprint_is_read_along_both_its_sides() {
        // Stripes of one pixel: any footprint of several pixels across them is gray.
        let stripes = (0..64 * 64).map(|at| if at % 2 == 0 { 255 } else { 0 }).collect();
        let sampler = sampler(64, stripes);
        for (sides, what) in [
            ([[0.25, 0.0], [0.0, 1.0 / 64.0]], "long across"),
            ([[0.0, 1.0 / 64.0], [0.25, 0.0]], "the same, named the other way"),
            ([[0.1, 0.1], [-0.1, 0.1]], "slanted"),
        ] {
            let uv = [0.431, 0.377];
            let value = sampler.sample(&Footprint { uv, steps: sides })[0];
            // A footprint that does not cover a whole number of stripes is off by less than one stripe of its length.
            assert!((value - 0.5).abs() < 0.07, "{what}: {value}");
        }
    }
}
