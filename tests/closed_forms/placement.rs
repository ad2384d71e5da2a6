//! The surface of a model is independent of the model's place in its scene and of the unit.

use glam::DVec3;
use sabi_tests::shapes::{PatchDivision, cube};
use sabi_tests::{MeshFile, OnMesh, Quad};
use serde_json::{Value, json};

/// Results that depend only on the surface: rays, and filters of a mask that is computed from normals.
const RESULTS: [&str; 6] = ["occlusion", "curvature", "thickness", "edges", "blur", "distance"];

const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "up": { "kind": "surface/direction", "params": { "toward": [0.3, 1, 0.2], "reach": 120 } },
    "occlusion": { "kind": "surface/occlusion", "params": { "distance": 0.3 } },
    "curvature": { "kind": "surface/curvature", "params": { "radius": 0.1 } },
    "thickness": { "kind": "surface/thickness", "params": { "distance": 0.5 } },
    "edges": { "kind": "surface/edges", "params": { "width": 0.05 } },
    "blur": { "kind": "filter/blur", "inputs": { "source": "up" }, "params": { "radius": 0.1 } },
    "distance": { "kind": "filter/distance", "inputs": { "source": "up" }, "params": { "width": 0.4 } } } }"#;

/// A cube that stands through a corner of another, placed as its node says.
fn placed(node: Value) -> OnMesh {
    let offsets = [DVec3::ZERO, DVec3::new(0.4, 0.3, 0.2)];
    let cubes = offsets.into_iter().enumerate().flat_map(|(half, by)| {
        cube(PatchDivision::scattered(4, 3)).into_iter().map(move |quad| Quad {
            corners: quad
                .corners
                .map(|corner| (DVec3::from(corner.map(f64::from)) + by).as_vec3().to_array()),
            uvs: quad.uvs.map(|[u, v]| [0.5 * (u + half as f32), v]),
        })
    });
    let file = MeshFile {
        node,
        ..MeshFile::new(cubes.collect())
    };
    OnMesh::new(GRAPH, file.write().path(), 128)
}

#[test]
fn a_model_in_other_units_or_elsewhere_has_the_same_surface() {
    let mut first = placed(Value::Null);
    let expected = RESULTS.map(|result| first.evaluate(result).component("mask"));
    // Means of what differs. Rounding of places shows in blurs most, by a millionth of their range. Until a model is so far
    // away that it is brought to the middle, rays start the higher above it the further away it is: here by 0.00015 of its
    // size.
    for (node, most) in [
        (json!({ "scale": [1000, 1000, 1000] }), 5e-6),
        (json!({ "scale": [0.001, 0.001, 0.001] }), 5e-6),
        (json!({ "translation": [10, 20, 30] }), 3e-4),
        (json!({ "translation": [10000, 0, 0] }), 5e-6),
        (json!({ "translation": [-10000, 10000, 10000] }), 5e-6),
    ] {
        let mut other = placed(node.clone());
        for (result, expected) in RESULTS.iter().zip(&expected) {
            let found = other.evaluate(result).component("mask");
            let differences = first
                .owned()
                .map(|(index, _)| f64::from((found[index] - expected[index]).abs()));
            let (sum, count) = differences.fold((0.0, 0.0), |(sum, count), more| (sum + more, count + 1.0));
            assert!(
                sum <= most * count,
                "{node}: {result} differs by {} in the mean",
                sum / count
            );
        }
    }
}
