//! Tall solids of revolution, fluted or not: vertical strips around, a disc at each end.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::charted_mesh::{ChartedMesh, Corner};

/// Profile and divisions of a turned solid.
pub(crate) struct LatheSolid<'a> {
    /// (distance from the axis, height) from the lower end to the upper one, along the outside.
    pub(crate) line: &'a [DVec2],
    /// Angles of its points around the axis, in radians, ascending over one turn without its end.
    pub(crate) angles: &'a [f64],
    /// Number of charts that share the wall; a divisor of the number of angles.
    pub(crate) strips: usize,
    /// Depth of the cut, in meters, by the index of a line point and of an angle.
    pub(crate) dent: &'a dyn Fn(usize, usize) -> f64,
}

/// Angles spread evenly over one turn.
pub(crate) fn even_angles(count: usize) -> Vec<f64> {
    (0..count).map(|i| TAU * i as f64 / count as f64).collect()
}

/// Turns it about the y axis.
pub(crate) fn lathe(what: &LatheSolid) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    let count = what.angles.len();
    let around = |i: usize| DVec2::from_angle(what.angles[i % count]);
    let place = |k: usize, i: usize| {
        let out = around(i) * (what.line[k].x - (what.dent)(k, i % count));
        dvec3(out.x, what.line[k].y, -out.y)
    };
    let width = count / what.strips;
    for strip in 0..what.strips {
        let (first, last) = (strip * width, (strip + 1) * width);
        let mut y = 0.0;
        let row = |k: usize| -> Vec<Corner> {
            if k > 0 {
                y += what.line[k].distance(what.line[k - 1]);
            }
            let mut lengths = vec![0.0];
            for i in first + 1..=last {
                lengths.push(lengths[i - first - 1] + place(k, i).distance(place(k, i - 1)));
            }
            let middle = lengths[width] / 2.0;
            let corner = |i: usize| Corner {
                position: place(k, i),
                sheet: dvec2(lengths[i - first] - middle, y),
                normal: None,
            };
            (first..=last).map(corner).collect()
        };
        let rows: Vec<Vec<Corner>> = (0..what.line.len()).map(row).collect();
        shape.grid(&rows);
    }
    for (k, mirror) in [(0, -1.0), (what.line.len() - 1, 1.0)] {
        let chart = shape.begin_chart();
        let middle = Corner {
            position: DVec3::Y * what.line[k].y,
            sheet: DVec2::ZERO,
            normal: None,
        };
        for i in 0..count {
            let rim = |i: usize| Corner {
                position: place(k, i),
                sheet: dvec2(mirror, 1.0) * around(i) * what.line[k].x,
                normal: None,
            };
            let (one, other) = if mirror > 0.0 {
                (rim(i), rim(i + 1))
            } else {
                (rim(i + 1), rim(i))
            };
            shape.triangle(chart, [middle, one, other]);
        }
    }
    shape
}

/// Points of an arc about a center, angles in degrees, both ends included.
pub(crate) fn arc(center: DVec2, radii: DVec2, from: f64, to: f64, pieces: usize) -> Vec<DVec2> {
    (0..=pieces)
        .map(|i| center + DVec2::from_angle((from + (to - from) * i as f64 / pieces as f64).to_radians()) * radii)
        .collect()
}
