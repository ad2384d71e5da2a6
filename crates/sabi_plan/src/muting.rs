//! Muted nodes pass on their first input of a suitable type.

use std::collections::BTreeSet;

use sabi_graph::{FlatGraph, FlatRef, PortType};

/// Ports of nodes, as needed for muting.
pub(crate) trait NodePorts {
    /// Type of a result; `None` where the node has no such result.
    fn output(&self, node: usize, port: Option<&str>) -> Option<PortType>;
    /// Names and types of the inputs, in order.
    fn inputs(&self, node: usize) -> Vec<(String, PortType)>;
}

/// Returns the origin of a link when muted nodes pass on their inputs, and the muted nodes on the way.
///
/// Follows the first input of the same type that leads to a node that is not muted; `None` where no input does.
pub(crate) fn unmuted_origin(
    graph: &FlatGraph,
    ports: &dyn NodePorts,
    from: &FlatRef,
) -> (Option<FlatRef>, BTreeSet<usize>) {
    let mut muted = BTreeSet::new();
    let mut ways = vec![from.clone()];
    while let Some(at) = ways.pop() {
        let node = &graph.nodes[at.node];
        if !node.muted {
            return (Some(at), muted);
        }
        // Each node is visited once: its inputs are the same for all its results.
        let first_time = muted.insert(at.node);
        let Some(ty) = ports.output(at.node, at.port.as_deref()).filter(|_| first_time) else {
            continue;
        };
        let inputs = ports.inputs(at.node);
        let fitting = inputs.iter().rev().filter(|(_, input)| *input == ty);
        ways.extend(fitting.filter_map(|(name, _)| node.inputs.get(name)).cloned());
    }
    (None, muted)
}
