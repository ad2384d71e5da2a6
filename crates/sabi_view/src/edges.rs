//! Lines over the model: its wires and the seams of its maps.

use rayon::prelude::*;
use sabi_nodes::wgsl_struct;
use sabi_surface::atlas::Atlas;
use sabi_surface::displace::DisplacedMesh;
use sabi_surface::model::Mesh;

use crate::placement::Placement;

wgsl_struct! {
    vertex "view/lines" Line:
    /// The ends of a line, view space.
    pub(crate) struct Line {
        pub(crate) first: [f32; 3],
        pub(crate) second: [f32; 3],
    }
}

/// Half-edge: an edge of one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct HalfEdge {
    /// Bits of the positions of its ends in model units, the smaller position first, so that both half-edges of an edge
    /// have the same value.
    ends: [[u32; 3]; 2],
    /// Number of its chart in UV.
    uv_chart: u32,
    /// Bits of the texture coordinates of its ends.
    uvs: [[u32; 2]; 2],
}

impl HalfEdge {
    fn new(ends: [[f32; 3]; 2], uv_chart: u32, uvs: [[f32; 2]; 2]) -> HalfEdge {
        // Adding 0 turns −0 into 0, so that equal positions have equal bits.
        let [a, b] = ends.map(|end| end.map(|at| (at + 0.0).to_bits()));
        let [of_a, of_b] = uvs.map(|uv| uv.map(f32::to_bits));
        let (ends, uvs) = if a <= b {
            ([a, b], [of_a, of_b])
        } else {
            ([b, a], [of_b, of_a])
        };
        HalfEdge { ends, uv_chart, uvs }
    }

    fn line(&self, placement: &Placement) -> Line {
        let [first, second] = self
            .ends
            .map(|end| placement.view_from_model(end.map(f32::from_bits)).to_array());
        Line { first, second }
    }
}

/// Half-edges of a mesh.
pub(crate) fn half_edges(mesh: &Mesh, atlas: &Atlas) -> Vec<HalfEdge> {
    let half_edge = |triangle: usize, corner: usize| {
        let corners = [corner, (corner + 1) % 3];
        HalfEdge::new(
            corners.map(|corner| mesh.positions[mesh.triangles[triangle][corner] as usize]),
            atlas.uv_chart(triangle),
            corners.map(|corner| mesh.uvs[mesh.triangles[triangle][corner] as usize]),
        )
    };
    let triangles = 0..mesh.triangles.len();
    triangles
        .flat_map(|triangle| [0, 1, 2].map(|corner| half_edge(triangle, corner)))
        .collect()
}

/// Half-edges of a displaced mesh along the edges of the original mesh. Edges that subdivide a triangle of the original are
/// left out.
pub(crate) fn displaced_half_edges(displaced: &DisplacedMesh, atlas: &Atlas) -> Vec<HalfEdge> {
    let mut half_edges = Vec::new();
    let mut edges: Vec<[u32; 2]> = Vec::new();
    let mut first = 0;
    for same in displaced.triangle_from.chunk_by(|a, b| a == b) {
        let uv_chart = atlas.uv_chart(same[0] as usize);
        edges.clear();
        for [a, b, c] in &displaced.triangles[first..first + same.len()] {
            edges.extend([[a, b], [b, c], [c, a]].map(|[from, to]| [*from.min(to), *from.max(to)]));
        }
        first += same.len();
        edges.sort_unstable();
        // Edges inside an original triangle are shared by two of the triangles into which it was cut.
        let outer = edges.chunk_by(|a, b| a == b).filter(|shared| shared.len() == 1);
        half_edges.extend(outer.map(|shared| {
            let ends = shared[0].map(|end| end as usize);
            HalfEdge::new(
                ends.map(|end| displaced.positions[end]),
                uv_chart,
                ends.map(|end| displaced.uvs[end]),
            )
        }));
    }
    half_edges
}

/// Returns lines along all edges and lines along the seams. A seam is an edge at which charts or texture coordinates differ
/// or the surface ends.
pub(crate) fn lines(mut half_edges: Vec<HalfEdge>, placement: &Placement) -> [Vec<Line>; 2] {
    half_edges.par_sort_unstable();
    let edges = half_edges.chunk_by(|a, b| a.ends == b.ends);
    let seams = edges.clone().filter(|edge| edge.len() != 2 || edge[0] != edge[1]);
    let line = |half_edges: &[HalfEdge]| half_edges[0].line(placement);
    [edges.map(line).collect(), seams.map(line).collect()]
}
