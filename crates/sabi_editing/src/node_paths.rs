//! Nodes by their full ids, as used in the evaluation: the ids of the enclosing instances, followed by the id of the node.

use std::sync::Arc;

use sabi_engine::catalog::Interface;
use sabi_graph::{Body, NodeId};

use crate::open_document::OpenDocument;

/// Returns the id of a node of the shown graph in the evaluation: the ids of the entered instances and its own id,
/// separated by slashes.
pub fn full_id(document: &OpenDocument, id: &NodeId) -> String {
    let path = document.place().instance_path().iter().chain([id]).map(NodeId::as_str);
    path.collect::<Vec<_>>().join("/")
}

/// Returns whether a node with this full id exists. A node inside a group file counts as existing if its instance exists.
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

/// Returns the title of a node, given its full id, after the titles of the enclosing instances.
pub fn title(document: &OpenDocument, full_id: &str) -> String {
    let mut body = Some(Body::Main);
    let mut titles = Vec::new();
    for step in full_id.split('/') {
        let node = body.as_ref().and_then(|body| document.graph_of(body)?.node(step));
        let interface = body.as_ref().and_then(|body| document.interfaces().of(body, step));
        let own = node.and_then(|node| node.label.clone());
        let title = own.or_else(|| interface.map(|interface| interface.label.clone()));
        titles.push(title.unwrap_or_else(|| step.to_owned()));
        body = node.and_then(|node| node.group.clone()).map(Body::Group);
    }
    titles.join(" › ")
}

/// Node with this full id, if it is in the shown graph.
pub fn in_shown_graph(document: &OpenDocument, full_id: &str) -> Option<NodeId> {
    let own = full_id.rsplit('/').next()?.parse::<NodeId>().ok()?;
    (self::full_id(document, &own) == full_id).then_some(own)
}

/// Words after which an error contains the full id of a node in quotation marks.
const BEFORE_IDS: [&str; 5] = ["node ", "nodes ", "instance ", "asks ", "but "];
/// Words after which an error contains the name of a parameter or an input of a node in quotation marks.
const BEFORE_MEMBERS: [&str; 2] = ["parameter ", "input "];
/// Words between a parameter or an input and the id of its node.
const OF_NODE: &str = " of node '";
/// Words before a list of ids of nodes that form a circle, and the text between these ids.
const BEFORE_CIRCLE: &str = "in a circle: ";
const IN_CIRCLE: &str = " → ";

/// Replaces the ids of nodes in an error or a warning by their titles, and the names of their parameters and ports by their labels.
/// Errors contain full ids, as in graph files, with the kinds in parentheses.
pub fn with_titles(document: &OpenDocument, sentence: &str) -> String {
    let mut told = String::with_capacity(sentence.len());
    let mut rest = sentence;
    let mut is_list = false;
    let mut last_node = None;
    while let Some(at) = rest.find(['\'', '"']) {
        let (before, quoted) = rest.split_at(at);
        let (mark, quoted) = quoted.split_at(1);
        told.push_str(&with_titles_in_circle(document, before));
        let Some((id, after)) = quoted.split_once(mark) else {
            told.push_str(mark);
            rest = quoted;
            continue;
        };
        let follows = is_list && [", ", " and "].contains(&before);
        is_list = (follows || BEFORE_IDS.iter().any(|word| told.ends_with(word))) && exists(document, id);
        let name = if is_list {
            last_node = Some(id);
            title(document, id)
        } else {
            let known = label_in(document, &told, after, last_node, id);
            known.unwrap_or_else(|| id.to_owned())
        };
        told.push_str(&format!("{mark}{name}{mark}"));
        rest = if is_list { without_kind(after) } else { after };
    }
    told.push_str(&with_titles_in_circle(document, rest));
    told
}

/// Label of a parameter or an input that a sentence names in quotation marks. `before` and `after` are the texts around the
/// quotation; the node is the one that follows, or `last`. `None` for anything else, and for names that the node does not have.
fn label_in(document: &OpenDocument, before: &str, after: &str, last: Option<&str>, name: &str) -> Option<String> {
    if !BEFORE_MEMBERS.iter().any(|word| before.ends_with(word)) {
        return None;
    }
    let of_node = after.strip_prefix(OF_NODE).and_then(|rest| rest.split_once('\''));
    let node = of_node.map(|(node, _)| node).or(last)?;
    let interface = interface(document, node)?;
    let knob = interface.knob(name).map(|knob| &knob.label);
    knob.or_else(|| interface.input(name).map(|port| &port.label)).cloned()
}

/// Ports and knobs of a node by its full id. `None` if they are not known, as in groups of other files.
fn interface(document: &OpenDocument, full_id: &str) -> Option<Arc<Interface>> {
    let (instances, own) = match full_id.rsplit_once('/') {
        Some((instances, own)) => (Some(instances), own),
        None => (None, full_id),
    };
    let mut body = Body::Main;
    for step in instances.into_iter().flat_map(|instances| instances.split('/')) {
        body = Body::Group(document.graph_of(&body)?.node(step)?.group.clone()?);
    }
    document.interfaces().of(&body, own).cloned()
}

/// Replaces the ids of nodes of the shown graph that form a circle by their titles.
fn with_titles_in_circle(document: &OpenDocument, text: &str) -> String {
    let Some((before, circle)) = text.split_once(BEFORE_CIRCLE) else {
        return text.to_owned();
    };
    let (ids, after) = circle.split_at(circle.find(';').unwrap_or(circle.len()));
    let titles = ids.split(IN_CIRCLE).map(|id| match id.parse::<NodeId>() {
        Ok(id) if document.node(&id).is_some() => document.title(&id),
        _ => id.to_owned(),
    });
    let titles: Vec<String> = titles.collect();
    format!("{before}{BEFORE_CIRCLE}{}{after}", titles.join(IN_CIRCLE))
}

/// Removes the kind of a node, in parentheses, from the start of a text.
fn without_kind(text: &str) -> &str {
    let inner = text.strip_prefix(" (").and_then(|text| text.split_once(')'));
    let is_kind = |kind: &str| {
        let is_letter = |letter: char| letter.is_ascii_alphanumeric() || "_/@-".contains(letter);
        kind.contains('/') && kind.chars().all(is_letter)
    };
    inner.filter(|(kind, _)| is_kind(kind)).map_or(text, |(_, rest)| rest)
}
