//! A mesh rebuilt with new texture coordinates: vertices split along the borders of charts, tangents recomputed.

use std::collections::BTreeSet;

use crate::load::{Submesh, tangents_for_uvs};
use crate::model::{Mesh, TextureUvs};

/// Returns the mesh with new texture coordinates, given for each corner, and for each vertex the vertex from which it was
/// made. `unwrapped` are the materials with new sheets; `None` means all of them, on one sheet.
pub(super) fn rebuild(mesh: &Mesh, corners: &[[[f32; 2]; 3]], unwrapped: Option<&BTreeSet<u32>>) -> (Mesh, Vec<u32>) {
    let mut submesh = Submesh {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        colors: mesh.colors.clone(),
        texture_uvs: mesh.texture_uvs.clone(),
        triangles: mesh.triangles.clone(),
        sources: (0..mesh.positions.len() as u32).collect(),
        ..Submesh::default()
    };
    if let Some(set) = mesh.uv_set {
        // The model's own textures, and the frames of its normal maps, still use this set.
        let place = submesh.texture_uvs.partition_point(|other| other.set < set);
        let (uvs, tangents) = (mesh.uvs.clone(), mesh.tangents.clone());
        submesh.texture_uvs.insert(place, TextureUvs { set, uvs, tangents });
    }
    submesh.uvs = submesh.split_by(corners.as_flattened());
    tangents_for_uvs(&mut submesh);
    let mesh = Mesh {
        positions: submesh.positions,
        normals: submesh.normals,
        tangents: submesh.tangents,
        uvs: submesh.uvs,
        uv_set: None,
        is_one_sheet: unwrapped.is_none(),
        // The new charts lie inside the unit square.
        repeating: match unwrapped {
            Some(unwrapped) => mesh.repeating.difference(unwrapped).copied().collect(),
            None => BTreeSet::new(),
        },
        texture_uvs: submesh.texture_uvs,
        missing_uvs: mesh.missing_uvs.clone(),
        colors: submesh.colors,
        triangles: submesh.triangles,
        triangle_material: mesh.triangle_material.clone(),
        triangle_part: mesh.triangle_part.clone(),
    };
    (mesh, submesh.sources)
}
