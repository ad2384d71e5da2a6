//! Straight solids between two cuts, lying along x: planks, posts, blocks, moldings.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::charted_mesh::{ChartedMesh, Corner, place_key};
use super::outline::{Outline, rectangle};
use super::sweep::{Station, SweepEnds, end_cap, seam_to_seam};

/// Path of a section along x, centered on the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bar {
    /// Between the middles of the cuts, in meters.
    pub(crate) length: f64,
    /// Size of the section at start (−x) and end, as a share of the outline's.
    pub(crate) taper: [f64; 2],
    /// Outward normals of the cuts at start and end, unit length.
    pub(crate) cuts: [DVec3; 2],
    /// Height of its middle above its ends, in meters.
    pub(crate) bow: f64,
    /// Pieces along its length.
    pub(crate) spans: usize,
}

impl Bar {
    /// Straight, of one section, cut at right angles.
    pub(crate) fn of(length: f64) -> Bar {
        Bar {
            length,
            taper: [1.0, 1.0],
            cuts: [DVec3::NEG_X, DVec3::X],
            bow: 0.0,
            spans: 1,
        }
    }

    /// The section at one of its stations; the first and the last lie in the cuts.
    fn station(&self, number: usize) -> Station {
        let share = number as f64 / self.spans as f64;
        let across = 2.0 * share - 1.0;
        let scale = self.taper[0] + (self.taper[1] - self.taper[0]) * share;
        let cut = match number {
            0 => self.cuts[0],
            last if last == self.spans => self.cuts[1],
            _ => DVec3::X,
        };
        let onto_cut = |axis: DVec3| (axis - DVec3::X * (cut.dot(axis) / cut.x)) * scale;
        Station {
            center: dvec3(across * self.length / 2.0, self.bow * (1.0 - across * across), 0.0),
            side: onto_cut(DVec3::NEG_Z),
            up: onto_cut(DVec3::Y),
        }
    }
}

/// The outline (its x toward −z, its y toward y) drawn along a bar. The wall is laid flat as it is, so that a slanted
/// cut stays slanted on its chart; ends are of one ring, a plain bevel.
pub(crate) fn bar(outline: &Outline, along: &Bar, ends: SweepEnds) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    let points = &outline.points;
    let bent = edge_normals(points);
    let narrowing = (along.taper[1] - along.taper[0]) / along.length;
    let inward = [DVec3::X / along.cuts[0].x.abs(), DVec3::NEG_X / along.cuts[1].x.abs()];
    for range in seam_to_seam(outline) {
        let row = |number: usize| -> Vec<Corner> {
            let mut station = along.station(number);
            if number == 0 {
                station.center += inward[0] * ends.radius;
            } else if number == along.spans {
                station.center += inward[1] * ends.radius;
            }
            let scale = station.up.dot(DVec3::Y);
            let mut along_outline = 0.0;
            let corner = |i: usize| {
                let point = points[i % points.len()];
                if i > *range.start() {
                    along_outline += point.distance(points[(i - 1) % points.len()]) * scale;
                }
                let position = station.place(point);
                let flat = bent[i % points.len()];
                let across = DVec3::NEG_Z * flat.x + DVec3::Y * flat.y;
                Corner {
                    position,
                    sheet: dvec2(along_outline, position.x),
                    normal: Some((across - DVec3::X * narrowing * point.dot(flat)).normalize_or_zero()),
                }
            };
            range.clone().map(corner).collect()
        };
        let rows: Vec<Vec<Corner>> = (0..=along.spans).map(row).collect();
        shape.grid(&rows);
    }
    let wall_normals: BTreeMap<[i64; 3], Option<DVec3>> = shape
        .triangles
        .iter()
        .flat_map(|triangle| triangle.corners)
        .map(|corner| (place_key(corner.position), corner.normal))
        .collect();
    for (number, is_start) in [(0, true), (along.spans, false)] {
        let (cut, inward) = if is_start {
            (along.cuts[0], inward[0])
        } else {
            (along.cuts[1], inward[1])
        };
        let first = shape.triangles.len();
        end_cap(&mut shape, points, &along.station(number), inward, ends, is_start);
        for corner in shape.triangles[first..]
            .iter_mut()
            .flat_map(|triangle| &mut triangle.corners)
        {
            let on_wall = wall_normals.get(&place_key(corner.position)).copied().flatten();
            corner.normal = on_wall.or(Some(cut));
        }
    }
    shape
}

/// Normals at the points of an outline: the longer side beside a point decides, so that flat sides stay flat and the
/// rounding between them takes the whole turn.
fn edge_normals(points: &[DVec2]) -> Vec<DVec2> {
    let count = points.len();
    let outward = |from: DVec2, to: DVec2| -(to - from).perp() * (to - from).length();
    (0..count)
        .map(|i| {
            let (before, after) = (points[(i + count - 1) % count], points[(i + 1) % count]);
            (outward(before, points[i]) + outward(points[i], after)).normalize_or_zero()
        })
        .collect()
}

/// A bar of wood or stone with `width` along z, `height` along y and every edge broken.
pub(crate) fn timber(width: f64, height: f64, edge: f64, along: &Bar) -> ChartedMesh {
    let ends = SweepEnds {
        radius: edge * 0.7,
        segments: 1,
    };
    bar(&rectangle(width, height, edge, 2, 2), along, ends)
}

/// As [`timber`] with a plain bevel, for what there are many of.
pub(crate) fn block(width: f64, height: f64, edge: f64, along: &Bar) -> ChartedMesh {
    let ends = SweepEnds {
        radius: edge * 0.9,
        segments: 1,
    };
    bar(&rectangle(width, height, edge, 1, 1), along, ends)
}

/// The outward normal of a cut that halves a right angle: along x, and toward z or −z.
pub(crate) fn miter(along: f64, toward: f64) -> DVec3 {
    dvec3(along, 0.0, toward) * FRAC_1_SQRT_2
}
