//! Keyboard control of the canvas: moving between nodes and ports, and connecting them.

use sabi_editing::{OpenDocument, connections};
use sabi_graph::{NodeId, OutputRef};

use super::gesture::{Gesture, connect};
use super::port_refs::{self, PortRef};
use super::{Canvas, node_rect};
use crate::action::{Action, ArrowKey};

/// Begins a wire at the port that has the focus, or drops the dragged wire there.
pub(super) fn wire(canvas: &mut Canvas, document: &OpenDocument) -> Vec<Action> {
    let mut actions = Vec::new();
    let Some(port) = canvas.focus.port(document) else {
        return actions;
    };
    match std::mem::take(&mut canvas.gesture) {
        Gesture::Wire { pending, off, .. } => {
            let at = canvas.camera.panel.map_or(egui::Pos2::ZERO, |panel| panel.center());
            connect(&mut canvas.popups, document, pending, off, &port, at, &mut actions);
        }
        _ => {
            canvas.gesture = Gesture::Wire {
                pending: port.pending_wire(),
                off: None,
                by_key: true,
            };
        }
    }
    canvas.focus.clear();
    actions
}

/// Follows an arrow key. From a port that has the focus, up and down go through the ports of its node, left and right along
/// its wire or to the other side of its node. Otherwise, and during the drag of a wire, it goes from node to node.
pub(super) fn arrow(canvas: &mut Canvas, document: &OpenDocument, key: ArrowKey) -> Vec<Action> {
    let focused = canvas.focus.port(document);
    let is_sideways = matches!(key, ArrowKey::Left | ArrowKey::Right);
    let is_wiring = matches!(canvas.gesture, Gesture::Wire { .. });
    match focused {
        Some(_) if !is_sideways => {
            canvas.focus.step(document, &canvas.gesture, key == ArrowKey::Down);
            return Vec::new();
        }
        Some(port) if !is_wiring => {
            if let Some(next) = port_beside(document, &port, key) {
                canvas.focus.set(document, &next);
                return match document.selected_one() == Some(next.node()) {
                    true => Vec::new(),
                    false => select(next.node()),
                };
            }
        }
        _ => {}
    }
    canvas.focus.clear();
    neighbor(document, key).map_or_else(Vec::new, |id| select(&id))
}

/// Selects a node and shows its result, as a click on it does.
fn select(id: &NodeId) -> Vec<Action> {
    let shown = Action::Show {
        node: id.clone(),
        port: None,
    };
    vec![Action::Select(vec![id.clone()]), shown]
}

/// Nearest node in the direction of an arrow key.
fn neighbor(document: &OpenDocument, key: ArrowKey) -> Option<NodeId> {
    let from = document.selected_one().and_then(|id| node_rect(document, id));
    let Some(from) = from else {
        return document.graph().ids().next().cloned();
    };
    let found = document
        .graph()
        .ids()
        .filter(|id| !document.selection().contains(*id))
        .filter_map(|id| {
            let to = node_rect(document, id)?.center() - from.center();
            let (along, aside) = match key {
                ArrowKey::Left => (-to.x, to.y),
                ArrowKey::Right => (to.x, to.y),
                ArrowKey::Up => (-to.y, to.x),
                ArrowKey::Down => (to.y, to.x),
            };
            // A distance across the direction counts twice.
            (along > 1.0).then(|| (along + 2.0 * aside.abs(), id))
        });
    found
        .min_by(|(one, _), (other, _)| one.total_cmp(other))
        .map(|(_, id)| id.clone())
}

/// Port to the left or right of another one: the other end of its wire, or the first port on the other side of its
/// node. `None` if it has no wire on that side.
fn port_beside(document: &OpenDocument, port: &PortRef, key: ArrowKey) -> Option<PortRef> {
    let first = |is_input: bool| {
        let ports = port_refs::ports_of(document, port.node()).into_iter();
        let mut ports = ports.map(|(port, _)| port);
        ports.find(|port| matches!(port, PortRef::Input(_)) == is_input)
    };
    match (port, key) {
        (PortRef::Input(slot), ArrowKey::Left) => {
            let from = connections::wire_into(document, slot)?;
            let port = document.interface(&from.node)?.output(from.port.as_deref())?;
            Some(PortRef::Output(OutputRef {
                node: from.node.clone(),
                port: Some(port.name.clone()),
            }))
        }
        (PortRef::Output(from), ArrowKey::Right) => {
            let mut readers = document.graph().readers(from.node.as_str()).into_iter();
            readers
                .find(|slot| connections::reads(document, slot, from))
                .map(PortRef::Input)
        }
        (PortRef::Input(_), _) => first(false),
        (PortRef::Output(_), _) => first(true),
    }
}
