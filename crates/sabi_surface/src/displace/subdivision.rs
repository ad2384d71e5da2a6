//! Subdivision of one triangle until no edge is too long.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};

use crate::atlas::Atlas;
use crate::model::Mesh;

/// Attributes that are interpolated over a triangle.
#[derive(Clone, Copy)]
pub(super) struct SplitVertex {
    pub(super) position: [f32; 3],
    pub(super) normal: [f32; 3],
    pub(super) tangent: [f32; 4],
    pub(super) uv: [f32; 2],
    pub(super) texel: [f32; 2],
}

impl SplitVertex {
    fn middle(&self, other: &SplitVertex) -> SplitVertex {
        SplitVertex {
            position: middle(self.position, other.position),
            normal: middle(self.normal, other.normal),
            tangent: middle(self.tangent, other.tangent),
            uv: middle(self.uv, other.uv),
            texel: middle(self.texel, other.texel),
        }
    }
}

/// Returns the midpoint, with the same bits for both orders of the ends. The ends are halved before the sum, so that it cannot overflow.
fn middle<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    std::array::from_fn(|axis| a[axis] * 0.5 + b[axis] * 0.5)
}

/// Result of subdividing a triangle of the mesh.
pub(super) struct SplitTriangle {
    /// The three corners of the triangle first.
    pub(super) vertices: Vec<SplitVertex>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Angles at the three corners, radians; all zero for a triangle without area, which has no normal.
    angles: [f64; 3],
}

impl SplitTriangle {
    pub(super) fn new(mesh: &Mesh, atlas: &Atlas, triangle: usize, edge_length: f32) -> SplitTriangle {
        let corners = mesh.triangles[triangle];
        let texels = atlas.triangle_texels[triangle];
        let vertices: Vec<SplitVertex> = corners
            .iter()
            .zip(texels)
            .map(|(&vertex, texel)| SplitVertex {
                position: mesh.positions[vertex as usize],
                // Attributes that the mesh does not have are zero in its copy, too.
                normal: mesh.normals.get(vertex as usize).copied().unwrap_or_default(),
                // Missing tangents are zero, like missing normals.
                tangent: mesh.tangents.get(vertex as usize).copied().unwrap_or_default(),
                // Missing UVs are zero, like missing normals.
                uv: mesh.uvs.get(vertex as usize).copied().unwrap_or_default(),
                texel,
            })
            .collect();
        let angles = angles([0, 1, 2].map(|corner| vertices[corner].position));
        let mut split = SplitTriangle {
            vertices,
            triangles: vec![[0, 1, 2]],
            angles,
        };
        let mut middles = HashMap::new();
        while split.cut_once(edge_length, &mut middles) {}
        split
    }

    /// Returns the angle of this triangle at a vertex in radians; pi for a vertex on an edge.
    pub(super) fn weight(&self, vertex: usize) -> f64 {
        match self.angles.get(vertex) {
            Some(angle) => *angle,
            None if self.angles == [0.0; 3] => 0.0,
            None => PI,
        }
    }

    /// Returns a step along the surface in texels, in the plane of this triangle; zero for a triangle without area.
    pub(super) fn texels_of(&self, step: DVec3) -> [f64; 2] {
        let at = |corner: usize| Vec3::from(self.vertices[corner].position).as_dvec3();
        let texel = |corner: usize| DVec2::from(self.vertices[corner].texel.map(f64::from));
        let (u, v) = (at(1) - at(0), at(2) - at(0));
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let determinant = uu * vv - uv * uv;
        let [along_u, along_v] = [step.dot(u), step.dot(v)];
        let texels = (texel(1) - texel(0)) * ((along_u * vv - along_v * uv) / determinant)
            + (texel(2) - texel(0)) * ((along_v * uu - along_u * uv) / determinant);
        if texels.is_finite() {
            texels.to_array()
        } else {
            [0.0; 2]
        }
    }

    /// Splits each triangle at all of its edges that are too long. Returns true if there were any. `middles` contains the
    /// vertices at the midpoints of edges, by the ends of the edge.
    fn cut_once(&mut self, edge_length: f32, middles: &mut HashMap<[u32; 2], u32>) -> bool {
        let before = std::mem::take(&mut self.triangles);
        self.triangles.reserve(before.len() * 4);
        for &corners in &before {
            let cut = SubdivisionStep::new(
                corners.map(|corner| self.vertices[corner as usize].position),
                edge_length,
            );
            let mut slots = [corners[0], corners[1], corners[2], 0, 0, 0];
            for edge in (0..3).filter(|&edge| cut.long[edge]) {
                let [from, to] = [corners[edge], corners[(edge + 1) % 3]];
                let vertices = &mut self.vertices;
                slots[3 + edge] = *middles.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                    vertices.push(vertices[from as usize].middle(&vertices[to as usize]));
                    vertices.len() as u32 - 1
                });
            }
            let parts = cut.parts().iter();
            self.triangles.extend(parts.map(|part| part.map(|slot| slots[slot])));
        }
        self.triangles.len() > before.len()
    }
}

/// Returns the number of triangles into which a triangle is split, or some number above `most`.
pub(super) fn count(corners: [[f32; 3]; 3], edge_length: f32, most: u64) -> u64 {
    let mut open = vec![corners];
    let mut found = 0;
    while let Some(corners) = open.pop() {
        let cut = SubdivisionStep::new(corners, edge_length);
        if cut.long == [false; 3] {
            found += 1;
        } else {
            let parts = cut.parts().iter();
            open.extend(parts.map(|part| part.map(|slot| cut.slots[slot])));
        }
        // Each open triangle becomes at least one triangle.
        if found + open.len() as u64 > most {
            return most + 1;
        }
    }
    found
}

/// One subdivision step of a triangle, at the midpoints of the edges that are too long.
struct SubdivisionStep {
    /// Its corners, and the middles of its edges: edge `k`, from corner `k` to the next, has slot `3 + k`.
    slots: [[f32; 3]; 6],
    /// True for each edge that is too long.
    long: [bool; 3],
}

impl SubdivisionStep {
    fn new([a, b, c]: [[f32; 3]; 3], edge_length: f32) -> SubdivisionStep {
        let slots = [a, b, c, middle(a, b), middle(b, c), middle(c, a)];
        let most = f64::from(edge_length).powi(2);
        let is_long = |a, b| {
            let square = square(a, b);
            square > most && square.is_finite()
        };
        let long = [is_long(a, b), is_long(b, c), is_long(c, a)];
        SubdivisionStep { slots, long }
    }

    /// Returns the parts as slots, wound as the triangle is.
    fn parts(&self) -> &'static [[usize; 3]] {
        // Tables by edge: of the only edge that is split, and of the only edge that is not split, with the diagonal from
        // its start or from its end.
        const ONE: [[[usize; 3]; 2]; 3] = [[[0, 3, 2], [3, 1, 2]], [[1, 4, 0], [4, 2, 0]], [[2, 5, 1], [5, 0, 1]]];
        const FROM_START: [[[usize; 3]; 3]; 3] = [
            [[5, 4, 2], [0, 1, 4], [0, 4, 5]],
            [[3, 5, 0], [1, 2, 5], [1, 5, 3]],
            [[4, 3, 1], [2, 0, 3], [2, 3, 4]],
        ];
        const FROM_END: [[[usize; 3]; 3]; 3] = [
            [[5, 4, 2], [0, 1, 5], [1, 4, 5]],
            [[3, 5, 0], [1, 2, 3], [2, 5, 3]],
            [[4, 3, 1], [2, 0, 4], [0, 3, 4]],
        ];
        let by_shorter = |whole: usize| {
            let (start, end) = (whole, (whole + 1) % 3);
            let from_start = square(self.slots[start], self.slots[3 + end]);
            let from_end = square(self.slots[end], self.slots[3 + (end + 1) % 3]);
            if from_start <= from_end {
                FROM_START[whole].as_slice()
            } else {
                FROM_END[whole].as_slice()
            }
        };
        match self.long {
            [false, false, false] => &[[0, 1, 2]],
            [true, false, false] => &ONE[0],
            [false, true, false] => &ONE[1],
            [false, false, true] => &ONE[2],
            [false, true, true] => by_shorter(0),
            [true, false, true] => by_shorter(1),
            [true, true, false] => by_shorter(2),
            [true, true, true] => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        }
    }
}

/// Returns the square of a distance, with the same bits for both orders of the ends.
fn square(a: [f32; 3], b: [f32; 3]) -> f64 {
    Vec3::from(a).as_dvec3().distance_squared(Vec3::from(b).as_dvec3())
}

fn angles(corners: [[f32; 3]; 3]) -> [f64; 3] {
    let corners = corners.map(|corner| Vec3::from(corner).as_dvec3());
    let edge = |from: usize, to: usize| corners[to % 3] - corners[from % 3];
    if edge(0, 1).cross(edge(0, 2)) == DVec3::ZERO {
        return [0.0; 3];
    }
    [0, 1, 2].map(|corner| {
        let angle = edge(corner, corner + 1).angle_between(edge(corner, corner + 2));
        if angle.is_finite() { angle } else { 0.0 }
    })
}
