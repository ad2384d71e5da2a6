//! Nodes: adding, removing, copying, changing.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sabi_engine::catalog::{Interface, Interfaces};
use sabi_graph::{Body, Edit, GROUP_KIND, Node, NodeDisplay, NodeId, NodeRows, Value};

use crate::connections::PendingWire;
use crate::instances::{bodies, instances};
use crate::names::{FILE_ENDING, is_file, knob_label};
use crate::node_size::GRID;
use crate::open_document::OpenDocument;
use crate::variants::NO_VARIANT;
use crate::{connections, exposed_values, new_nodes, node_size, reconnection};

/// Space between a node and one that was moved aside for it, canvas points.
const GAP: f32 = 2.0 * GRID;

/// Adds a node of a kind, connects it to a pending wire if it fits, and selects it.
pub fn add(document: &mut OpenDocument, kind: &str, pos: [f32; 2], pending: Option<&PendingWire>) -> Option<NodeId> {
    let Some(entry) = document.catalog().entry(kind).cloned() else {
        document.notify(format!("there is no node kind '{kind}'"));
        return None;
    };
    let (id, node) = new_nodes::of_kind(document, kind, pos);
    place_new(document, id, node, &entry, pending)
}

/// Adds an instance of a group: a group of the document, or a graph file by its path relative to the document.
pub fn add_instance(
    document: &mut OpenDocument,
    group: &str,
    pos: [f32; 2],
    pending: Option<&PendingWire>,
) -> Option<NodeId> {
    let (id, node, entry) = new_instance(document, group, pos)?;
    place_new(document, id, node, &entry, pending)
}

/// Creates an instance of a group with a new id, without adding it to the graph. If this is refused, a notice is added.
pub(crate) fn new_instance(
    document: &mut OpenDocument,
    group: &str,
    pos: [f32; 2],
) -> Option<(NodeId, Node, Arc<Interface>)> {
    if let Some(open) = containing_shown(document, group) {
        document.notify(format!(
            "'{group}' holds '{open}', which is open here; a group cannot be inside itself"
        ));
        return None;
    }
    let Some(entry) = group_entry(document, group) else {
        document.notify(match is_file(group) {
            true => format!("'{group}' cannot be read; choose a graph file"),
            false => format!("there is no group '{group}'"),
        });
        return None;
    };
    let (_, mut node) = new_nodes::of_kind(document, GROUP_KIND, pos);
    node.group = Some(group.to_owned());
    let name = group.rsplit('/').next().unwrap_or(group);
    let stem = name
        .strip_suffix(FILE_ENDING)
        .unwrap_or(name)
        .to_lowercase()
        .replace([' ', '-'], "_");
    let id = document.new_id(&stem, &BTreeSet::new());
    Some((id, node, entry))
}

/// Returns the ports and knobs of an instance of a group, even if no instance exists.
fn group_entry(document: &mut OpenDocument, group: &str) -> Option<Arc<Interface>> {
    if let Some(known) = document.interfaces().of_group(group) {
        return Some(known.clone());
    }
    if !is_file(group) {
        return None;
    }
    let base = document.session.graph().base();
    let contents = document.read_group_file(&base, group)?;
    let base = base.base_of(group);
    let catalog = document.node_kinds().catalog.clone();
    let mut read = |name: &str| document.read_group_file(&base, name);
    Interfaces::new(&catalog, &contents, &mut read).of_whole().cloned()
}

/// Returns the name of the shown group if `group` contains it. An instance of `group` inside it would contain itself.
pub(crate) fn containing_shown(document: &OpenDocument, group: &str) -> Option<String> {
    let Body::Group(open) = document.shown() else {
        return None;
    };
    let mut seen = BTreeSet::from([group]);
    let mut next = vec![group];
    while let Some(name) = next.pop() {
        if name == open {
            return Some(open.clone());
        }
        let inner = document
            .contents()
            .groups
            .get(name)
            .into_iter()
            .flat_map(|group| group.graph.nodes());
        let contained = inner.filter_map(|(_, node)| node.group.as_deref().filter(|_| node.kind == GROUP_KIND));
        next.extend(contained.filter(|contained| seen.insert(contained)));
    }
    None
}

fn place_new(
    document: &mut OpenDocument,
    id: NodeId,
    mut node: Node,
    entry: &Interface,
    pending: Option<&PendingWire>,
) -> Option<NodeId> {
    node.pos = free_position(document, node.pos);
    let mut edits = vec![new_nodes::addition(document, &id, node, BTreeMap::new())];
    let connected = pending.and_then(|pending| connections::connecting_pending(document, pending, &id, entry));
    let reader = match pending {
        Some(PendingWire::Into(to)) => document.interface(&to.node).map(|interface| &**interface),
        _ => Some(entry),
    };
    let started = connected.as_ref().zip(reader);
    let started = started.and_then(|(edit, interface)| connections::starting(document, edit, interface));
    edits.extend(connected.into_iter().chain(started));
    let is_made = document.edit(&format!("Add {}", entry.label), edits);
    is_made.then(|| {
        document.select([id.clone()]);
        id
    })
}

/// Returns a place for a new node with these ports where it covers no other node: the given place, or the nearest free one beside, above
/// or below the nodes there. If the distances are similar, right or below is preferred, since graphs are read in that direction.
pub fn uncovered(document: &OpenDocument, interface: &Interface, place: [f32; 2]) -> [f32; 2] {
    let size = node_size::size_of(interface);
    let boxes: Vec<[[f32; 2]; 2]> = document
        .graph()
        .nodes()
        .map(|(id, node)| [node.pos, node_size::of(document, id)])
        .collect();
    let is_free = |place: [f32; 2]| {
        boxes.iter().all(|[pos, of]| {
            let is_apart = |axis: usize| place[axis] >= pos[axis] + of[axis] || pos[axis] >= place[axis] + size[axis];
            is_apart(0) || is_apart(1)
        })
    };
    if is_free(place) {
        return place;
    }
    let [x, y] = place;
    let beside = boxes.iter().flat_map(|[pos, of]| {
        let low = [0, 1].map(|axis| pos[axis] - size[axis] - GAP);
        let high = [0, 1].map(|axis| pos[axis] + of[axis] + GAP);
        [[high[0], y], [x, high[1]], [low[0], y], [x, low[1]]]
    });
    let distance = |[to_x, to_y]: &[f32; 2]| {
        let is_back = *to_x < x || *to_y < y;
        (to_x - x).hypot(to_y - y) + if is_back { GAP } else { 0.0 }
    };
    let nearest = beside
        .filter(|place| is_free(*place))
        .min_by(|one, other| distance(one).total_cmp(&distance(other)));
    // There is always a free place beside the outermost node on each side.
    nearest.unwrap_or(place)
}

/// Returns the first position without a node, starting at the given one and going right and down: nodes at the same
/// position would hide each other.
fn free_position(document: &OpenDocument, pos: [f32; 2]) -> [f32; 2] {
    let is_taken = |place: [f32; 2]| document.graph().nodes().any(|(_, node)| node.pos == place);
    // Trying one position more than there are nodes is enough, except so far from the origin that a step is lost in rounding.
    let steps = 0..=document.graph().len();
    let mut places = steps.map(|step| pos.map(|at| at + step as f32 * 2.0 * GRID));
    places.find(|place| !is_taken(*place)).unwrap_or(pos)
}

/// Removes the selected nodes. If `reconnects` is true, their readers are connected to the results that the nodes would
/// pass on if they were muted.
pub fn delete(document: &mut OpenDocument, reconnects: bool) -> bool {
    let ids = document.selection().clone();
    let mut edits = if reconnects {
        reconnection::reconnecting(document, &ids)
    } else {
        Vec::new()
    };
    let body = document.body();
    edits.extend(ids.iter().map(|id| Edit::RemoveNode {
        body: body.clone(),
        id: id.clone(),
    }));
    document.edit(if reconnects { "Delete and reconnect" } else { "Delete" }, edits)
}

/// Mutes the selected nodes, or unmutes them if all are muted.
pub fn toggle_muted(document: &mut OpenDocument) -> bool {
    let is_muted = |id: &NodeId| document.node(id).is_some_and(|node| node.muted);
    let muted = !document.selection().iter().all(is_muted);
    set_muted(document, document.selection().clone(), muted)
}

/// Mutes a node of the main graph. Returns false if the node does not exist or is muted already.
pub fn mute_in_main_graph(document: &mut OpenDocument, id: &NodeId) -> bool {
    let node = document.graph_of(&Body::Main).and_then(|graph| graph.node(id.as_str()));
    if node.is_none_or(|node| node.muted) {
        return false;
    }
    let edit = Edit::SetMuted {
        body: Body::Main,
        node: id.clone(),
        muted: true,
    };
    document.edit("Mute", vec![edit])
}

/// Mutes or unmutes nodes.
pub(crate) fn set_muted(document: &mut OpenDocument, ids: impl IntoIterator<Item = NodeId>, muted: bool) -> bool {
    let body = document.body();
    let edits = ids.into_iter().map(|node| Edit::SetMuted {
        body: body.clone(),
        node,
        muted,
    });
    let edits = edits.collect();
    document.edit(if muted { "Mute" } else { "Unmute" }, edits)
}

/// Lets the selected nodes show only these rows, or all rows if all selected nodes are in that state already.
pub fn toggle_rows(document: &mut OpenDocument, rows: NodeRows) -> bool {
    let is_so = |id: &NodeId| document.node(id).is_some_and(|node| node.display.rows == rows);
    let (name, rows) = match (document.selection().iter().all(is_so), rows) {
        (false, NodeRows::Wired) => ("Hide unused ports", rows),
        (false, NodeRows::None) => ("Collapse", rows),
        _ => ("Show all ports", NodeRows::All),
    };
    set_display(document, name, |display| display.rows = rows)
}

/// Draws wires that start at the selected nodes as names, or as wires again if all of them are drawn as names.
pub fn toggle_named_wires(document: &mut OpenDocument) -> bool {
    let is_named = |id: &NodeId| document.node(id).is_some_and(|node| node.display.has_named_wires);
    let has_named_wires = !document.selection().iter().all(is_named);
    let name = match has_named_wires {
        true => "Draw wires as names",
        false => "Draw wires",
    };
    set_display(document, name, |display| display.has_named_wires = has_named_wires)
}

fn set_display(document: &mut OpenDocument, name: &str, change: impl Fn(&mut NodeDisplay)) -> bool {
    let edit = |id: &NodeId| {
        let mut display = document.node(id)?.display;
        change(&mut display);
        Some(Edit::SetDisplay {
            body: document.body(),
            node: id.clone(),
            display,
        })
    };
    let edits = document.selection().iter().filter_map(edit).collect();
    document.edit(name, edits)
}

/// Sets a knob of a node; `None` restores its default.
pub fn set_knob(document: &mut OpenDocument, id: &NodeId, knob: &str, value: Option<Value>) -> bool {
    set_knob_of(document, [id.clone()], knob, value)
}

/// Sets a knob of a node and, if the node is selected, of all selected nodes of its kind.
pub fn set_knob_of_selected(document: &mut OpenDocument, id: &NodeId, knob: &str, value: Option<Value>) -> bool {
    let kind = document.node(id).map(|node| (node.kind.clone(), node.group.clone()));
    let is_alike = |other: &NodeId| document.node(other).map(|node| (node.kind.clone(), node.group.clone())) == kind;
    let mut alike: Vec<NodeId> = document
        .selection()
        .iter()
        .filter(|other| is_alike(other))
        .cloned()
        .collect();
    if !alike.contains(id) {
        alike = vec![id.clone()];
    }
    set_knob_of(document, alike, knob, value)
}

fn set_knob_of(
    document: &mut OpenDocument,
    ids: impl IntoIterator<Item = NodeId>,
    knob: &str,
    value: Option<Value>,
) -> bool {
    let ids: Vec<NodeId> = ids.into_iter().collect();
    // All of these nodes have the same kind, so a value that means no variant is a reset for all of them.
    let value = value.filter(|value| !ids.iter().any(|node| means_no_variant(document, node, knob, value)));
    let mut edits = exposed_values::values_of_exposed(document, &ids, knob, value.as_ref());
    let step = match ids.as_slice() {
        [id] => format!(
            "{} of '{}'",
            knob_label(document.interface(id), knob),
            document.title(id)
        ),
        [id, ..] => format!("{} of {} nodes", knob_label(document.interface(id), knob), ids.len()),
        [] => return false,
    };
    for node in ids {
        if exposed_values::is_of_variant_only(document, &node, knob, value.as_ref()) {
            continue;
        }
        edits.push(Edit::SetParam {
            body: document.body(),
            node,
            param: knob.to_owned(),
            value: value.clone(),
        });
    }
    document.edit(&step, edits)
}

/// Returns whether a value selects no variant for a group instance. Files express this by omitting the parameter.
fn means_no_variant(document: &OpenDocument, id: &NodeId, knob: &str, value: &Value) -> bool {
    let is_instance = document.node(id).is_some_and(|node| node.kind == GROUP_KIND);
    is_instance && knob == "variant" && value.as_text() == Some(NO_VARIANT)
}

/// Sets the label of a node; an empty one restores the label of its kind. If the node is the only instance of a group, the
/// group itself is renamed, so that lists and the library show the name, too.
pub fn rename(document: &mut OpenDocument, id: &NodeId, name: &str) -> bool {
    let name = name.trim();
    let body = document.body();
    let label = |label: Option<String>| Edit::SetLabel {
        body: body.clone(),
        node: id.clone(),
        label,
    };
    if let Some(group) = group_to_rename(document, id, name) {
        let renamed = Edit::RenameGroup {
            name: group,
            to: name.to_owned(),
            shown: None,
        };
        let has_label = document.node(id).is_some_and(|node| node.label.is_some());
        let unlabeled = has_label.then(|| label(None));
        return document.edit("Rename group", unlabeled.into_iter().chain([renamed]).collect());
    }
    let edit = label(Some(name.to_owned()).filter(|name| !name.is_empty()));
    document.edit("Rename", vec![edit])
}

/// Returns the group of which the node is the only instance, if the group can be renamed.
fn group_to_rename(document: &OpenDocument, id: &NodeId, name: &str) -> Option<String> {
    let group = document.node(id)?.group.clone()?;
    let groups = &document.contents().groups;
    let is_free = !name.is_empty() && !is_file(name) && (name == group || !groups.contains_key(name));
    let uses = bodies(document.contents())
        .iter()
        .map(|(_, graph)| instances(graph, &group).count())
        .sum::<usize>();
    (groups.contains_key(&group) && is_free && uses == 1).then_some(group)
}
