//! Planning of a graph without a model, to find its faults.

use sabi_graph::{FlatGraph, Locator};
use sabi_plan::{
    FileContents, FileFaultKind, Lengths, LevelWidths, Limits, Mode, Plan, PlanError, Planner, Problem, Target,
};

use crate::error::{EngineError, ErrorKind, shorten};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::remedy::Remedy;

/// Creates a planner without a model: lengths are taken as written, and the limits are those of common adapters.
pub(crate) fn planner_without_model<'a>(
    graph: &'a FlatGraph,
    kinds: &'a Kinds,
    files: &'a FileContents,
) -> Planner<'a> {
    Planner {
        graph,
        library: &kinds.library,
        sources: &kinds.sources,
        sinks: &kinds.sinks,
        files,
        lengths: Lengths {
            working_from: &|_| 1.0,
            largest_piece: 1.0,
            extent: &|_| [0.0, 1.0],
        },
        level_widths: LevelWidths::of_texels(0.001, 0),
        surface_key: [0; 32],
        mode: Mode::Bake { fuse: true },
        most_rays: None,
        limits: Limits {
            sampled_textures: 16,
            storage_textures: 9,
            ..Limits::default()
        },
    }
}

/// Lists the first result of every node.
pub(crate) fn targets_of_all_nodes(graph: &FlatGraph) -> Vec<Target> {
    targets(0..graph.nodes.len())
}

/// Lists the first results of nodes.
pub(crate) fn targets(nodes: impl IntoIterator<Item = usize>) -> Vec<Target> {
    nodes.into_iter().map(|node| Target { node, port: None }).collect()
}

/// Explains an error in sentences. If a kind is unknown because of faults in its file, includes these faults.
fn explain(open: &OpenGraph, locator: &Locator<'_>, kinds: &Kinds, error: &PlanError) -> Vec<String> {
    let faults: Vec<String> = match error.problem {
        Problem::UnknownKind { .. } => kinds.faults_of(&error.kind).map(ToString::to_string).collect(),
        _ => Vec::new(),
    };
    if faults.is_empty() {
        return vec![open.with_position(locator, error, error)];
    }
    let sentence = format!(
        "node '{}' is of kind '{}', whose file has a fault:",
        error.node, error.kind
    );
    std::iter::once(open.with_position(locator, error, sentence))
        .chain(faults)
        .collect()
}

/// Maximum number of errors of a graph that are explained, since the position of each is found by counting from the beginning of the text.
const MOST_EXPLAINED: usize = 100;

/// Explains errors in sentences; only some of them if there are very many.
pub(crate) fn explained<'e>(
    open: &OpenGraph,
    kinds: &Kinds,
    errors: impl Iterator<Item = &'e PlanError>,
) -> Vec<String> {
    let mut errors = errors.fuse();
    let first: Vec<&PlanError> = errors.by_ref().take(MOST_EXPLAINED).collect();
    if first.is_empty() {
        return Vec::new();
    }
    let locator = open.locator();
    let mut sentences: Vec<String> = first
        .into_iter()
        .flat_map(|error| explain(open, &locator, kinds, error))
        .collect();
    sentences.iter_mut().for_each(shorten);
    let more = errors.count();
    sentences.extend((more > 0).then(|| open.with_path(format!("{more} more faults of this kind are left out"))));
    sentences
}

/// Classifies errors of a plan.
fn kind_of(errors: &[PlanError]) -> ErrorKind {
    let all = |is: fn(&Problem) -> bool| errors.iter().all(|error| is(&error.problem));
    if all(|problem| matches!(problem, Problem::NoSuchResult { .. })) {
        // The missing result was requested by name, so the file is not at fault.
        ErrorKind::Usage
    } else if all(|problem| matches!(problem, Problem::BadFile(fault) if is_out_of_reach(fault.kind))) {
        ErrorKind::MissingInput
    } else {
        ErrorKind::BadInput
    }
}

/// Returns true for the fault of a file that was not opened.
fn is_out_of_reach(kind: FileFaultKind) -> bool {
    match kind {
        FileFaultKind::Missing | FileFaultKind::Refused | FileFaultKind::NeverOpened => true,
        FileFaultKind::Unusable | FileFaultKind::TooLarge => false,
    }
}

/// Remedies of faults.
pub(crate) fn remedies_of(errors: &[PlanError]) -> Option<Remedy> {
    let is_there = |kind: FileFaultKind| {
        let is_it = |error: &PlanError| matches!(&error.problem, Problem::BadFile(fault) if fault.kind == kind);
        errors.iter().any(is_it)
    };
    if is_there(FileFaultKind::Refused) {
        Some(Remedy::TrustFile)
    } else {
        is_there(FileFaultKind::TooLarge).then_some(Remedy::RaiseMemory)
    }
}

/// Refuses a graph with faults on which the targets depend, with a sentence for each. Returns the plan without a model.
pub(crate) fn refuse_faults(
    open: &OpenGraph,
    graph: &FlatGraph,
    kinds: &Kinds,
    targets: &[Target],
) -> Result<Plan, EngineError> {
    let wanted: Vec<usize> = targets.iter().map(|target| target.node).collect();
    let files = open.file_contents(graph, kinds, graph.upstream(&wanted));
    let (plan, mut errors) = planner_without_model(graph, kinds, &files).plan(targets);
    errors.retain(|error| !error.is_warning());
    if errors.is_empty() {
        return Ok(plan);
    }
    let messages = explained(open, kinds, errors.iter());
    let refused = EngineError::several(kind_of(&errors), messages).with_remedies(remedies_of(&errors));
    Err(refused.caused_by(errors.swap_remove(0)))
}
