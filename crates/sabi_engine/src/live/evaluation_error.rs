//! Errors that end an evaluation.

use sabi_gpu::{Gpu, GpuError};

use crate::error::{EngineError, ErrorKind};
use crate::remedy::Remedy;

/// Error that ends an evaluation.
pub(super) enum EvaluationError {
    /// A newer request is pending, or the evaluator ends.
    Superseded,
    /// The device is lost.
    Lost(EngineError),
    /// The result of a node cannot be computed. Nodes that do not need it can be evaluated.
    Node {
        node: String,
        why: String,
        /// True if the node kept the device busy for too long.
        is_too_long: bool,
    },
    /// Anything else.
    Failed(EngineError),
}

impl EvaluationError {
    /// Classifies an error of work on this device.
    pub(super) fn of(gpu: &Gpu, error: impl Into<EngineError>) -> EvaluationError {
        if let Some(loss) = gpu.loss_behind_error() {
            return EvaluationError::Lost(loss.into());
        }
        let error = error.into();
        match error.kind {
            ErrorKind::Interrupted => EvaluationError::Superseded,
            _ => EvaluationError::Failed(error),
        }
    }

    /// Classifies an error of displaying results at a size in texels per UV unit.
    pub(super) fn of_results(gpu: &Gpu, size: u32, error: EngineError) -> EvaluationError {
        if error.kind != ErrorKind::OutOfMemory {
            return EvaluationError::of(gpu, error);
        }
        let room = format!("what is shown of the graph does not fit into memory at a size of {size}");
        EvaluationError::of(gpu, out_of_memory(&room).caused_by(error))
    }

    /// Classifies an error of a run at a size in texels per UV unit.
    pub(super) fn of_run(gpu: &Gpu, size: u32, error: GpuError) -> EvaluationError {
        // On a lost device the kernel of a node cannot be made either, which is no fault of the node.
        if let Some(loss) = gpu.loss_behind_error() {
            return EvaluationError::Lost(loss.into());
        }
        let room = match &error {
            GpuError::Node { node, reason } => {
                return EvaluationError::Node {
                    node: node.clone(),
                    why: reason.clone(),
                    is_too_long: false,
                };
            }
            // A kernel for a window belongs to one node.
            GpuError::TooLong { nodes, .. } if !nodes.is_empty() => {
                return EvaluationError::Node {
                    node: nodes.join(", "),
                    why: format!("{error}; the node is left out until it is changed"),
                    is_too_long: true,
                };
            }
            GpuError::OverBudget { needed_mib, budget_mib } => format!(
                "the graph's results need {needed_mib} MiB of textures at a size of {size}, more than the budget of \
                 {budget_mib} MiB"
            ),
            GpuError::OverMemory { needed_mib, left_mib } => format!(
                "the graph's results need {needed_mib} MiB of memory at a size of {size}, and {left_mib} MiB are left for them"
            ),
            GpuError::OutOfMemory { what } => {
                format!("the device is out of memory while making {what} at a size of {size}")
            }
            _ => return EvaluationError::of(gpu, error),
        };
        EvaluationError::of(gpu, out_of_memory(&room).caused_by(error))
    }
}

/// Returns the error for results that do not fit into memory, with remedies for a window.
fn out_of_memory(what: &str) -> EngineError {
    EngineError::new(ErrorKind::OutOfMemory, what).with_remedies([Remedy::SmallerSize, Remedy::CloseOtherPrograms])
}
