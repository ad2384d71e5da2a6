//! Selection of nodes: toggling, and selecting all, muted or connected nodes.

use sabi_graph::NodeId;

use crate::open_document::OpenDocument;

/// Adds a node to the selection, or removes it.
pub fn toggle(document: &mut OpenDocument, id: &NodeId) {
    let mut selection = document.selection().clone();
    if !selection.remove(id) {
        selection.insert(id.clone());
    }
    document.select(selection);
}

/// Selects all nodes of the shown graph.
pub fn select_all(document: &mut OpenDocument) {
    let all: Vec<NodeId> = document.graph().ids().cloned().collect();
    document.select(all);
}

/// Selects all muted nodes of the shown graph and no others. If there are none, the selection stays and a notice is added.
pub fn select_muted(document: &mut OpenDocument) {
    let nodes = document.graph().nodes();
    let muted: Vec<NodeId> = nodes.filter(|(_, node)| node.muted).map(|(id, _)| id.clone()).collect();
    if muted.is_empty() {
        return document.notify("no node of this graph is muted");
    }
    document.select(muted);
}

/// Adds all nodes that the selected ones depend on (`is_upstream`), or all that depend on them.
pub fn select_connected(document: &mut OpenDocument, is_upstream: bool) {
    let graph = document.graph();
    let found = match is_upstream {
        true => graph.upstream(document.selection()),
        false => graph.downstream(document.selection()),
    };
    document.select(found);
}
