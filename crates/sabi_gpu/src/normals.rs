//! Tangent-space normals of height and slope.

use std::ops::Range;

use sabi_nodes::link::Format;
use sabi_nodes::wgsl_struct;
use sabi_plan::SlotRef;
use sabi_surface::atlas::TILE;

use crate::bindings::{owners_entry, storage_entry, texture_entry, uniform_entry};
use crate::cache::ResultCache;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::layer_rows::LayerRows;
use crate::made_map::MadeMap;
use crate::pipelines::fixed_kernel;
use crate::pool::{array_view, texture};
use crate::readback::bands::{BandData, read_rows};
use crate::readback::{BAND_BYTES, PlaneData, RowBytes, StagingBuffer, read_texture};
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shaders::FixedShader;
use crate::stencils::stencils;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

wgsl_struct! {
    "surface/normal" Relief:
    /// Inputs that a normal is computed from.
    pub(crate) struct NormalConstants {
        has_height: u32,
        has_slope: u32,
        /// Page and first row of the written map, if it is a band of the atlas.
        first_page: u32,
        first_row: u32,
    }
}

/// Tangent-space normals of the height and slope of a run: unit vectors, Y up, in the model's MikkTSpace frame. Those of
/// ghosts are in the frame of their own chart.
#[derive(Clone, Copy)]
pub struct Normals<'a> {
    /// Device of the run.
    pub gpu: &'a Gpu,
    /// Surface of the run.
    pub surface: &'a GpuSurface,
    /// Slot of the height, working units; `None` for a flat one.
    pub height: Option<SlotRef>,
    /// Slot of the slope; `None` for none beside that of the height.
    pub slope: Option<SlotRef>,
    /// Options of the run.
    pub options: &'a RunOptions<'a>,
}

impl Normals<'_> {
    /// Slots of height and slope.
    pub(crate) fn slots(&self) -> [Option<SlotRef>; 2] {
        [self.height, self.slope]
    }

    /// Computes the normals and reads them back.
    pub fn read(&self, run: &mut Run) -> Result<PlaneData, GpuError> {
        let normals = self.texture(run)?;
        let data = read_texture(self.gpu, &normals, self.surface.extent, Format::Rgba32Float)?;
        run.pool.release(Format::Rgba32Float, normals);
        run.report.pool = run.pool.report();
        Ok(data)
    }

    /// Computes the normals and reads them back in bands of whole rows. Bands without texels of `texels` are left out. `visit` receives
    /// the texels of each band, counted page by page and row by row, and their normals.
    pub fn read_in_bands(
        &self,
        run: &mut Run,
        texels: &Range<usize>,
        mut visit: impl FnMut(&Range<usize>, &BandData<'_>),
    ) -> Result<(), GpuError> {
        let Normals {
            gpu, surface, options, ..
        } = *self;
        let format = Format::Rgba32Float;
        let width = surface.extent[0];
        let row = RowBytes::of_texels(width, format.texel_bytes());
        let tile_rows = (BAND_BYTES / (row.padded * u64::from(TILE))).max(1) as u32;
        let staging = StagingBuffer::new(gpu, row.padded * u64::from(tile_rows * TILE))?;
        for band in surface.bands(tile_rows * TILE) {
            let band_texels = surface.texels_of_rows(&band);
            if band_texels.start >= texels.end || band_texels.end <= texels.start {
                continue;
            }
            // A new texture for each band makes texels without a normal the same in all bands.
            let normals = texture(gpu, [width, band.rows.len() as u32, 1], format)?;
            let tiles = surface.tiles_of_rows(&band, options.shown);
            let slices = Slices::over(gpu, surface, &tiles, options.submission)?;
            let origin = [band.layer, band.rows.start];
            self.draw(&slices, run, &normals, origin)?;
            let rows = LayerRows::of_whole(&normals);
            read_rows(gpu, &normals, format, &rows, &staging, |data| visit(&band_texels, data))?;
            normals.destroy();
        }
        staging.free();
        run.report.pool = run.pool.report();
        Ok(())
    }

    /// Computes the normals as a texture.
    pub(crate) fn texture(&self, run: &mut Run) -> Result<wgpu::Texture, GpuError> {
        let normals = run.pool.take(self.gpu, Format::Rgba32Float, self.surface.extent)?;
        let slices = Slices::shown(self.gpu, self.surface, self.options.shown, self.options.submission)?;
        self.draw(&slices, run, &normals, [0; 2])?;
        Ok(normals)
    }

    /// Returns the normals as a texture that a cache keeps. Only normals near changed texels are computed again.
    pub(crate) fn kept(&self, run: &mut Run, cache: &mut ResultCache) -> Result<wgpu::Texture, GpuError> {
        // Each normal depends on the heights around it.
        let made = MadeMap::of(run, "normals", &self.slots()).map(|made| made.grown(self.surface));
        let Some(made) = made else {
            return self.texture(run);
        };
        if let Some(known) = cache.get(&made.key) {
            return Ok(known);
        }
        let before = made.before.and_then(|(key, tiles)| Some((cache.take(&key)?, tiles)));
        let normals = match before {
            Some((normals, tiles)) => {
                let slices = Slices::over(self.gpu, self.surface, &tiles, self.options.submission)?;
                self.draw(&slices, run, &normals, [0; 2])?;
                normals
            }
            None => self.texture(run)?,
        };
        cache.put(
            made.key,
            normals.clone(),
            Format::Rgba32Float.texel_bytes() * self.surface.texels(),
        );
        Ok(normals)
    }

    /// Computes the normals of some tiles into a texture that begins at this page and row.
    fn draw(
        &self,
        slices: &Slices<'_>,
        run: &mut Run,
        normals: &wgpu::Texture,
        [first_page, first_row]: [u32; 2],
    ) -> Result<(), GpuError> {
        let (gpu, [height, slope]) = (self.gpu, self.slots());
        let stencils = stencils(gpu, self.surface, run, self.options)?;
        let entries = [
            uniform_entry(0),
            texture_entry(1),
            texture_entry(2),
            owners_entry(3),
            storage_entry(4, Format::Rgba32Float),
        ];
        let kernel = fixed_kernel(gpu, FixedShader::Normal, &entries)?;
        let unused = texture(gpu, [1, 1, 1], Format::R32Float)?;
        let bound = |slot: Option<SlotRef>| match slot {
            Some(slot) => Ok::<_, GpuError>(array_view(&run.texture(slot)?)),
            // The kernel does not read the texture of a missing input.
            None => Ok(array_view(&unused)),
        };
        let (heights, slopes) = (bound(height)?, bound(slope)?);
        let values = NormalConstants {
            has_height: u32::from(height.is_some()),
            has_slope: u32::from(slope.is_some()),
            first_page,
            first_row,
        };
        let constants = gpu.uniform(bytemuck::bytes_of(&values));
        let view = array_view(normals);
        let group = gpu.bind(
            &kernel.layout,
            [
                constants.as_entire_binding(),
                wgpu::BindingResource::TextureView(&heights),
                wgpu::BindingResource::TextureView(&slopes),
                wgpu::BindingResource::TextureView(&stencils),
                wgpu::BindingResource::TextureView(&view),
            ],
        );
        slices.run(&kernel.pipeline, &kernel.pace, &group, self.options.is_canceled)?;
        Ok(())
    }
}
