//! Coarser levels of the surface, and the way of a plane between levels.

use std::collections::BTreeMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use sabi_nodes::link::Format;
use sabi_surface::atlas::{Atlas, AtlasLevel, EMPTY, GHOST_BIT};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::links::{GHOST_ROUNDS, LinkRound, Links};
use crate::pipelines::{FixedKernel, owners_entry, storage_entry, table_entry, texture_entry, uniform_entry};
use crate::pool::array_view;
use crate::run::RunOptions;
use crate::surface::{GpuSurface, TexelWidths};
use crate::tables::SurfaceTables;
use crate::tiles::Slices;
use crate::uploads::texel_texture;

/// A coarser level on the device.
pub struct CoarseSurface {
    pub(crate) surface: GpuSurface,
    /// Finer texels along a side of a coarser one.
    factor: u32,
    /// The chart that each texel belongs to, or whose ring it is in.
    charts: wgpu::TextureView,
    /// Coarser texels that cover no finer one.
    coarse_orphans: Links,
    /// Finer texels with no coarser one near.
    fine_orphans: Links,
}

impl CoarseSurface {
    /// Uploads a level; its tables are those of the coarser atlas.
    pub fn upload(
        gpu: &Gpu,
        level: &AtlasLevel,
        tables: &SurfaceTables,
        widths: TexelWidths,
    ) -> Result<CoarseSurface, GpuError> {
        let surface = GpuSurface::upload(gpu, &level.atlas, tables, widths)?;
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
            pad: [0; 7],
        };
        gpu.uniform(bytemuck::bytes_of(&scale))
    }
}

/// The chart that each texel of an atlas belongs to, or whose ring it is in; [`EMPTY`] where there is none.
fn charts(atlas: &Atlas) -> Vec<u32> {
    let chart = |owner: &u32| match *owner {
        EMPTY => EMPTY,
        ghost if ghost & GHOST_BIT != 0 => atlas.ghosts[(ghost & !GHOST_BIT) as usize].chart,
        triangle => atlas.triangle_chart[triangle as usize],
    };
    atlas.owners.iter().map(chart).collect()
}

/// All levels of a surface that a run may use.
#[derive(Clone, Copy)]
pub struct Surfaces<'s> {
    /// The finest, level 0.
    pub finest: &'s GpuSurface,
    /// Others by their number.
    pub coarser: &'s BTreeMap<u32, CoarseSurface>,
}

impl<'s> Surfaces<'s> {
    /// Only the finest level.
    pub fn only(finest: &'s GpuSurface) -> Surfaces<'s> {
        static NONE: BTreeMap<u32, CoarseSurface> = BTreeMap::new();
        Surfaces { finest, coarser: &NONE }
    }

    /// A level.
    pub(crate) fn at(&self, level: u32) -> Result<&'s GpuSurface, GpuError> {
        if level == 0 {
            return Ok(self.finest);
        }
        Ok(&self.coarse(level)?.surface)
    }

    fn coarse(&self, level: u32) -> Result<&'s CoarseSurface, GpuError> {
        let missing = || {
            GpuError::Source(format!(
                "level {level} of the surface is not there; this is a mistake in Sabi"
            ))
        };
        self.coarser.get(&level).ok_or_else(missing)
    }
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Scale {
    factor: u32,
    pad: [u32; 7],
}

impl Gpu {
    /// Brings a plane from one level to another, one of which is the finest, and fills what is linked.
    pub(crate) fn move_plane(
        &self,
        surfaces: Surfaces<'_>,
        [from, to]: [u32; 2],
        [source, target]: [&wgpu::Texture; 2],
        format: Format,
        options: &RunOptions<'_>,
    ) -> Result<(), GpuError> {
        let coarse = surfaces.coarse(from.max(to))?;
        let views = [array_view(source), array_view(target)];
        let (ground, orphans, (kernel, group)) = if to > from {
            let work = self.restriction(surfaces.finest, coarse, &views, format)?;
            (&coarse.surface, &coarse.coarse_orphans, work)
        } else {
            let work = self.prolongation(coarse, &views, format)?;
            (surfaces.finest, &coarse.fine_orphans, work)
        };
        let slices = Slices::new(self, ground, options.submission);
        slices.run(&kernel.pipeline, &group, options.is_canceled)?;
        let of_orphans = Slices::with_links(self, ground, orphans, options.submission);
        self.fill_links(
            orphans,
            of_orphans.surface_group(),
            (target, format),
            &[LinkRound::Owned],
        )?;
        self.fill_links(&ground.ghosts, slices.surface_group(), (target, format), &GHOST_ROUNDS)
    }

    /// The kernel to a coarser level, and what it binds.
    fn restriction(
        &self,
        fine: &GpuSurface,
        coarse: &CoarseSurface,
        [source, target]: &[wgpu::TextureView; 2],
        format: Format,
    ) -> Result<(Arc<FixedKernel>, wgpu::BindGroup), GpuError> {
        let text = include_str!("../../../shaders/surface/restrict.wgsl").replace("FORMAT", format.wgsl());
        let entries = [
            uniform_entry(0),
            owners_entry(1),
            table_entry(2),
            texture_entry(3),
            storage_entry(4, format),
        ];
        let kernel = self.fixed_kernel("restrict", Some(format), &text, &entries)?;
        let scale = coarse.scale(self);
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            scale.as_entire_binding(),
            view(&fine.owners),
            view(&fine.frames),
            view(source),
            view(target),
        ];
        let group = self.bind(&kernel.layout, resources);
        Ok((kernel, group))
    }

    /// The kernel to the finest level, and what it binds.
    fn prolongation(
        &self,
        coarse: &CoarseSurface,
        [source, target]: &[wgpu::TextureView; 2],
        format: Format,
    ) -> Result<(Arc<FixedKernel>, wgpu::BindGroup), GpuError> {
        let text = include_str!("../../../shaders/surface/prolong.wgsl").replace("FORMAT", format.wgsl());
        let entries = [
            uniform_entry(0),
            owners_entry(1),
            table_entry(2),
            texture_entry(3),
            storage_entry(4, format),
        ];
        let kernel = self.fixed_kernel("prolong", Some(format), &text, &entries)?;
        let scale = coarse.scale(self);
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            scale.as_entire_binding(),
            view(&coarse.charts),
            view(&coarse.surface.frames),
            view(source),
            view(target),
        ];
        let group = self.bind(&kernel.layout, resources);
        Ok((kernel, group))
    }
}
