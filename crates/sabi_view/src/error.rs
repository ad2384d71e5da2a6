//! What can go wrong with a view.

use sabi_gpu::GpuError;

/// An error of what is shown; never a panic.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ViewError {
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
