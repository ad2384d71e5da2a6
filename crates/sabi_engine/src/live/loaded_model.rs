//! Loaded model, coarse and full.

use std::sync::Arc;

use super::sized_model::SizedModel;
use crate::opening::linked_model::ModelOptions;
use crate::warning::Warning;

/// Loaded model, at one size or two.
pub(super) struct LoadedModel {
    pub(super) revision: u64,
    /// Options it was loaded with; their size is the full one.
    pub(super) options: Arc<ModelOptions>,
    /// Coarse size; `None` if the full size is not larger.
    pub(super) coarse: Option<SizedModel>,
    /// Full size; `None` before it is needed, and if it failed to load.
    pub(super) full: Option<SizedModel>,
    /// True if the full size failed to load.
    pub(super) has_full_failed: bool,
}

impl LoadedModel {
    /// Returns the size for first pictures.
    pub(super) fn first(&mut self) -> Option<&mut SizedModel> {
        self.coarse.as_mut().or(self.full.as_mut())
    }

    /// Returns the coarse or the full size.
    pub(super) fn at(&mut self, is_coarse: bool) -> Option<&mut SizedModel> {
        match is_coarse {
            true => self.coarse.as_mut(),
            false => self.full.as_mut(),
        }
    }

    /// Returns the largest loaded size.
    pub(super) fn best(&mut self) -> Option<&mut SizedModel> {
        self.full.as_mut().or(self.coarse.as_mut())
    }

    /// Lists the warnings about the model and about the current request. Those about the model are of its full size, since
    /// the user did not choose the coarse one. They are of the coarse size only if the full one cannot be loaded.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let first = self.coarse.as_ref().or(self.full.as_ref());
        let coarse = self.coarse.as_ref().filter(|_| !self.has_full_failed);
        let of_coarse = coarse.map(|sized| sized.model.linked.warnings());
        let of_coarse = of_coarse.unwrap_or_default(); // There is no coarse size if the full size is not larger.
        let of_request = first.into_iter().flat_map(SizedModel::warnings);
        let of_request = of_request.filter(|warning| !of_coarse.contains(warning));
        let of_model = self.full.as_ref().map(|sized| sized.model.linked.warnings());
        of_model.into_iter().flatten().chain(of_request).collect()
    }

    pub(super) fn sizes(&self) -> impl Iterator<Item = &SizedModel> {
        self.coarse.iter().chain(&self.full)
    }
}
