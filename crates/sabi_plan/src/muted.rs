//! Muted nodes pass their first fitting input on, as if they were a piece of wire.

use sabi_graph::{FlatGraph, FlatRef, PortType};

/// What a node's ports are, as far as muting needs it.
pub(crate) trait Ports {
    /// Type of a result, if there is such a one.
    fn output(&self, node: usize, port: Option<&str>) -> Option<PortType>;
    /// Names and types of the inputs, in order.
    fn inputs(&self, node: usize) -> Vec<(String, PortType)>;
}

/// Where a wire really comes from once muted nodes are wires: none when a muted node has nothing to pass on.
pub(crate) fn behind_muted(graph: &FlatGraph, ports: &dyn Ports, from: &FlatRef) -> Option<FlatRef> {
    let mut at = from.clone();
    // A flat graph has no cycles, so a chain of muted nodes is no longer than the graph.
    for _ in 0..=graph.nodes.len() {
        let node = &graph.nodes[at.node];
        if !node.muted {
            return Some(at);
        }
        let ty = ports.output(at.node, at.port.as_deref())?;
        let inputs = ports.inputs(at.node);
        let mut fitting = inputs.iter().filter(|(_, input)| *input == ty);
        at = fitting.find_map(|(name, _)| node.inputs.get(name))?.clone();
    }
    None
}
