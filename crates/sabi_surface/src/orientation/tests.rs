use glam::Vec3;

use super::turned_faces;
use crate::model::Mesh;

const NOTHING: [u32; 0] = [];

/// Creates a closed unit sphere with outward faces.
fn ball(center: Vec3, radius: f32, part: u32) -> Mesh {
    let (rings, slices) = (8, 12);
    let mut positions = vec![Vec3::Y, Vec3::NEG_Y];
    for ring in 1..rings {
        let polar = std::f32::consts::PI * ring as f32 / rings as f32;
        for slice in 0..slices {
            let around = std::f32::consts::TAU * slice as f32 / slices as f32;
            positions.push(Vec3::new(
                polar.sin() * around.sin(),
                polar.cos(),
                polar.sin() * around.cos(),
            ));
        }
    }
    let at = |ring: u32, slice: u32| 2 + (ring - 1) * slices + slice % slices;
    let mut triangles = Vec::new();
    for slice in 0..slices {
        triangles.push([0, at(1, slice), at(1, slice + 1)]);
        triangles.push([1, at(rings - 1, slice + 1), at(rings - 1, slice)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, slice), at(ring, slice + 1)];
            let [c, d] = [at(ring + 1, slice), at(ring + 1, slice + 1)];
            triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    let count = triangles.len();
    Mesh {
        positions: positions.iter().map(|at| (center + *at * radius).to_array()).collect(),
        triangles,
        triangle_part: vec![part; count],
        triangle_material: vec![0; count],
        ..Mesh::default()
    }
}

/// Creates a sheet with `side` squares along each side, all facing +Z.
fn sheet(side: u32) -> Mesh {
    let positions = (0..=side).flat_map(|y| (0..=side).map(move |x| [x as f32, y as f32, 0.0]));
    let at = |x: u32, y: u32| y * (side + 1) + x;
    let squares = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    let triangles: Vec<[u32; 3]> = squares
        .flat_map(|(x, y)| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let count = triangles.len();
    Mesh {
        positions: positions.collect(),
        triangles,
        triangle_part: vec![0; count],
        triangle_material: vec![0; count],
        ..Mesh::default()
    }
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        let triangles = mesh.triangles.iter();
        all.triangles
            .extend(triangles.map(|corners| corners.map(|corner| corner + first)));
        all.triangle_part.extend(&mesh.triangle_part);
        all.triangle_material.extend(&mesh.triangle_material);
    }
    all
}

fn with_turned(mut mesh: Mesh, turned: impl Fn(u32) -> bool) -> Mesh {
    for (number, corners) in mesh.triangles.iter_mut().enumerate() {
        if turned(number as u32) {
            corners.swap(1, 2);
        }
    }
    mesh
}

/// Numbers for which `is_it` holds.
fn of(count: usize, is_it: impl Fn(u32) -> bool) -> Vec<u32> {
    (0..count as u32).filter(|number| is_it(*number)).collect()
}

#[test]
fn faces_of_a_closed_body_that_face_inward_are_found() {
    let body = ball(Vec3::new(5.0, 0.0, 0.0), 1.0, 0);
    let count = body.triangles.len();
    let cases: [(&str, &dyn Fn(u32) -> bool); 5] = [
        ("none", &|_| false),
        ("one", &|face| face == 17),
        ("some", &|face| face % 7 == 3),
        ("most", &|face| face % 7 != 3),
        ("all", &|_| true),
    ];
    for (name, is_turned) in cases {
        let found = turned_faces(&with_turned(body.clone(), is_turned));
        assert_eq!(found, of(count, is_turned), "{name}");
    }
}

#[test]
fn an_open_sheet_is_never_inside_out_but_single_faces_may_be() {
    let plane = sheet(6);
    let count = plane.triangles.len();
    assert_eq!(turned_faces(&plane), NOTHING);
    assert_eq!(
        turned_faces(&with_turned(plane.clone(), |_| true)),
        NOTHING,
        "nothing says which side is meant"
    );
    let few = |face: u32| face.is_multiple_of(5);
    assert_eq!(turned_faces(&with_turned(plane.clone(), few)), of(count, few));
    let most = |face: u32| !face.is_multiple_of(5);
    assert_eq!(
        turned_faces(&with_turned(plane.clone(), most)),
        of(count, few),
        "most of it tells"
    );
    let half = |face: u32| face.is_multiple_of(2);
    assert_eq!(
        turned_faces(&with_turned(plane, half)),
        NOTHING,
        "either half may be meant"
    );
}

#[test]
fn a_cavity_correctly_faces_inward() {
    let outer = ball(Vec3::ZERO, 2.0, 0);
    let count = outer.triangles.len();
    for part in [0, 1] {
        let inner = with_turned(ball(Vec3::new(0.2, 0.1, 0.0), 1.0, part), |_| true);
        assert_eq!(
            turned_faces(&joined(&[outer.clone(), inner.clone()])),
            NOTHING,
            "a hollow ball"
        );
        let solid = ball(Vec3::ZERO, 1.0, part);
        assert_eq!(
            turned_faces(&joined(&[outer.clone(), solid])),
            NOTHING,
            "a ball in a ball"
        );
        let beside = with_turned(ball(Vec3::new(9.0, 0.0, 0.0), 1.0, part), |_| true);
        let all = of(2 * count, |face| face as usize >= count);
        assert_eq!(turned_faces(&joined(&[outer.clone(), beside])), all, "a ball beside it");
        let few = with_turned(inner, |face| face == 3);
        assert_eq!(turned_faces(&joined(&[outer.clone(), few])), [count as u32 + 3]);
    }
}

#[test]
fn a_body_may_be_made_of_several_parts() {
    let mut body = ball(Vec3::ZERO, 1.0, 0);
    for (number, part) in body.triangle_part.iter_mut().enumerate() {
        *part = u32::from(number % 14 > 6);
    }
    let inward = |face: u32| face % 14 > 6 || face == 2;
    let count = body.triangles.len();
    assert_eq!(turned_faces(&with_turned(body, inward)), of(count, inward));
    // Sheets of different parts that meet in an edge are not compared.
    let mut tent = sheet(2);
    for (number, part) in tent.triangle_part.iter_mut().enumerate() {
        *part = u32::from(number >= 4);
    }
    assert_eq!(turned_faces(&with_turned(tent, |face| face >= 5)), [4]);
}

#[test]
fn a_one_sided_band_has_no_faces_that_are_inside_out() {
    // A Möbius strip: the last square meets the first one upside down.
    let squares = 12;
    let edge = |step: u32| {
        let turn = std::f32::consts::TAU * step as f32 / squares as f32;
        let out = Vec3::new(turn.cos(), 0.0, turn.sin());
        let across = (out * (turn / 2.0).cos() + Vec3::Y * (turn / 2.0).sin()) * 0.3;
        [out + across, out - across]
    };
    let positions: Vec<[f32; 3]> = (0..squares).flat_map(edge).map(|at| at.to_array()).collect();
    let mut triangles = Vec::new();
    for step in 0..squares {
        let [a, b] = [2 * step, 2 * step + 1];
        let [c, d] = if step + 1 == squares { [1, 0] } else { [a + 2, b + 2] };
        triangles.extend([[a, b, d], [a, d, c]]);
    }
    let count = triangles.len();
    let band = Mesh {
        positions,
        triangles,
        triangle_part: vec![0; count],
        triangle_material: vec![0; count],
        ..Mesh::default()
    };
    assert_eq!(turned_faces(&band), NOTHING);
}
