//! Rows of an image, with their bytes in the order of a PNG file.

use std::borrow::Cow;
use std::ops::Range;

use super::{PngData, PngOptions};

/// Rows of an image whose samples match its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    data: PngData<'a>,
    pub(super) height: usize,
    pub(super) row_bytes: usize,
    pixel_bytes: usize,
}

/// Several neighboring rows.
#[derive(Debug)]
pub(super) struct Block<'a> {
    /// Bytes of the rows, after those of the row above if there is one.
    bytes: Cow<'a, [u8]>,
    has_row_above: bool,
    /// True if these are the last rows of the image.
    pub(super) is_last: bool,
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

    /// Returns rows together with the row above them.
    pub(super) fn block(&self, rows: Range<usize>) -> Block<'a> {
        let with_above = rows.start.saturating_sub(1)..rows.end;
        Block {
            has_row_above: with_above.len() > rows.len(),
            is_last: rows.end == self.height,
            bytes: self.bytes(with_above),
            row_bytes: self.row_bytes,
            pixel_bytes: self.pixel_bytes,
        }
    }

    fn bytes(&self, rows: Range<usize>) -> Cow<'a, [u8]> {
        let place = rows.start * self.row_bytes..rows.end * self.row_bytes;
        match self.data {
            PngData::U8(samples) => Cow::Borrowed(&samples[place]),
            PngData::U16(samples) => {
                let samples = &samples[place.start / 2..place.end / 2];
                Cow::Owned(samples.iter().flat_map(|sample| sample.to_be_bytes()).collect())
            }
            PngData::Rows(fill) => {
                let mut bytes = vec![0; place.len()];
                fill(rows, &mut bytes);
                Cow::Owned(bytes)
            }
        }
    }
}

impl Block<'_> {
    /// Returns the rows from the top, each with the row above. Above the first row of the image are zeros.
    pub(super) fn rows_with_above<'b>(
        &'b self,
        zeros: &'b [u8],
    ) -> impl ExactSizeIterator<Item = (&'b [u8], &'b [u8])> {
        let before = if self.has_row_above { None } else { Some(zeros) };
        let own = self
            .bytes
            .chunks_exact(self.row_bytes)
            .skip(usize::from(self.has_row_above));
        let mut above = before.into_iter().chain(self.bytes.chunks_exact(self.row_bytes));
        own.map(move |row| (row, above.next().unwrap_or(zeros)))
    }
}
