//! Paths along the edges of a model.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use sabi_surface::NO_TWIN;
use sabi_surface::patch::Site;

use super::fit::{bend_between, simplified};
use super::{Bend, Path, knot_at};
use crate::surface::PaintSurface;

/// Minimum angle between the triangles at a hard edge, as a cosine: 30°.
const HARD_COSINE: f64 = 0.866_025_403_784_438_6;
/// Largest change of direction with which a path continues if several edges meet, as a cosine: 45°.
const STRAIGHT_COSINE: f64 = 0.707;
/// Maximum distance of the path from the edges, as a share of its extent.
const TOLERANCE: f64 = 0.002;
/// Maximum number of edges of a path.
const EDGES_LIMIT: usize = 100_000;

/// Kind of edge that a path follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgeKind {
    /// Edges at which the surface bends by more than 30°, and borders of the surface.
    #[default]
    Hard,
    /// Seams of the texture.
    Seam,
    /// Borders between materials.
    Material,
}

impl EdgeKind {
    /// All kinds with their titles.
    pub const ALL: [(EdgeKind, &'static str); 3] = [
        (EdgeKind::Hard, "Hard edges"),
        (EdgeKind::Seam, "Seams"),
        (EdgeKind::Material, "Materials"),
    ];

    /// Returns true if a half-edge is of this kind.
    fn contains(self, surface: &PaintSurface<'_>, half_edge: u32) -> bool {
        let connected = surface.connected();
        let mesh = surface.mesh();
        let twin = connected.topology.twins[half_edge as usize];
        let (own, other) = (half_edge / 3, twin / 3);
        match self {
            _ if twin == NO_TWIN => self != EdgeKind::Material,
            EdgeKind::Hard => connected.normal(own).dot(connected.normal(other)) < HARD_COSINE,
            EdgeKind::Material => mesh.triangle_material[own as usize] != mesh.triangle_material[other as usize],
            EdgeKind::Seam => {
                let uv = |half_edge: u32, end: u32| {
                    let corner = (half_edge % 3 + end) % 3;
                    mesh.uvs[mesh.triangles[half_edge as usize / 3][corner as usize] as usize]
                };
                uv(half_edge, 0) != uv(twin, 1) || uv(half_edge, 1) != uv(twin, 0)
            }
        }
    }
}

/// Edges of a kind by the welded vertices at their ends.
struct EdgeNet<'a> {
    surface: &'a PaintSurface<'a>,
    /// For each vertex, the half-edges that start or end there, one of each pair.
    at_vertex: BTreeMap<u32, Vec<u32>>,
}

impl<'a> EdgeNet<'a> {
    fn new(surface: &'a PaintSurface<'a>, kind: EdgeKind) -> EdgeNet<'a> {
        let twins = &surface.connected().topology.twins;
        let mut net = EdgeNet {
            surface,
            at_vertex: BTreeMap::new(),
        };
        for half_edge in 0..twins.len() as u32 {
            let twin = twins[half_edge as usize];
            let is_first = twin == NO_TWIN || half_edge < twin;
            if is_first && kind.contains(surface, half_edge) {
                for end in net.ends(half_edge) {
                    net.at_vertex.entry(end).or_default().push(half_edge);
                }
            }
        }
        net
    }

    /// Returns the welded vertices at the ends of a half-edge.
    fn ends(&self, half_edge: u32) -> [u32; 2] {
        let corners = &self.surface.connected().topology.corners;
        let triangle = half_edge - half_edge % 3;
        [half_edge, triangle + (half_edge + 1) % 3].map(|corner| corners[corner as usize])
    }

    /// Returns the positions of the ends of a half-edge, in the order of [`EdgeNet::ends`].
    fn places(&self, half_edge: u32) -> [DVec3; 2] {
        let corners = self.surface.connected().corners(half_edge / 3);
        let first = half_edge as usize % 3;
        [corners[first], corners[(first + 1) % 3]]
    }

    /// Returns the edge nearest to a position, within a distance.
    fn nearest(&self, from: DVec3, reach: f64) -> Option<u32> {
        let distance = |half_edge: u32| {
            let [a, b] = self.places(half_edge);
            let square = (b - a).length_squared().max(f64::MIN_POSITIVE);
            let share = ((from - a).dot(b - a) / square).clamp(0.0, 1.0);
            from.distance(a.lerp(b, share))
        };
        let all = self.at_vertex.values().flatten().copied();
        let near = all.map(|half_edge| (distance(half_edge), half_edge));
        let near = near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        (near.0 <= reach).then_some(near.1)
    }

    /// Returns the edge that continues another edge at a vertex: the only other edge, or the straightest of several if it
    /// is nearly straight.
    fn next(&self, from: u32, vertex: u32) -> Option<u32> {
        let others: Vec<u32> = self
            .at_vertex
            .get(&vertex)?
            .iter()
            .copied()
            .filter(|edge| *edge != from)
            .collect();
        if let [only] = others.as_slice() {
            return Some(*only);
        }
        let toward = self.way(from, vertex, false);
        let straight = others
            .into_iter()
            .map(|edge| (self.way(edge, vertex, true).dot(toward), edge));
        let best = straight.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))?;
        (best.0 >= STRAIGHT_COSINE).then_some(best.1)
    }

    /// Returns the unit direction of an edge toward a vertex, or away from it.
    fn way(&self, edge: u32, vertex: u32, is_away: bool) -> DVec3 {
        let [a, b] = self.places(edge);
        let leaves = self.ends(edge)[0] == vertex;
        let way = if leaves == is_away { b - a } else { a - b };
        way.normalize_or_zero()
    }

    /// Returns the edges that continue an edge at one of its vertices, and whether they lead back to the edge.
    fn chain(&self, first: u32, mut vertex: u32) -> (Vec<u32>, bool) {
        let mut edges = vec![first];
        let mut passed = BTreeSet::from([first]);
        while let Some(next) = self.next(edges[edges.len() - 1], vertex) {
            if next == first {
                return (edges, true);
            }
            if !passed.insert(next) || edges.len() >= EDGES_LIMIT {
                break;
            }
            let [a, b] = self.ends(next);
            vertex = if a == vertex { b } else { a };
            edges.push(next);
        }
        (edges, false)
    }
}

impl Path {
    /// Returns the path along the edges of a kind near a position, as far as they continue; `None` if no such edge is
    /// within `reach`, in model units.
    pub fn along_edges(surface: &PaintSurface<'_>, kind: EdgeKind, from: DVec3, reach: f64) -> Option<Path> {
        let net = EdgeNet::new(surface, kind);
        let first = net.nearest(from, reach)?;
        let [start, end] = net.ends(first);
        let (behind, is_closed) = net.chain(first, end);
        let mut edges = Vec::new();
        if !is_closed {
            let (before, _) = net.chain(first, start);
            edges.extend(before.into_iter().skip(1).rev());
        }
        edges.extend(behind);
        let mut sites = sites_along(&net, &edges);
        if is_closed {
            sites.pop();
        }
        let places: Vec<DVec3> = sites.iter().map(|site| site.position).collect();
        let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let kept = simplified(&places, TOLERANCE * (high - low).length());
        let count = kept.len();
        let knots = kept.iter().enumerate().map(|(index, kept_index)| {
            let is_end = !is_closed && (index == 0 || index + 1 == count);
            let beside = |offset: usize| places[kept[(index + offset) % count]];
            let bend = if is_end {
                Bend::Smooth
            } else {
                bend_between(beside(count - 1), places[*kept_index], beside(1))
            };
            knot_at(surface, sites[*kept_index], bend)
        });
        Some(Path {
            knots: knots.collect::<Option<_>>()?,
            is_closed,
        })
    }
}

/// Returns sites at the vertices along consecutive edges.
fn sites_along(net: &EdgeNet<'_>, edges: &[u32]) -> Vec<Site> {
    let mut sites = Vec::new();
    let mut vertex = None;
    for (index, edge) in edges.iter().enumerate() {
        let ends = net.ends(*edge);
        let places = net.places(*edge);
        // The first edge starts at the vertex that the second edge does not have.
        let is_turned = match vertex {
            Some(vertex) => ends[1] == vertex,
            None => edges
                .get(index + 1)
                .is_some_and(|next| net.ends(*next).contains(&ends[0])),
        };
        let [from, to] = if is_turned { [1, 0] } else { [0, 1] };
        let site = |end: usize| Site {
            triangle: edge / 3,
            position: places[end],
        };
        if index == 0 {
            sites.push(site(from));
        }
        sites.push(site(to));
        vertex = Some(ends[to]);
    }
    sites
}
