//! What went wrong, by who can mend it.

use std::fmt;

/// Kinds of failure; the command line gives each its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// What was asked makes no sense: a wrong name, type or range.
    Usage,
    /// No adapter can be used.
    NoAdapter,
    /// A file is damaged, or is not what it should be.
    BadInput,
    /// A file is not there, or cannot be read.
    MissingInput,
    /// Textures do not fit into memory, or into the budget for them; smaller ones would.
    OutOfMemory,
    /// Results cannot be written.
    CannotWrite,
    /// The user stopped it.
    Interrupted,
}

/// One or more sentences to the person who can mend it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EngineError {
    /// Which kind of failure.
    pub kind: ErrorKind,
    /// The sentences.
    pub messages: Vec<String>,
}

impl EngineError {
    /// An error of one sentence.
    pub fn new(kind: ErrorKind, message: impl fmt::Display) -> EngineError {
        EngineError {
            kind,
            messages: vec![message.to_string()],
        }
    }
}

impl fmt::Display for EngineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.messages.join("\n"))
    }
}

impl std::error::Error for EngineError {}

impl From<sabi_gpu::GpuError> for EngineError {
    fn from(error: sabi_gpu::GpuError) -> Self {
        use sabi_gpu::GpuError;
        let kind = match error {
            GpuError::Canceled => ErrorKind::Interrupted,
            GpuError::Source(_) | GpuError::Node { .. } | GpuError::TooLarge { .. } | GpuError::TooDeep { .. } => {
                ErrorKind::BadInput
            }
            GpuError::OverBudget { .. } | GpuError::OutOfMemory { .. } => ErrorKind::OutOfMemory,
            GpuError::NoAdapter
            | GpuError::NoSuchAdapter { .. }
            | GpuError::Unfit { .. }
            | GpuError::Lost(_)
            | GpuError::Kernel { .. }
            | GpuError::Driver(_) => ErrorKind::NoAdapter,
        };
        EngineError::new(kind, error)
    }
}

impl From<sabi_view::ViewError> for EngineError {
    fn from(error: sabi_view::ViewError) -> Self {
        use sabi_view::ViewError;
        match error {
            ViewError::Gpu(error) => error.into(),
            size @ ViewError::Size { .. } => EngineError::new(ErrorKind::Usage, size),
            error => EngineError::new(ErrorKind::BadInput, error),
        }
    }
}

impl From<sabi_export::ExportError> for EngineError {
    fn from(error: sabi_export::ExportError) -> Self {
        let kind = if error.is_cannot_write() {
            ErrorKind::CannotWrite
        } else {
            ErrorKind::BadInput
        };
        EngineError::new(kind, error)
    }
}

impl From<sabi_surface::load::LoadError> for EngineError {
    fn from(error: sabi_surface::load::LoadError) -> Self {
        let kind = if error.is_missing() {
            ErrorKind::MissingInput
        } else {
            ErrorKind::BadInput
        };
        EngineError::new(kind, error)
    }
}

#[cfg(test)]
mod tests {
    use sabi_gpu::GpuError;

    use super::{EngineError, ErrorKind};

    #[test]
    fn what_a_smaller_bake_would_mend_is_not_the_adapters_fault() {
        let of = |error: GpuError| EngineError::from(error).kind;
        let (needed_mib, budget_mib) = (9, 4);
        let over = GpuError::OverBudget { needed_mib, budget_mib };
        assert_eq!(of(over), ErrorKind::OutOfMemory);
        let what = "a texture".to_owned();
        assert_eq!(of(GpuError::OutOfMemory { what }), ErrorKind::OutOfMemory);
        assert_eq!(of(GpuError::NoAdapter), ErrorKind::NoAdapter);
        assert_eq!(of(GpuError::Canceled), ErrorKind::Interrupted);
    }
}
