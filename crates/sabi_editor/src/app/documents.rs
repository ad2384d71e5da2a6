//! Graphs, models and textures as files.

use std::path::{Path, PathBuf};

use egui::Ui;
use sabi_editing::OpenDocument;
use sabi_engine::{EngineError, Kinds, NodeDraft, Session};
use sabi_graph::{Edit, Preview, Value};

use super::Editor;
use crate::action::{Action, Shelf};
use crate::command::Favorite;
use crate::files::{examples, whole};
use crate::panels::library::KEPT_AS;

/// Endings of models.
pub(crate) const MODELS: [&str; 3] = ["glb", "gltf", "obj"];
/// Endings of pictures that nodes read.
pub(crate) const PICTURES: [&str; 8] = ["png", "jpg", "jpeg", "exr", "hdr", "tga", "bmp", "webp"];

impl Editor {
    pub(crate) fn recovery_folder(&self) -> Option<&Path> {
        self.folders.recovery.as_deref()
    }

    /// Opens a graph file in the place of what is open.
    pub(crate) fn open_file(&mut self, path: &Path) {
        match Session::open(path, self.recovery_folder()) {
            Ok(session) => {
                self.settings.remember(path);
                self.take_session(session);
            }
            Err(error) => self.say(error.to_string()),
        }
    }

    pub(crate) fn open_example(&mut self, at: usize) {
        let Some(folder) = self.folders.examples.clone() else {
            self.say("This system has no folder for examples; open one of the project's graphs instead.");
            return;
        };
        match examples::unpack(&folder, at) {
            Ok(Some(file)) => self.open_file(&file),
            Ok(None) => {}
            Err(error) => self.say(format!("{} cannot be written: {error}", folder.display())),
        }
    }

    /// Goes on with what was kept when the program ended.
    pub(crate) fn recover(&mut self, at: usize) {
        if at >= self.files.recoveries.len() {
            return;
        }
        let recovery = self.files.recoveries.remove(at);
        let drafts = recovery.drafts().to_vec();
        match Session::recover(recovery) {
            Ok(session) => self.take_session(session),
            Err(error) => self.say(error.to_string()),
        }
        // Whatever became of the graph.
        self.panels.page.recover(drafts, &self.document);
    }

    /// Opens another graph, on the model that it names.
    pub(crate) fn take_session(&mut self, session: Session) {
        let model = super::model_of(&session);
        self.remember_export();
        let before = std::mem::replace(&mut self.document, OpenDocument::new(session));
        before.session.close();
        self.recall_export();
        self.keeping.kept = None;
        self.canvas = Default::default();
        self.look_at_nothing();
        if let Some(model) = model.filter(|model| whole(model) != whole(self.stage.model_file())) {
            self.take_model(&model);
        }
    }

    /// Saves to the graph's file, or asks for one.
    pub(crate) fn save(&mut self) {
        match self.document.session.file().map(Path::to_owned) {
            Some(file) => {
                self.keep_model();
                let saved = self.document.save();
                self.tell_saved(&file, saved);
            }
            None => self.files.ask_save(&self.document),
        }
    }

    /// Makes the model that the graph was worked on its own, so that it opens on that one again. What comes with the program
    /// stands in for a model that nobody has chosen, and as long as there is something to do again nothing is edited, since a
    /// save takes no step away.
    fn keep_model(&mut self) {
        let model = self.stage.model_file();
        let own = model_of(&self.document.session);
        let is_own = own.as_ref().is_some_and(|own| whole(own) == whole(model));
        let is_stand_in = own.is_none()
            && self
                .folders
                .examples
                .as_ref()
                .is_some_and(|of| whole(model).starts_with(whole(of)));
        let has_redo = self.document.session.redo_names().next().is_some();
        if is_own || is_stand_in || has_redo || self.stage.model_failure.is_some() {
            return;
        }
        let preview = Preview {
            mesh: Some(self.document.seen_from_own_folder(model)),
            ..self.document.contents().preview.clone().unwrap_or_default()
        };
        let edit = Edit::SetPreview { preview: Some(preview) };
        self.document.edit("Remember the model", vec![edit]);
    }

    pub(crate) fn save_to(&mut self, path: &Path) {
        self.keep_model();
        let before = self.document.session.file().unwrap_or(Path::new("")).to_owned();
        let saved = self.document.save_as(path);
        let after = self.document.session.file().unwrap_or(path);
        if saved.is_ok()
            && let Err(why) = self.panels.keepsakes.follow(&before, after)
        {
            self.say(why);
        }
        self.tell_saved(path, saved);
    }

    fn tell_saved(&mut self, path: &Path, saved: Result<(), EngineError>) {
        match saved {
            Ok(()) => {
                // A save lets go of what was kept, and node files that are being written are no part of it.
                self.keeping.kept = None;
                self.settings.remember(path);
                self.say(format!("Saved to {}", path.display()));
                self.export_after_save();
            }
            Err(error) => self.say(error.to_string()),
        }
    }

    /// The folder of a shelf of groups; the project's is only there once the graph has a file.
    fn shelf_folder(&self, shelf: Shelf) -> Option<PathBuf> {
        match shelf {
            Shelf::Project => {
                let file = self.document.session.file()?;
                Some(file.parent().unwrap_or(Path::new("")).join("library"))
            }
            Shelf::User => self.folders.library.clone(),
        }
    }

    /// Folders of groups to be used again, each of them once.
    pub(super) fn shelves(&self) -> Vec<(Shelf, PathBuf)> {
        let found = [Shelf::Project, Shelf::User].map(|shelf| Some((shelf, self.shelf_folder(shelf)?)));
        let mut shelves: Vec<(Shelf, PathBuf)> = found.into_iter().flatten().collect();
        shelves.dedup_by(|one, other| one.1 == other.1);
        shelves
    }

    /// Puts the selected group into a library, with its picture.
    pub(super) fn shelve_selected(&mut self, shelf: Shelf) {
        let Some(folder) = self.shelf_folder(shelf) else {
            self.say(match shelf {
                Shelf::Project => "Save the graph first, so that there is a folder beside it.",
                Shelf::User => "This system has no folder for a library.",
            });
            return;
        };
        let picture = self.document.selected_one().and_then(|id| {
            let result = self.reference(id, None);
            self.stage.thumbnail_pixels(&result).cloned()
        });
        let Some(file) = self.document.shelve(&folder) else {
            return;
        };
        self.panels.library.forget();
        if let Some(picture) = picture
            && let Err(why) = self.panels.keepsakes.keep(&self.context, &file, KEPT_AS, &picture)
        {
            self.say(why);
        }
    }

    /// Writes the file of a node and takes it into use.
    pub(super) fn save_node(&mut self, node: &NodeDraft) {
        let NodeDraft { folder, id, .. } = node;
        match node.save() {
            Ok(file) => {
                self.say(format!(
                    "'{id}' is in {}, and among the nodes that can be added.",
                    file.display()
                ));
                let mut kinds = Kinds::clone(self.document.kinds().0);
                kinds.reread(std::slice::from_ref(folder));
                self.document.take_kinds(kinds);
                self.panels.page.saved(node);
            }
            Err(error) => self.say(error.to_string()),
        }
    }

    /// Adds a node of a favorite where the pointer is.
    pub(super) fn add_favorite(&mut self, favorite: Favorite, ui: &Ui) {
        let key = self.settings.favorites.get(favorite.index()).cloned();
        let found = key.and_then(|key| self.candidates().iter().find(|known| known.new.key() == key));
        let Some(kind) = found.map(|found| found.new.clone()) else {
            let number = favorite.index() + 1;
            self.say(format!(
                "There is no favorite {number}; a star in the library makes one."
            ));
            return;
        };
        let add = Action::Add {
            kind,
            place: self.canvas.place_for_new(ui),
            loose: None,
            into: None,
        };
        self.perform(add, ui);
    }

    /// Takes a file by what it is: a graph is opened, a model shown, an environment lit, a picture becomes a node.
    pub(super) fn take_dropped_file(&mut self, path: &Path, ui: &Ui) {
        if path.is_dir() {
            self.take_dropped_folder(path, ui);
            return;
        }
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("sabi") => self
                .files
                .ask_next(&mut self.document, crate::files::Next::Open(path.to_owned())),
            Some(ending) if MODELS.contains(&ending) => self.take_model(path),
            Some("hdr") => self.take_environment(path),
            Some("exr") if self.active != crate::dock::Panel::Canvas => self.take_environment(path),
            Some(ending) if PICTURES.contains(&ending) => self.add_picture(path, ui),
            _ => self.say(format!(
                "{} is nothing that can be taken; drop graphs, models, pictures and environments",
                path.display()
            )),
        }
    }

    /// Takes a folder as the texture sets that its pictures are.
    fn take_dropped_folder(&mut self, folder: &Path, ui: &Ui) {
        let entries = match std::fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(error) => {
                self.say(format!("{} cannot be read: {error}", folder.display()));
                return;
            }
        };
        let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let is_picture = |file: &PathBuf| {
            let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
            ending.is_some_and(|ending| PICTURES.contains(&ending.as_str()))
        };
        let files: Vec<PathBuf> = files.filter(is_picture).collect();
        if files.is_empty() {
            self.say(format!("{} holds no pictures", folder.display()));
            return;
        }
        let place = self.canvas.place_for_new(ui);
        self.document.add_texture_sets(&files, place);
    }

    fn take_environment(&mut self, path: &Path) {
        let choice = whole(path).display().to_string();
        self.model_view.choose_environment(&choice);
        self.settings.environment = choice;
    }

    fn add_picture(&mut self, path: &Path, ui: &Ui) {
        let place = self.canvas.place_for_new(ui);
        let text = self.document.relative(path);
        self.document.session.begin("Add picture");
        let added = self.document.add("source/image", place, None);
        if let Some(id) = &added {
            self.document.set_knob(id, "file", Some(Value::Text(text)));
        }
        self.document.session.end();
        if let Some(id) = added {
            self.look_at(&id, None);
        }
    }
}

/// Where a path leads that a graph names.
pub(crate) fn model_of(session: &Session) -> Option<PathBuf> {
    let named = session.document().preview.as_ref()?.mesh.clone()?;
    Some(session.graph().folder().join(named))
}
