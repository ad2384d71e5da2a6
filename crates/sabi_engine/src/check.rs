//! `sabi check`: everything about a graph that can be known without a model.

use std::path::Path;

use sabi_graph::Overrides;
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
    let mut report = CheckReport {
        errors: kinds.faults.iter().map(ToString::to_string).collect(),
        ..Default::default()
    };
    let graph = open.flatten(&Overrides::default())?;
    let planner = Planner {
        graph: &graph,
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
    };
    let all: Vec<Target> = (0..graph.nodes.len()).map(|node| Target { node, port: None }).collect();
    for error in planner.resolve(&all).errors {
        if error.is_warning() {
            report.warnings.push(error.to_string())
        } else {
            report.errors.push(error.to_string())
        }
    }
    let is_output = |target: &Target| [OUTPUT_MATERIAL, OUTPUT_MASK].contains(&graph.nodes[target.node].kind.as_str());
    let outputs: Vec<Target> = all.into_iter().filter(is_output).collect();
    if outputs.is_empty() {
        report.warnings.push(format!(
            "the graph has no output; add a node of kind '{OUTPUT_MATERIAL}'"
        ));
    }
    report.nodes = graph.nodes.len();
    report.passes = planner.plan(&outputs).0.passes();
    for variant in open.document.graph.variants().keys() {
        let overrides = Overrides {
            variant: Some(variant.clone()),
            ..Overrides::default()
        };
        match open.flatten(&overrides) {
            Err(error) => report.errors.extend(error.messages),
            Ok(varied) => {
                let planner = Planner {
                    graph: &varied,
                    ..planner
                };
                let all: Vec<Target> = (0..varied.nodes.len())
                    .map(|node| Target { node, port: None })
                    .collect();
                let known = report.errors.clone();
                let errors = planner
                    .resolve(&all)
                    .errors
                    .into_iter()
                    .filter(|error| !error.is_warning());
                let fresh = errors
                    .map(|error| error.to_string())
                    .filter(|error| !known.contains(error));
                report
                    .errors
                    .extend(fresh.map(|error| format!("variant '{variant}': {error}")));
            }
        }
    }
    Ok(report)
}
