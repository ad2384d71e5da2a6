//! Results that are dropped to bound memory.

use sabi_editing::{OpenDocument, node_paths};
use sabi_engine::ViewSubject;
use sabi_graph::NodeRef;

use super::{Evaluation, Picture, Wanted};

/// Results on the model that are kept besides the wanted ones, since artists switch back to what they have just seen.
const KEPT_PICTURES: usize = 6;

impl Evaluation {
    /// Drops results that are not wanted and are of deleted nodes, of another model, or old.
    pub(super) fn evict(&mut self, document: &OpenDocument, wanted: &Wanted) {
        let mut numbers: Vec<u64> = self.pictures.values().map(|picture| picture.number).collect();
        numbers.sort_unstable();
        let oldest = numbers.len().saturating_sub(KEPT_PICTURES + wanted.subjects.len());
        let oldest = numbers.get(oldest).copied();
        let revision = self.model_revision;
        let is_kept = |seen: &ViewSubject, picture: &Picture| {
            let is_there = match seen {
                ViewSubject::Outputs => true,
                ViewSubject::Node(node) => node_paths::exists(document, &node.node),
            };
            is_there && oldest.is_none_or(|oldest| picture.number >= oldest) && picture.model.model_revision == revision
        };
        let gone = self.pictures.iter();
        let gone = gone.filter(|(seen, picture)| !wanted.subjects.contains(seen) && !is_kept(seen, picture));
        let gone: Vec<ViewSubject> = gone.map(|(seen, _)| seen.clone()).collect();
        let nodes = self.thumbnails.keys();
        let nodes = nodes.filter(|node| !wanted.thumbnails.contains(node) && !node_paths::exists(document, &node.node));
        let nodes: Vec<NodeRef> = nodes.cloned().collect();
        self.times.retain(|node, _| node_paths::exists(document, node));
        self.forget(gone, nodes);
    }

    /// Drops all results of nodes, since another graph is opened.
    pub(crate) fn forget_nodes(&mut self) {
        let seen = self.pictures.keys().filter(|seen| **seen != ViewSubject::Outputs);
        let (seen, nodes) = (seen.cloned().collect(), self.thumbnails.keys().cloned().collect());
        self.times.clear();
        self.forget(seen, nodes);
    }

    /// Drops results here and in the engine, which evaluates them again when they are wanted.
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
