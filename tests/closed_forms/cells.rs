//! `noise/cells` against all points of the 7 × 7 × 7 cells around, on the processor.

use glam::{DVec3, IVec3, UVec3, Vec3, ivec3};
use sabi_tests::{OnMesh, project};

/// The hash of `lib/hash.wgsl`, written again: Jarzynski and Olano, "Hash Functions for GPU Rendering" (2020).
fn pcg3d(key: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = key.map(|part| part.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for round in 0..2 {
        if round == 1 {
            [x, y, z] = [x, y, z].map(|part| part ^ (part >> 16));
        }
        x = x.wrapping_add(y.wrapping_mul(z));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
    }
    [x, y, z]
}

#[test]
fn the_hash_never_changes() {
    // Worked out apart from this code, with whole numbers of any size.
    assert_eq!(pcg3d([0, 0, 0]), HASH_OF_ZERO);
    assert_eq!(pcg3d([1, 2, 3]), HASH_OF_ONE_TWO_THREE);
}

const HASH_OF_ZERO: [u32; 3] = [2_611_992_518, 2_833_812_075, 1_058_359_340];
const HASH_OF_ONE_TWO_THREE: [u32; 3] = [4_204_755_366, 1_223_881_804, 1_500_469_937];

/// What a node's seed becomes in a document of seed 0.
fn effective_seed(own: u32) -> u32 {
    sabi_plan::pcg(sabi_plan::pcg(0) ^ own)
}

/// The point of a cell, in cells from the cell's corner, and its random number.
fn point(cell: IVec3, seed: u32, jitter: f32) -> (Vec3, u32) {
    let key = [
        seed,
        seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453),
        seed.wrapping_mul(277_803_737).wrapping_add(1_831_565_813),
    ];
    let folded: UVec3 = cell.as_uvec3() & UVec3::splat(65_535);
    let parts = folded.to_array();
    let random = pcg3d([0, 1, 2].map(|axis| parts[axis].wrapping_add(key[axis])));
    let unit = |bits: u32| (bits >> 8) as f32 / 16_777_216.0;
    (
        Vec3::splat(0.5) + jitter * (Vec3::from(random.map(unit)) - 0.5),
        random[0],
    )
}

/// Distance to the nearest of 343 points, and its value.
fn brute_force(position: DVec3, size: f64, seed: u32, jitter: f32) -> (f32, f32) {
    let place = position / size + DVec3::new(0.2713, 0.3137, 0.2299);
    let cell = place.floor().as_ivec3();
    let inside = (place - place.floor()).as_vec3();
    let mut nearest = (f32::INFINITY, 0);
    for at in 0..343 {
        let step = ivec3(at % 7 - 3, at / 7 % 7 - 3, at / 49 - 3);
        let (point, id) = point(cell + step, seed, jitter);
        let distance = (point + step.as_vec3()).distance(inside);
        if distance < nearest.0 {
            nearest = (distance, id);
        }
    }
    (nearest.0, (nearest.1 >> 8) as f32 / 16_777_216.0)
}

/// Places looked at.
const PLACES: usize = 10_000;

#[test]
fn cells_find_the_nearest_point_of_all() {
    for (jitter, own_seed, size) in [(1.0_f32, 0_u32, 0.12), (0.6, 7, 0.15), (0.0, 3, 0.2)] {
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{ "cells": {{ "kind": "noise/cells",
                "params": {{ "size": {size}, "jitter": {jitter}, "seed": {own_seed} }} }} }} }}"#
        );
        let mut on_mesh = OnMesh::new(&graph, &project("assets/meshes/cube.glb"), 256);
        let distances = on_mesh.evaluate("cells").component("mask");
        let ids = on_mesh.evaluate("cells.id").component("mask");
        let owned: Vec<usize> = on_mesh.owned().map(|(index, _)| index).collect();
        assert!(owned.len() >= PLACES, "{} texels", owned.len());
        let longest = 0.866_025_4 + (1.0 - 0.866_025_4) * jitter;
        let mut other_ids = 0;
        for index in owned.iter().step_by(owned.len() / PLACES).take(PLACES) {
            let position = on_mesh.position(*index).expect("an owned texel");
            let (distance, id) = brute_force(position, size, effective_seed(own_seed), jitter);
            let expected = (distance / longest).min(1.0);
            let got = distances[*index];
            assert!(
                (expected - got).abs() < 2e-5,
                "jitter {jitter} at {position}: {got}, not {expected}"
            );
            other_ids += usize::from((id - ids[*index]).abs() > 1e-6);
        }
        // Where two points are equally far, rounding decides which one is nearer.
        let allowed = if jitter > 0.0 { PLACES / 1000 } else { PLACES / 50 };
        assert!(other_ids <= allowed, "jitter {jitter}: {other_ids} other cells");
    }
}
