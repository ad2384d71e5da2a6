//! Group instances that cannot be opened are set aside, so that the rest of their graph goes on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use sabi_graph::{FlatGraph, Found, GROUP_KIND, NodeId, NodeRef, Overrides};

use crate::error::EngineError;
use crate::opening::document::OpenGraph;

/// A kind that there is not: what is of it has no result, and what hangs on it waits.
const FAILED_GROUP_KIND: &str = "graph/failed-group";

/// A graph without its groups, as far as they can be opened.
pub(super) struct Ungrouped {
    pub(super) graph: FlatGraph,
    /// Where in it the results of the wanted nodes come from.
    pub(super) found: Vec<Found>,
    /// Why instances were set aside, by their ids.
    pub(super) failed_groups: BTreeMap<String, String>,
}

/// Flattens a graph. Where it cannot be flattened, each instance is opened by itself to find out which ones are to blame.
///
/// # Errors
/// It cannot be flattened without them either.
pub(super) fn open_groups(
    open: &OpenGraph,
    wanted: &[NodeRef],
    files: &mut BTreeSet<PathBuf>,
) -> Result<Ungrouped, EngineError> {
    let plain = Overrides::default();
    let why = match open.flatten_and_list(&plain, wanted, files) {
        Ok((graph, found)) => {
            return Ok(Ungrouped {
                graph,
                found,
                failed_groups: BTreeMap::new(),
            });
        }
        Err(why) => why,
    };
    let nodes = open.document.graph.nodes();
    let instances: BTreeSet<&NodeId> = nodes
        .filter(|(_, node)| node.kind == GROUP_KIND)
        .map(|(id, _)| id)
        .collect();
    let failed_groups: BTreeMap<&NodeId, String> = instances
        .iter()
        .filter_map(|id| {
            let others = instances.iter().filter(|other| *other != id).copied();
            let alone = open.document.with_kind(others, FAILED_GROUP_KIND);
            let (error, _) = open.try_flatten(&alone, &plain, &[], files).err()?;
            Some((*id, error.to_string()))
        })
        .collect();
    let rest = open
        .document
        .with_kind(failed_groups.keys().copied(), FAILED_GROUP_KIND);
    let (graph, found) = open.try_flatten(&rest, &plain, wanted, files).map_err(|_| why)?;
    Ok(Ungrouped {
        graph,
        found,
        failed_groups: failed_groups
            .into_iter()
            .map(|(id, why)| (id.to_string(), why))
            .collect(),
    })
}
