//! The question for a path: a field for its name, and folders and files to choose from.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::{
    Button, Event, EventFilter, Id, Key, Label, Modal, Response, RichText, ScrollArea, TextEdit, Ui, WidgetInfo,
    WidgetType,
};
use egui_phosphor::regular as icon;

use super::examples;
use super::folder_list::{FolderEntry, FolderList, completed};
use super::system_dialog::{DialogAnswer, NO_DIALOG, PathFor, SystemDialog, answer_of};
use crate::context::ViewContext;
use crate::paths::{canonical_if_present, file_name, with_ending};
use crate::saved_pictures::OF_GRAPH;
use crate::theme::{Theme, space, type_size};

/// Width of the question, of its places, and height of its list, points.
const WIDTH: f32 = 620.0;
const PLACES: f32 = 150.0;
const HEIGHT: f32 = 260.0;
/// Side of the pictures of graphs, points.
const PICTURE: f32 = 36.0;
/// Most folders among the places.
const MOST_PLACES: usize = 9;

/// A question for a path that is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PathQuestion {
    pub(crate) what: PathFor,
    /// Folder that a typed name is in, unless a whole path is typed.
    folder: PathBuf,
    text: String,
    /// Typed part of a name, which narrows the list. A name that was chosen in the list does not narrow it.
    typed: String,
    /// Entry that was clicked last.
    clicked: Option<PathBuf>,
    /// True before it was drawn.
    is_new: bool,
    /// True if the system's dialog was asked for and could not be opened.
    has_no_dialog: bool,
}

/// Answer to the question in a frame.
pub(super) enum PathAnswer {
    Open,
    Closed,
    Chosen(PathBuf),
}

impl PathQuestion {
    /// Asks for a path in a folder, with a name to begin with.
    pub(super) fn new(what: PathFor, folder: PathBuf, name: String) -> PathQuestion {
        PathQuestion {
            what,
            folder,
            text: name,
            typed: String::new(),
            clicked: None,
            is_new: true,
            has_no_dialog: false,
        }
    }

    /// Shows the question. `dialog` is the system's dialog while it is open.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        context: &ViewContext<'_>,
        list: &mut FolderList,
        dialog: &mut Option<SystemDialog>,
    ) -> PathAnswer {
        // The system's dialog also gives paths that are not Unicode, which the field cannot hold.
        let mut chosen = match answer_of(dialog) {
            Some(DialogAnswer::Chosen(path)) => Some(path),
            Some(DialogAnswer::NotOpened) => {
                self.has_no_dialog = true;
                None
            }
            Some(DialogAnswer::Closed) | None => None,
        };
        let modal = Modal::new(Id::new("path question")).show(ui.ctx(), |ui| {
            ui.set_width(WIDTH);
            ui.heading(self.what.title());
            let (field, is_entered) = self.field(ui, list);
            let listed = self.listed().0;
            self.location(ui, &listed, context.theme);
            ui.horizontal_top(|ui| {
                self.places(ui, context);
                let entries = ui.vertical(|ui| self.entries(ui, &listed, list, context));
                if entries.inner {
                    chosen = Some(self.target());
                }
            });
            ui.separator();
            let fault = self.fault();
            let buttons = ui.horizontal(|ui| {
                let verb = if self.takes_folder() {
                    "Import the folder"
                } else {
                    self.what.verb()
                };
                let confirms = ui.add_enabled(fault.is_none(), Button::new(verb));
                let confirms = confirms.on_disabled_hover_text(fault.unwrap_or_default()); // Shown where there is one.
                let words = if dialog.is_some() {
                    "The system's dialog is open…"
                } else {
                    "System dialog…"
                };
                let opens_dialog = ui.add_enabled(dialog.is_none(), Button::new(words));
                [confirms, opens_dialog, ui.button("Cancel")]
            });
            let [confirms, opens_dialog, cancels] = buttons.inner;
            if self.has_no_dialog {
                let text = RichText::new(format!("{NO_DIALOG} Type a path, or choose from the list."));
                ui.add(Label::new(text.color(context.theme.warning)).wrap());
            }
            if (confirms.clicked() || is_entered) && fault.is_none() {
                chosen = Some(self.target());
            } else if is_entered && self.target().is_dir() {
                self.enter(self.target());
            } else if let Some(entry) = self.only_match(&listed, list).filter(|_| is_entered) {
                let path = listed.join(&entry.name);
                match entry.is_file {
                    true => chosen = Some(path),
                    false => self.enter(path),
                }
            }
            if opens_dialog.clicked() {
                self.has_no_dialog = false;
                let typed = self.target().display().to_string();
                *dialog = Some(SystemDialog::file(ui.ctx(), &self.what, &typed));
            }
            if ui.memory(|memory| memory.focused().is_none()) {
                field.request_focus();
            }
            cancels.clicked()
        });
        match chosen {
            Some(path) => PathAnswer::Chosen(path),
            None if modal.inner || modal.should_close() => PathAnswer::Closed,
            None => PathAnswer::Open,
        }
    }

    /// The only entry whose name contains what was typed, if a file is read.
    fn only_match(&self, listed: &Path, list: &mut FolderList) -> Option<FolderEntry> {
        let part = self.typed.to_lowercase();
        if part.is_empty() || self.what.is_written() {
            return None;
        }
        let entries = list.of(listed, self.what.endings()).ok()?; // A fault is shown in the list.
        let mut matches = entries.iter().filter(|entry| entry.name.to_lowercase().contains(&part));
        let only = matches.next()?;
        matches.next().is_none().then(|| only.clone())
    }

    /// Path that is typed or chosen.
    fn target(&self) -> PathBuf {
        self.folder.join(self.text.trim())
    }

    /// Reason why the path cannot be chosen.
    fn fault(&self) -> Option<&'static str> {
        let target = self.target();
        if self.takes_folder() {
            return None;
        }
        if self.text.trim().is_empty() {
            return Some("Choose or type a name.");
        }
        if !self.what.is_written() {
            return (!target.is_file()).then_some("There is no such file.");
        }
        if target.is_dir() {
            return Some("This is a folder.");
        }
        let is_taken = match self.what {
            PathFor::Picture => target.with_extension("png").exists(),
            PathFor::Archive => with_ending(target, "zip").exists(),
            _ => false,
        };
        is_taken.then_some("There is a file of this name already; choose another one.")
    }

    /// Returns whether the folder that is listed, or typed, is chosen as a whole.
    fn takes_folder(&self) -> bool {
        self.what == PathFor::ImportedPictures && self.target().is_dir()
    }

    /// Folder that is listed for the typed text, and the part of a name in it.
    fn listed(&self) -> (PathBuf, String) {
        let text = self.text.trim_start();
        match text.rfind(std::path::is_separator) {
            Some(at) => (self.folder.join(&text[..=at]), text[at + 1..].to_owned()),
            None => (self.folder.clone(), text.to_owned()),
        }
    }

    /// Goes to a folder. The name stays, if it is that of a file to write or to find.
    fn enter(&mut self, folder: PathBuf) {
        let name = self.listed().1;
        self.text = match self.what {
            PathFor::Save | PathFor::Archive | PathFor::Picture | PathFor::Missing(_) if !folder.ends_with(&name) => {
                name
            }
            _ => String::new(),
        };
        self.typed.clear();
        self.folder = canonical_if_present(&folder);
    }

    /// Field for the name. Returns whether Enter was pressed in it.
    fn field(&mut self, ui: &mut Ui, list: &mut FolderList) -> (Response, bool) {
        let id = ui.make_persistent_id("path");
        self.take_pasted_path(ui, id);
        let mut output = TextEdit::singleline(&mut self.text)
            .id(id)
            .hint_text("Name or path")
            .desired_width(f32::INFINITY)
            .show(ui);
        let field = output.response.response.clone();
        field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Path"));
        let (listed, part) = self.listed();
        if field.changed() {
            self.typed.clone_from(&part);
        }
        let names = list.of(&listed, self.what.endings());
        let names = names.unwrap_or_default().iter().map(|entry| entry.name.as_str()); // A fault is shown in the list.
        let completion = completed(&part, names).filter(|_| !part.is_empty());
        let select = |range: [usize; 2]| CCursorRange::two(CCursor::new(range[0]), CCursor::new(range[1]));
        if field.has_focus() {
            // Tab completes a name, and leads to the buttons where there is nothing to complete.
            let filter = EventFilter {
                tab: completion.is_some(),
                horizontal_arrows: true,
                vertical_arrows: true,
                ..EventFilter::default()
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
            if let Some(name) = completion.filter(|_| ui.input(|input| input.key_pressed(Key::Tab))) {
                self.text.truncate(self.text.len() - part.len());
                self.text += &name;
                self.typed = name;
                let end = self.text.chars().count();
                output.state.cursor.set_char_range(Some(select([end, end])));
                output.state.clone().store(ui.ctx(), id);
            }
        }
        if std::mem::take(&mut self.is_new) {
            field.request_focus();
            // Selects the name that is written without its ending, so that the ending stays when another name is typed. A
            // file that is read has an ending of its own.
            let replaced = match self.what.is_written() {
                true => Path::new(&self.text).file_stem().unwrap_or_default().to_string_lossy(), // No name has no stem.
                false => Cow::Borrowed(self.text.as_str()),
            };
            let end = replaced.chars().count();
            output.state.cursor.set_char_range(Some(select([0, end])));
            output.state.store(ui.ctx(), id);
        }
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        (field, is_entered)
    }

    /// Replaces the text by a whole path that is pasted, wherever the caret is.
    fn take_pasted_path(&mut self, ui: &Ui, id: Id) {
        if !ui.memory(|memory| memory.has_focus(id)) {
            return;
        }
        ui.input_mut(|input| {
            input.events.retain(|event| {
                let Event::Paste(text) = event else { return true };
                let is_whole = Path::new(text.trim()).is_absolute();
                if is_whole {
                    text.trim().clone_into(&mut self.text);
                }
                !is_whole
            });
        });
    }

    /// The listed folder, and the way up.
    fn location(&mut self, ui: &mut Ui, listed: &Path, theme: &Theme) {
        ui.horizontal(|ui| {
            let listed = canonical_if_present(listed);
            let up = ui.add_enabled(listed.parent().is_some(), Button::new(icon::ARROW_UP));
            up.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "To the folder above"));
            if let Some(above) = listed
                .parent()
                .filter(|_| up.on_hover_text("To the folder above").clicked())
            {
                self.enter(above.to_owned());
            }
            let path = RichText::new(listed.display().to_string()).color(theme.quiet);
            ui.add(Label::new(path).truncate());
        });
    }

    /// The home folder, that of the built-in models, and folders that were used before.
    fn places(&mut self, ui: &mut Ui, context: &ViewContext<'_>) {
        ui.vertical(|ui| {
            ui.set_width(PLACES);
            let mut place = |ui: &mut Ui, sign: &str, name: &str, folder: PathBuf| {
                let button = ui.add(Button::new(format!("{sign} {name}")).frame(false).truncate());
                button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
                if button.on_hover_text(folder.display().to_string()).clicked() {
                    self.enter(folder);
                }
            };
            let home = std::env::home_dir();
            let examples = context.examples.and_then(examples::models_folder);
            let recent = recent_folders(context).into_iter();
            let recent = recent.filter(|folder| ![&home, &examples].contains(&&Some(folder.clone())));
            let recent: Vec<PathBuf> = recent.collect();
            if let Some(home) = home.clone() {
                place(ui, icon::HOUSE, "Home", home);
            }
            if let Some(examples) = examples.clone().filter(|folder| folder.is_dir()) {
                place(ui, icon::CUBE, "Examples", examples);
            }
            if !recent.is_empty() {
                ui.add_space(space::TIGHT);
                ui.label(
                    RichText::new("RECENT")
                        .size(type_size::SMALL)
                        .color(context.theme.quiet),
                );
            }
            for folder in recent {
                place(ui, icon::FOLDER, &file_name(&folder), folder.clone());
            }
        });
    }

    /// Folders and files of the listed folder. Returns whether a file was double-clicked.
    fn entries(&mut self, ui: &mut Ui, listed: &Path, list: &mut FolderList, context: &ViewContext<'_>) -> bool {
        let theme = context.theme;
        let part = self.typed.to_lowercase();
        let narrows = self.what != PathFor::Save;
        let is_shown = |entry: &&FolderEntry| !narrows || entry.name.to_lowercase().contains(&part);
        let entries: Vec<FolderEntry> = match list.of(listed, self.what.endings()) {
            Ok(entries) => entries.iter().filter(is_shown).cloned().collect(),
            Err(fault) => {
                ui.add(Label::new(RichText::new(fault).color(theme.fault)).wrap());
                return false;
            }
        };
        if entries.is_empty() {
            let sentence = match narrows && !part.is_empty() {
                true => format!("No name here contains '{}'.", self.typed),
                false => {
                    let endings: Vec<String> = self.what.endings().iter().map(|ending| format!(".{ending}")).collect();
                    // Users who look for other files here are told where those are opened.
                    let elsewhere = if self.what == PathFor::Open {
                        " Pictures are added by Import pictures… in the File menu, models by + above the 3D view."
                    } else {
                        ""
                    };
                    format!(
                        "There are no folders here, and no {} files.{elsewhere}",
                        endings.join(", ")
                    )
                }
            };
            ui.add(Label::new(RichText::new(sentence).color(theme.quiet)).wrap());
        }
        let mut is_chosen = false;
        // Graphs are known by their pictures, which need higher rows.
        let has_pictures = self.what == PathFor::Open;
        let row = if has_pictures {
            PICTURE
        } else {
            ui.spacing().interact_size.y
        };
        let area = ScrollArea::vertical().max_height(HEIGHT).min_scrolled_height(HEIGHT);
        area.auto_shrink(false).show_rows(ui, row, entries.len(), |ui, rows| {
            for entry in &entries[rows] {
                let path = listed.join(&entry.name);
                let is_selected = entry.is_file && path == self.target();
                let picture = (has_pictures && entry.is_file).then(|| context.pictures.find(ui.ctx(), &path, OF_GRAPH));
                let label = entry_row(ui, entry, picture.flatten(), is_selected, row);
                if !label.clicked() {
                    continue;
                }
                // The second click of a double click may lie on an entry of another folder, which the first one opened.
                let is_same = self.clicked.as_ref() == Some(&path);
                if label.double_clicked() && !is_same {
                    continue;
                }
                is_chosen |= label.double_clicked() && entry.is_file;
                self.clicked = Some(path.clone());
                if entry.is_file {
                    listed.clone_into(&mut self.folder);
                    self.text.clone_from(&entry.name);
                } else {
                    self.enter(path);
                }
            }
        });
        is_chosen
    }
}

/// A folder or file as a row that can be clicked, with its picture where there is one.
fn entry_row(
    ui: &mut Ui,
    entry: &FolderEntry,
    picture: Option<egui::TextureId>,
    is_selected: bool,
    height: f32,
) -> egui::Response {
    let button = match picture {
        Some(picture) => {
            let image = egui::Image::new((picture, egui::Vec2::splat(PICTURE)));
            let button = Button::image_and_text(image, &entry.name).selected(is_selected);
            button.frame_when_inactive(false)
        }
        None => {
            let sign = if entry.is_file { icon::FILE } else { icon::FOLDER };
            let button = Button::selectable(is_selected, format!("{sign} {}", entry.name));
            button.min_size(egui::vec2(0.0, height))
        }
    };
    let response = ui.add(button);
    response.widget_info(|| WidgetInfo::selected(WidgetType::Button, true, is_selected, &entry.name));
    response
}

/// Folders of the open graph, of recent graphs and of models, each once.
fn recent_folders(context: &ViewContext<'_>) -> Vec<PathBuf> {
    let own = context.document.session.file().map(Path::to_owned);
    let files = own
        .iter()
        .chain(&context.settings.recent)
        .chain(&context.settings.models);
    let folders = files.filter_map(|file| file.parent().map(Path::to_owned));
    let mut places: Vec<PathBuf> = Vec::new();
    for folder in folders {
        if folder.is_absolute() && !places.contains(&folder) && places.len() < MOST_PLACES {
            places.push(folder);
        }
    }
    places
}
