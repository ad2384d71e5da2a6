//! Everything that can be put into a graph, to be searched, marked and dragged.

mod entry;
mod pictures;

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Context, RichText, TextureId, Ui};
use egui_phosphor::regular as icon;
use sabi_engine::OpenGraph;
use sabi_engine::catalog::{Catalog, Faces};

use crate::action::{Action, New, Shelf};
use crate::app::Editor;
use crate::search::{Candidate, Shelved, ranked};
use crate::theme::{Theme, space};
use pictures::Pictures;

/// What a picture of a group in a library is kept as.
pub(crate) const KEPT_AS: &str = "group";

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Library {
    query: String,
    /// Whether files may have changed since they were read.
    is_stale: bool,
    found: Found,
    /// Folders and files that it is read from.
    files: Arc<[PathBuf]>,
    pictures: Pictures,
    /// The folders from which they were read.
    read_from: Option<Vec<(Shelf, PathBuf)>>,
}

impl Library {
    /// Files may have changed.
    pub(crate) fn forget(&mut self) {
        self.is_stale = true;
    }

    /// Whether a picture of what a kind does is there.
    #[cfg(test)]
    pub(crate) fn has_picture(&self, kind: &str) -> bool {
        self.pictures.find(kind).is_some()
    }

    /// Folders and files that it is read from.
    pub(crate) fn files(&self) -> &Arc<[PathBuf]> {
        &self.files
    }

    /// Whether what was read is not what lies in these folders.
    pub(crate) fn has_changed(&self, folders: &[(Shelf, PathBuf)]) -> bool {
        self.is_stale || self.read_from.as_deref() != Some(folders)
    }

    /// Groups in the folders of the library.
    pub(crate) fn shelved(&mut self, folders: Vec<(Shelf, PathBuf)>, catalog: &Catalog) -> &[Shelved] {
        if self.has_changed(&folders) {
            self.is_stale = false;
            self.found = Found::default();
            let mut files = Vec::new();
            for (shelf, folder) in &folders {
                files.push(folder.clone());
                files.extend(self.found.read(*shelf, folder, catalog));
            }
            self.files = files.into();
            self.read_from = Some(folders);
        }
        &self.found.shelved
    }
}

/// What the folders hold.
#[derive(Default)]
struct Found {
    shelved: Vec<Shelved>,
    /// Why files are not among them, in sentences.
    faults: Vec<String>,
}

impl Found {
    /// Adds what a folder holds; gives the files that were looked at.
    fn read(&mut self, shelf: Shelf, folder: &Path, catalog: &Catalog) -> Vec<PathBuf> {
        let entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(error) => {
                if error.kind() != ErrorKind::NotFound {
                    self.faults
                        .push(format!("{} cannot be read: {error}", folder.display()));
                }
                return Vec::new();
            }
        };
        let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        files.retain(|file| {
            file.extension()
                .is_some_and(|ending| ending == sabi_editing::GRAPH_EXTENSION)
        });
        files.sort();
        for file in &files {
            match shelved(shelf, file, catalog) {
                Ok(shelved) => self.shelved.push(shelved),
                Err(why) => self.faults.push(why),
            }
        }
        files
    }
}

/// A file as a group that other graphs can use, or why it is none.
fn shelved(shelf: Shelf, file: &Path, catalog: &Catalog) -> Result<Shelved, String> {
    let open = OpenGraph::open(file).map_err(|error| error.to_string())?;
    let faces = Faces::new(catalog, &open.document, &mut |_| None);
    let whole = faces.of_whole().ok_or_else(|| {
        let why = "is in the library, and gives nothing that other graphs could use; add an output to it";
        format!("{} {why}", file.display())
    })?;
    let mut face = whole.as_ref().clone();
    if face.label == "Group" {
        face.label = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    }
    Ok(Shelved {
        shelf,
        file: file.to_owned(),
        face: Arc::new(face),
    })
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    head(editor, ui, actions);
    ui.add_space(space::TIGHT);
    let Editor { panels, document, .. } = editor;
    panels.library.pictures.poll(ui.ctx(), document.catalog());
    let query = editor.panels.library.query.clone();
    let all = editor.candidates().to_vec();
    let mut found: Vec<&Candidate> = ranked(&all, &query);
    let favorites = editor.settings.favorites.clone();
    let number = |candidate: &Candidate| favorites.iter().position(|known| *known == candidate.new.key());
    // Favorites come first in their own order; sorting keeps that of the others.
    found.sort_by_key(|candidate| number(candidate).unwrap_or(usize::MAX));
    let (mut toggled, mut dragged) = (None, None);
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        faults(ui, theme, &editor.panels.library.found.faults);
        ui.spacing_mut().item_spacing.y = 1.0;
        let mut section = String::new();
        for candidate in found {
            let number = number(candidate);
            let own = if number.is_some() {
                "favorites"
            } else {
                candidate.section.as_str()
            };
            if query.is_empty() && own != section {
                own.clone_into(&mut section);
                ui.add_space(space::USUAL);
                ui.label(RichText::new(own.to_uppercase()).small().color(theme.quiet));
            }
            let picture = picture(editor, ui.ctx(), &candidate.new);
            let shown = entry::Shown {
                candidate,
                number,
                picture,
            };
            let touched = shown.show(ui, theme, editor, actions);
            if touched.is_starred {
                toggled = Some(candidate.new.key());
            }
            dragged = dragged.or(touched.dragged);
        }
    });
    if let Some(at) = dragged {
        editor.canvas.bring(ui, at);
    }
    if let Some(key) = toggled {
        match editor.settings.favorites.iter().position(|known| *known == key) {
            Some(at) => drop(editor.settings.favorites.remove(at)),
            None => editor.settings.favorites.push(key),
        }
    }
}

/// What an entry gives; for a group of the graph that is what its first instance gives here.
pub(crate) fn picture(editor: &mut Editor, context: &Context, new: &New) -> Option<TextureId> {
    match new {
        New::Library(file) => editor.panels.keepsakes.find(context, file, KEPT_AS),
        New::Kind(kind) => editor.panels.library.pictures.find(kind),
        New::Group(group) => {
            let mut nodes = editor.document.graph().nodes();
            let instance = nodes.find(|(_, node)| node.group.as_ref() == Some(group));
            instance.and_then(|(id, _)| editor.thumbnail_of(id))
        }
    }
}

/// Why files in the folders of the library are not in it.
fn faults(ui: &mut Ui, theme: &Theme, faults: &[String]) {
    if faults.is_empty() {
        return;
    }
    let title = match faults.len() {
        1 => "A file here cannot be used".to_owned(),
        count => format!("{count} files here cannot be used"),
    };
    egui::CollapsingHeader::new(RichText::new(title).color(theme.fault))
        .id_salt("faults of the library")
        .default_open(faults.len() == 1)
        .show_unindented(ui, |ui| {
            for fault in faults {
                ui.add(egui::Label::new(RichText::new(fault).color(theme.quiet)).wrap());
            }
        });
}

/// The search, and the way of a group into the library.
fn head(editor: &mut Editor, ui: &mut Ui, actions: &mut Vec<Action>) {
    let has_file = editor.document.session.file().is_some();
    let row = egui::vec2(ui.available_width(), space::ROW);
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.allocate_ui_with_layout(row, layout, |ui| {
        let menu = ui.menu_button("Keep group", |ui| {
            if ui.button("For all graphs").clicked() {
                actions.push(Action::Shelve(Shelf::User));
            }
            let beside = ui.add_enabled(has_file, egui::Button::new("Beside this graph"));
            let beside = beside.on_hover_text("In a folder 'library' that goes with the project");
            let beside = beside.on_disabled_hover_text("Save the graph first, so that there is a folder beside it");
            if beside.clicked() {
                actions.push(Action::Shelve(Shelf::Project));
            }
        });
        menu.response.on_hover_text("Puts the selected group into a library");
        let field = egui::TextEdit::singleline(&mut editor.panels.library.query)
            .hint_text(format!("{} Search", icon::MAGNIFYING_GLASS))
            .desired_width(ui.available_width() - space::USUAL);
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Search the library"));
    });
}
