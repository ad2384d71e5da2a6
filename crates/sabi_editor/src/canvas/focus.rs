//! The canvas by keys alone: from node to node, from port to port, and wires between them.

use sabi_editing::OpenDocument;
use sabi_graph::{NodeId, OutputRef};

use super::gesture::Gesture;
use super::places::{self, Place};
use super::{Canvas, node_rect};
use crate::action::{Action, ArrowKey};

/// The port that keys are about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PortAt {
    node: NodeId,
    at: usize,
}

impl Canvas {
    pub(super) fn is_focused(&self, place: &Place) -> bool {
        let Some(port) = &self.port else { return false };
        *place.node() == port.node && self.focused.as_ref() == Some(place)
    }

    /// The port that keys are about, as `node.port`.
    #[cfg(test)]
    pub(crate) fn focused_port(&self) -> Option<String> {
        Some(match self.focused.as_ref()? {
            Place::Input(slot) => slot.to_string(),
            Place::Output(from) => from.to_string(),
        })
    }

    /// The port that keys are about.
    pub(super) fn port_place(&self, document: &OpenDocument) -> Option<Place> {
        let port = self.port.as_ref()?;
        places::places(document, &port.node)
            .into_iter()
            .nth(port.at)
            .map(|(place, _)| place)
    }

    /// Goes to the next port of the selected node, or to the one before; with a wire in hand, only to those that take it.
    pub(super) fn step_port(&mut self, document: &OpenDocument, is_on: bool) {
        let Some(id) = document.selected_one().cloned() else {
            return;
        };
        let places = places::places(document, &id);
        let fits = |at: usize| self.gesture.takes(document, &places[at].0) != Some(false);
        let now = self.port.as_ref().filter(|port| port.node == id).map(|port| port.at);
        let order: Vec<usize> = match (is_on, now) {
            (true, None) => (0..places.len()).collect(),
            (false, None) => (0..places.len()).rev().collect(),
            (true, Some(now)) => (now + 1..places.len()).chain(0..=now).collect(),
            (false, Some(now)) => (0..now).rev().chain((now..places.len()).rev()).collect(),
        };
        let next = order.into_iter().find(|at| fits(*at));
        self.port = next.map(|at| PortAt { node: id, at });
        self.focused = self.port_place(document);
    }

    /// Takes a wire at the port that keys are about, or drops the one in hand there.
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

    /// Where an arrow key leads: up and down through the ports of a node once one of them has the focus, left and right along
    /// its wire or to the ports on the other side; and from node to node otherwise, or with a wire in hand.
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

    /// Gives a port the focus, and selects its node.
    fn go_to_port(&mut self, document: &OpenDocument, place: &Place) -> Vec<Action> {
        let node = place.node().clone();
        let at = places::places(document, &node)
            .iter()
            .position(|(known, _)| known == place);
        self.port = at.map(|at| PortAt { node: node.clone(), at });
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

    /// Keys are about no port any more.
    pub(super) fn leave_port(&mut self) {
        self.port = None;
        self.focused = None;
    }

    /// A port of a node that is not the selected one has no focus.
    pub(super) fn follow_selection(&mut self, document: &OpenDocument) {
        if self
            .port
            .as_ref()
            .is_some_and(|port| document.selected_one() != Some(&port.node))
        {
            self.leave_port();
        }
    }

    /// The node to which an arrow key leads: of those that lie that way, the nearest.
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
                // What lies aside counts as farther than what lies ahead.
                (along > 1.0).then(|| (along + 2.0 * aside.abs(), id))
            });
        found
            .min_by(|(one, _), (other, _)| one.total_cmp(other))
            .map(|(_, id)| id.clone())
    }
}

/// The port to the left or right of one: the other end of its wire, or the first port on the other side of its node. None
/// where it has no wire on that side.
fn aside(document: &OpenDocument, place: &Place, way: ArrowKey) -> Option<Place> {
    let inside = |is_input: bool| {
        let places = places::places(document, place.node()).into_iter();
        let mut places = places.map(|(place, _)| place);
        places.find(|place| matches!(place, Place::Input(_)) == is_input)
    };
    match (place, way) {
        (Place::Input(slot), ArrowKey::Left) => {
            let from = document.wire_into(slot)?;
            let port = document.face(&from.node)?.output(from.port.as_deref())?;
            Some(Place::Output(OutputRef {
                node: from.node.clone(),
                port: Some(port.name.clone()),
            }))
        }
        (Place::Output(from), ArrowKey::Right) => {
            let mut readers = document.graph().readers(from.node.as_str()).into_iter();
            readers.find(|slot| document.reads(slot, from)).map(Place::Input)
        }
        (Place::Input(_), _) => inside(false),
        (Place::Output(_), _) => inside(true),
    }
}
