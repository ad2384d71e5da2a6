//! The point of the model under the pointer.

use glam::{DVec3, Vec3};
use sabi_surface::atlas::Atlas;
use sabi_surface::bvh::Bvh;
use sabi_surface::model::Mesh;

use crate::{Placement, Ray};

#[cfg(test)]
mod tests;

/// Radius that encloses every model: half the diagonal of a model's box in view space is at most 0.87.
const MODEL_RADIUS: f64 = 1.0;

/// First hit of a ray with the surface, from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedPoint {
    /// Triangle, an index into [`Mesh::triangles`].
    pub triangle: u32,
    /// Barycentric coordinates. They are not negative, and their sum is 1.
    pub barycentric: [f32; 3],
    /// Texture coordinates; zero for a mesh that has none.
    pub uv: [f32; 2],
    /// Chart of the atlas.
    pub chart: u32,
    /// Page of the atlas.
    pub page: u32,
    /// Position on that page in texels.
    pub texel: [f32; 2],
    /// Position on the material's map in texels from its upper left corner. The map repeats outside of the unit square.
    pub map_texel: [f32; 2],
    /// Position in model units.
    pub position: Vec3,
    /// Position in view space.
    pub position_view: Vec3,
    /// Interpolated shading normal, unit length. It points out of the surface even if the back is hit.
    pub normal: Vec3,
    /// Normal of the triangle itself, unit length; zero for a triangle without area.
    pub face_normal: Vec3,
    /// True if the ray hit the back of the surface.
    pub is_back_face: bool,
    /// Material, an index into [`sabi_surface::model::Model::materials`].
    pub material: u32,
    /// Part, an index into [`sabi_surface::model::Model::parts`].
    pub part: u32,
    /// Distance from the ray's origin, view units.
    pub distance: f32,
}

/// Returns the first hit of a ray in view space with a mesh. The hierarchy, the atlas and the placement are those of the mesh.
pub fn pick(bvh: &Bvh, mesh: &Mesh, atlas: &Atlas, ray: Ray, placement: &Placement) -> Option<PickedPoint> {
    let origin = ray.origin.as_dvec3();
    let direction = ray.direction.as_dvec3().try_normalize()?;
    // The start is moved along the ray to near the model, since single precision is coarse far away from it.
    let skipped = (-origin.dot(direction) - MODEL_RADIUS).max(0.0);
    let begin = (origin + direction * skipped) / placement.scale + DVec3::from(placement.center);
    let hit = bvh.closest(
        begin.as_vec3().to_array(),
        direction.as_vec3().to_array(),
        f32::INFINITY,
    )?;
    let corners = corners(mesh, hit.triangle)?;
    let [a, b, c] = corners.map(|corner| (corner - DVec3::from(placement.center)) * placement.scale);
    // The ray was rounded to the model's units, so the intersection is computed again. A ray along the plane has no
    // intersection; in this case the caster's coordinates are kept.
    let shares = barycentric([a, b, c], origin, direction).unwrap_or(hit.barycentric.map(f64::from));
    let shares = clamped_inside(shares);
    let position = a * shares[0] + b * shares[1] + c * shares[2];
    let barycentric = shares.map(|share| share as f32);
    let triangle = hit.triangle as usize;
    let uv = interpolated(mesh, triangle, &mesh.uvs, barycentric);
    let chart = *atlas.triangle_chart.get(triangle)?;
    let face_normal = face_normal(corners);
    let normal = Vec3::from(interpolated(mesh, triangle, &mesh.normals, barycentric));
    Some(PickedPoint {
        triangle: hit.triangle,
        barycentric,
        uv,
        chart,
        page: atlas.charts.get(chart as usize)?.page,
        texel: weighted(*atlas.triangle_texels.get(triangle)?, barycentric),
        map_texel: uv.map(|at| map_texel(at, atlas.size)),
        position: placement.model_from_view(position.as_vec3()),
        position_view: position.as_vec3(),
        normal: normal.try_normalize().unwrap_or(face_normal),
        face_normal,
        is_back_face: face_normal.as_dvec3().dot(direction) > 0.0,
        material: *mesh.triangle_material.get(triangle)?,
        part: *mesh.triangle_part.get(triangle)?,
        distance: (position - origin).dot(direction) as f32,
    })
}

fn corners(mesh: &Mesh, triangle: u32) -> Option<[DVec3; 3]> {
    let place = |vertex: u32| mesh.positions.get(vertex as usize).map(|at| Vec3::from(*at).as_dvec3());
    let [a, b, c] = *mesh.triangles.get(triangle as usize)?;
    Some([place(a)?, place(b)?, place(c)?])
}

/// Returns the barycentric coordinates of the intersection of a line with the plane of a triangle (Möller and Trumbore);
/// `None` for a line parallel to the plane.
fn barycentric([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<[f64; 3]> {
    let (u, v) = (b - a, c - a);
    let across = direction.cross(v);
    let turned = (origin - a).cross(u);
    let determinant = u.dot(across);
    let of_b = (origin - a).dot(across) / determinant;
    let of_c = direction.dot(turned) / determinant;
    (of_b.is_finite() && of_c.is_finite()).then_some([1.0 - of_b - of_c, of_b, of_c])
}

/// Returns barycentric coordinates that rounding has put outside of the triangle, moved onto it.
fn clamped_inside(shares: [f64; 3]) -> [f64; 3] {
    let clamped = shares.map(|share| share.clamp(0.0, 1.0));
    let sum: f64 = clamped.iter().sum();
    if sum > 0.0 {
        clamped.map(|share| share / sum)
    } else {
        [1.0, 0.0, 0.0]
    }
}

fn face_normal([a, b, c]: [DVec3; 3]) -> Vec3 {
    // The vectors are scaled up first, since the product underflows for a model of 1e-30 units.
    let (u, v) = (b - a, c - a);
    let large = u.abs().max(v.abs()).max_element();
    let normal = (u / large).cross(v / large).try_normalize();
    normal.map_or(Vec3::ZERO, DVec3::as_vec3)
}

/// Returns the interpolated value of the vertices at a point of a triangle; zero for meshes without such values.
fn interpolated<const N: usize>(mesh: &Mesh, triangle: usize, of_vertices: &[[f32; N]], shares: [f32; 3]) -> [f32; N] {
    let corners = mesh.triangles[triangle].map(|vertex| of_vertices.get(vertex as usize).copied());
    weighted(corners.map(|value| value.unwrap_or([0.0; N])), shares)
}

fn weighted<const N: usize>(corners: [[f32; N]; 3], shares: [f32; 3]) -> [f32; N] {
    std::array::from_fn(|axis| (0..3).map(|corner| corners[corner][axis] * shares[corner]).sum())
}

fn map_texel(at: f32, size: u32) -> f32 {
    let size = f64::from(size);
    (f64::from(at) * size).rem_euclid(size) as f32
}
