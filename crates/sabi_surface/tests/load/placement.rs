//! Nodes place meshes, and options turn and scale the whole.

use std::f32::consts::FRAC_1_SQRT_2;

use sabi_surface::load::{LoadOptions, Up};
use serde_json::json;

use crate::builder::Gltf;

fn face_normal(mesh: &sabi_surface::model::Mesh, triangle: usize) -> [f32; 3] {
    let [a, b, c] = mesh.triangles[triangle].map(|vertex| glam::Vec3::from(mesh.positions[vertex as usize]));
    (b - a).cross(c - a).normalize().into()
}

#[test]
fn nodes_compose_and_name_the_parts() {
    let mut file = Gltf::triangle();
    file.json["nodes"] = json!([
        { "children": [1, 2], "translation": [0, 0, 5], "scale": [2, 2, 2] },
        { "mesh": 0, "name": "near", "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2] },
        { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1] }
    ]);
    let model = file.model();
    assert_eq!(model.parts, ["near", "leaf"]);
    assert_eq!(model.mesh.triangle_part, [0, 1]);
    let expected = [
        [0.0, 0.0, 5.0],
        [0.0, 2.0, 5.0],
        [-2.0, 0.0, 5.0],
        [20.0, 0.0, 5.0],
        [22.0, 0.0, 5.0],
        [20.0, 2.0, 5.0],
    ];
    for (position, expected) in model.mesh.positions.iter().zip(expected) {
        assert!(
            glam::Vec3::from(*position).abs_diff_eq(expected.into(), 1e-6),
            "{position:?} is not {expected:?}"
        );
    }
}

#[test]
fn a_model_far_away_is_brought_to_the_middle_and_keeps_its_shape() {
    let shape = Gltf::triangle().model().mesh;
    for (translation, middle) in [
        ([60.0, 0.0, 0.0], [0.0; 3]),
        ([3e6, -5e6, 0.0], [3e6 + 0.5, -5e6 + 0.5, 0.0]),
    ] {
        let mut file = Gltf::triangle();
        file.json["nodes"][0]["translation"] = json!(translation);
        let model = file.model();
        assert_eq!(model.middle, middle);
        for (moved, own) in model.mesh.positions.iter().zip(&shape.positions) {
            let expected: [f64; 3] =
                std::array::from_fn(|axis| f64::from(own[axis]) + translation[axis] - middle[axis]);
            assert_eq!(moved.map(f64::from), expected);
        }
    }
}

#[test]
fn a_mirrored_instance_keeps_its_outside_out_and_its_texture_mirrored() {
    let mut file = Gltf::triangle();
    file.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    let mesh = file.model().mesh;
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(face_normal(&mesh, 0), [0.0, 0.0, 1.0]);
    // u grows towards -x, v upward in the picture still towards +y: cross(normal, tangent) × w must be +y.
    assert_eq!(mesh.tangents, [[-1.0, 0.0, 0.0, -1.0]; 3]);
}

#[test]
fn normals_stay_upright_under_an_uneven_scale() {
    let mut file = Gltf::new();
    let slope = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, -1.0]);
    file.place("slope", json!({ "attributes": { "POSITION": slope } }));
    file.json["nodes"][0]["scale"] = json!([1, 3, 1]);
    let mesh = file.model().mesh;
    let dot = glam::Vec3::from(mesh.normals[0]).dot(face_normal(&mesh, 0).into());
    assert!(dot > 0.999_999, "{dot}");
}

#[test]
fn the_up_axis_becomes_y_and_the_scale_applies() {
    for (up, expected) in [
        (Up::Y, [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]),
        (Up::Z, [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]]),
        (Up::X, [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [-2.0, 0.0, 0.0]]),
    ] {
        let options = LoadOptions {
            up,
            scale: 2.0,
            ..LoadOptions::default()
        };
        let mesh = Gltf::triangle().load_with(&options).unwrap().mesh;
        assert_eq!(mesh.positions, expected, "{up:?}");
        let dot = glam::Vec3::from(mesh.normals[0]).dot(face_normal(&mesh, 0).into());
        assert!(dot > 0.999_999, "{up:?}: turned, not mirrored");
    }
}

#[test]
fn the_default_scene_is_shown_else_the_first_else_all_roots() {
    let mut file = Gltf::triangle();
    file.json["nodes"] =
        json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b", "children": [2] }, { "mesh": 0, "name": "c" }]);
    assert_eq!(file.model().parts, ["a", "b", "c"]);
    file.json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1] }]);
    assert_eq!(file.model().parts, ["a"]);
    file.json["scene"] = json!(1);
    assert_eq!(file.model().parts, ["b", "c"]);
}

#[test]
fn meshes_without_nodes_are_taken_as_they_are() {
    let mut file = Gltf::triangle();
    file.json["nodes"] = json!([]);
    let model = file.model();
    assert_eq!(model.parts, ["leaf"]);
    assert_eq!(
        model.warnings,
        ["The file's scene shows no mesh; all meshes are taken as they are stored."]
    );
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_is_followed() {
    let mut file = Gltf::triangle();
    let last = 100_000;
    let mut nodes: Vec<_> = (1..=last).map(|child| json!({ "children": [child] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    file.json["nodes"] = json!(nodes);
    assert_eq!(file.model().mesh.triangles.len(), 1);
}

#[test]
fn further_scenes_are_told_and_can_be_chosen() {
    let mut file = Gltf::triangle();
    file.json["nodes"] = json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b" }]);
    file.json["scenes"] = json!([{ "nodes": [0], "name": "day" }, { "nodes": [1] }]);
    let told = ["The file has 2 scenes, and scene 0 (`day`) is taken; the other is 1."];
    assert_eq!(file.model().warnings, told);
    let chosen = |scene| {
        file.load_with(&LoadOptions {
            scene: Some(scene),
            ..LoadOptions::default()
        })
    };
    let night = chosen(1).unwrap();
    assert_eq!((night.parts, night.warnings), (vec!["b".to_owned()], vec![]));
    assert_eq!(
        chosen(2).unwrap_err().to_string(),
        "test.glb: it has no scene 2; it has 0 (`day`) and 1"
    );
}

#[test]
fn of_a_name_that_many_nodes_share_each_part_has_a_beginning() {
    let mut file = Gltf::triangle();
    file.json["meshes"][0]["name"] = json!(format!("{}ä", "n".repeat(255)));
    let mesh = file.json["nodes"][0]["mesh"].clone();
    file.json["nodes"] = json!([{ "mesh": mesh }, { "mesh": mesh, "name": "own" }]);
    assert_eq!(file.model().parts, ["n".repeat(255), "own".to_owned()]);
}
