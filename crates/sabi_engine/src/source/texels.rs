//! What a source sees of the surface, and how its values become the texels of a plane.

use std::sync::OnceLock;

use half::f16;
use rayon::prelude::*;
use sabi_gpu::{DeviceHierarchy, SurfaceTables};
use sabi_nodes::link::{Format, Plane};
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Model;
use sabi_surface::pieces::Pieces;

/// Texels that are filled in one go.
const CHUNK: usize = 4096;

/// The surface that sources are brought onto.
#[derive(Clone, Copy)]
pub(crate) struct SourceSurface<'a> {
    pub(crate) model: &'a Model,
    pub(crate) atlas: &'a Atlas,
    pub(crate) tables: &'a SurfaceTables,
    pub(crate) pieces: &'a Pieces,
    /// Built when the first ray is shot.
    pub(crate) bvh: &'a OnceLock<Bvh>,
    /// The same on the device, for a caster there.
    pub(crate) bvh_on_device: &'a OnceLock<DeviceHierarchy>,
    /// Factor from model units to working units.
    pub(crate) working_from_model: f64,
}

/// A point of the surface: its triangle, where it lies on its chart's page, and its texture coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub(crate) triangle: usize,
    pub(crate) texel: [f64; 2],
    pub(crate) uv: [f64; 2],
}

/// The shading frame at a point, in model space; interpolated, so not of unit length.
pub(crate) struct Frame {
    pub(crate) tangent: [f64; 3],
    pub(crate) bitangent: [f64; 3],
    pub(crate) normal: [f64; 3],
}

impl SourceSurface<'_> {
    /// The surface point under a texel of the atlas; over the seam for a ghost, none where nothing is.
    fn point(&self, index: usize) -> Option<SurfacePoint> {
        let owner = self.atlas.owners[index];
        if owner == EMPTY {
            return None;
        }
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let (triangle, texel) = if owner & GHOST_BIT != 0 {
            let ghost = self.atlas.ghosts.get((owner & !GHOST_BIT) as usize)?;
            (ghost.target_triangle as usize, ghost.target_texel.map(f64::from))
        } else {
            (
                owner as usize,
                [(index % width) as f64 + 0.5, ((index / width) % height) as f64 + 0.5],
            )
        };
        let chart = &self.atlas.charts[self.atlas.triangle_chart[triangle] as usize];
        let size = f64::from(self.atlas.size);
        let uv = std::array::from_fn(|axis| (texel[axis] - f64::from(chart.texel_from_uv[axis])) / size);
        Some(SurfacePoint { triangle, texel, uv })
    }

    /// What is linear over a triangle, at a point of it: three rows of a table, the value at the reference texel and its
    /// change a texel along u and v.
    fn affine(&self, point: &SurfacePoint, rows: [&[f32; 4]; 3]) -> [f64; 3] {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        let step: [f64; 2] = std::array::from_fn(|axis| point.texel[axis] - f64::from(geometry[axis][3]));
        std::array::from_fn(|axis| {
            f64::from(rows[0][axis]) + f64::from(rows[1][axis]) * step[0] + f64::from(rows[2][axis]) * step[1]
        })
    }

    /// The point itself, in working units.
    pub(crate) fn position(&self, point: &SurfacePoint) -> [f64; 3] {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        self.affine(point, [&geometry[0], &geometry[1], &geometry[2]])
    }

    /// What a step of one texel along u and along v is in space, in working units.
    pub(crate) fn texel_sides(&self, point: &SurfacePoint) -> [[f64; 3]; 2] {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        [1, 2].map(|row: usize| std::array::from_fn(|axis| f64::from(geometry[row][axis])))
    }

    /// The shading frame at a point.
    pub(crate) fn frame(&self, point: &SurfacePoint) -> Frame {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        let frames = &self.tables.frames[4 * point.triangle..];
        let normal = self.affine(point, [&geometry[3], &geometry[4], &geometry[5]]);
        let tangent = self.affine(point, [&frames[0], &frames[1], &frames[2]]);
        let sign = f64::from(frames[0][3]);
        Frame::new(normal, tangent, sign)
    }

    /// All texels of a plane in its storage format, ghosts included; zeros where nothing is.
    pub(crate) fn texels(&self, plane: Plane, value: impl Fn(&SurfacePoint) -> [f32; 4] + Sync) -> Vec<u8> {
        let format = plane.format();
        let size = format.texel_bytes() as usize;
        let mut bytes = vec![0_u8; self.atlas.owners.len() * size];
        bytes.par_chunks_mut(CHUNK * size).enumerate().for_each(|(at, texels)| {
            for (offset, texel) in texels.chunks_exact_mut(size).enumerate() {
                if let Some(point) = self.point(at * CHUNK + offset) {
                    put(texel, format, value(&point));
                }
            }
        });
        bytes
    }
}

impl Frame {
    /// A frame of interpolated vectors and the sign of its bitangent.
    pub(crate) fn new(normal: [f64; 3], tangent: [f64; 3], sign: f64) -> Frame {
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        Frame {
            bitangent: cross(normal, tangent).map(|x| sign * x),
            tangent,
            normal,
        }
    }

    /// The surface gradient that a tangent-space normal stands for: `up − n / (n · up)` with `n` in model space.
    pub(crate) fn slope(&self, normal: [f32; 3]) -> [f32; 3] {
        if normal[0] == 0.0 && normal[1] == 0.0 {
            return [0.0; 3];
        }
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let [x, y, z] = normal.map(f64::from);
        let tilted: [f64; 3] =
            std::array::from_fn(|axis| x * self.tangent[axis] + y * self.bitangent[axis] + z * self.normal[axis]);
        let length = dot(self.normal, self.normal).sqrt();
        let up = self.normal.map(|axis| axis / length.max(1e-30));
        let along = dot(tilted, up);
        // A normal that leans back below the surface has no slope; it is taken as very steep instead.
        let along = along.max(1e-3 * dot(tilted, tilted).sqrt()).max(1e-30);
        std::array::from_fn(|axis| (up[axis] - tilted[axis] / along) as f32)
    }
}

fn put(texel: &mut [u8], format: Format, value: [f32; 4]) {
    match format {
        Format::Rgba16Float => {
            for (bytes, value) in texel.chunks_exact_mut(2).zip(value) {
                bytes.copy_from_slice(&f16::from_f32(value).to_le_bytes());
            }
        }
        Format::R32Float | Format::Rgba32Float => {
            for (bytes, value) in texel.chunks_exact_mut(4).zip(value) {
                bytes.copy_from_slice(&value.to_le_bytes());
            }
        }
    }
}
