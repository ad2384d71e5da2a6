//! Exit codes, and failures that lead to them.

use sabi_engine::{EngineError, ErrorKind, Remedy};
use strum::VariantArray;

use crate::failed_bake::FailedBake;

/// Exit code of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, VariantArray)]
#[repr(u8)]
pub(crate) enum Exit {
    /// The command succeeded.
    Done = 0,
    /// Some items of a plan failed.
    SomeFailed = 1,
    /// The command line cannot be understood.
    Usage = 2,
    /// Files differ from their record.
    Mismatch = 3,
    /// No adapter can be used.
    NoAdapter = 4,
    /// A file is damaged or of the wrong kind.
    BadInput = 65,
    /// A file is missing or cannot be read.
    MissingInput = 66,
    /// A defect of Sabi.
    Defect = 70,
    /// Results cannot be written.
    CannotWrite = 73,
    /// The user stopped the command.
    Interrupted = 130,
    /// The system stopped the command.
    Terminated = 143,
}

impl Exit {
    /// All exit codes.
    pub(crate) const ALL: &'static [Exit] = Exit::VARIANTS;

    /// Returns the word for the exit code in JSON.
    pub(crate) fn kind(self) -> &'static str {
        match self {
            Exit::Done => "done",
            Exit::SomeFailed => "some_failed",
            Exit::Usage => "usage",
            Exit::Mismatch => "mismatch",
            Exit::NoAdapter => "no_adapter",
            Exit::BadInput => "bad_input",
            Exit::MissingInput => "missing",
            Exit::Defect => "defect",
            Exit::CannotWrite => "cannot_write",
            Exit::Interrupted | Exit::Terminated => "interrupted",
        }
    }
}

impl From<ErrorKind> for Exit {
    fn from(kind: ErrorKind) -> Exit {
        match kind {
            ErrorKind::Usage => Exit::Usage,
            ErrorKind::NoAdapter => Exit::NoAdapter,
            // More memory is needed than there is: the user can choose another size or model.
            ErrorKind::BadInput | ErrorKind::OutOfMemory => Exit::BadInput,
            ErrorKind::MissingInput => Exit::MissingInput,
            ErrorKind::CannotWrite => Exit::CannotWrite,
            ErrorKind::Interrupted => Exit::Interrupted,
            ErrorKind::Defect => Exit::Defect,
        }
    }
}

/// Reason why a command ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    /// Exit code of the process.
    pub(crate) exit: Exit,
    /// Sentences for the user.
    pub(crate) messages: Vec<String>,
    /// Remedies that are suggested after the last sentence.
    pub(crate) remedies: Vec<Remedy>,
    /// Advice on the command line, in words.
    pub(crate) tips: Vec<String>,
    /// The bake that failed, if the command was a bake.
    pub(crate) bake: Option<Box<FailedBake>>,
}

impl Failure {
    pub(crate) fn new(exit: Exit, message: String) -> Failure {
        Failure {
            exit,
            messages: vec![message],
            remedies: Vec::new(),
            tips: Vec::new(),
            bake: None,
        }
    }
}

impl From<EngineError> for Failure {
    fn from(error: EngineError) -> Failure {
        let messages = match error.kind {
            ErrorKind::Interrupted => vec!["stopped; nothing was written or changed".to_owned()],
            _ => error.messages,
        };
        Failure {
            exit: error.kind.into(),
            messages,
            remedies: error.remedies,
            tips: Vec::new(),
            bake: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use sabi_engine::{EngineError, ErrorKind, Remedy};

    use super::{Exit, Failure};

    #[test]
    fn each_kind_of_error_has_its_exit_code() {
        let code = |kind: ErrorKind| match kind {
            ErrorKind::Usage => 2,
            ErrorKind::NoAdapter => 4,
            ErrorKind::BadInput | ErrorKind::OutOfMemory => 65,
            ErrorKind::MissingInput => 66,
            ErrorKind::Defect => 70,
            ErrorKind::CannotWrite => 73,
            ErrorKind::Interrupted => 130,
        };
        for &kind in ErrorKind::ALL {
            assert_eq!(Exit::from(kind) as u8, code(kind), "{kind:?}");
        }
        assert_eq!(Exit::Done as u8, 0);
    }

    #[test]
    fn a_failure_keeps_sentences_and_remedies_of_its_error() {
        let error = EngineError::new(ErrorKind::CannotWrite, "the disk is full").with_remedies([Remedy::FreeSpace]);
        let failure = Failure::from(error);
        assert_eq!(failure.exit, Exit::CannotWrite);
        assert_eq!(failure.messages, ["the disk is full"]);
        assert_eq!(failure.remedies, [Remedy::FreeSpace]);
    }
}
