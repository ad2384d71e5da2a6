//! Questions about files, the start page and the list of keys. Every path can be typed in the window; the system's dialog is
//! the convenience.

pub(crate) mod examples;
pub(crate) mod key_list;
pub(crate) mod start;
pub(crate) mod system_dialog;

use std::path::{Path, PathBuf};

use egui::{Button, Id, Key, Modal, RichText, TextEdit, Ui, WidgetInfo, WidgetType};

use crate::action::{Action, ExportAction, FileAction, ModelAction, Next};
use crate::context::{View, ViewContext};
use crate::paths::{file_name, with_graph_ending};
use sabi_editing::OpenDocument;
use sabi_editing::knob_target::KnobTarget;
use system_dialog::{PathFor, SystemDialog, answer_of};

/// Reason for asking before a file is replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReplaceReason {
    /// The chosen file is not that of the open graph.
    Exists,
    /// The graph's own file was written by another program since it was read.
    WrittenByAnother,
}

/// Question that has to be answered before anything else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Question {
    /// Path of a file.
    Path { what: PathFor, text: String },
    /// Treatment of changes that are not saved.
    Unsaved { next: Next },
    /// Replacement of a file whose content is not the open graph's.
    Replace { file: PathBuf, reason: ReplaceReason },
    /// Closing of the window while textures are being written.
    Exporting,
}

/// The open question, and the action that follows its answer.
#[derive(Default)]
pub(crate) struct Questions {
    pub(crate) open: Option<Question>,
    /// System dialog for the requested path, while it is open.
    pub(crate) dialog: Option<SystemDialog>,
    /// Action that follows once the graph is saved or has no changes.
    after_save: Option<Next>,
}

impl View for Questions {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let action = match self.open.take() {
            Some(Question::Path { what, text }) => self.path(ui, what, text),
            Some(Question::Unsaved { next }) => self.unsaved(ui, next),
            Some(Question::Replace { file, reason }) => self.replace(ui, file, reason),
            Some(Question::Exporting) => self.exporting(ui, context),
            None => None,
        };
        action.into_iter().collect()
    }
}

impl Questions {
    /// Asks for a graph file to open.
    pub(crate) fn ask_to_open(&mut self, document: &OpenDocument) {
        let folder = document.session.file().and_then(Path::parent);
        let folder = folder.map_or_else(String::new, |folder| format!("{}/", folder.display()));
        self.ask_path(PathFor::Open, folder);
    }

    /// Asks for a file to save the graph to.
    pub(crate) fn ask_to_save(&mut self, document: &OpenDocument) {
        // A path that is not Unicode cannot be shown in the field, and a similar one would be another file.
        let file = document.session.file().and_then(Path::to_str);
        self.ask_path(PathFor::Save, file.unwrap_or("untitled.sabi").to_owned());
    }

    /// Asks for a model file.
    pub(crate) fn ask_for_model(&mut self) {
        self.ask_path(PathFor::Model, String::new());
    }

    /// Asks for an image file for a parameter.
    pub(crate) fn ask_for_image(&mut self, parameter: KnobTarget) {
        self.ask_path(PathFor::Image(parameter), String::new());
    }

    fn ask_path(&mut self, what: PathFor, text: String) {
        self.dialog = None;
        self.open = Some(Question::Path { what, text });
    }

    /// Asks whether to replace a file whose content is not the open graph's.
    pub(crate) fn ask_to_replace(&mut self, file: PathBuf, reason: ReplaceReason) {
        self.open = Some(Question::Replace { file, reason });
    }

    /// Continues with another graph, and asks first if changes would be lost.
    pub(crate) fn ask_next(&mut self, is_dirty: bool, next: Next) {
        if is_dirty {
            self.open = Some(Question::Unsaved { next });
        } else {
            self.open = None;
            self.after_save = Some(next);
        }
    }

    /// Takes the action that follows once no changes are lost by it. After a save that failed, nothing follows.
    pub(crate) fn take_next(&mut self, is_dirty: bool) -> Option<Next> {
        if self.open.is_some() {
            return None;
        }
        self.after_save.take().filter(|_| !is_dirty)
    }

    fn path(&mut self, ui: &Ui, what: PathFor, mut text: String) -> Option<Action> {
        let (title, verb) = match &what {
            PathFor::Open => ("Open a graph", "Open"),
            PathFor::Save => ("Save the graph", "Save"),
            PathFor::Model => ("Add a model", "Add"),
            PathFor::Image(_) => ("Choose a picture", "Choose"),
        };
        // The system's dialog also gives paths that are not Unicode, which the field cannot hold.
        let picked = answer_of(&mut self.dialog);
        let mut chosen = picked.is_some();
        let waits = self.dialog.is_some();
        let modal = Modal::new(Id::new("path question")).show(ui.ctx(), |ui| {
            ui.set_width(460.0);
            ui.heading(title);
            let edit = TextEdit::singleline(&mut text).desired_width(f32::INFINITY);
            let field = ui.add(edit.hint_text("Path"));
            field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Path"));
            chosen |= field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let buttons = ui.horizontal(|ui| {
                let confirms = ui.button(verb);
                let system = if waits {
                    "The system's dialog is open…"
                } else {
                    "System dialog…"
                };
                let opens_dialog = ui.add_enabled(!waits, Button::new(system));
                [confirms, opens_dialog, ui.button("Cancel")]
            });
            let [confirms, opens_dialog, cancels] = buttons.inner;
            let has_focus = [&field, &confirms, &opens_dialog, &cancels]
                .iter()
                .any(|part| part.has_focus());
            if !has_focus && !field.lost_focus() {
                field.request_focus();
            }
            chosen |= confirms.clicked();
            if opens_dialog.clicked() {
                self.dialog = Some(SystemDialog::file(ui.ctx(), &what, &text));
            }
            cancels.clicked()
        });
        let path = picked.unwrap_or_else(|| PathBuf::from(text.trim()));
        if chosen && !path.as_os_str().is_empty() {
            return Some(action_for(what, path));
        }
        if modal.inner || modal.should_close() {
            self.after_save = None;
            self.dialog = None;
        } else {
            self.open = Some(Question::Path { what, text });
        }
        None
    }

    fn unsaved(&mut self, ui: &Ui, next: Next) -> Option<Action> {
        let buttons = ["Save", "Discard", "Cancel"];
        let title = "There are changes that are not saved";
        let answer = buttons_question(ui, "unsaved question", 420.0, title, "They would be lost.", &buttons);
        match answer {
            Answer::Button(0) => {
                self.after_save = Some(next);
                Some(Action::File(FileAction::Save))
            }
            Answer::Button(1) => Some(Action::File(FileAction::Proceed(next))),
            Answer::Button(_) | Answer::Closed => None,
            Answer::None => {
                self.open = Some(Question::Unsaved { next });
                None
            }
        }
    }

    fn replace(&mut self, ui: &Ui, file: PathBuf, reason: ReplaceReason) -> Option<Action> {
        let buttons = ["Replace it", "Another name…"];
        let text = format!(
            "{} would be replaced, and stay beside it as {}.bak.",
            file.display(),
            file_name(&file)
        );
        let title = match reason {
            ReplaceReason::Exists => "This file exists already",
            ReplaceReason::WrittenByAnother => "Another program has written this file",
        };
        match buttons_question(ui, "replace question", 460.0, title, &text, &buttons) {
            Answer::Button(0) => return Some(Action::File(FileAction::Overwrite(file))),
            Answer::Button(_) => self.ask_path(PathFor::Save, file.display().to_string()),
            Answer::Closed => self.after_save = None,
            Answer::None => self.open = Some(Question::Replace { file, reason }),
        }
        None
    }

    /// Closes the window as soon as textures are written, or without them.
    fn exporting(&mut self, ui: &Ui, context: &ViewContext<'_>) -> Option<Action> {
        let buttons = ["Close without them", "Stay"];
        let text = "The window closes when they are done.";
        let title = "Textures are being written";
        let answer = buttons_question(ui, "exporting question", 420.0, title, text, &buttons);
        if matches!(answer, Answer::Button(1) | Answer::Closed) {
            return None;
        }
        if context.exports.running.is_none() {
            return Some(Action::File(FileAction::Proceed(Next::Close)));
        }
        // A canceled export ends soon, without leaving incomplete files.
        self.open = Some(Question::Exporting);
        (answer == Answer::Button(0)).then_some(Action::Export(ExportAction::Cancel))
    }
}

/// Answer to a question with buttons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    None,
    /// The button of this index.
    Button(usize),
    /// The question was closed by Escape or a click beside it.
    Closed,
}

/// Shows a question with buttons, of which the first is the suggested one.
fn buttons_question(ui: &Ui, id: &str, width: f32, title: &str, text: &str, buttons: &[&str]) -> Answer {
    let mut answer = Answer::None;
    let modal = Modal::new(Id::new(id)).show(ui.ctx(), |ui| {
        ui.set_width(width);
        ui.heading(title);
        ui.label(text);
        ui.horizontal(|ui| {
            for (at, words) in buttons.iter().enumerate() {
                let words = RichText::new(*words);
                let words = if at == 0 { words.strong() } else { words };
                if ui.add(Button::new(words)).clicked() {
                    answer = Answer::Button(at);
                }
            }
        });
    });
    match answer {
        Answer::None if modal.should_close() => Answer::Closed,
        answer => answer,
    }
}

/// Action for a path that was chosen.
fn action_for(what: PathFor, path: PathBuf) -> Action {
    match what {
        PathFor::Open => Action::File(FileAction::Ask(Next::Open(path))),
        PathFor::Save => Action::File(FileAction::SaveAs(with_graph_ending(path))),
        PathFor::Model => Action::Model(ModelAction::Show(path)),
        PathFor::Image(parameter) => Action::File(FileAction::SetImage { parameter, file: path }),
    }
}
