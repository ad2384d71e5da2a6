//! The one place where actions are performed or handed to the part of the window that they are about. No match of actions
//! or commands has a wildcard: one that is not handled does not compile.

mod commands;

use std::path::Path;

use egui::Ui;
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{OpenDocument, history, knob_target, relative_paths};
use sabi_graph::Value;

use super::Editor;
use super::library_files::{save_node, save_to_library};
use super::packing::pack_into;
use crate::action::{Action, ExportAction, FileAction};
use crate::exports::ExportSource;
use crate::notices::Work;

impl Editor {
    /// Performs the actions of a frame, and what follows from them.
    pub(super) fn perform_all(&mut self, actions: Vec<Action>, ui: &Ui) {
        let length = self.looks.length.take();
        for action in actions {
            self.perform(action, ui);
        }
        // The viewport was drawn before the length changed.
        if self.looks.length != length {
            ui.ctx().request_repaint();
        }
        let is_dirty = self.documents.document.session.is_dirty();
        if let Some(next) = self.views.questions.take_next(is_dirty) {
            self.proceed(next);
        }
        for sentence in self.documents.document.take_notices() {
            self.shell.notify(sentence);
        }
    }

    /// Performs an action.
    pub(super) fn perform(&mut self, action: Action, ui: &Ui) {
        let document = &mut self.documents.document;
        match action {
            Action::Do(command) => self.command(command, ui),
            Action::Edit(command) => self.edits().edit(command, ui),
            Action::Notice(sentence) => self.shell.notify(sentence),
            Action::AddInMiddle(new) => {
                let place = self.views.canvas.camera.center();
                self.edits().add_uncovering(new, place, ui);
            }
            Action::DragNew { interface, at } => {
                self.drop_targets().mark(ui, &interface, at);
                let document = &self.documents.document;
                self.views
                    .canvas
                    .drag_new(ui, &self.shell.theme, document, &interface, at);
            }
            Action::DropNew { new, interface, at } => {
                if let Some(target) = self.drop_targets().find(&interface, at) {
                    self.edits().drop_on(target, new, ui);
                }
            }
            Action::AddToLibrary(library) => {
                save_to_library(&mut self.documents, &self.evaluation, &mut self.shell, library)
            }
            Action::SaveNode(node) => {
                save_node(&mut self.documents, &mut self.shell, &mut self.views.page, &node);
            }
            Action::Replace { node, by } => self.edits().replace(node, by),
            Action::Select(ids) => self.edits().select(ids),
            Action::Arrow(key) => {
                for action in self.views.canvas.arrow(document, key) {
                    self.perform(action, ui);
                }
            }
            Action::Show { node, port } => self.looks.show(document, &node, port),
            Action::ShowChannel { node, mode } => {
                self.looks.show(document, &node, None);
                self.shell.settings.follows = true;
                self.views.model.shot.mode = mode;
            }
            Action::Pin { node } => self.looks.toggle_pin_2d(document, &node),
            Action::Look(action) => self.looks.perform(action, &mut self.shell.settings),
            Action::Knob { node, event } => self.edits().change_knob(node, event, ui),
            Action::TurnExposed(event) => self.edits().change_exposed_value(event, ui),
            Action::SaveVariant(name) => self.saving().save_variant(name),
            Action::File(action) => self.perform_on_file(action),
            Action::Model(action) => self.models().perform(action),
            Action::Trust(action) => self.models().perform_on_trust(action),
            Action::Dropped(path) => self.take_dropped(&path, ui),
            Action::ImportPictures(path) => self.edits().import_pictures(&path, ui),
            Action::ShowSet(set) => self.views.flat.set = Some(set),
            Action::GoTo(node) => self.edits().go_to(&node),
            Action::Steps(steps) => {
                for _ in 0..steps.unsigned_abs() {
                    match steps < 0 {
                        true => history::undo(document),
                        false => history::redo(document),
                    }
                }
            }
            Action::Export(action) => self.perform_export(action),
            Action::TakeColor(color) => self.edits().take_color(color),
            Action::SetGradient { parameter, stops } => {
                knob_target::set(document, &parameter, stops);
            }
            Action::AskForGradient(parameter) => self.views.questions.ask_for_gradient(document, parameter),
            Action::Paint(action) => self.painting().perform(action, ui),
            Action::Setting(action) => self.shell.set(action),
            Action::ShowPanel(panel) => self.shell.dock.bring_up(panel),
            Action::Arrange(workspace) => self.shell.dock.arrange(workspace),
            Action::ShowStartPage => self.views.start.is_open = true,
        }
    }

    /// Performs an action about the graph's file.
    pub(super) fn perform_on_file(&mut self, action: FileAction) {
        match action {
            FileAction::Ask(next) => {
                let is_dirty = self.documents.document.session.is_dirty();
                self.views.questions.ask_next(is_dirty, next);
            }
            FileAction::Proceed(next) => self.proceed(next),
            FileAction::Save => self.saving().save(),
            FileAction::SaveAs(file) => self.saving().save_as(file),
            FileAction::Overwrite(file) => self.saving().save_to(&file),
            FileAction::SaveBesideTheirs => self.saving().save_beside_theirs(),
            FileAction::AllowSaving => self.documents.document.session.graph_file.set_read_only(false),
            FileAction::Pack(file) => {
                pack_into(
                    &mut self.packing,
                    &mut self.documents,
                    &self.evaluation,
                    &mut self.shell,
                    file,
                );
            }
            FileAction::AskForMissing(lost) => {
                self.views.questions.ask_for_missing(&self.documents.document, lost);
            }
            FileAction::Find { lost, file } => self.models().find_missing(&lost, &file),
            FileAction::Reload => self.models().reload(),
            FileAction::KeepOpen => {
                self.documents.is_file_foreign = false;
                self.documents.document.session.graph_file.keep_document();
                self.documents.autosave.invalidate();
            }
            FileAction::DeleteRecovery(at) => {
                let recoveries = &mut self.documents.recoveries.found;
                if at < recoveries.len() {
                    recoveries.remove(at).forget();
                }
            }
            FileAction::AskForPicture => self.views.questions.ask_for_picture(&self.documents.document),
            FileAction::SavePicture(file) => self.views.model.saved_picture.save_to(file),
            FileAction::SetImage { parameter, file } => set_image(&mut self.documents.document, &parameter, &file),
            FileAction::PickGradient { parameter, file } => {
                let context = self.shell.context.clone();
                self.views.gradient_picker.open(&context, parameter, file);
            }
        }
    }

    /// Performs an action about exports.
    pub(super) fn perform_export(&mut self, action: ExportAction) {
        match action {
            ExportAction::Start { force } => {
                let source = ExportSource {
                    document: &self.documents.document,
                    evaluation: &self.evaluation,
                    choices: &self.shell.settings.export,
                };
                let started = self.exports.start(&self.shell.context, source, force);
                self.shell.report_on(Work::Export, started);
            }
            ExportAction::Cancel => self.exports.cancel(),
            ExportAction::Choose(choices) => self.shell.settings.export = choices,
            ExportAction::Target(place) => {
                self.exports.asks_force &= place.folder == self.exports.place.folder;
                self.exports.place = place;
            }
        }
    }
}

/// Gives an image file to a parameter.
fn set_image(document: &mut OpenDocument, parameter: &KnobTarget, file: &Path) {
    match relative_paths::chosen(document, file) {
        Ok(text) => {
            knob_target::set(document, parameter, Value::Text(text));
        }
        Err(refused) => document.notify(refused.to_string()),
    }
}
