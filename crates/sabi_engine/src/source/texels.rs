//! Surface in the form that sources use, and conversion of their values to the texels of a plane.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use glam::DVec3;
use half::f16;
use rayon::prelude::*;
use sabi_gpu::{DeviceHierarchy, SurfaceTables, TileSet, tile_of};
use sabi_nodes::link::{Format, Plane};
use sabi_paint::SurfaceIndex;
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT, TILE, TileRef};
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Model;
use sabi_surface::pieces::Pieces;

use super::picture_table::PictureTables;
use crate::phases::Progress;

/// Texels per parallel task.
const CHUNK: usize = 4096;

/// Number of times that tiles are divided into groups that are far from each other.
const SPLITS: u32 = 3;
/// Number of tiles up to which all texels are examined.
const FEW_TILES: u32 = 512;
/// Minimum gap at which they are divided, as a share of the largest side of the box around them.
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
    /// Pictures on the device.
    pub(crate) picture_tables: &'a PictureTables,
    /// Hash of the surface.
    pub(crate) key: [u8; 32],
    /// Factor from model units to working units.
    pub(crate) working_from_model: f64,
    /// Tiles whose texels are filled; `None` for all.
    pub(crate) tiles: Option<&'a TileSet>,
    /// Receiver of the progress, which can cancel the work.
    pub(crate) progress: &'a dyn Progress,
}

/// Point of the surface under a texel of the atlas: its triangle, and its position on the page of its chart.
#[derive(Clone, Copy, Debug)]
struct TexelPoint {
    index: usize,
    triangle: usize,
    texel: [f64; 2],
}

impl SourceSurface<'_> {
    /// Returns the surface point of a texel. For a ghost it is beyond the seam; `None` for an empty texel.
    fn point(&self, index: usize) -> Option<TexelPoint> {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let (triangle, texel) = match self.atlas.owners[index] {
            EMPTY => return None,
            owner if owner & GHOST_BIT != 0 => {
                let ghost = self.atlas.ghosts.get((owner & !GHOST_BIT) as usize)?;
                (ghost.target_triangle as usize, ghost.target_texel.map(f64::from))
            }
            owner => (
                owner as usize,
                [(index % width) as f64 + 0.5, ((index / width) % height) as f64 + 0.5],
            ),
        };
        Some(TexelPoint { index, triangle, texel })
    }

    /// Returns the position of a point, in working units.
    fn position(&self, point: &TexelPoint) -> DVec3 {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        // The fourth column of the first two rows holds the texel of the first corner.
        let step: [f64; 2] = std::array::from_fn(|axis| point.texel[axis] - f64::from(geometry[axis][3]));
        let [start, along_u, along_v] = [0, 1, 2].map(|row: usize| xyz(&geometry[row]));
        start + along_u * step[0] + along_v * step[1]
    }

    /// Returns the steps of one texel of the atlas in space, in working units. The point of a ghost is on another chart;
    /// for ghosts, the steps are those of the chart that reads them.
    fn atlas_sides(&self, point: &TexelPoint) -> [DVec3; 2] {
        let geometry = &self.tables.geometry[6 * point.triangle..];
        let sides = [1, 2].map(|row: usize| xyz(&geometry[row]));
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

    /// Returns the tiles with triangles of each material, including those under ghosts; empty if there is only one material.
    pub(crate) fn tiles_of_materials(&self) -> Vec<TileSet> {
        let of_triangle = &self.model.mesh.triangle_material;
        let count = of_triangle.iter().max().map_or(0, |last| *last as usize + 1);
        if count < 2 {
            return Vec::new();
        }
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let side = TILE as usize;
        let of_tile = |tile: &TileRef| {
            let first = (tile.page as usize * height + side * tile.row as usize) * width + side * tile.column as usize;
            let texels = (0..side * side).map(move |at| first + at / side * width + at % side);
            let materials = texels.filter_map(|index| Some(of_triangle[self.point(index)?.triangle]));
            materials.collect::<BTreeSet<u32>>()
        };
        let materials: Vec<BTreeSet<u32>> = self.atlas.tiles.par_iter().map(of_tile).collect();
        let mut tiles = vec![Vec::new(); count];
        for (tile, materials) in self.atlas.tiles.iter().zip(materials) {
            for material in materials {
                tiles[material as usize].push([tile.column, tile.row, tile.page]);
            }
        }
        tiles.into_iter().map(TileSet::new).collect()
    }

    /// Fills the texels of a plane in its storage format, including ghosts, by their index. Empty texels and those of other
    /// tiles are zero.
    pub(crate) fn indexed_texels(&self, plane: Plane, value: impl Fn(usize) -> [f32; 4] + Sync) -> Vec<u8> {
        self.fill(plane, |index| (self.atlas.owners[index] != EMPTY).then(|| value(index)))
    }

    /// Returns corners of boxes around all texels of some tiles, in working units. Tiles that are far from the others in
    /// space have separate boxes. Half a texel around its middle belongs to each texel.
    pub(crate) fn bounds_of(&self, tiles: &TileSet) -> Vec<[DVec3; 2]> {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let side = TILE as usize;
        // If there are many tiles, only every third texel is examined, and the boxes are enlarged accordingly.
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
            // The texels in a row of a tile are consecutive.
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

/// Adds the boxes around groups of boxes. Groups are divided at the largest gap between them if it is wide enough.
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
