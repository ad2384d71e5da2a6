//! Menus and text fields over the canvas, which take the keys while they are open.

use egui::Ui;

use super::CanvasContext;
use super::add_menu::{AddMenu, MenuResult};
use super::camera::CanvasCamera;
use super::notes::{self, NoteText};
use super::port_question::PortQuestion;
use super::questions::{self, ItemRename, MergeQuestion};
use crate::action::Action;

/// Open menus and text fields.
#[derive(Default)]
pub(super) struct Popups {
    /// Menu of nodes.
    pub(super) menu: Option<AddMenu>,
    /// Question about how to merge two masks.
    pub(super) merge: Option<MergeQuestion>,
    /// Question about which input of a node a wire leads to.
    pub(super) ports: Option<PortQuestion>,
    /// Name that is being typed.
    pub(super) renaming: Option<ItemRename>,
    /// Note that is being written.
    pub(super) note: Option<NoteText>,
}

impl Popups {
    /// Returns whether one of them is open.
    pub(super) fn is_open(&self) -> bool {
        let is_asked = self.merge.is_some() || self.ports.is_some();
        self.menu.is_some() || self.renaming.is_some() || is_asked || self.note.is_some()
    }

    /// Closes all of them without an answer.
    pub(super) fn close(&mut self) {
        *self = Popups::default();
    }

    /// Shows those that are open, and adds the actions of their answers.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        camera: &CanvasCamera,
        context: &CanvasContext<'_>,
        actions: &mut Vec<Action>,
    ) {
        if let Some(menu) = &mut self.menu {
            match menu.show(ui, context.document, context.theme, context.candidates) {
                MenuResult::Open => {}
                MenuResult::Closed => self.menu = None,
                MenuResult::Chosen(action) => {
                    self.menu = None;
                    actions.push(action);
                }
            }
        }
        questions::merge(&mut self.merge, ui, actions);
        notes::write(&mut self.note, ui, camera, actions);
        questions::rename(&mut self.renaming, ui, camera, context.document, actions);
    }
}
