//! The recipe of a bake, and the files that it read.

pub(crate) mod inputs;
pub(crate) mod recipe;
pub(crate) mod recorded_fit;

pub use inputs::InputRecord;
pub use recipe::{ModelRecipe, Recipe, SetRecipe, is_preset_file, moved};

use std::path::PathBuf;

use self::inputs::{node_files, records};
use crate::baking::bake_request::BakeRequest;
use crate::baking::presets::preset_files;
use crate::error::EngineError;

/// Recipe of a bake, and the files that it read.
pub(crate) struct BakeProvenance {
    pub(crate) recipe: Recipe,
    pub(crate) inputs: Vec<InputRecord>,
}

impl BakeProvenance {
    /// Records a bake. `read` are the files of the graph and the model. `document` is the graph's text if it differs from its file.
    pub(crate) fn of(
        request: &BakeRequest,
        document: Option<String>,
        read: &[PathBuf],
    ) -> Result<BakeProvenance, EngineError> {
        let presets = preset_files(&request.presets, request.preset_folder.as_deref())?;
        // The text counts, not the file.
        let is_graph = |path: &PathBuf| document.is_some() && *path == request.graph;
        let read = read.iter().filter(|path| !is_graph(path)).cloned();
        let files = read
            .chain(presets)
            .chain(node_files(&request.graph, &request.evaluator.model.trusted));
        Ok(BakeProvenance {
            inputs: records(files),
            recipe: Recipe::of(request, document),
        })
    }
}
