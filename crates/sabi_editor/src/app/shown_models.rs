//! The shown model, and the models beside it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::Context;
use sabi_editing::missing_files;
use sabi_engine::opening::linked_model::SavedReading;
use sabi_files::io_reason;

use super::documents::Documents;
use super::shell::Shell;
use super::trust;
use crate::action::{ModelAction, TrustAction};
use crate::evaluation::{Evaluation, ModelOutcome};
use crate::files::{Questions, examples};
use crate::import_options::ImportOptions;
use crate::model_row::ModelRow;
use crate::paths::{canonical_if_present, file_stem, in_canonical_folder};

/// Time after the last input for which the models beside the main one are not evaluated.
const REST: Duration = Duration::from_millis(250);

/// The shown model and the models beside it, with the choices that the open graph and the settings keep for them.
pub(crate) struct ShownModels<'a> {
    pub(super) documents: &'a mut Documents,
    pub(super) evaluation: &'a mut Evaluation,
    pub(super) row: &'a mut ModelRow,
    pub(super) shell: &'a mut Shell,
    pub(super) questions: &'a mut Questions,
}

impl ShownModels<'_> {
    /// Performs an action about a model.
    pub(super) fn perform(&mut self, action: ModelAction) {
        match action {
            ModelAction::Ask => self.questions.ask_for_model(self.evaluation.model.file()),
            ModelAction::Show(path) => self.take_chosen(&path),
            ModelAction::Read(reading) => self.read(reading),
            ModelAction::CancelReading => self.cancel_reading(),
            ModelAction::Remove(path) => self.remove(&path),
            ModelAction::AskBeside => self.questions.ask_for_model_beside(self.evaluation.model.file()),
            ModelAction::ShowBeside(path) => self.show_chosen_beside(&path),
            ModelAction::RemoveBeside(path) => self.row.remove(&path, &self.shell.context),
        }
    }

    /// Performs an action about trust: a model may be opened then. Trusted paths hold for this graph and all later ones.
    pub(super) fn perform_on_trust(&mut self, action: TrustAction) {
        match action {
            TrustAction::Folder(folder) => {
                trust::trust_path(self.documents, &mut self.shell.settings, &folder);
                self.take_named();
            }
            TrustAction::Nodes(folder) => trust::trust_nodes(self.documents, self.shell, &folder),
            TrustAction::LeaveNodes => self.documents.leaves_nodes = true,
        }
    }

    /// Requests another model.
    pub(super) fn take(&mut self, path: &Path) {
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
    pub(super) fn follow(&mut self) {
        match self.evaluation.model.take_outcome() {
            None => {}
            Some(ModelOutcome::Shown) => {
                let model = self.evaluation.model.file().to_owned();
                self.remember(&model);
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
    fn remove(&mut self, model: &Path) {
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
            self.take(&next);
        }
    }

    /// Reads the shown model with other options, now and whenever it is shown again.
    fn read(&mut self, reading: ImportOptions) {
        let file = self.evaluation.model.file().to_owned();
        self.keep_reading(&file, &reading);
        self.evaluation.model.replace(&file, reading);
    }

    /// Cancels the reading of the requested model. The previous one is shown again; if there is none, a built-in one is
    /// shown.
    fn cancel_reading(&mut self) {
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
    pub(super) fn follow_reading(&mut self) {
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
    fn remember(&mut self, model: &Path) {
        self.documents.models.add(model);
        self.shell.settings.remember_model(model);
    }

    /// Shows a model beside the main one, with the same graph.
    pub(super) fn show_beside(&mut self, path: &Path) {
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
        let added = self.row.add(self.evaluation, &path, reading, &self.shell.context);
        self.shell.allow(added);
    }

    /// Takes the events of the models beside the main one. Their evaluation pauses after input, so that no frame waits
    /// for it.
    pub(super) fn follow_row(&mut self, context: &Context) {
        for (model, outcome) in self.row.take_events(context) {
            match outcome {
                ModelOutcome::Shown if !self.documents.folders.is_own_model(&model) => self.remember(&model),
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

    /// Shows the model that the graph names, if it may be opened and is not shown.
    fn take_named(&mut self) {
        let shown = canonical_if_present(self.evaluation.model.file());
        let named = self.documents.named_model();
        if let Some(model) = named.filter(|model| canonical_if_present(model) != shown) {
            self.take(&model);
        }
    }

    /// Shows a model that the user chose.
    pub(super) fn take_chosen(&mut self, file: &Path) {
        self.trust(file);
        self.documents.is_model_chosen = true;
        self.take(file);
    }

    /// Shows a model that the user chose beside the main one.
    fn show_chosen_beside(&mut self, file: &Path) {
        self.trust(file);
        self.show_beside(file);
    }

    /// Lets every graph open a model that the user chose, since the open graph names it once it is saved.
    fn trust(&mut self, file: &Path) {
        trust::remember_file(self.documents, &mut self.shell.settings, file);
    }

    /// Names a file in place of a missing one, and files beside it in place of other missing ones.
    pub(super) fn find_missing(&mut self, lost: &str, file: &Path) {
        let model = self.evaluation.model.received.as_ref();
        let is_texture = model.is_some_and(|model| model.linked.model.missing_pictures().contains(lost));
        if is_texture
            && !missing_files::missing(&self.documents.document)
                .iter()
                .any(|named| named == lost)
        {
            return self.look_for_textures_beside(file);
        }
        let before = self.documents.written_model();
        let found = missing_files::relocate(&mut self.documents.document, lost, file);
        if self.documents.written_model() != before {
            // The strip has the model at its new place only.
            let is_lost = |model: &PathBuf| model.file_name() == file.file_name() && !model.exists();
            self.documents.models.files.retain(|model| !is_lost(model));
            self.take_named();
        }
        let sentence = match found {
            0 => return,
            1 => format!("{} is used from now on.", file.display()),
            2 => format!(
                "{} is used from now on, and one more that lies beside it.",
                file.display()
            ),
            _ => format!(
                "{} is used from now on, and {} more that lie beside it.",
                file.display(),
                found - 1
            ),
        };
        self.shell.notify(sentence);
    }

    /// Reads the shown model again, and looks for its missing pictures in and below the folder of a file.
    fn look_for_textures_beside(&mut self, file: &Path) {
        let Some(folder) = file.parent().map(canonical_if_present) else {
            return;
        };
        self.trust(&folder);
        let reading = ImportOptions {
            textures: Some(folder.clone()),
            ..self.evaluation.model.import_options().clone()
        };
        self.read(reading);
        self.shell.notify(format!(
            "Missing pictures of the model are looked for in {}.",
            folder.display()
        ));
    }

    /// Reads the graph again from its file, which another program has changed.
    pub(super) fn reload(&mut self) {
        let before = self.documents.written_model();
        let read = self.documents.document.read_again();
        if self.shell.report(read).is_some() {
            self.documents.is_file_foreign = false;
            let model = self.documents.written_model();
            if let Some(model) = self.documents.named_model().filter(|_| before != model) {
                self.take(&model);
            }
        }
    }
}
