//! A length has the same meaning in every unit in which a graph is written.

use sabi_engine::Kinds;
use sabi_graph::Fit;
use sabi_nodes::kind::Role;
use sabi_tests::{OnMesh, project, range};
use serde_json::json;

/// Two layers with relief; `unit` is how many of the graph's units the length 1 of `"fit": "unit"` is.
fn graph(fit: &str, mode: &str, unit: f64) -> String {
    let base = json!({ "color": "#808080", "height": 0.03 * unit });
    let upper = json!({ "height": 0.02 * unit, "height_mode": mode });
    let clouds = json!({ "size": 0.4 * unit, "octaves": 2 });
    json!({ "format": "sabi", "version": 1, "fit": fit, "nodes": {
        "clouds": { "kind": "noise/simplex", "params": clouds },
        "base": { "kind": "effect/layer", "params": base, "inputs": { "height_map": "clouds" } },
        "upper": { "kind": "effect/layer", "params": upper, "inputs": { "base": "base", "mask": "clouds" } },
    } })
    .to_string()
}

/// Heights in the model's own unit.
fn heights(written_fit: &str, fit: Fit, mode: &str, unit: f64) -> (OnMesh, Vec<f32>) {
    let mut on_mesh = OnMesh::new(
        &graph(written_fit, mode, unit),
        &project("assets/meshes/bench.glb"),
        128,
    );
    let scale = on_mesh.evaluator.linked().fitted(fit).working_from_model() as f32;
    let heights = on_mesh.evaluate("upper").component("height");
    let heights = heights.into_iter().map(|height| height / scale).collect();
    (on_mesh, heights)
}

#[test]
fn a_relief_is_the_same_whatever_unit_it_is_given_in() {
    let kinds = Kinds::builtin();
    let layer = kinds.library.kind("effect/layer").expect("the layer");
    let mode = layer.params.iter().find(|param| param.name == "height_mode");
    let Some(Role::Choice(modes)) = mode.map(|param| &param.ty.role) else {
        panic!("the layer offers no modes for the height");
    };
    assert!(modes.len() > 3, "{modes:?}");
    for mode in modes {
        let (on_mesh, by_unit) = heights("unit", Fit::Unit, mode, 1.0);
        let side = 1.0 / on_mesh.evaluator.linked().fitted(Fit::Unit).working_from_model();
        assert!((side - 1.0).abs() > 0.1, "a model of side {side} shows nothing");
        let (_, by_metres) = heights("metres", Fit::Metres, mode, side);
        let whole = range(on_mesh.owned().map(|(index, _)| by_unit[index]));
        assert!(whole > 1e-3 && whole < side, "{mode}: the heights range over {whole}");
        for (index, _) in on_mesh.owned() {
            let difference = f64::from((by_unit[index] - by_metres[index]).abs());
            assert!(
                difference <= 1e-3 * whole,
                "{mode}: {} differs from {}",
                by_unit[index],
                by_metres[index]
            );
        }
    }
}

#[test]
fn each_height_mode_does_what_its_name_says() {
    let expected = [
        ("normal", 0.02),
        ("add", 0.05),
        ("subtract", 0.01),
        ("min", 0.02),
        ("max", 0.03),
        ("difference", 0.01),
    ];
    for (mode, height) in expected {
        let text = json!({ "format": "sabi", "version": 1, "nodes": {
            "base": { "kind": "effect/layer", "params": { "height": 0.03 } },
            "upper": { "kind": "effect/layer", "inputs": { "base": "base" },
                       "params": { "height": 0.02, "height_mode": mode } },
        } });
        let mut on_mesh = OnMesh::new(&text.to_string(), &project("assets/meshes/cube.glb"), 32);
        let heights = on_mesh.evaluate("upper").component("height");
        for (index, _) in on_mesh.owned() {
            assert!(
                (heights[index] - height).abs() < 1e-6,
                "{mode} gives {}, not {height}",
                heights[index]
            );
        }
    }
}

#[test]
fn a_length_by_the_piece_is_multiplied_by_the_size_of_the_piece() {
    let text = json!({ "format": "sabi", "version": 1, "fit": "piece", "nodes": {
        "raised": { "kind": "effect/layer", "params": { "height": 0.1 } },
    } });
    let mut on_mesh = OnMesh::new(&text.to_string(), &project("assets/meshes/bench.glb"), 128);
    let heights = on_mesh.evaluate("raised").component("height");
    let linked = on_mesh.evaluator.linked();
    let scale = linked.fitted(Fit::Piece).working_from_model() as f32;
    let expected: Vec<f32> = linked
        .pieces
        .boxes
        .iter()
        .map(|piece| 0.1 * piece.typical_size() * scale)
        .collect();
    let close = |a: f32, b: f32| (a - b).abs() <= 1e-4 * b;
    let mut seen = vec![false; expected.len()];
    for (index, _) in on_mesh.owned() {
        let height = heights[index];
        assert!(
            expected.iter().any(|size| close(height, *size)),
            "no piece gives {height}"
        );
        for (seen, size) in seen.iter_mut().zip(&expected) {
            *seen |= close(height, *size);
        }
    }
    let sizes = range(expected.iter().copied());
    assert!(
        sizes > 0.5 * f64::from(expected[0]),
        "the sizes of the pieces range over {sizes} only"
    );
    assert!(seen.iter().all(|seen| *seen), "{seen:?}");
}
