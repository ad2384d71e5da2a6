//! Walks: straightest geodesics over a triangle mesh (Polthier and Schmies 1998, "Straightest geodesics on polyhedral
//! surfaces"). A walk is a straight line in each triangle, and crosses an edge as if both triangles lay in one plane.
//!
//! The computation takes place in the plane of the current triangle, with coordinates along (`x`) and away from (`y`) the
//! edge through which the walk entered. Crossing an edge keeps both coordinates of every vector, which equals a rotation
//! about that edge (parallel transport). At a border, vectors are mirrored, which keeps both coordinates, too.

use glam::{DMat2, DVec2, DVec3};

use super::fixed_point_uvs::Uvs;
use super::topology::{NO_TWIN, Topology};
use crate::model::Mesh;

/// Maximum number of edges that a walk crosses.
const CROSSINGS_LIMIT: u32 = 64;
/// Share of an edge at each end that walks do not cross: at a vertex the next triangle would be ambiguous.
const VERTEX_MARGIN: f64 = 1e-6;

/// Mesh that walks go over.
pub(super) struct WalkMesh<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) uvs: Uvs<'a>,
    /// True for each triangle in which a walk may end: it has an area in space and in UV, and is in a chart that owns texels.
    pub(super) usable: &'a [bool],
}

/// End of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WalkEnd {
    pub(super) triangle: u32,
    /// Texel coordinates in the user's layout.
    pub(super) texel: DVec2,
    /// Matrix from texel vectors at the start to texel vectors at the end.
    pub(super) transport: DMat2,
}

/// A triangle unfolded into a plane: corner `a` at the origin, `b` on the x axis, `c` above it.
struct UnfoldedTriangle {
    /// Corner numbers `3 t + k` of a, b and c.
    corners: [u32; 3],
    /// Length of the edge from a to b, model units.
    length: f64,
    /// Place of c, model units.
    c: DVec2,
}

impl UnfoldedTriangle {
    fn new(walker: &WalkMesh, corners: [u32; 3]) -> UnfoldedTriangle {
        let [a, b, c] = corners.map(|corner| walker.position(corner));
        let (ab, ac) = (b - a, c - a);
        let length = ab.length();
        let c = if length > 0.0 {
            DVec2::new(ab.dot(ac), ab.cross(ac).length()) / length
        } else {
            DVec2::ZERO
        };
        UnfoldedTriangle { corners, length, c }
    }

    /// Returns the barycentric coordinates of b and c of a vector or point of the plane.
    fn barycentric(&self, v: DVec2) -> [f64; 2] {
        let of_c = v.y / self.c.y;
        [(v.x - of_c * self.c.x) / self.length, of_c]
    }
}

/// Point at which a walk leaves a triangle.
struct EdgeCrossing {
    /// Share of the whole step from the current point to here.
    time: f64,
    /// Corner numbers of the edge's ends.
    ends: [u32; 2],
    /// Half-edge, as [`Topology`] numbers them.
    edge: u32,
    /// Position along the edge, from 0 to 1.
    fraction: f64,
    /// Unit vector along the edge.
    along: DVec2,
    /// Unit vector perpendicular to the edge, out of the triangle.
    outward: DVec2,
}

impl WalkMesh<'_> {
    /// Walks from a texel of a triangle along a texel vector of its chart. `None` when the walk does not end.
    pub(super) fn walk(&self, triangle: u32, start: DVec2, step: DVec2) -> Option<WalkEnd> {
        if !self.usable[triangle as usize] {
            return None;
        }
        let [q0, q1, q2] = self.uvs.corners(triangle);
        let (to_1, to_2) = (q1 - q0, q2 - q0);
        let area2 = to_1.perp_dot(to_2);
        let barycentric_of = |v: DVec2| [v.perp_dot(to_2) / area2, to_1.perp_dot(v) / area2];
        // A texel's center may lie slightly outside of the triangle that owns it, since corners are snapped. In that case
        // the walk starts at the edge, and ends at the same point.
        let inside = clamp_to_triangle(barycentric_of(start - q0));
        let at = q0 + to_1 * inside[0] + to_2 * inside[1];
        let step = start + step - at;

        let unfolded = UnfoldedTriangle::new(self, [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
        let plane =
            |[of_b, of_c]: [f64; 2]| DVec2::new(of_b * unfolded.length + of_c * unfolded.c.x, of_c * unfolded.c.y);
        // The texel axes in the plane, by the affine map of the triangle.
        let axes = DMat2::from_cols(plane(barycentric_of(DVec2::X)), plane(barycentric_of(DVec2::Y)));
        let walk = WalkState {
            walker: self,
            step,
            axes,
            remaining: 1.0,
        };
        let at = plane(inside);
        let crossing = unfolded.first_crossing(walk.direction(), at);
        walk.run(crossing, unfolded, at)
    }

    fn position(&self, corner: u32) -> DVec3 {
        let vertex = self.mesh.triangles[corner as usize / 3][corner as usize % 3];
        DVec3::from(self.mesh.positions[vertex as usize].map(f64::from))
    }
}

/// Walk that has not ended yet.
struct WalkState<'a> {
    walker: &'a WalkMesh<'a>,
    /// Whole step in texels of the start.
    step: DVec2,
    /// Texel axes of the start, transported to the plane of the current triangle.
    axes: DMat2,
    /// Share of the step that remains.
    remaining: f64,
}

impl WalkState<'_> {
    fn direction(&self) -> DVec2 {
        self.axes * self.step
    }

    fn run(mut self, first: Option<EdgeCrossing>, mut triangle: UnfoldedTriangle, mut at: DVec2) -> Option<WalkEnd> {
        let mut crossing = first;
        for _ in 0..=CROSSINGS_LIMIT {
            let usable = self.walker.usable[triangle.corners[0] as usize / 3];
            let ends_here = crossing.as_ref().is_none_or(|crossing| crossing.time >= self.remaining);
            if usable && ends_here {
                let end = at + self.direction() * self.remaining.max(0.0);
                return self.end(&triangle, end);
            }
            (triangle, at) = self.cross(crossing?);
            crossing = Some(triangle.next_crossing(self.direction(), at.x));
        }
        None
    }

    /// Crosses an edge, or is mirrored at a border. Returns the next triangle and the current point in its plane.
    fn cross(&mut self, crossing: EdgeCrossing) -> (UnfoldedTriangle, DVec2) {
        self.remaining -= crossing.time;
        // The edge and the outward direction become the axes of the next plane.
        self.axes = DMat2::from_cols(crossing.along, crossing.outward).transpose() * self.axes;
        let topology = self.walker.topology;
        let twin = match topology.twins[crossing.edge as usize] {
            NO_TWIN => crossing.edge,
            twin => twin,
        };
        let base = twin / 3 * 3;
        let mut ends = [twin, base + (twin - base + 1) % 3];
        if topology.corners[ends[0] as usize] != topology.corners[crossing.ends[0] as usize] {
            ends.swap(0, 1);
        }
        let opposite = base + (twin - base + 2) % 3;
        let triangle = UnfoldedTriangle::new(self.walker, [ends[0], ends[1], opposite]);
        let at = DVec2::new(crossing.fraction * triangle.length, 0.0);
        (triangle, at)
    }

    fn end(&self, triangle: &UnfoldedTriangle, at: DVec2) -> Option<WalkEnd> {
        let number = triangle.corners[0] / 3;
        let corners = self.walker.uvs.corners(number);
        let [a, b, c] = triangle.corners.map(|corner| corners[corner as usize % 3]);
        let texel_vector = |v: DVec2| {
            let [of_b, of_c] = triangle.barycentric(v);
            (b - a) * of_b + (c - a) * of_c
        };
        let texel = a + texel_vector(at);
        let transport = DMat2::from_cols(texel_vector(self.axes.x_axis), texel_vector(self.axes.y_axis));
        let sound = transport.is_finite() && texel.is_finite() && transport.determinant() != 0.0;
        sound.then_some(WalkEnd {
            triangle: number,
            texel,
            transport,
        })
    }
}

impl UnfoldedTriangle {
    /// Returns the crossing of a walk that starts inside a triangle; `None` if the walk does not move.
    fn first_crossing(&self, d: DVec2, at: DVec2) -> Option<EdgeCrossing> {
        let points = [DVec2::ZERO, DVec2::new(self.length, 0.0), self.c];
        let mut found: Option<EdgeCrossing> = None;
        for k in 0..3 {
            let edge = points[(k + 1) % 3] - points[k];
            let speed = -edge.perp_dot(d);
            if speed <= 0.0 {
                continue;
            }
            let time = (edge.perp_dot(at - points[k]) / speed).max(0.0);
            if found.as_ref().is_none_or(|found| time < found.time) {
                let offset = at + d * time - points[k];
                found = Some(self.crossing([k, (k + 1) % 3], time, edge, offset, 1.0));
            }
        }
        found
    }

    /// Returns the crossing of a walk that entered at `x` on the edge from a to b.
    ///
    /// The crossed edge follows from the side of the walk on which c lies. That needs no division and is defined for
    /// triangles without area, too.
    fn next_crossing(&self, d: DVec2, x: f64) -> EdgeCrossing {
        let at = DVec2::new(x, 0.0);
        let left = d.perp_dot(self.c - at) > 0.0;
        let (from, start, side) = if left {
            (1, DVec2::new(self.length, 0.0), 1.0)
        } else {
            (0, DVec2::ZERO, -1.0)
        };
        let edge = self.c - start;
        let offset = at - start;
        let time = -edge.perp_dot(offset) / edge.perp_dot(d);
        let time = if time.is_finite() { time.max(0.0) } else { 0.0 };
        self.crossing([from, 2], time, edge, offset + d * time, side)
    }

    /// Creates a crossing at `offset` from the start of an edge; `side` is 1 when the triangle lies to the left of the
    /// edge, and otherwise -1.
    fn crossing(&self, ends: [usize; 2], time: f64, edge: DVec2, offset: DVec2, side: f64) -> EdgeCrossing {
        let length = edge.length();
        let along = if length > 0.0 { edge / length } else { DVec2::X };
        let fraction = offset.dot(along) / length;
        let fraction = if fraction.is_finite() {
            fraction.clamp(VERTEX_MARGIN, 1.0 - VERTEX_MARGIN)
        } else {
            0.5
        };
        let corners = ends.map(|end| self.corners[end]);
        EdgeCrossing {
            time,
            ends: corners,
            edge: edge_between(corners),
            fraction,
            along,
            outward: -along.perp() * side,
        }
    }
}

/// The half-edge between two corners of a triangle.
fn edge_between([a, b]: [u32; 2]) -> u32 {
    let base = a / 3 * 3;
    if base + (a - base + 1) % 3 == b { a } else { b }
}

/// Clamps the barycentric coordinates of b and c to the triangle. For points close to the triangle, as here, the result is
/// close to its nearest point.
fn clamp_to_triangle([of_b, of_c]: [f64; 2]) -> [f64; 2] {
    let clamped = [1.0 - of_b - of_c, of_b, of_c].map(|coordinate| coordinate.max(0.0));
    let sum = clamped[0] + clamped[1] + clamped[2];
    [clamped[1] / sum, clamped[2] / sum]
}
