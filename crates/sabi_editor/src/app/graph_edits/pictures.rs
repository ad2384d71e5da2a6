//! Pictures that are added as nodes or as texture sets.

use std::fs;
use std::path::{Path, PathBuf};

use egui::Ui;
use sabi_editing::command::NodeCommand;
use sabi_files::io_reason;

use super::GraphEdits;
use crate::dock::Panel;
use crate::paths::{IMAGES, lowercase_ending};

impl GraphEdits<'_> {
    /// Adds a picture as a node, or the pictures of a folder as texture sets.
    pub(in crate::app) fn import_pictures(&mut self, path: &Path, ui: &Ui) {
        self.shell.dock.bring_up(Panel::Canvas);
        match path.is_dir() {
            true => self.add_folder(path, ui),
            false => self.add_image(path, ui),
        }
    }

    /// Adds the images of a folder as texture sets.
    pub(in crate::app) fn add_folder(&mut self, folder: &Path, ui: &Ui) {
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

    pub(in crate::app) fn add_image(&mut self, path: &Path, ui: &Ui) {
        let place = self.views.canvas.camera.place_for_new(ui);
        let file = path.to_owned();
        self.edit(NodeCommand::AddImage { file, place }, ui);
    }
}
