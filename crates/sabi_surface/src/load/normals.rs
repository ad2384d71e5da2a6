//! Computes missing normals: flat (glTF's rule), or smooth up to an angle between faces. Also computes normals that replace
//! those of the file.

use glam::{DVec3, Vec3};
use sabi_cancel::{Cancel, CancelableIterator as _};

use super::submesh::{MadeNormals, Smoothing, Submesh};
use super::unit_vector::unit;

/// Computation of missing normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NormalMethod {
    /// One normal for each triangle, as glTF requires.
    Flat,
    /// Smooth across edges with an angle of less than [`CREASE_DEGREES`], or according to the file's smoothing groups.
    Crease,
}

/// Angle between faces above which an edge is hard: the edges of a cube (90°) are hard, those of a six-sided cylinder (60°) are not.
const CREASE_DEGREES: f64 = 80.0;

/// Normalizes all normals and computes missing ones; returns the number of vertices without a valid normal.
pub(super) fn complete(submesh: &mut Submesh, missing: NormalMethod) -> usize {
    submesh.normals.resize(submesh.positions.len(), [0.0; 3]);
    let mut lost = vec![false; submesh.normals.len()];
    for (normal, lost) in submesh.normals.iter_mut().zip(&mut lost) {
        match unit(Vec3::from(*normal).as_dvec3()) {
            Some(unit) => *normal = unit,
            None => *lost = true,
        }
    }
    let count = lost.iter().filter(|lost| **lost).count();
    if count == 0 {
        return 0;
    }
    if count == lost.len() {
        submesh.made_normals = Some(match missing {
            NormalMethod::Flat => MadeNormals::Flat,
            NormalMethod::Crease => MadeNormals::Crease,
        });
    }
    let faces = face_normals(submesh);
    let made = match missing {
        NormalMethod::Flat => faces.iter().flat_map(|face| [*face; 3]).collect(),
        NormalMethod::Crease => smooth(submesh, &faces, |first, second| {
            is_smooth(submesh, &faces, first, second)
        }),
    };
    let corners: Vec<[f32; 3]> = submesh
        .triangles
        .as_flattened()
        .iter()
        .zip(made)
        .map(|(vertex, made)| {
            if lost[*vertex as usize] {
                // Triangles without area have no normal, so any direction can be used.
                unit(made).unwrap_or([0.0, 1.0, 0.0])
            } else {
                submesh.normals[*vertex as usize]
            }
        })
        .collect();
    submesh.normals = submesh.split_by(&corners);
    count
}

/// Replaces all normals: smooth across edges whose faces differ by less than `degrees`, flat at other edges. Removes the
/// tangents, which belonged to the previous normals.
pub(super) fn replace(submesh: &mut Submesh, degrees: f32) {
    let faces = face_normals(submesh);
    let least_cosine = f64::from(degrees).to_radians().cos();
    let made = smooth(submesh, &faces, |first, second| {
        faces[first].dot(faces[second]) > least_cosine
    });
    let corners: Vec<[f32; 3]> = made
        .into_iter()
        .enumerate()
        // Normals of opposite faces may cancel each other out. Triangles without area have no normal, so any direction can be used.
        .map(|(corner, made)| unit(made).or(unit(faces[corner / 3])).unwrap_or([0.0, 1.0, 0.0]))
        .collect();
    submesh.tangents.clear();
    for set in &mut submesh.texture_uvs {
        set.tangents.clear();
    }
    submesh.normals = vec![[0.0; 3]; submesh.positions.len()];
    submesh.normals = submesh.split_by(&corners);
    submesh.made_normals = Some(MadeNormals::Smooth(degrees));
}

/// Adapts the normals of reversed faces to their new outside. Computed normals are computed again; normals of the file are
/// reversed at corners of these faces where they point inward.
pub(super) fn follow_turned(submesh: &mut Submesh, is_turned: &[bool]) {
    let remake = |submesh: &mut Submesh, missing: NormalMethod| {
        submesh.normals.clear();
        complete(submesh, missing);
    };
    match submesh.made_normals {
        Some(MadeNormals::Flat) => remake(submesh, NormalMethod::Flat),
        Some(MadeNormals::Crease) => remake(submesh, NormalMethod::Crease),
        Some(MadeNormals::Smooth(degrees)) => replace(submesh, degrees),
        None => {
            let outward = |(corner, vertex): (usize, &u32)| {
                let normal = Vec3::from(submesh.normals[*vertex as usize]);
                let face = face_normal(submesh, corner / 3).as_vec3();
                let is_inward = is_turned[corner / 3] && normal.dot(face) < 0.0;
                if is_inward { -normal } else { normal }.to_array()
            };
            let corners: Vec<[f32; 3]> = submesh
                .triangles
                .as_flattened()
                .iter()
                .enumerate()
                .map(outward)
                .collect();
            submesh.normals = submesh.split_by(&corners);
        }
    }
}

fn face_normals(submesh: &Submesh) -> Vec<DVec3> {
    (0..submesh.triangles.len())
        .looking()
        .map(|triangle| face_normal(submesh, triangle))
        .collect()
}

fn corners_of(submesh: &Submesh, triangle: usize) -> [DVec3; 3] {
    submesh.triangles[triangle].map(|v| Vec3::from(submesh.positions[v as usize]).as_dvec3())
}

/// Returns the normal of a triangle with unit length; zero for a triangle without area.
fn face_normal(submesh: &Submesh, triangle: usize) -> DVec3 {
    let [a, b, c] = corners_of(submesh, triangle);
    unit((b - a).cross(c - a)).map_or(DVec3::ZERO, |unit| Vec3::from(unit).as_dvec3())
}

/// Computes the normals of the corners: the sum of face normals weighted by the angle of the corner, over all corners connected by smooth
/// edges (Thürmer & Wüthrich 1998). `is_smooth` returns whether the edge between two triangles is smooth.
fn smooth(submesh: &Submesh, faces: &[DVec3], is_smooth: impl Fn(usize, usize) -> bool) -> Vec<DVec3> {
    let mut corner_sets = CornerSets((0..submesh.triangles.len() as u32 * 3).collect());
    let mut edges = directed_edges(submesh);
    let cancel = Cancel::current();
    edges.sort_unstable_by(|a, b| {
        cancel.look();
        a.cmp(b)
    });
    for run in edges.chunk_by(|a, b| a.ends == b.ends).looking() {
        for pair in run.windows(2) {
            let [first, second] = [pair[0].triangle as usize, pair[1].triangle as usize];
            if is_smooth(first, second) {
                corner_sets.join(pair[0].low_corner, pair[1].low_corner);
                corner_sets.join(pair[0].high_corner, pair[1].high_corner);
            }
        }
    }
    let mut sums = vec![DVec3::ZERO; faces.len() * 3];
    for (triangle, face) in faces.iter().enumerate().looking() {
        let at = corners_of(submesh, triangle);
        for corner in 0..3 {
            let [here, next, last] = [at[corner], at[(corner + 1) % 3], at[(corner + 2) % 3]];
            let angle = (next - here).angle_between(last - here);
            if angle.is_finite() {
                sums[corner_sets.root(triangle as u32 * 3 + corner as u32) as usize] += *face * angle;
            }
        }
    }
    (0..sums.len() as u32)
        .map(|corner| sums[corner_sets.root(corner) as usize])
        .collect()
}

fn is_smooth(submesh: &Submesh, faces: &[DVec3], first: usize, second: usize) -> bool {
    // Formats without smoothing groups give no smoothing.
    let smoothing = |triangle: usize| submesh.smoothing.get(triangle).copied().unwrap_or(Smoothing::ByAngle);
    match (smoothing(first), smoothing(second)) {
        (Smoothing::ByAngle, Smoothing::ByAngle) => faces[first].dot(faces[second]) > CREASE_DEGREES.to_radians().cos(),
        (Smoothing::Group(first), Smoothing::Group(second)) => first == second,
        _ => false,
    }
}

/// An edge of a triangle. Edges between the same two positions are adjacent when sorted.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    /// First vertices at the two positions, lower number first.
    ends: [u32; 2],
    triangle: u32,
    low_corner: u32,
    high_corner: u32,
}

fn directed_edges(submesh: &Submesh) -> Vec<Edge> {
    let first_at = submesh.first_at_position();
    let mut edges = Vec::with_capacity(submesh.triangles.len() * 3);
    for (triangle, corners) in submesh.triangles.iter().enumerate().looking() {
        let triangle = triangle as u32;
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let mut ends = [
                (first_at[corners[from] as usize], from as u32),
                (first_at[corners[to] as usize], to as u32),
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

/// Disjoint sets of corners.
struct CornerSets(Vec<u32>);

impl CornerSets {
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
