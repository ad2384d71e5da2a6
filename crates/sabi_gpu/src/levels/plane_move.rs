//! Kernels that move a plane between levels.

use sabi_plan::{Level, MoveStep};

use super::{PointSurface, Scale, Surfaces};
use crate::bindings::{owners_entry, storage_entry, table_entry, texture_entry, uniform_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::ghosts::{FillRound, fill_ghosts, fill_links};
use crate::links::Links;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::run_options::RunOptions;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

/// Move of a plane from one level to another.
pub(crate) struct PlaneMove<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) surfaces: Surfaces<'a>,
    pub(crate) step: &'a MoveStep,
    /// Texture that is read.
    pub(crate) source: &'a wgpu::Texture,
    /// Texture that is written.
    pub(crate) target: &'a wgpu::Texture,
    pub(crate) options: &'a RunOptions<'a>,
}

impl PlaneMove<'_> {
    /// Moves the plane, and fills the linked texels of the target.
    pub(crate) fn run(&self) -> Result<(), GpuError> {
        match self.step.levels {
            [Level::Texels(from), Level::Texels(to)] => self.between_texels([from, to]),
            [Level::Texels(_), Level::Points(number)] => self.move_texels_to_points(self.surfaces.points_of(number)?),
            [Level::Points(number), Level::FINEST] => self.move_points_to_texels(self.surfaces.points_of(number)?),
            [from, to] => Err(GpuError::Defect(format!(
                "nothing moves from level {from} to level {to}"
            ))),
        }
    }

    /// Moves between the finest texels and coarser ones.
    fn between_texels(&self, [from, to]: [u32; 2]) -> Result<(), GpuError> {
        let (gpu, format) = (self.gpu, self.step.format);
        let coarse = self.surfaces.coarse(from.max(to))?;
        let fine = self.surfaces.finest;
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
        let kernel = fixed_kernel(gpu, shader, &entries)?;
        let scale = coarse.scale(gpu);
        let (source, written) = (array_view(self.source), array_view(self.target));
        let views = [owners_or_charts, frames, &source, &written].map(wgpu::BindingResource::TextureView);
        let group = gpu.bind(&kernel.layout, std::iter::once(scale.as_entire_binding()).chain(views));
        let slices = Slices::new(gpu, target_surface, self.options.submission);
        slices.run(&kernel.pipeline, &kernel.pace, &group, self.options.is_canceled)?;
        self.fill_linked(target_surface, Some(orphans))
    }

    /// Moves from the texels of the cells to their points.
    fn move_texels_to_points(&self, points: &PointSurface) -> Result<(), GpuError> {
        let (gpu, format) = (self.gpu, self.step.format);
        let entries = [table_entry(0), texture_entry(1), storage_entry(2, format)];
        let kernel = fixed_kernel(gpu, FixedShader::ToPoints(format), &entries)?;
        let (source, written) = (array_view(self.source), array_view(self.target));
        let views = [&points.cells, &source, &written].map(wgpu::BindingResource::TextureView);
        let group = gpu.bind(&kernel.layout, views);
        let slices = Slices::new(gpu, &points.surface, self.options.submission);
        slices.run(&kernel.pipeline, &kernel.pace, &group, self.options.is_canceled)?;
        Ok(())
    }

    /// Moves from points to the finest texels.
    fn move_points_to_texels(&self, points: &PointSurface) -> Result<(), GpuError> {
        let (gpu, format) = (self.gpu, self.step.format);
        let entries = [
            uniform_entry(0),
            owners_entry(1),
            table_entry(2),
            table_entry(3),
            texture_entry(4),
            storage_entry(5, format),
        ];
        let kernel = fixed_kernel(gpu, FixedShader::FromPoints(format), &entries)?;
        let scale = gpu.uniform(bytemuck::bytes_of(&Scale {
            factor: points.factor,
            spacing: points.surface.measures.texel as f32,
            pad: [0; 2],
        }));
        let (source, written) = (array_view(self.source), array_view(self.target));
        let views = [
            &points.point_of_texel,
            &points.cell_frames,
            &points.around,
            &source,
            &written,
        ]
        .map(wgpu::BindingResource::TextureView);
        let group = gpu.bind(&kernel.layout, std::iter::once(scale.as_entire_binding()).chain(views));
        let finest = self.surfaces.finest;
        let slices = Slices::new(gpu, finest, self.options.submission);
        slices.run(&kernel.pipeline, &kernel.pace, &group, self.options.is_canceled)?;
        let orphans = match points.cells_level {
            0 => None,
            level => Some(&self.surfaces.coarse(level)?.fine_orphans),
        };
        self.fill_linked(finest, orphans)
    }

    /// Fills the linked texels of the target on a level of texels: first those without a counterpart, then ghosts.
    fn fill_linked(&self, surface: &GpuSurface, orphans: Option<&Links>) -> Result<(), GpuError> {
        let (gpu, format) = (self.gpu, self.step.format);
        if let Some(orphans) = orphans {
            fill_links(gpu, surface, orphans, self.target, format, &[FillRound::Owned])?;
        }
        let rounds = FillRound::sequence(self.step.result.is_some());
        fill_ghosts(gpu, surface, self.target, format, rounds)
    }
}
