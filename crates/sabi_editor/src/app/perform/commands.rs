//! Commands, performed by the owner of their group. No match here has a wildcard.

use egui::Ui;
use sabi_editing::Align;

use super::Editor;
use crate::action::LookAsk;
use crate::command::{
    ArrangeCommand, CanvasCommand, Command, FileCommand, GraphCommand, LookCommand, ViewportCommand, WindowCommand,
};
use crate::dock::Panel;

/// Factor of one step of the interface's size.
const SCALE_STEP: f32 = 1.1;

impl Editor {
    /// Performs what a key or a menu entry asks for.
    pub(super) fn command(&mut self, command: Command, ui: &Ui) {
        match command {
            Command::File(command) => self.file_command(command),
            Command::Window(command) => self.window_command(command, ui),
            Command::Graph(command) => self.graph_command(command, ui),
            Command::Arrange(command) => self.arrange_command(command),
            Command::Canvas(command) => self.canvas_command(command, ui),
            Command::Look(command) => self.look_command(command),
            Command::Viewport(command) => self.viewport_command(command, ui),
            Command::Texture(command) => self.flat_view.command(command),
            Command::Favorite(favorite) => self.add_favorite(favorite, ui),
        }
    }

    fn file_command(&mut self, command: FileCommand) {
        match command {
            FileCommand::New => self.files.ask_new(&mut self.document),
            FileCommand::Open => self.files.ask_open(&self.document),
            FileCommand::Save => self.save(),
            FileCommand::SaveAs => self.files.ask_save(&self.document),
            FileCommand::Export => {
                self.bring_up(Panel::Export);
                self.export();
            }
        }
    }

    fn window_command(&mut self, command: WindowCommand, ui: &Ui) {
        match command {
            WindowCommand::NextPanel => self.step_panel(true, ui.ctx()),
            WindowCommand::PreviousPanel => self.step_panel(false, ui.ctx()),
            WindowCommand::Help => {
                self.panels.page.show_node();
                self.bring_up(Panel::Page);
            }
            WindowCommand::Keys => self.files.shows_keys = !self.files.shows_keys,
            WindowCommand::UseView => self.toggle_use_view(),
            WindowCommand::Larger => self.scale_by(SCALE_STEP, ui),
            WindowCommand::Smaller => self.scale_by(1.0 / SCALE_STEP, ui),
        }
    }

    fn graph_command(&mut self, command: GraphCommand, ui: &Ui) {
        let document = &mut self.document;
        match command {
            GraphCommand::Undo => document.undo(),
            GraphCommand::Redo => document.redo(),
            GraphCommand::Delete => drop(document.delete(false)),
            GraphCommand::Heal => drop(document.delete(true)),
            GraphCommand::TakeOut => drop(document.take_out()),
            GraphCommand::SwapInputs => drop(document.swap_inputs()),
            GraphCommand::Mute => drop(document.mute()),
            GraphCommand::Duplicate => drop(document.duplicate(false)),
            GraphCommand::DuplicateWired => drop(document.duplicate(true)),
            GraphCommand::Copy => self.copy(ui),
            GraphCommand::Cut => {
                if let Some(text) = document.cut_out() {
                    ui.ctx().copy_text(text);
                }
            }
            GraphCommand::Paste => self.ask_paste(ui.ctx()),
            GraphCommand::Frame => drop(document.frame()),
            GraphCommand::Group => drop(document.make_group()),
            GraphCommand::Ungroup => drop(document.dissolve_groups()),
            GraphCommand::Enter => {
                if let Some(id) = document.selected_one().cloned() {
                    document.enter(&id);
                }
            }
            GraphCommand::Leave => {
                if !self.canvas.let_go() {
                    document.leave();
                }
            }
        }
    }

    fn arrange_command(&mut self, command: ArrangeCommand) {
        let document = &mut self.document;
        match command {
            ArrangeCommand::AlignLeft => drop(document.align(Align::Left)),
            ArrangeCommand::AlignRight => drop(document.align(Align::Right)),
            ArrangeCommand::AlignTop => drop(document.align(Align::Top)),
            ArrangeCommand::AlignBottom => drop(document.align(Align::Bottom)),
            ArrangeCommand::Straighten => drop(document.straighten()),
            ArrangeCommand::LayOut => drop(document.lay_out()),
            ArrangeCommand::SelectAll => document.select_all(),
            ArrangeCommand::SelectUp => document.select_stream(true),
            ArrangeCommand::SelectDown => document.select_stream(false),
        }
    }

    fn canvas_command(&mut self, command: CanvasCommand, ui: &Ui) {
        if matches!(command, CanvasCommand::AddMenu | CanvasCommand::Rename) {
            // The menu and the text field open on the canvas.
            self.bring_up(Panel::Canvas);
        }
        for action in self.canvas.command(command, ui, &self.document) {
            self.perform(action, ui);
        }
    }

    fn look_command(&mut self, command: LookCommand) {
        let selected = self.document.selected_one().cloned();
        match command {
            LookCommand::FlatPictures => self.settings.is_flat = !self.settings.is_flat,
            LookCommand::MiniMap => self.settings.has_mini_map = !self.settings.has_mini_map,
            LookCommand::Preview => {
                let Some(id) = selected else {
                    self.say("Select the node to show first.");
                    return;
                };
                self.look_at(&id, None);
                self.look(LookAsk::Follow);
            }
            LookCommand::Follow => {
                self.settings.follows = !self.settings.follows;
                self.say(match self.settings.follows {
                    true => "The model shows the node that is clicked.",
                    false => "The model shows the outputs whatever is clicked.",
                });
            }
            LookCommand::Lock => {
                let chosen = selected.map(|id| self.chosen(&id));
                self.locked = if self.locked == chosen { None } else { chosen };
            }
            LookCommand::Compare => {
                self.model_view.wipe = if self.model_view.wipe.is_some() {
                    None
                } else {
                    Some(0.5)
                };
            }
        }
    }

    fn viewport_command(&mut self, command: ViewportCommand, ui: &Ui) {
        let rect = self.rects.get(&Panel::Viewport).copied();
        let pointer = ui.input(|input| input.pointer.hover_pos());
        let seen = self.seen();
        if let Some(rect) = rect {
            self.model_view.command(command, &self.stage, &seen, rect, pointer);
        }
    }

    fn scale_by(&mut self, factor: f32, ui: &Ui) {
        self.settings.scale = (self.settings.scale * factor).clamp(0.5, 3.0);
        ui.ctx().set_zoom_factor(self.settings.scale);
    }

    fn copy(&mut self, ui: &Ui) {
        match self.document.copied() {
            Some(text) => ui.ctx().copy_text(text),
            None => self.say("Select the nodes to copy first"),
        }
    }
}
