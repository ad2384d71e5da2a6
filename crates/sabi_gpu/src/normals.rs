//! Kernels of tangent-space maps: normals of height and slope, and anisotropy.

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
use crate::pool::{array_view, texture};
use crate::readback::bands::BandData;
use crate::readback::{BAND_BYTES, PlaneData};
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shaders::FixedShader;
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

/// Returns the map of the normals of a run. Each normal depends on the heights around it.
pub(crate) fn normals_of(run: &Run, slots: [Option<SlotRef>; 2], surface: &GpuSurface) -> Option<MadeMap> {
    MadeMap::of(run, "normals", &slots).map(|made| made.grown(surface))
}

impl Gpu {
    /// Computes the tangent-space normals of a run's height and slope and reads them back: unit vectors, Y up, in the
    /// model's MikkTSpace frame. Those of ghosts are in the frame of their own chart.
    pub fn normals(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        height: Option<SlotRef>,
        slope: Option<SlotRef>,
        options: &RunOptions<'_>,
    ) -> Result<PlaneData, GpuError> {
        let normals = self.normal_texture(surface, run, height, slope, options)?;
        let data = self.read_texture(&normals, surface.extent, Format::Rgba32Float)?;
        run.pool.release(Format::Rgba32Float, normals);
        run.report.pool = run.pool.report();
        Ok(data)
    }

    /// Computes and reads back the normals of a run, like [`Gpu::normals`], in bands of whole rows. Bands without texels of `range` are
    /// left out. `visit` receives the texels of each band, counted page by page and row by row, and their normals.
    pub fn normals_in_bands(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slots: [Option<SlotRef>; 2],
        texels: &Range<usize>,
        options: &RunOptions<'_>,
        mut visit: impl FnMut(&Range<usize>, &BandData<'_>),
    ) -> Result<(), GpuError> {
        let format = Format::Rgba32Float;
        let width = surface.extent[0];
        let row_bytes = u64::from(width) * format.texel_bytes();
        let tile_rows = (BAND_BYTES / (row_bytes * u64::from(TILE))).max(1) as u32;
        let staging = self.readback_buffer(row_bytes * u64::from(tile_rows * TILE))?;
        for band in surface.bands(tile_rows * TILE) {
            let band_texels = surface.texels_of_rows(&band);
            if band_texels.start >= texels.end || band_texels.end <= texels.start {
                continue;
            }
            // A new texture for each band makes texels without a normal the same in all bands.
            let normals = texture(self, [width, band.rows.len() as u32, 1], format)?;
            let tiles = surface.tiles_of_rows(&band, options.shown);
            let slices = Slices::over(self, surface, &tiles, options.submission)?;
            let origin = [band.layer, band.rows.start];
            self.draw_normals(&slices, run, slots, &normals, origin, options)?;
            let rows = LayerRows::of_whole(&normals);
            self.read_rows(&normals, format, &rows, &staging, |data| visit(&band_texels, data))?;
            normals.destroy();
        }
        staging.destroy();
        run.report.pool = run.pool.report();
        Ok(())
    }

    /// Returns the tangent-space normals of a run as a texture; see [`Gpu::normals`].
    pub(crate) fn normal_texture(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        height: Option<SlotRef>,
        slope: Option<SlotRef>,
        options: &RunOptions<'_>,
    ) -> Result<wgpu::Texture, GpuError> {
        let normals = run.pool.take(self, Format::Rgba32Float, surface.extent)?;
        let slices = Slices::shown(self, surface, options.shown, options.submission)?;
        self.draw_normals(&slices, run, [height, slope], &normals, [0; 2], options)?;
        Ok(normals)
    }

    /// Returns the tangent-space normals of a run as a texture that a cache keeps. Only normals near changed texels are computed again.
    pub(crate) fn kept_normals(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        [height, slope]: [Option<SlotRef>; 2],
        options: &RunOptions<'_>,
        cache: &mut ResultCache,
    ) -> Result<wgpu::Texture, GpuError> {
        let Some(made) = normals_of(run, [height, slope], surface) else {
            return self.normal_texture(surface, run, height, slope, options);
        };
        if let Some(known) = cache.get(&made.key) {
            return Ok(known);
        }
        let before = made.before.and_then(|(key, tiles)| Some((cache.take(&key)?, tiles)));
        let normals = match before {
            Some((normals, tiles)) => {
                let slices = Slices::over(self, surface, &tiles, options.submission)?;
                self.draw_normals(&slices, run, [height, slope], &normals, [0; 2], options)?;
                normals
            }
            None => self.normal_texture(surface, run, height, slope, options)?,
        };
        cache.put(
            made.key,
            normals.clone(),
            Format::Rgba32Float.texel_bytes() * surface.texels(),
        );
        Ok(normals)
    }

    /// Computes the normals of some tiles.
    fn draw_normals(
        &self,
        slices: &Slices<'_>,
        run: &mut Run,
        [height, slope]: [Option<SlotRef>; 2],
        normals: &wgpu::Texture,
        [first_page, first_row]: [u32; 2],
        options: &RunOptions<'_>,
    ) -> Result<(), GpuError> {
        let surface = slices.surface();
        let stencils = self.stencils(surface, run, options)?;
        let entries = [
            uniform_entry(0),
            texture_entry(1),
            texture_entry(2),
            owners_entry(3),
            storage_entry(4, Format::Rgba32Float),
        ];
        let kernel = self.fixed_kernel(FixedShader::Normal, &entries)?;
        let unused = texture(self, [1, 1, 1], Format::R32Float)?;
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
        let constants = self.uniform(bytemuck::bytes_of(&values));
        let view = array_view(normals);
        let group = self.bind(
            &kernel.layout,
            [
                constants.as_entire_binding(),
                wgpu::BindingResource::TextureView(&heights),
                wgpu::BindingResource::TextureView(&slopes),
                wgpu::BindingResource::TextureView(&stencils),
                wgpu::BindingResource::TextureView(&view),
            ],
        );
        slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
        Ok(())
    }

    /// Computes the anisotropy of a run in the model's tangent frame and reads it back: the unit direction in which
    /// highlights are stretched, as two components in −1..1, and the strength.
    pub fn anisotropy(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slot: SlotRef,
        options: &RunOptions<'_>,
    ) -> Result<PlaneData, GpuError> {
        let made = self.anisotropy_texture(surface, run, slot, options)?;
        let data = self.read_texture(&made, surface.extent, Format::Rgba32Float)?;
        run.pool.release(Format::Rgba32Float, made);
        run.report.pool = run.pool.report();
        Ok(data)
    }

    /// Anisotropy of a run as a texture, see [`Gpu::anisotropy`].
    pub(crate) fn anisotropy_texture(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        slot: SlotRef,
        options: &RunOptions<'_>,
    ) -> Result<wgpu::Texture, GpuError> {
        let stencils = self.stencils(surface, run, options)?;
        let entries = [texture_entry(0), owners_entry(1), storage_entry(2, Format::Rgba32Float)];
        let kernel = self.fixed_kernel(FixedShader::Anisotropy, &entries)?;
        let scratches = array_view(&run.texture(slot)?);
        let made = run.pool.take(self, Format::Rgba32Float, surface.extent)?;
        let view = array_view(&made);
        let views = [&scratches, &stencils, &view].map(wgpu::BindingResource::TextureView);
        let group = self.bind(&kernel.layout, views);
        let slices = Slices::shown(self, surface, options.shown, options.submission)?;
        slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
        Ok(made)
    }
}
