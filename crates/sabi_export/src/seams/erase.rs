//! Heights and normals beside seams.

use glam::{DMat3, DVec3, DVec4};
use rayon::prelude::*;
use sabi_surface::model::Mesh;

use super::solve::{ComparedRows, SeamSystem};
use super::{Footprint, SeamSample, SeamSamples};
use crate::ChannelPixels;

/// Least cosine of the angle between the shading normals of both sides of a smooth edge: 2.6°. Hard edges stay visible.
const SMOOTH: f64 = 0.999;

impl SeamSamples {
    /// Equalizes heights on both sides of all seams. Padding is not touched; see [`crate::PaddingMap::pad`].
    ///
    /// Pixels of [`crate::Channel::Height`], laid out as the set is; others stay as they are.
    pub fn erase_heights(&self, pixels: &mut ChannelPixels) {
        if let Some(system) = self.heights(pixels) {
            let changes = system.changes();
            let before = self.pixels.iter().map(|&pixel| pixels.data[pixel as usize]);
            let (low, high) = before
                .filter(|height| height.is_finite())
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), height| {
                    (low.min(height), high.max(height))
                });
            for (&pixel, [change]) in self.pixels.iter().zip(changes) {
                let height = &mut pixels.data[pixel as usize];
                let changed = (f64::from(*height) + change) as f32;
                // A texel that is not changed keeps its bits, also those of −0.
                if change != 0.0 && changed.is_finite() {
                    *height = changed.max(low).min(high);
                }
            }
        }
    }

    /// Equalizes normals, in space, on both sides of the seams over which the model is smooth, as a renderer reads
    /// them: interpolated between texels, then decoded in the frame of its side. Padding is not touched.
    ///
    /// Pixels of [`crate::Channel::Normal`], unit vectors, laid out as the set is; others stay as they are. `mesh` is
    /// that of the seams.
    pub fn erase_normals(&self, mesh: &Mesh, pixels: &mut ChannelPixels) {
        if let Some(system) = self.normals(mesh, pixels) {
            let changes = system.changes();
            for (&pixel, change) in self.pixels.iter().zip(changes) {
                let first = 3 * pixel as usize;
                let normal = &mut pixels.data[first..first + 3];
                let stored: [f64; 3] = std::array::from_fn(|at| f64::from(normal[at]));
                let changed = DVec3::from(stored) + DVec3::from(change);
                let length = changed.length();
                // A texel that is not changed keeps its bits, even if its length is not exactly 1.
                if change != [0.0; 3] && length.is_finite() && length > 0.0 {
                    normal.copy_from_slice(&(changed / length).as_vec3().to_array());
                }
            }
        }
    }

    /// Returns the difference of heights between both sides: root mean square along all seams, in the heights' unit.
    pub fn height_difference(&self, pixels: &ChannelPixels) -> f64 {
        self.heights(pixels).map_or(0.0, |system| system.mean_square().sqrt())
    }

    /// Returns the difference of normals over the smooth seams: the angle between them, radians, for small angles.
    pub fn normal_difference(&self, mesh: &Mesh, pixels: &ChannelPixels) -> f64 {
        self.normals(mesh, pixels)
            .map_or(0.0, |system| system.mean_square().sqrt())
    }

    /// None where there is nothing to erase: without seams, or of pixels that are no heights of the set.
    fn heights(&self, pixels: &ChannelPixels) -> Option<SeamSystem<'_, 1, 1>> {
        if !self.holds(pixels, 1) {
            return None;
        }
        let compare = |sample: &SeamSample| {
            let [[one], [other]] = sample.sides.map(|side| self.read::<1>(&side, pixels));
            ([[[1.0]]; 2], [one - other])
        };
        Some(self.system(compare))
    }

    fn normals(&self, mesh: &Mesh, pixels: &ChannelPixels) -> Option<SeamSystem<'_, 3, 2>> {
        if !self.holds(pixels, 3) {
            return None;
        }
        let compare = |sample: &SeamSample| {
            let frames = [0, 1].map(|side| self.frame(mesh, sample, side));
            let read = sample.sides.map(|side| DVec3::from(self.read::<3>(&side, pixels)));
            // Rows of zeros have no effect, so nothing is compared across a hard edge.
            compared_normals(frames, read).unwrap_or(([[[0.0; 3]; 2]; 2], [0.0; 2]))
        };
        Some(self.system(compare))
    }

    fn holds(&self, pixels: &ChannelPixels, components: usize) -> bool {
        let last = self.pixels.last().map(|&pixel| (pixel as usize + 1) * components);
        pixels.components == components && last.is_some_and(|end| end <= pixels.data.len())
    }

    /// Builds the system of all samples; those with values that are not finite have no effect.
    fn system<const N: usize, const K: usize>(
        &self,
        compare: impl Fn(&SeamSample) -> ComparedRows<N, K> + Sync,
    ) -> SeamSystem<'_, N, K> {
        let compared = self.samples.par_iter().map(|sample| {
            let (rows, differences) = compare(sample);
            let sound = differences.iter().all(|x| x.is_finite())
                && rows.as_flattened().as_flattened().iter().all(|x| x.is_finite());
            match sound {
                true => (rows, differences),
                false => ([[[0.0; N]; K]; 2], [0.0; K]),
            }
        });
        let (rows, differences) = compared.unzip();
        SeamSystem {
            samples: &self.samples,
            readers: &self.readers,
            rows,
            differences,
        }
    }

    /// Returns the interpolated value; computed relative to the first texel, so that constants keep their bits.
    fn read<const N: usize>(&self, footprint: &Footprint, pixels: &ChannelPixels) -> [f64; N] {
        let texel = |index: u32| -> [f64; N] {
            let first = N * self.pixels[index as usize] as usize;
            std::array::from_fn(|at| f64::from(pixels.data[first + at]))
        };
        let nearest = texel(footprint.texels[0]);
        let mut read = nearest;
        for (weight, index) in footprint.weights().into_iter().zip(footprint.texels) {
            let values = texel(index);
            for at in 0..N {
                read[at] += weight * (values[at] - nearest[at]);
            }
        }
        read
    }

    /// Tangent, bitangent and normal of one side, interpolated without normalizing, as renderers decode with them.
    fn frame(&self, mesh: &Mesh, sample: &SeamSample, side: usize) -> DMat3 {
        let [from, to] = self.seams[sample.seam as usize].vertices(mesh, side);
        let fraction = f64::from(sample.fraction);
        let between = |from: DVec3, to: DVec3| from * (1.0 - fraction) + to * fraction;
        let normal_of = |vertex: usize| DVec3::from(mesh.normals[vertex].map(f64::from));
        let tangent_of = |vertex: usize| DVec4::from(mesh.tangents[vertex].map(f64::from));
        let normal = between(normal_of(from), normal_of(to));
        let tangent = between(tangent_of(from).truncate(), tangent_of(to).truncate());
        DMat3::from_cols(tangent, normal.cross(tangent) * tangent_of(from).w, normal)
    }
}

/// Returns the difference of the decoded normals of two sides, perpendicular to their direction, and its derivative by the
/// values read; `None` over a hard edge. The difference of the faces' own normals is subtracted.
fn compared_normals(frames: [DMat3; 2], read: [DVec3; 2]) -> Option<ComparedRows<3, 2>> {
    let decoded = [frames[0] * read[0], frames[1] * read[1]];
    let faces = [unit(frames[0].z_axis)?, unit(frames[1].z_axis)?];
    let directions = [unit(decoded[0])?, unit(decoded[1])?];
    if faces[0].dot(faces[1]) < SMOOTH {
        return None;
    }
    let across = plane_of(directions[0] + directions[1])?;
    let mut rows = [[[0.0; 3]; 2]; 2];
    let mut differences = [0.0; 2];
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        let direction = directions[side];
        for (at, axis) in across.into_iter().enumerate() {
            differences[at] += sign * (axis.dot(direction) - axis.dot(faces[side]));
            // A decoded vector is normalized, so changes of its length have no effect.
            let turned = axis - direction * direction.dot(axis);
            let row = frames[side].transpose_mul_vec3(turned) / decoded[side].length();
            rows[side][at] = row.as_vec3().to_array();
        }
    }
    Some((rows, differences))
}

/// Two unit vectors across a third vector and each other.
fn plane_of(normal: DVec3) -> Option<[DVec3; 2]> {
    let normal = unit(normal)?;
    let axis = DVec3::AXES[normal.abs().min_position()];
    let first = unit(normal.cross(axis))?;
    Some([first, normal.cross(first)])
}

fn unit(v: DVec3) -> Option<DVec3> {
    let length = v.length();
    (length > 1e-12 && length.is_finite()).then(|| v / length)
}
