//! Tangents: the file's own, or MikkTSpace.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::Vec3;

use super::normals::places;
use super::piece::{Piece, direction};
use super::warnings::Warnings;

/// Magnitude of positions and texture coordinates beyond which their squares overflow or underflow in single precision.
const SAFE_EXPONENT: i32 = 24;

/// More pairs than this are not waited for (a few seconds' work; real models have some dozens a place).
const MOST_CROWDED: u64 = 1 << 30;

/// Gives every vertex a tangent; normals must exist. `who` names the piece in warnings.
///
/// glTF's convention: the bitangent is `cross(normal, tangent) × w` and points up in the picture, against v.
/// Without texture coordinates the tangent is any direction along the surface.
pub(super) fn complete(piece: &mut Piece, who: &str, warnings: &mut Warnings) {
    if !piece.tangents.is_empty() {
        if piece.tangents.iter_mut().all(normalize) {
            return;
        }
        warnings.add(format!(
            "The tangents of {who} are not unit vectors with a sign; they were made anew."
        ));
        piece.tangents.clear();
    }
    let made = if piece.uvs.is_empty() { None } else { mikktspace(piece) };
    if let Some(corners) = made {
        piece.tangents = piece.split_by(&corners);
        return;
    }
    if !piece.uvs.is_empty() {
        warnings.add(format!(
            "Too many triangles of {who} meet in one place to make tangents by the standard; theirs are arbitrary."
        ));
    }
    piece.tangents = piece
        .normals
        .iter()
        .map(|normal| with_sign(perpendicular(*normal), 1.0))
        .collect();
}

/// Gives every vertex a tangent for the texture coordinates, whatever it had.
pub(crate) fn for_uvs(piece: &mut Piece) {
    piece.tangents.clear();
    complete(piece, "the model", &mut Warnings::default());
}

/// Tangents of the corners, or `None` where making them would take minutes.
fn mikktspace(piece: &Piece) -> Option<Vec<[f32; 4]>> {
    if crowding(piece) > MOST_CROWDED {
        return None;
    }
    let mut corners = Corners {
        positions_scale: power_of_two_scale(piece.positions.as_flattened()),
        uvs_scale: power_of_two_scale(piece.uvs.as_flattened()),
        piece,
        tangents: vec![[0.0; 4]; piece.triangles.len() * 3],
    };
    generate_tangents(&mut corners).ok()?;
    Some(corners.tangents)
}

/// MikkTSpace compares the corners at one place with each other: the number of such pairs.
fn crowding(piece: &Piece) -> u64 {
    let corners = piece.triangles.len() as u64 * 3;
    if corners.pow(2) <= MOST_CROWDED {
        return 0;
    }
    let places = places(&piece.positions);
    let mut counts = vec![0u64; places.len()];
    for vertex in piece.triangles.as_flattened() {
        counts[places[*vertex as usize] as usize] += 1;
    }
    counts.iter().map(|count| count * count).sum()
}

/// A unit vector at right angles to the unit vector `normal` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
pub(super) fn perpendicular(normal: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = normal;
    let sign = 1.0f32.copysign(z);
    let a = -1.0 / (sign + z);
    [1.0 + sign * x * x * a, sign * x * y * a, -sign * x]
}

fn with_sign([x, y, z]: [f32; 3], sign: f32) -> [f32; 4] {
    [x, y, z, sign]
}

/// Makes a tangent of a file exact; `false` where it is none.
fn normalize(tangent: &mut [f32; 4]) -> bool {
    let [x, y, z, w] = *tangent;
    let Some(unit) = direction(Vec3::new(x, y, z).as_dvec3()) else {
        return false;
    };
    if !(0.5..=1.5).contains(&w.abs()) {
        return false;
    }
    *tangent = with_sign(unit, w.signum());
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

/// A piece as MikkTSpace asks for it.
struct Corners<'a> {
    piece: &'a Piece,
    positions_scale: f32,
    uvs_scale: f32,
    /// Three a triangle.
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.piece.triangles[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.piece.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.piece.positions[self.vertex(face, corner)].map(|x| x * self.positions_scale)
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.piece.normals[self.vertex(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.piece.uvs[self.vertex(face, corner)].map(|x| x * self.uvs_scale)
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let found = space.and_then(|space| {
            let unit = direction(Vec3::from(space.tangent()).as_dvec3())?;
            // MikkTSpace takes v to grow upward, glTF's grows downward: the bitangent turns around.
            Some(with_sign(
                unit,
                if space.is_orientation_preserving() { -1.0 } else { 1.0 },
            ))
        });
        let normal = self.piece.normals[self.vertex(face, corner)];
        self.tangents[face * 3 + corner] = found.unwrap_or_else(|| with_sign(perpendicular(normal), 1.0));
    }
}
