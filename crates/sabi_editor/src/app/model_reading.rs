//! Choices that the open graph keeps for reading its model.

use std::path::Path;

use sabi_editing::document_settings::changed_preview;
use sabi_editing::relative_paths;
use sabi_engine::opening::linked_model::SavedReading;
use sabi_files::NotText;

use super::documents::Documents;
use crate::import_options::ImportOptions;
use crate::paths::canonical_if_present;
use crate::settings::Settings;

impl Documents {
    /// Options for reading a model: those of the settings, with those of the open graph if it is the graph's model.
    pub(super) fn reading(&self, settings: &Settings, model: &Path) -> ImportOptions {
        let reading = settings.reading(model);
        match self.is_own_model(model) {
            true => reading.with_saved(self.saved_reading()),
            false => reading,
        }
    }

    /// Stores options in the open graph if the model is the graph's own; returns whether it is.
    pub(super) fn keep_reading(&mut self, model: &Path, reading: &ImportOptions) -> bool {
        if !self.is_own_model(model) {
            return false;
        }
        let wanted = reading.saved();
        if wanted != self.saved_reading() {
            match self.textures_text(&wanted) {
                Ok(textures) => {
                    let edit = changed_preview(&self.document, |preview| wanted.put_into(preview, textures));
                    self.document.edit("Change how the model is read", vec![edit]);
                }
                Err(refused) => self.document.notify(refused.to_string()),
            }
        }
        true
    }

    /// Returns whether the options in the open graph have changed since the last call.
    pub(super) fn takes_new_reading(&mut self) -> bool {
        let now = self.saved_reading();
        let is_new = now != self.seen_reading;
        self.seen_reading = now;
        is_new
    }

    fn saved_reading(&self) -> SavedReading {
        let preview = self.document.contents().preview.as_ref();
        let base = self.document.session.graph().base();
        preview.map_or_else(SavedReading::default, |preview| {
            SavedReading::of_preview(preview, &base)
        })
    }

    /// Path of the folder for textures as the graph writes it.
    ///
    /// # Errors
    /// The path cannot be named in a file.
    pub(super) fn textures_text(&self, reading: &SavedReading) -> Result<Option<String>, NotText> {
        let textures = reading.textures.as_deref();
        textures
            .map(|folder| relative_paths::relative(&self.document, folder))
            .transpose()
    }

    fn is_own_model(&self, model: &Path) -> bool {
        let named = self.named_model();
        named.is_some_and(|named| canonical_if_present(&named) == canonical_if_present(model))
    }
}
