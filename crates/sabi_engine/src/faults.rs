//! Faults that are found together and reported together.

use crate::error::{EngineError, ErrorKind};
use crate::phases::interrupted;
use crate::remedy::Remedy;

/// Maximum number of sentences that are kept, since each is compared with all others. It is more than an error shows.
const MOST_KEPT: usize = 1000;

/// Sentences about several faults, without repeats.
#[derive(Debug, Default)]
pub struct FaultList {
    messages: Vec<String>,
    kinds: Vec<ErrorKind>,
    /// True if trust in a file helps.
    is_refusal: bool,
}

impl FaultList {
    /// Adds the sentences of an error that are not known yet.
    pub fn add(&mut self, error: EngineError) {
        self.kinds.push(error.kind);
        self.is_refusal |= error.remedies.contains(&Remedy::TrustFile);
        for message in error.messages {
            if self.messages.len() < MOST_KEPT && !self.messages.contains(&message) {
                self.messages.push(message);
            }
        }
    }

    /// Returns true without any fault.
    pub fn is_empty(&self) -> bool {
        self.messages.is_empty()
    }

    /// Returns one error with all sentences, of the kind of the first fault.
    pub(crate) fn into_result_of_first(self) -> Result<(), EngineError> {
        let remedy = self.is_refusal.then_some(Remedy::TrustFile);
        match self.kinds.first() {
            None => Ok(()),
            Some(kind) => Err(EngineError::several(*kind, self.messages).with_remedies(remedy)),
        }
    }

    /// Returns one error with all sentences. Its kind is missing input if all faults are about missing files, otherwise bad
    /// input, since the mistakes are in a file here.
    pub fn into_result(self) -> Result<(), EngineError> {
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
