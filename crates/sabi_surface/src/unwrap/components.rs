//! Connected components of a mesh, and groups of similar ones: copies that were moved, rotated or scaled.

use sabi_cancel::{CancelableIterator as _, look};
use std::collections::BTreeMap;

use rayon::prelude::*;

use super::area::area;
use crate::atlas::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// Largest relative difference between edges of similar components, from the rounding of copies.
const SIMILARITY_TOLERANCE: f64 = 1e-3;

/// Triangles of one material that are connected over edges.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Component {
    /// In rising order.
    pub(super) triangles: Vec<u32>,
    /// Vertices in the order of their first use by the triangles. Of vertices with equal position and normal, only the first is listed.
    pub(super) vertices: Vec<u32>,
    /// Corners as indices into `vertices`.
    pub(super) corners: Vec<u32>,
    /// First component that is similar to this one, which may be itself, and the scale of this one relative to it.
    pub(super) similar_to: (usize, f64),
}

/// The components in the order of their first triangles with area.
pub(super) fn components(mesh: &Mesh) -> Vec<Component> {
    let topology = Topology::new(mesh);
    let mut component_of = vec![u32::MAX; mesh.triangles.len()];
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for first in (0..mesh.triangles.len() as u32).looking() {
        if component_of[first as usize] != u32::MAX || area(mesh, first) <= 0.0 {
            continue;
        }
        let number = groups.len() as u32;
        let mut members = vec![first];
        component_of[first as usize] = number;
        let mut next = 0;
        while next < members.len() {
            let triangle = members[next];
            next += 1;
            look();
            for edge in 3 * triangle..3 * triangle + 3 {
                let twin = topology.twins[edge as usize];
                if twin == NO_TWIN {
                    continue;
                }
                let other = (twin / 3) as usize;
                let is_same_material = mesh.triangle_material[other] == mesh.triangle_material[triangle as usize];
                if is_same_material && component_of[other] == u32::MAX {
                    component_of[other] = number;
                    members.push(other as u32);
                }
            }
        }
        members.sort_unstable();
        groups.push(members);
    }
    let first = first_equal_vertices(mesh);
    let mut local = vec![u32::MAX; mesh.positions.len()];
    let mut components: Vec<Component> = groups
        .into_iter()
        .map(|triangles| numbered(mesh, triangles, &first, &mut local))
        .collect();
    find_similar(mesh, &topology, &mut components);
    components
}

/// Returns for each vertex the first one with its position and normal. The unwrapper may then cut at hard edges, but not at
/// seams of an earlier layout, where vertices differ only in texture coordinates and tangents.
fn first_equal_vertices(mesh: &Mesh) -> Vec<u32> {
    // Adding 0.0 converts −0 to 0.
    let bits = |values: [f32; 3]| values.map(|value| (value + 0.0).to_bits());
    // Without normals, only positions are compared.
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

/// Numbers a component's vertices by their first use; all entries of `local` are unset before and after.
fn numbered(mesh: &Mesh, triangles: Vec<u32>, first: &[u32], local: &mut [u32]) -> Component {
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
    Component {
        triangles,
        vertices,
        corners,
        similar_to: (0, 1.0),
    }
}

/// Finds similar components: the same corners in the same order, the same neighbors, and edges of the same lengths up to a
/// common scale. Similar components are flattened only once.
fn find_similar(mesh: &Mesh, topology: &Topology, components: &mut [Component]) {
    let mut first_of: BTreeMap<[u8; 32], Vec<usize>> = BTreeMap::new();
    for index in 0..components.len() {
        look();
        let candidates = first_of.entry(connectivity(&components[index], topology)).or_default();
        let lengths = edge_lengths(mesh, &components[index]);
        let found = candidates
            .iter()
            .find_map(|&first| Some((first, scale(&edge_lengths(mesh, &components[first]), &lengths)?)));
        // A component without an earlier similar one is similar to itself.
        components[index].similar_to = found.unwrap_or((index, 1.0));
        // Only a few components with the same connectivity are compared, not thousands.
        if found.is_none() && candidates.len() < 16 {
            candidates.push(index);
        }
    }
}

/// Returns a hash of the connectivity of a component's triangles, in its own numbering.
fn connectivity(component: &Component, topology: &Topology) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(bytemuck::cast_slice(&component.corners));
    // Neighbors are determined by position, since vertices may be split.
    let local = |edge: u32| match component.triangles.binary_search(&(edge / 3)) {
        Ok(triangle) => 3 * triangle as u32 + edge % 3,
        Err(_) => NO_TWIN,
    };
    for &triangle in &component.triangles {
        for edge in 3 * triangle..3 * triangle + 3 {
            let twin = topology.twins[edge as usize];
            let twin = if twin == NO_TWIN { NO_TWIN } else { local(twin) };
            hasher.update(&twin.to_le_bytes());
        }
    }
    *hasher.finalize().as_bytes()
}

fn edge_lengths(mesh: &Mesh, component: &Component) -> Vec<f64> {
    let corner = |vertex: u32| glam::DVec3::from(mesh.positions[vertex as usize].map(f64::from));
    let of_triangle = |&triangle: &u32| {
        let [a, b, c] = mesh.triangles[triangle as usize].map(corner);
        [a.distance(b), b.distance(c), c.distance(a)]
    };
    component.triangles.iter().flat_map(of_triangle).collect()
}

/// Returns the scale from the first lengths to the second ones; `None` if they differ by more than a scale.
fn scale(from: &[f64], to: &[f64]) -> Option<f64> {
    let (before, after): (f64, f64) = (from.iter().sum(), to.iter().sum());
    let scale = after / before;
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    // Relative rounding is larger for short edges, so the differences are compared to the mean length.
    let mean = after / to.len() as f64;
    let differ = |(from, to): (&f64, &f64)| (from * scale - to).abs() > SIMILARITY_TOLERANCE * to.max(mean);
    (!from.iter().zip(to).any(differ)).then_some(scale)
}
