//! Versions to which nothing refers any more, but that an evaluation which began earlier may still need.

use std::collections::VecDeque;
use std::sync::Arc;

use sabi_paint::{StrokeList, Version};

/// Number of versions of unfinished strokes that are kept after the brush has moved on: those of about a second.
const PARTS: usize = 256;
/// Number of stroke lists that are kept for the evaluations that began last.
const ASKED: usize = 16;

/// Versions on their way out.
#[derive(Default)]
pub(super) struct RetiredVersions {
    /// The oldest first.
    parts: VecDeque<Version>,
    /// Lists with which evaluations began, each with its model. The latest is at the end.
    asked: VecDeque<(Version, Arc<StrokeList>, String)>,
}

impl RetiredVersions {
    /// Retires versions, the last one first, and returns those that have to be forgotten now.
    pub(super) fn retire(&mut self, parts: Vec<Version>) -> Vec<Version> {
        // A later version is forgotten before the one on which it builds.
        self.parts.extend(parts.into_iter().rev());
        let over = self.parts.len().saturating_sub(PARTS);
        self.parts.drain(..over).collect()
    }

    /// Keeps a version to which something refers again.
    pub(super) fn recall(&mut self, version: Version) {
        self.parts.retain(|part| *part != version);
    }

    /// Keeps the list with which an evaluation begins.
    pub(super) fn keep(&mut self, version: Version, list: Arc<StrokeList>, model: String) {
        self.asked.retain(|(known, ..)| *known != version);
        self.asked.push_back((version, list, model));
        if self.asked.len() > ASKED {
            self.asked.pop_front();
        }
    }

    /// Returns the list of a version with which an evaluation began, and its model.
    pub(super) fn list(&self, version: Version) -> Option<(&Arc<StrokeList>, &str)> {
        let found = self.asked.iter().find(|(known, ..)| *known == version);
        found.map(|(_, list, model)| (list, model.as_str()))
    }
}
