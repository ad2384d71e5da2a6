//! A chain that hangs between two rings: eleven forged links, each through its neighbors. About 0.9 m wide.

use glam::{DMat3, DQuat, DVec3, dvec3};

use super::charted_mesh::{self, ChartedMesh, ModelPart};
use super::glb::{Material, Model};
use super::hoop::{circle_path, hoop, link_path};
use super::outline::circle;

const LINKS: usize = 11;
/// Radius of the wire, and of a link's bends along the middle of the wire.
const WIRE: f64 = 0.0115;
const BEND: f64 = 0.0285;
const HALF_STRAIGHT: f64 = 0.031;
/// Of the end rings, along the middle of the wire.
const RING: f64 = 0.055;
/// From one point of contact to the next; a hair short, so that no link cuts its neighbor where the chain bends.
const PITCH: f64 = 2.0 * (HALF_STRAIGHT + BEND - WIRE) - 0.0006;

/// The chain.
pub(crate) fn chain() -> Model {
    let joints = joints();
    let mut parts = Vec::new();
    let link = hoop(&circle_of(WIRE, 12), &link_path(HALF_STRAIGHT, BEND, 9, 0.16), 1);
    for (number, ends) in joints.windows(2).enumerate() {
        let along = (ends[1] - ends[0]).normalize_or_zero();
        // Each link is turned by a quarter against the one before it, and none hangs quite straight.
        let lean = if number % 2 == 0 { 40.0 } else { -50.0 } + 7.0 * super::fixings::chance(number as u32);
        parts.push(part(
            format!("link_{number}"),
            (ends[0] + ends[1]) / 2.0,
            frame(along) * DQuat::from_rotation_x(f64::to_radians(lean)),
            link.clone(),
        ));
    }
    let ring = hoop(
        &circle_of(WIRE * 1.15, 12),
        &circle_path(RING, 0.0, glam::DVec2::Y, 32),
        1,
    );
    for (name, joint, out, lean) in [
        ("ring_left", joints[0], -1.0, -50.0),
        ("ring_right", joints[LINKS], 1.0, -38.0),
    ] {
        let hang = dvec3(out * 0.45, 1.0, 0.0).normalize_or_zero();
        let turn = frame(hang) * DQuat::from_rotation_x(f64::to_radians(lean + 90.0));
        parts.push(part(
            name.into(),
            joint + hang * (RING - 1.25 * WIRE),
            turn,
            ring.clone(),
        ));
    }
    let lowest = parts.iter().flat_map(|part| {
        let corners = part.shape.triangles.iter().flat_map(|triangle| triangle.corners);
        corners.map(|corner| (part.translation + part.rotation * corner.position).y)
    });
    let ground = lowest.fold(f64::INFINITY, f64::min);
    parts.iter_mut().for_each(|part| part.translation.y -= ground);
    Model {
        name: "chain",
        paint: None,
        materials: vec![Material::iron()],
        parts,
    }
}

fn part(name: String, translation: DVec3, rotation: DQuat, shape: ChartedMesh) -> ModelPart {
    ModelPart {
        smooth_below: 180.0,
        ..charted_mesh::part(name, 0, translation, rotation, shape)
    }
}

/// A wire with its chart borders where the inner half meets the outer one.
fn circle_of(radius: f64, points: usize) -> super::outline::Outline {
    let mut outline = circle(radius, points);
    outline.seams = vec![0, points / 2];
    outline
}

/// The turn that takes x to a direction of the plane of x and y, and z to z.
fn frame(along: DVec3) -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(along, DVec3::Z.cross(along), DVec3::Z))
}

/// Points of contact on a catenary y = a cosh(x / a): equal steps along it are equal steps of sinh(x / a).
fn joints() -> Vec<DVec3> {
    let a = 0.34;
    let on_curve = |s: f64| dvec3(a * (s / a).asinh(), (a * a + s * s).sqrt(), 0.0);
    let mut joints: Vec<DVec3> = Vec::new();
    for i in 0..=LINKS {
        let point = on_curve((i as f64 - LINKS as f64 / 2.0) * PITCH);
        let place = match joints.last() {
            // The chord is a little shorter than the arc; the links are not.
            Some(last) => {
                let before = on_curve((i as f64 - 1.0 - LINKS as f64 / 2.0) * PITCH);
                *last + (point - before).normalize_or_zero() * PITCH
            }
            None => point,
        };
        joints.push(place);
    }
    let middle = (joints[0].x + joints[LINKS].x) / 2.0;
    joints.iter_mut().for_each(|joint| joint.x -= middle);
    joints
}
