//! Limits for the size of images that are read.

use crate::ImageError;

/// Maximum side length, pixels.
pub const MAX_SIDE: u32 = 16384;
/// Maximum size of a decoded image in bytes.
pub const MAX_DECODED_BYTES: u64 = 1 << 30;

/// Size of a decoded image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecodedSize {
    /// Size of its samples in bytes.
    pub bytes: u64,
    /// Number of pixels.
    pub pixels: u64,
}

impl DecodedSize {
    /// Returns the size of an image of `width` × `height` pixels with this many bytes each.
    pub(crate) fn of_pixels([width, height]: [u32; 2], pixel_bytes: u64) -> DecodedSize {
        let pixels = u64::from(width) * u64::from(height);
        DecodedSize {
            bytes: pixels.saturating_mul(pixel_bytes),
            pixels,
        }
    }
}

/// Rejects unsupported sizes before any memory is allocated.
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
