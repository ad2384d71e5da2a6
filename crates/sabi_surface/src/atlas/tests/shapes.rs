//! Meshes made of flat patches, and reproducible pseudo-random numbers.

use glam::{DVec2, DVec3};

use crate::model::Mesh;

/// Generator of numbers that are the same in every run (PCG hash).
pub(super) struct PcgRandom(pub(super) u32);

impl PcgRandom {
    pub(super) fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((self.0 >> ((self.0 >> 28) + 4)) ^ self.0).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    }

    /// Returns a number from 0 to 1.
    pub(super) fn unit(&mut self) -> f64 {
        f64::from(self.next()) / f64::from(u32::MAX)
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// An affine map from a patch's own coordinates to UV: rotated by `turn` radians about `center`.
#[derive(Clone, Copy)]
pub(super) struct PatchFrame {
    pub(super) center: [f64; 2],
    pub(super) scale: f64,
    pub(super) turn: f64,
    pub(super) mirrored: bool,
}

impl PatchFrame {
    pub(super) fn straight(center: [f64; 2], scale: f64) -> PatchFrame {
        PatchFrame {
            center,
            scale,
            turn: 0.0,
            mirrored: false,
        }
    }

    fn uv(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let x = if self.mirrored { -x } else { x };
        let (sin, cos) = self.turn.sin_cos();
        let turned = [x * cos - y * sin, x * sin + y * cos];
        [0, 1].map(|axis| (self.center[axis] + self.scale * turned[axis]) as f32)
    }
}

/// Adds a grid of `cells × cells` quads over `origin + x·a + y·b`, with x and y from 0 to 1, as a separate chart.
pub(super) fn patch(mesh: &mut Mesh, axes: [[f64; 3]; 3], frame: PatchFrame, cells: u32) {
    let [origin, a, b] = axes.map(DVec3::from);
    let first = mesh.positions.len() as u32;
    for y in 0..=cells {
        for x in 0..=cells {
            let (s, t) = (f64::from(x) / f64::from(cells), f64::from(y) / f64::from(cells));
            mesh.positions.push((origin + a * s + b * t).as_vec3().to_array());
            mesh.uvs.push(frame.uv([s - 0.5, t - 0.5]));
        }
    }
    let row = cells + 1;
    for y in 0..cells {
        for x in 0..cells {
            let at = first + y * row + x;
            triangle(mesh, [at, at + 1, at + row + 1]);
            triangle(mesh, [at, at + row + 1, at + row]);
        }
    }
}

/// Adds a triangle of material 0 and part 0.
pub(super) fn triangle(mesh: &mut Mesh, corners: [u32; 3]) {
    mesh.triangles.push(corners);
    mesh.triangle_material.push(0);
    mesh.triangle_part.push(0);
}

/// Creates a cube from −½ to ½ with six charts of several sizes, rotated by odd angles, some mirrored.
pub(super) fn cube(cells: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let turns = [0.0f64, 30.0, 90.0, 200.0, 45.0, 137.0];
    let scales = [0.225, 0.15, 0.1875, 0.225, 0.125, 0.2];
    let mirrored = [false, true, false, false, true, false];
    let centers = [
        [0.175, 0.175],
        [0.5, 0.175],
        [0.825, 0.175],
        [0.175, 0.55],
        [0.5, 0.55],
        [0.825, 0.575],
    ];
    for face in 0..6 {
        let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
        let mut normal = DVec3::ZERO;
        normal[axis] = sign;
        let a = DVec3::AXES[(axis + 1) % 3];
        let b = normal.cross(a);
        let origin = (normal - a - b) * 0.5;
        let frame = PatchFrame {
            center: centers[face],
            scale: scales[face],
            turn: turns[face].to_radians(),
            mirrored: mirrored[face],
        };
        patch(&mut mesh, [origin, a, b].map(|v| v.to_array()), frame, cells);
    }
    mesh
}

/// One chart: a square of side 1 in the plane z = 0.
pub(super) fn square(frame: PatchFrame, cells: u32) -> Mesh {
    let mut mesh = Mesh::default();
    patch(&mut mesh, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], frame, cells);
    mesh
}

/// A ball: a grid over latitude and longitude, one chart, cut along a meridian.
pub(super) fn ball(cells: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=cells {
        for column in 0..=2 * cells {
            let latitude = std::f64::consts::PI * (f64::from(row) / f64::from(cells) - 0.5);
            // The last column closes the ball with exactly the same positions as the first.
            let around = f64::from(column % (2 * cells)) / f64::from(2 * cells);
            let longitude = std::f64::consts::TAU * around;
            let ring = if row == 0 || row == cells { 0.0 } else { latitude.cos() };
            let position = [ring * longitude.cos(), latitude.sin(), ring * longitude.sin()];
            mesh.positions.push(position.map(|value| value as f32));
            let u = 0.02 + 0.96 * f64::from(column) / f64::from(2 * cells);
            let v = 0.98 - 0.96 * f64::from(row) / f64::from(cells);
            mesh.uvs.push([u as f32, v as f32]);
        }
    }
    let width = 2 * cells + 1;
    for row in 0..cells {
        for column in 0..2 * cells {
            let at = row * width + column;
            // At the poles, one of the two triangles would have no area.
            if row + 1 < cells {
                triangle(&mut mesh, [at, at + width, at + width + 1]);
            }
            if row > 0 {
                triangle(&mut mesh, [at, at + width + 1, at + 1]);
            }
        }
    }
    mesh
}

/// The affine map of a triangle from texels of an atlas of `size` to space: a point's image and the images of the
/// texel axes.
pub(super) struct Affine {
    pub(super) axes: [DVec3; 2],
    corner: DVec2,
    position: DVec3,
}

impl Affine {
    pub(super) fn new(mesh: &Mesh, size: u32, offset: [i32; 2], triangle: u32) -> Affine {
        let corners = mesh.triangles[triangle as usize];
        let q = corners.map(|vertex| {
            let uv = DVec2::from(mesh.uvs[vertex as usize].map(f64::from));
            uv * f64::from(size) + DVec2::from(offset.map(f64::from))
        });
        let p = corners.map(|vertex| DVec3::from(mesh.positions[vertex as usize].map(f64::from)));
        let (q1, q2) = (q[1] - q[0], q[2] - q[0]);
        let (p1, p2) = (p[1] - p[0], p[2] - p[0]);
        let area2 = q1.perp_dot(q2);
        Affine {
            axes: [(p1 * q2.y - p2 * q1.y) / area2, (p2 * q1.x - p1 * q2.x) / area2],
            corner: q[0],
            position: p[0],
        }
    }

    pub(super) fn position(&self, texel: DVec2) -> DVec3 {
        self.position + self.vector(texel - self.corner)
    }

    pub(super) fn vector(&self, texels: DVec2) -> DVec3 {
        self.axes[0] * texels.x + self.axes[1] * texels.y
    }

    /// `[P_u·P_u, P_u·P_v, P_v·P_v]`.
    pub(super) fn metric(&self) -> [f64; 3] {
        let [u, v] = self.axes;
        [u.dot(u), u.dot(v), v.dot(v)]
    }
}
