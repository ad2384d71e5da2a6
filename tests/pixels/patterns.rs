//! Patterns: laid around the corners of boxes, of the share that they say, and the same on every unwrap.

use std::collections::{BTreeMap, BTreeSet};

use sabi_tests::OnMesh;

use crate::specimens::{Specimen, on_own_mesh, specimens};

fn patterns() -> Vec<Specimen> {
    let all = specimens().into_iter().filter(Specimen::is_pattern);
    let found: Vec<Specimen> = all.collect();
    assert!(found.len() > 30, "{} results of patterns", found.len());
    found
}

/// Graph of a pattern with parameters.
fn graph(kind: &str, params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "node": {{ "kind": "{kind}", "params": {{ {params} }} }} }} }}"#
    )
}

/// Normal of a triangle's first corner.
fn normal(on_mesh: &OnMesh, triangle: u32) -> [f32; 3] {
    let mesh = &on_mesh.evaluator.linked().model.mesh;
    mesh.normals[mesh.triangles[triangle as usize][0] as usize]
}

#[test]
fn a_pattern_goes_on_around_the_upright_corners_of_a_box() {
    for specimen in patterns() {
        let mut on_mesh = on_own_mesh(&specimen.coarse, "cube", 384);
        let components = on_mesh.evaluate(&specimen.target()).components();
        for (name, values) in &components {
            let mut differences = [Vec::new(), Vec::new()];
            for seam in on_mesh.seams() {
                let is_upright = seam.triangles.iter().all(|of| normal(&on_mesh, *of)[1].abs() < 0.5);
                for sample in 0..64 {
                    let along = (f64::from(sample) + 0.5) / 64.0;
                    let side = |side: usize| on_mesh.bilinear(values, seam.triangles[side], seam.weights(side, along));
                    differences[usize::from(is_upright)].push((side(0) - side(1)).abs());
                }
            }
            let [others, upright] = differences.map(|all| {
                assert!(!all.is_empty(), "the cube has upright corners and others");
                let many = all.len() as f64;
                all.into_iter().sum::<f64>() / many
            });
            let (low, high) = values
                .iter()
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| {
                    (low.min(*value), high.max(*value))
                });
            let range = f64::from(high - low);
            // A few samples lie on the border of a cell, which each side reads from its own texels.
            assert!(
                upright < 0.05 * range,
                "{} {name}: {upright:.4} of {range:.4} around upright corners, {others:.4} around others",
                specimen.name()
            );
        }
    }
}

#[test]
fn cells_cover_what_their_lengths_say() {
    for (kind, params, share) in [
        (
            "pattern/bricks",
            r#""length": 0.25, "row_height": 0.1, "joint": 0.02, "bevel": 0"#,
            0.92 * 0.8,
        ),
        (
            "pattern/bricks",
            r#""length": 0.25, "row_height": 0.1, "joint": 0.02, "bevel": 0, "bond": "stack", "uneven": 0"#,
            0.92 * 0.8,
        ),
        ("pattern/tiles", r#""width": 0.1, "joint": 0.02, "bevel": 0"#, 0.8 * 0.8),
        (
            "pattern/tiles",
            r#""width": 0.1, "joint": 0.02, "bevel": 0, "laid": "herringbone""#,
            0.8 * 0.9,
        ),
        (
            "pattern/tiles",
            r#""width": 0.1, "joint": 0.02, "bevel": 0, "laid": "basket""#,
            0.8 * 0.9,
        ),
        (
            "pattern/planks",
            r#""width": 0.1, "length": 0.5, "joint": 0.02, "bevel": 0"#,
            0.8 * 0.96,
        ),
        ("pattern/hex", r#""size": 0.1, "joint": 0.02, "bevel": 0"#, 0.64),
        ("pattern/weave", r#""size": 0.1, "thread": 0.8, "uneven": 0"#, 0.96),
        ("pattern/stripes", r#""size": 0.1, "width": 0.3"#, 0.3),
        ("pattern/grid", r#""size": 0.1, "width": 0.02"#, 0.36),
        ("pattern/checker", r#""size": 0.1"#, 0.5),
    ] {
        let mut means = Vec::new();
        // Cells of many texels, and cells that are far below one.
        for size in [512, 16] {
            let mut on_mesh = on_own_mesh(&graph(kind, params), "cube", size);
            let values = on_mesh.evaluate("node.mask").component("mask");
            let (sum, area) = on_mesh.areas().iter().fold((0.0, 0.0), |(sum, area), (index, own)| {
                (sum + own * f64::from(values[*index]), area + own)
            });
            means.push(sum / area);
        }
        for mean in means {
            assert!(
                (mean - share).abs() < 0.03,
                "{kind} {params}: {mean:.3} and not {share:.3}"
            );
        }
    }
}

#[test]
fn two_tiles_of_herringbone_never_share_a_square() {
    // Random values of cells: each tile of two squares has one, and neighbors others.
    let params = r#""width": 0.25, "joint": 0.05, "laid": "herringbone""#;
    let mut on_mesh = on_own_mesh(&graph("pattern/tiles", params), "cube", 256);
    let ids = on_mesh.evaluate("node.id").component("mask");
    let mask = on_mesh.evaluate("node.mask").component("mask");
    let mut areas = BTreeMap::<u32, f64>::new();
    // One side, since the others show the same tiles where they go on around its corners.
    let front: BTreeSet<usize> = on_mesh
        .owned()
        .filter(|(_, triangle)| normal(&on_mesh, *triangle)[2] > 0.5)
        .map(|(index, _)| index)
        .collect();
    for (index, area) in on_mesh.areas() {
        if mask[index] > 0.5 && front.contains(&index) {
            *areas.entry(ids[index].to_bits()).or_default() += area;
        }
    }
    // A whole tile is 0.2 by 0.45; those at corners are cut.
    let whole = 0.2 * 0.45;
    assert!(areas.len() > 6, "{} tiles", areas.len());
    assert!(areas.values().all(|area| *area < 1.2 * whole), "{areas:?}");
    let count = areas
        .values()
        .filter(|area| (**area - whole).abs() < 0.1 * whole)
        .count();
    assert!(count * 3 > areas.len(), "{count} of {} are whole", areas.len());
}
