//! A prefiltered cube map as bytes and back.

use std::sync::mpsc::channel;
use std::time::Duration;

use half::f16;
use sabi_gpu::{Gpu, GpuError};

use super::backdrop::PIXEL_BYTES;
use super::prefilter::{LEVELS, cube};
use crate::error::ViewError;

/// The device is done by then, and only its answer is on its way: what takes longer never comes.
const ANSWER_LIMIT: Duration = Duration::from_secs(30);

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

/// The cube map of these bytes, which are looked at first: whoever kept them may have kept something else.
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

/// The bytes of all levels; waits for the device.
pub(super) fn read(gpu: &Gpu, cube: &wgpu::Texture) -> Result<Vec<u8>, ViewError> {
    let mut bytes = Vec::new();
    for level in 0..cube.mip_level_count() {
        read_level(gpu, cube, level, &mut bytes)?;
    }
    Ok(bytes)
}

fn read_level(gpu: &Gpu, cube: &wgpu::Texture, level: u32, bytes: &mut Vec<u8>) -> Result<(), ViewError> {
    let side = cube.width() >> level;
    let row = PIXEL_BYTES * side;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.guarded("a readback buffer", |device| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(6 * side * padded),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    })?;
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(padded),
        rows_per_image: Some(side),
    };
    let target = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(at_level(cube, level), target, extent(side));
    gpu.queue().submit([encoder.finish()]);
    let (sender, answer) = channel();
    // The receiver is gone only if the wait has failed already.
    buffer.map_async(wgpu::MapMode::Read, .., move |mapped| drop(sender.send(mapped)));
    gpu.wait()?;
    let failed = |why: &str| GpuError::Driver(format!("an environment cannot be read back: {why}"));
    // Where several threads wait for one device, another one of them may be about to pass on the answer.
    match answer.recv_timeout(ANSWER_LIMIT) {
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
