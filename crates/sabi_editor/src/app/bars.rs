//! What stands around the panels: the menu, the models, the path into groups, and what is going on.

use std::time::Instant;

use egui::{Align, Area, Frame, Layout, Order, RichText, Ui, vec2};
use egui_phosphor::regular as icon;

use super::{Editor, NOTICE_LASTS, dress};
use crate::action::Action;
use crate::command::{
    ArrangeCommand, CanvasCommand, Command, FileCommand, GraphCommand, Habit, LookCommand, WindowCommand,
};
use crate::dock::{self, Panel};
use crate::key_map::KeyMap;
use crate::theme::{Shade, Theme, space, type_size};

impl Editor {
    pub(super) fn top_bar(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let frame = Frame::new()
            .fill(self.theme.ground)
            .inner_margin(egui::Margin::symmetric(8, 4));
        egui::Panel::top("top")
            .frame(frame)
            .show_separator_line(false)
            .show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(
                        RichText::new(icon::DIAMONDS_FOUR)
                            .color(self.theme.accent)
                            .size(type_size::HEADING),
                    );
                    ui.menu_button("File", |ui| self.file_menu(ui, actions));
                    ui.menu_button("Edit", |ui| self.commands(ui, EDIT, actions));
                    ui.menu_button("Arrange", |ui| self.commands(ui, ARRANGE, actions));
                    ui.menu_button("Window", |ui| self.window_menu(ui, actions));
                    ui.menu_button("Help", |ui| self.commands(ui, HELP, actions));
                    ui.add_space(space::WIDE);
                    self.button(ui, icon::ARROW_U_UP_LEFT, Command::Graph(GraphCommand::Undo), actions);
                    self.button(ui, icon::ARROW_U_UP_RIGHT, Command::Graph(GraphCommand::Redo), actions);
                    self.button(ui, icon::FLOPPY_DISK, Command::File(FileCommand::Save), actions);
                    self.button(ui, icon::EXPORT, Command::File(FileCommand::Export), actions);
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        self.button(
                            ui,
                            icon::SLIDERS_HORIZONTAL,
                            Command::Window(WindowCommand::UseView),
                            actions,
                        );
                        ui.with_layout(Layout::centered_and_justified(egui::Direction::LeftToRight), |ui| {
                            ui.label(RichText::new(self.marked_name()).color(self.theme.quiet));
                        });
                    });
                });
            });
    }

    /// What the graph's file is called, with a mark where it does not hold what is here.
    fn marked_name(&mut self) -> String {
        let mark = if self.document.session.is_dirty() { " •" } else { "" };
        let name = self.document.session.file().and_then(|file| file.file_name());
        format!(
            "{}{mark}",
            name.map_or("untitled".into(), |name| name.to_string_lossy())
        )
    }

    /// What the window is called, for the system's bar and its list of windows.
    pub(super) fn name_window(&mut self, context: &egui::Context) {
        let title = format!("{} – Sabi", self.marked_name());
        if self.named != title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.named = title;
        }
    }

    fn button(&self, ui: &mut Ui, sign: &str, command: Command, actions: &mut Vec<Action>) {
        let keys = self.keys.shown(command);
        let response = ui.button(sign).on_hover_text(format!("{}  {keys}", command.title()));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, command.title()));
        if response.clicked() {
            actions.push(Action::Do(command));
        }
    }

    fn commands(&self, ui: &mut Ui, commands: &[Option<Command>], actions: &mut Vec<Action>) {
        ui.set_min_width(220.0);
        for command in commands {
            match command {
                None => {
                    ui.separator();
                }
                Some(command) => {
                    let keys = self.keys.shown(*command);
                    if ui.add(egui::Button::new(command.title()).shortcut_text(keys)).clicked() {
                        actions.push(Action::Do(*command));
                    }
                }
            }
        }
    }

    fn file_menu(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        self.commands(
            ui,
            &[
                Some(Command::File(FileCommand::New)),
                Some(Command::File(FileCommand::Open)),
            ],
            actions,
        );
        ui.menu_button("Recent", |ui| {
            for path in &self.settings.recent {
                if ui.button(path.display().to_string()).clicked() {
                    actions.push(Action::OpenFile(path.clone()));
                }
            }
            if self.settings.recent.is_empty() {
                ui.weak("Nothing was open yet");
            }
        });
        if ui.button("Examples…").clicked() {
            self.files.is_start = true;
        }
        ui.separator();
        self.commands(
            ui,
            &[
                Some(Command::File(FileCommand::Save)),
                Some(Command::File(FileCommand::SaveAs)),
                None,
                Some(Command::File(FileCommand::Export)),
            ],
            actions,
        );
    }

    fn window_menu(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        for panel in Panel::ALL {
            if ui.button(panel.title()).clicked() {
                self.bring_up(panel);
            }
        }
        if ui.button("All panels where they were at first").clicked() {
            self.layout = dock::default_layout();
            self.use_layout = None;
        }
        ui.separator();
        self.commands(
            ui,
            &[
                Some(Command::Window(WindowCommand::UseView)),
                Some(Command::Look(LookCommand::MiniMap)),
                Some(Command::Look(LookCommand::FlatPictures)),
                None,
            ],
            actions,
        );
        let before = (self.settings.shade, self.settings.habit);
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.settings.shade, Shade::Dark, "Dark");
            ui.selectable_value(&mut self.settings.shade, Shade::Light, "Light");
        });
        ui.horizontal(|ui| {
            ui.label("Keys as in");
            for (habit, name) in Habit::ALL {
                ui.selectable_value(&mut self.settings.habit, habit, name);
            }
        });
        self.commands(
            ui,
            &[
                Some(Command::Window(WindowCommand::Larger)),
                Some(Command::Window(WindowCommand::Smaller)),
            ],
            actions,
        );
        if before != (self.settings.shade, self.settings.habit) {
            self.take_settings(ui.ctx());
        }
    }

    /// Follows settings that were changed.
    pub(crate) fn take_settings(&mut self, context: &egui::Context) {
        self.theme = std::sync::Arc::new(Theme::of(self.settings.shade));
        dress(context, &self.theme, self.settings.scale);
        let (keys, faults) = KeyMap::new(self.settings.habit, &self.settings.keys);
        self.keys = keys;
        for fault in faults {
            self.say(fault);
        }
    }

    /// The path into groups.
    pub(super) fn breadcrumb(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let path = self.document.path();
        if path.is_empty() {
            return;
        }
        let frame = Frame::new()
            .fill(self.theme.panel)
            .inner_margin(egui::Margin::symmetric(8, 3));
        egui::Panel::top("path")
            .frame(frame)
            .show_separator_line(false)
            .show(ui, |ui| {
                ui.horizontal(|ui| {
                    if ui.link("Graph").clicked() {
                        actions.push(Action::LeaveTo(0));
                    }
                    for (depth, (_, title)) in path.iter().enumerate() {
                        ui.label(icon::CARET_RIGHT);
                        if depth + 1 == path.len() {
                            ui.strong(title);
                        } else if ui.link(title).clicked() {
                            actions.push(Action::LeaveTo(depth + 1));
                        }
                    }
                });
            });
    }

    pub(super) fn status_bar(&mut self, ui: &mut Ui) {
        let frame = Frame::new()
            .fill(self.theme.ground)
            .inner_margin(egui::Margin::symmetric(8, 2));
        egui::Panel::bottom("status")
            .frame(frame)
            .show_separator_line(false)
            .show(ui, |ui| {
                ui.horizontal(|ui| {
                    let theme = self.theme.clone();
                    let quiet = |text: String| RichText::new(text).size(type_size::SMALL).color(theme.quiet);
                    let summary = self.stage.gpu().summary();
                    ui.label(quiet(format!("{} ({})", summary.name, summary.kind)));
                    if self.stage.is_busy() {
                        // Nothing that turns: every turn would draw the whole window again, which costs the evaluation its time.
                        ui.label(quiet(format!("{} evaluating", icon::HOURGLASS_MEDIUM)));
                    }
                    if let Some(latency) = self.stage.last.latency {
                        ui.label(quiet(crate::canvas::shown_time(latency)));
                    }
                    let count = self.problem_count();
                    if count > 0 {
                        let text = format!("{} {count}", icon::WARNING);
                        let problems = ui.link(RichText::new(text).color(theme.fault).size(type_size::SMALL));
                        if problems.clicked() {
                            self.bring_up(Panel::Problems);
                        }
                    }
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        self.measures(ui);
                        ui.label(quiet(format!("{} nodes", self.document.graph().len())));
                    });
                });
            });
    }

    /// Sentences that were said lately.
    pub(super) fn show_notices(&mut self, ui: &Ui) {
        self.notices.retain(|(said, _)| said.elapsed() < NOTICE_LASTS);
        let Some((oldest, _)) = self.notices.front() else {
            return;
        };
        let left = NOTICE_LASTS.saturating_sub(Instant::now().duration_since(*oldest));
        ui.ctx().request_repaint_after(left);
        let area = Area::new("notices".into()).order(Order::Tooltip).interactable(false);
        let corner = ui.ctx().content_rect().center_bottom() - vec2(0.0, 40.0);
        area.fixed_pos(corner)
            .pivot(egui::Align2::CENTER_BOTTOM)
            .show(ui.ctx(), |ui| {
                for (_, sentence) in &self.notices {
                    Frame::popup(ui.style()).show(ui, |ui| {
                        ui.set_max_width(560.0);
                        ui.label(sentence);
                    });
                }
            });
    }
}

pub(super) const EDIT: &[Option<Command>] = &[
    Some(Command::Graph(GraphCommand::Undo)),
    Some(Command::Graph(GraphCommand::Redo)),
    None,
    Some(Command::Canvas(CanvasCommand::AddMenu)),
    Some(Command::Graph(GraphCommand::Duplicate)),
    Some(Command::Graph(GraphCommand::DuplicateWired)),
    Some(Command::Graph(GraphCommand::Copy)),
    Some(Command::Graph(GraphCommand::Cut)),
    Some(Command::Graph(GraphCommand::Paste)),
    Some(Command::Graph(GraphCommand::Delete)),
    Some(Command::Graph(GraphCommand::Heal)),
    None,
    Some(Command::Graph(GraphCommand::Mute)),
    Some(Command::Graph(GraphCommand::SwapInputs)),
    Some(Command::Graph(GraphCommand::TakeOut)),
    Some(Command::Graph(GraphCommand::Group)),
    Some(Command::Graph(GraphCommand::Ungroup)),
    Some(Command::Graph(GraphCommand::Frame)),
    Some(Command::Canvas(CanvasCommand::Rename)),
];

pub(super) const ARRANGE: &[Option<Command>] = &[
    Some(Command::Canvas(CanvasCommand::ShowAll)),
    Some(Command::Canvas(CanvasCommand::ShowSelected)),
    None,
    Some(Command::Arrange(ArrangeCommand::SelectAll)),
    Some(Command::Arrange(ArrangeCommand::SelectUp)),
    Some(Command::Arrange(ArrangeCommand::SelectDown)),
    None,
    Some(Command::Arrange(ArrangeCommand::AlignLeft)),
    Some(Command::Arrange(ArrangeCommand::AlignRight)),
    Some(Command::Arrange(ArrangeCommand::AlignTop)),
    Some(Command::Arrange(ArrangeCommand::AlignBottom)),
    Some(Command::Arrange(ArrangeCommand::Straighten)),
    Some(Command::Arrange(ArrangeCommand::LayOut)),
];

const HELP: &[Option<Command>] = &[
    Some(Command::Window(WindowCommand::Help)),
    Some(Command::Window(WindowCommand::Keys)),
];
