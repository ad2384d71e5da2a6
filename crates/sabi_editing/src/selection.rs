//! Which nodes are meant.

use sabi_graph::NodeId;

use crate::connections;
use crate::open_document::OpenDocument;

/// Adds a node to the selection, or removes it.
pub fn toggle(document: &mut OpenDocument, id: &NodeId) {
    let mut selection = document.selection().clone();
    if !selection.remove(id) {
        selection.insert(id.clone());
    }
    document.select(selection);
}

/// Selects all that is seen.
pub fn select_all(document: &mut OpenDocument) {
    let all: Vec<NodeId> = document.graph().ids().cloned().collect();
    document.select(all);
}

/// Adds everything that the selected nodes are made from, or everything that is made from them.
pub fn select_connected(document: &mut OpenDocument, is_upstream: bool) {
    let mut found = document.selection().clone();
    let mut next: Vec<NodeId> = found.iter().cloned().collect();
    while let Some(id) = next.pop() {
        for neighbor in connections::neighbors(document, &id, is_upstream) {
            if found.insert(neighbor.clone()) {
                next.push(neighbor);
            }
        }
    }
    document.select(found);
}
