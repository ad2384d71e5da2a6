//! Dispatch of one kernel over the tiles of its level.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use sabi_nodes::link::{Domain, Format, SURVEY_GROUPS};
use sabi_plan::{KernelStep, SlotRef};
use sabi_surface::atlas::TILE;

use super::{Repetition, Runner};
use crate::error::GpuError;
use crate::ghosts::fill_ghosts;
use crate::pipeline_cache::CompiledKernel;
use crate::pool::array_view;
use crate::source_fill::SourceFill;
use crate::tiles::Slices;

/// Textures that a kernel reads and writes.
pub(super) struct BoundTextures {
    views: Vec<wgpu::TextureView>,
    /// Written textures with a slot of the plan.
    pub(super) written: Vec<(wgpu::Texture, Format)>,
}

impl BoundTextures {
    /// Texture bindings.
    pub(super) fn resources(&self) -> impl Iterator<Item = wgpu::BindingResource<'_>> {
        self.views.iter().map(wgpu::BindingResource::TextureView)
    }
}

/// Texels of tiles.
pub(super) fn texels_of(tiles: u32) -> u64 {
    u64::from(tiles) * u64::from(TILE).pow(2)
}

impl Runner<'_> {
    /// Runs a kernel once over all tiles and fills ghosts. Returns the time that the kernel takes without the ghosts, if it
    /// is known. It is not known for rays and for kernels without tiles.
    pub(super) fn dispatch(
        &mut self,
        step: &KernelStep,
        compiled: &CompiledKernel,
        block: &wgpu::Buffer,
        slots: [&[Option<SlotRef>]; 2],
        repetition: Repetition,
        sources: &mut dyn SourceFill,
    ) -> Result<Option<Duration>, GpuError> {
        let bound = self.bound(compiled, slots)?;
        let surface = self.surfaces.at(step.level)?;
        let covered = self.coverages.tiles(self.at);
        let slices_of_one = match self.part.as_ref().or(covered) {
            Some(tiles) => Slices::over(self.gpu, surface, tiles, self.options.submission)?,
            None => Slices::new(self.gpu, surface, self.options.submission),
        };
        let slices = slices_of_one.in_repetition(repetition.index, repetition.count);
        let mut taken = None;
        if let (Some(rays), Some(ray_generation)) = (step.rays.as_deref(), &compiled.ray_generation) {
            self.report.texels += texels_of(slices.tile_count());
            self.rays(step, rays, compiled, ray_generation, &bound, &slices, sources)?;
        } else {
            let block = std::iter::once(block.as_entire_binding());
            let group = self.gpu.bind(&compiled.layout, block.chain(bound.resources()));
            self.warm(compiled, &slices, &group)?;
            match step.spec.domain {
                Domain::Once => slices.submit(&compiled.pipeline, &group, 0, 1),
                Domain::Groups => {
                    let slices = slices.of_groups(SURVEY_GROUPS);
                    slices.run(&compiled.pipeline, &compiled.pace, &group, self.options.is_canceled)?;
                }
                Domain::AllTexels | Domain::OwnedTexels | Domain::OwnedTexelsByRays => {
                    let canceled = self.options.is_canceled;
                    self.report.texels += texels_of(slices.tile_count());
                    taken = Some(slices.run(&compiled.pipeline, &compiled.pace, &group, canceled)?);
                }
            }
        }
        if step.fills_ghosts {
            let rounds = repetition.fill_rounds(!step.keys.is_empty());
            let started = self.measured_time()?;
            for (texture, format) in &bound.written {
                fill_ghosts(self.gpu, surface, texture, *format, rounds)?;
            }
            if let (Some(started), Some(ended)) = (started, self.measured_time()?) {
                self.report.ghosts += ended - started;
            }
        }
        Ok(taken)
    }

    /// Waits for all work and returns the time; `None` if times are not measured.
    fn measured_time(&self) -> Result<Option<Instant>, GpuError> {
        if !self.options.times_ghosts {
            return Ok(None);
        }
        self.wait()?;
        Ok(Some(Instant::now()))
    }

    /// Returns the textures of the slots of a kernel, with one-texel textures for unused planes.
    fn bound(
        &mut self,
        compiled: &CompiledKernel,
        [reads, writes]: [&[Option<SlotRef>]; 2],
    ) -> Result<BoundTextures, GpuError> {
        let mut bound = BoundTextures {
            views: Vec::new(),
            written: Vec::new(),
        };
        for slot in reads {
            let texture = match slot {
                Some(slot) => self.texture(*slot)?,
                None => self.unused_plane(Format::Rgba16Float, false)?,
            };
            bound.views.push(array_view(&texture));
        }
        for (slot, format) in writes.iter().zip(&compiled.kernel.writes) {
            let texture = match slot {
                Some(slot) => self.texture(*slot)?,
                None => self.unused_plane(*format, true)?,
            };
            bound.views.push(array_view(&texture));
            if slot.is_some() {
                bound.written.push((texture, *format));
            }
        }
        Ok(bound)
    }

    /// Runs a kernel over no tiles if it has never run, so that the driver compiles it.
    pub(super) fn warm(
        &mut self,
        compiled: &CompiledKernel,
        slices: &Slices<'_>,
        group: &wgpu::BindGroup,
    ) -> Result<(), GpuError> {
        if !compiled.is_warm.load(Ordering::Relaxed) {
            // Work that was submitted earlier must not count in the time of compiling.
            self.wait()?;
            let warming = Instant::now();
            slices.warm(&compiled.pipeline, group, self.options.is_canceled)?;
            compiled.is_warm.store(true, Ordering::Relaxed);
            let (took, bytes) = (warming.elapsed(), compiled.kernel.module.wgsl().len());
            tracing::debug!(compile = ?took, bytes, nodes = compiled.nodes, "kernel compiled");
            self.report.compile += took;
        }
        Ok(())
    }
}
