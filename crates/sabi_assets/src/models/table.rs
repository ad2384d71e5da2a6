//! A workshop table: five planks on splayed legs, with rails, braces and iron angles. 0.75 m high.

use glam::{DQuat, DVec2, DVec3, dvec2, dvec3};

use super::bar::{Bar, timber};
use super::charted_mesh::{ChartedMesh, ModelPart, part};
use super::fixings::{chance, head, lying_along, standing_on};
use super::glb::{Material, Model};
use super::outline::{OutlineCorner, rectangle, rounded};
use super::sweep::{Station, SweepEnds, sweep};

const WOOD: usize = 0;
const IRON: usize = 1;

/// Ends of a leg's axis, at the floor and at the underside of the top, for x and z to the right and to the front.
const FOOT: DVec3 = dvec3(0.615, 0.0, 0.315);
const HIP: DVec3 = dvec3(0.545, 0.712, 0.262);
/// Thickness of the top.
const TOP: f64 = 0.038;
/// Middle height of the rails below the top.
const RAIL_Y: f64 = 0.655;

/// The table.
pub(crate) fn table() -> Model {
    let mut parts = top();
    for (name, x, z) in [
        ("front_left", -1.0, 1.0),
        ("front_right", 1.0, 1.0),
        ("back_left", -1.0, -1.0),
        ("back_right", 1.0, -1.0),
    ] {
        let side = dvec3(x, 1.0, z);
        parts.push(leg(&format!("leg_{name}"), side));
        parts.extend(angle_iron(name, side));
    }
    parts.extend(rails());
    parts.extend(braces());
    Model {
        name: "table",
        paint: None,
        materials: vec![Material::plain("wood", [0.42, 0.28, 0.17]), Material::iron()],
        parts,
    }
}

/// Five planks along x and two battens below them across; the outermost plank has warped and lies a little askew.
fn top() -> Vec<ModelPart> {
    let mut parts = Vec::new();
    let width = 0.152;
    for (row, length) in [1.4, 1.392, 1.4, 1.386, 1.397].into_iter().enumerate() {
        let z = (row as f64 - 2.0) * (width + 0.004);
        let along = Bar {
            bow: if row == 4 { -0.004 } else { 0.0 },
            spans: 6,
            ..Bar::of(length)
        };
        let askew = DQuat::from_rotation_y((0.25 * chance(row as u32 + 7)).to_radians());
        let askew = if row == 4 {
            DQuat::from_rotation_y(-0.7f64.to_radians()) * DQuat::from_rotation_x(1.2f64.to_radians())
        } else {
            askew
        };
        let lift = if row == 4 { 0.003 } else { 0.0 };
        let at = dvec3(0.006 * chance(row as u32), 0.75 - TOP / 2.0 + lift, z + lift);
        parts.push(part(
            format!("plank_{row}"),
            WOOD,
            at,
            askew,
            timber(width, TOP, 0.005, &along),
        ));
    }
    for (name, x) in [("left", -0.4), ("right", 0.4)] {
        let shape = timber(0.07, 0.03, 0.005, &Bar::of(0.72));
        let turn = lying_along(DVec3::Z);
        let at = dvec3(x, 0.75 - TOP - 0.0135, 0.0);
        parts.push(part(format!("batten_{name}"), WOOD, at, turn, shape));
    }
    parts
}

/// A leg that narrows toward its foot and stands flat on the floor.
fn leg(name: &str, side: DVec3) -> ModelPart {
    let (foot, hip) = (FOOT * side, HIP * side);
    let up = (hip - foot).normalize_or_zero();
    // Its faces stay square to the table's as far as the splay lets them.
    let across = (DVec3::X - up * up.x).normalize_or_zero();
    let turn = DQuat::from_mat3(&glam::DMat3::from_cols(up, across, up.cross(across)));
    let level = turn.inverse() * DVec3::Y;
    let along = Bar {
        taper: [0.68, 1.0],
        cuts: [-level, level],
        spans: 5,
        ..Bar::of(hip.distance(foot))
    };
    let shape = timber(0.076, 0.076, 0.007, &along);
    part(name, WOOD, (foot + hip) / 2.0, turn, shape)
}

/// Returns the point of the axis of the right front leg at a height.
fn axis_at(y: f64) -> DVec3 {
    FOOT.lerp(HIP, (y - FOOT.y) / (HIP.y - FOOT.y))
}

/// Four rails from leg to leg below the top.
fn rails() -> Vec<ModelPart> {
    let corner = axis_at(RAIL_Y);
    let rail = |name: &str, direction: DVec3, length: f64, out: DVec3| {
        let shape = timber(
            0.026,
            0.1,
            0.004,
            &Bar {
                spans: 2,
                ..Bar::of(length)
            },
        );
        part(
            format!("rail_{name}"),
            WOOD,
            out + DVec3::Y * RAIL_Y,
            lying_along(direction),
            shape,
        )
    };
    let (long, short) = (2.0 * corner.x - 0.04, 2.0 * corner.z - 0.04);
    vec![
        rail("front", DVec3::X, long, DVec3::Z * (corner.z + 0.008)),
        rail("back", DVec3::X, long, DVec3::Z * (-corner.z - 0.008)),
        rail("left", DVec3::Z, short, DVec3::X * (-corner.x - 0.008)),
        rail("right", DVec3::Z, short, DVec3::X * (corner.x + 0.008)),
    ]
}

/// A stretcher between each pair of legs, a beam between the stretchers, and two braces from the beam up to the top.
fn braces() -> Vec<ModelPart> {
    let low = axis_at(0.2);
    let along = |from: DVec3, to: DVec3, name: &str, width: f64, height: f64, bar: &dyn Fn(f64) -> Bar| {
        let shape = timber(width, height, 0.005, &bar(from.distance(to)));
        let turn = lying_along((to - from).normalize_or_zero());
        part(name, WOOD, (from + to) / 2.0, turn, shape)
    };
    let plain = |length: f64| Bar {
        spans: 3,
        ..Bar::of(length)
    };
    let mut parts = Vec::new();
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let end = dvec3(low.x * side, low.y, low.z);
        parts.push(along(
            end * dvec3(1.0, 1.0, -1.0),
            end,
            &format!("stretcher_{name}"),
            0.036,
            0.06,
            &plain,
        ));
        let (from, to) = (dvec3(0.22 * side, 0.21, 0.0), dvec3(0.405 * side, 0.7, 0.0));
        let direction = (to - from).normalize_or_zero();
        let level = lying_along(direction).inverse() * DVec3::Y;
        let slanted = move |length: f64| Bar {
            cuts: [-level, level],
            ..Bar::of(length)
        };
        parts.push(along(from, to, &format!("brace_{name}"), 0.04, 0.045, &slanted));
    }
    let reach = dvec3(low.x + 0.055, 0.0, 0.0);
    let height = DVec3::Y * 0.2;
    parts.push(along(height - reach, height + reach, "beam", 0.03, 0.05, &plain));
    parts
}

/// A bent strip of iron around a corner of the rails, and its bolts.
fn angle_iron(name: &str, side: DVec3) -> Vec<ModelPart> {
    let corner = axis_at(RAIL_Y);
    let (x, z) = (corner.x + 0.042, corner.z + 0.042);
    let (reach, thick) = (0.13, 0.005);
    let turn = |x: f64, z: f64, radius: f64| OutlineCorner {
        at: dvec2(x, z),
        radius,
        seam: false,
    };
    // Seen from above with z down the page; the left and back ones are the mirrored way, walked backward.
    let line = [
        turn(x - reach, z, 0.0),
        turn(x - 0.06, z, 0.0),
        turn(x, z, 0.012),
        turn(x, z - 0.06, 0.0),
        turn(x, z - reach, 0.0),
    ];
    let mirrored: Vec<OutlineCorner> = line
        .iter()
        .map(|turn| OutlineCorner {
            at: turn.at * dvec2(side.x, side.z),
            ..*turn
        })
        .collect();
    let points = rounded(&mirrored, 4, false).points;
    let station = |i: usize| {
        let arrive = (points[i] - points[i.saturating_sub(1)]).normalize_or_zero();
        let leave = (points[(i + 1).min(points.len() - 1)] - points[i]).normalize_or_zero();
        let along = in_plan((arrive + leave).normalize_or_zero(), 0.0);
        Station {
            center: in_plan(points[i], RAIL_Y + 0.002),
            side: DVec3::Y,
            up: along.cross(DVec3::Y),
        }
    };
    let path: Vec<Station> = (0..points.len()).map(station).collect();
    let ends = SweepEnds {
        radius: 0.0012,
        segments: 1,
    };
    let strip = sweep(&rectangle(0.056, thick, 0.0015, 2, 2), &path, ends);
    let mut parts = vec![part(format!("angle_{name}"), IRON, DVec3::ZERO, DQuat::IDENTITY, strip)];
    let mut bolts = ChartedMesh::default();
    for from_corner in [0.062, 0.112] {
        for (at, normal) in [
            (dvec3(x - from_corner, RAIL_Y + 0.002, z), DVec3::Z),
            (dvec3(x, RAIL_Y + 0.002, z - from_corner), DVec3::X),
        ] {
            let out = normal * dvec3(side.x, 1.0, side.z);
            bolts.append(
                head(0.011, 0.006, 10),
                standing_on(out),
                at * dvec3(side.x, 1.0, side.z) + out * thick / 2.0,
            );
        }
    }
    parts.push(part(format!("bolts_{name}"), IRON, DVec3::ZERO, DQuat::IDENTITY, bolts));
    parts
}

/// From the plan (x, z) into space.
fn in_plan(plan: DVec2, y: f64) -> DVec3 {
    dvec3(plan.x, y, plan.y)
}
