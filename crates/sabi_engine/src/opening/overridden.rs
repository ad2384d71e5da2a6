//! Values set from outside are held against the nodes: what the file alone gets right and they do not is theirs.

use sabi_graph::{FlatGraph, Overrides};
use sabi_plan::{FileContents, PlanError, Problem};

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::opening::modelless::{all_nodes, planner};

/// Refuses values that no node takes, and names that no node has: unlike those in a file, which may come from a newer
/// Sabi, nobody means to keep them. `graph` is the flat graph with the overrides.
pub(crate) fn refuse_bad_values(
    open: &OpenGraph,
    graph: &FlatGraph,
    kinds: &Kinds,
    overrides: &Overrides,
) -> Result<(), EngineError> {
    if overrides.set.is_empty() {
        return Ok(());
    }
    let without = Overrides {
        set: Vec::new(),
        ..overrides.clone()
    };
    let known = problems(&open.flatten(&without)?, kinds);
    let fresh = problems(graph, kinds)
        .into_iter()
        .filter(|error| !known.contains(error));
    let messages: Vec<String> = fresh.map(|error| open.said(sentence(&error))).collect();
    if messages.is_empty() {
        return Ok(());
    }
    Err(EngineError::several(ErrorKind::Usage, messages))
}

fn problems(graph: &FlatGraph, kinds: &Kinds) -> Vec<PlanError> {
    // What is wrong with a file is told with all that is wrong with the graph.
    let files = FileContents::new();
    planner(graph, kinds, &files).resolve(&all_nodes(graph)).errors
}

fn sentence(error: &PlanError) -> String {
    let PlanError { node, kind, problem } = error;
    match problem {
        Problem::UnknownParam { param, nearest } => {
            let advice = match nearest {
                Some(near) => format!("did you mean '{near}'?"),
                None => format!("'sabi nodes {kind}' lists what it has"),
            };
            format!("node '{node}' ({kind}) has no parameter '{param}'; {advice}")
        }
        _ => error.to_string(),
    }
}
