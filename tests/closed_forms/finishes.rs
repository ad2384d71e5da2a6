//! Clear coats, sheen and fine scratches where two materials meet, and below a layer.

use sabi_tests::{NodeResult, OnMesh, project};
use serde_json::{Value, json};

/// A layer over another one; the mask of the upper one is a ramp from 0 to 1 up the cube.
fn layered(lower: &Value, upper: &Value) -> (OnMesh, NodeResult, Vec<f32>) {
    let nodes = json!({
        "ramp": { "kind": "surface/position" },
        "lower": { "kind": "effect/layer", "params": lower },
        "upper": { "kind": "effect/layer", "params": upper, "inputs": { "base": "lower", "mask": "ramp" } },
    });
    on_cube(&nodes, "upper")
}

fn on_cube(nodes: &Value, node: &str) -> (OnMesh, NodeResult, Vec<f32>) {
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string();
    let mut on_mesh = OnMesh::new(&graph, &project("assets/meshes/cube.glb"), 128);
    let ramp = on_mesh.evaluate("ramp").component("mask");
    let result = on_mesh.evaluate(node);
    (on_mesh, result, ramp)
}

/// Returns the largest difference of a component from its expected value for the value of the ramp, on texels that have one.
fn off(on_mesh: &OnMesh, values: &[f32], ramp: &[f32], expected: impl Fn(f32) -> Option<f32>) -> f32 {
    let mut largest = 0.0_f32;
    for (index, _) in on_mesh.owned() {
        if let Some(expected) = expected(ramp[index]) {
            largest = largest.max((values[index] - expected).abs());
        }
    }
    largest
}

#[test]
fn a_coat_that_fades_out_keeps_its_roughness() {
    let coated = json!({ "coat": 1, "coat_roughness": 0.3 });
    for (lower, upper, coat) in [
        (&coated, &json!({}), (|t| 1.0 - t) as fn(f32) -> f32),
        (&json!({}), &coated, |t| t),
        (&coated, &json!({ "coat": 0.5, "coat_roughness": 0.3 }), |t| {
            1.0 - 0.5 * t
        }),
    ] {
        let (on_mesh, result, ramp) = layered(lower, upper);
        let [share, rough] = ["coat", "coat_roughness"].map(|name| result.component(name));
        assert!(off(&on_mesh, &share, &ramp, |t| Some(coat(t))) < 2e-3);
        // Where no coat is left it has no roughness.
        let wrong = off(&on_mesh, &rough, &ramp, |t| (coat(t) > 0.01).then_some(0.3));
        assert!(wrong < 2e-3, "{lower} below {upper}: {wrong}");
    }
}

#[test]
fn two_coats_mix_their_roughness_by_how_much_there_is_of_each() {
    let (lower, upper) = (
        json!({ "coat": 0.25, "coat_roughness": 0.1 }),
        json!({ "coat": 1, "coat_roughness": 0.5 }),
    );
    let (on_mesh, result, ramp) = layered(&lower, &upper);
    let rough = result.component("coat_roughness");
    let mean = |t: f32| (0.25 * (1.0 - t) * 0.1 + t * 0.5) / (0.25 * (1.0 - t) + t);
    let wrong = off(&on_mesh, &rough, &ramp, |t| Some(mean(t)));
    assert!(wrong < 2e-3, "{wrong}");
}

#[test]
fn sheen_that_fades_out_keeps_its_reach() {
    let (lower, upper) = (json!({ "sheen": "#ffffff", "sheen_roughness": 0.6 }), json!({}));
    let (on_mesh, result, ramp) = layered(&lower, &upper);
    let wrong = off(&on_mesh, &result.component("sheen_roughness"), &ramp, |t| {
        (t < 0.99).then_some(0.6)
    });
    assert!(wrong < 2e-3, "{wrong}");
}

#[test]
fn blended_materials_keep_the_roughness_of_a_coat_that_one_of_them_has() {
    let nodes = json!({
        "ramp": { "kind": "surface/position" },
        "coated": { "kind": "effect/layer", "params": { "coat": 1, "coat_roughness": 0.3, "sheen": "#ffffff" } },
        "bare": { "kind": "source/material" },
        "both": { "kind": "material/blend", "inputs": { "below": "coated", "above": "bare", "mask": "ramp" } },
    });
    let (on_mesh, result, ramp) = on_cube(&nodes, "both");
    for (name, expected) in [("coat_roughness", 0.3), ("sheen_roughness", 0.4)] {
        let wrong = off(&on_mesh, &result.component(name), &ramp, |t| {
            (t < 0.99).then_some(expected)
        });
        assert!(wrong < 2e-3, "{name}: {wrong}");
    }
}

/// Lengths of the direction of fine scratches.
fn strengths(on_mesh: &OnMesh, result: &NodeResult) -> Vec<f32> {
    let [x, y, z] = ["anisotropy.x", "anisotropy.y", "anisotropy.z"].map(|name| result.component(name));
    let length = |index: usize| (x[index] * x[index] + y[index] * y[index] + z[index] * z[index]).sqrt();
    on_mesh.owned().map(|(index, _)| length(index)).collect()
}

#[test]
fn opposite_directions_of_scratches_are_one() {
    let brushed = |way: [f64; 3]| json!({ "anisotropy": 0.8, "anisotropy_direction": way });
    let (on_mesh, result, _) = layered(&brushed([0.0, 1.0, 0.0]), &brushed([0.0, -1.0, 0.0]));
    let [low, high] = sabi_tests::extent(strengths(&on_mesh, &result));
    assert!(low > 0.799 && high < 0.801, "{low} to {high}");
}

#[test]
fn scratches_without_a_direction_follow_the_texture_coordinates() {
    let nodes = json!({
        "ramp": { "kind": "surface/position" },
        "brushed": { "kind": "effect/layer", "params": { "anisotropy": 0.8 } },
    });
    let (on_mesh, result, _) = on_cube(&nodes, "brushed");
    let ways = ["anisotropy.x", "anisotropy.y", "anisotropy.z"].map(|name| result.component(name));
    for (index, triangle) in on_mesh.owned() {
        let [_, x, y] = on_mesh.texel(index);
        let here = glam::dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let tangent = on_mesh.frame_at(triangle, here)[0].normalize();
        let way = glam::DVec3::from(ways.each_ref().map(|part| f64::from(part[index])));
        assert!((way - 0.8 * tangent).length() < 2e-3, "{way} along {tangent}");
    }
}

#[test]
fn a_tint_leaves_the_clear_coat_below_and_paint_covers_it() {
    let varnished =
        json!({ "coat": 1, "coat_roughness": 0.1, "sheen": "#ffffff", "subsurface": "#ffffff", "anisotropy": 0.5 });
    let names = ["coat", "sheen.r", "subsurface.r"];
    let tint = json!({ "color": "#ff0000", "color_mode": "multiply", "roughness_on": false });
    let dulled = json!({ "color_on": false, "roughness": 0.2, "roughness_mode": "add" });
    let paint = json!({ "color": "#ff0000" });
    let covering =
        json!({ "color": "#ff0000", "color_mode": "multiply", "roughness_on": false, "finish_mode": "cover" });
    let kept = json!({ "color": "#ff0000", "finish_mode": "keep" });
    for (upper, is_kept) in [
        (&tint, true),
        (&dulled, true),
        (&paint, false),
        (&covering, false),
        (&kept, true),
    ] {
        let (on_mesh, result, ramp) = layered(&varnished, upper);
        for name in names {
            let wrong = off(&on_mesh, &result.component(name), &ramp, |t| {
                Some(if is_kept { 1.0 } else { 1.0 - t })
            });
            assert!(wrong < 2e-3, "{name} below {upper}: {wrong}");
        }
        let strengths = strengths(&on_mesh, &result);
        let [low, _] = sabi_tests::extent(strengths);
        assert_eq!(low > 0.45, is_kept, "scratches below {upper}: {low}");
    }
}
