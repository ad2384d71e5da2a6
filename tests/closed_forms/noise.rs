//! Statistics of noises: properties on which a threshold, a seed and a resolution may rely.

use glam::DVec3;
use sabi_tests::{OnMesh, project};

fn one_node(kind: &str, params: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ "noise": {{ "kind": "{kind}", "params": {{ {params} }} }} }} }}"#
    )
}

/// The result of a node alone on the cube.
fn on_cube(kind: &str, params: &str, size: u32) -> (OnMesh, Vec<f32>) {
    let mut on_mesh = OnMesh::new(&one_node(kind, params), &project("assets/meshes/cube.glb"), size);
    let values = on_mesh.evaluate("noise").component("mask");
    (on_mesh, values)
}

fn owned_values(kind: &str, params: &str, size: u32) -> Vec<f64> {
    let (on_mesh, values) = on_cube(kind, params, size);
    on_mesh.owned().map(|(index, _)| f64::from(values[index])).collect()
}

fn below(values: &[f64], threshold: f64) -> f64 {
    values.iter().filter(|value| **value < threshold).count() as f64 / values.len() as f64
}

#[test]
fn a_threshold_on_clouds_is_the_share_that_is_left_out() {
    // Layers that the texels carry whole: what they do not is averaged out, and a mean has no share of its own.
    // How far the share may be off: what chance leaves of a dozen surfaces, and for ridges what the node's text states.
    for (mode, tolerance) in [("fbm", 0.02), ("billow", 0.02), ("ridged", 0.04)] {
        let graph = |seed: u32| {
            one_node(
                "noise/simplex",
                &format!(r#""size": 0.14, "octaves": 3, "mode": "{mode}", "seed": {seed}"#),
            )
        };
        let mut on_mesh = OnMesh::new(&graph(0), &project("assets/meshes/cube.glb"), 512);
        let mut all = Vec::new();
        for seed in 0..12 {
            on_mesh.set_graph(&graph(seed));
            let values = on_mesh.evaluate("noise").component("mask");
            all.extend(on_mesh.owned().map(|(index, _)| f64::from(values[index])));
        }
        for tenth in 1..10 {
            let threshold = f64::from(tenth) / 10.0;
            let share = below(&all, threshold);
            assert!(
                (share - threshold).abs() < tolerance,
                "{mode}: {share:.4} is below {threshold}"
            );
        }
    }
}

#[test]
fn grains_are_spread_evenly() {
    let values = owned_values("noise/white", r#""size": 0.02"#, 512);
    for tenth in 1..10 {
        let threshold = f64::from(tenth) / 10.0;
        let share = below(&values, threshold);
        assert!((share - threshold).abs() < 0.02, "{share:.4} is below {threshold}");
    }
}

fn correlation(one: &[f64], other: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_one, mean_other) = (mean(one), mean(other));
    let (mut both, mut squares_one, mut squares_other) = (0.0, 0.0, 0.0);
    for (a, b) in one.iter().zip(other) {
        let (a, b) = (a - mean_one, b - mean_other);
        both += a * b;
        squares_one += a * a;
        squares_other += b * b;
    }
    both / (squares_one * squares_other).sqrt()
}

#[test]
fn seeds_are_independent() {
    // So fine that chance itself is below a hundredth.
    let noises = [
        ("noise/simplex", r#""size": 0.02, "octaves": 1"#),
        ("noise/white", r#""size": 0.012"#),
        ("noise/cells", r#""size": 0.022"#),
        ("noise/cracks", r#""size": 0.03, "width": 0.006"#),
        ("noise/dots", r#""size": 0.008, "spacing": 0.016"#),
        ("noise/scratches", r#""density": 1, "length": 0.05, "width": 0.004"#),
    ];
    for (kind, params) in noises {
        let of_seed = |seed: u32| owned_values(kind, &format!(r#"{params}, "seed": {seed}"#), 512);
        let values = [of_seed(0), of_seed(1), of_seed(2)];
        for (a, b) in [(0, 1), (1, 2), (0, 2)] {
            let correlation = correlation(&values[a], &values[b]);
            assert!(correlation.abs() < 0.02, "{kind}, seeds {a} and {b}: {correlation:.4}");
        }
        assert!(
            (correlation(&values[0], &of_seed(0)) - 1.0).abs() < 1e-9,
            "{kind}: the same seed"
        );
    }
}

#[test]
fn grains_are_the_same_at_every_resolution() {
    // At three times the resolution every third texel has the same middle.
    let params = r#""size": 0.3"#;
    let (small, coarse) = on_cube("noise/white", params, 64);
    let (large, fine) = on_cube("noise/white", params, 192);
    let mut other = 0;
    let mut count = 0;
    for (index, triangle) in small.owned() {
        let chart = small.atlas().triangle_chart[triangle as usize] as usize;
        let (from, to) = (&small.atlas().charts[chart], &large.atlas().charts[chart]);
        let [_, x, y] = small.texel(index);
        let [column, row] = [(x, 0), (y, 1)]
            .map(|(at, axis)| (3 * (at as i32 - from.texel_from_uv[axis]) + 1 + to.texel_from_uv[axis]) as u32);
        let same = large.index([to.page, column, row]);
        let distance = |places: [Option<DVec3>; 2]| match places {
            [Some(one), Some(other)] => one.distance(other),
            _ => f64::INFINITY,
        };
        if distance([small.position(index), large.position(same)]) < 1e-5 {
            count += 1;
            other += usize::from(coarse[index] != fine[same]);
        }
    }
    assert!(count > 1000, "{count} places");
    // On the border between two cubes rounding decides.
    assert!(other <= count / 500, "{other} of {count} differ");
}

#[test]
fn simplex_noise_is_the_same_along_every_axis() {
    // Neighbors across each axis of space are equally alike: nothing shows the lattice.
    let (on_mesh, values) = on_cube("noise/simplex", r#""size": 0.05, "octaves": 1"#, 512);
    let mut sums = [[0.0; 2]; 3];
    for (one, other) in on_mesh.neighbors() {
        let [Some(from), Some(to)] = [one, other].map(|index| on_mesh.position(index)) else {
            continue;
        };
        let step = to - from;
        let square = (f64::from(values[one]) - f64::from(values[other])).powi(2) / step.length_squared();
        let direction = step.abs() / step.length();
        for axis in 0..3 {
            if direction[axis] > 0.9 {
                sums[axis][0] += square;
                sums[axis][1] += 1.0;
            }
        }
    }
    let steepness = sums.map(|[sum, count]| {
        assert!(count > 1000.0, "{sums:?}");
        f64::sqrt(sum / count)
    });
    let mean = steepness.iter().sum::<f64>() / 3.0;
    for steep in steepness {
        assert!((steep / mean - 1.0).abs() < 0.05, "{steepness:?}");
    }
}

#[test]
fn marks_finer_than_the_texels_are_their_mean() {
    // Far below the size at which any of them is seen by itself; the model is the sphere, so every direction counts.
    for (kind, params) in [
        ("cells", r#""size": 0.0625"#),
        ("cracks", r#""size": 0.05, "width": 0.004"#),
        ("cracks", r#""size": 0.05, "width": 0.008, "jitter": 0.3, "levels": 1"#),
        ("dots", r#""size": 0.02, "spacing": 0.06"#),
        ("dots", r#""size": 0.06, "spacing": 0.06, "variation": 0"#),
        (
            "dots",
            r#""size": 0.04, "spacing": 0.06, "variation": 1, "sharpness": 0"#,
        ),
        ("scratches", r#""length": 0.1, "width": 0.003"#),
        ("scratches", r#""length": 0.1, "width": 0.003, "density": 1"#),
    ] {
        for port in if kind == "cracks" || kind == "scratches" {
            &["mask", "height"][..]
        } else {
            &["mask"]
        } {
            let mean = |size: u32| {
                let graph = one_node(&format!("noise/{kind}"), params);
                let mut on_mesh = OnMesh::new(&graph, &project("assets/meshes/sphere.glb"), size);
                let values = on_mesh.evaluate(&format!("noise.{port}")).component("mask");
                let owned: Vec<f64> = on_mesh.owned().map(|(index, _)| f64::from(values[index])).collect();
                owned.iter().sum::<f64>() / owned.len() as f64
            };
            let (coarse, fine) = (mean(16), mean(1024));
            assert!(
                (coarse - fine).abs() < 0.02,
                "{kind}, {params}: the mean of {port} is {fine:.4} and is taken for {coarse:.4}"
            );
        }
    }
}
