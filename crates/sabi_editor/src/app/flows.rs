//! Operations that involve several owners: opening and saving, the model, closing the window, and files that change.

mod dropped;
mod models;
mod trust;

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Context, Key, Modifiers, Ui, ViewportCommand};
use sabi_editing::library;
use sabi_engine::{EngineError, NodeDraft, Session};

use super::Editor;
use crate::action::{LibraryKind, Next};
use crate::dock::Panel;
use crate::exports::ExportSource;
use crate::files::examples;
use crate::files::{Question, ReplaceReason};
use crate::paths::{canonical_if_present, model_of};
use crate::saved_pictures::{OF_GRAPH, OF_GROUP};

/// Time until the next check whether files are watched.
const WATCH_AGAIN: Duration = Duration::from_millis(100);

impl Editor {
    /// Continues with another graph, or closes the window.
    pub(super) fn proceed(&mut self, next: Next) {
        match next {
            Next::New => {
                let session = Session::new(self.documents.recovery_folder());
                self.take_session(session);
            }
            Next::Open(path) => self.open_file(&path),
            Next::Example(at) => self.open_example(at),
            Next::Recover(at) => self.recover(at),
            Next::Close if self.is_held_open() => {}
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
        }
    }

    fn open_example(&mut self, at: usize) {
        let Some(folder) = self.documents.folders.examples.clone() else {
            let why = "This system has no folder for examples; open one of the project's graphs instead.";
            return self.shell.notify(why);
        };
        match examples::unpack(&folder, at) {
            Ok(Some(file)) => self.open_file(&file),
            Ok(None) => {}
            Err(error) => self
                .shell
                .notify(format!("{} cannot be written: {error}", folder.display())),
        }
    }

    /// Opens the recovery file of a graph that was not saved when the program ended.
    fn recover(&mut self, at: usize) {
        if at >= self.documents.recoveries.len() {
            return;
        }
        let recovery = self.documents.recoveries.remove(at);
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
        self.remember_export();
        let model = self.documents.replace(session);
        self.recall_export();
        self.views.canvas = Default::default();
        self.views.export.forget_dialog();
        self.looks.clear();
        self.node_tips.forget();
        self.evaluation.drop_nodes();
        self.row.drop_nodes();
        self.trials.forget_variants();
        let shown = canonical_if_present(self.evaluation.model.file());
        if let Some(model) = model.filter(|model| canonical_if_present(model) != shown) {
            self.take_model(&model);
        }
    }

    /// Saves to the graph's file, or asks for one.
    pub(crate) fn save(&mut self) {
        let Some(file) = self.documents.document.session.file().map(Path::to_owned) else {
            return self.views.questions.ask_to_save(&self.documents.document);
        };
        if self.documents.is_file_foreign {
            return self
                .views
                .questions
                .ask_to_replace(file, ReplaceReason::WrittenByAnother);
        }
        self.documents.name_model(&self.evaluation);
        let saved = self.documents.document.save();
        self.report_saved(&file, saved);
    }

    /// Saves to a file, and replaces an existing one.
    pub(super) fn save_to(&mut self, path: &Path) {
        self.documents.name_model(&self.evaluation);
        let before = self
            .documents
            .document
            .session
            .file()
            .map_or_else(PathBuf::new, Path::to_owned);
        let saved = self.documents.document.save_as(path);
        if let (Ok(()), Some(after)) = (&saved, self.documents.document.session.file()) {
            let copied = self.documents.pictures.copy(&before, after);
            self.shell.report(copied);
        }
        self.report_saved(path, saved);
    }

    fn report_saved(&mut self, file: &Path, saved: Result<(), EngineError>) {
        if self.shell.report(saved).is_none() {
            return;
        }
        self.documents.is_file_foreign = false;
        // A save deletes the copies of the graph, but node files may still need theirs.
        self.documents.autosave.invalidate();
        self.shell.settings.remember(file);
        self.shell.notify(format!("Saved to {}", file.display()));
        self.store_picture_of_graph(file);
        let source = ExportSource {
            document: &self.documents.document,
            evaluation: &self.evaluation,
            choices: &self.shell.settings.export,
        };
        let exported = self.exports.after_save(&self.shell.context, source);
        self.shell.report(exported);
    }

    /// Stores the model as it looks now as the picture of a graph, for the start page.
    fn store_picture_of_graph(&mut self, file: &Path) {
        if !self.shows_outputs_at_rest() {
            return;
        }
        if let Some(picture) = self.views.model.pictures.shown(self.evaluation.gpu()) {
            let stored = self
                .documents
                .pictures
                .store(&self.shell.context, file, OF_GRAPH, &picture);
            self.shell.report(stored);
        }
    }

    /// Starts an export as the panel says.
    pub(crate) fn export(&mut self, force: bool) {
        let source = ExportSource {
            document: &self.documents.document,
            evaluation: &self.evaluation,
            choices: &self.shell.settings.export,
        };
        let started = self.exports.start(&self.shell.context, source, force);
        self.shell.report(started);
    }

    /// Restores the export target that the open graph had before.
    pub(super) fn recall_export(&mut self) {
        let file = self.documents.document.session.file();
        let place = file.map(|file| self.shell.settings.export_place(file));
        // A graph without a file has an empty target.
        self.exports.turn_to(place.unwrap_or_default());
    }

    /// Remembers the export target of the open graph.
    pub(super) fn remember_export(&mut self) {
        if let Some(file) = self.documents.document.session.file() {
            self.shell.settings.remember_export(file, &self.exports.place);
        }
    }

    /// Puts the selected group into a library, with the picture of its result.
    pub(crate) fn save_to_library(&mut self, library: LibraryKind) {
        let documents = &mut self.documents;
        let Some(folder) = documents.library_folder(library) else {
            return self.shell.notify(match library {
                LibraryKind::Project => "Save the graph first, so that there is a folder beside it.",
                LibraryKind::User | LibraryKind::Sabi => "This system has no folder for a library.",
            });
        };
        let picture = documents.document.selected_one().and_then(|id| {
            let result = crate::looks::result_of(&documents.document, id, None);
            self.evaluation.results.thumbnail_pixels(&result).cloned()
        });
        let Some(file) = library::save_group(&mut documents.document, &folder) else {
            return;
        };
        documents.library.invalidate();
        if let Some(picture) = picture {
            let stored = documents.pictures.store(&self.shell.context, &file, OF_GROUP, &picture);
            self.shell.report(stored);
        }
    }

    /// Writes the file of a node, and adds the node to those that can be added.
    pub(super) fn save_node(&mut self, node: &NodeDraft) {
        let NodeDraft { folder, id, .. } = node;
        if let Some(file) = self.shell.report(node.save()) {
            self.shell.notify(format!(
                "'{id}' is in {}, and among the nodes that can be added.",
                file.display()
            ));
            self.shell.settings.trust_nodes(folder);
            self.documents.trust_nodes(folder);
            self.documents.reread_kinds(std::slice::from_ref(folder));
            self.views.page.saved(node);
        }
    }

    /// Keeps the window open if closing it would lose unsaved work, and asks what to do.
    pub(super) fn keep_open(&mut self, ui: &Ui) {
        if !ui.input(|input| input.viewport().close_requested()) || self.may_close {
            return;
        }
        let is_held = if self.documents.document.session.is_dirty() {
            self.views.questions.open = Some(Question::Unsaved { next: Next::Close });
            true
        } else {
            self.is_held_open()
        };
        if is_held {
            ui.ctx().send_viewport_cmd(ViewportCommand::CancelClose);
        }
    }

    /// Returns whether an unsaved node file or a running export keeps the window open, and shows it to the user.
    fn is_held_open(&mut self) -> bool {
        if self.views.page.show_unsaved() {
            self.shell.dock.bring_up(Panel::Page);
            self.shell
                .notify("The text of a node is not saved: save or discard it, then close the window.");
            return true;
        }
        let is_exporting = self.exports.running.is_some();
        if is_exporting {
            self.views.questions.open = Some(Question::Exporting);
        }
        is_exporting
    }

    /// Reads files again that have changed.
    pub(super) fn follow_files(&mut self) {
        let environment = self.views.model.environment.file();
        self.documents.watch(&self.evaluation, &self.row, environment);
        match self.documents.watching.take_library_reread() {
            Some(true) => self.documents.library.invalidate(),
            Some(false) => {}
            None => self.shell.context.request_repaint_after(WATCH_AGAIN),
        }
        let Some(changes) = self.documents.watching.changes() else {
            return;
        };
        if changes.nodes {
            let folders = self.documents.document.node_folders();
            self.documents.reread_kinds(&folders);
        }
        if changes.model {
            self.evaluation.model.reread();
        }
        self.row.reread(&changes.files);
        if let Some(watched) = self.documents.watching.watched() {
            if watched.library.iter().any(|file| changes.files.contains(file)) {
                self.documents.library.invalidate();
            }
            if watched.environment.iter().any(|file| changes.files.contains(file)) {
                self.views.model.environment.read_again();
            }
            if !changes.files.is_disjoint(&watched.named) {
                self.documents.document.files_changed(&changes.files);
            }
        }
        if changes.graph {
            let deleted = self.documents.check_file();
            deleted.into_iter().for_each(|sentence| self.shell.notify(sentence));
        }
    }

    /// Reads the graph again from its file, which another program has changed.
    pub(super) fn reload(&mut self) {
        let before = model_of(&self.documents.document.session);
        let read = self.documents.document.read_again();
        if self.shell.report(read).is_some() {
            self.documents.is_file_foreign = false;
            let model = model_of(&self.documents.document.session);
            let is_another = before != model;
            if let Some(Ok(model)) = model.filter(|_| is_another) {
                self.take_model(&model);
            }
        }
    }

    /// Ends the choice of a color on Escape, which has no other effect then.
    pub(super) fn cancel_color_target(&mut self, context: &Context) {
        let is_taking = self.looks.color_target.is_some();
        if is_taking && context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            self.looks.color_target = None;
        }
    }
}
