//! Charts: triangles connected through edges that are not seams in UV.

use super::topology::{NO_TWIN, Topology};
use crate::groups::Groups;
use crate::model::Mesh;
use sabi_cancel::CancelableIterator as _;

/// Assignment of triangles to charts, which are numbered by material, then by first triangle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Partition {
    /// Chart of each triangle.
    pub(super) triangle_chart: Vec<u32>,
    /// Triangles of each chart.
    charts: Groups,
}

/// Returns the sheet of a chart's triangles: their material, or 0 where all materials share one.
pub(super) fn sheet_of(mesh: &Mesh, triangles: &[u32]) -> u32 {
    if mesh.is_one_sheet {
        0
    } else {
        mesh.triangle_material[triangles[0] as usize]
    }
}

impl Partition {
    /// Creates charts of the triangles with equal labels.
    pub(super) fn from_labels(mesh: &Mesh, labels: &[u32]) -> Partition {
        // First triangle of each label; the list is empty without labels.
        let mut first = vec![u32::MAX; labels.iter().map(|&label| label as usize + 1).max().unwrap_or(0)];
        for (triangle, &label) in labels.iter().enumerate() {
            let first = &mut first[label as usize];
            *first = (*first).min(triangle as u32);
        }
        let mut order: Vec<(u32, u32, u32)> = first
            .iter()
            .enumerate()
            .filter(|&(_, &first)| first != u32::MAX)
            .map(|(label, &first)| (mesh.triangle_material[first as usize], first, label as u32))
            .collect();
        order.sort_unstable();
        let mut chart_of_label = vec![0; first.len()];
        for (chart, &(_, _, label)) in order.iter().enumerate() {
            chart_of_label[label as usize] = chart as u32;
        }
        Partition::numbered(
            labels.iter().map(|&label| chart_of_label[label as usize]).collect(),
            order.len(),
        )
    }

    /// Creates charts from the chart number of each triangle.
    pub(super) fn numbered(triangle_chart: Vec<u32>, charts: usize) -> Partition {
        Partition {
            charts: Groups::of_each(&triangle_chart, charts),
            triangle_chart,
        }
    }

    /// Number of charts.
    pub(super) fn len(&self) -> usize {
        self.charts.count()
    }

    /// Returns the triangles of a chart in ascending order.
    pub(super) fn triangles(&self, chart: usize) -> &[u32] {
        self.charts.members(chart)
    }
}

/// Finds the charts of a mesh. Charts that overlap themselves are not split yet.
pub(super) fn partition(mesh: &Mesh, topology: &Topology, orientations: &[i8]) -> Partition {
    let mut sets = OrientedDisjointSets::new(orientations);
    // Triangles without area in UV are joined last. They never join charts of opposite winding.
    for with_flat in [false, true] {
        for (edge, &twin) in topology.twins.iter().enumerate().looking() {
            if twin == NO_TWIN || (twin as usize) < edge {
                continue;
            }
            let (a, b) = (edge / 3, twin as usize / 3);
            let flat = orientations[a] == 0 || orientations[b] == 0;
            if flat == with_flat && !is_seam(mesh, topology, edge as u32, twin) {
                sets.join(a as u32, b as u32);
            }
        }
    }
    let labels: Vec<u32> = (0..mesh.triangles.len() as u32)
        .looking()
        .map(|triangle| sets.find(triangle))
        .collect();
    Partition::from_labels(mesh, &labels)
}

/// Returns true if the two triangles at an edge differ in its texture coordinates or in their material.
pub(crate) fn is_seam(mesh: &Mesh, topology: &Topology, edge: u32, twin: u32) -> bool {
    let (a, b) = (edge as usize / 3, twin as usize / 3);
    if mesh.triangle_material[a] != mesh.triangle_material[b] {
        return true;
    }
    let ends = |edge: u32| [edge, edge / 3 * 3 + (edge + 1 - edge / 3 * 3) % 3];
    let [a0, a1] = ends(edge);
    let [mut b0, mut b1] = ends(twin);
    if topology.corners[a0 as usize] != topology.corners[b0 as usize] {
        std::mem::swap(&mut b0, &mut b1);
    }
    let uv = |corner: u32| mesh.uvs[mesh.triangles[corner as usize / 3][corner as usize % 3] as usize];
    // NaN differs from itself, so an edge with NaN coordinates is a seam.
    uv(a0) != uv(b0) || uv(a1) != uv(b1)
}

/// Disjoint sets of triangles. Triangles of opposite winding in UV are never in one set.
struct OrientedDisjointSets {
    parents: Vec<u32>,
    orientations: Vec<i8>,
}

impl OrientedDisjointSets {
    fn new(orientations: &[i8]) -> OrientedDisjointSets {
        OrientedDisjointSets {
            parents: (0..orientations.len() as u32).collect(),
            orientations: orientations.to_vec(),
        }
    }

    fn find(&mut self, mut triangle: u32) -> u32 {
        while self.parents[triangle as usize] != triangle {
            let above = self.parents[self.parents[triangle as usize] as usize];
            self.parents[triangle as usize] = above;
            triangle = above;
        }
        triangle
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        let (low, high) = (a.min(b) as usize, a.max(b) as usize);
        let ways = (self.orientations[low], self.orientations[high]);
        if low == high || (ways.0 != ways.1 && ways.0 != 0 && ways.1 != 0) {
            return;
        }
        self.parents[high] = low as u32;
        self.orientations[low] = if ways.0 != 0 { ways.0 } else { ways.1 };
    }
}
