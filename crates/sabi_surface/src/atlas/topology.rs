//! Half-edges of a mesh, paired in space regardless of texture coordinates.

use rayon::prelude::*;
use sabi_cancel::{Cancel, CancelableIterator as _};

use crate::model::Mesh;

/// Twin of a half-edge on a border.
pub const NO_TWIN: u32 = u32::MAX;

/// Connectivity of triangles whose vertices are welded by exact position.
///
/// Half-edge `3 t + k` runs from corner `k` to corner `(k + 1) % 3` of triangle `t`.
pub struct Topology {
    /// Welded vertex of each corner `3 t + k`.
    pub corners: Vec<u32>,
    /// Twin of each half-edge, on the triangle on the other side of the edge, or [`NO_TWIN`]. The relation is always mutual.
    pub twins: Vec<u32>,
    /// Edges with one triangle.
    pub border_edges: u32,
    /// Edges with more than two triangles.
    pub nonmanifold_edges: u32,
}

impl Topology {
    /// Connects the triangles of a mesh.
    pub fn new(mesh: &Mesh) -> Topology {
        let welded = weld(&mesh.positions);
        let corners: Vec<u32> = mesh
            .triangles
            .iter()
            .flatten()
            .map(|&vertex| welded[vertex as usize])
            .collect();
        let mut edges: Vec<(u64, u32)> = Vec::with_capacity(corners.len());
        for (triangle, corner) in corners.chunks_exact(3).enumerate().looking() {
            let [a, b, c] = [corner[0], corner[1], corner[2]];
            // A triangle with two corners at the same position is a line, whose two other edges coincide. It is left out,
            // so that its neighbors become twins.
            if a == b || b == c || c == a {
                continue;
            }
            for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                let key = (u64::from(from.min(to)) << 32) | u64::from(from.max(to));
                edges.push((key, (triangle * 3 + k) as u32));
            }
        }
        let cancel = Cancel::current();
        edges.par_sort_unstable_by(|a, b| {
            cancel.look();
            a.cmp(b)
        });
        let mut topology = Topology {
            twins: vec![NO_TWIN; corners.len()],
            corners,
            border_edges: 0,
            nonmanifold_edges: 0,
        };
        for group in edges.chunk_by(|a, b| a.0 == b.0).looking() {
            match group {
                [_] => topology.border_edges += 1,
                [(_, a), (_, b)] => topology.join(*a, *b),
                many => {
                    topology.nonmanifold_edges += 1;
                    let half_edges: Vec<u32> = many.iter().map(|&(_, edge)| edge).collect();
                    topology.join_unambiguous(mesh, half_edges);
                }
            }
        }
        topology
    }

    fn join(&mut self, a: u32, b: u32) {
        self.twins[a as usize] = b;
        self.twins[b as usize] = a;
    }

    /// Joins half-edges of an edge with more than two triangles if exactly two of them belong to one part, or to one part
    /// and the same vertices, so that two coincident surfaces stay separate.
    fn join_unambiguous(&mut self, mesh: &Mesh, mut half_edges: Vec<u32>) {
        let part = |edge: u32| mesh.triangle_part[edge as usize / 3];
        let vertices = |edge: u32| {
            let triangle = mesh.triangles[edge as usize / 3];
            let (a, b) = (triangle[edge as usize % 3], triangle[(edge as usize % 3 + 1) % 3]);
            (a.min(b), a.max(b))
        };
        half_edges.sort_unstable_by_key(|&edge| (part(edge), vertices(edge), edge));
        for of_part in half_edges.chunk_by(|&a, &b| part(a) == part(b)) {
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

/// Returns for each vertex the first one at the same position.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    // Adding 0.0 converts −0 to 0.
    let mut order: Vec<([u32; 3], u32)> = positions
        .iter()
        .enumerate()
        .map(|(vertex, position)| (position.map(|value| (value + 0.0).to_bits()), vertex as u32))
        .collect();
    let cancel = Cancel::current();
    order.par_sort_unstable_by(|a, b| {
        cancel.look();
        a.cmp(b)
    });
    let mut welded = vec![0; positions.len()];
    for group in order.chunk_by(|a, b| a.0 == b.0).looking() {
        for &(_, vertex) in group {
            welded[vertex as usize] = group[0].1;
        }
    }
    welded
}
