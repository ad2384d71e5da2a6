//! Warnings about a model and its atlas.

use std::collections::BTreeSet;

use sabi_surface::load::listed;
use sabi_surface::model::ExclusionReason;

use crate::opening::coverage;
use crate::opening::linked_model::LinkedModel;
use crate::opening::overlap::OverlapTotals;
use crate::opening::tiles;
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Maximum number of parts that a warning names.
const MOST_NAMED: usize = 12;

impl LinkedModel {
    /// Lists the warnings about the model and its atlas, which do not depend on a graph.
    pub fn warnings(&self) -> Vec<Warning> {
        let sentences = self.model.warnings.iter().chain(&self.atlas.report.warnings);
        let sentences = sentences.map(|sentence| Warning::from(sentence.as_str()));
        let shares = OverlapTotals::of(self).warning(self).into_iter();
        let all = sentences.chain(tiles::warnings(self)).chain(shares);
        let all = all.chain(coverage::warnings(self));
        let all = all.chain(self.parts_left_out()).chain(self.missing_pictures());
        all.chain(self.refused_files()).collect()
    }

    /// Warns about parts that were left out because of the meaning of their names.
    fn parts_left_out(&self) -> Option<Warning> {
        let parts = self.model.file_parts.iter();
        let by_name = parts.filter(|part| {
            matches!(
                part.left_out,
                Some(ExclusionReason::Hull | ExclusionReason::CoarserLevel)
            )
        });
        let names: BTreeSet<&str> = by_name
            .map(|part| part.of_group.as_deref().unwrap_or(&part.name))
            .collect();
        let (are, their) = match names.len() {
            0 => return None,
            1 => (
                "is",
                "its name says that it is a collision hull or a coarser level of detail",
            ),
            _ => (
                "are",
                "their names say that they are collision hulls or coarser levels of detail",
            ),
        };
        let named = listed(names.into_iter(), MOST_NAMED);
        Some(Warning::new(
            format!("{named} {are} left out, since {their}"),
            [Remedy::AllParts],
        ))
    }

    /// Warns about pictures that the model names but that are missing.
    fn missing_pictures(&self) -> Option<Warning> {
        let names = self.model.missing_pictures();
        let are = match names.len() {
            0 => return None,
            1 => "is",
            _ => "are",
        };
        let named = listed(names.into_iter(), MOST_NAMED);
        let sentence = format!("{named} {are} not where the model says");
        Some(Warning::new(sentence, [Remedy::TextureFolder]))
    }

    /// Warns about files that the model names but may not open.
    fn refused_files(&self) -> Option<Warning> {
        let files: BTreeSet<String> = self.model.refused.iter().map(ToString::to_string).collect();
        let first = files.first()?;
        let others = match files.len() - 1 {
            0 => String::new(),
            1 => " (and 1 other file)".to_owned(),
            others => format!(" (and {others} other files)"),
        };
        let is_helped = self.model.refused.iter().any(|refusal| refusal.folder().is_some());
        Some(Warning::new(
            format!("the model was read without a file that it names{others}: {first}"),
            is_helped.then_some(Remedy::TrustFile),
        ))
    }
}
