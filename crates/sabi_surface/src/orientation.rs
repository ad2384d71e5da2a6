//! Finds faces that are inside out: compared to the faces around them, or because a whole closed body faces inward.
//!
//! The faces of a body are compared across their shared edges, which run in opposite directions if both faces point to the same side. If
//! the body is closed, the outer side is the one with positive volume. An open sheet has no outer side, so the side of the larger area is
//! used. A closed body within another one may be a cavity, so its volume does not decide either.

use glam::DVec3;
use sabi_cancel::{Cancel, CancelableIterator as _, look};

use crate::atlas::topology::{NO_TWIN, Topology};
use crate::bvh::Bvh;
use crate::model::Mesh;

/// Volume relative to the area below which it counts as rounding error. For a sheet of paper it is dozens of times larger.
pub const LEAST_VOLUME: f64 = 1e-6;

/// Directions of rays that count the surfaces around a body. They are unlikely to be parallel to an edge.
const RAYS: [[f32; 3]; 3] = [
    [0.573_219, 0.612_374, 0.544_331],
    [-0.419_821, 0.817_496, 0.394_127],
    [0.271_828, -0.314_159, -0.909_603],
];

/// Returns the triangles that are inside out, in ascending order.
pub fn turned_faces(mesh: &Mesh) -> Vec<u32> {
    let topology = Topology::new(mesh);
    let part = |edge: u32| mesh.triangle_part[edge as usize / 3];
    // Bodies whose faces belong to several parts are handled first, if they are closed; the rest is handled part by part.
    let all = Bodies::of(mesh, &topology, |_| true, |_, _| true);
    let is_decided = |triangle: usize| all.body_of(triangle).is_some_and(|body| body.is_closed);
    let by_part = Bodies::of(
        mesh,
        &topology,
        |triangle| !is_decided(triangle),
        |edge, twin| part(edge) == part(twin),
    );
    let mut inside = Inside::new(mesh, &all, &by_part);
    let mut turned = Vec::new();
    for body in all.bodies.iter().filter(|body| body.is_closed) {
        turned.extend(body.turned(&all, &mut inside));
    }
    for body in &by_part.bodies {
        turned.extend(body.turned(&by_part, &mut inside));
    }
    turned.sort_unstable();
    turned
}

/// Triangles that are connected over edges.
struct TriangleShell {
    /// In rising order.
    triangles: Vec<u32>,
    /// True if every edge has two triangles.
    is_closed: bool,
    /// True if its faces cannot be oriented to one side.
    is_one_sided: bool,
    /// Volume behind the side of the first triangle; undefined for an open body.
    volume: f64,
    /// Area of the triangles oriented like the first one, and area of the others.
    areas: [f64; 2],
}

/// All bodies of a mesh.
struct Bodies {
    bodies: Vec<TriangleShell>,
    /// Body of each triangle; `None` for lines.
    body: Vec<Option<u32>>,
    /// True for triangles oriented like the first one of their body.
    agrees: Vec<bool>,
}

impl Bodies {
    /// Connects triangles over the half-edges that join them, each with its twin.
    fn of(
        mesh: &Mesh,
        topology: &Topology,
        is_wanted: impl Fn(usize) -> bool,
        joins: impl Fn(u32, u32) -> bool,
    ) -> Bodies {
        let count = mesh.triangles.len();
        let mut found = Bodies {
            bodies: Vec::new(),
            body: vec![None; count],
            agrees: vec![true; count],
        };
        for triangle in (0..count).looking() {
            if found.body[triangle].is_none() && is_wanted(triangle) && !is_line(topology, triangle) {
                found.follow(mesh, topology, triangle, &joins);
            }
        }
        found
    }

    /// Adds the body of a triangle.
    fn follow(&mut self, mesh: &Mesh, topology: &Topology, first: usize, joins: &impl Fn(u32, u32) -> bool) {
        let number = self.bodies.len() as u32;
        let mut body = TriangleShell {
            triangles: Vec::new(),
            is_closed: true,
            is_one_sided: false,
            volume: 0.0,
            areas: [0.0; 2],
        };
        let [origin, ..] = mesh.corners(first as u32);
        self.body[first] = Some(number);
        let mut open = vec![first];
        let cancel = Cancel::current();
        while let Some(triangle) = open.pop() {
            cancel.look();
            body.triangles.push(triangle as u32);
            body.measure(mesh.corners(triangle as u32), origin, self.agrees[triangle]);
            for edge in 3 * triangle..3 * triangle + 3 {
                let twin = topology.twins[edge];
                if twin == NO_TWIN || !joins(edge as u32, twin) {
                    body.is_closed = false;
                    continue;
                }
                let runs_along = topology.corners[edge] == topology.corners[twin as usize];
                let agrees = self.agrees[triangle] != runs_along;
                let other = twin as usize / 3;
                if self.body[other].is_none() {
                    self.body[other] = Some(number);
                    self.agrees[other] = agrees;
                    open.push(other);
                } else if self.agrees[other] != agrees {
                    body.is_one_sided = true;
                }
            }
        }
        body.triangles.sort_unstable();
        self.bodies.push(body);
    }

    fn body_of(&self, triangle: usize) -> Option<&TriangleShell> {
        self.bodies.get(self.body[triangle]? as usize)
    }
}

impl TriangleShell {
    /// Adds a triangle to volume and area.
    fn measure(&mut self, corners: [DVec3; 3], origin: DVec3, agrees: bool) {
        let [a, b, c] = corners.map(|corner| corner - origin);
        let sign = if agrees { 1.0 } else { -1.0 };
        self.volume += sign * a.dot(b.cross(c)) / 6.0;
        self.areas[usize::from(!agrees)] += (b - a).cross(c - a).length() / 2.0;
    }

    fn is_mixed(&self) -> bool {
        self.areas[0] > 0.0 && self.areas[1] > 0.0
    }

    /// Returns the triangles that are turned inside out.
    fn turned<'b>(&'b self, bodies: &'b Bodies, inside: &mut Inside<'_>) -> impl Iterator<Item = u32> + 'b {
        // True to reverse the triangles oriented like the first one, false to reverse the others.
        let side = self.turned_side(inside);
        let triangles = self.triangles.iter().copied();
        triangles.filter(move |triangle| side == Some(bodies.agrees[*triangle as usize]))
    }

    fn turned_side(&self, inside: &mut Inside<'_>) -> Option<bool> {
        if self.is_one_sided {
            return None;
        }
        let area = self.areas[0] + self.areas[1];
        let has_inside = self.is_closed && self.volume.abs() > LEAST_VOLUME * area.powf(1.5);
        if has_inside && (self.is_mixed() || self.volume < 0.0) && !inside.has(self) {
            return Some(self.volume < 0.0);
        }
        // If both areas are equal, the intended side is unknown.
        let is_undecided = self.areas[0] == self.areas[1];
        (self.is_mixed() && !is_undecided).then_some(self.areas[0] < self.areas[1])
    }
}

/// Finds bodies that lie within closed ones.
struct Inside<'m> {
    mesh: &'m Mesh,
    /// Number of the closed body of each triangle.
    closed: Vec<Option<u32>>,
    /// Number of closed bodies.
    count: usize,
    /// Hierarchy, built when it is first needed.
    hierarchy: Option<Bvh>,
}

impl<'m> Inside<'m> {
    fn new(mesh: &'m Mesh, all: &Bodies, by_part: &Bodies) -> Inside<'m> {
        let closed_body = |bodies: &Bodies, triangle| {
            let body = bodies.body[triangle]?;
            bodies.bodies[body as usize].is_closed.then_some(body)
        };
        let after_all = all.bodies.len() as u32;
        let closed = (0..mesh.triangles.len()).map(|triangle| {
            let of_part = || Some(after_all + closed_body(by_part, triangle)?);
            closed_body(all, triangle).or_else(of_part)
        });
        let bodies = all.bodies.iter().chain(&by_part.bodies);
        Inside {
            mesh,
            closed: closed.collect(),
            count: bodies.filter(|body| body.is_closed).count(),
            hierarchy: None,
        }
    }

    /// Returns true if a closed body lies within another one: most rays from it cross an odd number of faces of other closed bodies.
    fn has(&mut self, body: &TriangleShell) -> bool {
        look();
        let Some(first) = body.triangles.first().filter(|_| self.count > 1) else {
            return false;
        };
        let own = self.closed[*first as usize];
        let hierarchy = self.hierarchy.get_or_insert_with(|| Bvh::build(self.mesh));
        let [a, b, c] = self.mesh.corners(*first);
        let from = ((a + b + c) / 3.0).as_vec3().to_array();
        let is_other = |triangle: u32| self.closed[triangle as usize].is_some_and(|other| Some(other) != own);
        let is_odd = |direction: &&[f32; 3]| hierarchy.crossed(from, **direction, is_other) % 2 == 1;
        2 * RAYS.iter().filter(is_odd).count() > RAYS.len()
    }
}

fn is_line(topology: &Topology, triangle: usize) -> bool {
    let corners = &topology.corners[3 * triangle..3 * triangle + 3];
    corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]
}

#[cfg(test)]
mod tests;
