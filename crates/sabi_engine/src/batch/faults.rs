//! Faults that are found together and told together.

use crate::error::{EngineError, ErrorKind};
use crate::phases::interrupted;
use crate::remedy::Remedy;

/// Sentences about several faults, each once.
#[derive(Debug, Default)]
pub(super) struct Faults {
    messages: Vec<String>,
    kinds: Vec<ErrorKind>,
    /// True if trust in a file helps.
    is_refusal: bool,
}

impl Faults {
    pub(super) fn add(&mut self, error: EngineError) {
        self.kinds.push(error.kind);
        self.is_refusal |= error.remedies.contains(&Remedy::TrustFile);
        for message in error.messages {
            if !self.messages.contains(&message) {
                self.messages.push(message);
            }
        }
    }

    /// One error with all sentences: about missing files if all are, else about bad input, since what the command line could
    /// have wrong stands in a file here.
    pub(super) fn into_result(self) -> Result<(), EngineError> {
        if self.kinds.contains(&ErrorKind::Interrupted) {
            return Err(interrupted());
        }
        let kind = match self.kinds.iter().all(|kind| *kind == ErrorKind::MissingInput) {
            true => ErrorKind::MissingInput,
            false => ErrorKind::BadInput,
        };
        match self.messages.is_empty() {
            true => Ok(()),
            false => {
                let remedy = self.is_refusal.then_some(Remedy::TrustFile);
                Err(EngineError::several(kind, self.messages).with_remedies(remedy))
            }
        }
    }
}
