//! Tangents: the file's own, or MikkTSpace.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::Vec3;
use sabi_cancel::Cancel;

use super::submesh::Submesh;
use super::unit_vector::{perpendicular, unit};
use super::warnings::Warnings;

/// Binary exponent of positions and texture coordinates beyond which their squares overflow or underflow in single precision.
const SAFE_EXPONENT: i32 = 24;

/// Maximum number of pairs of corners that are compared: a few seconds' work. Real models have some dozens at a position.
const MOST_CROWDED: u64 = 1 << 30;

/// Computes a tangent for every vertex. Normals must exist. `who` names the submesh in warnings.
///
/// glTF's convention: the bitangent is `cross(normal, tangent) × w` and points up in the picture, against v. Without
/// texture coordinates the tangent is any direction along the surface. Returns true if the tangents of the file were kept.
pub(super) fn complete(submesh: &mut Submesh, who: &str, warnings: &mut Warnings) -> bool {
    if !submesh.tangents.is_empty() {
        if submesh.tangents.iter_mut().all(normalize) {
            return true;
        }
        warnings.add(format!(
            "The tangents of {who} are not unit vectors with a sign; they were made anew."
        ));
        submesh.tangents.clear();
    }
    let made = if submesh.uvs.is_empty() {
        None
    } else {
        mikktspace(submesh)
    };
    if let Some(corners) = made {
        submesh.tangents = submesh.split_by(&corners);
        return false;
    }
    if !submesh.uvs.is_empty() {
        warnings.add(format!(
            "Too many triangles of {who} meet in one place to make tangents by the standard; theirs are arbitrary."
        ));
    }
    submesh.tangents = submesh
        .normals
        .iter()
        .map(|normal| with_sign(perpendicular(*normal), 1.0))
        .collect();
    false
}

/// Recomputes the tangents of all vertices for the texture coordinates.
pub(crate) fn for_uvs(submesh: &mut Submesh) {
    submesh.tangents.clear();
    complete(submesh, "the model", &mut Warnings::default());
}

/// Returns the tangents of the corners, or `None` if computing them would take minutes.
fn mikktspace(submesh: &Submesh) -> Option<Vec<[f32; 4]>> {
    if crowding(submesh) > MOST_CROWDED {
        return None;
    }
    let mut corners = MikktspaceMesh {
        positions_scale: power_of_two_scale(submesh.positions.as_flattened()),
        uvs_scale: power_of_two_scale(submesh.uvs.as_flattened()),
        submesh,
        tangents: vec![[0.0; 4]; submesh.triangles.len() * 3],
        cancel: Cancel::current(),
    };
    generate_tangents(&mut corners).ok()?;
    Some(corners.tangents)
}

/// Returns the number of pairs of corners at one position, which MikkTSpace compares with each other.
fn crowding(submesh: &Submesh) -> u64 {
    let corners = submesh.triangles.len() as u64 * 3;
    if corners.pow(2) <= MOST_CROWDED {
        return 0;
    }
    let first_at = submesh.first_at_position();
    let mut counts = vec![0u64; first_at.len()];
    for vertex in submesh.triangles.as_flattened() {
        counts[first_at[*vertex as usize] as usize] += 1;
    }
    counts.iter().map(|count| count * count).sum()
}

fn with_sign([x, y, z]: [f32; 3], sign: f32) -> [f32; 4] {
    [x, y, z, sign]
}

/// Normalizes a tangent of a file; returns false if it is invalid.
fn normalize(tangent: &mut [f32; 4]) -> bool {
    let [x, y, z, w] = *tangent;
    let Some(direction) = unit(Vec3::new(x, y, z).as_dvec3()) else {
        return false;
    };
    if !(0.5..=1.5).contains(&w.abs()) {
        return false;
    }
    *tangent = with_sign(direction, w.signum());
    true
}

/// Returns 1, or the power of two that scales extreme values to about 1; directions keep their bits.
fn power_of_two_scale(values: &[f32]) -> f32 {
    let largest = values.iter().fold(0.0f32, |largest, x| largest.max(x.abs()));
    if largest == 0.0 {
        return 1.0;
    }
    let exponent = largest.log2().floor() as i32;
    if exponent.abs() <= SAFE_EXPONENT {
        1.0
    } else {
        2.0f32.powi((-exponent).clamp(-126, 127))
    }
}

/// A submesh as the input of MikkTSpace.
struct MikktspaceMesh<'a> {
    submesh: &'a Submesh,
    positions_scale: f32,
    uvs_scale: f32,
    /// Tangents, three for each triangle.
    tangents: Vec<[f32; 4]>,
    cancel: Cancel,
}

impl MikktspaceMesh<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.submesh.triangles[face][corner] as usize
    }
}

impl Geometry for MikktspaceMesh<'_> {
    fn num_faces(&self) -> usize {
        self.submesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        // Asked for all the time, so that the crate can be left.
        self.cancel.look();
        self.submesh.positions[self.vertex(face, corner)].map(|x| x * self.positions_scale)
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.submesh.normals[self.vertex(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.submesh.uvs[self.vertex(face, corner)].map(|x| x * self.uvs_scale)
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let found = space.and_then(|space| {
            let direction = unit(Vec3::from(space.tangent()).as_dvec3())?;
            // For MikkTSpace v grows upward, in glTF it grows downward. This reverses the bitangent.
            Some(with_sign(
                direction,
                if space.is_orientation_preserving() { -1.0 } else { 1.0 },
            ))
        });
        let normal = self.submesh.normals[self.vertex(face, corner)];
        self.tangents[face * 3 + corner] = found.unwrap_or_else(|| with_sign(perpendicular(normal), 1.0));
    }
}
