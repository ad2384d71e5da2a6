//! Faults that are found together and told together.

use crate::error::{EngineError, ErrorKind};
use crate::phases::interrupted;
use crate::remedy::Remedy;

/// Most sentences that are kept, each of which is compared with all others: more than an error has.
const MOST_KEPT: usize = 1000;

/// Sentences about several faults, each once.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    messages: Vec<String>,
    kinds: Vec<ErrorKind>,
    /// True if trust in a file helps.
    is_refusal: bool,
}

impl Faults {
    pub(crate) fn add(&mut self, error: EngineError) {
        self.kinds.push(error.kind);
        self.is_refusal |= error.remedies.contains(&Remedy::TrustFile);
        for message in error.messages {
            if self.messages.len() < MOST_KEPT && !self.messages.contains(&message) {
                self.messages.push(message);
            }
        }
    }

    /// Returns true without any fault.
    pub(crate) fn is_empty(&self) -> bool {
        self.messages.is_empty()
    }

    /// One error with all sentences, of the kind of the first fault.
    pub(crate) fn into_result_of_first(self) -> Result<(), EngineError> {
        let remedy = self.is_refusal.then_some(Remedy::TrustFile);
        match self.kinds.first() {
            None => Ok(()),
            Some(kind) => Err(EngineError::several(*kind, self.messages).with_remedies(remedy)),
        }
    }

    /// One error with all sentences: about missing files if all are, else about bad input, since what the command line could
    /// have wrong stands in a file here.
    pub(crate) fn into_result(self) -> Result<(), EngineError> {
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
