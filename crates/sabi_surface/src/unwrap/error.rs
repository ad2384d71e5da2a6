//! Errors of unwrapping.

use crate::model::Mesh;

/// Reason why a mesh cannot be unwrapped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnwrapError {
    /// The model has no triangles.
    #[error("the model has no triangles, so there is no surface to work on; choose a model with faces")]
    NoTriangles,
    /// No triangle covers a texel.
    #[error(
        "no triangle of the model has an area, so there is no surface to work on; look for a scale of zero in your \
         modeling program"
    )]
    NoArea,
    /// The mesh contradicts itself.
    #[error("the mesh is damaged: {what}; export the model again")]
    BrokenMesh {
        /// Contradiction that was found.
        what: String,
    },
    /// More charts than have room on a sheet.
    #[error(
        "the model falls into {charts} pieces that can be laid flat, and one sheet has no room for so many; join its \
         triangles, reduce it or split it in your modeling program"
    )]
    TooManyCharts {
        /// Number of charts.
        charts: usize,
    },
}

/// Checks the mesh before any other step.
pub(super) fn check(mesh: &Mesh) -> Result<(), UnwrapError> {
    let triangles = mesh.triangles.len();
    if triangles == 0 {
        return Err(UnwrapError::NoTriangles);
    }
    let broken = |what: String| Err(UnwrapError::BrokenMesh { what });
    let vertices = mesh.positions.len();
    if mesh.triangle_material.len() != triangles || mesh.triangle_part.len() != triangles {
        return broken("not every triangle has a material and a part".to_owned());
    }
    if triangles >= (1 << 30) {
        return broken(format!("{triangles} triangles are more than can be numbered"));
    }
    let mut corners = mesh.triangles.iter().flatten();
    if let Some(bad) = corners.find(|&&vertex| vertex as usize >= vertices) {
        return broken(format!("a triangle names vertex {bad} of {vertices}"));
    }
    if mesh.positions.as_flattened().iter().any(|value| !value.is_finite()) {
        return broken("a position is no number".to_owned());
    }
    if (0..triangles as u32).all(|triangle| super::area::area(mesh, triangle) <= 0.0) {
        return Err(UnwrapError::NoArea);
    }
    Ok(())
}
