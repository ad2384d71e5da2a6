//! Versions that nothing names any more, but that an evaluation which began before may still ask for.

use std::collections::VecDeque;
use std::sync::Arc;

use sabi_paint::{StrokeList, Version};

/// Parts of strokes that are known for a while after the brush moved on: those of about a second.
const PARTS: usize = 256;
/// Lists of strokes of the evaluations that began last.
const ASKED: usize = 16;

/// Versions on their way out.
#[derive(Default)]
pub(super) struct Retired {
    /// The oldest first.
    parts: VecDeque<Version>,
    /// Lists that evaluations began with, the latest at the end, each with its model.
    asked: VecDeque<(Version, Arc<StrokeList>, String)>,
}

impl Retired {
    /// Retires versions, the last one first, and returns those that are to be forgotten now.
    pub(super) fn retire(&mut self, parts: Vec<Version>) -> Vec<Version> {
        // A later part is forgotten before the one that it leads on from.
        self.parts.extend(parts.into_iter().rev());
        let over = self.parts.len().saturating_sub(PARTS);
        self.parts.drain(..over).collect()
    }

    /// A version that is named again stays.
    pub(super) fn recall(&mut self, version: Version) {
        self.parts.retain(|part| *part != version);
    }

    /// Keeps the list that an evaluation begins with.
    pub(super) fn keep(&mut self, version: Version, list: Arc<StrokeList>, model: String) {
        self.asked.retain(|(known, ..)| *known != version);
        self.asked.push_back((version, list, model));
        if self.asked.len() > ASKED {
            self.asked.pop_front();
        }
    }

    /// The list of a version that an evaluation began with, and its model.
    pub(super) fn list(&self, version: Version) -> Option<(&Arc<StrokeList>, &str)> {
        let found = self.asked.iter().find(|(known, ..)| *known == version);
        found.map(|(_, list, model)| (list, model.as_str()))
    }
}
