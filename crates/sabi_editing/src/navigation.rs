//! Entering and leaving groups.

use sabi_graph::{Body, GROUP_KIND, NodeId};

use crate::names::separate_file_notice;
use crate::open_document::OpenDocument;

/// Entered instances with their titles, outermost first, as a breadcrumb shows them.
pub fn breadcrumb(document: &OpenDocument) -> Vec<(NodeId, String)> {
    let entered = document.place().entered_graphs(document.contents());
    let around = std::iter::once(&Body::Main).chain(&entered);
    let steps = document.place().instance_path().iter().zip(around);
    let title = |(id, body): (&NodeId, &Body)| {
        let node = document.graph_of(body).and_then(|graph| graph.node(id.as_str()));
        let label = node.and_then(|node| node.label.clone().or_else(|| node.group.clone()));
        (id.clone(), label.unwrap_or_else(|| id.to_string()))
    };
    steps.take(entered.len()).map(title).collect()
}

/// Shows the graph of a group instance; returns whether it can be entered.
pub fn enter(document: &mut OpenDocument, id: &NodeId) -> bool {
    let instance = document.node(id).filter(|node| node.kind == GROUP_KIND);
    let Some(group) = instance.and_then(|node| node.group.clone()) else {
        return false;
    };
    if !document.contents().groups.contains_key(&group) {
        return document.refuse(separate_file_notice(&group));
    }
    // A file may have a group that contains itself. Such a group can be entered only once, since it has no end.
    if document
        .place()
        .entered_graphs(document.contents())
        .contains(&Body::Group(group.clone()))
    {
        return document.refuse(format!("'{group}' contains itself; delete this node"));
    }
    let path = document.place().instance_path().iter().chain([id]).cloned().collect();
    document.show_graph_at(path);
    true
}

/// Leaves groups until `depth` instances are entered, and selects the instance that was left. Returns whether any was left.
pub fn leave_to(document: &mut OpenDocument, depth: usize) -> bool {
    let Some((stays, [left, ..])) = document.place().instance_path().split_at_checked(depth) else {
        return false;
    };
    let (path, left) = (stays.to_vec(), left.clone());
    document.show_graph_at(path);
    document.select([left]);
    true
}

/// Leaves the group that was entered last; returns whether there was one.
pub fn leave(document: &mut OpenDocument) -> bool {
    match document.place().instance_path().len() {
        0 => false,
        depth => leave_to(document, depth - 1),
    }
}

/// Selects a node by its id in the evaluation, and shows the graph that contains it. A node in a group file cannot be
/// shown; its innermost instance that can be shown is selected instead. Returns the selected node.
pub fn go_to(document: &mut OpenDocument, full_id: &str) -> Option<NodeId> {
    leave_to(document, 0);
    let steps: Vec<NodeId> = full_id.split('/').filter_map(|step| step.parse().ok()).collect();
    let (mut selected, instances) = steps.split_last()?;
    for instance in instances {
        if !enter(document, instance) {
            selected = instance;
            break;
        }
    }
    document.select([selected.clone()]);
    Some(selected.clone())
}

/// The entered instance of the shown group, and the graph that it is in; `None` in the main graph.
pub(crate) fn entered_instance(document: &OpenDocument) -> Option<(Body, NodeId)> {
    let mut entered = document.place().entered_graphs(document.contents());
    entered.pop()?;
    let id = document.place().instance_path().get(entered.len())?.clone();
    Some((entered.pop().unwrap_or(Body::Main), id)) // Without an enclosing instance, this is the main graph.
}
