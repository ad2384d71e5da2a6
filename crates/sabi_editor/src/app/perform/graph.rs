//! Actions that only edit the open graph.

use sabi_editing::connections::PendingWire;
use sabi_editing::{
    OpenDocument, arrangement, document_settings, frames, groups, library, navigation, node_replacement, nodes, panel,
    ports, wires,
};
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
        NewNode::Kind(kind) => nodes::add(document, kind, place, loose),
        NewNode::Group(group) => nodes::add_instance(document, group, place, loose),
        NewNode::Library(file) => library::add(document, file, place, loose),
    };
    if let Some((id, into)) = added.as_ref().zip(into) {
        wires::insert(document, id, into);
    }
    document.session.end();
    added
}

/// Replaces a node; gives the new one.
pub(super) fn replace(document: &mut OpenDocument, node: &NodeId, by: &NewNode) -> Option<NodeId> {
    let is_replaced = match by {
        NewNode::Kind(kind) => node_replacement::by_kind(document, node, kind),
        NewNode::Group(group) => node_replacement::by_group(document, node, group),
        NewNode::Library(file) => {
            document.session.begin("Replace by a group");
            let group = library::import(document, file);
            let is_replaced = group.is_some_and(|group| node_replacement::by_group(document, node, &group));
            if is_replaced {
                document.session.end();
            } else {
                document.cancel_step();
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
            if wires::connect(document, &from, &to)
                && let Some(off) = off
            {
                wires::disconnect(document, &[off]);
            }
            document.session.end();
        }
        WireAction::Merge { from, to, how } => drop(wires::merge(document, &from, &to, how)),
        WireAction::Cut(slots) => drop(wires::disconnect(document, &slots)),
        WireAction::Insert { node, into } => drop(wires::insert(document, &node, &into)),
        WireAction::Reroute { into, place } => drop(wires::reroute(document, &into, place)),
    }
}

pub(super) fn move_nodes(document: &mut OpenDocument, action: MoveAction) {
    match action {
        MoveAction::Begin => document.session.begin("Move"),
        MoveAction::To(places) => drop(arrangement::move_nodes(document, "Move", places)),
        MoveAction::End => document.session.end(),
        MoveAction::Cancel => document.cancel_step(),
    }
}

pub(super) fn change_frames(document: &mut OpenDocument, action: FrameAction) {
    match action {
        FrameAction::Rename { frame, title } => change_frame(document, &frame, |known| known.title = Some(title)),
        FrameAction::Recolor(frame) => change_frame(document, &frame, |known| {
            known.color = Some(frames::next_color(known.color.as_deref()));
        }),
        FrameAction::Select(frame) => frames::select(document, &frame),
        FrameAction::Fill(frame) => {
            let nodes = document.selection().clone();
            frames::assign(document, &nodes, frame.as_deref());
        }
        FrameAction::Remove(frame) => drop(frames::remove(document, &frame)),
    }
}

fn change_frame(document: &mut OpenDocument, id: &str, change: impl FnOnce(&mut Frame)) {
    if let Some(mut frame) = document.graph().frames().get(id).cloned() {
        change(&mut frame);
        frames::set(document, "Change frame", id, frame);
    }
}

pub(super) fn change_ports(document: &mut OpenDocument, action: PortAction) {
    match action {
        PortAction::NameGraph(name) => drop(groups::rename_graph(document, &name)),
        PortAction::PublishInput(slot) => drop(ports::publish_input(document, &slot)),
        PortAction::PublishOutput(from) => drop(ports::publish_output(document, &from)),
        PortAction::LabelInput { name, label } => drop(ports::set_input_label(document, &name, &label)),
        PortAction::RenameInput { name, to } => drop(ports::rename_input(document, &name, &to)),
        PortAction::RemoveInput(name) => drop(ports::remove_input(document, &name)),
        PortAction::Feed { name, slot } => drop(ports::feed(document, &name, &slot)),
        PortAction::Unfeed(slot) => drop(ports::unfeed(document, &slot)),
        PortAction::RenameOutput { name, to } => drop(ports::rename_output(document, &name, &to)),
        PortAction::RemoveOutput(name) => drop(ports::remove_output(document, &name)),
        PortAction::Retarget { name, from } => drop(ports::retarget_output(document, &name, &from)),
    }
}

pub(super) fn change_document(document: &mut OpenDocument, action: DocumentAction) {
    match action {
        DocumentAction::Size(size) => document_settings::set_size(document, size),
        DocumentAction::Fit(fit) => document_settings::set_fit(document, fit),
        DocumentAction::Seed(seed) => document_settings::set_seed(document, seed),
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
    panel::expose(document, node, knob);
    if let Some(name) = panel::exposed_as(document, node, knob).map(str::to_owned) {
        for other in alike {
            panel::expose_also(document, &other, knob, &name);
        }
    }
    document.session.end();
}

/// Selects a node, which is named as the evaluation names it, in the group that it is in. Of a node in a group file, that is
/// the instance of the group.
pub(super) fn go_to(document: &mut OpenDocument, node: &str) -> Option<NodeId> {
    navigation::leave_to(document, 0);
    let steps: Vec<NodeId> = node.split('/').filter_map(|step| step.parse().ok()).collect();
    let (mut last, instances) = steps.split_last()?;
    for instance in instances {
        if !navigation::enter(document, instance) {
            last = instance;
            break;
        }
    }
    document.select([last.clone()]);
    Some(last.clone())
}
