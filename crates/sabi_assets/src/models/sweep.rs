//! Solids from outlines: drawn along a path, or turned about an axis.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::charted_mesh::{ChartedMesh, Corner};
use super::outline::{Outline, fill, offset};

/// A place on a path, with the plane the outline lies in; the path goes along `side × up`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Station {
    /// The outline's origin, in meters.
    pub(crate) center: DVec3,
    /// The outline's x.
    pub(crate) side: DVec3,
    /// The outline's y.
    pub(crate) up: DVec3,
}

impl Station {
    /// Returns the position of a point of the outline in space, in meters.
    pub(crate) fn place(&self, point: DVec2) -> DVec3 {
        self.center + self.side * point.x + self.up * point.y
    }

    fn along(&self) -> DVec3 {
        self.side.cross(self.up)
    }
}

/// Rounding of the two ends of a swept solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepEnds {
    /// In meters, less than the outline's own corner radii.
    pub(crate) radius: f64,
    /// Pieces of the quarter circle; 1 is a plain bevel.
    pub(crate) segments: usize,
}

/// Draws a counter-clockwise outline along a path and closes both ends. The wall is one chart from seam to seam, each
/// end with its rounding is one more.
pub(crate) fn sweep(outline: &Outline, path: &[Station], ends: SweepEnds) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    for range in seam_to_seam(outline) {
        wall(&mut shape, outline, path, range, ends.radius);
    }
    if let (Some(first), Some(last)) = (path.first(), path.last()) {
        end_cap(&mut shape, &outline.points, first, first.along(), ends, true);
        end_cap(&mut shape, &outline.points, last, -last.along(), ends, false);
    }
    shape
}

/// Runs of outline points from one chart border to the next; numbers past the end begin again at the start.
pub(crate) fn seam_to_seam(outline: &Outline) -> Vec<RangeInclusive<usize>> {
    let count = outline.points.len();
    let seams = if outline.seams.is_empty() {
        &[0][..]
    } else {
        &outline.seams
    };
    let after = seams[1..].iter().copied().chain([seams[0] + count]);
    seams.iter().zip(after).map(|(&first, last)| first..=last).collect()
}

/// One chart of the wall: the outline's points of a range, along the whole path short of the rounded ends.
fn wall(shape: &mut ChartedMesh, outline: &Outline, path: &[Station], range: RangeInclusive<usize>, end_radius: f64) {
    let count = outline.points.len();
    let mut rows = Vec::new();
    let mut y = 0.0;
    for (j, station) in path.iter().enumerate() {
        let mut station = *station;
        if j == 0 {
            station.center += station.along() * end_radius;
        } else if j == path.len() - 1 {
            station.center -= station.along() * end_radius;
        }
        if j > 0 {
            y += station.center.distance(path[j - 1].center) - if j == 1 { end_radius } else { 0.0 };
        }
        let mut x = 0.0;
        let mut row = Vec::new();
        for i in range.clone() {
            let point = outline.points[i % count];
            if i > *range.start() {
                x += point.distance(outline.points[(i - 1) % count]);
            }
            row.push(Corner {
                position: station.place(point),
                sheet: dvec2(x, y),
                normal: None,
            });
        }
        rows.push(row);
    }
    shape.grid(&rows);
}

/// An end: rings of the rounding and the flat fill, as one chart; the rings lie on the sheet at their true distance.
/// `inward` leads from the end into the solid, by one meter of depth.
pub(crate) fn end_cap(
    shape: &mut ChartedMesh,
    outline: &[DVec2],
    station: &Station,
    inward: DVec3,
    ends: SweepEnds,
    is_start: bool,
) {
    let chart = shape.begin_chart();
    let mirror = dvec2(if is_start { -1.0 } else { 1.0 }, 1.0);
    let ring = |i: usize| -> Vec<Corner> {
        let angle = FRAC_PI_2 * (i as f64 / ends.segments as f64);
        let center = station.center + inward * ends.radius * (1.0 - angle.sin());
        let inset = offset(outline, -ends.radius * (1.0 - angle.cos()));
        let sheet = offset(outline, ends.radius * (FRAC_PI_2 - angle - 1.0));
        inset
            .iter()
            .zip(&sheet)
            .map(|(&point, &sheet)| Corner {
                position: Station { center, ..*station }.place(point),
                sheet: sheet * mirror,
                normal: None,
            })
            .collect()
    };
    let rings: Vec<Vec<Corner>> = (0..=ends.segments).map(ring).collect();
    let count = outline.len();
    for pair in rings.windows(2) {
        for i in 0..count {
            let next = (i + 1) % count;
            let quad = [pair[0][i], pair[0][next], pair[1][next], pair[1][i]];
            shape.quad(
                chart,
                if is_start {
                    [quad[1], quad[0], quad[3], quad[2]]
                } else {
                    quad
                },
            );
        }
    }
    let flat = &rings[ends.segments];
    for [a, b, c] in fill(&offset(outline, -ends.radius)) {
        shape.triangle(
            chart,
            if is_start {
                [flat[b], flat[a], flat[c]]
            } else {
                [flat[a], flat[b], flat[c]]
            },
        );
    }
}

/// Turns a line of (distance from the axis, height) from the top of the y axis to its foot about that axis. The top
/// with its rim is one round chart, the underside (everything from `under` on) another.
pub(crate) fn turned(line: &[DVec2], under: usize, segments: usize) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    let mut disc = |line: &[DVec2], faces_down: bool| {
        let chart = shape.begin_chart();
        let mut from_axis = 0.0;
        let mut rings: Vec<Vec<Corner>> = Vec::new();
        for (k, point) in line.iter().enumerate() {
            if k > 0 {
                from_axis += point.distance(line[k - 1]);
            }
            let ring = (0..segments).map(|i| {
                let radial = DVec2::from_angle(TAU * i as f64 / segments as f64);
                let position = dvec3(radial.x * point.x, point.y, -radial.y * point.x);
                let sheet = radial * from_axis * dvec2(1.0, if faces_down { -1.0 } else { 1.0 });
                Corner {
                    position,
                    sheet,
                    normal: None,
                }
            });
            rings.push(ring.collect());
        }
        for pair in rings.windows(2) {
            for i in 0..segments {
                let next = (i + 1) % segments;
                let quad = [pair[0][i], pair[1][i], pair[1][next], pair[0][next]];
                shape.quad(
                    chart,
                    if faces_down {
                        [quad[3], quad[2], quad[1], quad[0]]
                    } else {
                        quad
                    },
                );
            }
        }
    };
    disc(&line[..=under], false);
    let underside: Vec<DVec2> = line[under..].iter().rev().copied().collect();
    disc(&underside, true);
    shape
}
