//! A prefiltered cube map as bytes and back.

use half::f16;
use sabi_gpu::{Gpu, read_layer};

use super::backdrop::PIXEL_BYTES;
use super::prefilter::{LEVELS, cube};
use crate::error::ViewError;

/// Bytes of the six faces of a level with this side.
fn level_bytes(side: u32) -> usize {
    (6 * side * side * PIXEL_BYTES) as usize
}

fn extent(side: u32) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width: side,
        height: side,
        depth_or_array_layers: 6,
    }
}

fn at_level(cube: &wgpu::Texture, level: u32) -> wgpu::TexelCopyTextureInfo<'_> {
    wgpu::TexelCopyTextureInfo {
        mip_level: level,
        ..cube.as_image_copy()
    }
}

/// Uploads a cube map. Returns an error if the number of bytes does not match.
pub(super) fn upload(gpu: &Gpu, side: u32, bytes: &[u8]) -> Result<wgpu::Texture, ViewError> {
    let expected: usize = (0..LEVELS).map(|level| level_bytes(side >> level)).sum();
    if bytes.len() != expected {
        let why = format!("it has {} bytes instead of {expected}", bytes.len());
        return Err(ViewError::Prefiltered(why));
    }
    let is_light = |half: &[u8; 2]| {
        let value = f16::from_le_bytes(*half);
        value.is_finite() && value >= f16::ZERO
    };
    if !bytes.as_chunks::<2>().0.iter().all(is_light) {
        return Err(ViewError::Prefiltered("it holds what is no light".to_owned()));
    }
    let cube = cube(gpu, "prefiltered environment", side, LEVELS)?;
    let mut rest = bytes;
    for level in 0..LEVELS {
        let side = side >> level;
        let (own, further) = rest.split_at(level_bytes(side));
        rest = further;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(PIXEL_BYTES * side),
            rows_per_image: Some(side),
        };
        gpu.queue()
            .write_texture(at_level(&cube, level), own, layout, extent(side));
    }
    Ok(cube)
}

/// Reads all levels back.
pub(super) fn read(gpu: &Gpu, cube: &wgpu::Texture) -> Result<Vec<u8>, ViewError> {
    let mut bytes = Vec::new();
    for level in 0..cube.mip_level_count() {
        for face in 0..cube.depth_or_array_layers() {
            read_layer(gpu, cube, face, level, &mut bytes)?;
        }
    }
    Ok(bytes)
}
