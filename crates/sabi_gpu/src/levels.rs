//! Coarser levels of the surface, and kernels that move a plane between levels.

mod points;

use std::collections::BTreeMap;

pub use points::{CellLevel, PointSurface};
use sabi_nodes::wgsl_struct;
use sabi_plan::{Level, MoveStep};
use sabi_surface::atlas::{Atlas, AtlasLevel, EMPTY, GHOST_BIT};

use crate::bindings::{owners_entry, storage_entry, table_entry, texture_entry, uniform_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::ghosts::FillRound;
use crate::links::Links;
use crate::pool::array_view;
use crate::run_options::RunOptions;
use crate::shaders::FixedShader;
use crate::surface::{GpuSurface, Measures};
use crate::tables::SurfaceTables;
use crate::tiles::Slices;
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

impl Gpu {
    /// Moves a plane from one level to another, and fills the linked texels of the target.
    pub(crate) fn move_plane(
        &self,
        surfaces: Surfaces<'_>,
        step: &MoveStep,
        textures: [&wgpu::Texture; 2],
        options: &RunOptions<'_>,
    ) -> Result<(), GpuError> {
        match step.levels {
            [Level::Texels(from), Level::Texels(to)] => self.move_texels(surfaces, [from, to], step, textures, options),
            [Level::Texels(_), Level::Points(number)] => {
                let points = surfaces.points_of(number)?;
                self.gather_to_points(points, step.format, textures, options)
            }
            [Level::Points(number), Level::FINEST] => {
                let points = surfaces.points_of(number)?;
                self.spread_from_points(surfaces, points, step, textures, options)
            }
            [from, to] => Err(GpuError::Defect(format!(
                "nothing moves from level {from} to level {to}"
            ))),
        }
    }

    /// Moves a plane between the finest texels and coarser ones.
    fn move_texels(
        &self,
        surfaces: Surfaces<'_>,
        [from, to]: [u32; 2],
        step: &MoveStep,
        [source, target]: [&wgpu::Texture; 2],
        options: &RunOptions<'_>,
    ) -> Result<(), GpuError> {
        let format = step.format;
        let coarse = surfaces.coarse(from.max(to))?;
        let fine = surfaces.finest;
        // Both kernels look up owners or charts on the level that is read. They also need the chart position of each triangle.
        let (shader, target_surface, orphans, owners_or_charts, frames) = if to > from {
            let coarse_orphans = &coarse.coarse_orphans;
            (
                FixedShader::Restrict(format),
                &coarse.surface,
                coarse_orphans,
                &fine.owners,
                &fine.frames,
            )
        } else {
            let frames = &coarse.surface.frames;
            (
                FixedShader::Prolong(format),
                fine,
                &coarse.fine_orphans,
                &coarse.charts,
                frames,
            )
        };
        let entries = [
            uniform_entry(0),
            owners_entry(1),
            table_entry(2),
            texture_entry(3),
            storage_entry(4, format),
        ];
        let kernel = self.fixed_kernel(shader, &entries)?;
        let scale = coarse.scale(self);
        let (source, written) = (array_view(source), array_view(target));
        let views = [owners_or_charts, frames, &source, &written].map(wgpu::BindingResource::TextureView);
        let group = self.bind(&kernel.layout, std::iter::once(scale.as_entire_binding()).chain(views));
        let slices = Slices::new(self, target_surface, options.submission);
        slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
        self.fill_moved(target_surface, Some(orphans), target, step, options)
    }

    /// Fills the linked texels of a plane that was moved to a level of texels: first those without a counterpart, then ghosts.
    fn fill_moved(
        &self,
        surface: &GpuSurface,
        orphans: Option<&Links>,
        target: &wgpu::Texture,
        step: &MoveStep,
        options: &RunOptions<'_>,
    ) -> Result<(), GpuError> {
        if let Some(orphans) = orphans {
            let of_orphans = Slices::with_links(self, surface, orphans, options.submission);
            let group = of_orphans.surface_group();
            self.fill_links(orphans, group, target, step.format, &[FillRound::Owned])?;
        }
        let rounds = FillRound::sequence(step.result.is_some());
        self.fill_ghosts(surface, target, step.format, rounds)
    }
}
