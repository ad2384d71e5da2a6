//! Hits found near a place are the same as those of the hierarchy.

use glam::{DVec3, Vec3};

use super::*;
use crate::model::Mesh;

/// Returns numbers from 0 to 1, evenly distributed: multiples of the golden ratio.
fn dice(state: &mut u32) -> f32 {
    *state += 1;
    (*state as f32 * 0.618_034).fract()
}

const SIDE: u32 = 24;
/// Share of the ground's width that rays reach.
const REACH: f32 = 0.12;

/// Creates a ground of `SIDE` × `SIDE` squares, with bumps of some height and a wall across it.
fn ground(bump: f32, wall: f32) -> Mesh {
    let mut state = 7;
    let mut mesh = Mesh::default();
    for row in 0..=SIDE {
        for column in 0..=SIDE {
            let up = bump * dice(&mut state) + if column > SIDE / 2 { wall } else { 0.0 };
            mesh.positions
                .push([column as f32 / SIDE as f32, up, row as f32 / SIDE as f32]);
        }
    }
    for row in 0..SIDE {
        for column in 0..SIDE {
            let at = row * (SIDE + 1) + column;
            let below = at + SIDE + 1;
            mesh.triangles.push([at, below, at + 1]);
            mesh.triangles.push([at + 1, below, below + 1]);
        }
    }
    mesh
}

/// Returns rays in all directions from a place on a triangle, whose starts are offset to the side to which each ray goes.
fn rays(mesh: &Mesh, triangle: u32, state: &mut u32) -> Vec<PlaceRay> {
    let [a, b, c] = mesh.corners(triangle).map(DVec3::as_vec3);
    let normal = (b - a).cross(c - a).normalize();
    let shares = [dice(state), dice(state)].map(|share| 0.5 * share);
    let place = a + (b - a) * shares[0] + (c - a) * shares[1];
    let mut ray = || {
        let direction = Vec3::from([0; 3].map(|_| dice(state) - 0.5)).normalize_or(Vec3::Y);
        let side = if direction.dot(normal) >= 0.0 { 1e-4 } else { -1e-4 };
        PlaceRay {
            origin: (place + normal * side).to_array(),
            direction: direction.to_array(),
            reach: REACH,
        }
    };
    (0..32).map(|_| ray()).collect()
}

/// Counts for rays of all triangles: known misses, known hits and unknown ones; and how many of the known results differ
/// from those of the hierarchy.
fn known(mesh: &Mesh, least_turn: Option<f32>) -> ([usize; 3], usize) {
    let bvh = Bvh::build(mesh);
    let mut state = 3;
    let (mut near, mut around) = (NearTriangles::default(), Surroundings::default());
    let (mut counts, mut differ) = ([0; 3], 0);
    for triangle in 0..mesh.triangles.len() as u32 {
        let rays = rays(mesh, triangle, &mut state);
        assert!(near.find(&bvh, rays.iter().copied(), 512));
        around.look(&bvh, &near, triangle, rays.iter().copied(), least_turn);
        for ray in rays {
            let found = bvh.closest(ray.origin, ray.direction, ray.reach);
            let found = found.map(|hit| hit.triangle);
            match around.closest(&bvh, ray) {
                Known::Miss => {
                    counts[0] += 1;
                    differ += usize::from(found.is_some());
                }
                Known::Hit(triangle, _) => {
                    counts[1] += 1;
                    differ += usize::from(found != Some(triangle));
                }
                Known::Nothing => counts[2] += 1,
            }
        }
    }
    (counts, differ)
}

#[test]
fn rays_of_a_place_have_the_same_hits_as_in_the_hierarchy() {
    for (bump, wall) in [(0.0, 0.0), (0.02, 0.0), (0.0, 0.1), (0.05, 0.3)] {
        let ([misses, hits, _], differ) = known(&ground(bump, wall), None);
        // A ray through an edge may hit either of its two triangles.
        assert!(
            differ * 1000 <= misses + hits,
            "{bump} {wall}: {differ} of {misses} and {hits}"
        );
        assert_eq!(hits > 0, bump + wall > 0.0, "{bump} {wall}");
    }
}

#[test]
fn hits_on_slightly_turned_triangles_are_ignored_but_not_those_on_a_wall() {
    let gentle = ground(0.004, 0.0);
    let ([_, all, _], _) = known(&gentle, None);
    let ([_, counting, _], _) = known(&gentle, Some(0.5));
    assert!(all > 0 && counting == 0, "{all} {counting}");
    let ([_, on_wall, _], _) = known(&ground(0.004, 0.1), Some(0.5));
    assert!(on_wall > 0);
}

#[test]
fn with_too_many_nearby_triangles_nothing_is_known() {
    let mesh = ground(0.02, 0.0);
    let bvh = Bvh::build(&mesh);
    let (mut near, mut around) = (NearTriangles::default(), Surroundings::default());
    let far = rays(&mesh, 500, &mut 1)
        .into_iter()
        .map(|ray| PlaceRay { reach: 2.0, ..ray });
    assert!(!near.find(&bvh, far.clone(), 512));
    assert!(near.find(&bvh, far.clone(), 2048));
    around.look(&bvh, &near, 500, far.clone(), None);
    assert!(far.into_iter().all(|ray| around.closest(&bvh, ray) == Known::Nothing));
}

#[test]
fn on_a_triangle_without_area_nothing_is_known() {
    let mut mesh = ground(0.02, 0.1);
    let line = mesh.triangles.len() as u32;
    mesh.triangles.push([0, 1, 1]);
    let bvh = Bvh::build(&mesh);
    let (mut near, mut around) = (NearTriangles::default(), Surroundings::default());
    let rays = rays(&mesh, 500, &mut 1);
    assert!(near.find(&bvh, rays.iter().copied(), 512));
    around.look(&bvh, &near, line, rays.iter().copied(), None);
    assert!(rays.iter().all(|ray| around.closest(&bvh, *ray) == Known::Nothing));
}
