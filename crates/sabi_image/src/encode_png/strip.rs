//! Strips of rows, each filtered and deflated separately.

use zlib_rs::adler32::adler32;
use zlib_rs::{Deflate, DeflateConfig, DeflateFlush, Status, Strategy, compress_bound};

use super::filter::filter_rows;
use super::method::{Matches, Method};
use super::rows::Block;

/// A part of the zlib stream.
#[derive(Debug)]
pub(super) struct Strip {
    pub(super) deflated: Vec<u8>,
    /// Checksum of the chunk.
    pub(super) crc: u32,
    /// Checksum of the filtered rows.
    pub(super) adler: u32,
    pub(super) filtered_bytes: u64,
}

/// Bytes reserved for the end of a strip.
const FLUSH_BYTES: usize = 64;
/// Window parameter: deflate without header and checksum, 32 KiB.
const RAW_WINDOW: i32 = -15;
/// Compression level, 0..9.
const LEVEL: i32 = 3;

impl Strip {
    /// Compresses rows; `None` if the compressor fails. The last rows of the image end the stream, others end at a byte boundary.
    pub(super) fn new(block: &Block<'_>, method: Method) -> Option<Strip> {
        let filtered = filter_rows(block, method.filter);
        Some(Strip {
            deflated: deflate(&filtered, method.matches, block.is_last)?,
            crc: 0,
            adler: adler32(1, &filtered),
            filtered_bytes: filtered.len() as u64,
        })
    }
}

fn deflate(bytes: &[u8], matches: Matches, is_last: bool) -> Option<Vec<u8>> {
    let strategy = match matches {
        Matches::Runs => Strategy::Rle,
        Matches::Any => Strategy::Default,
    };
    let mut deflate = Deflate::new_with_config(DeflateConfig {
        level: LEVEL,
        window_bits: RAW_WINDOW,
        strategy,
        ..DeflateConfig::default()
    });
    let mut out = vec![0; compress_bound(bytes.len()) + FLUSH_BYTES];
    let flush = if is_last {
        DeflateFlush::Finish
    } else {
        DeflateFlush::SyncFlush
    };
    let status = deflate.compress(bytes, &mut out, flush).ok()?;
    let (read, written) = (deflate.total_in(), deflate.total_out() as usize);
    // A flush is complete if it did not fill the output.
    let is_complete = status == Status::StreamEnd || (!is_last && written < out.len());
    out.truncate(written);
    out.shrink_to_fit();
    (is_complete && read == bytes.len() as u64).then_some(out)
}
