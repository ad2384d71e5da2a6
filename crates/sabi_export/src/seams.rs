//! Seams of an exported map: what a renderer reads on both sides of each, made alike.
//!
//! A renderer interpolates between the texels of one chart, and two grids of texels can agree along an edge only as well
//! as straight lines follow the surface between them. Least squares over the texels beside seams take away what is left
//! (after Liu, Ferguson, Jacobson and Gingold 2017, "Seamless: Seam erasure and seam-aware decoupling of shape from mesh
//! resolution"): the integral along all seams of the squared difference of both sides, and a little of the squared change
//! of every texel. All other texels keep their bits.

mod erase;
mod solve;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use sabi_surface::atlas::Atlas;
use sabi_surface::model::Mesh;
use sabi_surface::seams::Seam;

use crate::layout::SetLayout;

/// Samples for a texel along a seam: more than one, so that all texels beside it count.
const SAMPLES_A_TEXEL: f64 = 3.0;
/// Most samples that long seams get; where all seams together are longer, samples lie further apart.
const MOST_SAMPLES: f64 = (1 << 21) as f64;

/// Places where a renderer reads a texture set on both sides of its seams.
///
/// Seams inside the set only: between two sets, each keeps its own side. Places where one side reads a texel that is not
/// its chart's count as no seam: under overlapping charts, and beyond the border of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamSamples {
    /// The set's pixels beside seams, rising.
    pixels: Vec<u32>,
    samples: Vec<Sample>,
    seams: Vec<Seam>,
}

/// A point of a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sample {
    sides: [Reading; 2],
    /// Length of seam that the sample represents, in texels of the finer side.
    length: f32,
    /// An index into the seams.
    seam: u32,
    /// Share of the way from its start to its end.
    along: f32,
}

/// A bilinear reading.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reading {
    /// The four texels, row by row: pixels of the set, and then indices into those beside seams.
    texels: [u32; 4],
    /// Shares of the right column and of the lower row.
    shares: [f32; 2],
}

impl Reading {
    /// Weights of the four texels; their sum is 1.
    fn weights(&self) -> [f64; 4] {
        let [right, low] = self.shares.map(f64::from);
        let (left, high) = (1.0 - right, 1.0 - low);
        [left * high, right * high, left * low, right * low]
    }
}

impl SeamSamples {
    /// The seams of a set: its layout with the atlas it comes from, and [`sabi_surface::seams::seams`] of the mesh.
    pub fn new(mesh: &Mesh, seams: &[Seam], atlas: &Atlas, layout: &SetLayout) -> SeamSamples {
        let ground = Ground { mesh, atlas, layout };
        let total: f64 = seams
            .par_iter()
            .map(|seam| ground.length(seam))
            .collect::<Vec<_>>()
            .iter()
            .sum();
        let spacing = (1.0 / SAMPLES_A_TEXEL).max(total / MOST_SAMPLES);
        let of_seam = |(index, seam): (usize, &Seam)| ground.samples(index as u32, *seam, spacing);
        let mut samples: Vec<Sample> = seams.par_iter().enumerate().flat_map_iter(of_seam).collect();
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
                // All of them are among the pixels.
                side.texels = side
                    .texels
                    .map(|pixel| pixels.partition_point(|&other| other < pixel) as u32);
            });
        SeamSamples {
            pixels,
            samples,
            seams: seams.to_vec(),
        }
    }

    /// Whether the set has no seam at all.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }
}

/// Mesh, atlas and layout in which samples are looked up.
struct Ground<'a> {
    mesh: &'a Mesh,
    atlas: &'a Atlas,
    layout: &'a SetLayout,
}

impl Ground<'_> {
    /// The ends of a seam as one of its triangles has them, in pixels of the map before it wraps.
    fn ends(&self, seam: &Seam, side: usize) -> [[f64; 2]; 2] {
        let size = f64::from(self.layout.size);
        let uv = |vertex: usize| self.mesh.uvs[vertex].map(|value| f64::from(value) * size);
        seam.vertices(self.mesh, side).map(uv)
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
            (to[0] - from[0]).hypot(to[1] - from[1])
        };
        let length = of_side(0).max(of_side(1));
        if length.is_finite() { length } else { 0.0 }
    }

    fn samples(&self, index: u32, seam: Seam, spacing: f64) -> impl Iterator<Item = Sample> {
        let length = self.length(&seam);
        let count = if length > 0.0 {
            (length / spacing).ceil().max(1.0) as u32
        } else {
            0
        };
        let ends = [0, 1].map(|side| self.ends(&seam, side));
        (0..count).filter_map(move |at| {
            let along = (f64::from(at) + 0.5) / f64::from(count);
            let read = |side: usize| self.reading(seam.triangles[side], ends[side], along);
            Some(Sample {
                sides: [read(0)?, read(1)?],
                length: (length / f64::from(count)) as f32,
                seam: index,
                along: along as f32,
            })
        })
    }

    /// Returns the bilinear reading at a share of the length of an edge; `None` unless all four texels are the chart's own.
    fn reading(&self, triangle: u32, [from, to]: [[f64; 2]; 2], along: f64) -> Option<Reading> {
        let point = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * along - 0.5);
        let corner = point.map(f64::floor);
        let mut texels = [0; 4];
        for (tap, texel) in texels.iter_mut().enumerate() {
            let place = [
                corner[0] as i64 + (tap & 1) as i64,
                corner[1] as i64 + (tap >> 1) as i64,
            ];
            *texel = self.pixel(triangle, place)?;
        }
        let shares = [0, 1].map(|axis| (point[axis] - corner[axis]) as f32);
        Some(Reading { texels, shares })
    }

    /// The pixel that shows a texel of a triangle's chart, if one does.
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
