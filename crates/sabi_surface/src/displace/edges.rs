//! Hard edges of a mesh, and a search for those near a place.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::model::Mesh;

/// Cosine of the angle between shading normals, 15°, from which an edge is hard. At smaller angles, sinking faces overlap
/// each other by an invisible amount.
const HARD: f64 = 0.966;
/// Cosine of the angle, 30°, up to which a normal is considered the normal of a side of an edge.
const SAME_SIDE: f64 = 0.866;
/// Maximum slope at which a place may leave the plane of a side and still count as on it.
const ON_PLANE: f64 = 0.3;
/// Maximum number of cells along the largest side of a mesh.
const MOST_CELLS: f64 = 512.0;

/// One side of a hard edge.
pub(super) struct HardEdgeSide {
    ends: [DVec3; 2],
    /// Shading normal of this side, unit length.
    normal: DVec3,
    /// Direction from the edge into this side, unit length.
    inward: DVec3,
    /// Shading normal of the other side, unit length.
    pub(super) other: DVec3,
}

impl HardEdgeSide {
    /// Returns the distance from a place on this side to the edge, and a factor from 0 to 1 that falls off past the ends of
    /// the edge; `None` if the place is not on this side.
    pub(super) fn beside(&self, at: DVec3, normal: DVec3) -> Option<(f64, f64)> {
        if normal.dot(self.normal) < SAME_SIDE {
            return None;
        }
        let [from, to] = self.ends;
        let along = to - from;
        let share = ((at - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let away = at - (from + along * share);
        let distance = away.length();
        if distance <= along.length() * 1e-6 {
            return Some((distance, 1.0));
        }
        let beside = away.dot(self.inward) / distance;
        let is_on_plane = away.dot(self.normal).abs() <= ON_PLANE * distance;
        (is_on_plane && beside > 0.0).then(|| (distance, beside.min(1.0)))
    }
}

type Cell = [i32; 3];

/// The sides of all hard edges, stored in the cells of a grid that are within reach.
pub(super) struct HardEdges {
    sides: Vec<HardEdgeSide>,
    cell_size: f64,
    /// Sides within reach of any place of a cell.
    cells: HashMap<Cell, Vec<u32>>,
}

impl HardEdges {
    /// Finds the edges between faces whose shading normals differ sharply, for queries within `reach`, in model units. An
    /// edge of more than two faces does not count, since its sides have no order.
    pub(super) fn find(mesh: &Mesh, reach: f64) -> HardEdges {
        let sides = sides(mesh);
        let largest = mesh
            .triangles
            .iter()
            .flatten()
            .flat_map(|&vertex| mesh.positions[vertex as usize])
            .fold(0.0, |largest: f64, value| largest.max(f64::from(value.abs())));
        // A segment is entered in the cells around sample points on it that are half a cell apart, so that no point of it
        // is farther than a quarter cell from a sample.
        let cell_size = (reach * 4.0 / 3.0)
            .max(largest * 2.0 / MOST_CELLS)
            .max(f64::MIN_POSITIVE);
        let mut entries: Vec<(Cell, u32)> = (0..sides.len())
            .into_par_iter()
            .flat_map_iter(|number| cells_of(&sides[number], cell_size, number as u32))
            .collect();
        entries.par_sort_unstable();
        entries.dedup();
        let cells = entries
            .chunk_by(|a, b| a.0 == b.0)
            .map(|run| (run[0].0, run.iter().map(|(_, side)| *side).collect()))
            .collect();
        HardEdges {
            sides,
            cell_size,
            cells,
        }
    }

    /// Returns the sides that may be within reach of a place, in a fixed order.
    pub(super) fn near(&self, at: DVec3) -> impl Iterator<Item = &HardEdgeSide> {
        let found = self.cells.get(&cell(at, self.cell_size));
        found.into_iter().flatten().map(|&number| &self.sides[number as usize])
    }
}

fn cell(at: DVec3, size: f64) -> Cell {
    // Places so far out that numbers saturate have no neighbors that could be confused with others.
    (at / size).floor().to_array().map(|value| value as i32)
}

fn cells_of(side: &HardEdgeSide, size: f64, number: u32) -> Vec<(Cell, u32)> {
    let [from, to] = side.ends;
    let steps = (from.distance(to) / size * 2.0).ceil().max(1.0) as u32;
    let mut found = Vec::new();
    let mut last = None;
    for step in 0..=steps {
        let [x, y, z] = cell(from.lerp(to, f64::from(step) / f64::from(steps)), size);
        if last.replace([x, y, z]) == Some([x, y, z]) {
            continue;
        }
        let around = (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [i, j, k])));
        let neighbor = |[i, j, k]: [i32; 3]| [x.saturating_add(i), y.saturating_add(j), z.saturating_add(k)];
        found.extend(around.map(|offset| (neighbor(offset), number)));
    }
    found
}

/// An edge of a triangle. Edges between the same two positions are adjacent when sorted.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct TriangleEdge {
    /// Bits of the positions of its ends, the lower first.
    ends: [[u32; 3]; 2],
    triangle: u32,
    /// Corner at which the edge starts.
    corner: u32,
}

fn sides(mesh: &Mesh) -> Vec<HardEdgeSide> {
    // Adding 0.0 converts −0 to 0.
    let bits = |vertex: u32| mesh.positions[vertex as usize].map(|value| (value + 0.0).to_bits());
    let edges_of = |triangle: usize| {
        let corners = mesh.triangles[triangle];
        (0..3).filter_map(move |corner| {
            let mut ends = [bits(corners[corner]), bits(corners[(corner + 1) % 3])];
            ends.sort_unstable();
            let edge = TriangleEdge {
                ends,
                triangle: triangle as u32,
                corner: corner as u32,
            };
            (ends[0] != ends[1]).then_some(edge)
        })
    };
    let mut edges: Vec<TriangleEdge> = (0..mesh.triangles.len()).flat_map(edges_of).collect();
    edges.par_sort_unstable();
    let pairs: Vec<&[TriangleEdge]> = edges.chunk_by(|a, b| a.ends == b.ends).collect();
    pairs
        .iter()
        .filter_map(|pair| match pair {
            [first, second] => two_sides(mesh, *first, *second),
            _ => None,
        })
        .flatten()
        .collect()
}

/// Returns the two sides of an edge between two triangles; `None` if the edge is smooth, or a triangle has no area.
fn two_sides(mesh: &Mesh, first: TriangleEdge, second: TriangleEdge) -> Option<[HardEdgeSide; 2]> {
    let ends = first.ends.map(|end| Vec3::from(end.map(f32::from_bits)).as_dvec3());
    let [a, b] = [face_at(mesh, first)?, face_at(mesh, second)?];
    let side = |(normal, inward): (DVec3, DVec3), other| HardEdgeSide {
        ends,
        normal,
        inward,
        other,
    };
    (a.0.dot(b.0) < HARD).then(|| [side(a, b.0), side(b, a.0)])
}

/// The shading normal of a triangle along one of its edges, and the direction from the edge into it.
fn face_at(mesh: &Mesh, edge: TriangleEdge) -> Option<(DVec3, DVec3)> {
    let corner = edge.corner as usize;
    let corners = mesh.triangles[edge.triangle as usize];
    let [from, to, opposite] = [0, 1, 2].map(|offset| corners[(corner + offset) % 3] as usize);
    let at = |vertex: usize| Vec3::from(mesh.positions[vertex]).as_dvec3();
    let normal_of = |vertex: usize| mesh.normals.get(vertex).map(|normal| Vec3::from(*normal).as_dvec3());
    let along = (at(to) - at(from)).try_normalize()?;
    let into = at(opposite) - at(from);
    let inward = (into - along * into.dot(along)).try_normalize()?;
    let normal = (normal_of(from)? + normal_of(to)?).try_normalize()?;
    Some((normal, inward))
}
