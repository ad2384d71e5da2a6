//! A prefiltered cube map as bytes and back.

use std::sync::mpsc::channel;

use half::f16;
use sabi_gpu::{Gpu, GpuError};

use super::backdrop::PIXEL_BYTES;
use super::prefilter::{LEVELS, cube, side_of};
use crate::error::ViewError;

/// Bytes of the six faces of a level.
fn level_bytes(level: u32) -> usize {
    (6 * side_of(level) * side_of(level) * PIXEL_BYTES) as usize
}

/// Bytes of all levels.
fn all_bytes() -> usize {
    (0..LEVELS).map(level_bytes).sum()
}

fn extent(level: u32) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width: side_of(level),
        height: side_of(level),
        depth_or_array_layers: 6,
    }
}

fn at_level(cube: &wgpu::Texture, level: u32) -> wgpu::TexelCopyTextureInfo<'_> {
    wgpu::TexelCopyTextureInfo {
        mip_level: level,
        ..cube.as_image_copy()
    }
}

/// The cube map of these bytes, which are looked at first: whoever kept them may have kept something else.
pub(super) fn upload(gpu: &Gpu, bytes: &[u8]) -> Result<wgpu::Texture, ViewError> {
    if bytes.len() != all_bytes() {
        let why = format!("it has {} bytes instead of {}", bytes.len(), all_bytes());
        return Err(ViewError::Prefiltered(why));
    }
    let is_light = |half: &[u8; 2]| {
        let value = f16::from_le_bytes(*half);
        value.is_finite() && value >= f16::ZERO
    };
    if !bytes.as_chunks::<2>().0.iter().all(is_light) {
        return Err(ViewError::Prefiltered("it holds what is no light".to_owned()));
    }
    let cube = cube(gpu, "prefiltered environment", LEVELS)?;
    let mut rest = bytes;
    for level in 0..LEVELS {
        let (own, further) = rest.split_at(level_bytes(level));
        rest = further;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(PIXEL_BYTES * side_of(level)),
            rows_per_image: Some(side_of(level)),
        };
        gpu.queue()
            .write_texture(at_level(&cube, level), own, layout, extent(level));
    }
    Ok(cube)
}

/// The bytes of all levels; waits for the device.
pub(super) fn read(gpu: &Gpu, cube: &wgpu::Texture) -> Result<Vec<u8>, ViewError> {
    let mut bytes = Vec::with_capacity(all_bytes());
    for level in 0..LEVELS {
        read_level(gpu, cube, level, &mut bytes)?;
    }
    Ok(bytes)
}

fn read_level(gpu: &Gpu, cube: &wgpu::Texture, level: u32, bytes: &mut Vec<u8>) -> Result<(), ViewError> {
    let row = PIXEL_BYTES * side_of(level);
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.guarded("a readback buffer", |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(6 * side_of(level) * padded),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    })?;
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(padded),
        rows_per_image: Some(side_of(level)),
    };
    let target = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(at_level(cube, level), target, extent(level));
    gpu.queue().submit([encoder.finish()]);
    let (sender, answer) = channel();
    // The receiver is gone only if the wait has failed already.
    buffer.map_async(wgpu::MapMode::Read, .., move |mapped| drop(sender.send(mapped)));
    gpu.wait()?;
    let failed = |why: &str| GpuError::Driver(format!("an environment cannot be read back: {why}"));
    match answer.try_recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(failed(&error.to_string()).into()),
        Err(_) => return Err(failed("no answer came").into()),
    }
    let view = buffer.get_mapped_range(..);
    for line in view.chunks_exact(padded as usize) {
        bytes.extend_from_slice(&line[..row as usize]);
    }
    Ok(())
}
