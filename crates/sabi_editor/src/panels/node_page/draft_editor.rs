//! Editors of node files, which check the text after every change.

use std::path::Path;

use egui::{RichText, TextEdit, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::OpenDocument;
use sabi_engine::catalog::node_file::{
    NodeDraft, NodeTextFault, check_node, new_node_folder, new_node_text, node_id_fault, read_node,
};

use super::code;
use crate::action::Action;
use crate::theme::{Theme, space};

/// Editor of a node file.
pub(crate) struct DraftEditor {
    node: NodeDraft,
    /// Number of changes.
    edits: u64,
    /// True if the file contains the text.
    pub(super) is_saved: bool,
    /// True if the text was changed since it was opened.
    is_written: bool,
    /// True while the editor asks if unsaved changes may be lost.
    is_asking: bool,
    /// Errors of this id and text.
    faults: Vec<NodeTextFault>,
    why_no_id: Option<String>,
}

/// State of an editor after a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EditorState {
    Shown,
    /// The editor stays open, and the selected node is shown.
    Hidden,
    Closed,
}

impl DraftEditor {
    pub(super) fn id(&self) -> &str {
        &self.node.id
    }

    pub(super) fn node(&self) -> &NodeDraft {
        &self.node
    }

    pub(super) fn edits(&self) -> u64 {
        self.edits
    }

    /// Returns whether the editor edits this node of a folder.
    pub(super) fn is_of(&self, folder: &Path, id: &str) -> bool {
        self.node.folder == folder && self.node.id == id
    }

    /// Returns whether the editor has unsaved changes.
    pub(super) fn is_unsaved(&self) -> bool {
        self.is_written && !self.is_saved
    }

    /// Returns whether another editor edits the same node.
    pub(super) fn is_like(&self, other: &DraftEditor) -> bool {
        self.is_of(&other.node.folder, &other.node.id)
    }

    /// Handles a change of the text.
    fn written(&mut self, document: &OpenDocument) {
        self.is_saved = false;
        self.is_written = true;
        self.edits += 1;
        self.check(document);
    }

    /// Editor of a new node that begins as a copy of another one; `None` where there is no folder for it.
    pub(super) fn like(document: &OpenDocument, id: &str, text: &str) -> Option<DraftEditor> {
        let folder = new_node_folder(document.session.file())?;
        let kinds = &document.node_kinds().kinds;
        let numbered = (2..).map(|number| format!("{id}_{number}"));
        let mut ids = std::iter::once(format!("{id}_own")).chain(numbered);
        let id = ids.find(|id| node_id_fault(kinds, &folder, id).is_none())?;
        let node = NodeDraft {
            text: new_node_text(text, &id),
            folder,
            id,
            known: None,
        };
        Some(DraftEditor::checked(document, node, false))
    }

    /// Editor of the file of one of the artist's own nodes, as it is now, even if it has errors.
    ///
    /// # Errors
    /// A sentence: the node is none of the artist's own, or its file cannot be read.
    pub(super) fn of_own(document: &OpenDocument, id: &str) -> Result<DraftEditor, String> {
        let kinds = &document.node_kinds().kinds;
        let folder = kinds.own_folder(document.session.file(), id);
        let folder = folder.ok_or_else(|| format!("'{id}' is no node of your own; begin a new one from it"))?;
        let text = read_node(&folder, id).map_err(|error| error.to_string())?;
        let node = NodeDraft {
            folder,
            id: id.to_owned(),
            known: Some(text.clone()),
            text,
        };
        Ok(DraftEditor::checked(document, node, true))
    }

    /// Editor of a node file that was not saved when the program ended.
    pub(super) fn recovered(document: &OpenDocument, node: NodeDraft) -> DraftEditor {
        DraftEditor {
            is_written: true,
            ..DraftEditor::checked(document, node, false)
        }
    }

    /// Marks the text as saved.
    pub(super) fn was_saved(&mut self) {
        self.is_saved = true;
        self.node.known = Some(self.node.text.clone());
    }

    fn checked(document: &OpenDocument, node: NodeDraft, is_saved: bool) -> DraftEditor {
        let mut draft = DraftEditor {
            node,
            edits: 0,
            is_saved,
            is_written: false,
            is_asking: false,
            faults: Vec::new(),
            why_no_id: None,
        };
        draft.check(document);
        draft
    }

    fn check(&mut self, document: &OpenDocument) {
        let kinds = &document.node_kinds().kinds;
        let NodeDraft { folder, id, text, .. } = &self.node;
        self.why_no_id = node_id_fault(kinds, folder, id);
        self.faults = check_node(kinds, folder, id, text);
    }

    /// Shows the editor. Returns its state after that.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        document: &OpenDocument,
        actions: &mut Vec<Action>,
    ) -> EditorState {
        let mut state = self.head(ui, document, actions);
        let would_lose = self.is_unsaved();
        if state == EditorState::Closed && would_lose {
            self.is_asking = true;
            state = EditorState::Shown;
        }
        if self.is_asking && would_lose {
            state = self.question(ui, theme, state);
        }
        self.show_faults(ui, theme);
        let faulty: Vec<u32> = self.faults.iter().map(|fault| fault.line).collect();
        ui.separator();
        if code::edit(ui, theme, &mut self.node.text, &faulty) {
            self.written(document);
        }
        state
    }

    /// Shows the question whether unsaved changes may be lost.
    fn question(&mut self, ui: &mut Ui, theme: &Theme, state: EditorState) -> EditorState {
        let text = format!("'{}' has changes that are not saved.", self.node.id);
        ui.add(egui::Label::new(RichText::new(text).color(theme.warning)).wrap());
        ui.horizontal(|ui| {
            if ui.button("Discard changes").clicked() {
                return EditorState::Closed;
            }
            self.is_asking &= !ui.button("Keep editing").clicked();
            state
        })
        .inner
    }

    fn head(&mut self, ui: &mut Ui, document: &OpenDocument, actions: &mut Vec<Action>) -> EditorState {
        let row = egui::vec2(ui.available_width(), space::ROW);
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        ui.allocate_ui_with_layout(row, layout, |ui| {
            let leave = ui.button(if self.is_saved { "Close" } else { "Discard" });
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
                // A generated title follows the id.
                if new_node_text(&node.text, &before) == node.text {
                    node.text = new_node_text(&node.text, &node.id);
                }
                self.written(document);
            }
            match (leave.clicked(), aside.clicked()) {
                (true, _) => EditorState::Closed,
                (false, true) => EditorState::Hidden,
                (false, false) => EditorState::Shown,
            }
        })
        .inner
    }

    /// Shows the errors, or that there are none.
    fn show_faults(&self, ui: &mut Ui, theme: &Theme) {
        let wrapped = |ui: &mut Ui, text: String, color| {
            ui.add(egui::Label::new(RichText::new(text).color(color)).wrap());
        };
        if let Some(why) = &self.why_no_id {
            wrapped(ui, why.clone(), theme.fault);
        }
        for fault in &self.faults {
            let text = match fault.line {
                0 => fault.message.clone(),
                line => format!("Line {line}: {}", fault.message),
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
