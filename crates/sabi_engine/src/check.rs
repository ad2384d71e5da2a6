//! `sabi check`: everything about a graph that can be known without a model.

use std::path::Path;

use sabi_graph::{FlatGraph, Overrides};
use sabi_plan::{Lengths, Limits, Mode, Planner, Target};

use crate::document::OpenGraph;
use crate::error::EngineError;
use crate::kinds::Kinds;
use crate::source::{OUTPUT_MASK, OUTPUT_MATERIAL};

/// What was found in one graph.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CheckReport {
    /// Number of nodes after groups are inlined.
    pub nodes: usize,
    /// Kernel passes of a bake.
    pub passes: usize,
    /// What is wrong.
    pub errors: Vec<String>,
    /// What has no effect, or is probably not meant.
    pub warnings: Vec<String>,
}

/// Checks a graph file, its groups, its variants and the node kinds it uses.
pub fn check(path: &Path) -> Result<CheckReport, EngineError> {
    let open = OpenGraph::open(path)?;
    let kinds = Kinds::beside(Some(path));
    let errors = kinds.faults.iter().map(ToString::to_string).collect();
    let mut report = CheckReport {
        errors,
        ..CheckReport::default()
    };
    let graph = open.flatten(&Overrides::default())?;
    let planner = planner(&graph, &kinds);
    for error in planner.resolve(&all_nodes(&graph)).errors {
        let found = if error.is_warning() {
            &mut report.warnings
        } else {
            &mut report.errors
        };
        found.push(error.to_string());
    }
    let is_output = |target: &Target| [OUTPUT_MATERIAL, OUTPUT_MASK].contains(&graph.nodes[target.node].kind.as_str());
    let outputs: Vec<Target> = all_nodes(&graph).into_iter().filter(is_output).collect();
    if outputs.is_empty() {
        report.warnings.push(format!(
            "the graph has no output; add a node of kind '{OUTPUT_MATERIAL}'"
        ));
    }
    report.nodes = graph.nodes.len();
    report.passes = planner.plan(&outputs).0.passes();
    for variant in open.document.graph.variants().keys() {
        check_variant(&open, &kinds, variant, &mut report);
    }
    Ok(report)
}

/// What a variant makes wrong that is right without it.
fn check_variant(open: &OpenGraph, kinds: &Kinds, variant: &str, report: &mut CheckReport) {
    let overrides = Overrides {
        variant: Some(variant.to_owned()),
        ..Overrides::default()
    };
    match open.flatten(&overrides) {
        Err(error) => report.errors.extend(error.messages),
        Ok(graph) => {
            let errors = planner(&graph, kinds).resolve(&all_nodes(&graph)).errors.into_iter();
            let known = report.errors.clone();
            let sentences = errors
                .filter(|error| !error.is_warning())
                .map(|error| error.to_string());
            let fresh = sentences.filter(|sentence| !known.contains(sentence));
            report
                .errors
                .extend(fresh.map(|sentence| format!("variant '{variant}': {sentence}")));
        }
    }
}

fn all_nodes(graph: &FlatGraph) -> Vec<Target> {
    (0..graph.nodes.len()).map(|node| Target { node, port: None }).collect()
}

/// A planner for a model that is not there: lengths are as written, and the adapter is a common one.
fn planner<'a>(graph: &'a FlatGraph, kinds: &'a Kinds) -> Planner<'a> {
    Planner {
        graph,
        library: &kinds.library,
        sources: &kinds.sources,
        sinks: &kinds.sinks,
        lengths: Lengths {
            working_from: &|_| 1.0,
            extent: &|_| [0.0, 1.0],
        },
        surface_key: [0; 32],
        mode: Mode::Bake { fuse: true },
        limits: Limits {
            sampled_textures: 16,
            storage_textures: 8,
            ..Limits::default()
        },
    }
}
