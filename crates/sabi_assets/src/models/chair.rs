//! A kitchen chair with a leather cushion: posts bent in one piece, curved slats, turned stretchers. 0.92 m high.

use glam::{DMat3, DQuat, DVec2, DVec3, dvec2, dvec3};

use super::ball::Skin;
use super::bar::{Bar, timber};
use super::charted_mesh::{ModelPart, part};
use super::fixings::lying_along;
use super::glb::{Material, Model};
use super::hoop::hoop;
use super::outline::{OutlineCorner, circle, rectangle, rounded};
use super::sweep::{Station, SweepEnds, sweep};

const WOOD: usize = 0;
const LEATHER: usize = 1;

/// Height of the seat's upper side.
const SEAT: f64 = 0.44;
/// Half the distance of the back posts and of the front legs at the seat.
const POST_X: f64 = 0.178;
const LEG_X: f64 = 0.192;
/// Distance of the front legs from the middle.
const LEG_Z: f64 = 0.18;

/// The chair; it faces z.
pub(crate) fn chair() -> Model {
    let mut parts = vec![seat(), cushion(), piping()];
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        parts.push(front_leg(&format!("leg_front_{name}"), side));
        parts.push(post(&format!("leg_back_{name}"), side));
    }
    parts.extend(slats());
    parts.extend(rails());
    parts.extend(stretchers());
    Model {
        name: "chair",
        paint: None,
        materials: vec![
            Material::plain("wood", [0.33, 0.16, 0.08]),
            Material {
                roughness: 0.6,
                ..Material::plain("leather", [0.12, 0.19, 0.13])
            },
        ],
        parts,
    }
}

/// Returns a point (z, y) on the axis of a back post, in meters; 0 is the floor, 1 its upper end.
fn post_at(share: f64) -> DVec2 {
    // A parabola by three points (z, y): it stands back at the floor and leans back above the seat.
    let (foot, bend, top) = (dvec2(-0.235, 0.0), dvec2(-0.13, 0.46), dvec2(-0.275, 0.92));
    let rest = 1.0 - share;
    foot * rest * rest + bend * 2.0 * share * rest + top * share * share
}

/// The share of a post's way at which it reaches a height.
fn post_share(y: f64) -> f64 {
    y / 0.92
}

/// A back leg that continues as a post of the back.
fn post(name: &str, side: f64) -> ModelPart {
    let pieces = 14;
    let station = |i: usize| {
        let share = f64::from(i as u32) / f64::from(pieces as u32);
        let (before, after) = (post_at((share - 0.01).max(0.0)), post_at((share + 0.01).min(1.0)));
        let along = (after - before).normalize_or_zero();
        // It narrows toward both ends, and its foot is cut level.
        let scale = 1.0 - 0.28 * (2.0 * share - 0.95).powi(2);
        let up = if i == 0 {
            DVec3::NEG_Z
        } else {
            dvec3(0.0, along.y, along.x).cross(DVec3::X)
        };
        let at = post_at(share);
        Station {
            center: dvec3(0.0, at.y, at.x),
            side: DVec3::X * scale,
            up: up * scale,
        }
    };
    let path: Vec<Station> = (0..=pieces).map(station).collect();
    let ends = SweepEnds {
        radius: 0.004,
        segments: 2,
    };
    let shape = sweep(&rectangle(0.034, 0.036, 0.008, 2, 3), &unit_ends(path), ends);
    part(name, WOOD, DVec3::X * POST_X * side, DQuat::IDENTITY, shape)
}

/// Sections may be scaled anywhere but at the ends, whose depth is counted along `side × up`.
fn unit_ends(mut path: Vec<Station>) -> Vec<Station> {
    let last = path.len() - 1;
    for station in [0, last] {
        let station = &mut path[station];
        let scale = station.side.length();
        (station.side, station.up) = (station.side / scale, station.up / scale);
    }
    path
}

/// A tapered leg, splayed a little to the front and to its side.
fn front_leg(name: &str, side: f64) -> ModelPart {
    let foot = dvec3((LEG_X + 0.012) * side, 0.0, LEG_Z + 0.016);
    let hip = dvec3(LEG_X * side, SEAT - 0.022, LEG_Z);
    let up = (hip - foot).normalize_or_zero();
    let across = (DVec3::X - up * up.x).normalize_or_zero();
    let turn = DQuat::from_mat3(&DMat3::from_cols(up, across, up.cross(across)));
    let level = turn.inverse() * DVec3::Y;
    let along = Bar {
        taper: [0.66, 1.0],
        cuts: [-level, level],
        spans: 4,
        ..Bar::of(hip.distance(foot))
    };
    let shape = timber(0.042, 0.042, 0.007, &along);
    part(name, WOOD, (foot + hip) / 2.0, turn, shape)
}

/// The seat's plan, wider in front, some of it cut off all around; x to the right, −z up.
fn seat_plan(inset: f64) -> super::outline::Outline {
    let turn = |x: f64, y: f64, radius: f64| OutlineCorner {
        at: dvec2(x, y),
        radius: radius - inset * 0.4,
        seam: false,
    };
    let (front, back, near, far) = (0.222 - inset, 0.2 - inset, -0.215 + inset, 0.205 - inset);
    let mut outline = rounded(
        &[
            turn(-front, near, 0.05),
            turn(0.0, near - 0.012, 0.5),
            turn(front, near, 0.05),
            turn(back, far, 0.035),
            turn(0.0, far + 0.004, 0.0),
            turn(-back, far, 0.035),
        ],
        6,
        true,
    );
    // The border of its chart goes to the middle of the back.
    let hindmost = |i: &usize| outline.points[*i].y - outline.points[*i].x.abs();
    let seam = (0..outline.points.len()).max_by(|one, other| hindmost(one).total_cmp(&hindmost(other)));
    outline.seams = vec![seam.unwrap_or(0)];
    outline
}

fn seat() -> ModelPart {
    let station = |y: f64| Station {
        center: DVec3::Y * y,
        side: DVec3::X,
        up: DVec3::NEG_Z,
    };
    let ends = SweepEnds {
        radius: 0.008,
        segments: 3,
    };
    let shape = sweep(&seat_plan(0.0), &[station(SEAT - 0.03), station(SEAT)], ends);
    part("seat", WOOD, DVec3::ZERO, DQuat::IDENTITY, shape)
}

/// A pillow: a ball flattened, squared and sunk where one sits.
fn cushion() -> ModelPart {
    let mut skin = Skin::new(14);
    for point in &mut skin.points {
        let round = (point.x.powi(4) + point.z.powi(4)).sqrt() + point.y.powi(2);
        let full = *point / round.sqrt();
        let wide = 0.182 + 0.012 * full.z;
        *point = dvec3(full.x * wide, full.y * 0.028, full.z * 0.18);
        let sat = dvec2(full.x, full.z + 0.15).length_squared();
        point.y -= 0.008 * (-3.0 * sat).exp() * (full.y + 1.0).clamp(0.0, 1.0);
    }
    let shape = skin.shape(120);
    ModelPart {
        smooth_below: 180.0,
        ..part("cushion", LEATHER, DVec3::Y * (SEAT + 0.022), DQuat::IDENTITY, shape)
    }
}

/// The cord sewn around the cushion.
fn piping() -> ModelPart {
    let count = 56;
    let at = |i: usize| {
        let around = DVec2::from_angle(-std::f64::consts::TAU * i as f64 / f64::from(count as u32));
        let full = around / (around.x.powi(4) + around.y.powi(4)).powf(0.25);
        let wide = 0.182 - 0.012 * full.y;
        dvec3(full.x * wide, 0.0, -full.y * 0.18)
    };
    let station = |i: usize| {
        let along = (at(i + 1) - at(i + count - 1)).normalize_or_zero();
        Station {
            center: at(i),
            side: DVec3::Y.cross(along),
            up: DVec3::Y,
        }
    };
    let path: Vec<Station> = (0..count).map(station).collect();
    let shape = hoop(&circle(0.0052, 8), &path, 4);
    ModelPart {
        smooth_below: 180.0,
        ..part("piping", LEATHER, DVec3::Y * (SEAT + 0.022), DQuat::IDENTITY, shape)
    }
}

/// Three slats and a top rail between the posts, bent to the back.
fn slats() -> Vec<ModelPart> {
    let bent = |name: &str, y: f64, height: f64, thick: f64| {
        let share = post_share(y);
        let at = post_at(share);
        let along = (post_at(share + 0.01) - post_at(share - 0.01)).normalize_or_zero();
        let pieces = 8;
        let station = |i: usize| {
            let across = 2.0 * i as f64 / f64::from(pieces as u32) - 1.0;
            let depth = 0.026;
            let way = dvec3(POST_X, 0.0, 2.0 * depth * across).normalize_or_zero();
            Station {
                center: dvec3(POST_X * across, 0.0, -depth * (1.0 - across * across)),
                side: DVec3::Y.cross(way),
                up: DVec3::Y,
            }
        };
        let path: Vec<Station> = (0..=pieces).map(station).collect();
        let ends = SweepEnds {
            radius: 0.002,
            segments: 1,
        };
        let shape = sweep(&rectangle(thick, height, 0.005, 1, 3), &path, ends);
        let lean = DQuat::from_rotation_x(along.x.atan2(along.y));
        part(name, WOOD, dvec3(0.0, at.y, at.x), lean, shape)
    };
    vec![
        bent("slat_0", 0.56, 0.042, 0.014),
        bent("slat_1", 0.665, 0.046, 0.014),
        bent("slat_2", 0.77, 0.05, 0.014),
        bent("top_rail", 0.877, 0.074, 0.017),
    ]
}

/// Four boards below the seat.
fn rails() -> Vec<ModelPart> {
    let back_z = post_at(post_share(SEAT - 0.05)).x;
    let rail = |name: &str, from: DVec3, to: DVec3| {
        let y = SEAT - 0.052;
        let shape = timber(0.02, 0.05, 0.004, &Bar::of(from.distance(to)));
        let turn = lying_along((to - from).normalize_or_zero());
        part(
            format!("rail_{name}"),
            WOOD,
            (from + to) / 2.0 + DVec3::Y * y,
            turn,
            shape,
        )
    };
    let (front, back) = (dvec3(LEG_X, 0.0, LEG_Z), dvec3(POST_X, 0.0, back_z));
    let mirror = dvec3(-1.0, 1.0, 1.0);
    vec![
        rail("front", front * mirror, front),
        rail("back", back * mirror, back),
        rail("left", back * mirror, front * mirror),
        rail("right", back, front),
    ]
}

/// Turned rods between the legs, thicker in their middle.
fn stretchers() -> Vec<ModelPart> {
    let rod = |name: &str, from: DVec3, to: DVec3| {
        let pieces = 8;
        let length = from.distance(to);
        let station = |i: usize| {
            let across = 2.0 * i as f64 / f64::from(pieces as u32) - 1.0;
            let scale = if i == 0 || i == pieces {
                1.0
            } else {
                1.45 - 0.45 * across * across
            };
            Station {
                center: DVec3::X * across * length / 2.0,
                side: DVec3::NEG_Z * scale,
                up: DVec3::Y * scale,
            }
        };
        let path: Vec<Station> = (0..=pieces).map(station).collect();
        let ends = SweepEnds {
            radius: 0.002,
            segments: 1,
        };
        let shape = sweep(&circle(0.0085, 12), &path, ends);
        let turn = lying_along((to - from).normalize_or_zero());
        part(format!("stretcher_{name}"), WOOD, (from + to) / 2.0, turn, shape)
    };
    let back = |y: f64, side: f64| dvec3(POST_X * side, y, post_at(post_share(y)).x);
    let front = |y: f64, side: f64| {
        dvec3(
            (LEG_X + 0.012 * (1.0 - y / SEAT)) * side,
            y,
            LEG_Z + 0.016 * (1.0 - y / SEAT),
        )
    };
    vec![
        rod("left", back(0.15, -1.0), front(0.15, -1.0)),
        rod("right", back(0.15, 1.0), front(0.15, 1.0)),
        rod("front", front(0.24, -1.0), front(0.24, 1.0)),
        rod("back", back(0.2, -1.0), back(0.2, 1.0)),
    ]
}
