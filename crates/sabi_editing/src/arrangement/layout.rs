//! Layout of nodes from left to right. The nodes of a frame stay together.

use std::collections::BTreeMap;

use sabi_graph::NodeId;

use super::layered_drawing::{self, LayoutBox};
use crate::frames::{FRAME_AROUND, FRAME_STRIP};
use crate::node_size::GRID;
use crate::open_document::OpenDocument;
use crate::{arrangement, connections, node_size};

/// Nodes that are placed as a unit: the nodes of a frame, or a single node.
struct Cluster {
    /// Node ids, sorted.
    ids: Vec<NodeId>,
    /// Upper left corner of each node, relative to the corner of the cluster.
    places: Vec<[f32; 2]>,
    size: [f32; 2],
}

/// Lays out the selected nodes from left to right, or all nodes if none is selected.
pub fn lay_out(document: &mut OpenDocument) -> bool {
    let ids: Vec<NodeId> = match document.selection().is_empty() {
        true => document.graph().ids().cloned().collect(),
        false => document.selection().iter().cloned().collect(),
    };
    let at = |id: &NodeId| document.node(id).map_or([0.0; 2], |node| node.pos);
    let corner = ids.iter().map(at).fold([f32::INFINITY; 2], |corner, pos| {
        [corner[0].min(pos[0]), corner[1].min(pos[1])]
    });
    let clusters = clusters(document, &ids);
    let reads = reads_of(document, &clusters);
    // Frames that read each other cannot be ordered. In that case every node is a cluster of its own.
    let (clusters, reads) = match layered_drawing::order_of(&reads) {
        Some(_) => (clusters, reads),
        None => {
            let single: Vec<Cluster> = ids
                .iter()
                .map(|id| cluster(document, vec![id.clone()], false))
                .collect();
            let reads = reads_of(document, &single);
            (single, reads)
        }
    };
    let boxes: Vec<LayoutBox> = clusters
        .iter()
        .zip(reads)
        .map(|(cluster, reads)| LayoutBox {
            width: cluster.size[0],
            height: cluster.size[1],
            reads,
        })
        .collect();
    let snapped = |at: f32| (at / GRID).round() * GRID;
    let mut places = BTreeMap::new();
    for (cluster, [x, y]) in clusters.iter().zip(layered_drawing::lay_out(&boxes)) {
        for (id, [inner_x, inner_y]) in cluster.ids.iter().zip(&cluster.places) {
            let place = [snapped(corner[0] + x + inner_x), snapped(corner[1] + y + inner_y)];
            places.insert(id.clone(), place);
        }
    }
    arrangement::move_nodes(document, "Lay out", places)
}

/// Clusters of the nodes of each frame, and of single nodes. A node in several frames belongs to the first one.
fn clusters(document: &OpenDocument, ids: &[NodeId]) -> Vec<Cluster> {
    let mut rest: Vec<NodeId> = ids.to_vec();
    let mut clusters = Vec::new();
    for frame in document.graph().frames().values() {
        let (inside, outside): (Vec<NodeId>, Vec<NodeId>) = rest.into_iter().partition(|id| frame.nodes.contains(id));
        rest = outside;
        if !inside.is_empty() {
            clusters.push(cluster(document, inside, true));
        }
    }
    clusters.extend(rest.into_iter().map(|id| cluster(document, vec![id], false)));
    clusters
}

fn cluster(document: &OpenDocument, ids: Vec<NodeId>, is_framed: bool) -> Cluster {
    let boxes: Vec<LayoutBox> = ids
        .iter()
        .map(|id| {
            let [width, height] = node_size::of(document, id);
            let sources = connections::sources(document, id);
            let reads = sources.iter().filter_map(|from| ids.binary_search(from).ok());
            LayoutBox {
                width,
                height,
                reads: reads.collect(),
            }
        })
        .collect();
    let mut places = layered_drawing::lay_out(&boxes);
    let ends = places
        .iter()
        .zip(&boxes)
        .map(|(place, boxed)| [place[0] + boxed.width, place[1] + boxed.height]);
    let mut size = ends.fold([0.0; 2], |size: [f32; 2], end| {
        [size[0].max(end[0]), size[1].max(end[1])]
    });
    if is_framed {
        let above = FRAME_AROUND + FRAME_STRIP;
        for place in &mut places {
            *place = [place[0] + FRAME_AROUND, place[1] + above];
        }
        size = [size[0] + 2.0 * FRAME_AROUND, size[1] + FRAME_AROUND + above];
    }
    Cluster { ids, places, size }
}

/// Other clusters that each cluster reads, by index.
fn reads_of(document: &OpenDocument, clusters: &[Cluster]) -> Vec<Vec<usize>> {
    let owners = clusters
        .iter()
        .enumerate()
        .flat_map(|(at, cluster)| cluster.ids.iter().map(move |id| (id, at)));
    let owner_of: BTreeMap<&NodeId, usize> = owners.collect();
    let reads = clusters.iter().enumerate().map(|(at, cluster)| {
        let sources = cluster.ids.iter().flat_map(|id| connections::sources(document, id));
        let mut reads: Vec<usize> = sources.filter_map(|from| owner_of.get(&from).copied()).collect();
        reads.retain(|from| *from != at);
        reads.sort_unstable();
        reads.dedup();
        reads
    });
    reads.collect()
}
