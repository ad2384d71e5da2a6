//! Map of the texels from which slopes are computed. `stencil.wgsl` finds them, and `stencil_marks.wgsl` defines how they are stored.

use crate::bindings::marks_entry;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipelines::fixed_kernel;
use crate::pool::array_view;
use crate::run_options::RunOptions;
use crate::run_result::Run;
use crate::shaders::FixedShader;
use crate::surface::GpuSurface;
use crate::tiles::Slices;

/// Returns the map of the texels from which slopes are computed on a surface. It is created at its first use.
pub(crate) fn stencils(
    gpu: &Gpu,
    surface: &GpuSurface,
    run: &mut Run,
    options: &RunOptions<'_>,
) -> Result<wgpu::TextureView, GpuError> {
    if let Some(stencils) = surface.stencils.get() {
        return Ok(stencils.clone());
    }
    run.pool.count(surface.stencil_bytes())?;
    let [width, height, pages] = surface.extent;
    let made = gpu.guarded("the map of stencils", |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some("stencils"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: pages,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
            view_formats: &[],
        })
    })?;
    let view = array_view(&made);
    let kernel = fixed_kernel(gpu, FixedShader::Stencil, &[marks_entry(0)])?;
    let group = gpu.bind(&kernel.layout, [wgpu::BindingResource::TextureView(&view)]);
    let slices = Slices::over(gpu, surface, &surface.ghost_tiles, options.submission)?;
    slices.run(&kernel.pipeline, &kernel.pace, &group, options.is_canceled)?;
    Ok(surface.stencils.get_or_init(|| view).clone())
}
