//! Rows of a picture as a PNG file orders their bytes.

use super::{PngData, PngOptions};

/// Rows of a picture whose samples fit its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    data: PngData<'a>,
    pub(super) height: usize,
    pub(super) row_bytes: usize,
    pub(super) pixel_bytes: usize,
}

impl<'a> Rows<'a> {
    pub(super) fn new(width: u32, height: u32, data: PngData<'a>, options: PngOptions) -> Rows<'a> {
        let pixel_bytes = usize::from(options.channels) * usize::from(options.bits / 8);
        Rows {
            data,
            height: height as usize,
            row_bytes: width as usize * pixel_bytes,
            pixel_bytes,
        }
    }

    /// Copies a row into `bytes`, which has its length.
    pub(super) fn copy(&self, row: usize, bytes: &mut [u8]) {
        match self.data {
            PngData::U8(samples) => bytes.copy_from_slice(&samples[row * bytes.len()..(row + 1) * bytes.len()]),
            PngData::U16(samples) => {
                let count = bytes.len() / 2;
                let source = &samples[row * count..(row + 1) * count];
                for (pair, sample) in bytes.chunks_exact_mut(2).zip(source) {
                    pair.copy_from_slice(&sample.to_be_bytes());
                }
            }
            PngData::Rows(fill) => fill(row, bytes),
        }
    }
}
