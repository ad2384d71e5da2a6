//! Assignment of planned results to texture sets.

use std::collections::BTreeMap;

use sabi_export::{Channel, MeshMap};
use sabi_graph::FlatGraph;
use sabi_plan::{Plan, PlannedResult, Target};

use crate::baking::maps::SetWork;
use crate::evaluating::texture_sets::TextureSet;
use crate::source::map_output;

/// Finds the planned results that become separate maps in every texture set: outputs of the graph, and maps of the model.
fn own_maps<'p>(
    graph: &FlatGraph,
    plan: &'p Plan,
    mesh_targets: &[(MeshMap, Target)],
) -> Vec<(Channel, &'p PlannedResult)> {
    let of_graph = plan
        .results
        .iter()
        .filter_map(|result| Some((map_output(&graph.nodes[result.target.node])?, result)));
    let of_mesh = mesh_targets.iter().filter_map(|(map, target)| {
        let result = plan.results.iter().find(|result| result.target == *target)?;
        Some((Channel::Mesh(*map), result))
    });
    of_graph.chain(of_mesh).collect()
}

/// Assigns the planned results to the texture sets.
pub(super) fn set_works<'p>(
    graph: &FlatGraph,
    plan: &'p Plan,
    sets: Vec<TextureSet>,
    nodes: &[BTreeMap<u32, usize>],
    mesh_targets: &[(MeshMap, Target)],
) -> Vec<SetWork<'p>> {
    let maps = own_maps(graph, plan, mesh_targets);
    let result = |node: usize| plan.results.iter().find(|result| result.target.node == node);
    let work = |(set, nodes): (TextureSet, &BTreeMap<u32, usize>)| SetWork {
        key: set.key,
        name: set.name,
        materials: nodes
            .iter()
            .filter_map(|(material, node)| Some((*material, result(*node)?)))
            .collect(),
        maps: maps.clone(),
    };
    sets.into_iter().zip(nodes).map(work).collect()
}
