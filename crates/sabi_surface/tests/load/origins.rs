//! Every vertex and triangle knows its place in the file.

use std::collections::BTreeSet;

use sabi_surface::load::{LoadOptions, Up};
use sabi_surface::model::{FileOrigins, Model};
use serde_json::{Value, json};

use crate::builder::{Gltf, U16, shorts};

const STRIP: [[f32; 3]; 6] = [
    // Used by no triangle.
    [9.0, 9.0, 9.0],
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.5],
    [f32::NAN, 2.0, 0.0],
];
const FAN: [[f32; 3]; 4] = [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [1.0, 1.0, 2.0], [0.0, 1.0, 2.5]];

/// A mesh of points, of a strip of three triangles, one of them broken, and of a fan of two, shown by two nodes, the second of which
/// mirrors.
fn file() -> Gltf {
    let mut file = Gltf::new();
    let points = file.floats("VEC3", &[0.0; 3]);
    let strip = file.floats("VEC3", STRIP.as_flattened());
    let indices = file.accessor(U16, "SCALAR", 5, &shorts(&[1, 2, 3, 4, 5]));
    let fan = file.floats("VEC3", FAN.as_flattened());
    let uvs = file.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
    file.push(
        "meshes",
        json!({ "primitives": [
        { "attributes": { "POSITION": points }, "mode": 0 },
        { "attributes": { "POSITION": strip }, "indices": indices, "mode": 5 },
        { "attributes": { "POSITION": fan, "TEXCOORD_0": uvs, "TEXCOORD_1": uvs }, "mode": 6, "material": 0 },
    ] }),
    );
    file.push("materials", json!({}));
    for name in ["left", "right"] {
        file.push("nodes", json!({ "mesh": 0, "name": name }));
    }
    file.json["nodes"][1]["scale"] = json!([-2, 1, 1]);
    file
}

fn origins(model: &Model) -> &FileOrigins {
    model.origins.as_ref().unwrap()
}

#[test]
fn every_vertex_is_the_one_of_the_file_that_it_was_read_from() {
    let options = LoadOptions {
        up: Up::Z,
        scale: 3.0,
        ..LoadOptions::default()
    };
    let model = file().load_with(&options).unwrap();
    let origins = origins(&model);
    let places: Vec<_> = origins
        .placed
        .iter()
        .map(|placed| (placed.node, placed.mesh, placed.primitive))
        .collect();
    let expected = [(Some(0), 0, 1), (Some(0), 0, 2), (Some(1), 0, 1), (Some(1), 0, 2)];
    assert_eq!(places, expected, "points have no triangles");
    let triangles: Vec<_> = origins.placed.iter().map(|placed| placed.triangles.clone()).collect();
    assert_eq!(triangles, [0..2, 2..4, 4..6, 6..8], "a triangle of the strip is broken");
    for placed in &origins.placed {
        let positions = if placed.primitive == 1 { &STRIP[..] } else { &FAN };
        let model_from_file = glam::DMat3::from_cols_array_2d(&placed.model_from_file);
        for triangle in placed.triangles.clone() {
            for vertex in model.mesh.triangles[triangle as usize] {
                let stored = positions[origins.vertices[vertex as usize] as usize].map(f64::from);
                let moved = (model_from_file * glam::DVec3::from(stored)).as_vec3();
                assert_eq!(moved, glam::Vec3::from(model.mesh.positions[vertex as usize]));
            }
        }
    }
    let corners = |triangle: usize| model.mesh.triangles[triangle].map(|vertex| origins.vertices[vertex as usize]);
    assert_eq!([corners(0), corners(1)], [[1, 2, 3], [2, 4, 3]]);
    assert_eq!(
        [corners(4), corners(5)],
        [[1, 3, 2], [2, 3, 4]],
        "a mirrored triangle is reversed"
    );
}

#[test]
fn vertices_that_are_split_keep_their_origin() {
    let mut origins = FileOrigins {
        vertices: vec![5, 7, 9],
        ..FileOrigins::default()
    };
    origins.follow(&[0, 1, 2, 1, 0]);
    assert_eq!(origins.vertices, [5, 7, 9, 7, 5]);
}

#[test]
fn the_free_uv_set_is_behind_those_of_the_primitives_asked_for() {
    let model = file().model();
    let free = |materials: &[u32]| {
        let materials: BTreeSet<u32> = materials.iter().copied().collect();
        origins(&model).free_uv_set(&model.mesh, Some(&materials))
    };
    assert_eq!(origins(&model).free_uv_set(&model.mesh, None), 2);
    assert_eq!([free(&[0]), free(&[1]), free(&[])], [2, 0, 0]);
}

#[test]
fn tangents_are_the_files_own_where_they_belong_to_the_chosen_set() {
    let mut file = Gltf::triangle();
    let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let tangents = file.floats("VEC4", &[0.0, 1.0, 0.0, 1.0].repeat(3));
    let bad = file.floats("VEC4", &[0.0; 12]);
    let mut is_own = |normals: Option<usize>, tangents: usize, uv_set: u32| {
        let attributes: &mut Value = &mut file.primitive()["attributes"];
        attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"].clone();
        attributes["TANGENT"] = json!(tangents);
        match normals {
            Some(normals) => attributes["NORMAL"] = json!(normals),
            None => drop(attributes.as_object_mut().unwrap().shift_remove("NORMAL")),
        }
        let options = LoadOptions {
            uv_set,
            ..LoadOptions::default()
        };
        origins(&file.load_with(&options).unwrap()).placed[0].has_own_tangents
    };
    assert!(is_own(Some(normals), tangents, 0));
    assert!(!is_own(Some(normals), tangents, 1), "they are those of the first set");
    assert!(!is_own(Some(normals), bad, 0), "they were made again");
    assert!(!is_own(None, tangents, 0), "glTF has them ignored without normals");
}
