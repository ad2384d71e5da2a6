//! Resolution of a node named on a command line.

use sabi_graph::{FlatGraph, NodeRef, advice_on};
use sabi_plan::Target;

use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::EvaluatorOptions;
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;

/// Flattens the graph and finds the target of a node in it: the node itself, or the node from which the result of a group
/// instance or reroute comes.
pub(crate) fn graph_and_target(
    open: &OpenGraph,
    kinds: &Kinds,
    options: &EvaluatorOptions,
    node: &str,
) -> Result<(FlatGraph, Target), EngineError> {
    let (id, port) = match node.split_once('.') {
        Some((id, port)) => (id, Some(port.to_owned())),
        None => (node, None),
    };
    let wanted = NodeRef {
        node: id.to_owned(),
        port,
    };
    let (graph, found) = options.flat_graph_and_find(open, kinds, &[wanted])?;
    let refused = |why: String| EngineError::new(ErrorKind::Usage, open.with_path(why));
    let found = found
        .into_iter()
        .next()
        .transpose()
        .map_err(|error| refused(error.to_string()).caused_by(error))?;
    if let Some(from) = found.flatten() {
        let target = Target {
            node: from.node,
            port: from.port,
        };
        return Ok((graph, target));
    }
    if open.document.graph.node(id).is_some() {
        let why = format!("nothing is connected to the input of '{node}', so it has no result");
        return Err(refused(why));
    }
    Err(no_such_node(&graph, node))
}

fn no_such_node(graph: &FlatGraph, text: &str) -> EngineError {
    let advice = advice_on(text, graph.nodes.iter().map(|node| node.id.as_str()));
    let why = format!("the graph has no node '{text}'; {advice}");
    EngineError::new(ErrorKind::Usage, why)
}
