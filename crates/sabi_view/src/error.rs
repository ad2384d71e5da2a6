//! What can go wrong with a view.

use sabi_gpu::GpuError;

/// An error of what is shown; never a panic.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ViewError {
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Width and height of an environment do not fit its pixels, or there are none.
    #[error(
        "an environment of {width} × {height} pixels cannot be made of {given}; it needs at least one, and as many as its \
         sides say"
    )]
    Panorama {
        /// Pixels across, as given.
        width: u32,
        /// Pixels down, as given.
        height: u32,
        /// Pixels there are.
        given: u64,
    },
    /// What was kept of an environment is not what this program keeps.
    #[error("the prefiltered environment is damaged ({0}); make it anew from its picture")]
    Prefiltered(String),
    /// A picture without pixels, or with too many.
    #[error("a picture of {width} × {height} pixels cannot be drawn; each side has 1 to {longest} pixels")]
    Size {
        /// Asked for.
        width: u32,
        /// Asked for.
        height: u32,
        /// The most that the adapter allows.
        longest: u32,
    },
}
