//! Conversion of a mesh of the scene to a submesh.

use glam::DVec3;
use sabi_color::linear_from_srgb;
use ufbx::{Mesh, VertexVec2, VertexVec3, VertexVec4};

use super::FbxSourceMesh;
use crate::load::LoadOptions;
use crate::load::assembly::TextureUvSets;
use crate::load::completion::{Completion, LACKING_NORMALS};
use crate::load::faces::{Attribute, Faces, NONE};
use crate::load::normals::NormalMethod;
use crate::load::polygon::Budget;
use crate::load::submesh::{Smoothing, Submesh};
use crate::load::warnings::Warnings;

/// Reader of one mesh.
pub(super) struct FbxMeshReader<'r> {
    pub(super) options: &'r LoadOptions,
    pub(super) sets: &'r TextureUvSets,
}

impl FbxMeshReader<'_> {
    /// Reads a mesh in its own space.
    pub(super) fn read(&self, source: &FbxSourceMesh, budget: &mut Budget, warnings: &mut Warnings) -> Submesh {
        let FbxSourceMesh { mesh, who, .. } = source;
        let mut faces = outlines(mesh, who, warnings);
        let corners = kept_corners(mesh);
        if has_own_smoothing(mesh) {
            faces.normals = directions(&mesh.vertex_normal, &corners).joined();
        }
        faces.colors = colors(&mesh.vertex_color, &corners).joined();
        for (set, uvs) in mesh.uv_sets.iter().enumerate() {
            let set = set as u32;
            if set == self.options.uv_set {
                faces.uvs = coordinates(&uvs.vertex_uv, &corners).joined();
            } else if self.sets.all.contains(&set) {
                faces
                    .texture_uvs
                    .push((set, coordinates(&uvs.vertex_uv, &corners).joined()));
            }
        }
        let mut submesh = faces.triangulated(budget, warnings);
        let completion = Completion {
            repaired_normals: LACKING_NORMALS,
            missing: NormalMethod::Crease,
            smooth_degrees: self.options.smooth_degrees,
        };
        completion.complete(&mut submesh, &self.sets.framed, who, warnings);
        submesh
    }
}

/// Returns true if the mesh has normals, or smoothing from which they were computed.
fn has_own_smoothing(mesh: &Mesh) -> bool {
    let has_smoothing = !mesh.face_smoothing.is_empty() || !mesh.edge_smoothing.is_empty();
    mesh.vertex_normal.exists && (!mesh.generated_normals || has_smoothing)
}

/// Returns the faces that are kept, as ranges of the mesh's own corners, with their numbers.
fn kept_faces(mesh: &Mesh) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> {
    let is_hole = |face: usize| mesh.face_hole.get(face).copied() == Some(true);
    let faces = mesh.faces.iter().enumerate();
    faces.filter_map(move |(number, face)| {
        let first = face.index_begin as usize;
        let corners = first..first.checked_add(face.num_indices as usize)?;
        let is_whole = corners.len() >= 3 && corners.end <= mesh.vertex_indices.len();
        (is_whole && !is_hole(number)).then_some((number, corners))
    })
}

/// Returns the mesh's own numbers of the corners that are kept.
fn kept_corners(mesh: &Mesh) -> Vec<usize> {
    kept_faces(mesh).flat_map(|(_, corners)| corners).collect()
}

fn outlines(mesh: &Mesh, who: &str, warnings: &mut Warnings) -> Faces {
    let mut faces = Faces::default();
    let vertices = mesh.vertices.len();
    for (number, corners) in kept_faces(mesh) {
        let count = corners.len();
        let named = &mesh.vertex_indices.as_ref()[corners];
        // The library has clamped the indices. A missing vertex would be an error in the library.
        faces.corners.extend(
            named
                .iter()
                .map(|vertex| (*vertex).min(vertices.saturating_sub(1) as u32)),
        );
        let material = mesh.face_material.get(number).copied().unwrap_or(0);
        faces.close(count, material, Smoothing::ByAngle);
    }
    faces.positions = mesh.vertices.iter().map(|at| [at.x, at.y, at.z]).collect();
    if vertices == 0 {
        faces.faces.clear();
    }
    if mesh.num_point_faces + mesh.num_line_faces > 0 {
        warnings.add(format!("Points and lines of {who} are left out."));
    }
    faces
}

fn directions(from: &VertexVec3, corners: &[usize]) -> Attribute<3> {
    let value = |at: &ufbx::Vec3| DVec3::new(at.x, at.y, at.z).as_vec3().to_array();
    attribute(from.exists, &from.values, &from.indices, corners, value)
}

fn coordinates(from: &VertexVec2, corners: &[usize]) -> Attribute<2> {
    attribute(from.exists, &from.values, &from.indices, corners, |at| {
        [at.x as f32, (1.0 - at.y) as f32]
    })
}

fn colors(from: &VertexVec4, corners: &[usize]) -> Attribute<4> {
    attribute(from.exists, &from.values, &from.indices, corners, |color| {
        let light = |share: f64| linear_from_srgb((share as f32).clamp(0.0, 1.0));
        [light(color.x), light(color.y), light(color.z), color.w as f32]
    })
}

/// Returns an attribute of the mesh for the corners that are kept.
fn attribute<T, const N: usize>(
    exists: bool,
    values: &[T],
    indices: &[u32],
    corners: &[usize],
    value: impl Fn(&T) -> [f32; N],
) -> Attribute<N> {
    if !exists {
        return Attribute::default();
    }
    Attribute {
        values: values.iter().map(value).collect(),
        corners: corners
            .iter()
            .map(|corner| indices.get(*corner).copied().unwrap_or(NONE))
            .collect(),
    }
}
