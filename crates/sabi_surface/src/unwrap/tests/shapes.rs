//! Meshes without texture coordinates.

use crate::model::Mesh;

/// A mesh of places and triangles, every vertex with the normal of its first triangle.
pub(super) fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    let mut mesh = Mesh {
        normals: vec![[0.0, 1.0, 0.0]; positions.len()],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; positions.len()],
        triangle_material: vec![0; triangles.len()],
        triangle_part: vec![0; triangles.len()],
        positions,
        triangles,
        ..Mesh::default()
    };
    for corners in mesh.triangles.iter().rev() {
        let [a, b, c] = corners.map(|vertex| glam::Vec3::from(mesh.positions[vertex as usize]));
        let normal = (b - a).cross(c - a).normalize_or(glam::Vec3::Y);
        for &vertex in corners {
            mesh.normals[vertex as usize] = normal.to_array();
        }
    }
    mesh
}

/// Adds another mesh behind a first, moved, with a material of its own number.
pub(super) fn join(first: &mut Mesh, other: &Mesh, offset: [f32; 3], material: u32) {
    let start = first.positions.len() as u32;
    let moved = |at: &[f32; 3]| [0, 1, 2].map(|axis| at[axis] + offset[axis]);
    first.positions.extend(other.positions.iter().map(moved));
    first.normals.extend(&other.normals);
    first.tangents.extend(&other.tangents);
    first.triangles.extend(
        other
            .triangles
            .iter()
            .map(|corners| corners.map(|vertex| vertex + start)),
    );
    first.triangle_material.extend(vec![material; other.triangles.len()]);
    first.triangle_part.extend(&other.triangle_part);
}

/// A grid of `columns × rows` quads; the last column is the first one again where it closes, and so are rows.
pub(super) fn grid(columns: u32, rows: u32, closes: [bool; 2], place: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let wide = columns + u32::from(!closes[0]);
    let high = rows + u32::from(!closes[1]);
    let positions = (0..wide * high).map(|at| {
        let [x, y] = [
            f64::from(at % wide) / f64::from(columns),
            f64::from(at / wide) / f64::from(rows),
        ];
        place(x, y).map(|value| value as f32)
    });
    let at = |x: u32, y: u32| (y % high) * wide + x % wide;
    let mut triangles = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            triangles.push([at(x, y), at(x + 1, y), at(x + 1, y + 1)]);
            triangles.push([at(x, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    mesh(positions.collect(), triangles)
}

/// A cube of side 1 whose faces share no vertices.
pub(super) fn cube() -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for face in 0..6usize {
        let (axis, sign) = (face / 2, if face % 2 == 0 { 0.5 } else { -0.5 });
        let corner = |a: f32, b: f32| {
            let mut at = [0.0; 3];
            at[axis] = sign;
            at[(axis + 1) % 3] = a;
            // Seen from outside the corners go round counter-clockwise.
            at[(axis + 2) % 3] = b * sign * 2.0;
            at
        };
        let first = positions.len() as u32;
        positions.extend([
            corner(-0.5, -0.5),
            corner(0.5, -0.5),
            corner(0.5, 0.5),
            corner(-0.5, 0.5),
        ]);
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh(positions, triangles)
}

/// A ball; at the poles triangles shrink to lines.
pub(super) fn ball(cells: u32) -> Mesh {
    use std::f64::consts::{PI, TAU};
    grid(2 * cells, cells, [true, false], |x, y| {
        let (turn, latitude) = (-TAU * x, PI * (y - 0.5));
        let ring = if y == 0.0 || y == 1.0 { 0.0 } else { latitude.cos() };
        [ring * turn.cos(), latitude.sin(), ring * turn.sin()]
    })
}

/// A torus.
pub(super) fn torus() -> Mesh {
    use std::f64::consts::TAU;
    grid(36, 16, [true, true], |x, y| {
        let (turn, around) = (-TAU * x, TAU * y);
        let reach = 1.0 + 0.4 * around.cos();
        [reach * turn.cos(), 0.4 * around.sin(), reach * turn.sin()]
    })
}

/// A long strip, open on all sides, bent to a half circle.
pub(super) fn strip() -> Mesh {
    use std::f64::consts::PI;
    grid(40, 2, [false, false], |x, y| [(PI * x).cos(), (PI * x).sin(), -y])
}
