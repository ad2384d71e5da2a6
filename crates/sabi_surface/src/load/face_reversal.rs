//! Reversal of faces that are inside out. Which faces are inside out depends on the whole model, so all of it is placed first.

use super::submesh::Submesh;
use super::warnings::Warnings;
use super::{normals, tangents};
use crate::model::{Mesh, Model, TextureUvs};
use crate::orientation::turned_faces;

/// Copies of the placed triangles, kept only if faces are to be reversed.
pub(super) struct FaceReversal {
    held: Option<Vec<Submesh>>,
}

impl FaceReversal {
    pub(super) fn new(is_wanted: bool) -> FaceReversal {
        FaceReversal {
            held: is_wanted.then(Vec::new),
        }
    }

    /// Keeps a copy of triangles that are appended to the mesh of the model.
    pub(super) fn hold(&mut self, placed: &Submesh) {
        if let Some(held) = &mut self.held {
            held.push(placed.clone());
        }
    }

    /// Reverses the faces of a model that are inside out. Copies of all its triangles must have been kept, for a glTF file
    /// by placed primitives.
    pub(super) fn apply(self, model: &mut Model, [with_uvs, with_colors]: [bool; 2], warnings: &mut Warnings) {
        let turned = match &self.held {
            Some(_) => turned_faces(&model.mesh),
            None => return,
        };
        model.turned_faces = turned.len();
        if turned.is_empty() {
            return;
        }
        let mut is_turned = vec![false; model.mesh.triangles.len()];
        for face in turned {
            is_turned[face as usize] = true;
        }
        let empty = |other: &TextureUvs| TextureUvs {
            set: other.set,
            ..TextureUvs::default()
        };
        model.mesh = Mesh {
            uv_set: model.mesh.uv_set,
            texture_uvs: model.mesh.texture_uvs.iter().map(empty).collect(),
            ..Mesh::default()
        };
        let mut origins = model.origins.as_mut();
        if let Some(origins) = &mut origins {
            origins.vertices.clear();
        }
        // Without reversal, no copies are kept.
        for (number, mut submesh) in self.held.unwrap_or_default().into_iter().enumerate() {
            let first = model.mesh.triangles.len();
            let is_turned = &is_turned[first..first + submesh.triangles.len()];
            let has_turned = is_turned.contains(&true);
            if has_turned {
                submesh.turn(is_turned, warnings);
            }
            if let Some(origins) = &mut origins {
                origins.vertices.append(&mut submesh.sources);
                if let Some(placed) = origins.placed.get_mut(number).filter(|_| has_turned) {
                    placed.is_turned = true;
                    placed.has_own_tangents = false;
                }
            }
            submesh.append_to(&mut model.mesh, with_uvs, with_colors);
        }
    }
}

impl Submesh {
    /// Reverses some of the faces. Tangents are computed again, since those of a file belong to the file's normals.
    fn turn(&mut self, is_turned: &[bool], warnings: &mut Warnings) {
        for (corners, _) in self
            .triangles
            .iter_mut()
            .zip(is_turned)
            .filter(|(_, is_turned)| **is_turned)
        {
            corners.swap(1, 2);
        }
        let framed: Vec<bool> = self.texture_uvs.iter().map(|set| !set.tangents.is_empty()).collect();
        self.tangents.clear();
        for set in &mut self.texture_uvs {
            set.tangents.clear();
        }
        normals::follow_turned(self, is_turned);
        let who = "the model";
        tangents::complete(self, who, warnings);
        for index in (0..framed.len()).filter(|index| framed[*index]) {
            self.swap_set(index);
            tangents::complete(self, who, warnings);
            self.swap_set(index);
        }
    }
}
