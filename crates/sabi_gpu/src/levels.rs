//! Coarser levels of the surface.

mod plane_move;
mod points;

use std::collections::BTreeMap;

pub(crate) use plane_move::PlaneMove;
pub use points::{CellLevel, PointSurface};
use sabi_nodes::wgsl_struct;
use sabi_plan::Level;
use sabi_surface::atlas::{Atlas, AtlasLevel, EMPTY, GHOST_BIT};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::links::Links;
use crate::surface::{GpuSurface, Measures};
use crate::tables::SurfaceTables;
use crate::uploads::texel_texture;

/// A coarser level on the device.
pub struct CoarseSurface {
    pub(crate) surface: GpuSurface,
    /// Texels of the finest level along a side of one texel of this level.
    pub(crate) factor: u32,
    /// Chart of each texel, ghosts included.
    charts: wgpu::TextureView,
    /// Texels of this level that cover no texel of the finest.
    coarse_orphans: Links,
    /// Texels of the finest level that have no texel of this level near them.
    pub(crate) fine_orphans: Links,
}

impl CoarseSurface {
    /// Uploads a level with the tables of its own atlas.
    pub fn upload(
        gpu: &Gpu,
        level: &AtlasLevel,
        tables: &SurfaceTables,
        measures: Measures,
    ) -> Result<CoarseSurface, GpuError> {
        let surface = GpuSurface::upload(gpu, &level.atlas, tables, measures)?;
        let charts = charts(&level.atlas);
        let bytes = bytemuck::cast_slice(&charts);
        let format = wgpu::TextureFormat::R32Uint;
        Ok(CoarseSurface {
            charts: texel_texture(gpu, "the charts of a level", format, surface.extent, bytes)?,
            surface,
            factor: level.factor(),
            coarse_orphans: Links::of_orphans(gpu, &level.coarse_orphans)?,
            fine_orphans: Links::of_orphans(gpu, &level.fine_orphans)?,
        })
    }

    fn scale(&self, gpu: &Gpu) -> wgpu::Buffer {
        let scale = Scale {
            factor: self.factor,
            spacing: 0.0,
            pad: [0; 2],
        };
        gpu.uniform(bytemuck::bytes_of(&scale))
    }
}

/// Chart of each texel of an atlas, ghosts included; [`EMPTY`] where there is none.
fn charts(atlas: &Atlas) -> Vec<u32> {
    let chart = |owner: &u32| match *owner {
        EMPTY => EMPTY,
        ghost if ghost & GHOST_BIT != 0 => atlas.ghosts[(ghost & !GHOST_BIT) as usize].chart,
        triangle => atlas.triangle_chart[triangle as usize],
    };
    atlas.owners.iter().map(chart).collect()
}

/// Levels of a surface that a run may use.
#[derive(Clone, Copy)]
pub struct Surfaces<'s> {
    /// Finest level, number 0.
    pub finest: &'s GpuSurface,
    /// Coarser levels by number.
    pub coarser: &'s BTreeMap<u32, CoarseSurface>,
    /// Levels of points by number.
    pub points: &'s BTreeMap<u32, PointSurface>,
}

impl<'s> Surfaces<'s> {
    /// Only the finest level.
    pub fn only(finest: &'s GpuSurface) -> Surfaces<'s> {
        static NO_LEVELS: BTreeMap<u32, CoarseSurface> = BTreeMap::new();
        static NO_POINTS: BTreeMap<u32, PointSurface> = BTreeMap::new();
        Surfaces {
            finest,
            coarser: &NO_LEVELS,
            points: &NO_POINTS,
        }
    }

    /// A level.
    pub(crate) fn at(&self, level: Level) -> Result<&'s GpuSurface, GpuError> {
        Ok(match level {
            Level::FINEST => self.finest,
            Level::Texels(number) => &self.coarse(number)?.surface,
            Level::Points(number) => &self.points_of(number)?.surface,
        })
    }

    pub(crate) fn coarse(&self, number: u32) -> Result<&'s CoarseSurface, GpuError> {
        let missing = || GpuError::Defect(format!("level {number} of the surface was not uploaded"));
        self.coarser.get(&number).ok_or_else(missing)
    }

    pub(crate) fn points_of(&self, number: u32) -> Result<&'s PointSurface, GpuError> {
        let missing = || GpuError::Defect(format!("level {number} of points was not uploaded"));
        self.points.get(&number).ok_or_else(missing)
    }
}

wgsl_struct! {
    "surface/level" Scale:
    /// Ratio between a level and the finest one, and the spacing of points.
    pub(crate) struct Scale {
        pub(crate) factor: u32,
        pub(crate) spacing: f32,
        pub(crate) pad: [u32; 2],
    }
}
