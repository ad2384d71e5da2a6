//! Actions that only edit the open graph.

use sabi_editing::{OpenDocument, PendingWire};
use sabi_graph::{Frame, NodeId, SlotRef};

use crate::action::{DocumentAction, FrameAction, MoveAction, NewNode, PortAction, WireAction};

/// Adds a node, connected to a loose wire or put into a wire, as one step.
pub(super) fn add(
    document: &mut OpenDocument,
    new: &NewNode,
    place: [f32; 2],
    loose: Option<&PendingWire>,
    into: Option<&SlotRef>,
) -> Option<NodeId> {
    document.session.begin("Add");
    let added = match new {
        NewNode::Kind(kind) => document.add(kind, place, loose),
        NewNode::Group(group) => document.add_group_instance(group, place, loose),
        NewNode::Library(file) => document.add_from_library(file, place, loose),
    };
    if let Some((id, into)) = added.as_ref().zip(into) {
        document.insert(id, into);
    }
    document.session.end();
    added
}

/// Replaces a node; gives the new one.
pub(super) fn replace(document: &mut OpenDocument, node: &NodeId, by: &NewNode) -> Option<NodeId> {
    let is_replaced = match by {
        NewNode::Kind(kind) => document.replace(node, kind),
        NewNode::Group(group) => document.replace_by_group(node, group),
        NewNode::Library(file) => {
            document.session.begin("Replace by a group");
            let group = document.bring_from_library(file);
            let is_replaced = group.is_some_and(|group| document.replace_by_group(node, &group));
            if is_replaced {
                document.session.end();
            } else {
                document.take_back();
            }
            is_replaced
        }
    };
    document.selected_one().cloned().filter(|_| is_replaced)
}

pub(super) fn change_wires(document: &mut OpenDocument, action: WireAction) {
    match action {
        WireAction::Connect { from, to, off } => {
            document.session.begin("Connect");
            if document.connect(&from, &to)
                && let Some(off) = off
            {
                document.cut(&[off]);
            }
            document.session.end();
        }
        WireAction::Merge { from, to, how } => drop(document.merge(&from, &to, how)),
        WireAction::Cut(slots) => drop(document.cut(&slots)),
        WireAction::Insert { node, into } => drop(document.insert(&node, &into)),
        WireAction::Reroute { into, place } => drop(document.reroute(&into, place)),
    }
}

pub(super) fn move_nodes(document: &mut OpenDocument, action: MoveAction) {
    match action {
        MoveAction::Begin => document.session.begin("Move"),
        MoveAction::To(places) => drop(document.move_to("Move", places)),
        MoveAction::End => document.session.end(),
        MoveAction::Cancel => document.take_back(),
    }
}

pub(super) fn change_frames(document: &mut OpenDocument, action: FrameAction) {
    match action {
        FrameAction::Rename { frame, title } => change_frame(document, &frame, |known| known.title = Some(title)),
        FrameAction::Recolor(frame) => change_frame(document, &frame, |known| {
            known.color = Some(OpenDocument::next_color(known.color.as_deref()));
        }),
        FrameAction::Select(frame) => document.select_frame(&frame),
        FrameAction::Fill(frame) => {
            let nodes = document.selection().clone();
            document.put_into_frame(&nodes, frame.as_deref());
        }
        FrameAction::Remove(frame) => drop(document.remove_frame(&frame)),
    }
}

fn change_frame(document: &mut OpenDocument, id: &str, change: impl FnOnce(&mut Frame)) {
    if let Some(mut frame) = document.graph().frames().get(id).cloned() {
        change(&mut frame);
        document.set_frame("Change frame", id, frame);
    }
}

pub(super) fn change_ports(document: &mut OpenDocument, action: PortAction) {
    match action {
        PortAction::NameGraph(name) => drop(document.rename_graph(&name)),
        PortAction::PublishInput(slot) => drop(document.publish_input(&slot)),
        PortAction::PublishOutput(from) => drop(document.publish_output(&from)),
        PortAction::LabelInput { name, label } => drop(document.label_input(&name, &label)),
        PortAction::RenameInput { name, to } => drop(document.rename_input(&name, &to)),
        PortAction::RemoveInput(name) => drop(document.remove_input(&name)),
        PortAction::Feed { name, slot } => drop(document.feed(&name, &slot)),
        PortAction::Unfeed(slot) => drop(document.unfeed(&slot)),
        PortAction::RenameOutput { name, to } => drop(document.rename_output(&name, &to)),
        PortAction::RemoveOutput(name) => drop(document.remove_output(&name)),
        PortAction::Retarget { name, from } => drop(document.retarget_output(&name, &from)),
    }
}

pub(super) fn change_document(document: &mut OpenDocument, action: DocumentAction) {
    match action {
        DocumentAction::Size(size) => document.set_size(size),
        DocumentAction::Fit(fit) => document.set_fit(fit),
        DocumentAction::Seed(seed) => document.set_seed(seed),
    };
}

/// Undoes or redoes this many steps; negative is undo.
pub(super) fn step(document: &mut OpenDocument, steps: i32) {
    for _ in 0..steps.unsigned_abs() {
        if steps < 0 { document.undo() } else { document.redo() }
    }
}

/// Publishes a parameter of a node, together with those of the selected nodes of its kind.
pub(super) fn expose_of_alike(document: &mut OpenDocument, node: &NodeId, knob: &str) {
    let kind = |id: &NodeId| document.node(id).map(|node| &node.kind);
    let alike = document
        .selection()
        .iter()
        .filter(|id| *id != node && kind(id) == kind(node));
    let alike: Vec<NodeId> = alike.cloned().collect();
    document.session.begin("Expose");
    document.expose(node, knob);
    if let Some(name) = document.exposed_as(node, knob).map(str::to_owned) {
        for other in alike {
            document.expose_as(&other, knob, &name);
        }
    }
    document.session.end();
}

/// Selects a node, which is named as the evaluation names it, in the group that it is in. Of a node in a group file, that is
/// the instance of the group.
pub(super) fn go_to(document: &mut OpenDocument, node: &str) -> Option<NodeId> {
    document.leave_to(0);
    let steps: Vec<NodeId> = node.split('/').filter_map(|step| step.parse().ok()).collect();
    let (mut last, instances) = steps.split_last()?;
    for instance in instances {
        if !document.enter(instance) {
            last = instance;
            break;
        }
    }
    document.select([last.clone()]);
    Some(last.clone())
}
