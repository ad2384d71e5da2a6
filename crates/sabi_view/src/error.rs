//! Errors of the viewport.

use sabi_gpu::GpuError;

/// Error of the viewport.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ViewError {
    /// Error of the device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Width and height of an environment do not match its number of pixels, or are 0.
    #[error(
        "an environment of {width} × {height} pixels cannot be made of {given}; it needs at least one, and as many as its \
         sides say"
    )]
    Panorama {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
        /// Number of pixels given.
        given: u64,
    },
    /// The stored bytes of an environment are not in this program's format.
    #[error("the prefiltered environment is damaged ({0}); prefilter its picture again")]
    Prefiltered(String),
    /// A picture has no pixels, or too many.
    #[error("a picture of {width} × {height} pixels cannot be drawn; each side has 1 to {longest} pixels")]
    Size {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
        /// Longest side that the adapter allows, in pixels.
        longest: u32,
    },
}
