//! Operations that involve several owners: opening and saving, the model, closing the window, and files that change.

mod recovery;

use std::path::Path;
use std::time::Duration;

use egui::{Context, Key, Modifiers, Ui, ViewportCommand};
use sabi_editing::{library, node_paths, nodes};
use sabi_engine::catalog::node_file::NodeDraft;
use sabi_engine::{ErrorKind, Session};
use sabi_files::{io_reason, path_text};
use sabi_surface::load::MODEL_ENDINGS;

use super::saving::claim_file;
use super::shell::Shell;
use super::{Editor, trust};
use crate::action::{LibraryKind, Next};
use crate::dock::Panel;
use crate::exports::ExportSource;
use crate::files::Question;
use crate::files::{examples, new_graph};
use crate::model_view::ModelView;
use crate::notices::Work;
use crate::paths::{IMAGES, canonical_if_present, lowercase_ending};
use crate::saved_pictures::OF_GROUP;

/// Time until the next check whether files are watched.
const WATCH_AGAIN: Duration = Duration::from_millis(100);

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
            self.documents.recoveries.look();
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
                .fail(format!("{} cannot be written: {}", folder.display(), io_reason(&error))),
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
        self.remember_choices();
        let model = self.documents.replace(&self.shell.context, session);
        claim_file(&mut self.documents, &mut self.views.questions);
        self.recall_choices();
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

    /// Starts an export with the choices of its panel.
    pub(crate) fn export(&mut self, force: bool) {
        let source = ExportSource {
            document: &self.documents.document,
            evaluation: &self.evaluation,
            choices: &self.shell.settings.export,
        };
        let started = self.exports.start(&self.shell.context, source, force);
        self.shell.report_on(Work::Export, started);
    }

    /// Takes the results of exports, and reports a failure even if the export panel is hidden.
    pub(super) fn follow_exports(&mut self, context: &Context) {
        let Some(folder) = self.exports.poll(context) else {
            return;
        };
        match &self.exports.result {
            Some(Err(error)) if error.kind != ErrorKind::Interrupted => {
                let folder = folder.display();
                self.shell.notices.fail(
                    Work::Export,
                    format!("The textures were not exported to {folder}: {error}"),
                );
            }
            Some(Ok(_)) => self.shell.notices.succeed(Work::Export),
            _ => {}
        }
    }

    /// Restores the export target and the strip of models that the open graph had before.
    pub(super) fn recall_choices(&mut self) {
        let file = self.documents.document.session.file();
        let place = file.map(|file| self.shell.settings.export_place(file).beside(file));
        let models = file.map(|file| self.shell.settings.model_strip(file));
        // A graph without a file has an empty strip; the shown model joins it.
        self.documents.models = models.unwrap_or_default();
        // A graph without a file has an empty target.
        self.exports.turn_to(place.unwrap_or_default());
    }

    /// Remembers the export target and the strip of models of the open graph.
    pub(super) fn remember_choices(&mut self) {
        if let Some(file) = self.documents.document.session.file() {
            self.shell.settings.remember_export(file, &self.exports.place);
            self.shell.settings.remember_model_strip(file, &self.documents.models);
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
            let result = crate::shown_results::result_of(&documents.document, id, None);
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
        if let Some(file) = self.shell.report(node.save(self.documents.document.session.disk())) {
            self.shell.notify(format!(
                "'{id}' is in {}, and among the nodes that can be added.",
                file.display()
            ));
            trust::trust_nodes(&mut self.documents, &mut self.shell, folder);
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

    /// Mutes nodes that keep the device busy for too long. For a node in a group, the group is muted.
    pub(super) fn mute_what_takes_too_long(&mut self) {
        let document = &mut self.documents.document;
        for full_id in &self.evaluation.faults.all.too_long {
            let title = node_paths::title(document, full_id);
            let of_main_graph = full_id.split('/').next().and_then(|id| id.parse().ok());
            if of_main_graph.is_some_and(|id| nodes::mute_in_main_graph(document, &id)) {
                self.shell.notify(format!(
                    "'{title}' keeps the device busy for too long and is muted. Change it before you unmute it."
                ));
            }
        }
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
        let documents = &mut self.documents;
        documents
            .kinds_reading
            .take(&self.shell.context, &mut documents.document);
        let Some(changes) = self.documents.watching.changes() else {
            return;
        };
        if changes.nodes {
            let folders = sabi_editing::trust::node_folders(&self.documents.document);
            self.documents.reread_kinds(&self.shell.context, &folders);
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

    /// Ends the choice of a color on Escape, which has no other effect then.
    pub(super) fn cancel_color_target(&mut self, context: &Context) {
        let is_taking = self.looks.color_target.is_some();
        if is_taking && context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            self.looks.color_target = None;
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

/// Lights the model by a file.
fn use_environment(model: &mut ModelView, shell: &mut Shell, path: &Path) {
    let Some(choice) = shell.report(path_text(&canonical_if_present(path))) else {
        return;
    };
    model.environment.choose(&choice);
    model.environment.read_again();
    shell.settings.environment = choice;
}
