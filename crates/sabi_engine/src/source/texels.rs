//! Surface as sources see it, and conversion of their values to the texels of a plane.

use std::sync::OnceLock;

use glam::DVec3;
use half::f16;
use rayon::prelude::*;
use sabi_gpu::{DeviceHierarchy, SurfaceTables, TileSet, tile_of};
use sabi_nodes::link::{Format, Plane};
use sabi_paint::SurfaceIndex;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT, TILE};
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Model;
use sabi_surface::pieces::Pieces;

/// Texels per parallel task.
const CHUNK: usize = 4096;

/// Times that tiles are parted into groups that lie far from each other.
const SPLITS: u32 = 3;
/// Tiles of which all texels are looked at.
const FEW_TILES: u32 = 512;
/// Gap that parts them, as a share of the largest side of the box around them.
const WIDE_GAP: f64 = 0.15;

/// Surface that sources fill.
#[derive(Clone, Copy)]
pub(crate) struct SourceSurface<'a> {
    pub(crate) model: &'a Model,
    pub(crate) atlas: &'a Atlas,
    pub(crate) tables: &'a SurfaceTables,
    pub(crate) pieces: &'a Pieces,
    /// Index of the mesh for brushes, made when the first stroke is painted.
    pub(crate) paint_index: &'a OnceLock<SurfaceIndex>,
    /// Ray hierarchy, built when the first ray is traced.
    pub(crate) bvh: &'a OnceLock<Bvh>,
    /// Ray hierarchy on the device.
    pub(crate) bvh_on_device: &'a OnceLock<DeviceHierarchy>,
    /// Hash of the surface.
    pub(crate) key: [u8; 32],
    /// Factor from model units to working units.
    pub(crate) working_from_model: f64,
    /// Tiles whose texels are filled; none for all.
    pub(crate) tiles: Option<&'a TileSet>,
}

/// Point of the surface under a texel of the atlas: its triangle, its position on the page of its chart, and its texture
/// coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub(crate) index: usize,
    pub(crate) triangle: usize,
    pub(crate) texel: [f64; 2],
    pub(crate) uv: [f64; 2],
}

/// Shading frame at a point, in model space; interpolated, so its vectors have not unit length.
pub(crate) struct Frame {
    pub(crate) tangent: DVec3,
    pub(crate) bitangent: DVec3,
    pub(crate) normal: DVec3,
}

impl SourceSurface<'_> {
    /// Returns the surface point of a texel; beyond the seam for a ghost, none for an empty texel.
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
        Some(SurfacePoint {
            index,
            triangle,
            texel,
            uv,
        })
    }

    /// Interpolates a value that is linear over a triangle, given by rows of a table: the value at the reference texel and its
    /// change per texel along u and v.
    fn affine(&self, point: &SurfacePoint, rows: [&[f32; 4]; 3]) -> DVec3 {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        let step: [f64; 2] = std::array::from_fn(|axis| point.texel[axis] - f64::from(geometry[axis][3]));
        let [start, along_u, along_v] = rows.map(xyz);
        start + along_u * step[0] + along_v * step[1]
    }

    /// Returns the position of a point, in working units.
    pub(crate) fn position(&self, point: &SurfacePoint) -> DVec3 {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        self.affine(point, [&geometry[0], &geometry[1], &geometry[2]])
    }

    /// Returns the steps of one texel along u and v in space, in working units.
    pub(crate) fn texel_sides(&self, point: &SurfacePoint) -> [DVec3; 2] {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        [1, 2].map(|row: usize| xyz(&geometry[row]))
    }

    /// Returns the steps of one texel of the atlas in space, in working units. They differ from [`Self::texel_sides`] on
    /// ghosts, whose point lies on another chart.
    pub(crate) fn atlas_sides(&self, point: &SurfacePoint) -> [DVec3; 2] {
        let sides = self.texel_sides(point);
        let owner = self.atlas.owners[point.index];
        if owner == EMPTY || owner & GHOST_BIT == 0 {
            return sides;
        }
        match self.atlas.ghosts.get((owner & !GHOST_BIT) as usize) {
            Some(ghost) => [0, 1].map(|column: usize| {
                let [along, across] = ghost.target_from_own[column].map(f64::from);
                along * sides[0] + across * sides[1]
            }),
            None => sides,
        }
    }

    /// Returns the shading frame at a point.
    pub(crate) fn frame(&self, point: &SurfacePoint) -> Frame {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        let frames = &self.tables.frames[4 * point.triangle..];
        let normal = self.affine(point, [&geometry[3], &geometry[4], &geometry[5]]);
        let tangent = self.affine(point, [&frames[0], &frames[1], &frames[2]]);
        let sign = f64::from(frames[0][3]);
        Frame::new(normal, tangent, sign)
    }

    /// Fills the texels of a plane in its storage format, ghosts included; empty texels and those of other tiles are zero.
    pub(crate) fn texels(&self, plane: Plane, value: impl Fn(&SurfacePoint) -> [f32; 4] + Sync) -> Vec<u8> {
        self.fill(plane, |index| self.point(index).map(|point| value(&point)))
    }

    /// Fills all texels of a plane as [`Self::texels`] does, by their index alone.
    pub(crate) fn indexed_texels(&self, plane: Plane, value: impl Fn(usize) -> [f32; 4] + Sync) -> Vec<u8> {
        self.fill(plane, |index| (self.atlas.owners[index] != EMPTY).then(|| value(index)))
    }

    /// Corners of boxes around all texels of some tiles, in working units: tiles that lie far from the others in space have boxes of
    /// their own. Half a texel beyond its middle belongs to each texel.
    pub(crate) fn bounds_of(&self, tiles: &TileSet) -> Vec<[DVec3; 2]> {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let side = TILE as usize;
        // Of many tiles, every third texel stands for those beside it, too.
        let (step, reach) = if tiles.count() > FEW_TILES { (3, 2.0) } else { (1, 0.5) };
        let of_tile = |place: [u32; 3]| {
            let [column, row, page] = place.map(|at| at as usize);
            let texels = (0..side * side)
                .step_by(step)
                .map(|at| (page * height + side * row + at / side) * width + side * column + at % side);
            let boxes = texels.filter_map(|index| self.point(index)).map(|point| {
                let half = self
                    .atlas_sides(&point)
                    .iter()
                    .map(|side| reach * side.abs())
                    .sum::<DVec3>();
                let middle = self.position(&point);
                [middle - half, middle + half]
            });
            boxes.reduce(around)
        };
        let boxes: Vec<[DVec3; 2]> = tiles.places().filter_map(of_tile).collect();
        let mut apart = Vec::new();
        split(boxes, SPLITS, &mut apart);
        apart
    }

    /// Fills the texels of some tiles of a plane, tile by tile, by their index.
    pub(crate) fn indexed_tiles(
        &self,
        plane: Plane,
        tiles: &TileSet,
        value: impl Fn(usize) -> [f32; 4] + Sync,
    ) -> Vec<u8> {
        let format = plane.format();
        let size = format.texel_bytes() as usize;
        let side = TILE as usize;
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let places: Vec<[usize; 3]> = tiles.places().map(|place| place.map(|at| at as usize)).collect();
        let mut bytes = vec![0_u8; places.len() * side * side * size];
        let tiles = bytes.par_chunks_mut(side * side * size).zip(&places);
        tiles.for_each(|(texels, [column, row, page])| {
            for (at, texel) in texels.chunks_exact_mut(size).enumerate() {
                let [x, y] = [side * column + at % side, side * row + at / side];
                let index = (page * height + y) * width + x;
                if self.atlas.owners[index] != EMPTY {
                    put(texel, format, value(index));
                }
            }
        });
        bytes
    }

    fn fill(&self, plane: Plane, value: impl Fn(usize) -> Option<[f32; 4]> + Sync) -> Vec<u8> {
        let format = plane.format();
        let size = format.texel_bytes() as usize;
        let mut bytes = vec![0_u8; self.atlas.owners.len() * size];
        let side = TILE as usize;
        bytes.par_chunks_mut(CHUNK * size).enumerate().for_each(|(at, texels)| {
            // The texels of a row of a tile lie one after the other.
            for (row, texels) in texels.chunks_mut(side * size).enumerate() {
                let first = at * CHUNK + row * side;
                if self.tiles.is_some_and(|tiles| !tiles.contains(self.tile_of(first))) {
                    continue;
                }
                for (offset, texel) in texels.chunks_exact_mut(size).enumerate() {
                    if let Some(value) = value(first + offset) {
                        put(texel, format, value);
                    }
                }
            }
        });
        bytes
    }

    /// Returns the tile of a texel.
    fn tile_of(&self, index: usize) -> [u32; 3] {
        tile_of(index as u32, self.atlas.page_size)
    }
}

/// The box around two boxes.
fn around([low, high]: [DVec3; 2], [less, more]: [DVec3; 2]) -> [DVec3; 2] {
    [low.min(less), high.max(more)]
}

/// Adds the boxes around groups of boxes, which are parted where the largest gap between them is, as long as it is wide.
fn split(mut boxes: Vec<[DVec3; 2]>, splits: u32, apart: &mut Vec<[DVec3; 2]>) {
    let Some(all) = boxes.iter().copied().reduce(around) else {
        return;
    };
    let mut widest = (0.0, 0, 0);
    for axis in 0..3 {
        boxes.sort_by(|one, other| one[0][axis].total_cmp(&other[0][axis]));
        let mut end = f64::NEG_INFINITY;
        for (index, [low, high]) in boxes.iter().enumerate() {
            let gap = low[axis] - end;
            if index > 0 && gap > widest.0 {
                widest = (gap, axis, index);
            }
            end = end.max(high[axis]);
        }
    }
    let (gap, axis, index) = widest;
    if splits == 0 || gap < WIDE_GAP * (all[1] - all[0]).max_element() {
        apart.push(all);
        return;
    }
    boxes.sort_by(|one, other| one[0][axis].total_cmp(&other[0][axis]));
    let others = boxes.split_off(index);
    split(boxes, splits - 1, apart);
    split(others, splits - 1, apart);
}

impl Frame {
    /// Creates a frame from interpolated vectors and the sign of the bitangent.
    pub(crate) fn new(normal: DVec3, tangent: DVec3, sign: f64) -> Frame {
        Frame {
            bitangent: sign * normal.cross(tangent),
            tangent,
            normal,
        }
    }

    /// Converts a tangent-space normal to a surface gradient: `up − n / (n · up)` with `n` in model space.
    pub(crate) fn slope(&self, normal: [f32; 3]) -> [f32; 3] {
        if normal[0] == 0.0 && normal[1] == 0.0 {
            return [0.0; 3];
        }
        let [x, y, z] = normal.map(f64::from);
        let tilted = x * self.tangent + y * self.bitangent + z * self.normal;
        let up = self.normal / self.normal.length().max(1e-30);
        let along = tilted.dot(up);
        // A normal that points below the surface has no slope; it counts as very steep.
        let along = along.max(1e-3 * tilted.length()).max(1e-30);
        (up - tilted / along).as_vec3().to_array()
    }
}

/// First three values of a table's row.
fn xyz([x, y, z, _]: &[f32; 4]) -> DVec3 {
    DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z))
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
