//! Name, inputs and outputs of the shown graph as a group.

use egui::{RichText, TextWrapMode, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::command::PortCommand;
use sabi_editing::{OpenDocument, connections, groups, ports};
use sabi_engine::catalog::Port;
use sabi_graph::{Body, GroupInput, OutputRef, SlotRef};

use super::text_field::TextField;
use crate::theme::{Theme, space, type_size};

/// Width of the button that removes a row, with the space beside it, points.
const REMOVE_BUTTON: f32 = 34.0;

/// Shows the name, inputs and outputs, and returns the requested edits.
pub(crate) fn show(ui: &mut Ui, theme: &Theme, document: &OpenDocument) -> Vec<PortCommand> {
    let mut commands = Vec::new();
    let is_group = matches!(document.body(), Body::Group(_));
    let count = ports::inputs(document).len() + ports::outputs(document).len();
    let title = match (is_group, count) {
        (true, _) => "THE GROUP".to_owned(),
        (false, 0) => "GROUP INPUTS AND OUTPUTS".to_owned(),
        (false, count) => format!("GROUP INPUTS AND OUTPUTS ({count})"),
    };
    ui.add_space(space::WIDE);
    let title = RichText::new(title).size(type_size::SMALL).color(theme.quiet);
    egui::CollapsingHeader::new(title)
        .id_salt(("ports", document.body()))
        .default_open(is_group)
        .show_unindented(ui, |ui| {
            name(ui, theme, document, is_group, &mut commands);
            if count == 0 {
                let sentence = "It has no inputs and outputs yet. Right-click a port of a node on the canvas to expose it as an \
                                input or an output.";
                ui.add(egui::Label::new(RichText::new(sentence).color(theme.quiet)).wrap());
            }
            inputs(ui, theme, document, &mut commands);
            outputs(ui, theme, document, &mut commands);
        });
    commands
}

fn name(ui: &mut Ui, theme: &Theme, document: &OpenDocument, is_group: bool, commands: &mut Vec<PortCommand>) {
    ui.horizontal(|ui| {
        ui.colored_label(theme.quiet, "Name");
        let field = TextField {
            name: if is_group {
                "Name of the group"
            } else {
                "Name of the graph"
            },
            hint: "no name",
            held: &groups::graph_name(document),
            width: ui.available_width() - space::USUAL,
        };
        commands.extend(field.show(ui, ("name of", document.body())).map(PortCommand::NameGraph));
    });
}

fn inputs(ui: &mut Ui, theme: &Theme, document: &OpenDocument, commands: &mut Vec<PortCommand>) {
    if !ports::inputs(document).is_empty() {
        ui.label(RichText::new("Inputs").color(theme.quiet));
    }
    for (name, input) in ports::inputs(document) {
        let port = document.own_interface().and_then(|interface| interface.input(name));
        ui.horizontal(|ui| {
            dot(ui, theme, port);
            let width = (ui.available_width() - 34.0 - 2.0 * space::USUAL) / 2.0 - space::USUAL;
            let label = TextField {
                name: "Label of the input",
                hint: name,
                held: port.map_or("", |port| &port.label),
                width,
            };
            if let Some(label) = label.show(ui, ("label", name)) {
                let name = name.clone();
                commands.push(PortCommand::SetInputLabel { name, label });
            }
            let own = TextField {
                name: "Input",
                hint: "name in files",
                held: name,
                width,
            };
            if let Some(to) = own.show(ui, ("input", name)) {
                let name = name.clone();
                commands.push(PortCommand::RenameInput { name, to });
            }
            if small(ui, icon::TRASH, &format!("Remove the input {name}")) {
                commands.push(PortCommand::RemoveInput(name.clone()));
            }
        });
        feeds(ui, theme, document, name, input, commands);
    }
}

/// Shows the inputs of nodes that an input feeds, and a menu of those that it can feed.
fn feeds(
    ui: &mut Ui,
    theme: &Theme,
    document: &OpenDocument,
    name: &str,
    input: &GroupInput,
    commands: &mut Vec<PortCommand>,
) {
    ui.horizontal_wrapped(|ui| {
        ui.add_space(space::WIDE);
        ui.colored_label(theme.quiet, icon::ARROW_BEND_DOWN_RIGHT);
        for slot in &input.to {
            let title = title_of_slot(document, slot);
            let chip = egui::Button::new(format!("{title} {}", icon::X)).small();
            if ui.add(chip).on_hover_text("Disconnect").clicked() {
                commands.push(PortCommand::Unfeed(slot.clone()));
            }
        }
        let feedable = ports::feedable(document, name);
        let more = ui.add_enabled_ui(!feedable.is_empty(), |ui| {
            let menu = ui.menu_button(icon::PLUS, |ui| {
                list(
                    ui,
                    feedable.iter().map(|slot| (title_of_slot(document, slot), slot)),
                    |slot| {
                        commands.push(PortCommand::Feed {
                            name: name.to_owned(),
                            slot: slot.clone(),
                        });
                    },
                );
            });
            menu.response.widget_info(|| {
                WidgetInfo::labeled(
                    WidgetType::Button,
                    true,
                    format!("Connect the input {name} to another node"),
                )
            });
        });
        more.response.on_hover_text("Connect to the input of another node too");
    });
}

fn outputs(ui: &mut Ui, theme: &Theme, document: &OpenDocument, commands: &mut Vec<PortCommand>) {
    if !ports::outputs(document).is_empty() {
        ui.label(RichText::new("Outputs").color(theme.quiet));
    }
    for (name, from) in ports::outputs(document) {
        let port = document
            .own_interface()
            .and_then(|interface| interface.output(Some(name)));
        ui.horizontal(|ui| {
            dot(ui, theme, port);
            let width = (ui.available_width() - 34.0 - 2.0 * space::USUAL) / 2.0 - space::USUAL;
            let own = TextField {
                name: "Output",
                hint: "name in files",
                held: name,
                width,
            };
            if let Some(to) = own.show(ui, ("output", name)) {
                let name = name.clone();
                commands.push(PortCommand::RenameOutput { name, to });
            }
            let chosen = ui.scope(|ui| {
                // A long title leaves room for the button beside it.
                ui.set_max_width((ui.available_width() - REMOVE_BUTTON).max(0.0));
                ui.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
                let mut chosen = None;
                let menu = ui.menu_button(title_of_result(document, from), |ui| {
                    let results = ports::results(document);
                    let entries = results.iter().map(|from| (title_of_result(document, from), from));
                    list(ui, entries, |from| chosen = Some(from.clone()));
                });
                menu.response.on_hover_text("Result that it gives");
                chosen
            });
            commands.extend(chosen.inner.map(|from| PortCommand::Retarget {
                name: name.clone(),
                from,
            }));
            if small(ui, icon::TRASH, &format!("Remove the output {name}")) {
                commands.push(PortCommand::RemoveOutput(name.clone()));
            }
        });
    }
}

/// Shows the entries of a menu.
fn list<'l, T: 'l>(ui: &mut Ui, entries: impl Iterator<Item = (String, &'l T)>, mut choose: impl FnMut(&T)) {
    egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
        for (title, entry) in entries {
            if ui.button(title).clicked() {
                choose(entry);
            }
        }
    });
}

fn title_of_slot(document: &OpenDocument, slot: &SlotRef) -> String {
    let port = connections::input(document, slot).map_or(&slot.name, |port| &port.label);
    let interface = document.interface(&slot.node);
    let is_param_mask = interface.is_some_and(|interface| interface.param_mask(&slot.name).is_some());
    let sign = if is_param_mask { "× " } else { "" };
    format!("{} · {sign}{port}", document.title(&slot.node))
}

fn title_of_result(document: &OpenDocument, from: &OutputRef) -> String {
    let interface = document.interface(&from.node);
    let port = interface.and_then(|interface| interface.output(from.port.as_deref()));
    match port {
        Some(port) => format!("{} · {}", document.title(&from.node), port.label),
        None => document.title(&from.node),
    }
}

fn dot(ui: &mut Ui, theme: &Theme, port: Option<&Port>) {
    let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(10.0), egui::Sense::hover());
    let ty = port.and_then(|port| port.ty);
    ui.painter().circle_filled(rect.center(), 4.0, theme.port(ty));
}

fn small(ui: &mut Ui, sign: &str, name: &str) -> bool {
    let response = ui.small_button(sign);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
    response.on_hover_text(name).clicked()
}
