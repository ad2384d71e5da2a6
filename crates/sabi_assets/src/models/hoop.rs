//! Solids drawn along a way that comes back to its start: hoops, rings, links.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, dvec2};

use super::charted_mesh::{ChartedMesh, Corner};
use super::outline::Outline;
use super::sweep::{Station, seam_to_seam};

/// Draws a counter-clockwise outline along a closed path; each run from seam to seam is cut across into `pieces` charts,
/// each as long as that run is on average.
pub(crate) fn hoop(outline: &Outline, path: &[Station], pieces: usize) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    let count = outline.points.len();
    for range in seam_to_seam(outline) {
        let place = |j: usize, i: usize| path[j % path.len()].place(outline.points[i % count]);
        let mut along = 0.0;
        let mut rows: Vec<Vec<Corner>> = Vec::new();
        for j in 0..=path.len() {
            if j > 0 {
                let steps = range.clone().map(|i| place(j, i).distance(place(j - 1, i)));
                along += steps.sum::<f64>() / range.clone().count() as f64;
            }
            let mut across = 0.0;
            let corner = |i: usize| {
                if i > *range.start() {
                    across += outline.points[i % count].distance(outline.points[(i - 1) % count]);
                }
                Corner {
                    position: place(j, i),
                    sheet: dvec2(across, along),
                    normal: None,
                }
            };
            rows.push(range.clone().map(corner).collect());
        }
        for piece in 0..pieces {
            shape.grid(&rows[piece * path.len() / pieces..=(piece + 1) * path.len() / pieces]);
        }
    }
    shape
}

/// Stations about the y axis: the outline's x points away from the axis and its y along `up` of (out, y).
pub(crate) fn circle_path(radius: f64, height: f64, up: DVec2, segments: usize) -> Vec<Station> {
    let station = |i: usize| {
        // This way around, away × up is the way on.
        let out = DVec2::from_angle(-TAU * i as f64 / segments as f64);
        let away = DVec3::new(out.x, 0.0, -out.y);
        Station {
            center: away * radius + DVec3::Y * height,
            side: away * up.y - DVec3::Y * up.x,
            up: away * up.x + DVec3::Y * up.y,
        }
    };
    (0..segments).map(station).collect()
}

/// Stations of a link in the plane of x and y: two half circles of a radius about (±half_straight, 0). The outline's x
/// points away from the middle, its y along z. One straight side is swollen by `weld` where it was forged shut.
pub(crate) fn link_path(half_straight: f64, radius: f64, bend_pieces: usize, weld: f64) -> Vec<Station> {
    let station = |at: DVec2, out: DVec2, scale: f64| Station {
        center: at.extend(0.0),
        side: out.extend(0.0) * scale,
        up: DVec3::Z * scale,
    };
    let mut path = Vec::new();
    // Clockwise seen from z, starting where the lower side meets the left bend.
    for (end, middle, start) in [(-1.0, DVec2::Y, 1.5), (1.0, DVec2::NEG_Y, 0.5)] {
        for i in 0..=bend_pieces {
            let angle = PI * (start - i as f64 / bend_pieces as f64);
            let out = DVec2::from_angle(angle);
            path.push(station(dvec2(end * half_straight, 0.0) + out * radius, out, 1.0));
        }
        let swell = if end < 0.0 { 1.0 + weld } else { 1.0 };
        for (share, scale) in [(-0.5, 1.0), (-0.2, swell), (0.2, swell), (0.5, 1.0)] {
            path.push(station(dvec2(share * half_straight, radius) * middle.y, middle, scale));
        }
    }
    path
}
