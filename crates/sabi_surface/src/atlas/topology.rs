//! Triangles that meet at an edge in space, regardless of their texture coordinates.

use rayon::prelude::*;

use crate::model::Mesh;

/// No triangle on the other side of an edge.
pub(crate) const NO_TWIN: u32 = u32::MAX;

/// Triangles welded by exact position.
///
/// Edge `3 t + k` runs from corner `k` to corner `(k + 1) % 3` of triangle `t`.
pub(crate) struct Topology {
    /// Welded vertex of each corner `3 t + k`.
    pub(crate) corners: Vec<u32>,
    /// For each edge the same edge of the triangle on the other side, or [`NO_TWIN`]. Always mutual.
    pub(crate) twins: Vec<u32>,
    /// Edges with one triangle.
    pub(crate) border_edges: u32,
    /// Edges with more than two triangles.
    pub(crate) nonmanifold_edges: u32,
}

impl Topology {
    pub(crate) fn new(mesh: &Mesh) -> Topology {
        let welded = weld(&mesh.positions);
        let corners: Vec<u32> = mesh
            .triangles
            .iter()
            .flatten()
            .map(|&vertex| welded[vertex as usize])
            .collect();
        let mut edges: Vec<(u64, u32)> = Vec::with_capacity(corners.len());
        for (triangle, corner) in corners.chunks_exact(3).enumerate() {
            let [a, b, c] = [corner[0], corner[1], corner[2]];
            // Two corners in one place: the triangle is a line, and its two other edges are one. Left out, its
            // neighbors meet each other there.
            if a == b || b == c || c == a {
                continue;
            }
            for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                let key = (u64::from(from.min(to)) << 32) | u64::from(from.max(to));
                edges.push((key, (triangle * 3 + k) as u32));
            }
        }
        edges.par_sort_unstable();
        let mut topology = Topology {
            twins: vec![NO_TWIN; corners.len()],
            corners,
            border_edges: 0,
            nonmanifold_edges: 0,
        };
        for group in edges.chunk_by(|a, b| a.0 == b.0) {
            match group {
                [_] => topology.border_edges += 1,
                [(_, a), (_, b)] => topology.join(*a, *b),
                crowd => {
                    topology.nonmanifold_edges += 1;
                    let crowd: Vec<u32> = crowd.iter().map(|&(_, edge)| edge).collect();
                    topology.join_lone_pairs(mesh, crowd);
                }
            }
        }
        topology
    }

    fn join(&mut self, a: u32, b: u32) {
        self.twins[a as usize] = b;
        self.twins[b as usize] = a;
    }

    /// Of many triangles at one edge, joins those that are alone to two in their part, or alone to two in using the
    /// same vertices: two sheets that lie on one another stay two sheets.
    fn join_lone_pairs(&mut self, mesh: &Mesh, mut crowd: Vec<u32>) {
        let part = |edge: u32| mesh.triangle_part[edge as usize / 3];
        let vertices = |edge: u32| {
            let triangle = mesh.triangles[edge as usize / 3];
            let (a, b) = (triangle[edge as usize % 3], triangle[(edge as usize % 3 + 1) % 3]);
            (a.min(b), a.max(b))
        };
        crowd.sort_unstable_by_key(|&edge| (part(edge), vertices(edge), edge));
        for of_part in crowd.chunk_by(|&a, &b| part(a) == part(b)) {
            if let [a, b] = *of_part {
                self.join(a, b);
                continue;
            }
            for of_vertices in of_part.chunk_by(|&a, &b| vertices(a) == vertices(b)) {
                if let [a, b] = *of_vertices {
                    self.join(a, b);
                }
            }
        }
    }
}

/// Number of the first vertex at the same place, for each vertex.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    // + 0.0 turns −0 into 0.
    let mut order: Vec<([u32; 3], u32)> = positions
        .iter()
        .enumerate()
        .map(|(vertex, position)| (position.map(|value| (value + 0.0).to_bits()), vertex as u32))
        .collect();
    order.par_sort_unstable();
    let mut welded = vec![0; positions.len()];
    for group in order.chunk_by(|a, b| a.0 == b.0) {
        for &(_, vertex) in group {
            welded[vertex as usize] = group[0].1;
        }
    }
    welded
}
