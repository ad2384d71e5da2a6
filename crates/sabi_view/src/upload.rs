//! Uploads of buffers, tables and textures.

use sabi_gpu::{Gpu, GpuError};

/// Columns of the texture of a table.
const TABLE_WIDTH: u32 = 1 << CHART_BITS;
/// Exponent of [`TABLE_WIDTH`].
pub(crate) const CHART_BITS: u32 = 10;

/// Uploads bytes as a buffer.
pub(crate) fn buffer_of(
    gpu: &Gpu,
    what: &'static str,
    usage: wgpu::BufferUsages,
    bytes: &[u8],
) -> Result<wgpu::Buffer, GpuError> {
    let size = (bytes.len() as u64)
        .next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT)
        .max(16);
    let limit = gpu.device().limits().max_buffer_size;
    if size > limit {
        return Err(GpuError::TooLarge {
            what,
            needed_mib: size.div_ceil(1 << 20),
            limit_mib: limit >> 20,
        });
    }
    let buffer = gpu.guarded(what, |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    gpu.queue().write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// Uploads rows of four numbers as a texture of 1024 columns; see `chart_row` in `maps.wgsl`.
pub(crate) fn table_of(gpu: &Gpu, what: &'static str, rows: &[[f32; 4]]) -> Result<wgpu::TextureView, GpuError> {
    let height = (rows.len() as u32).div_ceil(TABLE_WIDTH).max(1);
    let limit = gpu.device().limits().max_texture_dimension_2d;
    if height > limit {
        let mib = |height: u32| (u64::from(height) * u64::from(TABLE_WIDTH) * 16).div_ceil(1 << 20);
        return Err(GpuError::TooLarge {
            what,
            needed_mib: mib(height),
            limit_mib: mib(limit),
        });
    }
    let mut padded = rows.to_vec();
    padded.resize((height * TABLE_WIDTH) as usize, [0.0; 4]);
    let texture = texture(gpu, what, [TABLE_WIDTH, height, 1], wgpu::TextureFormat::Rgba32Float)?;
    write(gpu, &texture, bytemuck::cast_slice(&padded));
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// Creates a texture that can be uploaded, rendered and sampled.
pub(crate) fn texture(
    gpu: &Gpu,
    what: &'static str,
    [width, height, layers]: [u32; 3],
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    gpu.guarded(what, |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some(what),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: layers,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_DST
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    })
}

/// Fills a texture of one layer and one level.
pub(crate) fn write(gpu: &Gpu, texture: &wgpu::Texture, bytes: &[u8]) {
    // Only formats with depth and stencil have no single size, and those are never uploaded.
    let texel_bytes = texture.format().block_copy_size(None).unwrap_or(4);
    gpu.queue().write_texture(
        texture.as_image_copy(),
        bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(texture.width() * texel_bytes),
            rows_per_image: Some(texture.height()),
        },
        texture.size(),
    );
}
