//! Warnings about a model and its atlas.

use crate::opening::coverage;
use crate::opening::linked_model::LinkedModel;
use crate::opening::overlap::OverlapTotals;
use crate::warning::Warning;

impl LinkedModel {
    /// Lists the warnings about the model and its atlas, which do not depend on a graph.
    pub fn warnings(&self) -> Vec<Warning> {
        let sentences = self.model.warnings.iter().chain(&self.atlas.report.warnings);
        let sentences = sentences.map(|sentence| Warning::from(sentence.as_str()));
        let shares = OverlapTotals::of(self).warning(self).into_iter();
        sentences.chain(shares).chain(coverage::warnings(self)).collect()
    }
}
