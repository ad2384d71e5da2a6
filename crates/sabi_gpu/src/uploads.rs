//! Uploads of the atlas and its tables.

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pool::{Extent, array_view};

/// Number of table rows in one row of its texture. Every adapter allows textures that are this wide.
const TABLE_WIDTH: usize = 1 << TABLE_BITS;
/// Exponent of [`TABLE_WIDTH`].
pub(crate) const TABLE_BITS: u32 = 13;
const TABLE_ROW_BYTES: usize = 16;

pub(crate) fn storage_buffer(gpu: &Gpu, what: &'static str, bytes: u64, limit: u64) -> Result<wgpu::Buffer, GpuError> {
    let size = bytes.max(64).next_multiple_of(16);
    if size > limit {
        return Err(GpuError::TooLarge {
            what,
            needed_mib: size.div_ceil(1 << 20),
            limit_mib: limit >> 20,
        });
    }
    gpu.guarded(what, |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })
}

/// Returns the maximum number of rows of a table.
pub(crate) fn most_table_rows(gpu: &Gpu) -> usize {
    TABLE_WIDTH * gpu.device.limits().max_texture_dimension_2d as usize
}

/// Returns the size of the texture of a table, or an error if it needs more than `highest` rows.
fn table_extent(what: &'static str, rows: usize, highest: u32) -> Result<wgpu::Extent3d, GpuError> {
    let lines = rows.div_ceil(TABLE_WIDTH).max(1);
    if lines > highest as usize {
        let mib = |lines: usize| ((lines * TABLE_WIDTH * TABLE_ROW_BYTES) as u64).div_ceil(1 << 20);
        return Err(GpuError::TooLarge {
            what,
            needed_mib: mib(lines),
            limit_mib: mib(highest as usize),
        });
    }
    Ok(wgpu::Extent3d {
        width: rows.clamp(1, TABLE_WIDTH) as u32,
        height: lines as u32,
        depth_or_array_layers: 1,
    })
}

/// Uploads a table of rows of four numbers as a texture of bit patterns; see `shaders/lib/atlas.wgsl`.
pub(crate) fn table_texture(gpu: &Gpu, what: &'static str, bytes: &[u8]) -> Result<wgpu::TextureView, GpuError> {
    let rows = bytes.len() / TABLE_ROW_BYTES;
    let size = table_extent(what, rows, gpu.device.limits().max_texture_dimension_2d)?;
    let texture = gpu.guarded(what, |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some(what),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    let line = TABLE_WIDTH * TABLE_ROW_BYTES;
    let whole = bytes.len() / line;
    for (first, height, part) in [(0, whole, &bytes[..whole * line]), (whole, 1, &bytes[whole * line..])] {
        if part.is_empty() {
            continue;
        }
        let mut target = texture.as_image_copy();
        target.origin.y = first as u32;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(line as u32),
            rows_per_image: None,
        };
        let extent = wgpu::Extent3d {
            width: (part.len() / height / TABLE_ROW_BYTES) as u32,
            height: height as u32,
            depth_or_array_layers: 1,
        };
        gpu.queue.write_texture(target, part, layout, extent);
    }
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// Uploads an integer for each texel of the atlas, page by page and row by row, with as many bytes as the format has.
pub(crate) fn texel_texture(
    gpu: &Gpu,
    what: &'static str,
    format: wgpu::TextureFormat,
    [width, height, pages]: Extent,
    bytes: &[u8],
) -> Result<wgpu::TextureView, GpuError> {
    let size = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: pages,
    };
    let no_size = || GpuError::Defect(format!("texels of {format:?} have no single size"));
    let texel_bytes = format.block_copy_size(None).ok_or_else(no_size)?;
    let texture = gpu.guarded(what, |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some(what),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    gpu.queue.write_texture(
        texture.as_image_copy(),
        bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(texel_bytes * width),
            rows_per_image: Some(height),
        },
        size,
    );
    Ok(array_view(&texture))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_as_many_texture_rows_as_needed_up_to_the_adapters_limit() {
        let extent = |rows| table_extent("the triangles", rows, 8192).map(|size| [size.width, size.height]);
        assert_eq!(extent(0), Ok([1, 1]));
        assert_eq!(extent(8192), Ok([8192, 1]));
        assert_eq!(extent(8193), Ok([8192, 2]));
        assert_eq!(extent(8192 * 8192), Ok([8192, 8192]));
        let error = extent(8192 * 8192 + 1).expect_err("one line too many").to_string();
        assert!(
            error.contains("the triangles") && error.contains("1025") && error.contains("1024"),
            "{error}"
        );
    }
}
