//! Connected pieces of a mesh, and which of them are the same piece in another place.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::sheet::area;
use crate::atlas::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// Largest relative difference between edges of congruent pieces, from rounding of a copy placed elsewhere.
const ALIKE: f64 = 1e-3;

/// Triangles of one material that are connected over edges.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    /// In rising order.
    pub(super) triangles: Vec<u32>,
    /// Vertices in the order in which the triangles name them; of those that differ in neither place nor normal, the first.
    pub(super) vertices: Vec<u32>,
    /// Corners as places in `vertices`.
    pub(super) corners: Vec<u32>,
    /// The first piece that is this one in another place, maybe itself, and how much larger this one is.
    pub(super) like: (usize, f64),
}

/// The pieces in the order of their first triangles with area.
pub(super) fn pieces(mesh: &Mesh) -> Vec<Piece> {
    let topology = Topology::new(mesh);
    let mut piece_of = vec![u32::MAX; mesh.triangles.len()];
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for first in 0..mesh.triangles.len() as u32 {
        if piece_of[first as usize] != u32::MAX || area(mesh, first) <= 0.0 {
            continue;
        }
        let number = groups.len() as u32;
        let mut members = vec![first];
        piece_of[first as usize] = number;
        let mut next = 0;
        while next < members.len() {
            let triangle = members[next];
            next += 1;
            for edge in 3 * triangle..3 * triangle + 3 {
                let twin = topology.twins[edge as usize];
                if twin == NO_TWIN {
                    continue;
                }
                let other = (twin / 3) as usize;
                let alike = mesh.triangle_material[other] == mesh.triangle_material[triangle as usize];
                if alike && piece_of[other] == u32::MAX {
                    piece_of[other] = number;
                    members.push(other as u32);
                }
            }
        }
        members.sort_unstable();
        groups.push(members);
    }
    let first = first_alike(mesh);
    let mut local = vec![u32::MAX; mesh.positions.len()];
    let mut pieces: Vec<Piece> = groups
        .into_iter()
        .map(|triangles| numbered(mesh, triangles, &first, &mut local))
        .collect();
    find_alike(mesh, &topology, &mut pieces);
    pieces
}

/// For each vertex the first one of its place and normal. Hard edges are good places to cut; borders of an older layout,
/// where vertices differ in texture coordinates and tangents alone, are none.
fn first_alike(mesh: &Mesh) -> Vec<u32> {
    // + 0.0 turns −0 into 0.
    let bits = |values: [f32; 3]| values.map(|value| (value + 0.0).to_bits());
    // Without normals, vertices are alike by position alone.
    let normal = |vertex: usize| mesh.normals.get(vertex).copied().unwrap_or_default();
    let mut order: Vec<([u32; 3], [u32; 3], u32)> = mesh
        .positions
        .iter()
        .enumerate()
        .map(|(vertex, &position)| (bits(position), bits(normal(vertex)), vertex as u32))
        .collect();
    order.par_sort_unstable();
    let mut first = vec![0; order.len()];
    for group in order.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        for &(.., vertex) in group {
            first[vertex as usize] = group[0].2;
        }
    }
    first
}

/// Numbers a piece's vertices by their first use; `local` is all unset before and after.
fn numbered(mesh: &Mesh, triangles: Vec<u32>, first: &[u32], local: &mut [u32]) -> Piece {
    let mut vertices = Vec::new();
    let mut corners = Vec::with_capacity(3 * triangles.len());
    let named = triangles.iter().flat_map(|&triangle| mesh.triangles[triangle as usize]);
    for vertex in named.map(|vertex| first[vertex as usize]) {
        let number = &mut local[vertex as usize];
        if *number == u32::MAX {
            *number = vertices.len() as u32;
            vertices.push(vertex);
        }
        corners.push(*number);
    }
    for &vertex in &vertices {
        local[vertex as usize] = u32::MAX;
    }
    Piece {
        triangles,
        vertices,
        corners,
        like: (0, 1.0),
    }
}

/// Finds copies: the same corners in the same order, the same neighbors, and edges of the same lengths up to one factor.
/// Such a piece is flattened the same way, wherever it is.
fn find_alike(mesh: &Mesh, topology: &Topology, pieces: &mut [Piece]) {
    let mut first_of: BTreeMap<[u8; 32], Vec<usize>> = BTreeMap::new();
    for index in 0..pieces.len() {
        let candidates = first_of.entry(connections(&pieces[index], topology)).or_default();
        let lengths = edge_lengths(mesh, &pieces[index]);
        let found = candidates
            .iter()
            .find_map(|&first| Some((first, factor(&edge_lengths(mesh, &pieces[first]), &lengths)?)));
        // A piece without an earlier copy is alike itself.
        pieces[index].like = found.unwrap_or((index, 1.0));
        // A handful of shapes with the same connections is compared, not thousands.
        if found.is_none() && candidates.len() < 16 {
            candidates.push(index);
        }
    }
}

/// Returns a hash of the connectivity of a piece's triangles, in its own numbering.
fn connections(piece: &Piece, topology: &Topology) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(bytemuck::cast_slice(&piece.corners));
    // Neighbors by position, whatever the vertices say.
    let local = |edge: u32| match piece.triangles.binary_search(&(edge / 3)) {
        Ok(triangle) => 3 * triangle as u32 + edge % 3,
        Err(_) => NO_TWIN,
    };
    for &triangle in &piece.triangles {
        for edge in 3 * triangle..3 * triangle + 3 {
            let twin = topology.twins[edge as usize];
            let twin = if twin == NO_TWIN { NO_TWIN } else { local(twin) };
            hasher.update(&twin.to_le_bytes());
        }
    }
    *hasher.finalize().as_bytes()
}

fn edge_lengths(mesh: &Mesh, piece: &Piece) -> Vec<f64> {
    let corner = |vertex: u32| glam::DVec3::from(mesh.positions[vertex as usize].map(f64::from));
    let of_triangle = |&triangle: &u32| {
        let [a, b, c] = mesh.triangles[triangle as usize].map(corner);
        [a.distance(b), b.distance(c), c.distance(a)]
    };
    piece.triangles.iter().flat_map(of_triangle).collect()
}

/// Returns the factor from the first lengths to the second ones; `None` if they differ by more than a factor.
fn factor(from: &[f64], to: &[f64]) -> Option<f64> {
    let (before, after): (f64, f64) = (from.iter().sum(), to.iter().sum());
    let factor = after / before;
    if !(factor.is_finite() && factor > 0.0) {
        return None;
    }
    // Short edges round more than long ones, but by no more than a share of what is usual.
    let usual = after / to.len() as f64;
    let differ = |(from, to): (&f64, &f64)| (from * factor - to).abs() > ALIKE * to.max(usual);
    (!from.iter().zip(to).any(differ)).then_some(factor)
}
