//! The canvas by keys alone: from node to node, from port to port, and wires between them.

use sabi_graph::NodeId;

use super::gesture::Gesture;
use super::ports::{self, Place};
use super::{Canvas, node_rect};
use crate::action::Action;
use crate::desk::Desk;

/// The port that keys are about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PortAt {
    node: NodeId,
    at: usize,
}

/// Where an arrow key leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Left,
    Right,
    Up,
    Down,
}

impl Canvas {
    pub(super) fn is_focused(&self, place: &Place) -> bool {
        let Some(port) = &self.port else { return false };
        let node = match place {
            Place::Input(slot) => &slot.node,
            Place::Output(from) => &from.node,
        };
        *node == port.node && self.focused.as_ref() == Some(place)
    }

    /// The port that keys are about.
    pub(super) fn port_place(&self, desk: &Desk) -> Option<Place> {
        let port = self.port.as_ref()?;
        ports::places(desk, &port.node)
            .into_iter()
            .nth(port.at)
            .map(|(place, _)| place)
    }

    /// Goes to the next port of the selected node, or to the one before; with a wire in hand, only to those that take it.
    pub(super) fn step_port(&mut self, desk: &Desk, is_on: bool) {
        let Some(id) = desk.selected_one().cloned() else {
            return;
        };
        let places = ports::places(desk, &id);
        let fits = |at: usize| self.gesture.takes(desk, &places[at].0) != Some(false);
        let now = self.port.as_ref().filter(|port| port.node == id).map(|port| port.at);
        let order: Vec<usize> = match (is_on, now) {
            (true, None) => (0..places.len()).collect(),
            (false, None) => (0..places.len()).rev().collect(),
            (true, Some(now)) => (now + 1..places.len()).chain(0..=now).collect(),
            (false, Some(now)) => (0..now).rev().chain((now..places.len()).rev()).collect(),
        };
        let next = order.into_iter().find(|at| fits(*at));
        self.port = next.map(|at| PortAt { node: id, at });
        self.focused = self.port_place(desk);
    }

    /// Takes a wire at the port that keys are about, or drops the one in hand there.
    pub(super) fn wire_by_key(&mut self, desk: &Desk) -> Vec<Action> {
        let mut actions = Vec::new();
        let Some(place) = self.port_place(desk) else {
            return actions;
        };
        match std::mem::take(&mut self.gesture) {
            Gesture::Wire { loose, off, .. } => {
                let at = self.panel.map_or(egui::Pos2::ZERO, |panel| panel.center());
                self.tie(desk, loose, place, off, at, &mut actions);
                self.port = None;
                self.focused = None;
            }
            _ => {
                self.gesture = Gesture::Wire {
                    loose: place.loose(),
                    off: None,
                    by_key: true,
                };
                self.port = None;
                self.focused = None;
            }
        }
        actions
    }

    /// The node to which an arrow key leads: of those that lie that way, the nearest.
    pub(crate) fn neighbor(&self, desk: &Desk, way: Way) -> Option<NodeId> {
        let from = desk.selected_one().and_then(|id| node_rect(desk, id));
        let Some(from) = from else {
            return desk.graph().ids().next().cloned();
        };
        let found = desk.graph().ids().filter(|id| !desk.is_selected(id)).filter_map(|id| {
            let to = node_rect(desk, id)?.center() - from.center();
            let (along, aside) = match way {
                Way::Left => (-to.x, to.y),
                Way::Right => (to.x, to.y),
                Way::Up => (-to.y, to.x),
                Way::Down => (to.y, to.x),
            };
            // What lies aside counts as farther than what lies ahead.
            (along > 1.0).then(|| (along + 2.0 * aside.abs(), id))
        });
        found
            .min_by(|(one, _), (other, _)| one.total_cmp(other))
            .map(|(_, id)| id.clone())
    }
}
