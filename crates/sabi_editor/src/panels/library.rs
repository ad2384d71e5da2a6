//! Nodes and groups that can be added: searched, made favorites, clicked and dragged to the canvas.

mod entry;
mod entry_pictures;

use egui::{Context, RichText, ScrollArea, TextureId, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::command::NodeSource;
use sabi_engine::catalog::has_picture;

use crate::action::{Action, LibraryKind, SettingAction};
use crate::choice_previews::PreviewChoice;
use crate::context::{View, ViewContext};
use crate::saved_pictures::OF_GROUP;
use crate::search::{Candidate, ranked};
use crate::theme::{Theme, space};
use entry::LibraryEntry;
use entry_pictures::{EntryPictures, PictureSize};

/// Panel of nodes and groups that can be added.
#[derive(Default)]
pub(crate) struct LibraryPanel {
    query: String,
    pictures: EntryPictures,
}

impl View for LibraryPanel {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let before = self.query.clone();
        head(&mut self.query, ui, context, &mut actions);
        ui.add_space(space::TIGHT);
        self.pictures.poll(ui.ctx());
        let favorites = &context.settings.favorites;
        let number = |candidate: &Candidate| candidate.favorite_number(favorites);
        let mut found: Vec<&Candidate> = ranked(context.candidates, &self.query);
        // Favorites come first in their own order, then the effects, which artists look for more often than for single
        // nodes. The sort is stable: the others keep their order, which in a search is that of their rank.
        let is_single = |candidate: &Candidate| self.query.is_empty() && matches!(candidate.new, NodeSource::Kind(_));
        found.sort_by_key(|candidate| (number(candidate).unwrap_or(usize::MAX), is_single(candidate)));
        let mut area = ScrollArea::vertical().auto_shrink(false);
        if self.query != before {
            // The best match is the first one.
            area = area.vertical_scroll_offset(0.0);
        }
        area.show(ui, |ui| {
            faults(ui, context.theme, context.library.faults());
            ui.spacing_mut().item_spacing.y = 1.0;
            let mut section = "";
            for candidate in found {
                let number = number(candidate);
                let own = match number {
                    Some(_) => "favorites",
                    None => candidate.section.as_str(),
                };
                if self.query.is_empty() && own != section {
                    section = own;
                    ui.add_space(space::USUAL);
                    ui.label(RichText::new(own.to_uppercase()).small().color(context.theme.quiet));
                }
                let egui = ui.ctx().clone();
                let entry = LibraryEntry {
                    candidate,
                    number,
                    has_picture: self.has_picture(&egui, context, &candidate.new),
                    picture: &|side| self.picture(&egui, context, &candidate.new, side),
                };
                actions.extend(entry.show(ui, context));
            }
        });
        actions
    }
}

impl LibraryPanel {
    /// Picture of a node kind, once it is loaded.
    #[cfg(test)]
    pub(crate) fn picture_of_kind(&self, kind: &str) -> Option<TextureId> {
        self.pictures.find(kind, PictureSize::Small)
    }

    /// Picture of an entry in the list.
    #[cfg(test)]
    pub(crate) fn small_picture(
        &self,
        egui: &Context,
        context: &ViewContext<'_>,
        new: &NodeSource,
    ) -> Option<TextureId> {
        self.picture(egui, context, new, PictureSize::Small)
    }

    /// Returns whether an entry has a picture, loaded or not.
    fn has_picture(&self, egui: &Context, context: &ViewContext<'_>, new: &NodeSource) -> bool {
        match new {
            NodeSource::Kind(kind) => has_picture(kind),
            NodeSource::Library(_) if context.tries_effects() => true,
            NodeSource::Library(_) | NodeSource::Group(_) => {
                self.picture(egui, context, new, PictureSize::Small).is_some()
            }
        }
    }

    /// Picture of the result of an entry; for a group of the graph, of its first instance.
    fn picture(
        &self,
        egui: &Context,
        context: &ViewContext<'_>,
        new: &NodeSource,
        side: PictureSize,
    ) -> Option<TextureId> {
        match new {
            NodeSource::Library(file) => {
                let tried = || context.choice_previews.find(PreviewChoice::Effect(file.clone()));
                let tried = context.tries_effects().then(tried).flatten();
                let saved = || context.pictures.find(egui, file, OF_GROUP);
                let drawn = || self.pictures.find(&file.display().to_string(), side);
                tried.or_else(saved).or_else(drawn)
            }
            NodeSource::Kind(kind) => self.pictures.find(kind, side),
            NodeSource::Group(group) => {
                let mut nodes = context.document.graph().nodes();
                let instance = nodes.find(|(_, node)| node.group.as_ref() == Some(group));
                instance.and_then(|(id, _)| context.node_picture(id))
            }
        }
    }
}

/// Sentences about files in the library that cannot be used.
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

/// Search field, and the menu that puts a group into a library.
fn head(query: &mut String, ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let has_file = context.document.session.file().is_some();
    let row = egui::vec2(ui.available_width(), space::ROW);
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.allocate_ui_with_layout(row, layout, |ui| {
        let menu = ui.menu_button("Save group", |ui| {
            if ui.button("To the user library").clicked() {
                actions.push(Action::AddToLibrary(LibraryKind::User));
            }
            let beside = ui.add_enabled(has_file, egui::Button::new("To the project library"));
            let beside = beside.on_hover_text("In a folder 'library' that goes with the project");
            let beside = beside.on_disabled_hover_text("Save the graph first, so that there is a folder beside it");
            if beside.clicked() {
                actions.push(Action::AddToLibrary(LibraryKind::Project));
            }
        });
        menu.response.on_hover_text("Puts the selected group into a library");
        let is_on = context.tries_effects();
        let switch = ui.add(egui::Button::selectable(is_on, icon::CUBE));
        switch.widget_info(|| {
            egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, is_on, "Effects on the open model")
        });
        if switch.on_hover_text("Shows each effect on the open model").clicked() {
            actions.push(Action::Setting(SettingAction::TryEffects(!is_on)));
        }
        let field = egui::TextEdit::singleline(query)
            .hint_text(format!("{} Search", icon::MAGNIFYING_GLASS))
            .desired_width(ui.available_width() - space::USUAL);
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Search the library"));
    });
}
