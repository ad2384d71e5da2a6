//! The shown model, and the models beside it.

use std::path::Path;
use std::time::Duration;

use egui::Context;
use sabi_engine::opening::linked_model::SavedReading;

use super::super::Editor;
use sabi_files::io_reason;

use crate::evaluation::ModelOutcome;
use crate::files::examples;
use crate::import_options::ImportOptions;
use crate::paths::{file_stem, in_canonical_folder};

/// Time after the last input for which the models beside the main one are not evaluated.
const REST: Duration = Duration::from_millis(250);

impl Editor {
    /// Requests another model.
    pub(crate) fn take_model(&mut self, path: &Path) {
        let path = in_canonical_folder(path);
        let reading = self.reading(&path);
        if self.evaluation.model.is_being_read(&path, &reading) {
            return;
        }
        // If the requested model is beside the main one, they trade places.
        let before = self.evaluation.model.file().to_owned();
        self.row.replace(&path, &before, self.reading(&before));
        self.evaluation.model.replace(&path, reading);
    }

    /// Puts a newly shown model on the strip, or reports why a model cannot be shown.
    pub(in crate::app) fn follow_model(&mut self) {
        match self.evaluation.model.take_outcome() {
            None => {}
            Some(ModelOutcome::Shown) => {
                let model = self.evaluation.model.file().to_owned();
                self.remember_model(&model);
            }
            Some(ModelOutcome::Refused { file, error }) => {
                self.row.remove(self.evaluation.model.file(), &self.shell.context);
                let stays = file_stem(self.evaluation.model.file());
                let advice = if file.exists() {
                    ""
                } else {
                    "; find it again in Problems"
                };
                self.shell.fail(format!(
                    "{} could not be loaded; still showing {stays}: {error}{advice}",
                    file.display()
                ));
            }
        }
    }

    /// Takes a model off the strip. If it is shown, the next one is shown; the only one stays.
    pub(in crate::app) fn remove_model(&mut self, model: &Path) {
        let models = &mut self.documents.models.files;
        let Some(at) = models.iter().position(|known| known == model) else {
            return;
        };
        if models.len() == 1 {
            return self.shell.notify("This is the only model. Add another one first.");
        }
        models.remove(at);
        let next = models[at.min(models.len() - 1)].clone();
        if self.evaluation.model.file() == model {
            self.take_model(&next);
        }
    }

    /// Reads the shown model with other options, now and whenever it is shown again.
    pub(in crate::app) fn read_model(&mut self, reading: ImportOptions) {
        let file = self.evaluation.model.file().to_owned();
        self.keep_reading(&file, &reading);
        self.evaluation.model.replace(&file, reading);
    }

    /// Cancels the reading of the requested model. The previous one is shown again; if there is none, a built-in one is
    /// shown.
    pub(in crate::app) fn cancel_reading(&mut self) {
        if let Some((file, reading)) = self.evaluation.model.cancel() {
            return self.keep_reading(&file, &reading);
        }
        if self.evaluation.model.is_first() {
            self.cancel_first();
        }
    }

    /// Shows a built-in model in place of the first one, which is being read.
    fn cancel_first(&mut self) {
        match self.documents.folders.first_model() {
            Ok(instead) => {
                let left = file_stem(self.evaluation.model.file()).into_owned();
                let reading = self.reading(&instead);
                self.evaluation.model.cancel_first(&instead, reading);
                let instead = file_stem(&instead);
                self.shell
                    .notify(format!("{left} was not read; {instead} is shown. Read it in Problems."));
            }
            Err(error) => self.shell.fail(error.to_string()),
        }
    }

    /// Keeps the options for reading a model: in the graph those that it stores for its own model, all others in the
    /// settings.
    fn keep_reading(&mut self, file: &Path, reading: &ImportOptions) {
        let kept = match self.documents.keep_reading(file, reading) {
            true => reading.clone().with_saved(SavedReading::default()),
            false => reading.clone(),
        };
        self.shell.settings.remember_reading(file, kept);
    }

    /// Options for reading a model.
    fn reading(&self, model: &Path) -> ImportOptions {
        self.documents.reading(&self.shell.settings, model)
    }

    /// Reads the shown model again if its options in the graph have changed, such as by an undo.
    pub(in crate::app) fn follow_reading(&mut self) {
        if !self.documents.takes_new_reading() {
            return;
        }
        let file = self.evaluation.model.file().to_owned();
        let reading = self.reading(&file);
        if reading.saved() != self.evaluation.model.import_options().saved() {
            self.evaluation.model.replace(&file, reading);
        }
    }

    /// Puts a model on the strip.
    fn remember_model(&mut self, model: &Path) {
        self.documents.models.add(model);
        self.shell.settings.remember_model(model);
    }

    /// Shows a model beside the main one, with the same graph.
    pub(in crate::app) fn show_beside(&mut self, path: &Path) {
        let path = in_canonical_folder(path);
        let written = match &self.documents.folders.examples {
            Some(folder) => examples::write_model(folder, &path),
            None => Ok(()),
        };
        if let Err(error) = written {
            let sentence = format!("{} could not be written: {}", path.display(), io_reason(&error));
            return self.shell.fail(sentence);
        }
        let reading = self.reading(&path);
        let added = self.row.add(&self.evaluation, &path, reading, &self.shell.context);
        self.shell.allow(added);
    }

    /// Returns whether a model is one of Sabi's own, which are offered without being on the strip.
    fn is_own_model(&self, model: &Path) -> bool {
        let folder = self.documents.folders.examples.as_deref();
        folder.is_some_and(|folder| examples::models(folder).any(|own| own == model))
    }

    /// Takes the events of the models beside the main one. Their evaluation pauses after input, so that no frame waits
    /// for it.
    pub(in crate::app) fn follow_row(&mut self, context: &Context) {
        for (model, outcome) in self.row.take_events(context) {
            match outcome {
                ModelOutcome::Shown if !self.is_own_model(&model) => self.remember_model(&model),
                ModelOutcome::Shown => {}
                ModelOutcome::Refused { file, error } => {
                    self.shell
                        .fail(format!("{} could not be loaded: {error}", file.display()));
                }
            }
        }
        if context.input(|input| !input.events.is_empty()) {
            self.evaluation.hold_others(REST);
        }
    }
}
