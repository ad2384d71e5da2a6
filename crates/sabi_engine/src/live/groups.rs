//! Flattening of graphs in which some group instances cannot be opened. The rest is evaluated without them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use sabi_files::Refusal;
use sabi_graph::{FlatGraph, GROUP_KIND, NodeId, NodeRef, Overrides, ResultOrigin};

use crate::error::EngineError;
use crate::opening::document::OpenGraph;

/// Unknown kind that replaces a failed instance. Its node has no result, and nodes downstream are blocked.
const FAILED_GROUP_KIND: &str = "graph/failed-group";

/// Flat graph, and the instances that could not be opened.
pub(super) struct OpenedGroups {
    pub(super) graph: FlatGraph,
    /// Node in the flat graph from which each wanted node's result comes.
    pub(super) found: Vec<ResultOrigin>,
    /// Reason of each failed instance, by its id.
    pub(super) failed_groups: BTreeMap<String, String>,
    /// Refusals of group files that may not be opened.
    pub(super) refused: Vec<Refusal>,
}

/// Flattens a graph with the variant of its preview. Where that fails, each instance is opened alone to find those that fail.
///
/// # Errors
/// The graph cannot be flattened without the failed instances either.
pub(super) fn open_groups(
    open: &OpenGraph,
    wanted: &[NodeRef],
    files: &mut BTreeSet<PathBuf>,
) -> Result<OpenedGroups, EngineError> {
    let overrides = Overrides::of_preview(&open.document);
    let why = match open.flatten_and_list(&overrides, wanted, files) {
        Ok((graph, found)) => {
            return Ok(OpenedGroups {
                graph,
                found,
                failed_groups: BTreeMap::new(),
                refused: Vec::new(),
            });
        }
        Err(why) => why,
    };
    let nodes = open.document.graph.nodes();
    let instances: BTreeSet<&NodeId> = nodes
        .filter(|(_, node)| node.kind == GROUP_KIND)
        .map(|(id, _)| id)
        .collect();
    let mut refused = Vec::new();
    let failed_groups: BTreeMap<&NodeId, String> = instances
        .iter()
        .filter_map(|id| {
            let others = instances.iter().filter(|other| *other != id).copied();
            let alone = open.document.with_kind(others, FAILED_GROUP_KIND);
            let (error, class) = open.try_flatten(&alone, &overrides, &[], files).err()?;
            refused.extend(class.refusal.map(|refusal| *refusal));
            Some((*id, error.to_string()))
        })
        .collect();
    let rest = open
        .document
        .with_kind(failed_groups.keys().copied(), FAILED_GROUP_KIND);
    let (graph, found) = open.try_flatten(&rest, &overrides, wanted, files).map_err(|_| why)?;
    Ok(OpenedGroups {
        graph,
        found,
        failed_groups: failed_groups
            .into_iter()
            .map(|(id, why)| (id.to_string(), why))
            .collect(),
        refused,
    })
}
