//! A node file that is being written, with what is wrong with it at every letter.

use std::path::Path;

use egui::{RichText, TextEdit, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::OpenDocument;
use sabi_engine::{NodeDraft, NodeTextFault, check_node, new_node_folder, node_text_like, read_node, why_no_node_id};

use super::code;
use crate::action::Action;
use crate::theme::{Theme, space};

/// A node file that is being written.
pub(crate) struct Draft {
    node: NodeDraft,
    /// How often something was written.
    edits: u64,
    /// Whether the text is as the file has it.
    pub(super) is_saved: bool,
    /// Whether something was written that no file has.
    is_written: bool,
    /// Whether it is asked if that may be lost.
    asks: bool,
    /// Of this id and text.
    faults: Vec<NodeTextFault>,
    why_no_id: Option<String>,
}

/// Whether a draft is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Left {
    No,
    /// It is kept, and the selected node shown.
    Aside,
    ForGood,
}

impl Draft {
    pub(super) fn id(&self) -> &str {
        &self.node.id
    }

    pub(super) fn node(&self) -> &NodeDraft {
        &self.node
    }

    pub(super) fn edits(&self) -> u64 {
        self.edits
    }

    /// Whether it is of a node in a folder.
    pub(super) fn is_of(&self, folder: &Path, id: &str) -> bool {
        self.node.folder == folder && self.node.id == id
    }

    /// Whether something was written that its file does not hold.
    pub(super) fn is_unsaved(&self) -> bool {
        self.is_written && !self.is_saved
    }

    /// Whether another one is of the same node.
    pub(super) fn is_like(&self, other: &Draft) -> bool {
        self.is_of(&other.node.folder, &other.node.id)
    }

    /// The text changed.
    fn written(&mut self, document: &OpenDocument) {
        self.is_saved = false;
        self.is_written = true;
        self.edits += 1;
        self.check(document);
    }

    /// A new node that begins as another one is; none where there is no folder for it.
    pub(super) fn like(document: &OpenDocument, id: &str, text: &str) -> Option<Draft> {
        let folder = new_node_folder(document.session.file())?;
        let kinds = document.kinds().0;
        let numbered = (2..).map(|number| format!("{id}_{number}"));
        let mut ids = std::iter::once(format!("{id}_own")).chain(numbered);
        let id = ids.find(|id| why_no_node_id(kinds, &folder, id).is_none())?;
        let node = NodeDraft {
            text: node_text_like(text, &id),
            folder,
            id,
            known: None,
        };
        Some(Draft::checked(document, node, false))
    }

    /// The file of one of the artist's own nodes, as it is by now, which need not be the last one without a fault.
    ///
    /// # Errors
    /// A sentence: it is none of those, or cannot be read.
    pub(super) fn of_own(document: &OpenDocument, id: &str) -> Result<Draft, String> {
        let kinds = document.kinds().0;
        let folder = kinds.own_folder(document.session.file(), id);
        let folder = folder.ok_or_else(|| format!("'{id}' is no node of your own; begin a new one from it"))?;
        let text = read_node(&folder, id).map_err(|error| error.to_string())?;
        let node = NodeDraft {
            folder,
            id: id.to_owned(),
            known: Some(text.clone()),
            text,
        };
        Ok(Draft::checked(document, node, true))
    }

    /// One that was being written when the program ended.
    pub(super) fn recovered(document: &OpenDocument, node: NodeDraft) -> Draft {
        Draft {
            is_written: true,
            ..Draft::checked(document, node, false)
        }
    }

    /// The file has this text now.
    pub(super) fn was_saved(&mut self) {
        self.is_saved = true;
        self.node.known = Some(self.node.text.clone());
    }

    fn checked(document: &OpenDocument, node: NodeDraft, is_saved: bool) -> Draft {
        let mut draft = Draft {
            node,
            edits: 0,
            is_saved,
            is_written: false,
            asks: false,
            faults: Vec::new(),
            why_no_id: None,
        };
        draft.check(document);
        draft
    }

    fn check(&mut self, document: &OpenDocument) {
        let kinds = document.kinds().0;
        let NodeDraft { folder, id, text, .. } = &self.node;
        self.why_no_id = why_no_node_id(kinds, folder, id);
        self.faults = check_node(kinds, folder, id, text);
    }

    /// Shows it; says whether it is left.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        document: &OpenDocument,
        actions: &mut Vec<Action>,
    ) -> Left {
        let mut left = self.head(ui, document, actions);
        let would_lose = self.is_unsaved();
        if left == Left::ForGood && would_lose {
            self.asks = true;
            left = Left::No;
        }
        if self.asks && would_lose {
            left = self.question(ui, theme, left);
        }
        self.told(ui, theme);
        let faulty: Vec<u32> = self.faults.iter().map(|fault| fault.line).collect();
        ui.separator();
        if code::edit(ui, theme, &mut self.node.text, &faulty) {
            self.written(document);
        }
        left
    }

    /// Whether what was written may be lost.
    fn question(&mut self, ui: &mut Ui, theme: &Theme, left: Left) -> Left {
        let text = format!("What was written for '{}' is in no file.", self.node.id);
        ui.add(egui::Label::new(RichText::new(text).color(theme.warning)).wrap());
        ui.horizontal(|ui| {
            if ui.button("Lose it").clicked() {
                return Left::ForGood;
            }
            self.asks &= !ui.button("Keep it").clicked();
            left
        })
        .inner
    }

    fn head(&mut self, ui: &mut Ui, document: &OpenDocument, actions: &mut Vec<Action>) -> Left {
        let row = egui::vec2(ui.available_width(), space::ROW);
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        ui.allocate_ui_with_layout(row, layout, |ui| {
            let leave = ui.button(if self.is_saved { "Close" } else { "Let it go" });
            let aside = ui.button(icon::ARROW_LEFT);
            aside.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "To the selected node"));
            let aside = aside.on_hover_text("Shows the page of the selected node; what is written here is kept");
            let can_save = self.why_no_id.is_none() && !self.is_saved;
            let save = ui.add_enabled(can_save, egui::Button::new("Save node"));
            let place = self.node.folder.display().to_string();
            if save.on_hover_text(format!("Writes it into {place}")).clicked() {
                actions.push(Action::SaveNode(self.node.clone()));
            }
            let node = &mut self.node;
            let before = node.id.clone();
            let field = TextEdit::singleline(&mut node.id).desired_width(ui.available_width() - space::USUAL);
            let field = ui.add(field);
            field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Id of the node"));
            if field.changed() {
                node.known = None;
                // A title that nobody wrote follows the name.
                if node_text_like(&node.text, &before) == node.text {
                    node.text = node_text_like(&node.text, &node.id);
                }
                self.written(document);
            }
            match (leave.clicked(), aside.clicked()) {
                (true, _) => Left::ForGood,
                (false, true) => Left::Aside,
                (false, false) => Left::No,
            }
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
