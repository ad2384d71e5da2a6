//! A small mesh.

use sabi_surface::model::Mesh;

/// A square of two triangles, with these heights over its corners.
pub fn square(height: impl Fn([f32; 2]) -> f32) -> Mesh {
    let corners = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]];
    Mesh {
        positions: corners.map(|[x, y]| [x, y, height([x, y])]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: corners.to_vec(),
        uv_set: Some(0),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_material: vec![0, 0],
        triangle_part: vec![0, 0],
        ..Mesh::default()
    }
}
