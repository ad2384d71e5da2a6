//! Seam erasure: a renderer reads the same values on both sides of a seam of an exported map.
//!
//! A renderer interpolates between the texels of one chart, and the texel grids of two charts agree along an edge only up to
//! interpolation error. The texels beside seams are changed by least squares (after Liu, Ferguson, Jacobson and Gingold
//! 2017, "Seamless: Seam erasure and seam-aware decoupling of shape from mesh resolution"): minimized is the integral along
//! all seams of the squared difference of both sides, plus a small weight on the squared change of every texel. All other
//! texels keep their bits.

mod erase;
mod footprint_places;
mod solve;
#[cfg(test)]
mod tests;

use glam::DVec2;
use rayon::prelude::*;
use sabi_surface::atlas::Atlas;
use sabi_surface::model::Mesh;
use sabi_surface::seams::Seam;

use self::footprint_places::FootprintPlaces;
use crate::layout::SetLayout;

/// Number of samples for each texel along a seam. It is more than one, so that all texels beside the seam are sampled.
const SAMPLES_A_TEXEL: f64 = 3.0;
/// Approximate maximum number of samples of all seams together. If the seams are longer, the samples are farther apart.
const MOST_SAMPLES: f64 = (1 << 21) as f64;

/// Samples of a texture set along its seams, with the texels that a renderer reads on both sides.
///
/// Only seams within the set are sampled. A point is left out if either side reads a texel that does not belong to its
/// chart, because charts overlap, or beyond the border of the image.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamSamples {
    /// The set's pixels beside seams, ascending.
    pixels: Vec<u32>,
    samples: Vec<SeamSample>,
    /// Samples of each pixel.
    readers: FootprintPlaces,
    seams: Vec<Seam>,
}

/// Sample of a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SeamSample {
    sides: [Footprint; 2],
    /// Length of seam that the sample represents, in texels of the finer side.
    length: f32,
    /// An index into the seams.
    seam: u32,
    /// Position along the seam, 0 at its start and 1 at its end.
    fraction: f32,
}

/// Footprint of a bilinear lookup.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Footprint {
    /// The four texels, row by row: indices into [`SeamSamples::pixels`], and pixels of the set until those are known.
    texels: [u32; 4],
    /// Weights of the right column and of the lower row.
    fractions: [f32; 2],
}

impl Footprint {
    /// Weights of the four texels; their sum is 1.
    fn weights(&self) -> [f64; 4] {
        let [right, low] = self.fractions.map(f64::from);
        let (left, high) = (1.0 - right, 1.0 - low);
        [left * high, right * high, left * low, right * low]
    }
}

impl SeamSamples {
    /// Samples the seams of a set. `seams` are those of the mesh ([`sabi_surface::seams::seams`]), and `layout` is made of
    /// `atlas`.
    pub fn new(mesh: &Mesh, seams: &[Seam], atlas: &Atlas, layout: &SetLayout) -> SeamSamples {
        let sampler = SeamSampler { mesh, atlas, layout };
        let total: f64 = seams
            .par_iter()
            .map(|seam| sampler.length(seam))
            .collect::<Vec<_>>()
            .iter()
            .sum();
        let spacing = (1.0 / SAMPLES_A_TEXEL).max(total / MOST_SAMPLES);
        let of_seam = |(index, seam): (usize, &Seam)| sampler.samples(index as u32, *seam, spacing);
        let mut samples: Vec<SeamSample> = seams.par_iter().enumerate().flat_map_iter(of_seam).collect();
        let read = samples
            .iter()
            .flat_map(|sample| sample.sides)
            .flat_map(|side| side.texels);
        let mut pixels: Vec<u32> = read.collect();
        pixels.par_sort_unstable();
        pixels.dedup();
        samples
            .par_iter_mut()
            .flat_map_iter(|sample| &mut sample.sides)
            .for_each(|side| {
                // All of these texels are in the list of pixels.
                side.texels = side
                    .texels
                    .map(|pixel| pixels.partition_point(|&other| other < pixel) as u32);
            });
        SeamSamples {
            readers: FootprintPlaces::new(&samples, pixels.len()),
            pixels,
            samples,
            seams: seams.to_vec(),
        }
    }

    /// Returns true if the set has no seams.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }
}

/// Inputs of sampling.
struct SeamSampler<'a> {
    mesh: &'a Mesh,
    atlas: &'a Atlas,
    layout: &'a SetLayout,
}

impl SeamSampler<'_> {
    /// Returns the ends of a seam on one side, in pixels of the map before wrapping.
    fn ends(&self, seam: &Seam, side: usize) -> [DVec2; 2] {
        let size = f64::from(self.layout.size);
        let place = |vertex: usize| DVec2::from(self.mesh.uvs[vertex].map(f64::from)) * size;
        seam.vertices(self.mesh, side).map(place)
    }

    /// Returns the length of a seam in texels of the finer side; 0 where the set does not have both sides.
    fn length(&self, seam: &Seam) -> f64 {
        let chart = |triangle: u32| &self.atlas.charts[self.atlas.triangle_chart[triangle as usize] as usize];
        let is_here =
            |triangle: &u32| chart(*triangle).sheet == self.layout.key.material && chart(*triangle).texels > 0;
        if !seam.triangles.iter().all(is_here) {
            return 0.0;
        }
        let of_side = |side: usize| {
            let [from, to] = self.ends(seam, side);
            (to.x - from.x).hypot(to.y - from.y)
        };
        let length = of_side(0).max(of_side(1));
        if length.is_finite() { length } else { 0.0 }
    }

    fn samples(&self, index: u32, seam: Seam, spacing: f64) -> impl Iterator<Item = SeamSample> {
        let length = self.length(&seam);
        let count = if length > 0.0 {
            (length / spacing).ceil().max(1.0) as u32
        } else {
            0
        };
        let ends = [0, 1].map(|side| self.ends(&seam, side));
        (0..count).filter_map(move |at| {
            let fraction = (f64::from(at) + 0.5) / f64::from(count);
            let read = |side: usize| self.footprint(seam.triangles[side], ends[side], fraction);
            Some(SeamSample {
                sides: [read(0)?, read(1)?],
                length: (length / f64::from(count)) as f32,
                seam: index,
                fraction: fraction as f32,
            })
        })
    }

    /// Returns the footprint at a fraction of an edge; `None` unless all four texels are the chart's own.
    fn footprint(&self, triangle: u32, [from, to]: [DVec2; 2], fraction: f64) -> Option<Footprint> {
        let point = from + (to - from) * fraction - 0.5;
        let corner = point.floor();
        let [x, y] = corner.as_i64vec2().to_array();
        let mut texels = [0; 4];
        for (tap, texel) in texels.iter_mut().enumerate() {
            *texel = self.pixel(triangle, [x + (tap & 1) as i64, y + (tap >> 1) as i64])?;
        }
        let fractions = (point - corner).as_vec2().to_array();
        Some(Footprint { texels, fractions })
    }

    /// Returns the pixel of a texel of a triangle's chart; `None` where the pixel shows another texel.
    fn pixel(&self, triangle: u32, place: [i64; 2]) -> Option<u32> {
        let chart = &self.atlas.charts[self.atlas.triangle_chart[triangle as usize] as usize];
        let page = [0, 1].map(|axis| place[axis] + i64::from(chart.texel_from_uv[axis]));
        let [width, height] = self.atlas.page_size.map(i64::from);
        if page[0] < 0 || page[1] < 0 || page[0] >= width || page[1] >= height {
            return None;
        }
        let texel = (i64::from(chart.page) * height + page[1]) * width + page[0];
        let size = i64::from(self.layout.size);
        let [x, y] = place.map(|value| value.rem_euclid(size));
        let pixel = y * size + x;
        let shown = *self.layout.source.get(pixel as usize)?;
        (i64::from(shown) == texel).then_some(pixel as u32)
    }
}
