//! Kernels over only the covered tiles, in slices of about a given time.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::layer_rows::LayerRows;
use crate::pace::{MARGIN, Pace};
use crate::pass_constants::PassConstants;
use crate::shown_tiles::ShownTiles;
use crate::surface::GpuSurface;
use crate::tile_set::TileSet;
use crate::waiting::Patience;

/// Workgroups in a row of a dispatch; adapters allow 65 535.
const ROW: u32 = 32_768;

/// Tiles of a surface in slices, for the dispatches of a kernel.
pub(crate) struct Slices<'a> {
    gpu: &'a Gpu,
    surface: &'a GpuSurface,
    target: Duration,
    tile_count: u32,
    constants: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// Index of this repetition and number of repetitions.
    repetition: [u32; 2],
    /// Page and first row of the texture that is written.
    origin: [u32; 2],
}

impl<'a> Slices<'a> {
    pub(crate) fn new(gpu: &'a Gpu, surface: &'a GpuSurface, target: Duration) -> Slices<'a> {
        Slices::of(gpu, surface, &surface.tiles, surface.tile_count, target)
    }

    /// Creates slices of the shown tiles of a surface, or of all tiles if any texel may be read.
    pub(crate) fn shown(
        gpu: &'a Gpu,
        surface: &'a GpuSurface,
        shown: Option<&ShownTiles>,
        target: Duration,
    ) -> Result<Slices<'a>, GpuError> {
        match shown {
            Some(shown) => Slices::over(gpu, surface, shown.tiles(), target),
            None => Ok(Slices::new(gpu, surface, target)),
        }
    }

    /// Creates slices of only these tiles of a surface.
    pub(crate) fn over(
        gpu: &'a Gpu,
        surface: &'a GpuSurface,
        tiles: &TileSet,
        target: Duration,
    ) -> Result<Slices<'a>, GpuError> {
        let list = tiles.upload(gpu)?;
        Ok(Slices::of(gpu, surface, &list, tiles.count(), target))
    }

    fn of(
        gpu: &'a Gpu,
        surface: &'a GpuSurface,
        tiles: &wgpu::Buffer,
        tile_count: u32,
        target: Duration,
    ) -> Slices<'a> {
        let constants = gpu.uniform(&[0; size_of::<PassConstants>()]);
        let group = surface.bindings_with(gpu, tiles, &surface.ghosts.all, &constants);
        Slices {
            gpu,
            surface,
            target,
            tile_count,
            constants,
            group,
            repetition: [0, 1],
            origin: [0; 2],
        }
    }

    /// Returns the slices for kernels of points that write a band of the atlas beginning at this row.
    pub(crate) fn into_band(mut self, band: &LayerRows) -> Slices<'a> {
        self.origin = [band.layer, band.rows.start];
        self
    }

    /// Returns the slices for one of several repetitions.
    pub(crate) fn in_repetition(mut self, index: u32, count: u32) -> Slices<'a> {
        self.repetition = [index, count];
        self
    }

    /// Returns slices over the groups of a survey instead of tiles. A workgroup takes 64 groups.
    pub(crate) fn of_groups(mut self, groups: u32) -> Slices<'a> {
        self.tile_count = groups.div_ceil(64);
        self
    }

    /// Target time of a slice.
    pub(crate) fn target(&self) -> Duration {
        self.target
    }

    /// Number of tiles.
    pub(crate) fn tile_count(&self) -> u32 {
        self.tile_count
    }

    /// Runs one workgroup over no tiles, since some drivers compile a kernel at its first use.
    pub(crate) fn warm(
        &self,
        pipeline: &wgpu::ComputePipeline,
        group: &wgpu::BindGroup,
        is_canceled: &dyn Fn() -> bool,
    ) -> Result<(), GpuError> {
        self.submit(pipeline, group, 0, 0);
        self.gpu.wait_with(Patience::for_compiling(is_canceled))
    }

    /// Runs a kernel over its tiles in slices, waits for each and measures it. A kernel that is known to be quick is
    /// submitted without a wait. Returns the measured or expected time.
    pub(crate) fn run(
        &self,
        pipeline: &wgpu::ComputePipeline,
        pace: &Arc<Pace>,
        group: &wgpu::BindGroup,
        is_canceled: &dyn Fn() -> bool,
    ) -> Result<Duration, GpuError> {
        if is_canceled() {
            return Err(GpuError::Canceled);
        }
        let tiles = self.tile_count;
        if tiles == 0 {
            return Ok(Duration::ZERO);
        }
        if let Some(expected) = self.gpu.in_flight.add(pace, tiles, self.target) {
            self.submit(pipeline, group, 0, tiles);
            return Ok(expected);
        }
        let patience = Patience::for_slice(is_canceled);
        // Work that was submitted earlier must not be included in the measurement.
        self.gpu.wait_with(patience)?;
        let (mut first, mut length, mut sum) = (0, self.first_slice(pace), Duration::ZERO);
        while first < tiles {
            if is_canceled() {
                return Err(GpuError::Canceled);
            }
            let end = (first + length).min(tiles);
            let started = Instant::now();
            self.submit(pipeline, group, first, end);
            self.gpu.wait_with(patience)?;
            let taken = started.elapsed().max(Duration::from_micros(10));
            // Limits the growth to eight times the last slice, so that one quick slice does not lead to a very long one.
            let scale = (self.target.as_secs_f64() / taken.as_secs_f64()).clamp(0.125, 8.0);
            length = ((f64::from(end - first) * scale) as u32).max(1);
            first = end;
            sum += taken;
        }
        pace.measured(tiles, sum);
        Ok(sum)
    }

    /// Returns the number of tiles of the first slice: as many as the kernel is known to process in a fraction of the target time.
    fn first_slice(&self, pace: &Pace) -> u32 {
        let most = self.target.as_secs_f64() / MARGIN;
        let known = pace.seconds(1);
        known.map_or(pace.first_tiles(), |seconds| ((most / seconds) as u32).max(1))
    }

    /// Submits a kernel over a range of tiles without waiting.
    pub(crate) fn submit(
        &self,
        pipeline: &wgpu::ComputePipeline,
        group: &wgpu::BindGroup,
        first_tile: u32,
        end_tile: u32,
    ) {
        let tiles = (end_tile - first_tile).max(1);
        let row_length = tiles.min(ROW);
        let constants = PassConstants {
            first_tile,
            end_tile,
            row_length,
            size: self.surface.size as f32,
            round: self.repetition[0],
            rounds: self.repetition[1],
            texel: self.surface.measures.texel as f32,
            finest: self.surface.measures.finest as f32,
            farthest: self.surface.measures.farthest as f32,
            first_page: self.origin[0],
            first_row: self.origin[1],
            pad: 0,
        };
        self.gpu
            .queue
            .write_buffer(&self.constants, 0, bytemuck::bytes_of(&constants));
        self.dispatch(pipeline, group, [row_length, tiles.div_ceil(ROW)]);
    }

    /// Submits workgroups with the surface bound, without waiting.
    pub(crate) fn dispatch(&self, pipeline: &wgpu::ComputePipeline, group: &wgpu::BindGroup, [x, y]: [u32; 2]) {
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_bind_group(1, group, &[]);
            pass.dispatch_workgroups(x, y, 1);
        }
        self.gpu.queue.submit([encoder.finish()]);
    }
}
