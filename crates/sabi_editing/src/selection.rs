//! Which nodes are meant.

use std::collections::BTreeSet;

use sabi_graph::NodeId;

use super::OpenDocument;

impl OpenDocument {
    /// Selected nodes of the shown graph.
    pub fn selection(&self) -> &BTreeSet<NodeId> {
        &self.selection
    }

    /// Whether a node is selected.
    pub fn is_selected(&self, id: &NodeId) -> bool {
        self.selection.contains(id)
    }

    /// The one node that is selected; none where there are several.
    pub fn selected_one(&self) -> Option<&NodeId> {
        match self.selection.len() {
            1 => self.selection.first(),
            _ => None,
        }
    }

    /// Selects these and nothing else.
    pub fn select(&mut self, ids: impl IntoIterator<Item = NodeId>) {
        self.selection = ids.into_iter().collect();
        self.forget_what_is_gone();
    }

    /// Selects only nodes that are there.
    pub(super) fn forget_what_is_gone(&mut self) {
        let selection = std::mem::take(&mut self.selection);
        let there = selection.into_iter().filter(|id| self.node(id).is_some());
        self.selection = there.collect();
    }

    /// Selects a node besides the others, or no more.
    pub fn toggle(&mut self, id: &NodeId) {
        if !self.selection.remove(id) && self.node(id).is_some() {
            self.selection.insert(id.clone());
        }
    }

    /// Selects all that is seen.
    pub fn select_all(&mut self) {
        let all: Vec<NodeId> = self.graph().ids().cloned().collect();
        self.select(all);
    }

    /// Adds everything that the selected nodes are made from, or everything that is made from them.
    pub fn select_stream(&mut self, is_upstream: bool) {
        let mut found = self.selection.clone();
        let mut next: Vec<NodeId> = found.iter().cloned().collect();
        while let Some(id) = next.pop() {
            for neighbor in self.neighbors(&id, is_upstream) {
                if found.insert(neighbor.clone()) {
                    next.push(neighbor);
                }
            }
        }
        self.selection = found;
    }

    /// The nodes that one reads, or those that read it.
    pub fn neighbors(&self, id: &NodeId, is_upstream: bool) -> Vec<NodeId> {
        let graph = self.graph();
        if !is_upstream {
            return graph.readers(id.as_str()).into_iter().map(|slot| slot.node).collect();
        }
        let inputs = graph.node(id.as_str()).map(|node| node.inputs.values());
        inputs.into_iter().flatten().map(|from| from.node.clone()).collect()
    }
}
