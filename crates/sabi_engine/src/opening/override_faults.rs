//! Check of the values that a request sets. A fault that the graph has only with these values is a fault of the
//! request.

use sabi_graph::{FlatGraph, Overrides};
use sabi_plan::{FileContents, PlanError, Problem};

use crate::error::{EngineError, ErrorKind};
use crate::faults::FaultList;
use crate::opening::document::OpenGraph;
use crate::opening::graph_faults::{planner_without_model, targets_of_all_nodes};
use crate::opening::kinds::Kinds;
use crate::opening::setting::read_typed;

/// Refuses values that no node accepts, and names that no node has. A file may contain such values, since it may be of a
/// newer version of Sabi, but a request may not. `graph` is the flat graph with the overrides.
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
    let messages: Vec<String> = fresh.map(|error| open.with_path(sentence(&error))).collect();
    if messages.is_empty() {
        return Ok(());
    }
    Err(EngineError::several(ErrorKind::Usage, messages))
}

/// Maximum number of settings up to which each wrong one is reported.
const MOST_LOOKED_AT: usize = 500;

/// Returns an error with all faults of the values that a request sets. `first` is the first of these faults, with which the
/// graph cannot be flattened. Each name and value is tried separately, and then the remaining ones together.
pub(crate) fn all_override_faults(
    open: &OpenGraph,
    kinds: &Kinds,
    overrides: &Overrides,
    first: EngineError,
) -> EngineError {
    let mut good = Overrides {
        set: Vec::new(),
        ..overrides.clone()
    };
    let mut faults = FaultList::default();
    if let Err(error) = open.flatten(&good) {
        good.variant = None;
        if open.flatten(&good).is_err() {
            // The file is at fault.
            return first;
        }
        faults.add(error);
    }
    // Each check examines the whole graph. Very many settings were written by a program, which needs no list of all faults.
    if overrides.set.len() > MOST_LOOKED_AT {
        return first;
    }
    for setting in &overrides.set {
        good.set.push(setting.clone());
        if let Err(error) = open.flatten(&read_typed(open, kinds, &good)) {
            good.set.pop();
            faults.add(error);
        }
    }
    let typed = read_typed(open, kinds, &good);
    if let Ok(graph) = open.flatten(&typed)
        && let Err(error) = refuse_bad_values(open, &graph, kinds, &typed)
    {
        faults.add(error);
    }
    faults.into_result_of_first().err().unwrap_or(first)
}

fn problems(graph: &FlatGraph, kinds: &Kinds) -> Vec<PlanError> {
    // Faults of files are reported with the other faults of the graph.
    let files = FileContents::new();
    planner_without_model(graph, kinds, &files)
        .resolve(&targets_of_all_nodes(graph))
        .errors
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
