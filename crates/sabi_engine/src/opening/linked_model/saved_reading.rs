//! Choices that a graph saves for reading its model.

use std::path::PathBuf;

use sabi_files::{PathBase, canonical};
use sabi_graph::Preview;
use sabi_surface::load::PartChoice;

use super::ModelOptions;
use crate::opening::document::OpenGraph;

/// Parts of a model that are used, treatment of faces that are inside out, and folder of missing textures. These correct
/// problems of the model for which a graph is made, so the graph stores them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SavedReading {
    /// Parts that count.
    pub parts: PartChoice,
    /// True to turn faces that are inside out, false to leave them even if a graph says otherwise; `None` if there is no choice.
    pub turn_faces: Option<bool>,
    /// Folder in which, including its subfolders, missing files that the model names are searched.
    pub textures: Option<PathBuf>,
}

impl SavedReading {
    /// Returns the choices in the preview of a graph. Paths in it start from `base`.
    pub fn of_preview(preview: &Preview, base: &PathBase) -> SavedReading {
        SavedReading {
            parts: PartChoice {
                parts: preview.parts.clone(),
                without: preview.without.clone(),
            },
            turn_faces: preview.turn_faces.then_some(true),
            textures: preview.textures.as_ref().map(|textures| base.resolve(textures)),
        }
    }

    /// Stores the choices in the preview of a graph. The path to the folder for textures is relative to the graph.
    pub fn put_into(&self, preview: &mut Preview, textures: Option<String>) {
        preview.textures = textures;
        preview.parts = self.parts.parts.clone();
        preview.without = self.parts.without.clone();
        preview.turn_faces = self.turns_faces();
    }

    /// Returns these choices, completed by those of a preview.
    pub(crate) fn or(&self, preview: &Preview, base: &PathBase) -> SavedReading {
        let saved = SavedReading::of_preview(preview, base);
        SavedReading {
            parts: match self.parts.is_default() {
                true => saved.parts,
                false => self.parts.clone(),
            },
            turn_faces: self.turn_faces.or(saved.turn_faces),
            textures: self.textures.clone().or(saved.textures),
        }
    }

    /// Returns true if faces that are inside out are turned.
    pub(crate) fn turns_faces(&self) -> bool {
        self.turn_faces == Some(true)
    }
}

impl ModelOptions {
    /// Returns the options, completed by the choices of a graph if the graph names this model.
    pub(crate) fn for_graph(&self, open: &OpenGraph) -> ModelOptions {
        let named = open.document.preview.as_ref();
        let preview = named.filter(|preview| {
            let file = preview.mesh.as_ref().map(|mesh| open.base().resolve(mesh));
            let named = file.and_then(|file| canonical(&file).ok());
            named.is_some() && named == canonical(&self.path).ok()
        });
        ModelOptions {
            reading: preview.map_or_else(
                || self.reading.clone(),
                |preview| self.reading.or(preview, &open.base()),
            ),
            ..self.clone()
        }
    }
}
