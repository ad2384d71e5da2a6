//! Heights and normals beside seams.

use sabi_surface::model::Mesh;

use super::solve::{Compared, System};
use super::{Reading, Sample, SeamSamples};
use crate::ChannelPixels;

type Vec3 = [f64; 3];

/// Cosine of the angle between the shading normals of both sides from which on an edge is smooth: 2.6°. A hard edge is to
/// be seen.
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
                // A texel without a change keeps its bits, also those of −0.
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
                let changed: Vec3 = std::array::from_fn(|at| f64::from(normal[at]) + change[at]);
                let length = length(changed);
                // As above: not even its length changes.
                if change != [0.0; 3] && length.is_finite() && length > 0.0 {
                    normal.copy_from_slice(&changed.map(|value| (value / length) as f32));
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
    fn heights(&self, pixels: &ChannelPixels) -> Option<System<'_, 1, 1>> {
        if !self.holds(pixels, 1) {
            return None;
        }
        let compare = |sample: &Sample| {
            let [[one], [other]] = sample.sides.map(|side| self.read::<1>(&side, pixels));
            ([[[1.0]]; 2], [one - other])
        };
        Some(self.system(compare))
    }

    fn normals(&self, mesh: &Mesh, pixels: &ChannelPixels) -> Option<System<'_, 3, 2>> {
        if !self.holds(pixels, 3) {
            return None;
        }
        let compare = |sample: &Sample| {
            let frames = [0, 1].map(|side| self.frame(mesh, sample, side));
            let read = sample.sides.map(|side| self.read::<3>(&side, pixels));
            // A hard edge compares nothing: rows of zeros have no effect.
            compared_normals(frames, read).unwrap_or(([[[0.0; 3]; 2]; 2], [0.0; 2]))
        };
        Some(self.system(compare))
    }

    fn holds(&self, pixels: &ChannelPixels, components: usize) -> bool {
        let last = self.pixels.last().map(|&pixel| (pixel as usize + 1) * components);
        pixels.components == components && last.is_some_and(|end| end <= pixels.data.len())
    }

    /// The system of all samples; what is compared of one without a number is left out.
    fn system<const N: usize, const K: usize>(&self, compare: impl Fn(&Sample) -> Compared<N, K>) -> System<'_, N, K> {
        let mut system = System {
            samples: &self.samples,
            texels: self.pixels.len(),
            rows: Vec::with_capacity(self.samples.len()),
            differences: Vec::with_capacity(self.samples.len()),
        };
        for sample in &self.samples {
            let (rows, differences) = compare(sample);
            let sound = differences.iter().all(|x| x.is_finite())
                && rows.as_flattened().as_flattened().iter().all(|x| x.is_finite());
            system.rows.push(if sound { rows } else { [[[0.0; N]; K]; 2] });
            system.differences.push(if sound { differences } else { [0.0; K] });
        }
        system
    }

    /// Returns the interpolated value; computed relative to the first texel, so that constants keep their bits.
    fn read<const N: usize>(&self, reading: &Reading, pixels: &ChannelPixels) -> [f64; N] {
        let texel = |index: u32| -> [f64; N] {
            let first = N * self.pixels[index as usize] as usize;
            std::array::from_fn(|at| f64::from(pixels.data[first + at]))
        };
        let nearest = texel(reading.texels[0]);
        let mut read = nearest;
        for (weight, index) in reading.weights().into_iter().zip(reading.texels) {
            let values = texel(index);
            for at in 0..N {
                read[at] += weight * (values[at] - nearest[at]);
            }
        }
        read
    }

    /// Tangent, bitangent and normal of one side, interpolated without normalizing, as renderers decode with them.
    fn frame(&self, mesh: &Mesh, sample: &Sample, side: usize) -> [Vec3; 3] {
        let [from, to] = self.seams[sample.seam as usize].vertices(mesh, side);
        let along = f64::from(sample.along);
        let between = |from: f32, to: f32| (1.0 - along) * f64::from(from) + along * f64::from(to);
        let normal: Vec3 = std::array::from_fn(|at| between(mesh.normals[from][at], mesh.normals[to][at]));
        let tangent: Vec3 = std::array::from_fn(|at| between(mesh.tangents[from][at], mesh.tangents[to][at]));
        let sign = f64::from(mesh.tangents[from][3]);
        [tangent, cross(normal, tangent).map(|x| sign * x), normal]
    }
}

/// Returns the difference of the decoded normals of two sides, perpendicular to their direction, and its derivative by the
/// values read; `None` over a hard edge. The difference of the faces' own normals is subtracted.
fn compared_normals(frames: [[Vec3; 3]; 2], read: [Vec3; 2]) -> Option<Compared<3, 2>> {
    let decode = |side: usize| -> Vec3 {
        let (frame, read) = (frames[side], read[side]);
        std::array::from_fn(|at| (0..3).map(|of| frame[of][at] * read[of]).sum())
    };
    let decoded = [decode(0), decode(1)];
    let faces = [unit(frames[0][2])?, unit(frames[1][2])?];
    let directions = [unit(decoded[0])?, unit(decoded[1])?];
    if dot(faces[0], faces[1]) < SMOOTH {
        return None;
    }
    let across = plane_of(std::array::from_fn(|at| directions[0][at] + directions[1][at]))?;
    let mut rows = [[[0.0; 3]; 2]; 2];
    let mut differences = [0.0; 2];
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        let direction = directions[side];
        for (at, axis) in across.into_iter().enumerate() {
            differences[at] += sign * (dot(axis, direction) - dot(axis, faces[side]));
            // A decoded vector is normalized, so what lengthens it changes nothing.
            let turned: Vec3 = std::array::from_fn(|at| axis[at] - direction[at] * dot(direction, axis));
            let size = length(decoded[side]);
            rows[side][at] = frames[side].map(|own| (dot(turned, own) / size) as f32);
        }
    }
    Some((rows, differences))
}

/// Two unit vectors across a third vector and each other.
fn plane_of(normal: Vec3) -> Option<[Vec3; 2]> {
    let normal = unit(normal)?;
    let smallest = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()))?;
    let mut axis = [0.0; 3];
    axis[smallest] = 1.0;
    let first = unit(cross(normal, axis))?;
    Some([first, cross(normal, first)])
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn length(v: Vec3) -> f64 {
    dot(v, v).sqrt()
}

fn unit(v: Vec3) -> Option<Vec3> {
    let length = length(v);
    (length > 1e-12 && length.is_finite()).then(|| v.map(|x| x / length))
}
