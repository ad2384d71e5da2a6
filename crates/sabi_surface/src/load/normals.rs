//! Normals that a file leaves out: flat (glTF's rule), or smooth up to a crease angle.

use glam::{DVec3, Vec3};

use super::piece::{Piece, Smoothing, direction};

/// Computation of missing normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Missing {
    /// Every triangle shades flat, as glTF asks.
    Flat,
    /// Smooth over edges that turn by less than [`CREASE_DEGREES`], unless the file's smoothing groups say otherwise.
    Crease,
}

/// A cube (90°) stays hard, a coarse cylinder of six sides (60°) gets round.
const CREASE_DEGREES: f64 = 80.0;

/// Makes all normals unit length and makes those that are missing; says how many vertices had none.
pub(super) fn complete(piece: &mut Piece, missing: Missing) -> usize {
    piece.normals.resize(piece.positions.len(), [0.0; 3]);
    let mut lost = vec![false; piece.normals.len()];
    for (normal, lost) in piece.normals.iter_mut().zip(&mut lost) {
        match direction(Vec3::from(*normal).as_dvec3()) {
            Some(unit) => *normal = unit,
            None => *lost = true,
        }
    }
    let count = lost.iter().filter(|lost| **lost).count();
    if count == 0 {
        return 0;
    }
    let faces: Vec<DVec3> = (0..piece.triangles.len())
        .map(|triangle| face_normal(piece, triangle))
        .collect();
    let made = match missing {
        Missing::Flat => faces.iter().flat_map(|face| [*face; 3]).collect(),
        Missing::Crease => smooth(piece, &faces),
    };
    let corners: Vec<[f32; 3]> = piece
        .triangles
        .as_flattened()
        .iter()
        .zip(made)
        .map(|(vertex, made)| {
            if lost[*vertex as usize] {
                // A corner of triangles without area alone has no side; up is as good as any.
                direction(made).unwrap_or([0.0, 1.0, 0.0])
            } else {
                piece.normals[*vertex as usize]
            }
        })
        .collect();
    piece.normals = piece.split_by(&corners);
    count
}

fn corners_of(piece: &Piece, triangle: usize) -> [DVec3; 3] {
    piece.triangles[triangle].map(|v| Vec3::from(piece.positions[v as usize]).as_dvec3())
}

/// Unit length, or zero for a triangle without area.
fn face_normal(piece: &Piece, triangle: usize) -> DVec3 {
    let [a, b, c] = corners_of(piece, triangle);
    direction((b - a).cross(c - a)).map_or(DVec3::ZERO, |unit| Vec3::from(unit).as_dvec3())
}

/// Normals of the corners: face normals weighted by the corner's angle, over all corners that smooth edges join.
fn smooth(piece: &Piece, faces: &[DVec3]) -> Vec<DVec3> {
    let mut joined = Joined((0..piece.triangles.len() as u32 * 3).collect());
    let mut edges = directed_edges(piece);
    edges.sort_unstable();
    for run in edges.chunk_by(|a, b| a.ends == b.ends) {
        for pair in run.windows(2) {
            let [first, second] = [pair[0].triangle as usize, pair[1].triangle as usize];
            if is_smooth(piece, faces, first, second) {
                joined.join(pair[0].low_corner, pair[1].low_corner);
                joined.join(pair[0].high_corner, pair[1].high_corner);
            }
        }
    }
    let mut sums = vec![DVec3::ZERO; faces.len() * 3];
    for (triangle, face) in faces.iter().enumerate() {
        let at = corners_of(piece, triangle);
        for corner in 0..3 {
            let [here, next, last] = [at[corner], at[(corner + 1) % 3], at[(corner + 2) % 3]];
            let angle = (next - here).angle_between(last - here);
            if angle.is_finite() {
                sums[joined.root(triangle as u32 * 3 + corner as u32) as usize] += *face * angle;
            }
        }
    }
    (0..sums.len() as u32)
        .map(|corner| sums[joined.root(corner) as usize])
        .collect()
}

fn is_smooth(piece: &Piece, faces: &[DVec3], first: usize, second: usize) -> bool {
    // Formats without smoothing groups have none.
    let smoothing = |triangle: usize| piece.smoothing.get(triangle).copied().unwrap_or(Smoothing::ByAngle);
    match (smoothing(first), smoothing(second)) {
        (Smoothing::ByAngle, Smoothing::ByAngle) => faces[first].dot(faces[second]) > CREASE_DEGREES.to_radians().cos(),
        (Smoothing::Group(first), Smoothing::Group(second)) => first == second,
        _ => false,
    }
}

/// One side of a triangle; sides between the same two places sort together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    /// The two places, lower number first.
    ends: [u32; 2],
    triangle: u32,
    low_corner: u32,
    high_corner: u32,
}

fn directed_edges(piece: &Piece) -> Vec<Edge> {
    let places = places(&piece.positions);
    let mut edges = Vec::with_capacity(piece.triangles.len() * 3);
    for (triangle, corners) in piece.triangles.iter().enumerate() {
        let triangle = triangle as u32;
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let mut ends = [
                (places[corners[from] as usize], from as u32),
                (places[corners[to] as usize], to as u32),
            ];
            ends.sort_unstable();
            let [(low, low_corner), (high, high_corner)] = ends;
            if low != high {
                edges.push(Edge {
                    ends: [low, high],
                    triangle,
                    low_corner: triangle * 3 + low_corner,
                    high_corner: triangle * 3 + high_corner,
                });
            }
        }
    }
    edges
}

/// The same number for vertices at exactly the same position.
pub(super) fn places(positions: &[[f32; 3]]) -> Vec<u32> {
    // Adding zero makes the two zeros one.
    let bits = |vertex: u32| positions[vertex as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|vertex| (bits(*vertex), *vertex));
    let mut places = vec![0; positions.len()];
    for run in order.chunk_by(|a, b| bits(*a) == bits(*b)) {
        for vertex in run {
            places[*vertex as usize] = run[0];
        }
    }
    places
}

/// Disjoint sets of corners.
struct Joined(Vec<u32>);

impl Joined {
    fn root(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            let above = self.0[self.0[of as usize] as usize];
            self.0[of as usize] = above;
            of = above;
        }
        of
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
