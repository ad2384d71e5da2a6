//! Request with its flat graph, and the nodes that failed.

use std::collections::BTreeMap;

use sabi_graph::{FlatGraph, NodeRef, Value};
use sabi_plan::{FileContents, Target};

use super::event::GraphFaults;

/// Request with its flat graph and the targets in it.
pub(super) struct FlattenedRequest {
    pub(super) graph: FlatGraph,
    /// Targets of the nodes that the request names, as far as they exist.
    pub(super) found: BTreeMap<NodeRef, Target>,
    pub(super) contents: FileContents,
    pub(super) kinds_revision: u64,
    /// Faults known before the evaluation.
    pub(super) faults: GraphFaults,
}

/// Node whose result could not be computed. It is tried again once its parameters, its file or the node files change.
pub(super) struct FailedNode {
    pub(super) why: String,
    /// True if it kept the device busy for too long.
    pub(super) is_too_long: bool,
    pub(super) params: BTreeMap<String, Value>,
    pub(super) content: Option<[u8; 32]>,
    pub(super) kinds_revision: u64,
}

impl FlattenedRequest {
    /// Records that a node's result cannot be computed. Returns true if this node of the graph had not failed before;
    /// without this check, planning again without the node might not end.
    pub(super) fn record_failure(
        &self,
        failed_nodes: &mut BTreeMap<String, FailedNode>,
        node: &str,
        why: &str,
        is_too_long: bool,
    ) -> bool {
        let Some(index) = self.graph.find(node) else {
            return false;
        };
        let found = FailedNode {
            why: why.to_owned(),
            is_too_long,
            params: self.graph.nodes[index].params.clone(),
            content: self.content(index),
            kinds_revision: self.kinds_revision,
        };
        failed_nodes.insert(node.to_owned(), found).is_none()
    }

    fn content(&self, node: usize) -> Option<[u8; 32]> {
        self.contents.get(&node)?.as_ref().ok().copied()
    }

    pub(super) fn still_fails(&self, id: &str, failed: &FailedNode) -> bool {
        self.graph.find(id).is_some_and(|index| {
            let node = &self.graph.nodes[index];
            let is_same = node.params == failed.params && self.content(index) == failed.content;
            is_same && !node.muted && self.kinds_revision == failed.kinds_revision
        })
    }

    /// Lists the ids of all nodes downstream of a node.
    pub(super) fn downstream(&self, id: &str) -> impl Iterator<Item = &str> {
        let index = self.graph.find(id);
        let needs = move |node: &usize| {
            Some(*node) != index && index.is_some_and(|index| self.graph.upstream(&[*node]).contains(&index))
        };
        let nodes = (0..self.graph.nodes.len()).filter(needs);
        nodes.map(|node| self.graph.nodes[node].id.as_str())
    }

    /// Returns the targets that need no failed node.
    pub(super) fn without_failed(
        &self,
        targets: &[Target],
        failed_nodes: &BTreeMap<String, FailedNode>,
    ) -> Vec<Target> {
        if failed_nodes.is_empty() {
            return targets.to_vec();
        }
        let failed: Vec<usize> = failed_nodes.keys().filter_map(|id| self.graph.find(id)).collect();
        let is_sound = |target: &&Target| {
            // The node of the model's own materials is appended to the graph and has no inputs.
            let needed = self.graph.upstream(&[target.node]);
            !failed.iter().any(|node| needed.contains(node))
        };
        targets.iter().filter(is_sound).cloned().collect()
    }
}
