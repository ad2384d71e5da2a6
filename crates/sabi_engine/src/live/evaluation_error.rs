//! What keeps an evaluation from its end.

use sabi_gpu::{Gpu, GpuError};

use crate::error::{EngineError, ErrorKind};

/// Why something was not evaluated.
pub(super) enum EvaluationError {
    /// A newer wish is there, or nobody wishes any more.
    Superseded,
    /// The device is gone.
    Lost(EngineError),
    /// The result of a node that is no kernel cannot be made; what does not need it can.
    Node { node: String, why: String },
    /// Anything else.
    Failed(EngineError),
}

impl EvaluationError {
    /// What an error means to whoever works on this device.
    pub(super) fn of(gpu: &Gpu, error: impl Into<EngineError>) -> EvaluationError {
        if let Some(loss) = gpu.loss() {
            return EvaluationError::Lost(loss.into());
        }
        let error = error.into();
        match error.kind {
            ErrorKind::Interrupted => EvaluationError::Superseded,
            _ => EvaluationError::Failed(error),
        }
    }

    /// The same of what is made of results on a surface of so many texels for one unit of UV.
    pub(super) fn of_results(gpu: &Gpu, size: u32, error: EngineError) -> EvaluationError {
        if error.kind != ErrorKind::OutOfMemory {
            return EvaluationError::of(gpu, error);
        }
        let room = format!("what is shown of the graph does not fit into memory at a size of {size}");
        EvaluationError::of(gpu, no_room(&room))
    }

    /// The same of a run on a surface of so many texels for one unit of UV.
    pub(super) fn of_run(gpu: &Gpu, size: u32, error: GpuError) -> EvaluationError {
        let room = match error {
            GpuError::Node { node, why } => return EvaluationError::Node { node, why },
            GpuError::OverBudget { needed_mib, budget_mib } => format!(
                "the graph's results need {needed_mib} MiB of textures at a size of {size}, more than the budget of \
                 {budget_mib} MiB"
            ),
            GpuError::OutOfMemory { what } => {
                format!("the device is out of memory while making {what} at a size of {size}")
            }
            other => return EvaluationError::of(gpu, other),
        };
        EvaluationError::of(gpu, no_room(&room))
    }
}

/// Memory is short: what is too large, and what helps in a window.
fn no_room(what: &str) -> EngineError {
    let advice = "work at a smaller size, or close other programs that use the graphics card";
    EngineError::new(ErrorKind::OutOfMemory, format!("{what}; {advice}"))
}
