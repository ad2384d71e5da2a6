//! Saving of the graph. The user is asked first if another program has changed the file.

use std::path::{Path, PathBuf};

use sabi_editing::command::{Outcome, VariantCommand, perform};
use sabi_engine::session::is_open_in_a_window;
use sabi_engine::{EngineError, Remedy};

use super::documents::Documents;
use super::model_pictures::ModelPictures;
use super::shell::Shell;
use super::trust;
use crate::evaluation::Evaluation;
use crate::exports::{ExportSource, Exports};
use crate::files::{Questions, ReplaceReason};
use crate::notices::Work;
use crate::paths::canonical_if_present;
use crate::shown_results::ShownResults;
use crate::views::Views;

/// Saving of the open graph: the graph names the shown model, its picture is stored, and its textures are exported again.
pub(crate) struct Saving<'a> {
    pub(super) documents: &'a mut Documents,
    pub(super) evaluation: &'a Evaluation,
    pub(super) looks: &'a ShownResults,
    pub(super) shell: &'a mut Shell,
    pub(super) views: &'a mut Views,
    pub(super) exports: &'a mut Exports,
}

impl Saving<'_> {
    /// Saves to the graph's file, or asks for one.
    pub(super) fn save(&mut self) {
        let Some(file) = self.documents.document.session.file().map(Path::to_owned) else {
            return self.views.questions.ask_to_save(&self.documents.document);
        };
        let session = &mut self.documents.document.session;
        if session.graph_file.is_read_only() {
            // The other window may have been closed meanwhile.
            if is_open_in_a_window(&file) || !session.graph_file.claim() {
                self.views.questions.ask_about_open_file(file);
                return;
            }
            session.graph_file.set_read_only(false);
        }
        // The notice about a deleted file is not needed: the file is written again.
        let _ = self.documents.check_file();
        if self.documents.is_file_foreign {
            self.views
                .questions
                .ask_to_replace(file, ReplaceReason::WrittenByAnother);
            return;
        }
        self.prepare_to_save();
        let saved = self.documents.document.session.save();
        if let Err(error) = &saved
            && error.remedies.contains(&Remedy::ReplaceFile)
        {
            // Another program has written the file since the check.
            self.views
                .questions
                .ask_to_replace(file, ReplaceReason::WrittenByAnother);
            return;
        }
        self.report_saved(&file, saved);
    }

    /// Copies the version that another program has written, then saves to the graph's file.
    pub(super) fn save_beside_theirs(&mut self) {
        let Some(file) = self.documents.document.session.file().map(Path::to_owned) else {
            return;
        };
        self.prepare_to_save();
        let saved = self.documents.document.session.save_beside_theirs();
        let (saved, copy) = match saved {
            Ok(copy) => (Ok(()), copy),
            Err(error) => (Err(error), None),
        };
        self.report_saved(&file, saved);
        if let Some(copy) = copy {
            self.shell
                .notify(format!("What the other program wrote is in {}", copy.display()));
        }
    }

    fn prepare_to_save(&mut self) {
        self.documents.name_model(self.evaluation);
        let backups = self.shell.settings.backups;
        self.documents.document.session.graph_file.set_backups(backups);
    }

    /// Saves to a file, and replaces an existing one.
    pub(super) fn save_to(&mut self, path: &Path) {
        self.prepare_to_save();
        let before = self
            .documents
            .document
            .session
            .file()
            .map_or_else(PathBuf::new, Path::to_owned);
        let folder = self.documents.document.session.graph().folder().to_owned();
        let saved = self.documents.document.save_as(path);
        let documents = &mut *self.documents;
        if documents.document.session.graph().folder() != folder {
            documents
                .kinds_reading
                .read_first(&self.shell.context, &mut documents.document);
        }
        if let (Ok(()), Some(after)) = (&saved, self.documents.document.session.file()) {
            let copied = self.documents.pictures.copy(&before, after);
            self.shell.report(copied);
        }
        self.report_saved(path, saved);
    }

    fn report_saved(&mut self, file: &Path, saved: Result<(), EngineError>) {
        if self.shell.report_on(Work::Save, saved).is_none() {
            return;
        }
        let session = &mut self.documents.document.session;
        // A new file is not claimed yet. If another window has it open, the user has chosen to replace it.
        session.graph_file.claim();
        session.graph_file.set_read_only(false);
        self.documents.is_file_foreign = false;
        // A save deletes the copies of the graph, but node files may still need theirs.
        self.documents.autosave.invalidate();
        self.shell.settings.remember(file);
        trust::remember_named(self.documents, &mut self.shell.settings, self.evaluation);
        self.shell.notify(format!("Saved to {}", file.display()));
        self.pictures().store_of_graph(file);
        self.exports.place = std::mem::take(&mut self.exports.place).beside(file);
        let source = ExportSource {
            document: &self.documents.document,
            evaluation: self.evaluation,
            choices: &self.shell.settings.export,
        };
        let exported = self.exports.after_save(&self.shell.context, source);
        self.shell.report_on(Work::Export, exported);
    }

    /// Saves to another file, and asks first if that would replace a file or if the folder is missing.
    pub(super) fn save_as(&mut self, file: PathBuf) {
        let session = &self.documents.document.session;
        let own = session.file().map(canonical_if_present);
        let is_own = own == Some(canonical_if_present(&file));
        let is_taken = file.exists() && !is_own;
        let is_open_elsewhere = match is_own {
            true => session.graph_file.is_read_only() && file.exists(),
            false => is_open_in_a_window(&file),
        };
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
        let questions = &mut self.views.questions;
        if is_open_elsewhere {
            questions.ask_to_replace(file, ReplaceReason::OpenElsewhere);
        } else if is_taken {
            questions.ask_to_replace(file, ReplaceReason::Exists);
        } else if folder.is_some_and(|folder| !folder.is_dir()) {
            questions.ask_to_make_folder(file);
        } else {
            self.save_to(&file);
        }
    }

    /// Saves the present values as a variant, with the model as it looks now.
    pub(super) fn save_variant(&mut self, name: String) {
        let command = VariantCommand::Save(name.clone());
        if perform(&mut self.documents.document, command.into()) == Outcome::Done {
            self.pictures().store_of_variant(name.trim());
        }
    }

    fn pictures(&mut self) -> ModelPictures<'_> {
        ModelPictures {
            documents: self.documents,
            evaluation: self.evaluation,
            looks: self.looks,
            shell: self.shell,
            model: &self.views.model,
        }
    }
}

/// Marks the graph's file as open in this window. If another window has it open, saving to it is refused until the
/// user allows it.
pub(super) fn claim_file(documents: &mut Documents, questions: &mut Questions) {
    // A window without a recovery folder is only drawn for a picture, and claims no file.
    let is_worked_in = documents.recovery_folder().is_some();
    let session = &mut documents.document.session;
    if !is_worked_in || session.graph_file.claim() {
        return;
    }
    session.graph_file.set_read_only(true);
    if let Some(file) = session.file().map(Path::to_owned) {
        questions.ask_about_open_file(file);
    }
}
