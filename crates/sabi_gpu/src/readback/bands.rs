//! Readback in bands of whole rows, which are passed on while they are mapped.

use std::ops::Range;

use half::f16;
use half::slice::HalfFloatSliceExt;
use sabi_nodes::link::Format;
use sabi_plan::{Plan, SlotRef};

use super::{BAND_BYTES, PendingCopy, RowBytes, StagingBuffer};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::layer_rows::LayerRows;
use crate::run_result::Run;
use crate::surface::GpuSurface;

/// Texels of a band of rows of one plane, in their storage format.
#[derive(Clone, Copy, Debug)]
pub struct BandData<'a> {
    format: Format,
    row: RowBytes,
    bytes: &'a [u8],
}

/// Number of halves that are converted at once.
const HALVES: usize = 64;

impl BandData<'_> {
    /// Copies the components of consecutive texels, counted row by row from the first texel of the band. Components that
    /// the format does not have are 0.
    pub fn copy_texels(&self, texels: Range<usize>, out: &mut [[f32; 4]]) {
        let texel_bytes = self.format.texel_bytes() as usize;
        let width = self.row.used as usize / texel_bytes;
        let (mut next, mut out) = (texels.start, out);
        while next < texels.end && !out.is_empty() {
            let (row, column) = (next / width, next % width);
            let count = (width - column).min(texels.end - next).min(out.len());
            let (part, rest) = out.split_at_mut(count);
            let start = row * self.row.padded as usize + column * texel_bytes;
            copy(&self.bytes[start..start + count * texel_bytes], self.format, part);
            (next, out) = (next + count, rest);
        }
    }
}

/// Converts stored texels to floats.
fn copy(bytes: &[u8], format: Format, out: &mut [[f32; 4]]) {
    match format {
        Format::R32Float => {
            for (texel, value) in out.iter_mut().zip(bytes.as_chunks().0) {
                *texel = [f32::from_le_bytes(*value), 0.0, 0.0, 0.0];
            }
        }
        Format::Rgba32Float => {
            for (number, value) in out.as_flattened_mut().iter_mut().zip(bytes.as_chunks().0) {
                *number = f32::from_le_bytes(*value);
            }
        }
        Format::Rgba16Float => {
            let mut halves = [f16::ZERO; HALVES];
            let parts = out.as_flattened_mut().chunks_mut(HALVES);
            for (numbers, bytes) in parts.zip(bytes.chunks(2 * HALVES)) {
                for (half, bytes) in halves.iter_mut().zip(bytes.as_chunks().0) {
                    *half = f16::from_le_bytes(*bytes);
                }
                halves[..numbers.len()].convert_to_f32_slice(numbers);
            }
        }
    }
}

/// Reads a slot of a run in bands of whole rows. Bands without texels of `texels` are left out. `visit` receives the
/// texels of each band, counted page by page and row by row, and their data. The device copies one band while another
/// is processed; no more than two are in memory.
pub fn read_slot_in_bands(
    gpu: &Gpu,
    surface: &GpuSurface,
    plan: &Plan,
    run: &Run,
    slot: SlotRef,
    texels: &Range<usize>,
    mut visit: impl FnMut(&Range<usize>, &BandData<'_>),
) -> Result<(), GpuError> {
    let (texture, format) = (run.texture(slot)?, plan.slots[slot].format);
    let row = RowBytes::of(&texture, 0)?;
    let band_rows = (BAND_BYTES / row.padded).max(1) as u32;
    let staging = [
        StagingBuffer::new(gpu, row.padded * u64::from(band_rows))?,
        StagingBuffer::new(gpu, row.padded * u64::from(band_rows))?,
    ];
    let bands = surface
        .bands(band_rows)
        .map(|band| (surface.texels_of_rows(&band), band));
    let read = bands.filter(|(of_band, _)| of_band.start < texels.end && of_band.end > texels.start);
    let mut look = |(of_band, copy, buffer): (Range<usize>, PendingCopy, &StagingBuffer)| {
        buffer.read(gpu, copy, |bytes| visit(&of_band, &BandData { format, row, bytes }))
    };
    let mut copied = None;
    for ((of_band, band), buffer) in read.zip(staging.iter().cycle()) {
        let copy = buffer.copy_rows(gpu, &texture, &band)?;
        if let Some(before) = copied.replace((of_band, copy, buffer)) {
            look(before)?;
        }
    }
    copied.map_or(Ok(()), look)?;
    staging.into_iter().for_each(StagingBuffer::free);
    Ok(())
}

/// Reads rows of a texture through a buffer and passes them to `look`.
pub(crate) fn read_rows(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    format: Format,
    rows: &LayerRows,
    staging: &StagingBuffer,
    look: impl FnOnce(&BandData<'_>),
) -> Result<(), GpuError> {
    let row = RowBytes::of(texture, rows.level)?;
    let copy = staging.copy_rows(gpu, texture, rows)?;
    staging.read(gpu, copy, |bytes| look(&BandData { format, row, bytes }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_are_copied_across_the_padding_of_rows() {
        // Two rows of three texels, each with two bytes of padding.
        let values = [0.5, -1.0, 2.0, 3.0, 4.0, -0.25_f32];
        let mut bytes = Vec::new();
        for row in values.chunks(3) {
            bytes.extend(row.iter().flat_map(|value| value.to_le_bytes()));
            bytes.extend([0xff; 2]);
        }
        let row = RowBytes { used: 12, padded: 14 };
        let band = BandData {
            format: Format::R32Float,
            row,
            bytes: &bytes,
        };
        let mut out = [[9.0; 4]; 4];
        band.copy_texels(1..5, &mut out);
        assert_eq!(out, [-1.0, 2.0, 3.0, 4.0].map(|value| [value, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn halves_are_converted_to_floats_exactly() {
        let values: Vec<f32> = (0..4 * 50).map(|at| (at as f32 - 99.0) / 8.0).collect();
        let halves = values.iter().flat_map(|value| f16::from_f32(*value).to_le_bytes());
        let bytes: Vec<u8> = halves.collect();
        let band = BandData {
            format: Format::Rgba16Float,
            row: RowBytes { used: 400, padded: 400 },
            bytes: &bytes,
        };
        let mut out = [[0.0; 4]; 47];
        band.copy_texels(3..50, &mut out);
        assert_eq!(out.as_flattened(), &values[12..]);
    }
}
