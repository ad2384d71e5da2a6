//! Everything that can be put into a graph, to be searched, marked and dragged.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Color32, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_engine::OpenGraph;
use sabi_engine::catalog::{Catalog, Faces};

use crate::action::{Action, New};
use crate::app::Editor;
use crate::search::{Candidate, Shelved, ranked};
use crate::theme::{Theme, space};

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Library {
    query: String,
    /// Whether files may have changed since they were read.
    is_stale: bool,
    shelf: Option<Vec<Shelved>>,
}

impl Library {
    /// Files may have changed.
    pub(crate) fn forget(&mut self) {
        self.is_stale = true;
    }

    pub(crate) fn has_changed(&self) -> bool {
        self.is_stale || self.shelf.is_none()
    }

    /// Groups in the folder of the library.
    pub(crate) fn shelf(&mut self, folder: Option<&Path>, catalog: &Catalog) -> Vec<Shelved> {
        if self.has_changed() {
            self.is_stale = false;
            self.shelf = Some(folder.map(|folder| read(folder, catalog)).unwrap_or_default());
        }
        self.shelf.clone().unwrap_or_default()
    }
}

fn read(folder: &Path, catalog: &Catalog) -> Vec<Shelved> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == crate::desk::ENDING));
    files.sort();
    let shelved = files.into_iter().filter_map(|file| {
        let open = OpenGraph::open(&file).ok()?;
        let faces = Faces::new(catalog, &open.document, &mut |_| None);
        let mut face = faces.of_whole()?.as_ref().clone();
        if face.label == "Group" {
            face.label = file.file_stem()?.to_string_lossy().into_owned();
        }
        Some(Shelved {
            file,
            face: Arc::new(face),
        })
    });
    shelved.collect()
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let library = &mut editor.panels.library;
        let hint = format!("{} Search", icon::MAGNIFYING_GLASS);
        let width = ui.available_width() - 90.0;
        let field = ui.add(
            egui::TextEdit::singleline(&mut library.query)
                .hint_text(hint)
                .desired_width(width),
        );
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Search the library"));
        let shelve = ui
            .button("Keep group")
            .on_hover_text("Puts the selected group into the library");
        if shelve.clicked() {
            editor.shelve_selected();
        }
    });
    ui.add_space(space::TIGHT);
    let query = editor.panels.library.query.clone();
    let all = editor.candidates().to_vec();
    let mut found: Vec<&Candidate> = ranked(&all, &query);
    let favorites = editor.settings.favorites.clone();
    let is_favorite = |candidate: &Candidate| favorites.contains(&key_of(&candidate.new));
    // Sorting keeps the order of those that are alike.
    found.sort_by_key(|candidate| !is_favorite(candidate));
    let mut toggled = None;
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut section = String::new();
        for candidate in found {
            let own = if is_favorite(candidate) {
                "favorites"
            } else {
                candidate.section.as_str()
            };
            if query.is_empty() && own != section {
                own.clone_into(&mut section);
                ui.add_space(space::TIGHT);
                ui.label(RichText::new(own.to_uppercase()).small().color(theme.quiet));
            }
            ui.horizontal(|ui| {
                let star = if is_favorite(candidate) {
                    theme.accent
                } else {
                    Color32::TRANSPARENT
                };
                let star = ui.add(egui::Label::new(RichText::new(icon::STAR).color(star)).sense(egui::Sense::click()));
                if star.on_hover_text("Favorite").clicked() {
                    toggled = Some(key_of(&candidate.new));
                }
                entry(ui, theme, candidate, editor, actions);
            });
        }
    });
    if let Some(key) = toggled {
        match editor.settings.favorites.iter().position(|known| *known == key) {
            Some(at) => drop(editor.settings.favorites.remove(at)),
            None => editor.settings.favorites.push(key),
        }
    }
}

/// One entry: a click adds it in the middle of the canvas, a drag where it is dropped.
fn entry(ui: &mut Ui, theme: &Theme, candidate: &Candidate, editor: &Editor, actions: &mut Vec<Action>) {
    let face = &candidate.face;
    let text = RichText::new(&face.label).color(theme.text);
    let sense = egui::Sense::click_and_drag();
    let response = ui.add(egui::Label::new(text).sense(sense)).on_hover_text(&face.summary);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &face.label));
    let place = if response.clicked() {
        Some(editor.canvas.middle())
    } else if response.drag_stopped() {
        let at = ui.input(|input| input.pointer.latest_pos());
        at.and_then(|at| editor.canvas.place_at(at))
    } else {
        None
    };
    if response.dragged() {
        ui.set_cursor_icon(egui::CursorIcon::Grabbing);
    }
    if let Some(place) = place {
        actions.push(Action::Add {
            kind: candidate.new.clone(),
            place,
            loose: None,
            into: None,
        });
    }
}

/// What a favorite is remembered by.
fn key_of(new: &New) -> String {
    match new {
        New::Kind(kind) => kind.clone(),
        New::Group(group) => format!("group {group}"),
        New::Library(file) => file.display().to_string(),
    }
}
