//! Commands, performed by the owner of their group. No match here has a wildcard.

use egui::Ui;
use sabi_editing::{OpenDocument, navigation};

use super::Editor;
use crate::action::{ExportAction, FileAction, LookAction, Next};
use crate::app::graph_edits::arrangement;
use crate::app::packing::ask_to_pack;
use crate::app::shell::Shell;
use crate::command::{CanvasCommand, Command, FileCommand, LookCommand, WindowCommand};
use crate::dock::Panel;
use crate::shown_results::ShownResults;

/// Factor of one step of the interface's size.
const SCALE_STEP: f32 = 1.1;

impl Editor {
    /// Performs the command of a key or a menu entry.
    pub(super) fn command(&mut self, command: Command, ui: &Ui) {
        match command {
            Command::File(command) => self.file_command(command),
            Command::Window(command) => self.window_command(command),
            Command::Graph(command) => self.edits().command(command, ui),
            Command::Arrange(command) => self.edits().edit(arrangement(command), ui),
            Command::Canvas(command) => self.canvas_command(command, ui),
            Command::Look(command) => {
                look_command(command, &self.documents.document, &mut self.looks, &mut self.shell);
            }
            Command::Viewport(command) => {
                if let Some(rect) = self.shell.dock.rects.get(&Panel::Viewport).copied() {
                    let pointer = ui.input(|input| input.pointer.hover_pos());
                    let seen = self.looks.on_model(&self.documents.document, &self.shell.settings);
                    let model = &mut self.views.model;
                    model.command(command, &self.evaluation, &seen, rect, pointer);
                }
            }
            Command::Texture(command) => self.views.flat.command(command),
            Command::Brush(command) => self.painting().command(command, ui),
            Command::Favorite(favorite) => self.edits().add_favorite(favorite, ui),
        }
    }

    fn file_command(&mut self, command: FileCommand) {
        match command {
            FileCommand::New => self.perform_on_file(FileAction::Ask(Next::New)),
            FileCommand::Open => self.views.questions.ask_to_open(&self.documents.document),
            FileCommand::Save => self.saving().save(),
            FileCommand::SaveAs => self.views.questions.ask_to_save(&self.documents.document),
            FileCommand::Export => {
                self.shell.dock.bring_up(Panel::Export);
                self.perform_export(ExportAction::Start { force: false });
            }
            FileCommand::ImportPictures => self.views.questions.ask_for_pictures(&self.documents.document),
            FileCommand::Pack => {
                ask_to_pack(
                    &self.packing,
                    &mut self.documents,
                    &mut self.shell,
                    &mut self.views.questions,
                );
            }
        }
    }

    /// Performs a command about the window around the views.
    pub(in crate::app) fn window_command(&mut self, command: WindowCommand) {
        match command {
            WindowCommand::NextPanel => self.shell.step_panel(true),
            WindowCommand::PreviousPanel => self.shell.step_panel(false),
            WindowCommand::Help => {
                self.views.page.show_node();
                self.shell.dock.bring_up(Panel::Page);
            }
            WindowCommand::Tutorial => {
                self.views.page.show_tutorial();
                self.shell.dock.bring_up(Panel::Page);
            }
            WindowCommand::Keys => self.views.key_list.is_open = !self.views.key_list.is_open,
            WindowCommand::UseView => {
                if self.shell.dock.toggle_use_view() {
                    // Only the model and the exposed parameters of the whole graph are shown.
                    navigation::leave_to(&mut self.documents.document, 0);
                    self.looks.followed = None;
                    self.shell.keyboard.active = Panel::Viewport;
                }
            }
            WindowCommand::Larger => self.shell.scale_by(SCALE_STEP),
            WindowCommand::Smaller => self.shell.scale_by(1.0 / SCALE_STEP),
        }
    }

    fn canvas_command(&mut self, command: CanvasCommand, ui: &Ui) {
        if matches!(
            command,
            CanvasCommand::AddMenu | CanvasCommand::Rename | CanvasCommand::AddNote
        ) {
            // The menu and the text field open on the canvas.
            self.shell.dock.bring_up(Panel::Canvas);
        }
        for action in self.views.canvas.command(command, ui, &self.documents.document) {
            self.perform(action, ui);
        }
    }
}

/// Changes the results that the views show, or how they show them.
fn look_command(command: LookCommand, document: &OpenDocument, looks: &mut ShownResults, shell: &mut Shell) {
    let settings = &mut shell.settings;
    match command {
        LookCommand::FlatPictures => settings.is_flat = !settings.is_flat,
        LookCommand::MiniMap => settings.has_mini_map = !settings.has_mini_map,
        LookCommand::Preview => match document.selected_one() {
            Some(id) => {
                looks.show(document, id, None);
                looks.perform(LookAction::Follow, settings);
            }
            None => shell.notify("Select the node to show first."),
        },
        LookCommand::Follow => {
            settings.follows = !settings.follows;
            let sentence = match settings.follows {
                true => "The model shows the node that is clicked.",
                false => "The model always shows the outputs.",
            };
            shell.notify(sentence);
        }
        LookCommand::Pin => match document.selected_one() {
            None if looks.pinned_3d.is_none() => shell.notify("Select the node to pin to the 3D view first."),
            id => looks.toggle_pin_3d(document, id),
        },
        LookCommand::Compare => looks.is_compared = !looks.is_compared,
    }
}
