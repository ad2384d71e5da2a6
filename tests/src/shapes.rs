//! Shapes with closed forms, cut into as many faces as a test asks for.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::meshes::Quad;

/// Low and high texture coordinates of a patch.
pub type PatchUvs = [[f32; 2]; 2];

/// Division of a patch into faces.
#[derive(Clone, Copy, Debug)]
pub struct PatchDivision {
    /// Faces along both sides.
    pub steps: [u32; 2],
    /// A seed to move inner corners within the patch and to turn diagonals by; none leaves all as even as it is.
    pub scatter: Option<u32>,
}

impl PatchDivision {
    /// As many even faces along either side.
    pub fn even(steps: u32) -> PatchDivision {
        PatchDivision {
            steps: [steps; 2],
            scatter: None,
        }
    }

    /// The same with corners and diagonals at random.
    pub fn scattered(steps: u32, seed: u32) -> PatchDivision {
        PatchDivision {
            scatter: Some(seed),
            ..PatchDivision::even(steps)
        }
    }
}

/// A number from 0 to 1 for a place of a grid.
fn random(seed: u32, [x, y]: [u32; 2], which: u32) -> f64 {
    let key = [x, y, which].into_iter().fold(seed, |key, part| {
        sabi_plan::pcg(key ^ part.wrapping_mul(0x9e37_79b9).wrapping_add(which))
    });
    f64::from(key) / f64::from(u32::MAX)
}

/// A patch over the unit square; `at` goes right and up as seen from outside.
pub fn patch(at: impl Fn(f64, f64) -> DVec3, place: PatchUvs, cut: PatchDivision) -> Vec<Quad> {
    let [columns, rows] = cut.steps;
    let is_border = |[x, y]: [u32; 2]| x.is_multiple_of(columns) || y.is_multiple_of(rows);
    // Less than a quarter of a face: whichever way a face is divided, its triangles keep their side.
    let moved = |corner: [u32; 2], axis: usize| match cut.scatter {
        Some(seed) if !is_border(corner) => 0.48 * (random(seed, corner, axis as u32) - 0.5),
        _ => 0.0,
    };
    let share = |corner: [u32; 2]| {
        [0, 1].map(|axis| (f64::from(corner[axis]) + moved(corner, axis)) / f64::from(cut.steps[axis]))
    };
    let mix = |axis: usize, share: f64| {
        let [low, high] = [place[0][axis], place[1][axis]].map(f64::from);
        (low + (high - low) * share) as f32
    };
    let face = |column: u32, row: u32| {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| share([column + x, row + y]));
        let mut quad = Quad {
            corners: corners.map(|[s, t]| at(s, t).as_vec3().to_array()),
            uvs: corners.map(|[s, t]| [mix(0, s), mix(1, 1.0 - t)]),
        };
        if cut.scatter.is_some_and(|seed| random(seed, [column, row], 2) < 0.5) {
            quad.corners.rotate_left(1);
            quad.uvs.rotate_left(1);
        }
        quad
    };
    let columns = 0..columns;
    columns
        .flat_map(|column| (0..rows).map(move |row| [column, row]))
        .map(|[column, row]| face(column, row))
        .collect()
}

/// The same faces, seen from behind.
pub fn turned_in(mut quads: Vec<Quad>) -> Vec<Quad> {
    for quad in &mut quads {
        quad.corners.reverse();
        quad.uvs.reverse();
    }
    quads
}

/// The place of one of several patches on a sheet, with room around it.
pub fn on_sheet(index: usize, count: usize) -> PatchUvs {
    let columns = (count as f32).sqrt().ceil();
    let side = 1.0 / columns;
    let [x, y] = [index as f32 % columns, (index as f32 / columns).floor()];
    [
        [(x + 0.04) * side, (y + 0.04) * side],
        [(x + 0.96) * side, (y + 0.96) * side],
    ]
}

/// Right, up and out of the sides of a cube.
const SIDES: [[DVec3; 3]; 6] = [
    [DVec3::NEG_Z, DVec3::Y, DVec3::X],
    [DVec3::Z, DVec3::Y, DVec3::NEG_X],
    [DVec3::X, DVec3::NEG_Z, DVec3::Y],
    [DVec3::X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::X, DVec3::Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z],
];

/// A cube around the origin from -1 to 1, its places passed on.
pub fn bent_cube(bend: impl Fn(DVec3) -> DVec3, cut: PatchDivision) -> Vec<Quad> {
    let sides = SIDES.iter().enumerate().flat_map(|(index, [right, up, out])| {
        let at = |s: f64, t: f64| bend(*out + *right * (2.0 * s - 1.0) + *up * (2.0 * t - 1.0));
        patch(at, on_sheet(index, 6), cut)
    });
    sides.collect()
}

/// A cube around the origin of one unit a side.
pub fn cube(cut: PatchDivision) -> Vec<Quad> {
    bent_cube(|at| 0.5 * at, cut)
}

/// A ball around the origin.
pub fn ball(radius: f64, steps: u32) -> Vec<Quad> {
    bent_cube(|at| radius * at.normalize(), PatchDivision::even(steps))
}

/// A tube around the y axis without ends, from -1 to 1, of flat sides whose edges are `radius` from the axis.
pub fn tube(sides: u32, radius: f64) -> Vec<Quad> {
    let at = |s: f64, t: f64| {
        let (sine, cosine) = (TAU * s).sin_cos();
        DVec3::new(radius * sine, 2.0 * t - 1.0, radius * cosine)
    };
    let cut = PatchDivision {
        steps: [sides, 1],
        scatter: None,
    };
    patch(at, [[0.02, 0.02], [0.98, 0.98]], cut)
}
