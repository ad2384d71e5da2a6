//! A barrel: twenty bulged staves, two heads of boards, six iron hoops with rivets, a bung. 0.9 m high.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3, dvec2, dvec3};

use super::charted_mesh::{ChartedMesh, Corner, ModelPart, part};
use super::fixings::{chance, head, standing_on};
use super::glb::{Material, Model};
use super::hoop::{circle_path, hoop};
use super::outline::{Outline, OutlineCorner, rectangle, rounded};
use super::sweep::{Station, SweepEnds, end_cap, sweep, turned};

const WOOD: usize = 0;
const IRON: usize = 1;

const STAVES: usize = 20;
const HEIGHT: f64 = 0.9;
/// Outer radius at the ends and at the belly.
const RADII: [f64; 2] = [0.268, 0.335];
/// Thickness of a stave.
const STAVE: f64 = 0.026;
/// Distance of a head's boards below the staves' ends.
const CHIME: f64 = 0.05;

/// The barrel.
pub(crate) fn barrel() -> Model {
    let mut parts: Vec<ModelPart> = (0..STAVES).map(stave).collect();
    for (name, y) in [("bottom", CHIME), ("top", HEIGHT - CHIME)] {
        parts.extend(barrel_head(name, y));
    }
    let mut rivets = ChartedMesh::default();
    for (number, y) in [0.035, 0.165, 0.3, 0.6, 0.735, 0.865].into_iter().enumerate() {
        let broad = if number % 5 == 0 { 0.046 } else { 0.038 };
        parts.push(iron(format!("hoop_{number}"), iron_hoop(y, broad)));
        // Direction of the overlapping ends; another one for each hoop, as if made by hand.
        let seam_angle = 0.35 + 0.12 * chance(number as u32);
        for step in [-1.0, 1.0] {
            let angle = seam_angle + step * 0.045;
            let out = dvec3(angle.sin(), 0.0, angle.cos());
            let normal = (out - DVec3::Y * slope_at(y)).normalize_or_zero();
            rivets.append(
                head(0.0085, 0.005, 8),
                standing_on(normal),
                out * (radius_at(y) + 0.0039) + DVec3::Y * y,
            );
        }
    }
    parts.push(iron("rivets".into(), rivets));
    parts.push(bung());
    Model {
        name: "barrel",
        paint: None,
        materials: vec![Material::plain("wood", [0.36, 0.22, 0.12]), Material::iron()],
        parts,
    }
}

/// The belly's curve.
fn radius_at(y: f64) -> f64 {
    let from_middle = (y / HEIGHT) * 2.0 - 1.0;
    RADII[1] - (RADII[1] - RADII[0]) * from_middle * from_middle
}

/// Returns the derivative of the radius by the height.
fn slope_at(y: f64) -> f64 {
    -4.0 * (RADII[1] - RADII[0]) / HEIGHT * ((y / HEIGHT) * 2.0 - 1.0)
}

fn wood(name: String, translation: DVec3, rotation: DQuat, shape: ChartedMesh) -> ModelPart {
    part(name, WOOD, translation, rotation, shape)
}

fn iron(name: String, shape: ChartedMesh) -> ModelPart {
    ModelPart {
        material: IRON,
        ..ModelPart::new(name, shape)
    }
}

/// A stave's section at the belly: round outside, x along the rim and y outward, the chart border inside.
fn stave_outline() -> Outline {
    let half = TAU / STAVES as f64 / 2.0 * RADII[1] - 0.0006;
    let bulge = |x: f64| -x * x / (2.0 * RADII[1]);
    let turn = |x: f64, y: f64, radius: f64, seam: bool| OutlineCorner {
        at: dvec2(x, y + bulge(x)),
        radius,
        seam,
    };
    let inner = half * (1.0 - STAVE / RADII[1]);
    let turns = [
        turn(0.0, -STAVE, 0.0, true),
        turn(inner, -STAVE, 0.003, false),
        turn(half, 0.0, 0.003, false),
        turn(half / 3.0, 0.0, 0.0, false),
        turn(-half / 3.0, 0.0, 0.0, false),
        turn(-half, 0.0, 0.003, false),
        turn(-inner, -STAVE, 0.003, false),
    ];
    rounded(&turns, 2, true)
}

/// One stave, bent and narrowed toward its ends; its x points up.
fn stave(number: usize) -> ModelPart {
    let outline = stave_outline();
    let lot = number as u32 * 3;
    let length = HEIGHT + 0.003 * chance(lot);
    let out = 0.0012 * chance(lot + 1);
    let pieces = 7;
    let station = |i: usize| {
        let y = HEIGHT / 2.0 + (i as f64 / pieces as f64 - 0.5) * length;
        let along = dvec3(0.0, 1.0, slope_at(y)).normalize_or_zero();
        let scale = radius_at(y) / RADII[1];
        // At the ends the section lies level, as sawn.
        let up = if i == 0 || i == pieces {
            DVec3::Z
        } else {
            along.cross(DVec3::NEG_X)
        };
        Station {
            center: dvec3(0.0, y, radius_at(y) + out),
            side: DVec3::NEG_X * scale,
            up,
        }
    };
    let path: Vec<Station> = (0..=pieces).map(station).collect();
    let angle = TAU * number as f64 / STAVES as f64;
    wood(
        format!("stave_{number}"),
        DVec3::ZERO,
        DQuat::from_rotation_y(angle),
        tapered(&outline, &path),
    )
}

/// A sweep whose section narrows only along its x; the wall's chart narrows with it.
fn tapered(outline: &Outline, path: &[Station]) -> ChartedMesh {
    let mut shape = ChartedMesh::default();
    let ends = SweepEnds {
        radius: 0.002,
        segments: 1,
    };
    let count = outline.points.len();
    let along = |station: &Station| station.side.cross(station.up).normalize_or_zero();
    let last = path.len() - 1;
    let mut rows: Vec<Vec<Corner>> = Vec::new();
    let mut y = 0.0;
    for (j, station) in path.iter().enumerate() {
        let mut station = *station;
        if j == 0 {
            station.center += along(&station) * ends.radius;
        } else if j == last {
            station.center -= along(&station) * ends.radius;
        }
        if j > 0 {
            y += station.center.distance(path[j - 1].center);
        }
        let mut x = 0.0;
        let mut row = Vec::new();
        for i in 0..=count {
            let position = station.place(outline.points[i % count]);
            if i > 0 {
                x += position.distance(station.place(outline.points[i - 1]));
            }
            row.push(Corner {
                position,
                sheet: dvec2(x, y),
                normal: None,
            });
        }
        row.iter_mut().for_each(|corner| corner.sheet.x -= x / 2.0);
        rows.push(row);
    }
    shape.grid(&rows);
    for (station, is_start) in [(&path[0], true), (&path[last], false)] {
        let inward = along(station) * if is_start { 1.0 } else { -1.0 };
        end_cap(&mut shape, &outline.points, station, inward, ends, is_start);
    }
    shape
}

/// Four boards side by side, cut round.
fn barrel_head(name: &str, y: f64) -> Vec<ModelPart> {
    let radius = radius_at(y) - STAVE + 0.004;
    let (boards, thick) = (4, 0.02);
    let broad = 2.0 * radius / f64::from(boards);
    (0..boards)
        .map(|i| {
            let low = -radius + broad * f64::from(i) + 0.0008;
            let high = low + broad - 0.0016;
            // The board's plan: straight edges where it meets its neighbors, an arc at each end.
            let end = |x: f64, z: f64| dvec2(x * (radius * radius - z * z).max(1e-4).sqrt(), z);
            let steps = 6;
            let z_at = |k: i32| low + (high - low) * (f64::from(k) / f64::from(steps)).clamp(0.02, 0.98);
            let right = (0..=steps).map(|k| end(1.0, z_at(k)));
            let left = (0..=steps).rev().map(|k| end(-1.0, z_at(k)));
            let points: Vec<DVec2> = right.chain(left).collect();
            let outline = Outline { points, seams: vec![0] };
            let station = |y: f64| Station {
                center: DVec3::Y * y,
                side: DVec3::X,
                up: DVec3::NEG_Z,
            };
            let ends = SweepEnds {
                radius: 0.0025,
                segments: 1,
            };
            let lift = 0.0015 * chance(i as u32 + if y < HEIGHT / 2.0 { 100 } else { 110 });
            let shape = sweep(&outline, &[station(-thick / 2.0), station(thick / 2.0)], ends);
            let turn = DQuat::from_rotation_y(if y < HEIGHT / 2.0 { 0.3 } else { -0.2 });
            wood(format!("head_{name}_{i}"), DVec3::Y * (y + lift), turn, shape)
        })
        .collect()
}

/// A band that leans with the staves it holds.
fn iron_hoop(y: f64, broad: f64) -> ChartedMesh {
    let mut outline = rectangle(0.0042, broad, 0.0012, 1, 1);
    // Its chart border runs along the lower edge of the inner face, which is hardly visible.
    outline.seams = vec![7];
    let lean = dvec2(slope_at(y), 1.0).normalize_or_zero();
    hoop(&outline, &circle_path(radius_at(y) + 0.0012, y, lean, 48), 4)
}

/// The wooden stopper in the widest place of a stave.
fn bung() -> ModelPart {
    let line = [
        dvec2(0.0, 0.012),
        dvec2(0.02, 0.0115),
        dvec2(0.0235, 0.009),
        dvec2(0.025, -0.006),
        dvec2(0.0, -0.006),
    ];
    let angle = TAU * 3.0 / STAVES as f64;
    let out = dvec3(angle.sin(), 0.0, angle.cos());
    wood(
        "bung".into(),
        out * RADII[1] + DVec3::Y * HEIGHT / 2.0,
        standing_on(out),
        turned(&line, 3, 16),
    )
}
