//! Ports of the shown graph, and where they are.

use egui::{Pos2, Rect};
use sabi_editing::connections::PendingWire;
use sabi_editing::{OpenDocument, node_size};
use sabi_engine::catalog::Port;
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::{Canvas, node_rect, wires};

/// Half the width of a dot, canvas points.
pub(super) const DOT: f32 = 5.0;
/// Least distance at which a port reacts to the pointer, screen points.
const REACH: f32 = 9.0;

/// Distance at which a port reacts to the pointer, screen points.
pub(super) fn reach_of(zoom: f32) -> f32 {
    (DOT * 1.6 * zoom).max(REACH)
}

/// Port of a node of the shown graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PortRef {
    Input(SlotRef),
    Output(OutputRef),
}

impl PortRef {
    /// Position on the canvas.
    pub(super) fn position(&self, document: &OpenDocument) -> Option<[f32; 2]> {
        match self {
            PortRef::Input(slot) => wires::end_of(document, slot),
            PortRef::Output(from) => wires::start_of(document, from),
        }
    }

    pub(super) fn node(&self) -> &NodeId {
        match self {
            PortRef::Input(slot) => &slot.node,
            PortRef::Output(from) => &from.node,
        }
    }

    /// Wire that is dragged from this port.
    pub(super) fn pending_wire(&self) -> PendingWire {
        match self {
            PortRef::Input(slot) => PendingWire::Into(slot.clone()),
            PortRef::Output(from) => PendingWire::From(from.clone()),
        }
    }
}

/// All ports of a node, in order.
pub(super) fn ports_of(document: &OpenDocument, id: &NodeId) -> Vec<(PortRef, Port)> {
    let Some(interface) = document.interface(id) else {
        return Vec::new();
    };
    let inputs = interface.inputs.iter().map(|port| {
        let slot = SlotRef {
            node: id.clone(),
            name: port.name.clone(),
        };
        (PortRef::Input(slot), port.clone())
    });
    let outputs = interface.outputs.iter().map(|port| {
        let from = OutputRef {
            node: id.clone(),
            port: Some(port.name.clone()),
        };
        (PortRef::Output(from), port.clone())
    });
    inputs.chain(outputs).collect()
}

/// Ports of a node that have a row, in order.
pub(super) fn shown_ports_of(document: &OpenDocument, id: &NodeId) -> Vec<(PortRef, Port)> {
    let (Some(interface), Some(rows)) = (document.interface(id), node_size::rows_of(document, id)) else {
        return Vec::new();
    };
    let inputs = interface.inputs.len();
    let is_shown = |at: usize| match at.checked_sub(inputs) {
        None => rows.shows_input(at),
        Some(output) => rows.shows_output(output),
    };
    let ports = ports_of(document, id).into_iter().enumerate();
    ports.filter(|(at, _)| is_shown(*at)).map(|(_, port)| port).collect()
}

/// Port under a place of the screen.
pub(super) fn at(canvas: &Canvas, document: &OpenDocument, panel: Rect, pointer: Pos2) -> Option<PortRef> {
    let reach = reach_of(canvas.camera.view.zoom);
    let near = |id: &&NodeId| {
        let rect = node_rect(document, id).map(|rect| canvas.camera.view.screen_rect(panel, rect));
        rect.is_some_and(|rect| rect.expand(reach).contains(pointer))
    };
    let ports = document
        .graph()
        .ids()
        .filter(near)
        .flat_map(|id| shown_ports_of(document, id));
    let found = ports.filter_map(|(place, _)| {
        let center = canvas.camera.view.screen(panel, place.position(document)?);
        Some((center.distance(pointer), place)).filter(|(distance, _)| *distance < reach)
    });
    let nearest = found.min_by(|(one, _), (other, _)| one.total_cmp(other));
    nearest.map(|(_, place)| place)
}

/// Distance of the name of an exposed port from the port, canvas points.
pub(super) const NAME_OF_EXPOSED: f32 = 31.0;
/// Width of a letter of such a name, canvas points: more than most have.
const LETTER: f32 = 6.0;

/// Room beside an exposed port that its name takes, canvas points.
pub(super) fn room_of_name(name: &str) -> f32 {
    NAME_OF_EXPOSED + LETTER * name.chars().count() as f32
}
