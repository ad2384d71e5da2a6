//! Files and folders that are dropped on the window.

use std::fs;
use std::path::{Path, PathBuf};

use egui::Ui;
use sabi_editing::command::NodeCommand;
use sabi_files::{io_reason, path_text};
use sabi_surface::load::MODEL_ENDINGS;

use super::super::Editor;
use crate::action::Next;
use crate::dock::Panel;
use crate::paths::{IMAGES, canonical_if_present, file_name, lowercase_ending};

impl Editor {
    /// Uses a file by its type: a graph is opened, a model shown, an environment used as light, an image added as a node.
    pub(in crate::app) fn take_dropped(&mut self, path: &Path, ui: &Ui) {
        if path.is_dir() {
            return self.take_dropped_folder(path, ui);
        }
        let is_on_canvas = self.shell.keyboard.active == Panel::Canvas;
        match lowercase_ending(path).as_deref() {
            Some("sabi") => {
                let is_dirty = self.documents.document.session.is_dirty();
                self.views.questions.ask_next(is_dirty, Next::Open(path.to_owned()));
            }
            Some(ending) if MODEL_ENDINGS.contains(&ending) => self.models().take_chosen(path),
            Some("hdr") => self.take_environment(path),
            Some("exr") if !is_on_canvas => self.take_environment(path),
            Some(ending) if IMAGES.contains(&ending) => self.add_image(path, ui),
            _ => self.shell.notify(format!(
                "{} cannot be used here; drop a graph, a model, an image or an environment",
                path.display()
            )),
        }
    }

    /// Adds a picture as a node, or the pictures of a folder as texture sets.
    pub(in crate::app) fn import_pictures(&mut self, path: &Path, ui: &Ui) {
        self.shell.dock.bring_up(Panel::Canvas);
        match path.is_dir() {
            true => self.take_dropped_folder(path, ui),
            false => self.add_image(path, ui),
        }
    }

    /// Marks the window while a file is held over it, with a caption that says what a drop does.
    pub(in crate::app) fn mark_hovered_file(&self, ui: &Ui) {
        let hovered = ui.input(|input| input.raw.hovered_files.first().cloned());
        let Some(hovered) = hovered else { return };
        let file = hovered.path.as_deref();
        let name = file.map_or_else(|| "the file".into(), file_name);
        let ending = file.and_then(lowercase_ending);
        let words = match ending.as_deref() {
            _ if file.is_some_and(Path::is_dir) => format!("Drop {name} to add its pictures as texture sets"),
            Some("sabi") => format!("Drop {name} to open it"),
            Some(ending) if MODEL_ENDINGS.contains(&ending) => format!("Drop {name} to show the graph on it"),
            Some("hdr") => format!("Drop {name} to light the model by it"),
            Some(ending) if IMAGES.contains(&ending) => format!("Drop {name} to add it as an image"),
            _ => "Drop a graph, a model, a picture or an environment here".to_owned(),
        };
        self.mark_target(ui, ui.ctx().content_rect(), &words);
    }

    /// Adds the images of a folder as texture sets.
    fn take_dropped_folder(&mut self, folder: &Path, ui: &Ui) {
        let entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(error) => {
                let why = io_reason(&error);
                return self.shell.fail(format!("{} cannot be read: {why}", folder.display()));
            }
        };
        let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let is_image = |file: &PathBuf| lowercase_ending(file).is_some_and(|ending| IMAGES.contains(&ending.as_str()));
        let files: Vec<PathBuf> = files.filter(is_image).collect();
        if files.is_empty() {
            return self.shell.notify(format!("{} holds no pictures", folder.display()));
        }
        self.add_texture_sets(files, ui);
    }

    /// Adds images as texture sets, and shows the first of their materials.
    pub(in crate::app) fn add_texture_sets(&mut self, files: Vec<PathBuf>, ui: &Ui) {
        let place = self.views.canvas.camera.place_for_new(ui);
        let before = self.documents.document.selection().clone();
        self.edit(NodeCommand::AddTextureSets { files, place }, ui);
        let document = &self.documents.document;
        if let Some(material) = document.selection().difference(&before).next() {
            self.looks.show(document, material, None);
        }
    }

    fn take_environment(&mut self, path: &Path) {
        let Some(choice) = self.shell.report(path_text(&canonical_if_present(path))) else {
            return;
        };
        self.views.model.environment.choose(&choice);
        self.views.model.environment.read_again();
        self.shell.settings.environment = choice;
    }

    fn add_image(&mut self, path: &Path, ui: &Ui) {
        let place = self.views.canvas.camera.place_for_new(ui);
        let file = path.to_owned();
        self.edit(NodeCommand::AddImage { file, place }, ui);
    }
}
