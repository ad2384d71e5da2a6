//! Questions about files, the start page and the list of keys. Every path can be typed in the window; the system's
//! dialog is an alternative.

pub(crate) mod examples;
mod folder_list;
pub(crate) mod key_list;
pub(crate) mod new_graph;
pub(crate) mod path_question;
mod recovery_list;
pub(crate) mod start;
pub(crate) mod system_dialog;

use std::path::{Path, PathBuf};

use egui::{Button, Id, Key, Modal, RichText, Ui};

use crate::action::{Action, ExportAction, FileAction, ModelAction, Next, PaintAction};
use crate::context::{View, ViewContext};
use crate::paths::{canonical_if_present, file_name, with_ending, with_graph_ending};
use crate::settings::text_font::TextFont;
use folder_list::FolderList;
use path_question::{PathAnswer, PathQuestion};
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{OpenDocument, missing_files};
use system_dialog::{PathFor, SystemDialog};

/// Button that leads to the question for a path.
const ANOTHER_NAME: &str = "Another name…";
/// Label of the button that replaces a file.
const REPLACE: &str = "Replace it";
/// Label of the button that stops an export and closes the window.
const CANCEL_EXPORT: &str = "Cancel the export and close";

/// Reason for asking before a file is replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReplaceReason {
    /// The chosen file is not that of the open graph.
    Exists,
    /// The graph's own file was written by another program since it was read.
    WrittenByAnother,
    /// The file is open in another window.
    OpenElsewhere,
}

/// Question that has to be answered before anything else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Question {
    /// Path of a file.
    Path(PathQuestion),
    /// Treatment of changes that are not saved.
    Unsaved { next: Next },
    /// Replacement of a file whose content is not the open graph's.
    Replace { file: PathBuf, reason: ReplaceReason },
    /// Recovery of unsaved work on the open graph's file, by its index.
    Recover { at: usize },
    /// Use of the graph's own file, which another window has open.
    OpenElsewhere { file: PathBuf },
    /// Creation of the folder for a file.
    NewFolder { file: PathBuf },
    /// Closing of the window while textures are being written.
    Exporting,
}

/// The open question, and the action that follows its answer.
#[derive(Default)]
pub(crate) struct Questions {
    pub(crate) open: Option<Question>,
    /// System dialog for the requested path, while it is open.
    pub(crate) dialog: Option<SystemDialog>,
    list: FolderList,
    /// Action that follows once the graph is saved or has no changes.
    after_save: Option<Next>,
}

impl View for Questions {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let action = match self.open.take() {
            Some(Question::Path(question)) => self.path(ui, context, question),
            Some(Question::Unsaved { next }) => self.unsaved(ui, next),
            Some(Question::Replace { file, reason }) => self.replace(ui, context, file, reason),
            Some(Question::Recover { at }) => self.recover(ui, context, at),
            Some(Question::OpenElsewhere { file }) => self.open_elsewhere(ui, file),
            Some(Question::NewFolder { file }) => self.new_folder(ui, file),
            Some(Question::Exporting) => self.exporting(ui, context),
            None => None,
        };
        action.into_iter().collect()
    }
}

impl Questions {
    /// Asks for a graph file to open.
    pub(crate) fn ask_to_open(&mut self, document: &OpenDocument) {
        self.ask_path(PathFor::Open, document.session.file(), String::new());
    }

    /// Asks for a file to save the graph to.
    pub(crate) fn ask_to_save(&mut self, document: &OpenDocument) {
        self.ask_for_name(document.session.file());
    }

    /// Asks for a model file, in the folder of the one that is shown.
    pub(crate) fn ask_for_model(&mut self, shown: &Path) {
        self.ask_path(PathFor::Model, of_the_artist(shown), String::new());
    }

    /// Asks for a model file to show beside the main model.
    pub(crate) fn ask_for_model_beside(&mut self, shown: &Path) {
        self.ask_path(PathFor::ModelBeside, of_the_artist(shown), String::new());
    }

    /// Asks for a picture, or a folder of pictures, to add.
    pub(crate) fn ask_for_pictures(&mut self, document: &OpenDocument) {
        self.ask_path(PathFor::ImportedPictures, document.session.file(), String::new());
    }

    /// Asks for a file for a picture of the model's view, with a free name beside the graph.
    pub(crate) fn ask_for_picture(&mut self, document: &OpenDocument) {
        self.ask_path(PathFor::Picture, document.session.file(), free_name(document, "png"));
    }

    /// Asks for an archive to pack the graph into, with a free name beside the graph.
    pub(crate) fn ask_for_archive(&mut self, document: &OpenDocument) {
        self.ask_path(PathFor::Archive, document.session.file(), free_name(document, "zip"));
    }

    /// Asks for the new place of a missing file that the graph names.
    pub(crate) fn ask_for_missing(&mut self, document: &OpenDocument, lost: String) {
        let name = missing_files::name_of(&lost).to_owned();
        self.ask_path(PathFor::Missing(lost), document.session.file(), name);
    }

    /// Asks for an image file for a parameter.
    pub(crate) fn ask_for_image(&mut self, document: &OpenDocument, parameter: KnobTarget) {
        self.ask_path(PathFor::Image(parameter), document.session.file(), String::new());
    }

    /// Asks for an image file that a gradient is picked from.
    pub(crate) fn ask_for_gradient(&mut self, document: &OpenDocument, parameter: KnobTarget) {
        self.ask_path(PathFor::Gradient(parameter), document.session.file(), String::new());
    }

    /// Asks for a picture for the brush to stamp, or for the file of a brush.
    pub(crate) fn ask_for_brush(&mut self, document: &OpenDocument, what: PathFor) {
        self.ask_path(what, document.session.file(), String::new());
    }

    /// Asks for a path in the folder of a file, or in the folder that the program was started in.
    fn ask_path(&mut self, what: PathFor, beside: Option<&Path>, name: String) {
        self.dialog = None;
        let folder = beside.and_then(|file| canonical_if_present(file).parent().map(Path::to_owned));
        let folder = folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default(); // Without one, whole paths are typed.
        self.open = Some(Question::Path(PathQuestion::new(what, folder, name)));
    }

    /// Asks whether to make the folder of a file.
    pub(crate) fn ask_to_make_folder(&mut self, file: PathBuf) {
        self.open = Some(Question::NewFolder { file });
    }

    /// Asks whether to replace a file whose content is not the open graph's.
    pub(crate) fn ask_to_replace(&mut self, file: PathBuf, reason: ReplaceReason) {
        self.open = Some(Question::Replace { file, reason });
    }

    /// Asks how to use the graph's file, which another window has open.
    pub(crate) fn ask_about_open_file(&mut self, file: PathBuf) {
        self.open = Some(Question::OpenElsewhere { file });
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

    fn path(&mut self, ui: &Ui, context: &ViewContext<'_>, mut question: PathQuestion) -> Option<Action> {
        match question.show(ui, context, &mut self.list, &mut self.dialog) {
            PathAnswer::Chosen(path) => return Some(action_for(question.what, path)),
            PathAnswer::Closed => {
                self.after_save = None;
                self.dialog = None;
            }
            PathAnswer::Open => self.open = Some(Question::Path(question)),
        }
        None
    }

    fn unsaved(&mut self, ui: &Ui, next: Next) -> Option<Action> {
        let buttons = ["Save", "Discard", "Cancel"];
        let title = "There are changes that are not saved";
        let answer = buttons_question(ui, "unsaved question", 420.0, title, "They would be lost.", &buttons);
        match answer {
            QuestionAnswer::Button(0) => {
                self.after_save = Some(next);
                Some(Action::File(FileAction::Save))
            }
            QuestionAnswer::Button(1) => Some(Action::File(FileAction::Proceed(next))),
            QuestionAnswer::Button(_) | QuestionAnswer::Closed => None,
            QuestionAnswer::None => {
                self.open = Some(Question::Unsaved { next });
                None
            }
        }
    }

    fn replace(&mut self, ui: &Ui, context: &ViewContext<'_>, file: PathBuf, reason: ReplaceReason) -> Option<Action> {
        let text = replacement_text(&file, reason, context.settings.backups);
        let (title, is_own) = match reason {
            ReplaceReason::Exists => ("This file exists already", false),
            ReplaceReason::WrittenByAnother => ("Another program has written this file", true),
            ReplaceReason::OpenElsewhere => ("This file is open in another window", false),
        };
        let buttons: &[&str] = match is_own {
            true => &["Keep theirs beside it", REPLACE, ANOTHER_NAME],
            false => &[REPLACE, ANOTHER_NAME],
        };
        match (
            buttons_question(ui, "replace question", 460.0, title, &text, buttons),
            is_own,
        ) {
            (QuestionAnswer::Button(0), true) => return Some(Action::File(FileAction::SaveBesideTheirs)),
            (QuestionAnswer::Button(0), false) | (QuestionAnswer::Button(1), true) => {
                return Some(Action::File(FileAction::Overwrite(file)));
            }
            (QuestionAnswer::Button(_), _) => self.ask_for_name(Some(&file)),
            (QuestionAnswer::Closed, _) => self.after_save = None,
            (QuestionAnswer::None, _) => self.open = Some(Question::Replace { file, reason }),
        }
        None
    }

    fn recover(&mut self, ui: &Ui, context: &ViewContext<'_>, at: usize) -> Option<Action> {
        let recovery = context.recoveries.get(at)?;
        let text = format!(
            "Sabi ended before changes of {} were saved: {}. Without them the file is open as it was saved last, and they stay \
             on the start page.",
            context.file_or_empty().display(),
            recovery_list::dates_text(recovery)
        );
        let buttons = ["Recover the changes", "Open the file as it was saved"];
        let title = "There is unsaved work on this graph";
        match buttons_question(ui, "recovery question", 460.0, title, &text, &buttons) {
            QuestionAnswer::Button(0) => return Some(Action::File(FileAction::Ask(Next::Recover(at)))),
            QuestionAnswer::Button(_) | QuestionAnswer::Closed => {}
            QuestionAnswer::None => self.open = Some(Question::Recover { at }),
        }
        None
    }

    fn open_elsewhere(&mut self, ui: &Ui, file: PathBuf) -> Option<Action> {
        let buttons = ["Open it for reading only", "Save a copy…", "Open it anyway"];
        let text = format!(
            "{} is open in another window. If both windows save it, one takes the place of what the other has saved.",
            file.display()
        );
        let title = "This graph is open already";
        match buttons_question(ui, "open question", 460.0, title, &text, &buttons) {
            QuestionAnswer::Button(1) => self.ask_for_name(Some(&file)),
            QuestionAnswer::Button(2) => return Some(Action::File(FileAction::AllowSaving)),
            // Saving stays refused until the user allows it.
            QuestionAnswer::Button(_) | QuestionAnswer::Closed => self.after_save = None,
            QuestionAnswer::None => self.open = Some(Question::OpenElsewhere { file }),
        }
        None
    }

    fn new_folder(&mut self, ui: &Ui, file: PathBuf) -> Option<Action> {
        let folder = file.parent().unwrap_or(&file).display();
        let text = format!("There is no folder {folder} yet.");
        let buttons = ["Create it and save", ANOTHER_NAME];
        match buttons_question(ui, "folder question", 460.0, "Make a folder?", &text, &buttons) {
            QuestionAnswer::Button(0) => return Some(Action::File(FileAction::Overwrite(file))),
            QuestionAnswer::Button(_) => self.ask_for_name(Some(&file)),
            QuestionAnswer::Closed => self.after_save = None,
            QuestionAnswer::None => self.open = Some(Question::NewFolder { file }),
        }
        None
    }

    /// Asks for the path of a file to save to, beginning with the name of another one.
    fn ask_for_name(&mut self, file: Option<&Path>) {
        // A name that is not Unicode cannot be shown in the field, and a similar one would be another file.
        let name = file.and_then(Path::file_name).and_then(|name| name.to_str());
        self.ask_path(PathFor::Save, file, name.unwrap_or("untitled.sabi").to_owned());
    }

    /// Closes the window as soon as textures are written, or without them.
    fn exporting(&mut self, ui: &Ui, context: &ViewContext<'_>) -> Option<Action> {
        let buttons = [CANCEL_EXPORT, "Keep the window open"];
        let text = "The window closes when the export is done.";
        let title = "An export is running";
        let answer = buttons_question(ui, "exporting question", 420.0, title, text, &buttons);
        if matches!(answer, QuestionAnswer::Button(1) | QuestionAnswer::Closed) {
            return None;
        }
        if context.exports.running.is_none() {
            return Some(Action::File(FileAction::Proceed(Next::Close)));
        }
        // A canceled export ends soon, without leaving incomplete files.
        self.open = Some(Question::Exporting);
        (answer == QuestionAnswer::Button(0)).then_some(Action::Export(ExportAction::Cancel))
    }
}

/// Text that says what happens to a file that would be replaced.
fn replacement_text(file: &Path, reason: ReplaceReason, backups: usize) -> String {
    let (shown, name) = (file.display(), file_name(file));
    match (reason, backups) {
        (ReplaceReason::WrittenByAnother, 0) => format!(
            "{shown} was changed since it was opened or saved here. What it holds can be kept beside it, or is replaced \
             and lost, since no backups are kept."
        ),
        (ReplaceReason::WrittenByAnother, _) => format!(
            "{shown} was changed since it was opened or saved here. What it holds can be kept beside it, or is replaced \
             and stays as {name}.bak."
        ),
        (ReplaceReason::Exists | ReplaceReason::OpenElsewhere, 0) => {
            format!("{shown} would be replaced and lost, since no backups are kept.")
        }
        (ReplaceReason::Exists | ReplaceReason::OpenElsewhere, _) => {
            format!("{shown} would be replaced, and stay beside it as {name}.bak.")
        }
    }
}

/// Answer to a question with buttons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum QuestionAnswer {
    None,
    /// The button of this index.
    Button(usize),
    /// The question was closed by Escape or a click beside it.
    Closed,
}

/// Buttons that replace or stop something, which Enter does not press.
const NOT_BY_ENTER: [&str; 2] = [REPLACE, CANCEL_EXPORT];

/// Shows a question with buttons, of which the first is the suggested one. A click beside it does not answer it.
fn buttons_question(ui: &Ui, id: &str, width: f32, title: &str, text: &str, buttons: &[&str]) -> QuestionAnswer {
    let mut answer = QuestionAnswer::None;
    let modal = Modal::new(Id::new(id)).show(ui.ctx(), |ui| {
        ui.set_width(width);
        ui.heading(title);
        ui.label(text);
        ui.horizontal(|ui| {
            for (at, words) in buttons.iter().enumerate() {
                let words = RichText::new(*words);
                let words = if at == 0 { words.strong() } else { words };
                if ui.add(Button::new(words)).clicked() {
                    answer = QuestionAnswer::Button(at);
                }
            }
        });
    });
    let is_on_top = modal.is_top_modal && !modal.any_popup_open;
    let is_pressed = |key: Key| is_on_top && ui.input(|input| input.key_pressed(key));
    let by_enter = buttons.first().is_some_and(|first| !NOT_BY_ENTER.contains(first));
    match answer {
        QuestionAnswer::None if is_pressed(Key::Escape) => QuestionAnswer::Closed,
        QuestionAnswer::None if by_enter && is_pressed(Key::Enter) => QuestionAnswer::Button(0),
        answer => answer,
    }
}

/// Name with an ending that no file beside the graph has.
fn free_name(document: &OpenDocument, ending: &str) -> String {
    let file = document.session.file();
    let stem = file
        .and_then(Path::file_stem)
        .and_then(|stem| stem.to_str())
        .unwrap_or("view");
    let folder = file.and_then(Path::parent).unwrap_or(Path::new(""));
    let numbered = (2..).map(|number| format!("{stem} {number}.{ending}"));
    let mut names = std::iter::once(format!("{stem}.{ending}")).chain(numbered);
    let free = names.find(|name| !folder.join(name).exists());
    free.unwrap_or_default() // There is always one.
}

/// The shown model, if it is none of the built-in ones: those are in a hidden folder, and a menu offers them.
fn of_the_artist(shown: &Path) -> Option<&Path> {
    Some(shown).filter(|shown| !examples::is_own_model(shown))
}

/// Action for a path that was chosen.
fn action_for(what: PathFor, path: PathBuf) -> Action {
    match what {
        PathFor::Open => Action::File(FileAction::Ask(Next::Open(path))),
        PathFor::Save => Action::File(FileAction::SaveAs(with_graph_ending(path))),
        PathFor::Archive => Action::File(FileAction::Pack(with_ending(path, "zip"))),
        PathFor::Model => Action::Model(ModelAction::Show(path)),
        PathFor::ModelBeside => Action::Model(ModelAction::ShowBeside(path)),
        PathFor::Missing(lost) => Action::File(FileAction::Find { lost, file: path }),
        PathFor::ImportedPictures => Action::ImportPictures(path),
        PathFor::Picture => Action::File(FileAction::SavePicture(path.with_extension("png"))),
        PathFor::Image(parameter) => Action::File(FileAction::SetImage { parameter, file: path }),
        PathFor::Gradient(parameter) => Action::File(FileAction::PickGradient { parameter, file: path }),
        PathFor::BrushPicture => Action::Paint(PaintAction::TakePicture(path)),
        PathFor::Stencil => Action::Paint(PaintAction::TakeStencil(path)),
        PathFor::Brush => Action::Paint(PaintAction::TakeBrush(path)),
        PathFor::Font => Action::Paint(PaintAction::ChooseFont(TextFont::of_file(path))),
    }
}
