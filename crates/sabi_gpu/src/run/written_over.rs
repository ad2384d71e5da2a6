//! Kernels of points that write their results over inputs that they are the last to read.
//!
//! A texture cannot be read and written in one dispatch. Therefore such a kernel writes a band of rows to separate
//! textures, which are copied into place before the next band is computed. This is possible since a texel of a result
//! depends only on the same texel of the inputs.

use std::collections::BTreeMap;
use std::time::Duration;

use sabi_nodes::link::Format;
use sabi_plan::{KernelStep, SlotRef};
use sabi_surface::atlas::TILE;

use super::Runner;
use crate::error::GpuError;
use crate::layer_rows::LayerRows;
use crate::needed_steps::{band_rows, written_over};
use crate::pipeline_cache::CompiledKernel;
use crate::pool::{array_view, bytes_of};
use crate::surface::GpuSurface;
use crate::tile_set::TileSet;
use crate::tiles::Slices;

/// Texture that a kernel fills band by band.
struct Filled {
    band: wgpu::Texture,
    format: Format,
    whole: wgpu::Texture,
}

impl Runner<'_> {
    /// Returns the read slots whose textures the written slots of a kernel take over; empty if that saves little.
    pub(super) fn slots_written_over(&self, step: &KernelStep) -> BTreeMap<SlotRef, SlotRef> {
        let dead = self.dead_after.get(&self.at).filter(|_| self.part.is_none());
        let over = dead.map(|dead| written_over(self.plan, step, dead));
        let over = over.unwrap_or_default();
        let bytes = |slot: &SlotRef| {
            let extent = self.extent(*slot);
            extent.map_or(0, |extent| bytes_of(self.plan.slots[*slot].format, extent))
        };
        match over.keys().map(bytes).sum::<u64>() >= self.options.writes_over_from {
            true => over,
            false => BTreeMap::new(),
        }
    }

    /// Runs a kernel of points over all tiles, band by band. Returns the time that it takes.
    pub(super) fn kernel_over(
        &mut self,
        step: &KernelStep,
        compiled: &CompiledKernel,
        block: &wgpu::Buffer,
        over: &BTreeMap<SlotRef, SlotRef>,
    ) -> Result<Duration, GpuError> {
        let surface = self.surfaces.at(step.level)?;
        let rows = band_rows(surface.extent, self.bytes_of_row(step, surface));
        let (resources, filled) = self.filled(step, over, surface, rows)?;
        let resources = resources.iter().map(wgpu::BindingResource::TextureView);
        let group = {
            let block = std::iter::once(block.as_entire_binding());
            self.gpu.bind(&compiled.layout, block.chain(resources))
        };
        let covered = self.coverages.tiles(self.at);
        let all = TileSet::all(&surface.tile_numbers);
        let tiles = covered.unwrap_or(&all);
        let mut sum = Duration::ZERO;
        for band in surface.bands(rows) {
            let tile_rows = band.rows.start / TILE..band.rows.end.div_ceil(TILE);
            let is_here = |[_, row, page]: &[u32; 3]| *page == band.layer && tile_rows.contains(row);
            let here = TileSet::new(tiles.places().filter(is_here));
            if here.count() == 0 {
                continue;
            }
            let slices = Slices::over(self.gpu, surface, &here, self.options.submission)?.into_band(&band);
            self.warm(compiled, &slices, &group)?;
            self.report.texels += super::dispatch::texels_of(here.count());
            sum += slices.run(&compiled.pipeline, &compiled.pace, &group, self.options.is_canceled)?;
            self.copy_band(&filled, &band);
        }
        for (slot, from) in over {
            self.textures[*slot] = self.textures[*from].take();
        }
        for filled in &filled {
            self.pool.discard(filled.format, &filled.band);
        }
        Ok(sum)
    }

    /// Returns the number of bytes of a row of everything that a kernel writes.
    fn bytes_of_row(&self, step: &KernelStep, surface: &GpuSurface) -> u64 {
        let written = step.writes.iter().flatten();
        let texel_bytes = |slot: &SlotRef| self.plan.slots[*slot].format.texel_bytes();
        u64::from(surface.extent[0]) * written.map(texel_bytes).sum::<u64>()
    }

    /// Returns views of the textures that a kernel reads and of the bands that it writes, and the textures to which the bands are copied.
    fn filled(
        &mut self,
        step: &KernelStep,
        over: &BTreeMap<SlotRef, SlotRef>,
        surface: &GpuSurface,
        rows: u32,
    ) -> Result<(Vec<wgpu::TextureView>, Vec<Filled>), GpuError> {
        let (mut views, mut filled) = (Vec::new(), Vec::new());
        for slot in step.reads.iter().flatten() {
            views.push(array_view(&self.texture(*slot)?));
        }
        for slot in step.writes.iter().flatten() {
            let format = self.plan.slots[*slot].format;
            let whole = self.texture(over.get(slot).copied().unwrap_or(*slot))?;
            let band = self.pool.take(self.gpu, format, [surface.extent[0], rows, 1])?;
            views.push(array_view(&band));
            filled.push(Filled { band, format, whole });
        }
        Ok((views, filled))
    }

    /// Copies a written band into place.
    fn copy_band(&self, filled: &[Filled], band: &LayerRows) {
        let descriptor = wgpu::CommandEncoderDescriptor::default();
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        for filled in filled {
            let mut place = filled.whole.as_image_copy();
            place.origin = wgpu::Origin3d {
                x: 0,
                y: band.rows.start,
                z: band.layer,
            };
            let size = wgpu::Extent3d {
                width: filled.band.width(),
                height: band.rows.len() as u32,
                depth_or_array_layers: 1,
            };
            encoder.copy_texture_to_texture(filled.band.as_image_copy(), place, size);
        }
        self.gpu.queue.submit([encoder.finish()]);
    }
}
