//! Errors of nodes, and what other nodes wait for because of them.

use std::collections::BTreeMap;

use sabi_engine::live::GraphFaults;

/// Errors of the last evaluation, by node.
#[derive(Default)]
pub(crate) struct NodeFaults {
    /// All errors.
    pub(crate) all: GraphFaults,
    /// Error of each faulty node and of the group instances around it.
    by_node: BTreeMap<String, String>,
    /// Sentence about what each blocked node and the group instances around it wait for.
    waiting: BTreeMap<String, String>,
}

impl NodeFaults {
    pub(super) fn new(all: GraphFaults) -> NodeFaults {
        let faults = all.faults.iter();
        let unchosen = all.unchosen.iter().map(|it| (&*it.node, it.sentence.clone()));
        let blocked = all.blocked.iter();
        let blocked = blocked.map(|it| (&*it.node, format!("waiting for node '{}'", it.blocked_by)));
        NodeFaults {
            by_node: with_group_instances(faults.map(|fault| (&*fault.node, fault.sentence.clone()))),
            waiting: with_group_instances(unchosen.chain(blocked)),
            all,
        }
    }

    /// Error of a node, or of the first one in a group instance.
    pub(crate) fn of(&self, node: &str) -> Option<&String> {
        self.by_node.get(node)
    }

    /// Sentence about what a node, or the first one in a group instance, waits for.
    pub(crate) fn waits(&self, node: &str) -> Option<&String> {
        self.waiting.get(node)
    }

    /// Sentence about why a node has no result: its error, or what it waits for.
    pub(crate) fn sentence(&self, node: &str) -> Option<&String> {
        self.of(node).or_else(|| self.waits(node))
    }
}

/// Sentences by node, also at the group instances around it: one at `a/b/c` is also at `a/b` and `a`, unless another is
/// there.
fn with_group_instances<'n>(sentences: impl Iterator<Item = (&'n str, String)>) -> BTreeMap<String, String> {
    let mut at_nodes = BTreeMap::new();
    for (node, sentence) in sentences {
        let nodes = std::iter::successors(Some(node), |inner| inner.rsplit_once('/').map(|(outer, _)| outer));
        for node in nodes {
            at_nodes.entry(node.to_owned()).or_insert_with(|| sentence.clone());
        }
    }
    at_nodes
}
