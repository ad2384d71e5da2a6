//! Guarantees that every loaded model keeps.

use sabi_surface::model::Model;

/// Checks the guarantees of a model.
pub(crate) fn check(model: &Model) {
    let mesh = &model.mesh;
    let count = mesh.positions.len();
    assert!(!mesh.triangles.is_empty() && !model.materials.is_empty() && !model.parts.is_empty());
    assert_eq!([mesh.normals.len(), mesh.tangents.len()], [count; 2]);
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == count);
    assert!(mesh.colors.is_empty() || mesh.colors.len() == count);
    assert_eq!(
        [mesh.triangle_material.len(), mesh.triangle_part.len()],
        [mesh.triangles.len(); 2]
    );
    assert!(
        mesh.triangles
            .as_flattened()
            .iter()
            .all(|vertex| (*vertex as usize) < count)
    );
    assert!(
        mesh.triangle_material
            .iter()
            .all(|material| (*material as usize) < model.materials.len())
    );
    assert!(
        mesh.triangle_part
            .iter()
            .all(|part| (*part as usize) < model.parts.len())
    );
    assert!(
        mesh.positions
            .as_flattened()
            .iter()
            .chain(mesh.uvs.as_flattened())
            .all(|x| x.is_finite())
    );
    if let Some(origins) = &model.origins {
        assert_eq!(origins.vertices.len(), count);
        let mut next = 0;
        for placed in &origins.placed {
            assert_eq!(placed.triangles.start, next);
            next = placed.triangles.end;
        }
        assert_eq!(next as usize, mesh.triangles.len());
    }
    assert_eq!(model.origins.is_some(), model.is_gltf);
    assert!(mesh.colors.as_flattened().iter().all(|x| x.is_finite()));
    let unit = |vector: &[f32]| (vector.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-4;
    assert!(mesh.normals.iter().all(|normal| unit(normal)));
    assert!(
        mesh.tangents
            .iter()
            .all(|tangent| unit(&tangent[..3]) && tangent[3].abs() == 1.0)
    );
}
