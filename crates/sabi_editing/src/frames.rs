//! Titled boxes around nodes.

use std::collections::BTreeSet;

use sabi_graph::{Edit, Frame, NodeId};

use crate::open_document::OpenDocument;

/// Space between a frame's border and its nodes, canvas points.
pub const FRAME_AROUND: f32 = 20.0;
/// Height of a frame's title bar, canvas points.
pub const FRAME_STRIP: f32 = 30.0;
/// Error about a frame that does not exist.
const GONE: &str = "this frame does not exist any more";
/// Colors that new frames get in turn.
const COLORS: [&str; 6] = ["#4a5a6a", "#6a5a3c", "#4c6650", "#6a4a4a", "#5a4a6a", "#3c6266"];

/// Adds a frame around the selected nodes.
pub fn add(document: &mut OpenDocument) -> bool {
    if document.selection().is_empty() {
        document.notify("select the nodes that a frame should hold");
        return false;
    }
    let count = document.graph().frames().len();
    let taken = ids(document);
    let id = document.new_id("frame", &taken);
    let frame = Frame {
        title: Some("Frame".to_owned()),
        color: Some(COLORS[count % COLORS.len()].to_owned()),
        nodes: document.selection().iter().cloned().collect(),
        ..Frame::default()
    };
    set(document, "Frame", id.as_str(), frame)
}

/// Returns the ids of the frames of the shown graph that are valid ids of nodes.
pub(crate) fn ids(document: &OpenDocument) -> BTreeSet<NodeId> {
    let frames = document.graph().frames().keys();
    frames.filter_map(|id| id.parse().ok()).collect()
}

/// Selects the nodes in a frame.
pub fn select(document: &mut OpenDocument, id: &str) {
    match document.graph().frames().get(id).map(|frame| frame.nodes.clone()) {
        Some(nodes) => document.select(nodes),
        None => document.notify(GONE),
    }
}

/// Moves nodes into a frame, or (`None`) out of all frames.
pub fn assign(document: &mut OpenDocument, nodes: &BTreeSet<NodeId>, id: Option<&str>) -> bool {
    let mut edits = Vec::new();
    for (known, frame) in document.graph().frames() {
        let mut changed = frame.clone();
        changed.nodes.retain(|node| !nodes.contains(node));
        if Some(known.as_str()) == id {
            changed.nodes.extend(nodes.iter().cloned());
            // If all nodes are in the frame already, their order is kept.
            if nodes.iter().all(|node| frame.nodes.contains(node)) {
                continue;
            }
        }
        if changed != *frame {
            edits.push(Edit::AddFrame {
                body: document.body(),
                id: known.clone(),
                frame: changed,
            });
        }
    }
    document.edit("Change frame", edits)
}

/// Replaces a frame, or adds it.
fn set(document: &mut OpenDocument, step: &str, id: &str, frame: Frame) -> bool {
    let edit = Edit::AddFrame {
        body: document.body(),
        id: id.to_owned(),
        frame,
    };
    document.edit(step, vec![edit])
}

/// Sets the title of a frame.
pub fn rename(document: &mut OpenDocument, id: &str, title: String) -> bool {
    change(document, id, |frame| frame.title = Some(title))
}

/// Gives a frame the next color of the palette.
pub fn recolor(document: &mut OpenDocument, id: &str) -> bool {
    change(document, id, |frame| {
        frame.color = Some(next_color(frame.color.as_deref()))
    })
}

fn change(document: &mut OpenDocument, id: &str, change: impl FnOnce(&mut Frame)) -> bool {
    let Some(mut frame) = document.graph().frames().get(id).cloned() else {
        return document.refuse(GONE);
    };
    change(&mut frame);
    set(document, "Change frame", id, frame)
}

/// Removes a frame; its nodes stay.
pub fn remove(document: &mut OpenDocument, id: &str) -> bool {
    let edit = Edit::RemoveFrame {
        body: document.body(),
        id: id.to_owned(),
    };
    document.edit("Delete frame", vec![edit])
}

/// Returns the color that follows a frame's color in the palette.
pub(crate) fn next_color(color: Option<&str>) -> String {
    let at = COLORS.iter().position(|known| Some(*known) == color);
    COLORS[at.map_or(0, |at| (at + 1) % COLORS.len())].to_owned()
}
