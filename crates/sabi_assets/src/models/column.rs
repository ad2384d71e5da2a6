//! A fluted column of three drums on an Attic base, with an echinus and an abacus. 2.5 m high.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, dvec2};

use super::bar::{Bar, timber};
use super::charted_mesh::{ChartedMesh, ModelPart};
use super::glb::{Material, Model};
use super::lathe::{LatheSolid, arc, even_angles, lathe};

/// Flutes around the shaft, and points across one of them, its fillet included.
const FLUTES: usize = 20;
const POINTS: usize = 6;
/// Heights of the ends of the shaft, in meters above the ground.
const FOOT: f64 = 0.23;
const NECK: f64 = 2.22;
/// Radius of the shaft at its foot and neck.
const RADII: [f64; 2] = [0.165, 0.138];

/// The column.
pub(crate) fn column() -> Model {
    let block = |name: &str, side: f64, from: f64, to: f64| {
        let shape = timber(side, to - from, 0.008, &Bar::of(side));
        part(name, DVec3::Y * (from + to) / 2.0, shape)
    };
    let parts = vec![
        block("plinth", 0.48, 0.0, 0.1),
        part("base", DVec3::ZERO, base()),
        part("shaft", DVec3::ZERO, shaft()),
        part("capital", DVec3::ZERO, capital()),
        block("abacus", 0.46, 2.4, 2.5),
    ];
    Model {
        name: "column",
        paint: None,
        materials: vec![Material::plain("marble", [0.62, 0.59, 0.53])],
        parts,
    }
}

fn part(name: &str, translation: DVec3, shape: ChartedMesh) -> ModelPart {
    ModelPart {
        translation,
        smooth_below: 38.0,
        ..ModelPart::new(name, shape)
    }
}

/// Two tori with a hollow between them.
fn base() -> ChartedMesh {
    let mut line = arc(dvec2(0.196, 0.132), dvec2(0.036, 0.036), -90.0, 90.0, 8);
    line.push(dvec2(0.204, 0.176));
    line.extend(
        arc(dvec2(0.207, 0.19), dvec2(0.02, 0.014), -90.0, -180.0, 4)
            .into_iter()
            .skip(1),
    );
    line.extend(
        arc(dvec2(0.197, 0.2), dvec2(0.01, 0.008), -180.0, -270.0, 2)
            .into_iter()
            .skip(1),
    );
    line.extend(arc(dvec2(0.19, 0.222), dvec2(0.014, 0.014), -90.0, 90.0, 5));
    plain(&line, 40)
}

/// A ring below the neck, a hollow, three fillets and the cushion that carries the abacus.
fn capital() -> ChartedMesh {
    let mut line = vec![dvec2(0.142, 2.205)];
    line.extend(arc(dvec2(0.146, 2.22), dvec2(0.013, 0.013), -90.0, 90.0, 6));
    line.push(dvec2(0.139, 2.235));
    line.push(dvec2(0.139, 2.285));
    line.extend(
        arc(dvec2(0.155, 2.285), dvec2(0.016, 0.018), 180.0, 90.0, 3)
            .into_iter()
            .skip(1),
    );
    for i in 0..2 {
        let (out, y) = (0.162 + 0.007 * f64::from(i), 2.303 + 0.011 * f64::from(i));
        line.extend([dvec2(out, y + 0.001), dvec2(out + 0.001, y + 0.01)]);
    }
    line.extend(arc(dvec2(0.17, 2.395), dvec2(0.05, 0.068), -86.0, 18.0, 8));
    line.push(dvec2(0.205, 2.416));
    plain(&line, 40)
}

/// Turned without flutes, in four charts.
fn plain(line: &[DVec2], around: usize) -> ChartedMesh {
    let angles = even_angles(around);
    lathe(&LatheSolid {
        line,
        angles: &angles,
        strips: 4,
        dent: &|_, _| 0.0,
    })
}

/// The radius at a height: the shaft swells a little before it narrows.
fn radius_at(y: f64) -> f64 {
    let t = ((y - FOOT) / (NECK - FOOT)).clamp(0.0, 1.0);
    RADII[0] + (RADII[1] - RADII[0]) * t.powf(1.7)
}

/// The shaft: flutes that end in round niches, drums with a worn joint between them.
fn shaft() -> ChartedMesh {
    // Radius beyond the shaft's own, height, and how deep the flutes are there.
    let mut rows: Vec<(f64, f64, f64)> = vec![(0.02, FOOT, 0.0), (0.02, FOOT + 0.02, 0.0), (0.013, FOOT + 0.023, 0.0)];
    rows.extend([(0.005, FOOT + 0.035, 0.0), (0.0, FOOT + 0.055, 0.0)]);
    let (low, high, niche) = (FOOT + 0.07, NECK - 0.04, 0.03);
    let ends = [0.0, 0.08, 0.35, 1.0];
    let depth = |share: f64| (1.0 - (1.0 - share) * (1.0 - share)).sqrt();
    rows.extend(ends.map(|share| (0.0, low + niche * share, depth(share))));
    let joints = [FOOT + 0.36 * (NECK - FOOT), FOOT + 0.69 * (NECK - FOOT)];
    let mut from = low + niche;
    for joint in joints.into_iter().chain([high - niche]) {
        let is_joint = joint < high - niche;
        let until = if is_joint { joint - 0.006 } else { joint };
        rows.extend((1..3).map(|i| (0.0, from + (until - from) * f64::from(i) / 3.0, 1.0)));
        if is_joint {
            rows.extend([
                (0.0, joint - 0.006, 1.0),
                (-0.006, joint, 1.0),
                (0.0, joint + 0.006, 1.0),
            ]);
            from = joint + 0.006;
        }
    }
    rows.extend(
        ends.iter()
            .rev()
            .map(|&share| (0.0, high - niche * share, depth(share))),
    );
    rows.extend([(0.0, NECK - 0.025, 0.0), (0.004, NECK - 0.01, 0.0), (0.01, NECK, 0.0)]);
    let line: Vec<DVec2> = rows.iter().map(|&(out, y, _)| dvec2(radius_at(y) + out, y)).collect();
    let fillet = 0.2;
    let angles: Vec<f64> = (0..FLUTES * POINTS)
        .map(|i| {
            let across = PI * (i % POINTS) as f64 / (POINTS - 1) as f64;
            let share = fillet / 2.0 + (1.0 - fillet) * (1.0 - across.cos()) / 2.0;
            ((i / POINTS) as f64 + share) * TAU / FLUTES as f64
        })
        .collect();
    let dent = |k: usize, i: usize| {
        let across = PI * (i % POINTS) as f64 / (POINTS - 1) as f64;
        rows[k].2 * 0.34 * line[k].x * TAU / FLUTES as f64 * across.sin()
    };
    lathe(&LatheSolid {
        line: &line,
        angles: &angles,
        strips: 4,
        dent: &dent,
    })
}
