//! Performs the actions of the brush.

use egui::Ui;
use sabi_editing::command::{Outcome, PaintCommand, perform};
use sabi_editing::painting;

use crate::action::{LookAction, PaintAction};
use crate::app::Editor;
use crate::command::BrushCommand;

impl Editor {
    pub(super) fn perform_painting(&mut self, action: PaintAction, ui: &Ui) {
        match action {
            PaintAction::Begin => self.begin_drag(),
            PaintAction::Lay(command) => self.edit(command, ui),
            PaintAction::Change(command) => {
                self.edit(command, ui);
                self.keep_strokes();
            }
            PaintAction::End => {
                self.end_drag();
                self.keep_strokes();
            }
            PaintAction::Cancel => self.cancel_drag(),
            PaintAction::Choose(brush) => self.shell.settings.brush = brush,
        }
    }

    /// Stores the strokes, and has the graph that names them stored soon.
    pub(super) fn keep_strokes(&mut self) {
        if let Err(error) = self.documents.document.session.keep_strokes() {
            self.shell.notify(error.to_string());
        }
        self.documents.autosave.invalidate();
    }

    pub(super) fn brush_command(&mut self, command: BrushCommand, ui: &Ui) {
        let paints = self.paints();
        let brush = &mut self.shell.settings.brush;
        match command {
            BrushCommand::Paint if paints => self.looks.is_painting = false,
            BrushCommand::Paint => self.begin_painting(ui),
            BrushCommand::Larger => *brush = brush.resized(true),
            BrushCommand::Smaller => *brush = brush.resized(false),
            BrushCommand::Erase => brush.erases = !brush.erases,
        }
    }

    /// Returns whether drags on the model paint: with another node selected they do not.
    fn paints(&self) -> bool {
        let document = &self.documents.document;
        let selected = document.selected_one();
        self.looks.is_painting && selected.is_some_and(|node| painting::strokes_of(document, node).is_some())
    }

    /// Begins to paint on the selected paint node, or on a new one over the selected mask.
    fn begin_painting(&mut self, ui: &Ui) {
        let document = &mut self.documents.document;
        let Some(node) = document.selected_one().cloned() else {
            self.shell
                .notify("Select the mask to paint over, or a Paint node from the library.");
            return;
        };
        if let Outcome::Added(node) = perform(document, PaintCommand::Over(node).into()) {
            self.looks.show(document, &node, None);
            // The material shows what the strokes do to it; a mask that nothing reads has only itself to show.
            if painting::is_read(document, &node) {
                self.looks.perform(LookAction::Outputs, &mut self.shell.settings);
            }
            self.looks.is_painting = true;
            self.shell.dock.bring_up(crate::dock::Panel::Viewport);
            ui.ctx().request_repaint();
        }
    }
}
