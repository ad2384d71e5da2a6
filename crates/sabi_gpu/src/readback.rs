//! Readback of textures and buffers.

pub(crate) mod bands;

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use half::f16;
use sabi_nodes::link::Format;
use sabi_plan::{Plan, SlotRef};

use crate::device::Gpu;
use crate::error::GpuError;
use crate::formats::format_of;
use crate::layer_rows::LayerRows;
use crate::pool::Extent;
use crate::run_result::Run;
use crate::surface::GpuSurface;

/// Maximum time between the end of the device's work and the call of a mapping callback.
const ANSWER_LIMIT: Duration = Duration::from_secs(30);

/// Texels of one plane in their storage format, page by page and row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneData {
    format: Format,
    bytes: Vec<u8>,
}

impl PlaneData {
    /// Number of texels.
    pub fn len(&self) -> usize {
        self.bytes.len() / self.format.texel_bytes() as usize
    }

    /// Returns true if there are no texels.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Stored bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the components of a texel. Components that the format does not have are 0.
    #[inline]
    pub fn texel(&self, index: usize) -> [f32; 4] {
        let size = self.format.texel_bytes() as usize;
        let bytes = &self.bytes[index * size..][..size];
        // The `const` conversion does not detect features of the processor at each call.
        let half = |at: usize| f16::from_le_bytes([bytes[2 * at], bytes[2 * at + 1]]).to_f32_const();
        let full =
            |at: usize| f32::from_le_bytes([bytes[4 * at], bytes[4 * at + 1], bytes[4 * at + 2], bytes[4 * at + 3]]);
        match self.format {
            Format::R32Float => [full(0), 0.0, 0.0, 0.0],
            Format::Rgba16Float => [half(0), half(1), half(2), half(3)],
            Format::Rgba32Float => [full(0), full(1), full(2), full(3)],
        }
    }
}

/// Number of bytes that are read back at once, unless a single row has more.
pub(crate) const BAND_BYTES: u64 = 16 << 20;

/// Copy into a [`StagingBuffer`] that the device may not have finished.
pub(crate) struct PendingCopy {
    submitted: wgpu::SubmissionIndex,
    bytes: u64,
    answer: Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// Mappable buffer through which bytes are read back, one copy at a time.
pub(crate) struct StagingBuffer {
    buffer: wgpu::Buffer,
}

impl StagingBuffer {
    pub(crate) fn new(gpu: &Gpu, bytes: u64) -> Result<StagingBuffer, GpuError> {
        let buffer = gpu.guarded("a readback buffer", |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: bytes,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        })?;
        Ok(StagingBuffer { buffer })
    }

    /// Submits a copy of the first bytes of a buffer without waiting.
    pub(crate) fn copy_buffer(&self, gpu: &Gpu, source: &wgpu::Buffer, bytes: u64) -> PendingCopy {
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(source, 0, &self.buffer, 0, bytes);
        self.pending(gpu.queue.submit([encoder.finish()]), bytes)
    }

    /// Submits a copy of rows of a texture of uncompressed pixels without waiting.
    pub(crate) fn copy_rows(
        &self,
        gpu: &Gpu,
        texture: &wgpu::Texture,
        rows: &LayerRows,
    ) -> Result<PendingCopy, GpuError> {
        let padded = RowBytes::of(texture, rows.level)?.padded;
        let height = rows.rows.len() as u32;
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut source = texture.as_image_copy();
        source.origin = wgpu::Origin3d {
            x: 0,
            y: rows.rows.start,
            z: rows.layer,
        };
        source.mip_level = rows.level;
        encoder.copy_texture_to_buffer(
            source,
            wgpu::TexelCopyBufferInfo {
                buffer: &self.buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded as u32),
                    rows_per_image: Some(height),
                },
            },
            wgpu::Extent3d {
                width: (texture.width() >> rows.level).max(1),
                height,
                depth_or_array_layers: 1,
            },
        );
        let submitted = gpu.queue.submit([encoder.finish()]);
        Ok(self.pending(submitted, padded * u64::from(height)))
    }

    /// Requests the mapping of the first bytes after a submission.
    fn pending(&self, submitted: wgpu::SubmissionIndex, bytes: u64) -> PendingCopy {
        let (sender, answer) = channel();
        // The receiver has been dropped only if waiting failed before.
        self.buffer
            .map_async(wgpu::MapMode::Read, ..bytes, move |mapped| drop(sender.send(mapped)));
        PendingCopy {
            submitted,
            bytes,
            answer,
        }
    }

    /// Waits for a copy into this buffer, but for no later submission, and calls `look` with its bytes.
    pub(crate) fn read<T>(&self, gpu: &Gpu, copy: PendingCopy, look: impl FnOnce(&[u8]) -> T) -> Result<T, GpuError> {
        gpu.wait_for(copy.submitted)?;
        // If several threads wait for one device, another thread may be running the callback now.
        mapped(copy.answer.recv_timeout(ANSWER_LIMIT))?;
        let view = self.buffer.get_mapped_range(..copy.bytes);
        let seen = look(&view);
        drop(view);
        self.buffer.unmap();
        Ok(seen)
    }

    /// Frees the memory now, since the next buffer may be created before the device would free this one.
    pub(crate) fn free(self) {
        self.buffer.destroy();
    }
}

/// Converts the answer to a mapping request once the device is done.
fn mapped(answer: Result<Result<(), wgpu::BufferAsyncError>, RecvTimeoutError>) -> Result<(), GpuError> {
    match answer {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(GpuError::Driver(format!("a result cannot be read back: {error}"))),
        Err(_) => Err(GpuError::Driver(
            "a result cannot be read back: no answer came".to_owned(),
        )),
    }
}

/// Reads a slot of a run.
pub fn read_slot(
    gpu: &Gpu,
    surface: &GpuSurface,
    plan: &Plan,
    run: &Run,
    slot: SlotRef,
) -> Result<PlaneData, GpuError> {
    read_texture(gpu, &run.texture(slot)?, surface.extent, plan.slots[slot].format)
}

/// Reads a whole texture.
pub(crate) fn read_texture(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    [width, height, pages]: Extent,
    format: Format,
) -> Result<PlaneData, GpuError> {
    let texels = u64::from(width) * u64::from(height) * u64::from(pages);
    let mut bytes = Vec::with_capacity((texels * format.texel_bytes()) as usize);
    for page in 0..pages {
        read_layer(gpu, texture, page, 0, &mut bytes)?;
    }
    Ok(PlaneData { format, bytes })
}

/// Reads the texels of a texture on the atlas, page by page and row by row.
pub fn read_texels(gpu: &Gpu, texture: &wgpu::Texture) -> Result<PlaneData, GpuError> {
    let extent = [texture.width(), texture.height(), texture.depth_or_array_layers()];
    read_texture(gpu, texture, extent, format_of(texture)?)
}

/// Reads the texels of an R32 float texture, page by page and row by row.
pub fn read_numbers(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<f32>, GpuError> {
    if texture.format() != wgpu::TextureFormat::R32Float {
        let reason = "numbers were to be read from a texture of another format";
        return Err(GpuError::Defect(reason.into()));
    }
    let plane = read_texels(gpu, texture)?;
    let (numbers, _) = plane.bytes.as_chunks::<4>();
    Ok(numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
}

/// Appends one layer of one level of a texture of uncompressed pixels to `bytes`, row by row without padding.
pub fn read_layer(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    layer: u32,
    level: u32,
    bytes: &mut Vec<u8>,
) -> Result<(), GpuError> {
    let height = (texture.height() >> level).max(1);
    let row_bytes = u64::from((texture.width() >> level).max(1)) * u64::from(texel_bytes_of(texture)?);
    let rows = (BAND_BYTES / row_bytes).clamp(1, u64::from(height)) as u32;
    for first in (0..height).step_by(rows as usize) {
        let rows = first..(first + rows).min(height);
        append_rows(gpu, texture, LayerRows { layer, level, rows }, bytes)?;
    }
    Ok(())
}

/// Appends rows of a texture of uncompressed pixels, without padding.
fn append_rows(gpu: &Gpu, texture: &wgpu::Texture, rows: LayerRows, bytes: &mut Vec<u8>) -> Result<(), GpuError> {
    let row = RowBytes::of(texture, rows.level)?;
    let staging = StagingBuffer::new(gpu, row.padded * rows.rows.len() as u64)?;
    let copy = staging.copy_rows(gpu, texture, &rows)?;
    staging.read(gpu, copy, |mapped| {
        for line in mapped.chunks_exact(row.padded as usize) {
            bytes.extend_from_slice(&line[..row.used as usize]);
        }
    })?;
    staging.free();
    Ok(())
}

/// Sizes of a row of texels in bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowBytes {
    used: u64,
    /// Size with the padding that a copy to a buffer adds.
    pub(crate) padded: u64,
}

impl RowBytes {
    /// Returns the sizes for a level of a texture of uncompressed pixels.
    fn of(texture: &wgpu::Texture, level: u32) -> Result<RowBytes, GpuError> {
        let width = (texture.width() >> level).max(1);
        Ok(RowBytes::of_texels(width, u64::from(texel_bytes_of(texture)?)))
    }

    /// Returns the sizes for a number of texels.
    pub(crate) fn of_texels(width: u32, texel_bytes: u64) -> RowBytes {
        let used = u64::from(width) * texel_bytes;
        RowBytes {
            used,
            padded: used.next_multiple_of(u64::from(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)),
        }
    }
}

/// Bytes of a texel of a texture of uncompressed pixels.
fn texel_bytes_of(texture: &wgpu::Texture) -> Result<u32, GpuError> {
    let format = texture.format();
    let no_size = || GpuError::Defect(format!("texels of {format:?} have no single size"));
    format.block_copy_size(None).ok_or_else(no_size)
}

#[cfg(test)]
mod tests {
    use super::{RecvTimeoutError, mapped};

    #[test]
    fn a_buffer_that_cannot_be_mapped_is_an_error_and_no_panic() {
        assert_eq!(mapped(Ok(Ok(()))), Ok(()));
        let told = "a result cannot be read back";
        for answer in [Ok(Err(wgpu::BufferAsyncError)), Err(RecvTimeoutError::Timeout)] {
            let error = mapped(answer).expect_err("nothing is mapped").to_string();
            assert!(error.contains(told), "{error}");
        }
    }
}
