//! Surface points in the UV sets of the model's own textures.

use glam::DVec3;
use sabi_surface::model::TextureUvs;

use super::sampler::Footprint;
use super::texels::{Frame, SourceSurface, SurfacePoint};

impl SourceSurface<'_> {
    /// Returns the footprint of a texel on a picture in the layout of the atlas, or of another UV set.
    pub(super) fn footprint(&self, point: &SurfacePoint, other: Option<&TextureUvs>) -> Footprint {
        let width = 1.0 / f64::from(self.atlas.size);
        let steps = [[width, 0.0], [0.0, width]];
        let Some(other) = other else {
            return Footprint { uv: point.uv, steps };
        };
        let corners = self.corners(point).map(|corner| other.uvs[corner].map(f64::from));
        let at = |[u, v]: [f64; 2]| blend(self.weights(point, [point.uv[0] + u, point.uv[1] + v]), corners);
        let uv = at([0.0; 2]);
        let steps = steps.map(|step| {
            let ahead = at(step);
            [ahead[0] - uv[0], ahead[1] - uv[1]]
        });
        Footprint { uv, steps }
    }

    /// Returns the tangent frame of a normal map in the layout of the atlas, or of another UV set.
    pub(super) fn frame_of(&self, point: &SurfacePoint, other: Option<&TextureUvs>) -> Frame {
        let Some(other) = other.filter(|other| !other.tangents.is_empty()) else {
            return self.frame(point);
        };
        let (corners, weights) = (self.corners(point), self.weights(point, point.uv));
        let tangents = corners.map(|corner| other.tangents[corner].map(f64::from));
        let [x, y, z, _] = blend(weights, tangents);
        let normals = corners.map(|corner| self.model.mesh.normals[corner].map(f64::from));
        Frame::new(
            DVec3::from(blend(weights, normals)),
            DVec3::new(x, y, z),
            tangents[0][3],
        )
    }

    fn corners(&self, point: &SurfacePoint) -> [usize; 3] {
        self.model.mesh.triangles[point.triangle].map(|corner| corner as usize)
    }

    /// Returns the barycentric weights of the second and third corner at texture coordinates; 0 for a triangle without area.
    pub(super) fn weights(&self, point: &SurfacePoint, uv: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self
            .corners(point)
            .map(|corner| self.model.mesh.uvs[corner].map(f64::from));
        let from_a = |to: [f64; 2]| [to[0] - a[0], to[1] - a[1]];
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let (ab, ac, at) = (from_a(b), from_a(c), from_a(uv));
        let area = cross(ab, ac);
        if area == 0.0 {
            return [0.0; 2];
        }
        [cross(at, ac) / area, cross(ab, at) / area]
    }
}

/// Interpolates values of the corners.
fn blend<const N: usize>([second, third]: [f64; 2], [a, b, c]: [[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|at| a[at] + (b[at] - a[at]) * second + (c[at] - a[at]) * third)
}
