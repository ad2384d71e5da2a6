//! Masks that are linked to parameters multiply them at each place.

use sabi_nodes::Library;
use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, OnMesh, project};
use serde_json::{Value, json};

use crate::specimens::{for_each, on_own_mesh};

/// Adds a mask of 1 everywhere to a graph, and links it to parameters of `node`.
fn with_mask_of_one(graph: &str, params: &[&str]) -> String {
    let mut graph: Value = serde_json::from_str(graph).expect("a graph");
    graph["nodes"]["param_mask"] = json!({ "kind": "adjust/invert", "params": { "source": 0 } });
    for param in params {
        graph["nodes"]["node"]["inputs"][*param] = json!("param_mask");
    }
    graph.to_string()
}

#[test]
fn a_mask_of_one_leaves_every_parameter_as_it_is() {
    let library = Library::builtin();
    let mut count = 0;
    for_each(|specimen| {
        let kind = library.kind(&specimen.kind).expect("a built-in kind");
        let params = kind.params.iter().filter(|param| param.takes_mask);
        let params: Vec<&str> = params.map(|param| param.name.as_str()).collect();
        if params.is_empty() {
            return Ok(());
        }
        count += 1;
        let mut on_mesh = on_own_mesh(&specimen.alone, "cube", 32);
        let without = on_mesh.evaluate(&specimen.target()).bytes();
        on_mesh.set_graph(&with_mask_of_one(&specimen.alone, &params));
        let with = on_mesh.evaluate(&specimen.target()).bytes();
        (without == with)
            .then_some(())
            .ok_or_else(|| format!("a mask changes it, linked to {}", params.join(", ")))
    });
    assert!(count > 60, "only {count} results have a parameter that takes a mask");
}

/// A ramp from 0 at the bottom to 1 at the top, and a node of every shape with a parameter that the ramp multiplies.
const RAMPED: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "ramp": { "kind": "surface/position" },
    "one": { "kind": "adjust/invert", "params": { "source": 0 } },
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.3 } },
    "point": { "kind": "adjust/remap", "inputs": { "source": "one", "to_high": "ramp" }, "params": { "to_high": 0.8 } },
    "sharp": { "kind": "filter/sharpen", "inputs": { "source": "clouds" }, "params": { "amount": 2 } },
    "field": { "kind": "filter/sharpen", "inputs": { "source": "clouds", "amount": "ramp" }, "params": { "amount": 2 } },
    "soft": { "kind": "surface/edges", "params": { "width": 0.2, "softness": 1, "rays": 64 } },
    "ray": { "kind": "surface/edges", "params": { "width": 0.2, "softness": 1, "rays": 64 }, "inputs": { "softness": "one" } }
} }"#;

#[test]
fn a_ramp_multiplies_a_parameter_of_points_and_fields_in_all_modes() {
    let mut on_mesh = OnMesh::new(RAMPED, &project("assets/meshes/crate.glb"), 128);
    let mask = |on_mesh: &mut OnMesh, node: &str| on_mesh.evaluate(node).component("mask");
    let [ramp, clouds, sharp] = ["ramp", "clouds", "sharp"].map(|node| mask(&mut on_mesh, node));
    for mode in [Mode::Bake { fuse: true }, Mode::Bake { fuse: false }, Mode::Interactive] {
        let mut asked_for = |node: &str| {
            on_mesh
                .evaluate_as(node, EvaluationOptions { mode, cache: None })
                .component("mask")
        };
        let [point, field] = ["point", "field"].map(&mut asked_for);
        for (index, _) in on_mesh.owned() {
            let expected = 0.8 * ramp[index].clamp(0.0, 1.0);
            assert!(
                (point[index] - expected).abs() < 1e-5,
                "{} is not {expected}",
                point[index]
            );
            let expected = clouds[index] + ramp[index].clamp(0.0, 1.0) * (sharp[index] - clouds[index]);
            assert!(
                (field[index] - expected).abs() < 1e-4,
                "{} is not {expected}",
                field[index]
            );
        }
    }
    let [soft, ray] = ["soft", "ray"].map(|node| mask(&mut on_mesh, node));
    assert_eq!(soft, ray);
}
