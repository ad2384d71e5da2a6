//! Connected components of the triangles of each part.

use glam::{DVec3, Vec3};
use sabi_cancel::CancelableIterator as _;

use crate::atlas::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// Disjoint sets of triangles; the first triangle of a set identifies it.
struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    fn first(&mut self, mut triangle: u32) -> u32 {
        loop {
            let parent = self.parents[triangle as usize];
            if parent == triangle {
                return triangle;
            }
            let above = self.parents[parent as usize];
            self.parents[triangle as usize] = above;
            triangle = above;
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }
}

/// Piece of each triangle, numbered by first triangles.
pub(super) fn triangle_pieces(mesh: &Mesh, topology: &Topology) -> Vec<u32> {
    let count = mesh.triangles.len() as u32;
    let mut sets = DisjointSets {
        parents: (0..count).collect(),
    };
    let part = |triangle: u32| mesh.triangle_part[triangle as usize];
    for (edge, &twin) in topology.twins.iter().enumerate().looking() {
        let (own, other) = (edge as u32 / 3, twin / 3);
        if twin != NO_TWIN && part(own) == part(other) {
            sets.join(own, other);
        }
    }
    join_nonmanifold(mesh, topology, &mut sets);
    join_lines(mesh, topology, &mut sets);
    let mut numbers = vec![0; count as usize];
    let mut next = 0;
    for triangle in (0..count).looking() {
        let first = sets.first(triangle);
        if first == triangle {
            numbers[triangle as usize] = next;
            next += 1;
        } else {
            numbers[triangle as usize] = numbers[first as usize];
        }
    }
    numbers
}

fn is_line(topology: &Topology, triangle: usize) -> bool {
    let corners = &topology.corners[3 * triangle..3 * triangle + 3];
    corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]
}

/// Joins triangles at nonmanifold edges within a part, where solids touch: pairs of triangles that bound the same solid are joined.
fn join_nonmanifold(mesh: &Mesh, topology: &Topology, sets: &mut DisjointSets) {
    let mut open: Vec<(u32, u64, u32)> = Vec::new();
    for (edge, &twin) in topology.twins.iter().enumerate().looking() {
        let triangle = edge / 3;
        if twin == NO_TWIN && !is_line(topology, triangle) {
            let [low, high] = ends(topology, edge as u32);
            let key = (u64::from(low) << 32) | u64::from(high);
            open.push((mesh.triangle_part[triangle], key, edge as u32));
        }
    }
    open.sort_unstable();
    for of_edge in open.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let sides: Vec<EdgeSide> = of_edge
            .iter()
            .filter_map(|&(.., edge)| EdgeSide::new(mesh, topology, edge))
            .collect();
        join_about_edge(&sides, sets);
    }
}

/// Joins every triangle at an edge with the next triangle of opposite direction around the edge, on the side of its solid.
/// Triangles are sorted by angle, which takes O(n log n) time for n triangles.
fn join_about_edge(sides: &[EdgeSide], sets: &mut DisjointSets) {
    let Some(first) = sides.first() else { return };
    let turns: Vec<f64> = sides.iter().map(|side| first.turn_to(side)).collect();
    for forward in [false, true] {
        // The solid of a backward side is counter-clockwise of it, that of a forward side clockwise.
        let turn = |side: usize| {
            if forward {
                (4.0 - turns[side]) % 4.0
            } else {
                turns[side]
            }
        };
        let (own, mut facing): (Vec<usize>, Vec<usize>) =
            (0..sides.len()).partition(|&side| sides[side].forward == forward);
        facing.sort_unstable_by(|&a, &b| turn(a).total_cmp(&turn(b)).then(a.cmp(&b)));
        for side in own {
            let from = (turn(side) + SAME_TURN) % 4.0;
            let next = facing.partition_point(|&other| turn(other) <= from);
            if let Some(&other) = facing.get(next).or(facing.first()) {
                sets.join(sides[side].triangle, sides[other].triangle);
            }
        }
    }
}

/// Smallest angle between triangles. At smaller angles they coincide and count as a full turn apart, since their solids are
/// on opposite sides.
const SAME_TURN: f64 = 1e-4;

/// Welded vertices of an edge, the lesser first.
fn ends(topology: &Topology, edge: u32) -> [u32; 2] {
    let triangle = edge / 3 * 3;
    let (from, to) = (
        topology.corners[edge as usize],
        topology.corners[(triangle + (edge + 1) % 3) as usize],
    );
    [from.min(to), from.max(to)]
}

/// A triangle at a nonmanifold edge.
struct EdgeSide {
    triangle: u32,
    /// True if its half-edge runs from the lesser vertex to the greater.
    forward: bool,
    /// Unit vector perpendicular to the edge, into the triangle.
    across: DVec3,
    /// `across` after a quarter turn counter-clockwise about the edge.
    onward: DVec3,
}

impl EdgeSide {
    /// None for a triangle without area.
    fn new(mesh: &Mesh, topology: &Topology, edge: u32) -> Option<EdgeSide> {
        let [low, high] = ends(topology, edge);
        let triangle = edge / 3;
        let place = |vertex: u32| Vec3::from(mesh.positions[vertex as usize]).as_dvec3();
        let third = topology.corners[(3 * triangle + (edge + 2) % 3) as usize];
        let along = (place(high) - place(low)).try_normalize()?;
        let leg = place(third) - place(low);
        let across = (leg - along * leg.dot(along)).try_normalize()?;
        let forward = topology.corners[edge as usize] == low;
        Some(EdgeSide {
            triangle,
            forward,
            across,
            onward: along.cross(across),
        })
    }

    /// Returns the counter-clockwise angle around the edge from this triangle to another, from 0 to less than 4 quarter turns. Within a
    /// quarter turn it is linear along a diamond instead of a circle, which keeps the order and needs no arc tangent.
    fn turn_to(&self, other: &EdgeSide) -> f64 {
        let (x, y) = (other.across.dot(self.across), other.across.dot(self.onward));
        let part = y.abs() / (x.abs() + y.abs()).max(1e-300);
        let turn = match (x >= 0.0, y >= 0.0) {
            (true, true) => part,
            (false, true) => 2.0 - part,
            (false, false) => 2.0 + part,
            (true, false) => 4.0 - part,
        };
        turn % 4.0
    }
}

/// Joins triangles that are lines, which have no twins, with the first triangle at one of their corners.
fn join_lines(mesh: &Mesh, topology: &Topology, sets: &mut DisjointSets) {
    let count = mesh.triangles.len();
    if !(0..count).any(|triangle| is_line(topology, triangle)) {
        return;
    }
    let mut first_at = vec![u32::MAX; mesh.positions.len()];
    for triangle in (0..count).filter(|triangle| !is_line(topology, *triangle)) {
        for corner in &topology.corners[3 * triangle..3 * triangle + 3] {
            let first = &mut first_at[*corner as usize];
            *first = (*first).min(triangle as u32);
        }
    }
    for triangle in (0..count).filter(|triangle| is_line(topology, *triangle)) {
        let neighbors = topology.corners[3 * triangle..3 * triangle + 3]
            .iter()
            .map(|corner| first_at[*corner as usize]);
        let mut neighbors = neighbors.filter(|first| *first != u32::MAX);
        let part = mesh.triangle_part[triangle];
        if let Some(first) = neighbors.find(|first| mesh.triangle_part[*first as usize] == part) {
            sets.join(triangle as u32, first);
        }
    }
}
