//! Lines over the model: its wires and the seams of its maps.

use std::collections::{BTreeMap, BTreeSet};

use bytemuck::{Pod, Zeroable};
use sabi_surface::atlas::Atlas;
use sabi_surface::model::Mesh;

use crate::placement::Placement;

/// The ends of a line, view space.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Line {
    pub(crate) ends: [[f32; 3]; 2],
}

/// Names an edge by where it lies: both triangles beside it say the same.
type EdgeKey = [[u32; 3]; 2];

fn key(mesh: &Mesh, [from, to]: [u32; 2]) -> EdgeKey {
    // Zero has two signs.
    let place = |vertex: u32| mesh.positions[vertex as usize].map(|at| (at + 0.0).to_bits());
    let (a, b) = (place(from), place(to));
    if a <= b { [a, b] } else { [b, a] }
}

fn line(placement: &Placement, ends: EdgeKey) -> Line {
    Line {
        ends: ends.map(|end| placement.view_from_model(end.map(f32::from_bits)).to_array()),
    }
}

fn edges_of_triangle([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Every edge of a mesh once.
pub(crate) fn edges_of(mesh: &Mesh, placement: &Placement) -> Vec<Line> {
    let all = mesh.triangles.iter().flat_map(|triangle| edges_of_triangle(*triangle));
    let keys: BTreeSet<EdgeKey> = all.map(|edge| key(mesh, edge)).collect();
    keys.into_iter().map(|ends| line(placement, ends)).collect()
}

/// The edges at which a chart ends: those beside which the charts differ, or the texture coordinates do.
pub(crate) fn seams_of(mesh: &Mesh, atlas: &Atlas, placement: &Placement) -> Vec<Line> {
    /// Which chart lies beside an edge, and where its ends are on it.
    type Side = (u32, [[u32; 2]; 2]);
    let mut beside: BTreeMap<EdgeKey, Vec<Side>> = BTreeMap::new();
    for (at, triangle) in mesh.triangles.iter().enumerate() {
        let texels = atlas.triangle_texels[at].map(|texel| texel.map(f32::to_bits));
        for (corner, edge) in edges_of_triangle(*triangle).into_iter().enumerate() {
            let key = key(mesh, edge);
            let ends = [texels[corner], texels[(corner + 1) % 3]];
            let is_turned = mesh.positions[edge[0] as usize].map(|at| (at + 0.0).to_bits()) != key[0];
            let ends = if is_turned { [ends[1], ends[0]] } else { ends };
            beside.entry(key).or_default().push((atlas.triangle_chart[at], ends));
        }
    }
    let is_seam = |sides: &Vec<Side>| sides.len() != 2 || sides[0] != sides[1];
    let seams = beside.into_iter().filter(|(_, sides)| is_seam(sides));
    seams.map(|(ends, _)| line(placement, ends)).collect()
}
