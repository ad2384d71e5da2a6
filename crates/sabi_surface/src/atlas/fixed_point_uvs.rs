//! Texture coordinates in texels: exact ones, and ones that are snapped to a fine grid.

use glam::DVec2;

use super::AtlasError;
use crate::model::Mesh;

/// Number of grid steps in a texel, to which corners are snapped for rasterization.
pub(crate) const UNIT: i64 = 256;
/// Largest distance from the origin, in texels, at which rasterization cannot overflow.
const REACH_TEXELS: f64 = (1u64 << 30) as f64;

/// A mesh's texture coordinates at one size.
#[derive(Clone, Copy)]
pub(super) struct Uvs<'a> {
    mesh: &'a Mesh,
    size: f64,
}

impl<'a> Uvs<'a> {
    /// Checks that the mesh is consistent, and that its texture coordinates are in the range that can be rasterized.
    pub(super) fn check(mesh: &'a Mesh, size: u32) -> Result<Uvs<'a>, AtlasError> {
        if mesh.triangles.is_empty() {
            return Err(AtlasError::NoTriangles);
        }
        if mesh.uvs.is_empty() {
            return Err(AtlasError::NoUvs);
        }
        let broken = |what: String| Err(AtlasError::BrokenMesh { what });
        let vertices = mesh.positions.len();
        if mesh.uvs.len() != vertices {
            return broken(format!(
                "it has {vertices} positions but {} texture coordinates",
                mesh.uvs.len()
            ));
        }
        let triangles = mesh.triangles.len();
        if mesh.triangle_material.len() != triangles || mesh.triangle_part.len() != triangles {
            return broken("not every triangle has a material and a part".to_owned());
        }
        if triangles >= (1 << 30) {
            return broken(format!("{triangles} triangles are more than can be numbered"));
        }
        if let Some(bad) = mesh
            .triangles
            .iter()
            .flatten()
            .find(|&&vertex| vertex as usize >= vertices)
        {
            return broken(format!("a triangle names vertex {bad} of {vertices}"));
        }
        let size_f = f64::from(size);
        for (vertex, uv) in mesh.uvs.iter().enumerate() {
            let far = |value: f32| value.is_finite() && (f64::from(value) * size_f).abs() > REACH_TEXELS;
            if far(uv[0]) || far(uv[1]) {
                let [u, v] = uv.map(|value| format!("{value:e}"));
                return Err(AtlasError::UvTooFar {
                    vertex: vertex as u32,
                    u,
                    v,
                    size,
                });
            }
        }
        Ok(Uvs { mesh, size: size_f })
    }

    /// Texels for one unit of UV.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Returns the texture coordinates of a vertex; 0 for NaN and infinity.
    fn uv(&self, vertex: u32) -> DVec2 {
        let finite = |value: f32| if value.is_finite() { f64::from(value) } else { 0.0 };
        DVec2::from(self.mesh.uvs[vertex as usize].map(finite))
    }

    /// Returns `uv × size` of a vertex; 0 for NaN and infinity.
    fn texel(&self, vertex: u32) -> DVec2 {
        self.uv(vertex) * self.size
    }

    /// Corners of a triangle in texels of the user's layout.
    pub(super) fn corners(&self, triangle: u32) -> [DVec2; 3] {
        self.mesh.triangles[triangle as usize].map(|vertex| self.texel(vertex))
    }

    /// Corners of a triangle in parts of a texel of the user's layout.
    pub(super) fn fixed(&self, triangle: u32) -> [[i64; 2]; 3] {
        self.corners(triangle)
            .map(|corner| (corner * UNIT as f64).round().as_i64vec2().to_array())
    }

    /// Returns the winding of a triangle in UV: 1, −1, or 0 when its height is within the rounding
    /// error of its coordinates.
    ///
    /// The result does not depend on the size, so that every level has the same charts.
    pub(super) fn orientation(&self, triangle: u32) -> i8 {
        let [a, b, c] = self.mesh.triangles[triangle as usize].map(|vertex| self.uv(vertex));
        let edges = [b - a, c - b, a - c];
        let longest = edges.iter().map(|edge| edge.x.hypot(edge.y)).fold(0.0, f64::max);
        let reach = a.abs().max(b.abs()).max(c.abs()).max_element();
        let area2 = (b - a).perp_dot(c - a);
        // Compare the height over the longest edge with half a step of an f32 at that distance.
        if area2.abs() <= longest * reach * f64::from(f32::EPSILON) {
            0
        } else {
            area2.signum() as i8
        }
    }
}
