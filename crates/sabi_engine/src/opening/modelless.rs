//! What can be known of a graph before there is a model.

use sabi_graph::FlatGraph;
use sabi_plan::{FileContents, Lengths, Limits, Mode, Plan, PlanError, Planner, Problem, Target};

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;

/// A planner for a model that is not there: lengths are as written, and the adapter is a common one.
pub(crate) fn planner<'a>(graph: &'a FlatGraph, kinds: &'a Kinds, files: &'a FileContents) -> Planner<'a> {
    Planner {
        graph,
        library: &kinds.library,
        sources: &kinds.sources,
        sinks: &kinds.sinks,
        files,
        lengths: Lengths {
            working_from: &|_| 1.0,
            extent: &|_| [0.0, 1.0],
        },
        levels: &[0.001],
        surface_key: [0; 32],
        mode: Mode::Bake { fuse: true },
        most_rays: None,
        limits: Limits {
            sampled_textures: 16,
            storage_textures: 8,
            ..Limits::default()
        },
    }
}

/// Every node's first result.
pub(crate) fn all_nodes(graph: &FlatGraph) -> Vec<Target> {
    targets(0..graph.nodes.len())
}

/// The first results of nodes.
pub(crate) fn targets(nodes: impl IntoIterator<Item = usize>) -> Vec<Target> {
    nodes.into_iter().map(|node| Target { node, port: None }).collect()
}

/// An error as sentences: where a kind is unknown because its file has faults, those too.
pub(crate) fn explained(open: &OpenGraph, kinds: &Kinds, error: &PlanError) -> Vec<String> {
    let faults: Vec<String> = match error.problem {
        Problem::UnknownKind { .. } => kinds.faults_of(&error.kind).map(ToString::to_string).collect(),
        _ => Vec::new(),
    };
    if faults.is_empty() {
        return vec![open.pointed(error, error)];
    }
    let sentence = format!(
        "node '{}' is of kind '{}', whose file has a fault:",
        error.node, error.kind
    );
    std::iter::once(open.pointed(error, sentence)).chain(faults).collect()
}

/// Who can mend these errors.
fn kind_of(errors: &[PlanError]) -> ErrorKind {
    let all = |is: fn(&Problem) -> bool| errors.iter().all(|error| is(&error.problem));
    if all(|problem| matches!(problem, Problem::NoSuchResult { .. })) {
        // A result that is not there was asked for by name; the file is not to blame.
        ErrorKind::Usage
    } else if all(|problem| matches!(problem, Problem::BadFile(fault) if fault.is_missing)) {
        ErrorKind::MissingInput
    } else {
        ErrorKind::BadInput
    }
}

/// Refuses a graph in which something that the targets need is at fault, with a sentence for each fault. Gives the plan
/// as it would be without a model.
pub(crate) fn refuse_faults(
    open: &OpenGraph,
    graph: &FlatGraph,
    kinds: &Kinds,
    targets: &[Target],
) -> Result<Plan, EngineError> {
    let wanted: Vec<usize> = targets.iter().map(|target| target.node).collect();
    let files = open.file_contents(graph, kinds, graph.upstream(&wanted));
    let (plan, mut errors) = planner(graph, kinds, &files).plan(targets);
    errors.retain(|error| !error.is_warning());
    if errors.is_empty() {
        return Ok(plan);
    }
    let messages = errors.iter().flat_map(|error| explained(open, kinds, error)).collect();
    Err(EngineError::several(kind_of(&errors), messages).caused_by(errors.swap_remove(0)))
}
