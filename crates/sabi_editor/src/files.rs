//! Files: opening, saving, the questions before work is lost, and the start page. Every path can be typed in the window; the
//! system's dialog is the convenience.

pub(crate) mod examples;
mod key_list;
mod start;
pub(crate) mod system_dialog;

use std::path::{Path, PathBuf};

use egui::{Key, Modal, RichText, Ui};
use sabi_editing::{KnobTarget, OpenDocument};
use sabi_engine::{Recovery, canonical, recoveries};

use crate::action::Action;
use crate::app::Editor;
use crate::dock::Panel;
use system_dialog::{SystemDialog, answer_of};

/// What a path is wanted for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum PathFor {
    Open,
    Save,
    Model,
    /// A knob that names a picture.
    Picture(KnobTarget),
}

/// Something that has to be answered before anything else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Question {
    /// Which file.
    Path { what: PathFor, text: String },
    /// What becomes of changes that are not saved, and what is done next.
    Unsaved { next: Next },
    /// Whether a file is replaced that is another graph's.
    Replace { file: PathBuf },
    /// The window is to be closed, and textures are being written.
    Exporting,
}

/// What comes after the work was saved or let go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    New,
    Open(PathBuf),
    Example(usize),
    Recover(usize),
    Close,
}

/// What is open of files and questions.
pub(crate) struct Files {
    pub(crate) question: Option<Question>,
    /// Whether the start page is shown.
    pub(crate) is_start: bool,
    pub(crate) shows_keys: bool,
    /// What was kept of graphs when the program ended before they were saved.
    pub(crate) recoveries: Vec<Recovery>,
    /// The system's dialog for the path that is asked for, while it is open.
    pub(crate) dialog: Option<SystemDialog>,
    /// What comes once a save is done.
    after_save: Option<Next>,
    /// Whether the window may close without another question.
    pub(crate) may_close: bool,
}

impl Files {
    pub(crate) fn new(is_start: bool, recovery_folder: Option<&Path>) -> Files {
        let recoveries = recovery_folder.map(recoveries).unwrap_or_default();
        Files {
            question: None,
            is_start: is_start || !recoveries.is_empty(),
            shows_keys: false,
            recoveries,
            dialog: None,
            after_save: None,
            may_close: false,
        }
    }

    pub(crate) fn ask_new(&mut self, document: &mut OpenDocument) {
        self.ask_next(document, Next::New);
    }

    pub(crate) fn ask_open(&mut self, document: &OpenDocument) {
        let folder = document.session.file().and_then(Path::parent);
        self.ask_path(
            PathFor::Open,
            folder
                .map(|folder| format!("{}/", folder.display()))
                .unwrap_or_default(),
        );
    }

    pub(crate) fn ask_save(&mut self, document: &OpenDocument) {
        let file = document.session.file().map(|file| file.display().to_string());
        self.ask_path(PathFor::Save, file.unwrap_or_else(|| "untitled.sabi".to_owned()));
    }

    pub(crate) fn ask_for_model(&mut self) {
        self.ask_path(PathFor::Model, String::new());
    }

    pub(crate) fn ask_for_picture(&mut self, knob: KnobTarget) {
        self.ask_path(PathFor::Picture(knob), String::new());
    }

    fn ask_path(&mut self, what: PathFor, text: String) {
        self.dialog = None;
        self.question = Some(Question::Path { what, text });
    }

    /// Asks first where something would be lost.
    pub(crate) fn ask_next(&mut self, document: &mut OpenDocument, next: Next) {
        let is_dirty = document.session.is_dirty();
        self.question = is_dirty.then_some(Question::Unsaved { next: next.clone() });
        if !is_dirty {
            self.after_save = Some(next);
        }
    }

    /// What is to be done now that nothing is lost by it. A save that failed ends it: the document stays open.
    pub(crate) fn take_next(&mut self, document: &mut OpenDocument) -> Option<Next> {
        if self.question.is_some() {
            return None;
        }
        self.after_save.take().filter(|_| !document.session.is_dirty())
    }
}

impl Editor {
    /// Shows what is asked, and the start page.
    pub(crate) fn show_files(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        if ui.input(|input| input.viewport().close_requested()) && !self.files.may_close {
            let is_held = if self.document.session.is_dirty() {
                self.files.question = Some(Question::Unsaved { next: Next::Close });
                true
            } else {
                self.is_held_open()
            };
            if is_held {
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::CancelClose);
            }
        }
        start::show(self, ui, actions);
        key_list::show(self, ui);
        match self.files.question.take() {
            Some(Question::Path { what, text }) => self.path_question(ui, what, text, actions),
            Some(Question::Unsaved { next }) => self.unsaved_question(ui, next),
            Some(Question::Replace { file }) => self.replace_question(ui, file),
            Some(Question::Exporting) => self.exporting_question(ui),
            None => {}
        }
        if let Some(next) = self.files.take_next(&mut self.document) {
            self.go_on(next, ui);
        }
    }

    fn path_question(&mut self, ui: &Ui, what: PathFor, mut text: String, actions: &mut Vec<Action>) {
        let (title, verb) = match &what {
            PathFor::Open => ("Open a graph", "Open"),
            PathFor::Save => ("Save the graph", "Save"),
            PathFor::Model => ("Add a model", "Add"),
            PathFor::Picture(_) => ("Choose a picture", "Choose"),
        };
        let mut chosen = false;
        if let Some(path) = answer_of(&mut self.files.dialog) {
            text = path.display().to_string();
            chosen = true;
        }
        let waits = self.files.dialog.is_some();
        let modal = Modal::new(egui::Id::new("path question")).show(ui.ctx(), |ui| {
            ui.set_width(460.0);
            ui.heading(title);
            let field = ui.add(
                egui::TextEdit::singleline(&mut text)
                    .desired_width(f32::INFINITY)
                    .hint_text("Path"),
            );
            field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Path"));
            chosen |= field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let buttons = ui.horizontal(|ui| {
                let does = ui.button(verb);
                let system = if waits {
                    "The system's dialog is open…"
                } else {
                    "System dialog…"
                };
                let asks_system = ui.add_enabled(!waits, egui::Button::new(system));
                [does, asks_system, ui.button("Cancel")]
            });
            let [does, asks_system, cancels] = buttons.inner;
            let has_focus = [&field, &does, &asks_system, &cancels]
                .iter()
                .any(|part| part.has_focus());
            if !has_focus && !field.lost_focus() {
                field.request_focus();
            }
            chosen |= does.clicked();
            if asks_system.clicked() {
                self.files.dialog = Some(SystemDialog::file(ui.ctx(), &what, &text));
            }
            cancels.clicked()
        });
        let path = PathBuf::from(text.trim());
        if chosen && !path.as_os_str().is_empty() {
            self.take_path(what, path, actions);
        } else if !modal.inner && !modal.should_close() {
            self.files.question = Some(Question::Path { what, text });
        } else {
            self.files.after_save = None;
            self.files.dialog = None;
        }
    }

    /// Does with a path what it was asked for.
    fn take_path(&mut self, what: PathFor, path: PathBuf, actions: &mut Vec<Action>) {
        match what {
            PathFor::Open => self.files.ask_next(&mut self.document, Next::Open(path)),
            // At once, since an action that closes the document may wait for it.
            PathFor::Save => self.save_unless_taken(with_ending(path)),
            PathFor::Model => actions.push(Action::TakeModel(path)),
            PathFor::Picture(knob) => {
                let text = self.document.relative(&path);
                self.document.set_at(&knob, sabi_graph::Value::Text(text));
            }
        }
    }

    fn unsaved_question(&mut self, ui: &Ui, next: Next) {
        let mut answer = None;
        let modal = Modal::new(egui::Id::new("unsaved question")).show(ui.ctx(), |ui| {
            ui.set_width(420.0);
            ui.heading("There are changes that are not saved");
            ui.label("They would be lost.");
            ui.horizontal(|ui| {
                let save = egui::Button::new(RichText::new("Save").strong());
                if ui.add(save).clicked() {
                    answer = Some(Some(true));
                }
                if ui.button("Let them go").clicked() {
                    answer = Some(Some(false));
                }
                if ui.button("Cancel").clicked() {
                    answer = Some(None);
                }
            });
        });
        match answer {
            Some(Some(true)) => {
                self.files.after_save = Some(next);
                self.save();
            }
            Some(Some(false)) => self.go_on(next, ui),
            Some(None) => {}
            None if modal.should_close() => {}
            None => self.files.question = Some(Question::Unsaved { next }),
        }
    }

    /// Whether something else than the graph keeps the window from closing; what that is, is said.
    fn is_held_open(&mut self) -> bool {
        if self.panels.page.show_unsaved() {
            self.bring_up(Panel::Page);
            self.say("The text of a node is not saved: save it or let it go, then close the window.");
            return true;
        }
        let is_exporting = self.panels.export.running.is_some();
        if is_exporting {
            self.files.question = Some(Question::Exporting);
        }
        is_exporting
    }

    /// Closes the window as soon as textures are written, or without them.
    fn exporting_question(&mut self, ui: &Ui) {
        let mut answer = None;
        let modal = Modal::new(egui::Id::new("exporting question")).show(ui.ctx(), |ui| {
            ui.set_width(420.0);
            ui.heading("Textures are being written");
            ui.label("The window closes when they are done.");
            ui.horizontal(|ui| {
                if ui.button("Close without them").clicked() {
                    answer = Some(true);
                }
                if ui.button("Stay").clicked() {
                    answer = Some(false);
                }
            });
        });
        match answer {
            Some(true) => self.panels.export.cancel(),
            Some(false) => return,
            None if modal.should_close() => return,
            None => {}
        }
        // What was canceled ends soon, and leaves no half files then.
        match self.panels.export.running {
            Some(_) => self.files.question = Some(Question::Exporting),
            None => self.go_on(Next::Close, ui),
        }
    }

    /// Saves under a name, unless a file is there that is another graph's: then that is asked about.
    fn save_unless_taken(&mut self, file: PathBuf) {
        let whole = |path: &Path| canonical(path).ok();
        let own = self.document.session.file().and_then(whole);
        match whole(&file) {
            Some(found) if Some(&found) != own.as_ref() => self.files.question = Some(Question::Replace { file }),
            _ => self.save_to(&file),
        }
    }

    fn replace_question(&mut self, ui: &Ui, file: PathBuf) {
        let mut answer = None;
        let modal = Modal::new(egui::Id::new("replace question")).show(ui.ctx(), |ui| {
            ui.set_width(460.0);
            ui.heading("There is such a file already");
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            ui.label(format!(
                "{} would be replaced, and stay beside it as {name}.bak.",
                file.display()
            ));
            ui.horizontal(|ui| {
                if ui.button("Replace it").clicked() {
                    answer = Some(Some(()));
                }
                if ui.button("Another name…").clicked() {
                    answer = Some(None);
                }
            });
        });
        match answer {
            Some(Some(())) => self.save_to(&file),
            Some(None) => self.files.ask_path(PathFor::Save, file.display().to_string()),
            None if modal.should_close() => self.files.after_save = None,
            None => self.files.question = Some(Question::Replace { file }),
        }
    }

    /// Does what was waiting for an answer.
    fn go_on(&mut self, next: Next, ui: &Ui) {
        match next {
            Next::New => {
                let session = sabi_engine::Session::new(self.recovery_folder());
                self.take_session(session);
            }
            Next::Open(path) => self.open_file(&path),
            Next::Example(at) => self.open_example(at),
            Next::Recover(at) => self.recover(at),
            Next::Close if self.is_held_open() => {}
            Next::Close => {
                self.files.may_close = true;
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }
}

/// A file by its one name, where it is there.
pub(crate) fn whole(file: &Path) -> PathBuf {
    canonical(file).unwrap_or_else(|_| file.to_owned())
}

/// A file whose folder is the one of its name. What a link leads to may have another name, and others beside it.
pub(crate) fn in_whole_folder(file: &Path) -> PathBuf {
    match (file.parent(), file.file_name()) {
        (Some(folder), Some(name)) => whole(folder).join(name),
        _ => file.to_owned(),
    }
}

/// A graph file ends in .sabi, whatever was typed.
fn with_ending(path: PathBuf) -> PathBuf {
    let is_graph = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case(sabi_editing::GRAPH_EXTENSION));
    let Some(name) = path.file_name().filter(|_| !is_graph) else {
        return path;
    };
    let mut name = name.to_owned();
    name.push(".");
    name.push(sabi_editing::GRAPH_EXTENSION);
    path.with_file_name(name)
}
