//! Nodes by their full ids, as the evaluation uses them: the ids of the instances that contain a node, then its own id.

use sabi_graph::{Body, NodeId};

use crate::open_document::OpenDocument;

/// Returns whether a node with this full id exists. Nodes inside groups of other files exist as long as their instance
/// does.
pub fn exists(document: &OpenDocument, full_id: &str) -> bool {
    let mut body = Body::Main;
    let mut steps = full_id.split('/').peekable();
    while let Some(step) = steps.next() {
        let Some(graph) = document.graph_of(&body) else {
            return true;
        };
        let Some(node) = graph.node(step) else {
            return false;
        };
        body = match &node.group {
            Some(name) => Body::Group(name.clone()),
            None => return steps.peek().is_none(),
        };
    }
    true
}

/// Returns the title of a node by its full id, after the titles of the instances that contain it.
pub fn title(document: &OpenDocument, full_id: &str) -> String {
    let mut body = Some(Body::Main);
    let mut titles = Vec::new();
    for step in full_id.split('/') {
        let node = body.as_ref().and_then(|body| document.graph_of(body)?.node(step));
        let face = body.as_ref().and_then(|body| document.faces().of(body, step));
        let own = node.and_then(|node| node.label.clone());
        let title = own.or_else(|| face.map(|face| face.label.clone()));
        titles.push(title.unwrap_or_else(|| step.to_owned()));
        body = node.and_then(|node| node.group.clone()).map(Body::Group);
    }
    titles.join(" › ")
}

/// Node with this full id, if it is in the shown graph.
pub fn in_shown_graph(document: &OpenDocument, full_id: &str) -> Option<NodeId> {
    let own = full_id.rsplit('/').next()?.parse::<NodeId>().ok()?;
    (document.full_id(&own) == full_id).then_some(own)
}
