//! The surface around a place, unfolded into a plane, and paths over the surface.
//!
//! Triangles are laid into one plane edge by edge, the nearest edge first, so that lengths along a straight line in the
//! plane are lengths on the surface (the discrete exponential map). This is exact where the surface can be unrolled, over
//! any number of edges. On a sphere the error grows with the square of the ratio of distance to radius.

#[cfg(test)]
mod tests;
mod walk;

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use crate::atlas::topology::{NO_TWIN, Topology};
use crate::model::Mesh;
use crate::segment::distance_to_segment;

pub use walk::walk;

/// A point on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Triangle of the mesh.
    pub triangle: u32,
    /// Position on it, model units.
    pub position: DVec3,
}

/// A triangle in the plane of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedTriangle {
    /// Triangle of the mesh.
    pub triangle: u32,
    /// Its corners in the plane, model units; the site of the patch is at the origin.
    pub corners: [DVec2; 3],
}

impl PlacedTriangle {
    /// Returns the position in the plane of a point of the triangle, whose corners in space are given; `None` for a triangle without area.
    pub fn place_of(&self, corners: [DVec3; 3], position: DVec3) -> Option<DVec2> {
        let weights = weights_at(corners, position)?;
        let [first, second, third] = self.corners;
        Some(first + weights.x * (second - first) + weights.y * (third - first))
    }
}

/// Returns the weights of the second and third corner of a triangle at a position, projected onto its plane; `None` for a
/// triangle without area.
pub fn weights_at([a, b, c]: [DVec3; 3], position: DVec3) -> Option<DVec2> {
    let (ab, ac, ap) = (b - a, c - a, position - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    let weights = DVec2::new(ap.cross(ac).dot(normal) / square, ab.cross(ap).dot(normal) / square);
    (square > 0.0).then_some(weights)
}

/// Mesh with its connections.
#[derive(Clone, Copy)]
pub struct ConnectedMesh<'a> {
    /// Triangles in space.
    pub mesh: &'a Mesh,
    /// Their connections.
    pub topology: &'a Topology,
}

impl ConnectedMesh<'_> {
    /// Corners of a triangle, model units.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh.corners(triangle)
    }

    /// Unit normal of a triangle's plane; zero for a triangle without area.
    pub fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).normalize_or_zero()
    }
}

/// Unfolds patches of a mesh. Its memory is reused.
pub struct Unfolder {
    /// Number of the patch in which each triangle was placed last.
    placed_in: Vec<u32>,
    patch: u32,
    edges: BinaryHeap<OpenEdge>,
}

/// An edge of the patch over which it may grow.
#[derive(Clone, Copy, Debug)]
struct OpenEdge {
    /// Distance from the site in the plane.
    distance: f64,
    /// Half-edge of the triangle to be placed.
    half_edge: u32,
    /// Ends of that half-edge in the plane, in its own order; the triangle lies to the left.
    ends: [DVec2; 2],
}

impl PartialEq for OpenEdge {
    fn eq(&self, other: &OpenEdge) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for OpenEdge {}

impl PartialOrd for OpenEdge {
    fn partial_cmp(&self, other: &OpenEdge) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OpenEdge {
    /// Compares so that the nearest edge is the greatest. Among equally near edges, numbers decide.
    fn cmp(&self, other: &OpenEdge) -> Ordering {
        let by_distance = other.distance.total_cmp(&self.distance);
        by_distance.then(other.half_edge.cmp(&self.half_edge))
    }
}

impl Unfolder {
    /// Prepares for a mesh of this many triangles.
    pub fn new(triangles: usize) -> Unfolder {
        Unfolder {
            placed_in: vec![0; triangles],
            patch: 0,
            edges: BinaryHeap::new(),
        }
    }

    /// Unfolds everything within `reach` of a site into `patch`, starting with the site's own triangle. The x axis of the plane is `ahead`
    /// projected onto the surface, and the plane is seen from outside. A site on a triangle without area gives an empty patch.
    pub fn unfold(
        &mut self,
        surface: ConnectedMesh<'_>,
        site: Site,
        ahead: DVec3,
        reach: f64,
        patch: &mut Vec<PlacedTriangle>,
    ) {
        patch.clear();
        self.edges.clear();
        self.patch = self.patch.wrapping_add(1);
        if self.patch == 0 {
            self.placed_in.fill(0);
            self.patch = 1;
        }
        let normal = surface.normal(site.triangle);
        if normal == DVec3::ZERO {
            return;
        }
        let (x, y) = axes(normal, ahead);
        let corners = surface.corners(site.triangle).map(|corner| {
            let offset = corner - site.position;
            DVec2::new(offset.dot(x), offset.dot(y))
        });
        let placed = PlacedTriangle {
            triangle: site.triangle,
            corners,
        };
        self.grow(surface, placed, reach, patch, |_| true);
    }

    /// Adds a triangle that already has a place in the plane, and everything connected to it within reach, to the patch
    /// that was unfolded last: first across triangles for which `leads` is true, then across the others. Triangles that are
    /// in the patch already are not moved.
    pub fn grow(
        &mut self,
        surface: ConnectedMesh<'_>,
        from: PlacedTriangle,
        reach: f64,
        patch: &mut Vec<PlacedTriangle>,
        leads: impl Fn(u32) -> bool,
    ) {
        if self.placed_in[from.triangle as usize] == self.patch {
            return;
        }
        self.place(surface, from.triangle, from.corners, 0, 3, reach, patch);
        let mut later = Vec::new();
        let mut is_first = true;
        loop {
            let Some(edge) = self.edges.pop() else {
                if !std::mem::take(&mut is_first) {
                    break;
                }
                self.edges.append(&mut later.drain(..).collect());
                continue;
            };
            let triangle = edge.half_edge / 3;
            if self.placed_in[triangle as usize] == self.patch {
                continue;
            }
            if is_first && !leads(triangle) {
                later.push(edge);
                continue;
            }
            let first = (edge.half_edge % 3) as usize;
            let Some(corners) = corners_beside(surface.corners(triangle), first, edge.ends) else {
                continue;
            };
            self.place(surface, triangle, corners, first + 1, 2, reach, patch);
        }
    }

    /// Places a triangle, and opens `count` of its edges from `first` on.
    fn place(
        &mut self,
        surface: ConnectedMesh<'_>,
        triangle: u32,
        corners: [DVec2; 3],
        first: usize,
        count: usize,
        reach: f64,
        patch: &mut Vec<PlacedTriangle>,
    ) {
        self.placed_in[triangle as usize] = self.patch;
        patch.push(PlacedTriangle { triangle, corners });
        for edge in (first..first + count).map(|edge| edge % 3) {
            let twin = surface.topology.twins[3 * triangle as usize + edge];
            if twin == NO_TWIN || self.placed_in[twin as usize / 3] == self.patch {
                continue;
            }
            // The twin has the opposite direction.
            let ends = [corners[(edge + 1) % 3], corners[edge]];
            let distance = distance_to_segment(DVec2::ZERO, ends);
            if distance < reach {
                self.edges.push(OpenEdge {
                    distance,
                    half_edge: twin,
                    ends,
                });
            }
        }
    }
}

/// Returns axes of the plane perpendicular to a unit normal: x is `ahead` projected onto the surface, y is to its left as
/// seen from outside.
pub fn axes(normal: DVec3, ahead: DVec3) -> (DVec3, DVec3) {
    let flat = ahead - normal * normal.dot(ahead);
    let x = flat.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    (x, normal.cross(x))
}

/// Returns the corners in the plane of a triangle whose edge that starts at corner `first` lies at `ends`. The triangle is
/// to the left of that edge.
fn corners_beside(corners: [DVec3; 3], first: usize, ends: [DVec2; 2]) -> Option<[DVec2; 3]> {
    let [a, b, c] = [0, 1, 2].map(|corner| corners[(first + corner) % 3]);
    let (ab, ac) = (b - a, c - a);
    let length = ab.length();
    let along = (ends[1] - ends[0]).try_normalize()?;
    if length <= 0.0 {
        return None;
    }
    let third = ends[0] + along * (ab.dot(ac) / length) + along.perp() * (ab.cross(ac).length() / length);
    let mut placed = [DVec2::ZERO; 3];
    for (corner, at) in [ends[0], ends[1], third].into_iter().enumerate() {
        placed[(first + corner) % 3] = at;
    }
    Some(placed)
}
