//! The canvas by keys alone: moving between nodes and ports, and connecting them.

use sabi_editing::{OpenDocument, connections};
use sabi_graph::{NodeId, OutputRef};

use super::gesture::Gesture;
use super::port_refs::{self, PortRef};
use super::{Canvas, node_rect};
use crate::action::{Action, ArrowKey};

/// Port that has the keyboard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FocusedPort {
    node: NodeId,
    at: usize,
}

impl Canvas {
    pub(super) fn is_focused(&self, place: &PortRef) -> bool {
        let Some(port) = &self.port else { return false };
        *place.node() == port.node && self.focused.as_ref() == Some(place)
    }

    /// Port that has the keyboard, as `node.port`.
    #[cfg(test)]
    pub(crate) fn focused_port(&self) -> Option<String> {
        Some(match self.focused.as_ref()? {
            PortRef::Input(slot) => slot.to_string(),
            PortRef::Output(from) => from.to_string(),
        })
    }

    /// Port that has the keyboard.
    pub(super) fn port_place(&self, document: &OpenDocument) -> Option<PortRef> {
        let port = self.port.as_ref()?;
        port_refs::places(document, &port.node)
            .into_iter()
            .nth(port.at)
            .map(|(place, _)| place)
    }

    /// Moves the keyboard to the next or the previous port of the selected node; during the drag of a wire, only to
    /// ports that take it.
    pub(super) fn step_port(&mut self, document: &OpenDocument, is_on: bool) {
        let Some(id) = document.selected_one().cloned() else {
            return;
        };
        let places = port_refs::places(document, &id);
        let fits = |at: usize| self.gesture.takes(document, &places[at].0) != Some(false);
        let now = self.port.as_ref().filter(|port| port.node == id).map(|port| port.at);
        let order: Vec<usize> = match (is_on, now) {
            (true, None) => (0..places.len()).collect(),
            (false, None) => (0..places.len()).rev().collect(),
            (true, Some(now)) => (now + 1..places.len()).chain(0..=now).collect(),
            (false, Some(now)) => (0..now).rev().chain((now..places.len()).rev()).collect(),
        };
        let next = order.into_iter().find(|at| fits(*at));
        self.port = next.map(|at| FocusedPort { node: id, at });
        self.focused = self.port_place(document);
    }

    /// Begins a wire at the port that has the keyboard, or drops the dragged one there.
    pub(super) fn wire_by_key(&mut self, document: &OpenDocument) -> Vec<Action> {
        let mut actions = Vec::new();
        let Some(place) = self.port_place(document) else {
            return actions;
        };
        match std::mem::take(&mut self.gesture) {
            Gesture::Wire { loose, off, .. } => {
                let at = self.panel.map_or(egui::Pos2::ZERO, |panel| panel.center());
                self.tie(document, loose, place, off, at, &mut actions);
                self.leave_port();
            }
            _ => {
                self.gesture = Gesture::Wire {
                    loose: place.loose(),
                    off: None,
                    by_key: true,
                };
                self.leave_port();
            }
        }
        actions
    }

    /// Follows an arrow key. From a port that has the keyboard, up and down go through the ports of its node, left and right
    /// along its wire or to the other side of its node. Otherwise, and during the drag of a wire, it goes from node to node.
    pub(crate) fn arrow(&mut self, document: &OpenDocument, way: ArrowKey) -> Vec<Action> {
        let focused = self.port_place(document);
        let is_aside = matches!(way, ArrowKey::Left | ArrowKey::Right);
        let is_in_hand = matches!(self.gesture, Gesture::Wire { .. });
        match focused {
            Some(_) if !is_aside => {
                self.step_port(document, way == ArrowKey::Down);
                return Vec::new();
            }
            Some(place) if !is_in_hand => {
                if let Some(next) = aside(document, &place, way) {
                    return self.go_to_port(document, &next);
                }
            }
            _ => {}
        }
        self.leave_port();
        let Some(id) = self.neighbor(document, way) else {
            return Vec::new();
        };
        let shown = Action::Show {
            node: id.clone(),
            port: None,
        };
        vec![Action::Select(vec![id]), shown]
    }

    /// Gives a port the keyboard, and selects its node.
    fn go_to_port(&mut self, document: &OpenDocument, place: &PortRef) -> Vec<Action> {
        let node = place.node().clone();
        let at = port_refs::places(document, &node)
            .iter()
            .position(|(known, _)| known == place);
        self.port = at.map(|at| FocusedPort { node: node.clone(), at });
        self.focused = self.port_place(document);
        if document.selected_one() == Some(&node) {
            return Vec::new();
        }
        let shown = Action::Show {
            node: node.clone(),
            port: None,
        };
        vec![Action::Select(vec![node]), shown]
    }

    /// Takes the keyboard from the port that has it.
    pub(super) fn leave_port(&mut self) {
        self.port = None;
        self.focused = None;
    }

    /// Takes the keyboard from a port whose node is not selected any more.
    pub(super) fn follow_selection(&mut self, document: &OpenDocument) {
        if self
            .port
            .as_ref()
            .is_some_and(|port| document.selected_one() != Some(&port.node))
        {
            self.leave_port();
        }
    }

    /// Nearest node in the direction of an arrow key.
    fn neighbor(&self, document: &OpenDocument, way: ArrowKey) -> Option<NodeId> {
        let from = document.selected_one().and_then(|id| node_rect(document, id));
        let Some(from) = from else {
            return document.graph().ids().next().cloned();
        };
        let found = document
            .graph()
            .ids()
            .filter(|id| !document.is_selected(id))
            .filter_map(|id| {
                let to = node_rect(document, id)?.center() - from.center();
                let (along, aside) = match way {
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
}

/// Port to the left or right of another one: the other end of its wire, or the first port on the other side of its node. None
/// where it has no wire on that side.
fn aside(document: &OpenDocument, place: &PortRef, way: ArrowKey) -> Option<PortRef> {
    let inside = |is_input: bool| {
        let places = port_refs::places(document, place.node()).into_iter();
        let mut places = places.map(|(place, _)| place);
        places.find(|place| matches!(place, PortRef::Input(_)) == is_input)
    };
    match (place, way) {
        (PortRef::Input(slot), ArrowKey::Left) => {
            let from = connections::wire_into(document, slot)?;
            let port = document.face(&from.node)?.output(from.port.as_deref())?;
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
        (PortRef::Input(_), _) => inside(false),
        (PortRef::Output(_), _) => inside(true),
    }
}
