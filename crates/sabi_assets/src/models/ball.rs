//! The ball cut into the six charts of a cube, and closed shapes that are a ball pulled into form.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_4;

use glam::{DVec2, DVec3, dvec2};

use super::charted_mesh::{ChartedMesh, Corner, place_key};

/// Right, up and outward of each face of a cube; right × up is outward.
pub(crate) const FACES: [[DVec3; 3]; 6] = [
    [DVec3::NEG_Z, DVec3::Y, DVec3::X],
    [DVec3::Z, DVec3::Y, DVec3::NEG_X],
    [DVec3::X, DVec3::NEG_Z, DVec3::Y],
    [DVec3::X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::X, DVec3::Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z],
];

/// The direction of a face's point, both coordinates in −1..1; equal steps are nearly equal angles.
fn direction([right, up, out]: [DVec3; 3], at: DVec2) -> DVec3 {
    (out + right * (at.x * FRAC_PI_4).tan() + up * (at.y * FRAC_PI_4).tan()).normalize_or_zero()
}

/// A ball about the origin: six charts of `steps`² quads, exact normals.
pub(crate) fn ball(radius: f64, steps: usize) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    let side = radius * 2.0 * FRAC_PI_4;
    for face in FACES {
        let at = |i: usize| 2.0 * i as f64 / steps as f64 - 1.0;
        let rows: Vec<Vec<Corner>> = (0..=steps)
            .map(|j| {
                let place = |i: usize| {
                    let at = dvec2(at(i), at(j));
                    let normal = direction(face, at);
                    Corner {
                        position: normal * radius,
                        sheet: at * side,
                        normal: Some(normal),
                    }
                };
                (0..=steps).map(place).collect()
            })
            .collect();
        shape.grid(&rows);
    }
    shape
}

/// The grid of a ball whose points may move: the six faces share the points of their common edges.
#[derive(Clone, Debug)]
pub(crate) struct Skin {
    /// Directions at first; places once they were pulled into form.
    pub(crate) points: Vec<DVec3>,
    /// For each face its rows of point numbers.
    pub(crate) faces: Vec<Vec<Vec<usize>>>,
    /// Numbers of the points beside each point, ascending.
    pub(crate) beside: Vec<Vec<usize>>,
}

impl Skin {
    /// The ball's own grid.
    pub(crate) fn new(steps: usize) -> Skin {
        let mut points = Vec::new();
        let mut numbers = BTreeMap::new();
        let mut faces = Vec::new();
        for face in FACES {
            let mut number_at = |i: usize, j: usize| {
                let at = dvec2(i as f64, j as f64) * 2.0 / steps as f64 - 1.0;
                let point = direction(face, at);
                *numbers.entry(place_key(point)).or_insert_with(|| {
                    points.push(point);
                    points.len() - 1
                })
            };
            let rows = (0..=steps).map(|j| (0..=steps).map(|i| number_at(i, j)).collect::<Vec<usize>>());
            faces.push(rows.collect::<Vec<_>>());
        }
        let mut beside = vec![BTreeSet::new(); points.len()];
        let mut join = |one: usize, other: usize| {
            beside[one].insert(other);
            beside[other].insert(one);
        };
        for rows in &faces {
            for row in rows {
                row.windows(2).for_each(|pair| join(pair[0], pair[1]));
            }
            for pair in rows.windows(2) {
                pair[0]
                    .iter()
                    .zip(&pair[1])
                    .for_each(|(&below, &above)| join(below, above));
            }
        }
        let beside = beside.into_iter().map(|set| set.into_iter().collect()).collect();
        Skin { points, faces, beside }
    }

    /// Each face laid flat by [`unroll`].
    pub(crate) fn sheets(&self, rounds: usize) -> Vec<Vec<Vec<DVec2>>> {
        let faces = self.faces.iter();
        faces.map(|rows| unroll(&self.points, rows, rounds)).collect()
    }

    /// The shape, each face one chart.
    pub(crate) fn shape(&self, rounds: usize) -> ChartedMesh {
        let mut shape = ChartedMesh::default();
        for (rows, sheet) in self.faces.iter().zip(self.sheets(rounds)) {
            let corners: Vec<Vec<Corner>> = rows
                .iter()
                .zip(&sheet)
                .map(|(row, sheet)| {
                    row.iter()
                        .zip(sheet)
                        .map(|(&number, &sheet)| Corner {
                            position: self.points[number],
                            sheet,
                            normal: None,
                        })
                        .collect()
                })
                .collect();
            shape.grid(&corners);
        }
        shape
    }
}

/// Flattens a grid of points with little stretch. It starts from an even grid of the right size; then each point in
/// turn is moved to the place that fits its true distances from its neighbors best, but never so far that a triangle
/// beside it would flip.
fn unroll(points: &[DVec3], rows: &[Vec<usize>], rounds: usize) -> Vec<Vec<DVec2>> {
    let steps = rows.len() - 1;
    let length = |a: (usize, usize), b: (usize, usize)| points[rows[a.1][a.0]].distance(points[rows[b.1][b.0]]);
    let mut total = DVec2::ZERO;
    for j in 0..=steps {
        for i in 0..steps {
            total += dvec2(length((i, j), (i + 1, j)), length((j, i), (j, i + 1)));
        }
    }
    let cell = total / (steps * (steps + 1)) as f64;
    let mut sheet: Vec<Vec<DVec2>> = (0..=steps)
        .map(|j| (0..=steps).map(|i| dvec2(i as f64, j as f64) * cell).collect())
        .collect();
    for _ in 0..rounds {
        for j in 0..=steps {
            for i in 0..=steps {
                let old = sheet[j][i];
                let (mut push, mut count) = (DVec2::ZERO, 0.0);
                for (x, y) in neighbors(i, j, steps) {
                    let apart = old - sheet[y][x];
                    push += apart * (length((i, j), (x, y)) / apart.length().max(1e-9) - 1.0);
                    count += 1.0;
                }
                push *= 0.7 / count;
                sheet[j][i] = old + push;
                while flattest_corner(&sheet, i, j) < 0.25 && push.length() > 1e-6 {
                    push *= 0.5;
                    sheet[j][i] = old + push;
                }
                if push.length() <= 1e-6 {
                    sheet[j][i] = old;
                }
            }
        }
    }
    sheet
}

/// The least sine of the corners, with the grid's own turn, of the quads around a point; every way to halve a quad
/// has its triangles among these corners.
fn flattest_corner(sheet: &[Vec<DVec2>], i: usize, j: usize) -> f64 {
    let steps = sheet.len() - 1;
    let mut least = 1.0f64;
    for y in j.saturating_sub(1)..=j.min(steps - 1) {
        for x in i.saturating_sub(1)..=i.min(steps - 1) {
            let quad = [sheet[y][x], sheet[y][x + 1], sheet[y + 1][x + 1], sheet[y + 1][x]];
            for k in 0..4 {
                let one = (quad[(k + 1) % 4] - quad[k]).normalize_or_zero();
                let other = (quad[(k + 3) % 4] - quad[k]).normalize_or_zero();
                least = least.min(one.perp_dot(other));
            }
        }
    }
    least
}

/// The up to eight grid points around one.
fn neighbors(i: usize, j: usize, steps: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..9).filter(|&k| k != 4).filter_map(move |k| {
        let x = (i + k % 3).checked_sub(1)?;
        let y = (j + k / 3).checked_sub(1)?;
        (x <= steps && y <= steps).then_some((x, y))
    })
}
