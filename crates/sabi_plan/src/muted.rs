//! Muted nodes pass their first fitting input on, as if they were a piece of wire.

use std::collections::BTreeSet;

use sabi_graph::{FlatGraph, FlatRef, PortType};

/// What a node's ports are, as far as muting needs it.
pub(crate) trait Ports {
    /// Type of a result, if there is such a one.
    fn output(&self, node: usize, port: Option<&str>) -> Option<PortType>;
    /// Names and types of the inputs, in order.
    fn inputs(&self, node: usize) -> Vec<(String, PortType)>;
}

/// Where a wire really comes from once muted nodes are wires, and the muted nodes that were looked at.
///
/// Of a muted node's inputs of the same type the first one is followed that leads to a node that is not muted. None when
/// nothing is passed on.
pub(crate) fn behind_muted(graph: &FlatGraph, ports: &dyn Ports, from: &FlatRef) -> (Option<FlatRef>, BTreeSet<usize>) {
    let mut muted = BTreeSet::new();
    let mut ways = vec![from.clone()];
    while let Some(at) = ways.pop() {
        let node = &graph.nodes[at.node];
        if !node.muted {
            return (Some(at), muted);
        }
        // A node is asked once: whichever of its results is meant, its inputs lead nowhere else.
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
