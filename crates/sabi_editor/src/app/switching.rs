//! Opens another graph in place of the open one.

use std::path::{Path, PathBuf};

use egui::{Ui, ViewportCommand};
use sabi_engine::Session;
use sabi_files::{io_reason, path_text};
use sabi_surface::load::MODEL_ENDINGS;

use super::Editor;
use super::closing::is_held_open;
use super::documents::{Documents, ProgramFolders};
use super::saving::claim_file;
use super::shell::Shell;
use crate::action::Next;
use crate::dock::Panel;
use crate::exports::Exports;
use crate::files::{examples, new_graph};
use crate::model_view::ModelView;
use crate::paths::{IMAGES, canonical_if_present, lowercase_ending};
use crate::settings::Settings;

impl Editor {
    /// Continues with another graph, or closes the window.
    pub(super) fn proceed(&mut self, next: Next) {
        match next {
            Next::New => {
                let session = new_graph::session(self.documents.recovery_folder());
                if let Some(session) = self.shell.report(session) {
                    self.take_session(session);
                }
            }
            Next::Open(path) => self.open_file(&path),
            Next::Example(at) => {
                if let Some(file) = example(&self.documents.folders, &mut self.shell, at) {
                    self.open_file(&file);
                }
            }
            Next::Recover(at) => self.recover(at),
            Next::Close if is_held_open(&mut self.views, &mut self.shell, &self.exports) => {}
            Next::Close => {
                self.may_close = true;
                self.shell.context.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Opens a graph file in place of the open graph.
    pub(crate) fn open_file(&mut self, path: &Path) {
        let opened = Session::open(path, self.documents.recovery_folder());
        if let Some(session) = self.shell.report(opened) {
            self.shell.settings.remember(path);
            self.take_session(session);
            self.documents.recoveries.look();
        }
    }

    /// Opens the recovery file of a graph that was not saved when the program ended.
    fn recover(&mut self, at: usize) {
        let recoveries = &mut self.documents.recoveries;
        if at >= recoveries.found.len() {
            return;
        }
        let recovery = recoveries.found.remove(at);
        recoveries.is_offer_due = false;
        let drafts = recovery.drafts().to_vec();
        let recovered = Session::recover(recovery);
        if let Some(session) = self.shell.report(recovered) {
            self.take_session(session);
        }
        // Node files are recovered even if the graph is not.
        self.views.page.recover(drafts, &self.documents.document);
    }

    /// Opens another graph, on the model that it names.
    pub(crate) fn take_session(&mut self, session: Session) {
        remember_choices(&self.documents, &self.exports, &mut self.shell.settings);
        let model = self.documents.replace(&self.shell.context, session);
        claim_file(&mut self.documents, &mut self.views.questions);
        recall_choices(&mut self.documents, &mut self.exports, &self.shell.settings);
        self.views.canvas = Default::default();
        self.views.export.forget_dialog();
        self.looks.clear();
        self.node_brush_tip.forget();
        self.evaluation.drop_nodes();
        self.row.drop_nodes();
        self.choice_previews.forget_variants();
        let shown = canonical_if_present(self.evaluation.model.file());
        match model.filter(|model| canonical_if_present(model) != shown) {
            Some(model) => self.models().take(&model),
            None => self.documents.models.add(self.evaluation.model.file()),
        }
    }

    /// Uses a file by its type: a graph is opened, a model shown, an environment used as light, an image added as a node.
    pub(super) fn take_dropped(&mut self, path: &Path, ui: &Ui) {
        if path.is_dir() {
            return self.edits().add_folder(path, ui);
        }
        let is_on_canvas = self.shell.keyboard.active == Panel::Canvas;
        match lowercase_ending(path).as_deref() {
            Some("sabi") => {
                let is_dirty = self.documents.document.session.is_dirty();
                self.views.questions.ask_next(is_dirty, Next::Open(path.to_owned()));
            }
            Some(ending) if MODEL_ENDINGS.contains(&ending) => self.models().take_chosen(path),
            Some("hdr") => use_environment(&mut self.views.model, &mut self.shell, path),
            Some("exr") if !is_on_canvas => use_environment(&mut self.views.model, &mut self.shell, path),
            Some(ending) if IMAGES.contains(&ending) => self.edits().add_image(path, ui),
            _ => self.shell.notify(format!(
                "{} cannot be used here; drop a graph, a model, an image or an environment",
                path.display()
            )),
        }
    }
}

/// Writes the files of an example, and returns its graph file.
fn example(folders: &ProgramFolders, shell: &mut Shell, at: usize) -> Option<PathBuf> {
    let Some(folder) = &folders.examples else {
        shell.notify("This system has no folder for examples; open one of the project's graphs instead.");
        return None;
    };
    let file = examples::unpack(folder, at);
    let file = file.map_err(|error| format!("{} cannot be written: {}", folder.display(), io_reason(&error)));
    shell.report(file).flatten()
}

/// Lights the model by a file.
fn use_environment(model: &mut ModelView, shell: &mut Shell, path: &Path) {
    let Some(choice) = shell.report(path_text(&canonical_if_present(path))) else {
        return;
    };
    model.environment.choose(&choice);
    model.environment.read_again();
    shell.settings.environment = choice;
}

/// Restores the export target and the strip of models that the open graph had before.
pub(super) fn recall_choices(documents: &mut Documents, exports: &mut Exports, settings: &Settings) {
    let file = documents.document.session.file();
    let place = file.map(|file| settings.export_place(file).beside(file));
    let models = file.map(|file| settings.model_strip(file));
    // A graph without a file has an empty strip; the shown model joins it.
    documents.models = models.unwrap_or_default();
    // A graph without a file has an empty target.
    exports.turn_to(place.unwrap_or_default());
}

/// Remembers the export target and the strip of models of the open graph.
pub(super) fn remember_choices(documents: &Documents, exports: &Exports, settings: &mut Settings) {
    if let Some(file) = documents.document.session.file() {
        settings.remember_export(file, &exports.place);
        settings.remember_model_strip(file, &documents.models);
    }
}
