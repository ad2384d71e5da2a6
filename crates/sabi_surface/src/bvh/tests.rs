//! The hierarchy finds the same hits as testing every triangle.

use super::*;

fn dice(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((*state >> ((*state >> 28) + 4)) ^ *state).wrapping_mul(277_803_737);
    ((word >> 22) ^ word) as f32 / u32::MAX as f32
}

/// Creates triangles scattered over a box of a given size, some of them without area.
fn soup(seed: u32, scale: f32) -> Mesh {
    let mut state = seed;
    let mut mesh = Mesh::default();
    for number in 0..400u32 {
        let center = [0; 3].map(|_| dice(&mut state) * scale);
        for _ in 0..3 {
            let flat = if number % 50 == 0 { 0.0 } else { 0.5 * scale };
            mesh.positions.push(center.map(|value| value + dice(&mut state) * flat));
        }
        mesh.triangles.push([number * 3, number * 3 + 1, number * 3 + 2]);
    }
    mesh
}

/// Tests every triangle in double precision (Möller and Trumbore).
fn brute(mesh: &Mesh, origin: [f32; 3], direction: [f32; 3], max: f32) -> Option<(u32, f64)> {
    let vector = |v: [f32; 3]| glam::DVec3::from(v.map(f64::from));
    let (origin, direction) = (vector(origin), vector(direction).normalize());
    let mut best: Option<(u32, f64)> = None;
    for (number, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|vertex| vector(mesh.positions[vertex as usize]));
        let (u, v) = (b - a, c - a);
        let p = direction.cross(v);
        let det = u.dot(p);
        if det == 0.0 {
            continue;
        }
        let s = origin - a;
        let of_b = s.dot(p) / det;
        let q = s.cross(u);
        let of_c = direction.dot(q) / det;
        let t = v.dot(q) / det;
        let inside = of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0;
        if inside && t > 0.0 && t <= f64::from(max) && best.is_none_or(|(_, least)| t < least) {
            best = Some((number as u32, t));
        }
    }
    best
}

#[test]
fn rays_hit_the_same_triangles_as_testing_every_triangle_at_any_scale() {
    for (seed, scale) in [(1, 1.0f32), (2, 1e-3), (3, 4e4)] {
        let mesh = soup(seed, scale);
        let bvh = Bvh::build(&mesh);
        let mut state = seed + 100;
        let (mut hits, mut differ) = (0, 0);
        for ray in 0..1000 {
            let origin = [0; 3].map(|_| (dice(&mut state) * 2.0 - 0.5) * scale);
            let direction = origin.map(|value| dice(&mut state) * scale - value);
            let max = if ray % 3 == 0 { 0.3 * scale } else { 10.0 * scale };
            let expected = brute(&mesh, origin, direction, max);
            let found = bvh.closest(origin, direction, max);
            assert_eq!(found.is_some(), bvh.any(origin, direction, max));
            let (Some((triangle, distance)), Some(hit)) = (expected, found) else {
                differ += u32::from(expected.is_some() != found.is_some());
                continue;
            };
            hits += 1;
            assert!(
                (f64::from(hit.distance) - distance).abs() < 1e-4 * f64::from(scale),
                "{hit:?} {distance}"
            );
            differ += u32::from(hit.triangle != triangle);
            let point = mesh.triangles[hit.triangle as usize]
                .iter()
                .zip(hit.barycentric)
                .fold(glam::Vec3::ZERO, |sum, (&vertex, share)| {
                    sum + glam::Vec3::from(mesh.positions[vertex as usize]) * share
                });
            let on_ray = glam::Vec3::from(origin) + glam::Vec3::from(direction).normalize() * hit.distance;
            assert!((point - on_ray).length() < 2e-4 * scale, "{point} {on_ray}");
        }
        assert!(hits > 300, "{hits}");
        // A ray through an edge may hit either of its two triangles.
        assert!(differ <= 2, "{differ}");
    }
}

#[test]
fn triangles_at_a_few_millionths_of_the_models_size_are_hit() {
    // A large face far away, and two small vertical faces with a very narrow gap between them. Seen from the middle of the
    // gap, they are four millionths of the diagonal away.
    let gap = 2e-5_f32;
    let upright = |x: f32| [[x, -0.01, -0.01], [x, 0.01, -0.01], [x, 0.0, 0.02]];
    let far = [[-1.0, -0.5, -1.0], [1.0, -0.5, -1.0], [0.0, -0.5, 1.0]];
    let mesh = Mesh {
        positions: [upright(0.0), upright(gap), far].concat(),
        triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]],
        ..Mesh::default()
    };
    let bvh = Bvh::build(&mesh);
    for direction in [1.0, -1.0_f32] {
        let hit = bvh.closest([0.5 * gap, 0.001, 0.001], [direction, 0.0, 0.0], 1.0);
        let distance = hit.map_or(f32::INFINITY, |hit| hit.distance);
        assert!((distance - 0.5 * gap).abs() < 0.2 * gap, "{direction}: {hit:?}");
    }
}

#[test]
fn the_sign_of_zero_does_not_change_a_ray() {
    let mesh = Mesh {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 2.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let bvh = Bvh::build(&mesh);
    for [x, y] in [[0.0, 0.0], [-0.0, 0.0], [0.0, -0.0], [-0.0, -0.0]] {
        for (height, z) in [(1.0, -1.0), (-1.0, 1.0)] {
            let hit = bvh.closest([0.0, 0.0, height], [x, y, z], 4.0);
            assert_eq!(hit.map(|hit| hit.triangle), Some(0), "{x} {y} {z}");
            assert!(bvh.any([0.0, 0.0, height], [x, y, z], 4.0), "{x} {y} {z}");
        }
    }
}

#[test]
fn building_twice_gives_the_same_hierarchy() {
    let mesh = soup(5, 1.0);
    assert_eq!(Bvh::build(&mesh).tree(), Bvh::build(&mesh).tree());
}

#[test]
fn an_empty_mesh_is_never_hit() {
    let empty = Bvh::build(&Mesh::default());
    assert_eq!(empty.closest([0.0; 3], [0.0, 1.0, 0.0], f32::INFINITY), None);
    assert!(!empty.any([0.0; 3], [0.0, 1.0, 0.0], 1.0));
    let bvh = Bvh::build(&soup(6, 1.0));
    assert_eq!(bvh.closest([0.5; 3], [0.0; 3], 1.0), None);
    assert_eq!(bvh.closest([f32::NAN; 3], [0.0, 1.0, 0.0], 1.0), None);
    assert_eq!(bvh.closest([0.5; 3], [0.0, 1.0, 0.0], f32::NAN), None);
    assert_eq!(bvh.closest([0.5; 3], [0.0, 1.0, 0.0], -1.0), None);
    let mut point = Mesh {
        positions: vec![[2.0; 3]],
        triangles: vec![[0, 0, 0]],
        ..Mesh::default()
    };
    assert_eq!(Bvh::build(&point).closest([0.0; 3], [1.0; 3], 10.0), None);
    point.positions[0][0] = f32::NAN;
    assert_eq!(Bvh::build(&point).closest([0.0; 3], [1.0; 3], 10.0), None);
}
