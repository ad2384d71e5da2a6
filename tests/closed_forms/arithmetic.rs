//! Every operation of the nodes that calculate, compared with the same operation in Rust.

use std::f64::consts::TAU;

use glam::DVec3;
use sabi_tests::{OnMesh, project};
use serde_json::{Value, json};

/// Three ramps over the cube, from -2 to 2, in different directions.
fn on_cube(
    kind: &str,
    params: &Value,
    inputs: &Value,
    port: &str,
    names: &[&str],
) -> (OnMesh, Vec<Vec<f32>>, [Vec<f32>; 3]) {
    let ramp = |along: [f64; 3]| json!({ "kind": "surface/position", "params": { "along": along } });
    let wide = |source: &str| {
        json!({
            "kind": "adjust/remap", "inputs": { "source": source }, "params": { "to_low": -2, "to_high": 2 },
        })
    };
    let nodes = json!({
        "x": ramp([1.0, 0.2, 0.1]), "y": ramp([0.1, 1.0, -0.3]), "z": ramp([-0.2, 0.3, 1.0]),
        "a": wide("x"), "b": wide("y"), "c": wide("z"),
        "v": { "kind": "vector/combine", "inputs": { "x": "a", "y": "b", "z": "c" } },
        "w": { "kind": "vector/combine", "inputs": { "x": "c", "y": "a", "z": "b" } },
        "node": { "kind": kind, "params": params, "inputs": inputs },
    });
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string();
    let mut on_mesh = OnMesh::new(&graph, &project("assets/meshes/cube.glb"), 96);
    let ramps = ["a", "b", "c"].map(|name| on_mesh.evaluate(name).component("mask"));
    let result = on_mesh.evaluate(port);
    let components = names.iter().map(|name| result.component(name)).collect();
    (on_mesh, components, ramps)
}

type OfThree = fn(f64, f64, f64) -> f64;

const OPERATIONS: [(&str, OfThree); 21] = [
    ("add", |a, b, _| a + b),
    ("subtract", |a, b, _| a - b),
    ("multiply", |a, b, _| a * b),
    ("divide", |a, b, _| a / b),
    ("power", |a, b, _| a.abs().powf(b)),
    ("min", |a, b, _| a.min(b)),
    ("max", |a, b, _| a.max(b)),
    ("modulo", |a, b, _| a - b * (a / b).floor()),
    ("greater", |a, b, _| f64::from(u8::from(a > b))),
    ("mix", |a, b, c| a + (b - a) * c),
    ("smoothstep", |a, b, c| {
        let t = ((a - c) / (b - c)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }),
    ("wrap", |a, b, c| a - (b - c) * ((a - c) / (b - c)).floor()),
    ("absolute", |a, _, _| a.abs()),
    ("negate", |a, _, _| -a),
    ("sign", |a, _, _| if a == 0.0 { 0.0 } else { a.signum() }),
    ("floor", |a, _, _| a.floor()),
    ("round", |a, _, _| (a + 0.5).floor()),
    ("fraction", |a, _, _| a - a.floor()),
    ("square_root", |a, _, _| a.max(0.0).sqrt()),
    ("sine", |a, _, _| (TAU * a).sin()),
    ("cosine", |a, _, _| (TAU * a).cos()),
];

#[test]
fn every_operation_on_masks_is_its_formula() {
    let inputs = json!({ "a": "a", "b": "b", "c": "c" });
    for (operation, formula) in OPERATIONS {
        let params = json!({ "operation": operation });
        let (on_mesh, values, [a, b, c]) = on_cube("math/mask", &params, &inputs, "node", &["mask"]);
        let mut counted = 0;
        for (index, _) in on_mesh.owned() {
            let [a, b, c] = [&a, &b, &c].map(|ramp| f64::from(ramp[index]));
            let expected = formula(a, b, c);
            // Near a jump or a pole of a formula, the result depends on the last bit of an input.
            let around = [-1e-5, 1e-5].map(|step| formula(a + step, b - step, c + 0.5 * step));
            let is_smooth = around
                .into_iter()
                .all(|near| (near - expected).abs() < 1e-2 * expected.abs().max(1.0));
            if !is_smooth || expected.abs() > 1e3 {
                continue;
            }
            counted += 1;
            let off = (f64::from(values[0][index]) - expected).abs();
            assert!(
                off < 2e-4 * expected.abs().max(1.0),
                "{operation} of {a}, {b}, {c}: {} for {expected}",
                values[0][index]
            );
        }
        assert!(counted > 1000, "{operation}: {counted} places");
    }
}

#[test]
fn every_operation_on_vectors_is_its_formula() {
    type OfTwo = fn(DVec3, DVec3, f64, DVec3) -> DVec3;
    let operations: [(&str, OfTwo); 12] = [
        ("add", |a, b, _, _| a + b),
        ("subtract", |a, b, _, _| a - b),
        ("multiply", |a, b, _, _| a * b),
        ("scale", |a, _, factor, _| a * factor),
        ("mix", |a, b, factor, _| a + (b - a) * factor),
        ("min", |a, b, _, _| a.min(b)),
        ("max", |a, b, _, _| a.max(b)),
        ("cross", |a, b, _, _| a.cross(b)),
        ("normalize", |a, _, _, _| a.normalize_or_zero()),
        ("project", |a, _, _, normal| a - normal * a.dot(normal)),
        ("project_on_b", |a, b, _, _| {
            b.normalize_or_zero() * a.dot(b.normalize_or_zero())
        }),
        ("rotate", |a, b, factor, _| {
            glam::DQuat::from_axis_angle(b.normalize(), 0.25 * TAU * factor) * a
        }),
    ];
    let inputs = json!({ "a": "v", "b": "w", "factor": "x" });
    let names = ["vector.x", "vector.y", "vector.z"];
    for (operation, formula) in operations {
        let params = json!({ "operation": operation });
        let (mut on_mesh, values, [a, b, c]) = on_cube("math/vector", &params, &inputs, "node.vector", &names);
        let factor = on_mesh.evaluate("x").component("mask");
        for (index, triangle) in on_mesh.owned() {
            let [a, b, c] = [&a, &b, &c].map(|ramp| f64::from(ramp[index]));
            let [_, x, y] = on_mesh.texel(index);
            let normal = on_mesh.frame_at(triangle, glam::dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5))[2].normalize();
            let expected = formula(
                DVec3::new(a, b, c),
                DVec3::new(c, a, b),
                f64::from(factor[index]),
                normal,
            );
            let is = DVec3::from([0, 1, 2].map(|axis: usize| f64::from(values[axis][index])));
            assert!(
                (is - expected).length() < 1e-3,
                "{operation} at {a}, {b}, {c}: {is} for {expected}"
            );
        }
    }
}

#[test]
fn the_default_rotation_of_a_vector_is_a_right_angle() {
    for (params, expected) in [
        (
            json!({ "operation": "rotate", "a": [1, 0, 0], "b": [0, 2, 0] }),
            DVec3::NEG_Z,
        ),
        (
            json!({ "operation": "rotate", "a": [1, 0, 0], "b": [0, 2, 0], "angle": 180 }),
            DVec3::NEG_X,
        ),
        (
            json!({ "operation": "rotate", "a": [1, 0, 0], "b": [0, 2, 0], "angle": 360, "factor": 0.25 }),
            DVec3::NEG_Z,
        ),
    ] {
        let names = ["vector.x", "vector.y", "vector.z"];
        let (on_mesh, values, _) = on_cube("math/vector", &params, &json!({}), "node.vector", &names);
        let (index, _) = on_mesh.owned().next().expect("a texel");
        let is = DVec3::from([0, 1, 2].map(|axis: usize| f64::from(values[axis][index])));
        assert!((is - expected).length() < 1e-4, "{is} for {expected}");
    }
}
