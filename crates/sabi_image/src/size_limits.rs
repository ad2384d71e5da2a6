//! Largest pictures that are read.

use crate::ImageError;

/// Longest side that is read, pixels.
pub const MAX_SIDE: u32 = 16384;
/// Most bytes that a picture may take once decoded.
pub const MAX_DECODED_BYTES: u64 = 1 << 30;

/// Rejects unsupported sizes before anything is allocated for them.
pub(crate) fn check_size(name: &str, width: u64, height: u64, pixel_bytes: u64) -> Result<(), ImageError> {
    let bytes = width
        .checked_mul(height)
        .and_then(|pixels| pixels.checked_mul(pixel_bytes));
    let fits = width <= u64::from(MAX_SIDE)
        && height <= u64::from(MAX_SIDE)
        && bytes.is_some_and(|bytes| bytes <= MAX_DECODED_BYTES);
    if fits {
        Ok(())
    } else {
        Err(ImageError::TooLarge {
            name: name.into(),
            width,
            height,
        })
    }
}
