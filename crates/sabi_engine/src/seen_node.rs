//! The node that somebody wants to see, by the name on a command line.

use sabi_graph::{Body, Edit, FlatGraph, Node, NodeId, OutputRef, nearest};
use sabi_plan::Target;

use crate::document::OpenGraph;
use crate::error::{EngineError, ErrorKind};
use crate::kinds::Kinds;
use crate::source::OUTPUT_MASK;
use crate::workpiece::{Workpiece, WorkpieceOptions};

/// Id of the node that is wired to what has no result of its own; long enough to be nobody's.
const PROBE: &str = "sabi_preview_probe_of_groups_and_reroutes";

/// The flat graph, and what of it is to be seen.
///
/// Group instances and reroutes are gone from a flat graph: a probe is wired to them, and what it reads is shown.
pub(crate) fn graph_and_target(
    open: &OpenGraph,
    kinds: &Kinds,
    options: &WorkpieceOptions,
    node: &str,
) -> Result<(FlatGraph, Target), EngineError> {
    let graph = Workpiece::flat_graph(open, kinds, options)?;
    let plain = target(&graph, node);
    let Ok(wire) = node.parse::<OutputRef>() else {
        return plain.map(|target| (graph, target));
    };
    if plain.is_ok() || open.document.graph.node(wire.node.as_str()).is_none() {
        return plain.map(|target| (graph, target));
    }
    let mut probed = open.clone();
    let mut probe = Node::new(OUTPUT_MASK);
    probe.inputs.insert("source".to_owned(), wire);
    let id: NodeId = PROBE
        .parse()
        .map_err(|_| EngineError::new(ErrorKind::BadInput, "the probe has no name"))?;
    let add = Edit::AddNode {
        body: Body::Main,
        id,
        node: probe,
    };
    let refused = |why: String| EngineError::new(ErrorKind::Usage, open.said(why));
    probed.document.apply(add).map_err(|error| refused(error.to_string()))?;
    let graph = Workpiece::flat_graph(&probed, kinds, options)?;
    let seen = graph
        .find(PROBE)
        .and_then(|probe| graph.nodes[probe].inputs.get("source").cloned());
    let nothing = || {
        refused(format!(
            "nothing is connected behind '{}', so there is nothing to see",
            node
        ))
    };
    let from = seen.ok_or_else(nothing)?;
    Ok((
        graph,
        Target {
            node: from.node,
            port: from.port,
        },
    ))
}

/// The target that `id` or `id.port` names.
fn target(graph: &FlatGraph, text: &str) -> Result<Target, EngineError> {
    if let Some(node) = graph.find(text) {
        return Ok(Target { node, port: None });
    }
    if let Some((id, port)) = text.rsplit_once('.')
        && let Some(node) = graph.find(id)
    {
        return Ok(Target {
            node,
            port: Some(port.to_owned()),
        });
    }
    let ids = || graph.nodes.iter().map(|node| node.id.as_str());
    let advice = match nearest(text, ids()) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("there are: {}", ids().collect::<Vec<_>>().join(", ")),
    };
    Err(EngineError::new(
        ErrorKind::Usage,
        format!("the graph has no node '{text}'; {advice}"),
    ))
}
