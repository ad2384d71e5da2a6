//! Failures in JSON for scripts; docs/report.md lists the keys.

use serde::Serialize;

use crate::advice::remedies_with_flags;
use crate::exit::Failure;
use crate::failed_bake::FailedBake;

/// Failure of a command: what `--json` prints, and the report of a bake that failed.
#[derive(Debug, Serialize)]
pub(crate) struct FailureReport {
    #[serde(flatten)]
    bake: Option<Box<FailedBake>>,
    error: ErrorReport,
}

/// The error of a failure.
#[derive(Debug, Serialize)]
pub(crate) struct ErrorReport {
    kind: &'static str,
    exit: u8,
    message: String,
    /// Remedies, as phrases.
    pub(crate) remedies: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    messages: Option<Vec<String>>,
}

impl FailureReport {
    /// Describes a failure of the command with this name. The remedies name the flags of this command.
    pub(crate) fn new(failure: &Failure, command: &str) -> FailureReport {
        FailureReport {
            bake: failure.bake.clone(),
            error: ErrorReport::new(failure, command),
        }
    }
}

impl ErrorReport {
    /// Describes a failure of the command with this name. The remedies name the flags of this command.
    pub(crate) fn new(failure: &Failure, command: &str) -> ErrorReport {
        let mut remedies = remedies_with_flags(&failure.remedies, command);
        remedies.extend(failure.tips.iter().cloned());
        ErrorReport {
            kind: failure.exit.kind(),
            exit: failure.exit as u8,
            message: failure.messages.first().cloned().unwrap_or_default(), // Every failure has a sentence.
            remedies,
            messages: (failure.messages.len() > 1).then(|| failure.messages.clone()),
        }
    }
}
