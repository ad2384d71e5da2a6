//! Mesh with new texture coordinates: vertices split along the charts' borders, tangents recomputed.

use crate::load::{Piece, tangents_for_uvs};
use crate::model::{Mesh, TextureUvs};

/// The mesh with these corners as its texture coordinates, and for each vertex the one that it was.
pub(super) fn redraw(mesh: &Mesh, corners: &[[[f32; 2]; 3]]) -> (Mesh, Vec<u32>) {
    let mut piece = Piece {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        colors: mesh.colors.clone(),
        texture_uvs: mesh.texture_uvs.clone(),
        triangles: mesh.triangles.clone(),
        sources: (0..mesh.positions.len() as u32).collect(),
        ..Piece::default()
    };
    if let Some(set) = mesh.uv_set {
        // Its pictures, and its normal maps with their frames, are still laid out by it.
        let place = piece.texture_uvs.partition_point(|other| other.set < set);
        let (uvs, tangents) = (mesh.uvs.clone(), mesh.tangents.clone());
        piece.texture_uvs.insert(place, TextureUvs { set, uvs, tangents });
    }
    piece.uvs = piece.split_by(corners.as_flattened());
    tangents_for_uvs(&mut piece);
    let mesh = Mesh {
        positions: piece.positions,
        normals: piece.normals,
        tangents: piece.tangents,
        uvs: piece.uvs,
        uv_set: None,
        is_one_sheet: true,
        texture_uvs: piece.texture_uvs,
        missing_uvs: mesh.missing_uvs.clone(),
        colors: piece.colors,
        triangles: piece.triangles,
        triangle_material: mesh.triangle_material.clone(),
        triangle_part: mesh.triangle_part.clone(),
    };
    (mesh, piece.sources)
}
