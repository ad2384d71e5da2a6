//! Port that has the keyboard focus.

use sabi_editing::OpenDocument;
use sabi_graph::NodeId;

use super::gesture::Gesture;
use super::port_refs::{self, PortRef};

/// Keyboard focus of ports.
#[derive(Default)]
pub(super) struct PortFocus {
    focused: Option<FocusedPort>,
    /// The same port by its name.
    name: Option<PortRef>,
}

/// Port by its node and its index among the node's ports.
#[derive(Clone, Debug, PartialEq, Eq)]
struct FocusedPort {
    node: NodeId,
    at: usize,
}

impl PortFocus {
    /// Returns whether a port has the focus.
    pub(super) fn is_set(&self) -> bool {
        self.focused.is_some()
    }

    /// Returns whether this port has the focus.
    pub(super) fn is_at(&self, port: &PortRef) -> bool {
        let Some(focused) = &self.focused else { return false };
        *port.node() == focused.node && self.name.as_ref() == Some(port)
    }

    /// Port that has the focus, as `node.port`.
    #[cfg(test)]
    pub(super) fn text(&self) -> Option<String> {
        Some(match self.name.as_ref()? {
            PortRef::Input(slot) => slot.to_string(),
            PortRef::Output(from) => from.to_string(),
        })
    }

    /// Port that has the focus.
    pub(super) fn port(&self, document: &OpenDocument) -> Option<PortRef> {
        let focused = self.focused.as_ref()?;
        port_refs::shown_ports_of(document, &focused.node)
            .into_iter()
            .nth(focused.at)
            .map(|(port, _)| port)
    }

    /// Moves the focus to the next or the previous port of the selected node; during the drag of a wire, only to ports that
    /// accept it.
    pub(super) fn step(&mut self, document: &OpenDocument, gesture: &Gesture, is_forward: bool) {
        let Some(id) = document.selected_one().cloned() else {
            return;
        };
        let ports = port_refs::shown_ports_of(document, &id);
        let fits = |at: usize| gesture.accepts(document, &ports[at].0) != Some(false);
        let focused = self.focused.as_ref().filter(|port| port.node == id);
        let now = focused.map(|port| port.at);
        let order: Vec<usize> = match (is_forward, now) {
            (true, None) => (0..ports.len()).collect(),
            (false, None) => (0..ports.len()).rev().collect(),
            (true, Some(now)) => (now + 1..ports.len()).chain(0..=now).collect(),
            (false, Some(now)) => (0..now).rev().chain((now..ports.len()).rev()).collect(),
        };
        let next = order.into_iter().find(|at| fits(*at));
        self.focused = next.map(|at| FocusedPort { node: id, at });
        self.name = self.port(document);
    }

    /// Moves the focus to a port.
    pub(super) fn set(&mut self, document: &OpenDocument, port: &PortRef) {
        let node = port.node().clone();
        let at = port_refs::shown_ports_of(document, &node)
            .iter()
            .position(|(known, _)| known == port);
        self.focused = at.map(|at| FocusedPort { node, at });
        self.name = self.port(document);
    }

    /// Takes the focus from the port that has it.
    pub(super) fn clear(&mut self) {
        *self = PortFocus::default();
    }

    /// Takes the focus from a port whose node is not selected any more.
    pub(super) fn follow_selection(&mut self, document: &OpenDocument) {
        let is_selected = |port: &FocusedPort| document.selected_one() == Some(&port.node);
        if self.focused.as_ref().is_some_and(|port| !is_selected(port)) {
            self.clear();
        }
    }
}
