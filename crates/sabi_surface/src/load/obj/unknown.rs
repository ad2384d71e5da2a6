//! Unknown statements of a file.

use std::collections::BTreeSet;

use crate::load::warnings::Warnings;

/// Maximum number of keywords that a warning lists.
const MOST_NAMED: usize = 5;
/// Maximum number of bytes of a keyword in a warning.
const MOST_BYTES: usize = 32;

/// Unknown keywords, each once, in the order of their first use.
#[derive(Default)]
pub(super) struct Unknown {
    known: BTreeSet<String>,
    named: Vec<String>,
    /// Line of the first unknown keyword.
    line: usize,
}

impl Unknown {
    /// Records the keyword of a line.
    pub(super) fn note(&mut self, keyword: &str, line: usize) {
        // One more keyword is kept, which shows that there are more than can be listed.
        if self.known.len() > MOST_NAMED || self.known.contains(keyword) {
            return;
        }
        if self.known.is_empty() {
            self.line = line;
        }
        self.known.insert(keyword.to_owned());
        self.named
            .push(keyword[..keyword.floor_char_boundary(MOST_BYTES)].to_owned());
    }

    /// Adds a warning about all of them. `whose` is the file.
    pub(super) fn warn(&self, whose: &str, warnings: &mut Warnings) {
        let named: Vec<String> = self
            .named
            .iter()
            .take(MOST_NAMED)
            .map(|word| format!("`{word}`"))
            .collect();
        if !named.is_empty() {
            warnings.add(format!(
                "{whose} has statements that are not known and are left out, the first in line {}: {}{}.",
                self.line,
                named.join(", "),
                if self.named.len() > MOST_NAMED {
                    " and others"
                } else {
                    ""
                }
            ));
        }
    }
}
