//! Points on flat, turned and curved surfaces.

use std::path::Path;

use glam::{DVec3, Vec3};

use super::{SurfacePoint, SurfacePoints};
use crate::atlas::{Atlas, AtlasOptions, EMPTY};
use crate::load::{LoadOptions, load};
use crate::model::Mesh;

/// A ball of radius 0.5, its six charts turned and of different sizes.
fn ball() -> (Mesh, Atlas) {
    let mut mesh = Mesh {
        uv_set: Some(0),
        ..Mesh::default()
    };
    let cells = 24_u32;
    for face in 0..6_u32 {
        let first = mesh.positions.len() as u32;
        let axis = (face / 2) as usize;
        let sign = if face % 2 == 0 { 1.0 } else { -1.0 };
        let (sine, cosine) = (0.7 * face as f32).sin_cos();
        let scale = 0.2 - 0.015 * face as f32;
        for y in 0..=cells {
            for x in 0..=cells {
                let [s, t] = [x, y].map(|at| at as f32 / cells as f32 * 2.0 - 1.0);
                let mut place = [0.0; 3];
                place[axis] = sign;
                place[(axis + 1) % 3] = s * sign;
                place[(axis + 2) % 3] = t;
                let out = Vec3::from(place).normalize();
                // Rounded, so that the corners of neighboring faces are at exactly the same place.
                mesh.positions
                    .push((out * 32768.0).round().to_array().map(|x| x / 65536.0));
                mesh.normals.push(out.to_array());
                mesh.tangents.push([1.0, 0.0, 0.0, 1.0]);
                let center = [0.17 + 0.33 * (face % 3) as f32, 0.25 + 0.5 * (face / 3) as f32];
                let half = 0.5 * scale;
                mesh.uvs.push([
                    center[0] + half * (cosine * s - sine * t),
                    center[1] + half * (sine * s + cosine * t),
                ]);
            }
        }
        for y in 0..cells {
            for x in 0..cells {
                let at = first + y * (cells + 1) + x;
                for corners in [[at, at + 1, at + cells + 2], [at, at + cells + 2, at + cells + 1]] {
                    mesh.triangles.push(corners);
                    mesh.triangle_material.push(0);
                    mesh.triangle_part.push(0);
                }
            }
        }
    }
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap();
    (mesh, atlas)
}

#[test]
fn every_texel_is_in_a_cell_and_every_cell_has_texels() {
    let (mesh, atlas) = ball();
    let points = SurfacePoints::spread(&mesh, &atlas, 0.05);
    let owned = atlas
        .owners
        .iter()
        .filter(|owner| **owner & crate::atlas::GHOST_BIT == 0)
        .count();
    assert_eq!(
        points.point_of_texel.iter().filter(|point| **point != EMPTY).count(),
        owned
    );
    for point in 0..points.points.len() {
        let share: f32 = points.cells.of(point).iter().map(|texel| texel.share).sum();
        assert!((share - 1.0).abs() < 1e-4, "shares of cell {point} sum to {share}");
    }
}

#[test]
fn points_keep_their_minimum_distance_and_leave_no_gap() {
    let (mesh, atlas) = ball();
    let spacing = 0.05;
    let points = SurfacePoints::spread(&mesh, &atlas, spacing);
    let area = std::f64::consts::PI;
    let packed = area / (spacing * spacing);
    let count = points.points.len() as f64;
    assert!(
        count > 0.55 * packed && count < 0.75 * packed,
        "{count} points, {packed} squares of a spacing"
    );
    let places: Vec<DVec3> = points
        .points
        .iter()
        .map(|point| Vec3::from(point.position).as_dvec3())
        .collect();
    let nearest = |at: usize| {
        let others = places.iter().enumerate().filter(|(other, _)| *other != at);
        others
            .map(|(_, other)| other.distance(places[at]))
            .fold(f64::INFINITY, f64::min)
    };
    let nearest: Vec<f64> = (0..places.len()).map(nearest).collect();
    let [least, most] = [f64::min, f64::max].map(|pick| nearest.iter().copied().reduce(pick).unwrap());
    assert!(least > 0.6 * spacing && most < 2.0 * spacing, "{least} to {most}");
}

/// Returns the rate at which a heat pattern decays: the flow to each point times its value, over the whole area.
fn decay(points: &SurfacePoints, value: impl Fn(DVec3) -> f64) -> f64 {
    let place = |point: &SurfacePoint| Vec3::from(point.position).as_dvec3();
    let values: Vec<f64> = points.points.iter().map(|point| value(place(point))).collect();
    let (mut product, mut square) = (0.0, 0.0);
    for (point, own) in values.iter().enumerate() {
        let flows = points.flows.of(point).iter();
        let flow: f64 = flows
            .map(|flow| f64::from(flow.rate) * (values[flow.to as usize] - own))
            .sum();
        product += points.points[point].area * flow * own;
        square += points.points[point].area * own * own;
    }
    -product / square / (points.spacing * points.spacing)
}

#[test]
fn patterns_on_a_ball_decay_as_spherical_harmonics_do() {
    let (mesh, atlas) = ball();
    let points = SurfacePoints::spread(&mesh, &atlas, 0.05);
    // On a ball of radius r, a harmonic of degree l decays at l (l + 1) / r².
    let degree_1 = decay(&points, |place| place.z);
    let degree_2 = decay(&points, |place| place.x * place.y);
    assert!((degree_1 / 8.0 - 1.0).abs() < 0.01, "degree 1 decays at {degree_1}");
    assert!((degree_2 / 24.0 - 1.0).abs() < 0.02, "degree 2 decays at {degree_2}");
}

#[test]
fn the_gain_of_one_point_is_the_loss_of_another() {
    let (mesh, atlas) = ball();
    let points = SurfacePoints::spread(&mesh, &atlas, 0.05);
    let mut limited = 0;
    for point in 0..points.points.len() {
        let total: f32 = points.flows.of(point).iter().map(|flow| flow.rate).sum();
        assert!(total <= 4.001, "{total} flows to point {point}");
        limited += usize::from(total > 3.999);
        for flow in points.flows.of(point) {
            let back = points.flows.of(flow.to as usize);
            assert!(
                back.iter().any(|other| other.to as usize == point),
                "{point} and {}",
                flow.to
            );
        }
    }
    assert!(limited * 100 < points.points.len(), "{limited} points are slowed down");
}

#[test]
fn the_sides_of_a_thin_wall_stay_apart() {
    // Two squares, back to back, not connected.
    let mut mesh = Mesh {
        uv_set: Some(0),
        ..Mesh::default()
    };
    for (side, z) in [(0.0, 0.0), (0.5, 0.01)] {
        let first = mesh.positions.len() as u32;
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            mesh.positions.push([x, y, z]);
            mesh.normals.push([0.0, 0.0, if z > 0.0 { 1.0 } else { -1.0 }]);
            mesh.tangents.push([1.0, 0.0, 0.0, 1.0]);
            mesh.uvs.push([0.05 + side + 0.4 * x, 0.05 + 0.4 * y]);
        }
        for corners in [[0, 1, 2], [0, 2, 3]] {
            mesh.triangles.push(corners.map(|corner: u32| corner + first));
            mesh.triangle_material.push(0);
            mesh.triangle_part.push(0);
        }
    }
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(128)).unwrap();
    let points = SurfacePoints::spread(&mesh, &atlas, 0.1);
    let side = |point: usize| points.points[point].position[2] > 0.005;
    for point in 0..points.points.len() {
        for other in points.around.of(point) {
            assert_eq!(side(point), side(*other as usize), "{point} and {other}");
        }
    }
}

#[test]
fn points_across_a_seam_are_neighbors() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/sphere.glb");
    let mesh = load(&path, &LoadOptions::default()).unwrap().mesh;
    // On some of these maps, chart borders are in the middle of texels, so that links end between ghosts.
    for size in [128, 200, 256] {
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap();
        let spacing = 8.0 / f64::from(size);
        let points = SurfacePoints::spread(&mesh, &atlas, spacing);
        let places: Vec<Vec3> = points.points.iter().map(|point| Vec3::from(point.position)).collect();
        for (point, place) in places.iter().enumerate() {
            let around = points.around.of(point);
            let near = |other: &Vec3| f64::from(other.distance(*place)) < 1.3 * spacing;
            for (other, _) in places.iter().enumerate().filter(|(_, other)| near(other)) {
                assert!(
                    around.contains(&(other as u32)),
                    "{point} and {other} at {place}, {size} texels"
                );
            }
        }
    }
}

#[test]
fn every_texel_of_a_rough_map_is_in_a_cell() {
    // Charts of a few texels, where some links between ghosts lead in only one direction.
    for (name, size) in [
        ("bench", 32),
        ("bench", 64),
        ("figure", 32),
        ("barrel", 24),
        ("sphere", 17),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/meshes/{name}.glb"));
        let mesh = load(&path, &LoadOptions::default()).unwrap().mesh;
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap();
        for share in [4.0, 12.0, 40.0] {
            let points = SurfacePoints::spread(&mesh, &atlas, mesh.area().sqrt() / share);
            let is_owned = |owner: &u32| *owner & crate::atlas::GHOST_BIT == 0;
            let texels = atlas.owners.iter().zip(&points.point_of_texel);
            assert!(
                texels
                    .clone()
                    .all(|(owner, point)| is_owned(owner) == (*point != EMPTY)),
                "{name} at {size}"
            );
        }
    }
}
