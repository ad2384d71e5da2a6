//! A node file that is being written, with what is wrong with it at every letter.

use std::path::PathBuf;

use egui::{RichText, TextEdit, Ui, WidgetInfo, WidgetType};
use sabi_engine::{NodeTextFault, check_node, new_node_folder, node_text_like, read_node, why_no_node_id};

use super::code;
use crate::action::{Action, NodeText};
use crate::desk::Desk;
use crate::theme::{Theme, space};

/// A node file that is being written.
pub(crate) struct Draft {
    id: String,
    text: String,
    folder: PathBuf,
    /// Whether the text is as the file has it.
    pub(crate) is_saved: bool,
    /// Of this id and text.
    faults: Vec<NodeTextFault>,
    why_no_id: Option<String>,
    /// What its file is known to hold; none before it is written for the first time.
    known: Option<String>,
}

impl Draft {
    /// A new node that begins as another one is; none where there is no folder for it.
    pub(super) fn like(desk: &Desk, id: &str, text: &str) -> Option<Draft> {
        let folder = new_node_folder(desk.session.file())?;
        let kinds = desk.kinds().0;
        let numbered = (2..).map(|number| format!("{id}_{number}"));
        let mut ids = std::iter::once(format!("{id}_own")).chain(numbered);
        let id = ids.find(|id| why_no_node_id(kinds, &folder, id).is_none())?;
        let text = node_text_like(text, &id);
        Some(Draft::checked(desk, id, text, folder, false))
    }

    /// The file of one of the artist's own nodes, as it is by now, which need not be the last one without a fault.
    ///
    /// # Errors
    /// A sentence: it is none of those, or cannot be read.
    pub(super) fn of_own(desk: &Desk, id: &str) -> Result<Draft, String> {
        let kinds = desk.kinds().0;
        let folder = kinds.own_folder(desk.session.file(), id);
        let folder = folder.ok_or_else(|| format!("'{id}' is no node of your own; begin a new one from it"))?;
        let text = read_node(&folder, id).map_err(|error| error.to_string())?;
        let mut draft = Draft::checked(desk, id.to_owned(), text, folder, true);
        draft.known = Some(draft.text.clone());
        Ok(draft)
    }

    /// The file has this text now.
    pub(crate) fn was_saved(&mut self) {
        self.is_saved = true;
        self.known = Some(self.text.clone());
    }

    fn checked(desk: &Desk, id: String, text: String, folder: PathBuf, is_saved: bool) -> Draft {
        let mut draft = Draft {
            id,
            text,
            folder,
            is_saved,
            faults: Vec::new(),
            why_no_id: None,
            known: None,
        };
        draft.check(desk);
        draft
    }

    fn check(&mut self, desk: &Desk) {
        let kinds = desk.kinds().0;
        self.why_no_id = why_no_node_id(kinds, &self.folder, &self.id);
        self.faults = check_node(kinds, &self.folder, &self.id, &self.text);
    }

    /// Shows it; says whether it is let go.
    pub(super) fn show(&mut self, ui: &mut Ui, theme: &Theme, desk: &Desk, actions: &mut Vec<Action>) -> bool {
        let is_left = self.head(ui, desk, actions);
        self.told(ui, theme);
        let faulty: Vec<u32> = self.faults.iter().map(|fault| fault.line).collect();
        ui.separator();
        if code::edit(ui, theme, &mut self.text, &faulty) {
            self.is_saved = false;
            self.check(desk);
        }
        is_left
    }

    fn head(&mut self, ui: &mut Ui, desk: &Desk, actions: &mut Vec<Action>) -> bool {
        let row = egui::vec2(ui.available_width(), space::ROW);
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        ui.allocate_ui_with_layout(row, layout, |ui| {
            let leave = ui.button(if self.is_saved { "Close" } else { "Let it go" });
            let can_save = self.why_no_id.is_none() && !self.is_saved;
            let save = ui.add_enabled(can_save, egui::Button::new("Save node"));
            let place = self.folder.display().to_string();
            if save.on_hover_text(format!("Writes it into {place}")).clicked() {
                actions.push(Action::SaveNode(NodeText {
                    folder: self.folder.clone(),
                    id: self.id.clone(),
                    text: self.text.clone(),
                    known: self.known.clone(),
                }));
            }
            let before = self.id.clone();
            let field = TextEdit::singleline(&mut self.id).desired_width(ui.available_width() - space::USUAL);
            let field = ui.add(field);
            field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Id of the node"));
            if field.changed() {
                self.is_saved = false;
                self.known = None;
                // A title that nobody wrote follows the name.
                if node_text_like(&self.text, &before) == self.text {
                    self.text = node_text_like(&self.text, &self.id);
                }
                self.check(desk);
            }
            leave.clicked()
        })
        .inner
    }

    /// What is wrong, or that nothing is.
    fn told(&self, ui: &mut Ui, theme: &Theme) {
        let wrapped = |ui: &mut Ui, text: String, color| {
            ui.add(egui::Label::new(RichText::new(text).color(color)).wrap());
        };
        if let Some(why) = &self.why_no_id {
            wrapped(ui, why.clone(), theme.fault);
        }
        for fault in &self.faults {
            let text = match fault.line {
                0 => fault.told.clone(),
                line => format!("Line {line}: {}", fault.told),
            };
            wrapped(ui, text, theme.fault);
        }
        if self.why_no_id.is_none() && self.faults.is_empty() {
            let text = if self.is_saved {
                "Saved; nothing is wrong."
            } else {
                "Nothing is wrong."
            };
            wrapped(ui, text.to_owned(), theme.good);
        }
    }
}
