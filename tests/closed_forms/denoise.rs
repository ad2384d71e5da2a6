//! Noise of results of rays: removed from even areas, without a change of real borders.

use sabi_tests::{OnMesh, project};

const NODES: &str = r#"
    "few": { "kind": "surface/sunlight", "params": { "rays": 16 } },
    "many": { "kind": "surface/sunlight", "params": { "rays": 256, "seed": 9 } },
    "clean": { "kind": "filter/denoise", "inputs": { "source": "few" } },
    "edge": { "kind": "surface/direction", "params": { "reach": 90, "fade": 0 } },
    "kept": { "kind": "filter/denoise", "inputs": { "source": "edge" } }"#;

fn graph() -> String {
    format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {NODES} }} }}"#)
}

/// Root of the mean squared difference over owned texels.
fn apart(on_mesh: &OnMesh, one: &[f32], other: &[f32]) -> f64 {
    let squares = on_mesh
        .owned()
        .map(|(index, _)| f64::from(one[index] - other[index]).powi(2));
    let (sum, count) = squares.fold((0.0, 0), |(sum, count), square| (sum + square, count + 1));
    (sum / f64::from(count)).sqrt()
}

#[test]
fn denoising_sunlight_is_as_good_as_four_times_as_many_rays() {
    let mut on_mesh = OnMesh::new(&graph(), &project("assets/meshes/figure.glb"), 256);
    let mut of = |node: &str| on_mesh.evaluate(node).component("mask");
    let [few, many, clean] = ["few", "many", "clean"].map(&mut of);
    let (grainy, left) = (apart(&on_mesh, &few, &many), apart(&on_mesh, &clean, &many));
    assert!(left < grainy / 2.0, "{left} of {grainy}");
}

#[test]
fn a_real_border_is_not_denoised() {
    let mut on_mesh = OnMesh::new(&graph(), &project("assets/meshes/cube.glb"), 256);
    let mut of = |node: &str| on_mesh.evaluate(node).component("mask");
    let [edge, kept] = ["edge", "kept"].map(&mut of);
    assert!(apart(&on_mesh, &edge, &kept) < 0.01);
}

/// Returns occlusion or curvature of this many rays, with a seed.
fn of_rays(kind: &str, rays: u32, seed: u32) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{
            "rays": {{ "kind": "surface/{kind}", "params": {{ "rays": {rays}, "seed": {seed} }} }} }} }}"#
    )
}

#[test]
fn denoised_results_of_few_rays_are_as_good_as_those_of_two_or_three_times_as_many() {
    let mut on_mesh = OnMesh::new(&graph(), &project("assets/meshes/figure.glb"), 512);
    // Root mean square errors of 16 rays of occlusion and of 32 rays of curvature without denoising.
    for (kind, rays, grain) in [("occlusion", 8, 0.0217), ("curvature", 12, 0.0472)] {
        let [few, many] = [(rays, 0), (1024, 9)].map(|(rays, seed)| {
            on_mesh.set_graph(&of_rays(kind, rays, seed));
            on_mesh.evaluate("rays").component("mask")
        });
        let error = apart(&on_mesh, &few, &many);
        assert!(error < 2.0 / 3.0 * grain, "{kind}: {error}");
    }
}
