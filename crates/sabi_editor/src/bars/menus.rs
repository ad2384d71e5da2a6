//! The bar at the top of the window, with the menus.

use egui::{Align, Button, Direction, Layout, Margin, RichText, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::OpenDocument;

use super::bar;
use crate::action::{Action, FileAction, Next, SettingAction};
use crate::command::{
    ArrangeCommand, CanvasCommand, Command, FileCommand, GraphCommand, InputPreset, LookCommand, WindowCommand,
};
use crate::context::ViewContext;
use crate::dock::{Panel, Workspace};
use crate::paths::file_name;
use crate::theme::{ColorScheme, space, type_size};

/// Entries of the Edit menu; `None` is a line between them.
pub(crate) const EDIT: &[Option<Command>] = &[
    graph(GraphCommand::Undo),
    graph(GraphCommand::Redo),
    None,
    canvas(CanvasCommand::AddMenu),
    graph(GraphCommand::Duplicate),
    graph(GraphCommand::DuplicateWired),
    graph(GraphCommand::Copy),
    graph(GraphCommand::Cut),
    graph(GraphCommand::Paste),
    graph(GraphCommand::Delete),
    graph(GraphCommand::Heal),
    None,
    graph(GraphCommand::Mute),
    graph(GraphCommand::Collapse),
    graph(GraphCommand::HidePorts),
    graph(GraphCommand::NameWires),
    graph(GraphCommand::SwapInputs),
    graph(GraphCommand::TakeOut),
    graph(GraphCommand::Group),
    graph(GraphCommand::Ungroup),
    graph(GraphCommand::Frame),
    canvas(CanvasCommand::Rename),
    canvas(CanvasCommand::AddNote),
];

/// Entries of the Arrange menu.
pub(crate) const ARRANGE: &[Option<Command>] = &[
    canvas(CanvasCommand::ShowAll),
    canvas(CanvasCommand::ShowSelected),
    None,
    arrange(ArrangeCommand::SelectAll),
    arrange(ArrangeCommand::SelectMuted),
    arrange(ArrangeCommand::SelectUp),
    arrange(ArrangeCommand::SelectDown),
    None,
    arrange(ArrangeCommand::AlignLeft),
    arrange(ArrangeCommand::AlignRight),
    arrange(ArrangeCommand::AlignTop),
    arrange(ArrangeCommand::AlignBottom),
    arrange(ArrangeCommand::DistributeAcross),
    arrange(ArrangeCommand::DistributeDown),
    arrange(ArrangeCommand::Straighten),
    arrange(ArrangeCommand::LayOut),
];

/// Entries of the Help menu.
const HELP: &[Option<Command>] = &[
    window(WindowCommand::Tutorial),
    window(WindowCommand::Help),
    window(WindowCommand::Keys),
];

/// Entries of the File menu above and below the recent files.
const OPEN: &[Option<Command>] = &[file(FileCommand::New), file(FileCommand::Open)];
const SAVE: &[Option<Command>] = &[
    file(FileCommand::Save),
    file(FileCommand::SaveAs),
    None,
    file(FileCommand::ImportPictures),
    file(FileCommand::Export),
    file(FileCommand::Pack),
];
/// Entries of the Window menu below the panels and at its end.
const VIEWS: &[Option<Command>] = &[
    window(WindowCommand::UseView),
    look(LookCommand::MiniMap),
    look(LookCommand::FlatPictures),
    None,
];
const SIZES: &[Option<Command>] = &[window(WindowCommand::Larger), window(WindowCommand::Smaller)];

/// Numbers of backups that are offered.
const BACKUPS: [usize; 5] = [0, 1, 3, 5, 9];

const fn file(command: FileCommand) -> Option<Command> {
    Some(Command::File(command))
}

const fn window(command: WindowCommand) -> Option<Command> {
    Some(Command::Window(command))
}

const fn graph(command: GraphCommand) -> Option<Command> {
    Some(Command::Graph(command))
}

const fn arrange(command: ArrangeCommand) -> Option<Command> {
    Some(Command::Arrange(command))
}

const fn canvas(command: CanvasCommand) -> Option<Command> {
    Some(Command::Canvas(command))
}

const fn look(command: LookCommand) -> Option<Command> {
    Some(Command::Look(command))
}

/// Bar at the top: menus, the most used commands, and the name of the graph's file.
pub(crate) fn top(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    egui::Panel::top("top")
        .frame(bar(context.theme.background, Margin::symmetric(8, 4)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal(|ui| contents(ui, context, &mut actions));
        });
    actions
}

fn contents(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let sign = RichText::new(icon::DIAMONDS_FOUR);
    ui.label(sign.color(context.theme.accent).size(type_size::HEADING));
    ui.menu_button("File", |ui| file_menu(ui, context, actions));
    ui.menu_button("Edit", |ui| entries(ui, context, EDIT, actions));
    ui.menu_button("Arrange", |ui| entries(ui, context, ARRANGE, actions));
    ui.menu_button("Window", |ui| window_menu(ui, context, actions));
    ui.menu_button("Help", |ui| entries(ui, context, HELP, actions));
    ui.add_space(space::WIDE);
    for (sign, command) in [
        (icon::ARROW_U_UP_LEFT, Command::Graph(GraphCommand::Undo)),
        (icon::ARROW_U_UP_RIGHT, Command::Graph(GraphCommand::Redo)),
        (icon::FLOPPY_DISK, Command::File(FileCommand::Save)),
        (icon::EXPORT, Command::File(FileCommand::Export)),
    ] {
        button(ui, context, sign, command, actions);
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let use_view = Command::Window(WindowCommand::UseView);
        button(ui, context, icon::SLIDERS_HORIZONTAL, use_view, actions);
        ui.with_layout(Layout::centered_and_justified(Direction::LeftToRight), |ui| {
            let name = marked_name(context.document, context.is_dirty);
            ui.label(RichText::new(name).color(context.theme.quiet));
        });
    });
}

/// Name of the graph's file, with a mark if there are unsaved changes.
pub(crate) fn marked_name(document: &OpenDocument, is_dirty: bool) -> String {
    let mark = if is_dirty { " •" } else { "" };
    let name = document.session.file().map_or("untitled".into(), file_name);
    let access = if document.session.graph_file.is_read_only() {
        " (for reading only)"
    } else {
        ""
    };
    format!("{name}{access}{mark}")
}

fn button(ui: &mut Ui, context: &ViewContext<'_>, sign: &str, command: Command, actions: &mut Vec<Action>) {
    let keys = context.keys.shown(command);
    let response = ui.button(sign).on_hover_text(format!("{}  {keys}", command.title()));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, command.title()));
    if response.clicked() {
        actions.push(Action::Do(command));
    }
}

fn entries(ui: &mut Ui, context: &ViewContext<'_>, commands: &[Option<Command>], actions: &mut Vec<Action>) {
    ui.set_min_width(220.0);
    for command in commands {
        match command {
            None => {
                ui.separator();
            }
            Some(command) => {
                let keys = context.keys.shown(*command);
                if ui.add(Button::new(command.title()).shortcut_text(keys)).clicked() {
                    actions.push(Action::Do(*command));
                }
            }
        }
    }
}

fn file_menu(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    entries(ui, context, OPEN, actions);
    ui.menu_button("Recent", |ui| {
        let recent = &context.settings.recent;
        for path in recent {
            if ui.button(path.display().to_string()).clicked() {
                actions.push(Action::File(FileAction::Ask(Next::Open(path.clone()))));
            }
        }
        if recent.is_empty() {
            ui.weak("Nothing was open yet");
        }
    });
    if ui.button("Examples…").clicked() {
        actions.push(Action::ShowStartPage);
    }
    ui.separator();
    entries(ui, context, SAVE, actions);
    ui.menu_button("Backups", |ui| backups_menu(ui, context, actions));
    ui.separator();
    if ui.button("Quit").clicked() {
        actions.push(Action::File(FileAction::Ask(Next::Close)));
    }
}

/// Choice of the number of backups.
fn backups_menu(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    ui.label("Earlier files that a save keeps, as .bak, .bak2 …");
    for offered in BACKUPS {
        let words = match offered {
            0 => "none".to_owned(),
            1 => "the last one".to_owned(),
            several => format!("the last {several}"),
        };
        if ui.radio(context.settings.backups == offered, words).clicked() {
            actions.push(Action::Setting(SettingAction::Backups(offered)));
        }
    }
}

fn window_menu(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    for panel in Panel::ALL {
        if ui.button(panel.title()).clicked() {
            actions.push(Action::ShowPanel(panel));
        }
    }
    ui.separator();
    ui.menu_button("Workspace", |ui| {
        for (workspace, title) in Workspace::ALL {
            let tooltip = workspace.about();
            if ui.button(title).on_hover_text(tooltip).clicked() {
                actions.push(Action::Arrange(workspace));
            }
        }
    });
    if ui.button("Reset the layout of the panels").clicked() {
        actions.push(Action::Arrange(Workspace::Material));
    }
    entries(ui, context, VIEWS, actions);
    let (mut shade, mut preset) = (context.settings.shade, context.settings.input_preset);
    ui.horizontal(|ui| {
        ui.label("Colors");
        ui.selectable_value(&mut shade, ColorScheme::Dark, "Dark");
        ui.selectable_value(&mut shade, ColorScheme::Light, "Light");
    });
    ui.horizontal(|ui| {
        ui.label("Keys");
        for (offered, name) in InputPreset::ALL {
            ui.selectable_value(&mut preset, offered, name);
        }
    });
    entries(ui, context, SIZES, actions);
    if shade != context.settings.shade {
        actions.push(Action::Setting(SettingAction::Shade(shade)));
    }
    if preset != context.settings.input_preset {
        actions.push(Action::Setting(SettingAction::InputPreset(preset)));
    }
}
