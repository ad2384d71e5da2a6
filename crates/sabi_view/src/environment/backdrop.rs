//! A panorama on the device with mip levels, for small and blurred backgrounds.

use half::f16;
use half::slice::HalfFloatSliceExt;
use rayon::prelude::*;
use sabi_gpu::Gpu;

use super::panorama::Panorama;
use crate::error::ViewError;

/// Largest width: a picture shows about 40 degrees of the background.
const MAX_WIDTH: u32 = 4096;
/// Bytes of a pixel of four half floats.
pub(super) const PIXEL_BYTES: u32 = 8;

/// Mip levels of a panorama, all with the same mean radiance.
pub(super) fn levels(panorama: &Panorama) -> Vec<Panorama> {
    let (width, height) = (panorama.width(), panorama.height());
    let reduction = width.max(height).div_ceil(MAX_WIDTH);
    let mut levels = vec![panorama.reduced([width.div_ceil(reduction), height.div_ceil(reduction)])];
    while let Some(last) = levels.last()
        && last.width().max(last.height()) > 1
    {
        levels.push(last.reduced([last.width(), last.height()].map(|side| (side / 2).max(1))));
    }
    levels
}

/// Uploads mip levels as a texture.
pub(super) fn upload(gpu: &Gpu, levels: &[Panorama]) -> Result<wgpu::Texture, ViewError> {
    let extent = |level: &Panorama| wgpu::Extent3d {
        width: level.width(),
        height: level.height(),
        depth_or_array_layers: 1,
    };
    let texture = gpu.guarded("an environment", |device| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some("backdrop"),
            size: extent(&levels[0]),
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    })?;
    for (level, own) in levels.iter().enumerate() {
        gpu.queue().write_texture(
            wgpu::TexelCopyTextureInfo {
                mip_level: level as u32,
                ..texture.as_image_copy()
            },
            bytemuck::cast_slice(&half_floats(own)),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(PIXEL_BYTES * own.width()),
                rows_per_image: None,
            },
            extent(own),
        );
    }
    Ok(texture)
}

/// Pixels as bits of half floats; alpha is 1.
fn half_floats(panorama: &Panorama) -> Vec<u16> {
    let row = |pixels: &[[f32; 3]]| {
        let full: Vec<f32> = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let mut halves = vec![f16::ZERO; full.len()];
        halves.convert_from_f32_slice(&full);
        halves.into_iter().map(f16::to_bits).collect::<Vec<_>>()
    };
    panorama
        .rgb()
        .par_chunks(panorama.width() as usize)
        .flat_map_iter(row)
        .collect()
}
