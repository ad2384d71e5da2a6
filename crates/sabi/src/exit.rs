//! Exit codes, and failures on their way to them.

use sabi_engine::{EngineError, ErrorKind};

/// What the process ends with. 3 is kept for a verification that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(crate) enum Exit {
    /// Everything was done.
    Done = 0,
    /// The command line makes no sense.
    Usage = 2,
    /// No adapter can be used.
    NoAdapter = 4,
    /// A file is damaged, or not what it should be.
    BadInput = 65,
    /// A file is not there.
    MissingInput = 66,
    /// A mistake in Sabi.
    Mistake = 70,
    /// Results cannot be written.
    CannotWrite = 73,
    /// The user stopped it.
    Interrupted = 130,
}

impl From<ErrorKind> for Exit {
    fn from(kind: ErrorKind) -> Exit {
        match kind {
            ErrorKind::Usage => Exit::Usage,
            ErrorKind::NoAdapter => Exit::NoAdapter,
            // What a smaller size would mend, the command line would, too.
            ErrorKind::BadInput | ErrorKind::OutOfMemory => Exit::BadInput,
            ErrorKind::MissingInput => Exit::MissingInput,
            ErrorKind::CannotWrite => Exit::CannotWrite,
            ErrorKind::Interrupted => Exit::Interrupted,
        }
    }
}

/// Why a command ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    /// What the process ends with.
    pub(crate) exit: Exit,
    /// Sentences to the user; none where everything is said already.
    pub(crate) messages: Vec<String>,
}

impl Failure {
    pub(crate) fn new(exit: Exit, message: String) -> Failure {
        Failure {
            exit,
            messages: vec![message],
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
        }
    }
}
