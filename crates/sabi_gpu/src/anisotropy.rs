//! Anisotropy in the model's tangent frame.

use sabi_nodes::link::Format;
use sabi_plan::SlotRef;

use crate::bindings::{owners_entry, storage_entry, texture_entry};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::readback::{PlaneData, read_texture};
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shaders::FixedShader;
use crate::stencils::stencils;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

/// Computes the anisotropy of a run in the model's tangent frame and reads it back: the unit direction in which
/// highlights are stretched, as two components in −1..1, and the strength.
pub fn read_anisotropy(
    gpu: &Gpu,
    surface: &GpuSurface,
    run: &mut Run,
    slot: SlotRef,
    options: &RunOptions<'_>,
) -> Result<PlaneData, GpuError> {
    let made = anisotropy_texture(gpu, surface, run, slot, options)?;
    let data = read_texture(gpu, &made, surface.extent, Format::Rgba32Float)?;
    run.pool.release(Format::Rgba32Float, made);
    run.report.pool = run.pool.report();
    Ok(data)
}

/// Anisotropy of a run as a texture, see [`read_anisotropy`].
pub(crate) fn anisotropy_texture(
    gpu: &Gpu,
    surface: &GpuSurface,
    run: &mut Run,
    slot: SlotRef,
    options: &RunOptions<'_>,
) -> Result<wgpu::Texture, GpuError> {
    let stencils = stencils(gpu, surface, run, options)?;
    let entries = [texture_entry(0), owners_entry(1), storage_entry(2, Format::Rgba32Float)];
    let kernel = fixed_kernel(gpu, FixedShader::Anisotropy, &entries)?;
    let scratches = array_view(&run.texture(slot)?);
    let made = run.pool.take(gpu, Format::Rgba32Float, surface.extent)?;
    let view = array_view(&made);
    let views = [&scratches, &stencils, &view].map(wgpu::BindingResource::TextureView);
    let group = gpu.bind(&kernel.layout, views);
    let slices = Slices::shown(gpu, surface, options.shown, options.submission)?;
    slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
    Ok(made)
}
