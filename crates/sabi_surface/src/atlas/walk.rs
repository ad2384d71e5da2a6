//! Straightest paths over a triangle mesh: in each triangle a straight line, over an edge as if both were flat.
//!
//! Computes in the plane of the current triangle, in coordinates along (`x`) and away from (`y`) the edge
//! it was entered by. Crossing an edge keeps both coordinates of every vector, which is the rotation about that edge.
//! At a border vectors are mirrored, which keeps them as well.

use super::fixed::{Uvs, cross, sub};
use super::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// Most edges that a path crosses.
const CROSSINGS_LIMIT: u32 = 64;
/// Paths keep this share of an edge away from its ends, where it would be unclear which triangle comes next.
const VERTEX_MARGIN: f64 = 1e-6;

type Vec2 = [f64; 2];
type Vec3 = [f64; 3];

/// Mesh that paths run over.
pub(super) struct Ground<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) uvs: Uvs<'a>,
    /// Triangles a path may end in: they have area in space and in UV, and their chart owns texels.
    pub(super) usable: &'a [bool],
}

/// End of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Landing {
    pub(super) triangle: u32,
    /// In texels of the user's layout.
    pub(super) texel: Vec2,
    /// Columns carry texel axes of the start to texel vectors of the end.
    pub(super) transport: [Vec2; 2],
}

/// A triangle laid flat: `a` at the origin, `b` on the x axis, `c` above it.
struct Flat {
    /// Corner numbers `3 t + k` of a, b and c.
    corners: [u32; 3],
    length: f64,
    c: Vec2,
}

impl Flat {
    fn new(ground: &Ground, corners: [u32; 3]) -> Flat {
        let [a, b, c] = corners.map(|corner| ground.position(corner));
        let (ab, ac) = (sub3(b, a), sub3(c, a));
        let length = dot3(ab, ab).sqrt();
        let along = if length > 0.0 { dot3(ab, ac) / length } else { 0.0 };
        let normal = cross3(ab, ac);
        let away = if length > 0.0 {
            dot3(normal, normal).sqrt() / length
        } else {
            0.0
        };
        Flat {
            corners,
            length,
            c: [along, away],
        }
    }

    /// Shares of b and c in a vector or point of the plane.
    fn shares(&self, v: Vec2) -> [f64; 2] {
        let of_c = v[1] / self.c[1];
        [(v[0] - of_c * self.c[0]) / self.length, of_c]
    }
}

/// Edge by which a path leaves a triangle.
struct Exit {
    /// Share of the whole path used until there.
    time: f64,
    /// Corner numbers of the edge's ends.
    ends: [u32; 2],
    /// Edge number.
    edge: u32,
    /// Place on the edge, 0 to 1.
    place: f64,
    /// Unit vectors along the edge and out of the triangle.
    along: Vec2,
    out: Vec2,
}

impl Ground<'_> {
    /// Walks from a texel of a triangle along a texel vector of its chart. `None` when the path does not end.
    pub(super) fn walk(&self, triangle: u32, start: Vec2, step: Vec2) -> Option<Landing> {
        if !self.usable[triangle as usize] {
            return None;
        }
        let [q0, q1, q2] = self.uvs.corners(triangle);
        let area2 = cross(sub(q1, q0), sub(q2, q0));
        // The center of a texel may lie outside of the triangle that owns it by the snapping of its corners: start
        // at the edge, and end where the step ends all the same.
        let shares = [
            cross(sub(start, q0), sub(q2, q0)) / area2,
            cross(sub(q1, q0), sub(start, q0)) / area2,
        ];
        let inside = clamp_shares(shares);
        let at = [0, 1].map(|axis| q0[axis] + inside[0] * (q1[axis] - q0[axis]) + inside[1] * (q2[axis] - q0[axis]));
        let step = sub([start[0] + step[0], start[1] + step[1]], at);

        let flat = Flat::new(self, [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
        let plane = |[of_b, of_c]: [f64; 2]| [of_b * flat.length + of_c * flat.c[0], of_c * flat.c[1]];
        // The texel axes in the plane, by the affine map of the triangle.
        let axes = [[1.0, 0.0], [0.0, 1.0]]
            .map(|axis| plane([cross(axis, sub(q2, q0)) / area2, cross(sub(q1, q0), axis) / area2]));
        let path = Path {
            ground: self,
            step,
            axes,
            remaining: 1.0,
        };
        let at = plane(inside);
        let exit = flat.first_exit(path.direction(), at);
        path.run(exit, flat, at)
    }

    fn position(&self, corner: u32) -> Vec3 {
        let vertex = self.mesh.triangles[corner as usize / 3][corner as usize % 3];
        self.mesh.positions[vertex as usize].map(f64::from)
    }
}

/// Path that has not ended yet.
struct Path<'a> {
    ground: &'a Ground<'a>,
    /// Whole step in texels of the start.
    step: Vec2,
    /// Texel axes of the start, carried to the current triangle's plane.
    axes: [Vec2; 2],
    /// Share of the step that remains.
    remaining: f64,
}

impl Path<'_> {
    fn direction(&self) -> Vec2 {
        let [u, v] = self.axes;
        [
            u[0] * self.step[0] + v[0] * self.step[1],
            u[1] * self.step[0] + v[1] * self.step[1],
        ]
    }

    fn run(mut self, first: Option<Exit>, mut flat: Flat, mut at: Vec2) -> Option<Landing> {
        let mut exit = first;
        for _ in 0..=CROSSINGS_LIMIT {
            let usable = self.ground.usable[flat.corners[0] as usize / 3];
            let ends_here = exit.as_ref().is_none_or(|exit| exit.time >= self.remaining);
            if usable && ends_here {
                let (d, left) = (self.direction(), self.remaining.max(0.0));
                return self.land(&flat, [at[0] + d[0] * left, at[1] + d[1] * left]);
            }
            (flat, at) = self.cross(exit?);
            exit = Some(flat.next_exit(self.direction(), at[0]));
        }
        None
    }

    /// Steps over an edge, or turns back at a border.
    fn cross(&mut self, exit: Exit) -> (Flat, Vec2) {
        self.remaining -= exit.time;
        self.axes = self.axes.map(|v| [dot(v, exit.along), dot(v, exit.out)]);
        let topology = self.ground.topology;
        let twin = match topology.twins[exit.edge as usize] {
            NO_TWIN => exit.edge,
            twin => twin,
        };
        let base = twin / 3 * 3;
        let mut ends = [twin, base + (twin - base + 1) % 3];
        if topology.corners[ends[0] as usize] != topology.corners[exit.ends[0] as usize] {
            ends.swap(0, 1);
        }
        let opposite = base + (twin - base + 2) % 3;
        let flat = Flat::new(self.ground, [ends[0], ends[1], opposite]);
        let at = [exit.place * flat.length, 0.0];
        (flat, at)
    }

    fn land(&self, flat: &Flat, at: Vec2) -> Option<Landing> {
        let triangle = flat.corners[0] / 3;
        let corners = self.ground.uvs.corners(triangle);
        let [a, b, c] = flat.corners.map(|corner| corners[corner as usize % 3]);
        let texel_vector = |v: Vec2| {
            let [of_b, of_c] = flat.shares(v);
            [0, 1].map(|axis| of_b * (b[axis] - a[axis]) + of_c * (c[axis] - a[axis]))
        };
        let offset = texel_vector(at);
        let transport = self.axes.map(texel_vector);
        let texel = [a[0] + offset[0], a[1] + offset[1]];
        let sound = transport
            .iter()
            .chain([&texel])
            .flatten()
            .all(|value| value.is_finite());
        (sound && cross(transport[0], transport[1]) != 0.0).then_some(Landing {
            triangle,
            texel,
            transport,
        })
    }
}

impl Flat {
    /// The edge by which a path that starts inside leaves; `None` when it does not move.
    fn first_exit(&self, d: Vec2, at: Vec2) -> Option<Exit> {
        let points = [[0.0, 0.0], [self.length, 0.0], self.c];
        let mut found: Option<Exit> = None;
        for k in 0..3 {
            let edge = sub(points[(k + 1) % 3], points[k]);
            let speed = -cross(edge, d);
            if speed <= 0.0 {
                continue;
            }
            let time = (cross(edge, sub(at, points[k])) / speed).max(0.0);
            if found.as_ref().is_none_or(|found| time < found.time) {
                let meet = sub([at[0] + d[0] * time, at[1] + d[1] * time], points[k]);
                found = Some(self.exit([k, (k + 1) % 3], time, edge, meet, 1.0));
            }
        }
        found
    }

    /// The edge by which a path leaves that came in at `x` on the edge from a to b.
    ///
    /// The far corner lies to the left or to the right of the path: this needs no division and always has an answer,
    /// for triangles without area as well.
    fn next_exit(&self, d: Vec2, x: f64) -> Exit {
        let left = cross(d, sub(self.c, [x, 0.0])) > 0.0;
        let (from, start, side) = if left {
            (1, [self.length, 0.0], 1.0)
        } else {
            (0, [0.0, 0.0], -1.0)
        };
        let edge = sub(self.c, start);
        let offset = sub([x, 0.0], start);
        let time = -cross(edge, offset) / cross(edge, d);
        let time = if time.is_finite() { time.max(0.0) } else { 0.0 };
        let meet = [offset[0] + d[0] * time, d[1] * time];
        self.exit([from, 2], time, edge, meet, side)
    }

    /// `meet` counts from the edge's start; `side` is 1 when the triangle lies to the left of the edge.
    fn exit(&self, ends: [usize; 2], time: f64, edge: Vec2, meet: Vec2, side: f64) -> Exit {
        let length = dot(edge, edge).sqrt();
        let along = if length > 0.0 {
            [edge[0] / length, edge[1] / length]
        } else {
            [1.0, 0.0]
        };
        let place = dot(meet, along) / length;
        let place = if place.is_finite() {
            place.clamp(VERTEX_MARGIN, 1.0 - VERTEX_MARGIN)
        } else {
            0.5
        };
        let corners = ends.map(|end| self.corners[end]);
        Exit {
            time,
            ends: corners,
            edge: edge_between(corners),
            place,
            along,
            out: [along[1] * side, -along[0] * side],
        }
    }
}

/// The edge number of the edge between two corners of a triangle.
fn edge_between([a, b]: [u32; 2]) -> u32 {
    let base = a / 3 * 3;
    if base + (a - base + 1) % 3 == b { a } else { b }
}

/// The nearest shares of b and c inside of a triangle, near enough for a point that is hardly outside.
fn clamp_shares([of_b, of_c]: [f64; 2]) -> [f64; 2] {
    let shares = [1.0 - of_b - of_c, of_b, of_c].map(|share| share.max(0.0));
    let sum = shares[0] + shares[1] + shares[2];
    [shares[1] / sum, shares[2] / sum]
}

fn dot(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn sub3(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot3(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross3(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
