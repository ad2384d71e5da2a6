//! The context menu of ports, and the marks of exposed ports.

use egui::{Align2, FontId, Painter, Pos2, Response, Stroke, vec2};
use sabi_editing::command::{PortCommand, WireCommand};
use sabi_editing::{OpenDocument, connections, ports, wires};
use sabi_graph::{Body, OutputRef, SlotRef};

use super::add_menu::{AddMenu, Purpose};
use super::popups::Popups;
use super::port_refs::{NAME_OF_EXPOSED, PortRef};
use super::wires::is_named;
use super::{Canvas, wire_names};
use crate::action::Action;
use crate::theme::{Theme, type_size};

/// Zoom below which names of exposed ports are not drawn.
const LEGIBLE: f32 = 0.7;

/// Shows the context menu of a port.
pub(super) fn show(
    canvas: &mut Canvas,
    response: &Response,
    place: &PortRef,
    document: &OpenDocument,
    actions: &mut Vec<Action>,
) {
    response.context_menu(|ui| {
        let whole = match document.body() {
            Body::Main => "graph",
            Body::Group(_) => "group",
        };
        let exposed_as = ports::exposed_as(document, &place.pending_wire());
        let (expose, off) = match place {
            PortRef::Input(_) => (
                format!("Expose as input of the {whole}"),
                "Disconnect from the input".to_owned(),
            ),
            PortRef::Output(_) => (
                format!("Expose as output of the {whole}"),
                "Remove the output".to_owned(),
            ),
        };
        match &exposed_as {
            None if ui.button(expose).clicked() => actions.push(Action::edit(expose_command(place))),
            Some(name) if ui.button(format!("{off} '{}'", label(document, place, name))).clicked() => {
                actions.push(Action::edit(unexpose(place, name)));
            }
            _ => {}
        }
        let wires = wires_at(document, place);
        ui.separator();
        if ui
            .add_enabled(!wires.is_empty(), egui::Button::new("Disconnect"))
            .clicked()
        {
            actions.push(Action::edit(WireCommand::Disconnect(wires.clone())));
        }
        let instead = match (place, wires.is_empty()) {
            (PortRef::Input(_), false) => "Replace with…",
            _ => "Connect a new node…",
        };
        if let PortRef::Input(slot) = place {
            for from in named_outputs(document, slot) {
                if ui
                    .button(format!("Connect to {}", wire_names::name_of(document, &from)))
                    .clicked()
                {
                    let to = slot.clone();
                    actions.push(Action::edit(WireCommand::Connect { from, to, off: None }));
                }
            }
        }
        if ui.button(instead).clicked() {
            open_node_menu(&mut canvas.popups, document, place, response.rect.center());
        }
    });
}

/// Outputs whose wires are drawn as names and that an input accepts.
fn named_outputs(document: &OpenDocument, slot: &SlotRef) -> Vec<OutputRef> {
    let named = document.graph().ids().filter(|id| is_named(document, id));
    let outputs = named.flat_map(|id| {
        let ports = document.interface(id).map_or(&[][..], |interface| &interface.outputs);
        ports.iter().map(|port| OutputRef {
            node: id.clone(),
            port: Some(port.name.clone()),
        })
    });
    outputs
        .filter(|from| wires::check(document, from, slot).is_ok())
        .collect()
}

fn expose_command(place: &PortRef) -> PortCommand {
    match place {
        PortRef::Input(slot) => PortCommand::ExposeInput(slot.clone()),
        PortRef::Output(from) => PortCommand::ExposeOutput(from.clone()),
    }
}

fn unexpose(place: &PortRef, name: &str) -> PortCommand {
    match place {
        PortRef::Input(slot) => PortCommand::Unfeed(slot.clone()),
        PortRef::Output(_) => PortCommand::RemoveOutput(name.to_owned()),
    }
}

/// Inputs of the wires that end or begin at a port.
fn wires_at(document: &OpenDocument, place: &PortRef) -> Vec<SlotRef> {
    match place {
        PortRef::Input(slot) => connections::wire_into(document, slot)
            .map(|_| slot.clone())
            .into_iter()
            .collect(),
        PortRef::Output(from) => {
            let readers = document.graph().readers(from.node.as_str()).into_iter();
            readers
                .filter(|slot| connections::reads(document, slot, from))
                .collect()
        }
    }
}

/// Opens the menu of nodes, to add one that is connected to a port.
pub(super) fn open_node_menu(popups: &mut Popups, document: &OpenDocument, place: &PortRef, at: Pos2) {
    let aside = match place {
        PortRef::Input(_) => -(sabi_editing::node_size::NODE_WIDTH + 60.0),
        PortRef::Output(_) => 60.0,
    };
    let Some(on_canvas) = place.position(document) else {
        return;
    };
    let purpose = Purpose {
        place: [on_canvas[0] + aside, on_canvas[1] - 20.0],
        pending: Some(place.pending_wire()),
        ..Purpose::default()
    };
    popups.menu = Some(AddMenu::new(at, purpose));
}

/// Distances of the ends of the mark of an exposed port from the port, canvas points.
const MARK: [f32; 2] = [9.0, 24.0];

/// Marks an exposed port with its name outside of the graph.
pub(super) fn mark(
    painter: &Painter,
    theme: &Theme,
    document: &OpenDocument,
    place: &PortRef,
    center: Pos2,
    zoom: f32,
) {
    let Some(name) = ports::exposed_as(document, &place.pending_wire()) else {
        return;
    };
    let (way, align) = match place {
        PortRef::Input(_) => (-1.0, Align2::RIGHT_CENTER),
        PortRef::Output(_) => (1.0, Align2::LEFT_CENTER),
    };
    let [near, far] = MARK.map(|away| center + vec2(way * away * zoom, 0.0));
    painter.line_segment([near, far], Stroke::new(2.0 * zoom, theme.accent));
    painter.circle_filled(far, 3.0 * zoom, theme.accent);
    if zoom > LEGIBLE {
        let font = FontId::proportional((type_size::SMALL * zoom * 2.0).round() / 2.0);
        let at = center + vec2(way * NAME_OF_EXPOSED * zoom, 0.0);
        painter.text(at, align, name, font, theme.quiet);
    }
}

/// Label of the input or output of the shown graph as which a port is exposed.
fn label(document: &OpenDocument, place: &PortRef, name: &str) -> String {
    match place {
        PortRef::Input(_) => ports::input_label(document, name),
        PortRef::Output(_) => ports::output_label(document, name),
    }
}
