//! Failures in JSON for scripts; docs/report.md lists the keys.

use schemars::JsonSchema;
use serde::Serialize;

use crate::advice::remedies_with_flags;
use crate::exit::Failure;
use crate::failed_bake::FailedBake;

/// Failure of a command: what `--json` prints, and the report of a bake that failed.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum FailureReport {
    /// Failure of a bake.
    OfBake(Box<FailedBakeReport>),
    /// Failure of another command, or of a bake whose arguments cannot be understood.
    OfCommand(FailedCommandReport),
}

/// Report of a bake that failed.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct FailedBakeReport {
    #[serde(flatten)]
    bake: FailedBake,
    /// The failure.
    error: ErrorReport,
}

/// Report of a command that failed.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct FailedCommandReport {
    /// The failure.
    error: ErrorReport,
}

/// The error of a failure.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ErrorReport {
    /// Kind of failure.
    kind: &'static str,
    /// Exit code of the process.
    exit: u8,
    /// The first sentence.
    message: String,
    /// Remedies, as phrases.
    pub(crate) remedies: Vec<String>,
    /// All sentences, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    messages: Option<Vec<String>>,
}

impl FailureReport {
    /// Describes a failure of the command with this name. The remedies name the flags of this command.
    pub(crate) fn new(failure: &Failure, command: &str) -> FailureReport {
        let error = ErrorReport::new(failure, command);
        match failure.bake.as_deref() {
            Some(bake) => FailureReport::OfBake(Box::new(FailedBakeReport {
                bake: bake.clone(),
                error,
            })),
            None => FailureReport::OfCommand(FailedCommandReport { error }),
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

#[cfg(test)]
mod tests {
    use sabi_engine::Remedy;

    use super::*;
    use crate::exit::Exit;

    #[test]
    fn a_remedy_has_the_flag_of_its_command_and_a_single_sentence_is_no_list() {
        let failure = Failure {
            remedies: vec![Remedy::SmallerSize],
            ..Failure::new(Exit::BadInput, "one".to_owned())
        };
        let report = serde_json::to_value(FailureReport::new(&failure, "bake")).unwrap();
        let expected = serde_json::json!({ "error": {
            "kind": "bad_input", "exit": 65, "message": "one", "remedies": ["choose a smaller size with --size"],
        } });
        assert_eq!(report, expected);
    }
}
