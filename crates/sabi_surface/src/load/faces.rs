//! Faces with any number of corners, whose attributes have separate indices, and their conversion to triangles.

use sabi_cancel::{Cancel, CancelableIterator as _};
use std::collections::HashMap;
use std::ops::Range;

use glam::{DVec3, Vec3};

use super::blur::{StorageErrors, blurred};
use super::far::far_middle;
use super::polygon;
use super::submesh::{Smoothing, Submesh};
use super::warnings::Warnings;
use crate::model::TextureUvs;

/// Marks a corner without a value of an attribute.
pub(super) const NONE: u32 = u32::MAX;

/// Values of an attribute, and for each corner the number of its value. Without values, the file does not have the attribute.
#[derive(Default)]
pub(super) struct Attribute<const N: usize, T = f32> {
    pub(super) values: Vec<[T; N]>,
    /// Number of the value of each corner; [`NONE`] for a corner without a value.
    pub(super) corners: Vec<u32>,
}

/// A face of three or more corners.
pub(super) struct Face {
    /// Range of its corners in [`Faces::corners`].
    pub(super) corners: Range<usize>,
    pub(super) material: u32,
    pub(super) part: u32,
    pub(super) smoothing: Smoothing,
}

/// Faces with checked indices.
#[derive(Default)]
pub(super) struct Faces {
    /// Positions as in the file, with 64 bits: they are rounded to 32 bits only after they were moved near the origin.
    pub(super) positions: Vec<[f64; 3]>,
    /// True if the file stores positions in 32 bits.
    pub(super) is_single: bool,
    /// Position of each corner.
    pub(super) corners: Vec<u32>,
    pub(super) faces: Vec<Face>,
    pub(super) normals: Attribute<3>,
    /// Colors, linear. A corner without a color is white.
    pub(super) colors: Attribute<4>,
    /// The chosen UV set; v grows downward.
    pub(super) uvs: Attribute<2>,
    /// Further sets that textures use, by ascending number.
    pub(super) texture_uvs: Vec<(u32, Attribute<2>)>,
}

impl<const N: usize> Attribute<N> {
    /// Returns the attribute with equal values merged, so that corners with equal values become one vertex.
    pub(super) fn joined(mut self) -> Attribute<N> {
        // Adding 0.0 converts −0 to 0.
        let bits = |value: u32| self.values[value as usize].map(|x| (x + 0.0).to_bits());
        let mut order: Vec<u32> = (0..self.values.len() as u32).collect();
        let cancel = Cancel::current();
        order.sort_unstable_by_key(|value| {
            cancel.look();
            (bits(*value), *value)
        });
        let mut first = vec![0; order.len()];
        for run in order.chunk_by(|a, b| bits(*a) == bits(*b)) {
            for value in run {
                first[*value as usize] = run[0];
            }
        }
        for corner in &mut self.corners {
            *corner = first.get(*corner as usize).copied().unwrap_or(NONE);
        }
        self
    }

    /// Returns the values at the corners `at`; empty if the file does not have the attribute.
    fn gathered(&self, at: &[u32], otherwise: [f32; N]) -> Vec<[f32; N]> {
        if self.values.is_empty() {
            return Vec::new();
        }
        let value = |corner: &u32| {
            let value = self.corners.get(*corner as usize);
            value.and_then(|value| self.values.get(*value as usize)).copied()
        };
        at.iter()
            .looking()
            .map(|corner| value(corner).unwrap_or(otherwise))
            .collect()
    }

    /// Returns the numbers of the values of the corners; `None` if the file does not have the attribute.
    fn numbers(&self) -> Option<&[u32]> {
        (!self.values.is_empty()).then_some(&self.corners[..])
    }
}

impl Faces {
    /// Returns the number of triangles into which the faces are divided.
    pub(super) fn triangles(&self) -> u64 {
        self.faces.iter().map(|face| face.corners.len() as u64 - 2).sum()
    }

    /// Adds a face that consists of the last `count` corners, three or more.
    pub(super) fn close(&mut self, count: usize, material: u32, smoothing: Smoothing) {
        let end = self.corners.len();
        self.faces.push(Face {
            corners: end - count..end,
            material,
            part: 0,
            smoothing,
        });
    }

    /// Divides the faces into triangles, with one vertex for corners that are equal in all attributes. Missing values are
    /// zero, and white for colors.
    pub(super) fn triangulated(&self, budget: &mut polygon::Budget, warnings: &mut Warnings) -> Submesh {
        let (vertices, first_corners) = self.vertices();
        let sets = self.texture_uvs.iter().map(|(set, uvs)| TextureUvs {
            set: *set,
            uvs: uvs.gathered(&first_corners, [0.0; 2]),
            tangents: Vec::new(),
        });
        let position = |corner: u32| DVec3::from(self.positions[self.corners[corner as usize] as usize]);
        let origin = far_middle(first_corners.iter().map(|corner| position(*corner)));
        let near = |corner: u32| position(corner) - origin;
        let mut submesh = Submesh {
            origin,
            positions: first_corners
                .iter()
                .map(|corner| near(*corner).as_vec3().into())
                .collect(),
            normals: self.normals.gathered(&first_corners, [0.0; 3]),
            colors: self.colors.gathered(&first_corners, [1.0; 4]),
            uvs: self.uvs.gathered(&first_corners, [0.0; 2]),
            texture_uvs: sets.filter(|set| !set.uvs.is_empty()).collect(),
            ..Submesh::default()
        };
        let mut outline: Vec<[f32; 3]> = Vec::new();
        for face in self.faces.iter().looking() {
            let before = submesh.triangles.len();
            let numbers = &vertices[face.corners.clone()];
            outline.clear();
            outline.extend(numbers.iter().map(|vertex| submesh.positions[*vertex as usize]));
            polygon::triangulate(&outline, budget, |triangle| {
                submesh.triangles.push(triangle.map(|corner| numbers[corner]));
            });
            let more = submesh.triangles.len() - before;
            submesh.materials.extend(std::iter::repeat_n(face.material, more));
            submesh.parts.extend(std::iter::repeat_n(face.part, more));
            submesh.smoothing.extend(std::iter::repeat_n(face.smoothing, more));
        }
        let exact = |vertex: usize| near(first_corners[vertex]);
        if self.is_single {
            let stored = |corner: u32| -> [f32; 3] { position(corner).as_vec3().into() };
            let errors = StorageErrors::of(first_corners.iter().map(|corner| stored(*corner)));
            let error = |vertex: usize| errors.at(stored(first_corners[vertex]));
            submesh.blurred_by_file = blurred(&submesh.triangles, exact, error);
        } else {
            let rounded = |vertex: usize| Vec3::from(submesh.positions[vertex]).as_dvec3();
            let error = |vertex: usize| exact(vertex).distance(rounded(vertex));
            submesh.blurred = blurred(&submesh.triangles, exact, error);
        }
        if budget.is_spent() {
            warnings.add("Some hollow faces have too many corners to be cut up well; triangulate the model on export.");
        }
        submesh
    }

    /// Returns the vertex of each corner and the first corner of each vertex. Vertices are in the order of their first corners.
    fn vertices(&self) -> (Vec<u32>, Vec<u32>) {
        let mut vertices = self.corners.clone();
        let textures = self.texture_uvs.iter().map(|(_, uvs)| uvs.numbers());
        let own = [self.uvs.numbers(), self.normals.numbers(), self.colors.numbers()];
        let attributes = own.into_iter().chain(textures).flatten();
        let mut first_corners = renumbered(&mut vertices, |_| 0);
        for numbers in attributes {
            first_corners = renumbered(&mut vertices, |corner| numbers.get(corner).copied().unwrap_or(NONE));
        }
        (vertices, first_corners)
    }
}

/// Renumbers vertices so that corners share a vertex only if `number` agrees, too. Returns the first corner of each vertex.
fn renumbered(vertices: &mut [u32], number: impl Fn(usize) -> u32) -> Vec<u32> {
    let mut known: HashMap<(u32, u32), u32> = HashMap::new();
    let mut first_corners = Vec::new();
    for (corner, vertex) in vertices.iter_mut().enumerate().looking() {
        *vertex = *known.entry((*vertex, number(corner))).or_insert_with(|| {
            first_corners.push(corner as u32);
            first_corners.len() as u32 - 1
        });
    }
    first_corners
}
