//! A park bench: two stone sides, seven planks, iron straps with bolts, and a tie rod. 1.6 m wide.

use glam::{DMat3, DQuat, DVec2, DVec3, dvec2, dvec3};

use super::charted_mesh::{self, ChartedMesh, ModelPart};
use super::glb::{Material, Model};
use super::outline::{Outline, OutlineCorner, circle, rounded, rounded_rectangle};
use super::sweep::{Station, SweepEnds, sweep, turned};

/// Distance of the stone sides from the middle, in meters.
const SIDE_X: f64 = 0.56;
/// Thickness of a plank.
const PLANK: f64 = 0.042;
/// Thickness of a strap.
const STRAP: f64 = 0.008;

/// Points of the side view: x = toward the back, y = up.
const SEAT_FRONT: DVec2 = dvec2(-0.25, 0.445);
const CREASE: DVec2 = dvec2(0.17, 0.43);
const BACK_TOP: DVec2 = dvec2(0.285, 0.86);

/// The bench.
pub(crate) fn bench() -> Model {
    let mut parts = Vec::new();
    for (name, x) in [("left", -SIDE_X), ("right", SIDE_X)] {
        parts.push(stone(&format!("stone_{name}"), x));
        parts.push(strap(&format!("strap_{name}"), x));
        parts.push(rosette(&format!("rosette_{name}"), x));
    }
    parts.push(tie_rod());
    for (row, seat) in rows().iter().enumerate() {
        parts.push(plank(row, seat));
        for (name, x) in [("left", -SIDE_X), ("right", SIDE_X)] {
            parts.push(bolt(&format!("bolt_{name}_{row}"), seat, x));
        }
    }
    Model {
        name: "bench",
        paint: None,
        materials: vec![Material::plain("bench", [0.5, 0.42, 0.34])],
        parts,
    }
}

/// A plank's place in the side view.
struct PlankPlace {
    /// Middle of the face that rests on the stone.
    foot: DVec2,
    /// Away from the stone, unit length.
    away: DVec2,
    /// In meters.
    width: f64,
    length: f64,
    /// Sag of its middle, in meters.
    sag: f64,
}

/// Four planks to sit on, three to lean on. No two are quite alike.
fn rows() -> Vec<PlankPlace> {
    let seat = (CREASE - SEAT_FRONT).normalize_or_zero();
    let back = (BACK_TOP - CREASE).normalize_or_zero();
    let mut rows = Vec::new();
    let lengths = [1.6, 1.594, 1.6, 1.588, 1.597, 1.585, 1.6];
    let sags = [0.004, 0.006, 0.005, 0.003, 0.001, 0.0015, 0.001];
    for i in 0..4 {
        let foot = SEAT_FRONT + seat * (0.036 + 0.108 * f64::from(i));
        rows.push(PlankPlace {
            foot,
            away: seat.perp(),
            width: 0.098,
            length: 0.0,
            sag: 0.0,
        });
    }
    for i in 0..3 {
        let foot = CREASE + back * (0.132 + 0.126 * f64::from(i));
        rows.push(PlankPlace {
            foot,
            away: back.perp(),
            width: 0.114,
            length: 0.0,
            sag: 0.0,
        });
    }
    for (row, (length, sag)) in rows.iter_mut().zip(lengths.into_iter().zip(sags)) {
        (row.length, row.sag) = (length, sag);
    }
    rows
}

/// From the side view into the bench's space: x stays to be chosen, the back is toward −z.
fn in_space(x: f64, side_view: DVec2) -> DVec3 {
    dvec3(x, side_view.y, -side_view.x)
}

/// The turn that takes y to a direction of the side view and keeps x.
fn turn_to(away: DVec2) -> DQuat {
    let y = in_space(0.0, away);
    DQuat::from_mat3(&DMat3::from_cols(DVec3::X, y, DVec3::X.cross(y)))
}

fn part(name: String, translation: DVec3, rotation: DQuat, shape: ChartedMesh, smooth_below: f64) -> ModelPart {
    ModelPart {
        smooth_below,
        ..charted_mesh::part(name, 0, translation, rotation, shape)
    }
}

/// A side: its outline, drawn through its thickness, every edge broken by a mason's chisel.
fn stone(name: &str, x: f64) -> ModelPart {
    let turn = |x: f64, y: f64, radius: f64, seam: bool| OutlineCorner {
        at: dvec2(x, y),
        radius,
        seam,
    };
    let outline = rounded(
        &[
            turn(-0.28, 0.0, 0.016, true),
            turn(-0.13, 0.0, 0.016, false),
            turn(-0.08, 0.055, 0.05, false),
            turn(0.09, 0.055, 0.05, false),
            turn(0.14, 0.0, 0.016, false),
            turn(0.3, 0.0, 0.016, true),
            turn(0.3, 0.07, 0.016, false),
            turn(0.245, 0.095, 0.03, false),
            turn(0.25, 0.42, 0.3, false),
            turn(0.385, 0.88, 0.022, true),
            turn(0.345, 0.915, 0.022, false),
            turn(0.2997, 0.915, 0.018, false),
            turn(CREASE.x, CREASE.y, 0.03, false),
            turn(SEAT_FRONT.x, SEAT_FRONT.y, 0.018, true),
            turn(-0.262, 0.395, 0.018, false),
            turn(-0.19, 0.27, 0.12, false),
            turn(-0.225, 0.095, 0.03, false),
            turn(-0.28, 0.07, 0.016, false),
        ],
        3,
        true,
    );
    let path: Vec<Station> = (0..=3)
        .map(|i| Station {
            center: DVec3::X * (f64::from(i) / 3.0 - 0.5) * 0.16,
            side: DVec3::NEG_Z,
            up: DVec3::Y,
        })
        .collect();
    let shape = sweep(
        &outline,
        &path,
        SweepEnds {
            radius: 0.012,
            segments: 2,
        },
    );
    part(name.into(), dvec3(x, 0.0, 0.0), DQuat::IDENTITY, shape, 50.0)
}

/// A plank along x with its resting face at y = 0, sunk a little in its middle.
fn plank(number: usize, row: &PlankPlace) -> ModelPart {
    let outline = rounded_rectangle(row.width, PLANK, 0.008, 2);
    let pieces = 6;
    let path: Vec<Station> = (0..=pieces)
        .map(|i| {
            let t = 2.0 * f64::from(i) / f64::from(pieces) - 1.0;
            // The bolted places have not moved.
            let from_bolt = row.length / 2.0 / SIDE_X;
            let slope = 4.0 * row.sag * t * from_bolt * from_bolt / row.length;
            let along = dvec3(1.0, slope, 0.0).normalize_or_zero();
            let center = dvec3(
                t * row.length / 2.0,
                PLANK / 2.0 - row.sag * (1.0 - t * t * from_bolt * from_bolt),
                0.0,
            );
            Station {
                center,
                side: DVec3::NEG_Z,
                up: DVec3::NEG_Z.cross(along) * -1.0,
            }
        })
        .collect();
    let shape = sweep(
        &outline,
        &path,
        SweepEnds {
            radius: 0.006,
            segments: 2,
        },
    );
    part(
        format!("plank_{number}"),
        in_space(0.0, row.foot),
        turn_to(row.away),
        shape,
        60.0,
    )
}

/// Flat iron over the planks: up the front edge, along the seat, up the back.
fn strap(name: &str, x: f64) -> ModelPart {
    let seat = (CREASE - SEAT_FRONT).normalize_or_zero();
    let back = (BACK_TOP - CREASE).normalize_or_zero();
    let above = PLANK + STRAP / 2.0 - 0.0015;
    let front = SEAT_FRONT + seat * (-0.013 - STRAP / 2.0) + seat.perp() * above;
    let (seat_line, back_line) = (SEAT_FRONT + seat.perp() * above, CREASE + back.perp() * above);
    let along_seat = (back_line - seat_line).perp_dot(back) / seat.perp_dot(back);
    let turn = |at: DVec2, radius: f64| OutlineCorner {
        at,
        radius,
        seam: false,
    };
    let line = rounded(
        &[
            turn(front - seat.perp() * (PLANK + 0.03), 0.0),
            turn(front, 0.012),
            turn(seat_line + seat * along_seat, 0.04),
            turn(BACK_TOP + back * 0.006 + back.perp() * above, 0.0),
        ],
        5,
        false,
    );
    let shape = sweep(
        &rounded_rectangle(0.05, STRAP, 0.002, 1),
        &path_in_side_view(&line),
        STRAP_ENDS,
    );
    part(name.into(), dvec3(x, 0.0, 0.0), DQuat::IDENTITY, shape, 50.0)
}

const STRAP_ENDS: SweepEnds = SweepEnds {
    radius: 0.0015,
    segments: 1,
};

/// Stations along a line of the side view; the outline's y points to the left of the way.
fn path_in_side_view(line: &Outline) -> Vec<Station> {
    let points = &line.points;
    (0..points.len())
        .map(|i| {
            let arrive = (points[i] - points[i.saturating_sub(1)]).normalize_or_zero();
            let leave = (points[(i + 1).min(points.len() - 1)] - points[i]).normalize_or_zero();
            let up = in_space(0.0, (arrive + leave).normalize_or_zero().perp());
            Station {
                center: in_space(0.0, points[i]),
                side: DVec3::NEG_X,
                up,
            }
        })
        .collect()
}

/// A round bolt head on a strap.
fn bolt(name: &str, row: &PlankPlace, x: f64) -> ModelPart {
    let dome = (0..=3).map(|i| {
        let t = f64::from(i) / 3.0;
        dvec2(0.016 * t, 0.0015 + 0.0085 * (1.0 - t * t).sqrt())
    });
    let mut line: Vec<DVec2> = dome.collect();
    line.extend([dvec2(0.016, -0.001), dvec2(0.0, -0.001)]);
    let foot = row.foot + row.away * (PLANK + STRAP - 0.0015);
    part(
        name.into(),
        in_space(x, foot),
        turn_to(row.away),
        turned(&line, 4, 12),
        40.0,
    )
}

/// The cast plate with a nut's dome that holds the tie rod, on the outer face of a side.
fn rosette(name: &str, x: f64) -> ModelPart {
    let line = [
        dvec2(0.0, 0.022),
        dvec2(0.008, 0.021),
        dvec2(0.0145, 0.017),
        dvec2(0.017, 0.009),
        dvec2(0.027, 0.009),
        dvec2(0.034, 0.0115),
        dvec2(0.039, 0.0105),
        dvec2(0.042, 0.007),
        dvec2(0.042, -0.001),
        dvec2(0.0, -0.001),
    ];
    let outward = x.signum();
    let turn = DQuat::from_mat3(&DMat3::from_cols(DVec3::Y * -outward, DVec3::X * outward, DVec3::Z));
    part(
        name.into(),
        dvec3(x + outward * 0.08, 0.24, 0.02),
        turn,
        turned(&line, 8, 20),
        35.0,
    )
}

/// The rod between the sides, its ends inside the stone.
fn tie_rod() -> ModelPart {
    let path: Vec<Station> = (0..=8)
        .map(|i| Station {
            center: DVec3::X * (f64::from(i) / 4.0 - 1.0) * (SIDE_X - 0.06),
            side: DVec3::NEG_Z,
            up: DVec3::Y,
        })
        .collect();
    let shape = sweep(
        &circle(0.013, 16),
        &path,
        SweepEnds {
            radius: 0.002,
            segments: 1,
        },
    );
    part("tie_rod".into(), dvec3(0.0, 0.24, 0.02), DQuat::IDENTITY, shape, 50.0)
}
