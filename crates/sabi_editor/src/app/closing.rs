//! Closes the window, or leaves its state to another one.

use egui::{Context, Ui, ViewportCommand};

use super::Editor;
use super::autosave::autosave_at_end;
use super::opening::LostWindow;
use super::shell::Shell;
use crate::action::Next;
use crate::dock::Panel;
use crate::exports::Exports;
use crate::files::Question;
use crate::views::Views;

impl Editor {
    /// Keeps the window open if closing it would lose unsaved work, and asks what to do.
    pub(super) fn keep_open(&mut self, ui: &Ui) {
        if !ui.input(|input| input.viewport().close_requested()) || self.may_close {
            return;
        }
        let is_held = if self.documents.document.session.is_dirty() {
            self.views.questions.open = Some(Question::Unsaved { next: Next::Close });
            true
        } else {
            is_held_open(&mut self.views, &mut self.shell, &self.exports)
        };
        if is_held {
            ui.ctx().send_viewport_cmd(ViewportCommand::CancelClose);
        }
    }

    /// Hands the session over to a window on another device, since this one's is lost.
    pub(super) fn hand_over(&mut self, context: &Context) {
        self.documents.name_model_of_unsaved(&self.evaluation);
        let mut document = self.documents.take();
        // In case the other window cannot be opened.
        autosave_at_end(&mut document, &self.views.page.unsaved());
        self.views.canvas.cancel_all();
        if let Ok(mut handover) = self.handover.lock() {
            *handover = Some(LostWindow {
                document,
                canvas: std::mem::take(&mut self.views.canvas),
                model: self.evaluation.model.file().to_owned(),
                beside: self.row.files(),
                drafts: self.views.page.take_drafts(),
                was_exporting: self.exports.running.is_some(),
            });
        }
        self.evaluation.lost = None;
        self.is_leaving = true;
        context.send_viewport_cmd(ViewportCommand::Close);
    }

    /// Closes the open graph as the window ends. Changes that were neither saved nor discarded are kept for recovery, since
    /// a system may end programs without a question.
    pub(super) fn end(&mut self) {
        self.documents.name_model_of_unsaved(&self.evaluation);
        let mut document = self.documents.take();
        let drafts = self.views.page.unsaved();
        if self.may_close || !document.session.is_dirty() && drafts.is_empty() {
            document.session.close();
        } else {
            autosave_at_end(&mut document, &drafts);
        }
    }
}

/// Returns whether an unsaved node file or a running export keeps the window open, and shows it to the user.
pub(super) fn is_held_open(views: &mut Views, shell: &mut Shell, exports: &Exports) -> bool {
    if views.page.show_unsaved() {
        shell.dock.bring_up(Panel::Page);
        shell.notify("The text of a node is not saved: save or discard it, then close the window.");
        return true;
    }
    let is_exporting = exports.running.is_some();
    if is_exporting {
        views.questions.open = Some(Question::Exporting);
    }
    is_exporting
}
