//! Results of surveys, compared with the areas of the texels themselves.

use std::collections::BTreeMap;

use sabi_tests::{OnMesh, project};

const MODELS: [&str; 5] = ["bench", "barrel", "figure", "column", "cube"];

fn on(mesh: &str, size: u32, nodes: &str) -> OnMesh {
    let graph = format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {nodes} }} }}"#);
    OnMesh::new(&graph, &project(&format!("assets/meshes/{mesh}.glb")), size)
}

#[test]
fn as_much_is_covered_as_is_asked_for_on_any_model_and_from_any_mask() {
    let sources = [
        r#""kind": "noise/simplex", "params": { "size": 0.2 }"#,
        r#""kind": "surface/position", "params": { "along": [0.2, 1, 0] }"#,
        r#""kind": "noise/cracks", "params": { "size": 0.2 }"#,
    ];
    let asked = [(0.02, 0.1), (0.3, 0.0), (0.3, 0.5), (0.8, 0.1)];
    let mut nodes = Vec::new();
    for (number, source) in sources.iter().enumerate() {
        nodes.push(format!(r#""source_{number}": {{ {source} }}"#));
        for (at, (amount, softness)) in asked.iter().enumerate() {
            nodes.push(format!(
                r#""cover_{number}_{at}": {{ "kind": "adjust/coverage", "inputs": {{ "source": "source_{number}" }},
                    "params": {{ "amount": {amount}, "softness": {softness} }} }}"#
            ));
        }
    }
    for mesh in MODELS {
        let mut on_mesh = on(mesh, 256, &nodes.join(", "));
        for (number, source) in sources.iter().enumerate() {
            for (at, (amount, softness)) in asked.into_iter().enumerate() {
                let mask = on_mesh.evaluate(&format!("cover_{number}_{at}")).component("mask");
                let covered = on_mesh.mean(&mask);
                // Lines are 0 on most of the surface: cut hard, all of that or nothing is covered.
                let is_possible = softness > 0.0 || !source.contains("cracks");
                assert!(
                    !is_possible || (covered - amount).abs() < 0.005,
                    "{mesh}, {source}: {covered} for {amount} at {softness}"
                );
            }
        }
    }
}

#[test]
fn none_and_all_of_an_even_mask_are_covered_as_asked() {
    for (amount, expected) in [(0.0, 0.0), (0.3, 0.3), (1.0, 1.0)] {
        let mut on_mesh = on(
            "cube",
            64,
            &format!(
                r#""even": {{ "kind": "adjust/levels", "params": {{ "low": 0.4, "high": 0.4 }} }},
                "cover": {{ "kind": "adjust/coverage", "inputs": {{ "source": "even" }}, "params": {{ "amount": {amount} }} }}"#
            ),
        );
        let covered = {
            let mask = on_mesh.evaluate("cover").component("mask");
            on_mesh.mean(&mask)
        };
        assert!((covered - expected).abs() < 1e-3, "{covered} for {amount}");
    }
}

#[test]
fn auto_levels_leave_the_shares_that_were_asked_at_both_ends() {
    for mesh in MODELS {
        let mut on_mesh = on(
            mesh,
            256,
            r#""source": { "kind": "noise/simplex", "params": { "size": 0.2 } },
            "auto": { "kind": "adjust/auto_levels", "inputs": { "source": "source" }, "params": { "low": 0.1, "high": 0.8 } }"#,
        );
        let mask = on_mesh.evaluate("auto").component("mask");
        let share = |is_meant: fn(f32) -> bool| {
            let meant: Vec<f32> = mask.iter().map(|value| f32::from(u8::from(is_meant(*value)))).collect();
            on_mesh.mean(&meant)
        };
        let (black, white) = (share(|value| value <= 0.0), share(|value| value >= 1.0));
        assert!(
            (black - 0.1).abs() < 0.003 && (white - 0.2).abs() < 0.003,
            "{mesh}: {black}, {white}"
        );
    }
}

/// Means of a mask over the groups of an id mask, with the share of the surface that each has.
fn means(on_mesh: &mut OnMesh, node: &str) -> Vec<(f64, f64)> {
    let [ids, mask] = ["ids.id", node].map(|port| on_mesh.evaluate(port).component("mask"));
    let mut groups: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
    let areas = on_mesh.areas();
    let whole: f64 = areas.iter().map(|(_, area)| area).sum();
    for (index, area) in areas {
        let group = groups.entry(ids[index].to_bits()).or_default();
        group.0 += area * f64::from(mask[index]);
        group.1 += area;
    }
    groups
        .into_values()
        .map(|(sum, area)| (sum / area, area / whole))
        .collect()
}

#[test]
fn each_part_piece_and_chart_gets_the_share_that_is_asked_for() {
    let height = r#""height": { "kind": "surface/position", "params": { "along": [0.2, 1, 0.1] } }"#;
    for (mesh, each) in [
        ("chain", "part"),
        ("chain", "piece"),
        ("crate", "piece"),
        ("cube", "chart"),
    ] {
        let nodes = format!(
            r#"{height}, "ids": {{ "kind": "surface/id", "params": {{ "by": "{each}" }} }},
            "whole": {{ "kind": "adjust/coverage", "inputs": {{ "source": "height" }}, "params": {{ "amount": 0.3 }} }},
            "apart": {{ "kind": "adjust/coverage", "inputs": {{ "source": "height" }},
                "params": {{ "amount": 0.3, "each": "{each}" }} }},
            "stretched": {{ "kind": "adjust/auto_levels", "inputs": {{ "source": "height" }},
                "params": {{ "each": "{each}" }} }},
            "even": {{ "kind": "adjust/match", "inputs": {{ "source": "height" }},
                "params": {{ "mean": 0.4, "spread": 0.2, "each": "{each}" }} }}"#
        );
        let mut on_mesh = on(mesh, 512, &nodes);
        let apart = means(&mut on_mesh, "apart");
        assert!(apart.len() > 1 || each == "part", "{mesh} has one {each}");
        for (mean, share) in apart {
            // A group of few texels cannot be cut exactly.
            let allowed = 0.01 + 1e-4 / share;
            assert!(
                (mean - 0.3).abs() < allowed,
                "{each} of {mesh}: {mean} covered, {share} of the surface"
            );
        }
        for (mean, share) in means(&mut on_mesh, "even") {
            assert!(
                (mean - 0.4).abs() < 0.02 + 1e-4 / share,
                "{each} of {mesh}: mean {mean} of {share}"
            );
        }
        let whole = means(&mut on_mesh, "whole");
        let spread = whole.iter().map(|(mean, _)| (mean - 0.3).abs()).fold(0.0, f64::max);
        assert!(
            spread > 0.1 || whole.len() == 1,
            "measured together, they differ: {spread}"
        );
    }
}

#[test]
fn one_piece_measured_apart_is_the_whole_surface_to_the_last_bit() {
    for each in ["part", "piece"] {
        let nodes = format!(
            r#""height": {{ "kind": "noise/simplex" }},
            "whole": {{ "kind": "adjust/coverage", "inputs": {{ "source": "height" }} }},
            "apart": {{ "kind": "adjust/coverage", "inputs": {{ "source": "height" }}, "params": {{ "each": "{each}" }} }}"#
        );
        let mut on_mesh = on("sphere", 128, &nodes);
        let [whole, apart] = ["whole", "apart"].map(|node| on_mesh.evaluate(node).bytes());
        assert_eq!(whole, apart, "{each}");
    }
}

#[test]
fn a_matched_mask_has_the_mean_and_the_spread_that_are_asked_for() {
    for mesh in ["bench", "cube"] {
        for (mean, spread) in [(0.5, 0.2), (0.3, 0.1), (0.6, 0.3), (0.5, 0.0)] {
            for flatten in [0.0, 1.0] {
                let nodes = format!(
                    r#""source": {{ "kind": "noise/simplex", "params": {{ "size": 0.2 }} }},
                    "match": {{ "kind": "adjust/match", "inputs": {{ "source": "source" }},
                        "params": {{ "mean": {mean}, "spread": {spread}, "flatten": {flatten} }} }}"#
                );
                let mut on_mesh = on(mesh, 256, &nodes);
                let mask = on_mesh.evaluate("match").component("mask");
                let is_mean = on_mesh.mean(&mask);
                let squares: Vec<f32> = mask.iter().map(|value| value * value).collect();
                let is_spread = (on_mesh.mean(&squares) - is_mean * is_mean).max(0.0).sqrt();
                assert!(
                    (is_mean - mean).abs() < 0.01 && (is_spread - spread).abs() < 0.01,
                    "{mesh}, flattened by {flatten}: {is_mean} ± {is_spread} for {mean} ± {spread}"
                );
            }
        }
    }
}
