//! Titled boxes around nodes.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Edit, Frame, NodeId};

use super::OpenDocument;

/// Colors that frames take in turn.
const COLORS: [&str; 6] = ["#4a5a6a", "#6a5a3c", "#4c6650", "#6a4a4a", "#5a4a6a", "#3c6266"];

impl OpenDocument {
    /// Puts a frame around the selected nodes.
    pub fn frame(&mut self) -> bool {
        if self.selection.is_empty() {
            self.say("select the nodes that a frame should hold");
            return false;
        }
        let count = self.graph().frames().len();
        let taken = self.frame_ids();
        let id = self.new_id("frame", &taken);
        let frame = Frame {
            title: Some("Frame".to_owned()),
            color: Some(COLORS[count % COLORS.len()].to_owned()),
            nodes: self.selection.iter().cloned().collect(),
            ..Frame::default()
        };
        self.set_frame("Frame", id.as_str(), frame)
    }

    /// Ids of frames that are seen, as far as a new one could have them.
    pub(super) fn frame_ids(&self) -> BTreeSet<NodeId> {
        let frames = self.graph().frames().keys();
        frames.filter_map(|id| id.parse().ok()).collect()
    }

    /// Selects the nodes in a frame.
    pub fn select_frame(&mut self, id: &str) {
        let frame = self.graph().frames().get(id);
        let nodes = frame.map(|frame| frame.nodes.clone());
        self.select(nodes.unwrap_or_default());
    }

    /// Puts nodes into a frame, or (`None`) takes them out of all.
    pub fn put_into_frame(&mut self, nodes: &BTreeSet<NodeId>, id: Option<&str>) -> bool {
        let mut edits = Vec::new();
        for (known, frame) in self.graph().frames() {
            let mut changed = frame.clone();
            changed.nodes.retain(|node| !nodes.contains(node));
            if Some(known.as_str()) == id {
                changed.nodes.extend(nodes.iter().cloned());
                // As long as all were in it already, they keep their places.
                if nodes.iter().all(|node| frame.nodes.contains(node)) {
                    continue;
                }
            }
            if changed != *frame {
                edits.push(Edit::AddFrame {
                    body: self.body(),
                    id: known.clone(),
                    frame: changed,
                });
            }
        }
        self.edit("Change frame", edits)
    }

    /// Changes a frame, or adds it.
    pub fn set_frame(&mut self, step: &str, id: &str, frame: Frame) -> bool {
        let edit = Edit::AddFrame {
            body: self.body(),
            id: id.to_owned(),
            frame,
        };
        self.edit(step, vec![edit])
    }

    /// Removes a frame; its nodes stay.
    pub fn remove_frame(&mut self, id: &str) -> bool {
        let edit = Edit::RemoveFrame {
            body: self.body(),
            id: id.to_owned(),
        };
        self.edit("Remove frame", vec![edit])
    }

    /// The removal of frames that these edits leave without a node: nobody sees those or could take them away.
    pub(super) fn emptied_frames(&self, edits: &[Edit]) -> Vec<Edit> {
        let body = self.body();
        let holds = |frame: &Frame| frame.nodes.iter().any(|id| self.graph().node(id.as_str()).is_some());
        let (mut removed, mut added, mut framed) = (BTreeSet::new(), BTreeSet::new(), BTreeMap::new());
        for edit in edits {
            match edit {
                Edit::RemoveNode { body: of, id } if *of == body => removed.insert(id),
                Edit::AddNode { body: of, id, .. } if *of == body => added.insert(id),
                Edit::AddFrame { body: of, id, frame } if *of == body => framed.insert(id, Some(frame)).is_none(),
                Edit::RemoveFrame { body: of, id } if *of == body => framed.insert(id, None).is_none(),
                _ => false,
            };
        }
        let stays =
            |id: &NodeId| added.contains(id) || (!removed.contains(id) && self.graph().node(id.as_str()).is_some());
        let frames = self.graph().frames().iter().filter(|(_, frame)| holds(frame));
        let emptied = frames.filter(|(id, frame)| match framed.get(id) {
            Some(None) => false,
            Some(Some(changed)) => !changed.nodes.iter().any(stays),
            None => !frame.nodes.iter().any(stays),
        });
        let remove = |id: &String| Edit::RemoveFrame {
            body: body.clone(),
            id: id.clone(),
        };
        emptied.map(|(id, _)| remove(id)).collect()
    }

    /// The color after the one that a frame has.
    pub fn next_color(color: Option<&str>) -> String {
        let at = COLORS.iter().position(|known| Some(*known) == color);
        COLORS[at.map_or(0, |at| (at + 1) % COLORS.len())].to_owned()
    }
}
