//! Warnings about repairs and omissions, collected while reading.

use super::error::ModelFault;

/// Maximum number of sentences that are collected, since a broken file may repeat a fault many times.
const MOST: usize = 40;

/// Sentences for the artist, each once, in the order in which they occurred.
#[derive(Clone, Debug, Default)]
pub(super) struct Warnings {
    sentences: Vec<String>,
    left_out: usize,
}

/// `1 triangle`, `2 triangles`.
pub(super) fn counted(count: usize, [one, more]: [&str; 2]) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

/// Singular and plural for [`Warnings::counted`].
pub(super) const TRIANGLES: [&str; 2] = ["triangle", "triangles"];
/// Singular and plural for [`Warnings::counted`].
pub(super) const VERTICES: [&str; 2] = ["vertex", "vertices"];

impl Warnings {
    /// Adds a sentence unless it is there already.
    pub(super) fn add(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if self.sentences.contains(&sentence) {
            return;
        }
        if self.sentences.len() < MOST {
            self.sentences.push(sentence);
        } else {
            self.left_out += 1;
        }
    }

    /// Returns true if there are no warnings.
    pub(super) fn is_empty(&self) -> bool {
        self.sentences.is_empty()
    }

    /// Adds all of `other`.
    pub(super) fn absorb(&mut self, other: Warnings) {
        for sentence in other.sentences {
            self.add(sentence);
        }
        self.left_out += other.left_out;
    }

    /// Returns the fault of a model without any triangle, with the warnings as reasons.
    pub(super) fn into_fault(self) -> ModelFault {
        let reasons = self
            .sentences
            .into_iter()
            .take(3)
            .fold(String::new(), |reasons, reason| {
                reasons + "; " + reason.trim_end_matches('.')
            });
        ModelFault::NoTriangles(reasons)
    }

    /// Returns the sentences, followed by one about the number of those that were dropped.
    pub(super) fn finish(mut self) -> Vec<String> {
        if self.left_out > 0 {
            self.sentences
                .push(format!("There were {} more warnings of this kind.", self.left_out));
        }
        self.sentences
    }
}
