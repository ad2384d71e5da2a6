//! Converts directions from the model to the space of a mesh of its file.

use glam::{DMat3, DVec3, Vec3};
use sabi_surface::model::PlacedPrimitive;

/// The inverse transform, from the model to a mesh of the file.
pub(super) struct InverseTransform {
    model_from_file: DMat3,
    /// The matrix, up to a scale factor.
    file_from_model: DMat3,
    pub(super) is_mirrored: bool,
}

impl InverseTransform {
    /// The frame of a placed primitive.
    pub(super) fn of(placed: &PlacedPrimitive) -> InverseTransform {
        let model_from_file = DMat3::from_cols_array_2d(&placed.model_from_file);
        let is_mirrored = model_from_file.determinant() < 0.0;
        let sign = if is_mirrored { -1.0 } else { 1.0 };
        // The adjugate matrix is the inverse times the determinant, and exists for singular matrices as well.
        let [a, b, c] = [model_from_file.x_axis, model_from_file.y_axis, model_from_file.z_axis];
        let adjugate = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b)).transpose();
        InverseTransform {
            model_from_file,
            file_from_model: adjugate * sign,
            is_mirrored,
        }
    }

    fn is_identity(&self) -> bool {
        self.model_from_file == DMat3::IDENTITY
    }

    /// Converts a unit normal. The inverse transpose of the node's matrix converts it to the model, so the transpose converts it back.
    pub(super) fn normal(&self, normal: [f32; 3]) -> [f32; 3] {
        if self.is_identity() {
            return normal;
        }
        let back = self.model_from_file.transpose() * Vec3::from(normal).as_dvec3();
        unit(back).unwrap_or(normal)
    }

    /// Converts a tangent. If a node flattens the mesh, there is no inverse, and any direction is valid.
    pub(super) fn tangent(&self, tangent: [f32; 4]) -> [f32; 4] {
        if self.is_identity() {
            return tangent;
        }
        let [x, y, z, w] = tangent;
        let back = unit(self.file_from_model * Vec3::new(x, y, z).as_dvec3());
        let [x, y, z] = back.unwrap_or([x, y, z]);
        [x, y, z, if self.is_mirrored { -w } else { w }]
    }
}

fn unit(vector: DVec3) -> Option<[f32; 3]> {
    let unit = vector.try_normalize().filter(|unit| unit.is_finite())?;
    Some(unit.as_vec3().into())
}
