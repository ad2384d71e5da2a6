//! Pictures that are let go of.

use sabi_editing::OpenDocument;
use sabi_engine::ViewSubject;
use sabi_graph::NodeRef;

use super::{Picture, Stage, Wanted};

/// Pictures of the model that are kept besides those that are wanted, since one goes back to what one has just seen.
const KEPT_PICTURES: usize = 6;

impl Stage {
    /// Lets go of what nobody wants and nobody will want soon: of nodes that are gone, of other models, of long ago.
    pub(super) fn let_go(&mut self, document: &OpenDocument, wanted: &Wanted) {
        let mut numbers: Vec<u64> = self.pictures.values().map(|picture| picture.number).collect();
        numbers.sort_unstable();
        let oldest = numbers.len().saturating_sub(KEPT_PICTURES + wanted.seen.len());
        let oldest = numbers.get(oldest).copied().unwrap_or_default();
        let revision = self.model_revision;
        let is_kept = |seen: &ViewSubject, picture: &Picture| {
            let is_there = match seen {
                ViewSubject::Outputs => true,
                ViewSubject::Node(node) => document.has(&node.node),
            };
            is_there && picture.number >= oldest && picture.model.model_revision == revision
        };
        let gone = self.pictures.iter();
        let gone = gone.filter(|(seen, picture)| !wanted.seen.contains(seen) && !is_kept(seen, picture));
        let gone: Vec<ViewSubject> = gone.map(|(seen, _)| seen.clone()).collect();
        let nodes = self.thumbnails.keys();
        let nodes = nodes.filter(|node| !wanted.thumbnails.contains(node) && !document.has(&node.node));
        let nodes: Vec<NodeRef> = nodes.cloned().collect();
        self.times.retain(|node, _| document.has(node));
        self.forget(gone, nodes);
    }

    /// Lets go of all pictures of nodes, since another graph is opened.
    pub(crate) fn forget_nodes(&mut self) {
        let seen = self.pictures.keys().filter(|seen| **seen != ViewSubject::Outputs);
        let (seen, nodes) = (seen.cloned().collect(), self.thumbnails.keys().cloned().collect());
        self.times.clear();
        self.forget(seen, nodes);
    }

    /// Lets go of pictures, which come again once they are wanted again.
    fn forget(&mut self, seen: Vec<ViewSubject>, nodes: Vec<NodeRef>) {
        for seen in &seen {
            self.pictures.remove(seen);
        }
        for node in &nodes {
            self.thumbnails.remove(node);
        }
        if !seen.is_empty() || !nodes.is_empty() {
            self.live.mark_dropped(seen, nodes);
        }
    }
}
