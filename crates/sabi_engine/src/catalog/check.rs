//! Check of a graph without a model.

use std::path::Path;

use sabi_graph::{FlatGraph, Overrides};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::EngineError;
use crate::evaluating::outputs::{duplicate_map_names, missing_output, outputs};
use crate::opening::document::OpenGraph;
use crate::opening::graph_faults::{explained, planner_without_model, targets, targets_of_all_nodes};
use crate::opening::kinds::Kinds;

/// Result of a check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CheckReport {
    /// Number of nodes after groups are inlined.
    pub nodes: usize,
    /// Kernel passes of a bake.
    pub passes: usize,
    /// Faults.
    pub errors: Vec<String>,
    /// Values without effect, and probable mistakes.
    pub warnings: Vec<String>,
}

/// Result of a check in `sabi check --json`; docs/report.md lists the keys.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CheckedGraph {
    /// Path of the graph as it was given.
    graph: String,
    /// True if there are no errors.
    good: bool,
    /// Number of nodes after groups are inlined.
    nodes: usize,
    /// Kernel passes of a bake.
    passes: usize,
    /// Faults, as sentences.
    errors: Vec<String>,
    /// Values without effect, and probable mistakes, as sentences.
    warnings: Vec<String>,
}

impl CheckedGraph {
    /// Describes the result of checking the graph file at `path`, which is written as it was given.
    pub fn new(path: &Path, report: CheckReport) -> CheckedGraph {
        CheckedGraph {
            graph: path.display().to_string(),
            good: report.errors.is_empty(),
            nodes: report.nodes,
            passes: report.passes,
            errors: report.errors,
            warnings: report.warnings,
        }
    }
}

/// Checks a graph file, its groups, its variants and the node kinds it uses.
pub fn check(path: &Path) -> Result<CheckReport, EngineError> {
    check_graph(&OpenGraph::open(path)?)
}

/// Checks a graph in memory.
pub fn check_graph(open: &OpenGraph) -> Result<CheckReport, EngineError> {
    let kinds = Kinds::beside(Some(&open.path), &open.trusted);
    // A fault in a node file affects only graphs that use the node.
    let mut report = CheckReport {
        warnings: kinds.faults.iter().map(ToString::to_string).collect(),
        ..CheckReport::default()
    };
    report.warnings.extend(open.unknown_keys());
    let graph = open.flatten(&Overrides::default())?;
    let (errors, warnings) = faults(open, &graph, &kinds);
    report.errors.extend(errors);
    report.warnings.extend(warnings);
    report.warnings.extend(missing_output(&graph));
    report.nodes = graph.nodes.len();
    let wanted = targets(outputs(&graph));
    let files = open.file_contents(&graph, &kinds, 0..graph.nodes.len());
    report.passes = planner_without_model(&graph, &kinds, &files).plan(&wanted).0.passes();
    for variant in open.document.graph.variants().keys() {
        check_variant(open, &kinds, variant, &mut report);
    }
    let errors = &report.errors;
    report.warnings.retain(|warning| !errors.contains(warning));
    Ok(report)
}

/// Lists faults and warnings of a flat graph.
fn faults(open: &OpenGraph, graph: &FlatGraph, kinds: &Kinds) -> (Vec<String>, Vec<String>) {
    let files = open.file_contents(graph, kinds, 0..graph.nodes.len());
    let found = planner_without_model(graph, kinds, &files)
        .resolve(&targets_of_all_nodes(graph))
        .errors;
    let mut errors = explained(open, kinds, found.iter().filter(|error| !error.is_warning()));
    let warnings = explained(open, kinds, found.iter().filter(|error| error.is_warning()));
    errors.extend(duplicate_map_names(graph));
    (errors, warnings)
}

/// Lists the faults that a variant adds.
fn check_variant(open: &OpenGraph, kinds: &Kinds, variant: &str, report: &mut CheckReport) {
    let overrides = Overrides {
        variant: Some(variant.to_owned()),
        ..Overrides::default()
    };
    match open.flatten(&overrides) {
        Err(error) => report.errors.extend(error.messages),
        Ok(graph) => {
            let mut fresh = faults(open, &graph, kinds).0;
            fresh.retain(|sentence| !report.errors.contains(sentence));
            let said = fresh.iter().map(|sentence| format!("variant '{variant}': {sentence}"));
            report.errors.extend(said);
        }
    }
}
