//! Completion of attributes that are missing or invalid in a file: normals, tangents, texture coordinates.

use sabi_surface::load::LoadOptions;
use sabi_surface::model::MissingUvs;
use serde_json::json;

use crate::builder::{Gltf, U8};

/// Two triangles that meet in an edge with a right angle, sharing their vertices.
fn folded() -> Gltf {
    let mut file = Gltf::new();
    let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    let indices = file.accessor(U8, "SCALAR", 6, &[0, 1, 2, 0, 3, 1]);
    file.place(
        "fold",
        json!({ "attributes": { "POSITION": positions }, "indices": indices }),
    );
    file
}

#[test]
fn missing_normals_are_flat_and_split_the_vertices() {
    let mesh = folded().model().mesh;
    assert_eq!(mesh.positions.len(), 6);
    for (triangle, normal) in mesh.triangles.iter().zip([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]) {
        assert_eq!(triangle.map(|vertex| mesh.normals[vertex as usize]), [normal; 3]);
    }
}

#[test]
fn normals_without_a_direction_are_computed() {
    let mut file = folded();
    let normals = file.floats(
        "VEC3",
        &[0.0, 0.0, 2.0, f32::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.6, 0.8],
    );
    file.primitive()["attributes"]["NORMAL"] = json!(normals);
    let model = file.model();
    assert_eq!(model.mesh.normals[0], [0.0, 0.0, 1.0]);
    assert_eq!(model.mesh.normals[2], [0.0, 0.0, 1.0]);
    assert_eq!(
        model.warnings,
        ["2 vertices of mesh `fold` had normals without a direction; these were made anew."]
    );
}

#[test]
fn tangents_point_along_u_and_bitangents_upward_in_the_image() {
    let mesh = Gltf::triangle().model().mesh;
    assert_eq!(mesh.tangents, [[1.0, 0.0, 0.0, 1.0]; 3]);
}

#[test]
fn a_vertex_between_mirrored_triangles_is_split() {
    let mut file = Gltf::new();
    let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0]);
    let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4));
    let uvs = file.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0]);
    let indices = file.accessor(U8, "SCALAR", 6, &[0, 1, 2, 0, 2, 3]);
    let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
    file.place("leaf", json!({ "attributes": attributes, "indices": indices }));
    let mesh = file.model().mesh;
    assert_eq!(mesh.positions.len(), 6);
    let corners = |triangle: usize| mesh.triangles[triangle].map(|vertex| mesh.tangents[vertex as usize]);
    assert_eq!(corners(0), [[1.0, 0.0, 0.0, 1.0]; 3]);
    assert_eq!(corners(1), [[-1.0, 0.0, 0.0, -1.0]; 3]);
}

#[test]
fn stored_tangents_are_kept_if_they_are_valid() {
    let mut file = Gltf::triangle();
    let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let good = file.floats("VEC4", &[0.0, -1.0, 0.0, -1.0].repeat(3));
    let bad = file.floats("VEC4", &[0.0, -1.0, 0.0, 0.0].repeat(3));
    file.primitive()["attributes"]["NORMAL"] = json!(normals);
    file.primitive()["attributes"]["TANGENT"] = json!(good);
    assert_eq!(file.model().mesh.tangents, [[0.0, -1.0, 0.0, -1.0]; 3]);
    file.primitive()["attributes"]["TANGENT"] = json!(bad);
    let model = file.model();
    assert_eq!(model.mesh.tangents, [[1.0, 0.0, 0.0, 1.0]; 3]);
    assert_eq!(
        model.warnings,
        ["The tangents of mesh `leaf` are not unit vectors with a sign; they were made anew."]
    );
}

#[test]
fn many_vertices_at_one_place_do_not_take_quadratic_time() {
    let mut file = Gltf::triangle();
    let corners = 90_000;
    let positions = file.floats("VEC3", &vec![1.0; corners * 3]);
    let uvs: Vec<f32> = (0..corners * 2).map(|number| number as f32).collect();
    let uvs = file.floats("VEC2", &uvs);
    file.place(
        "crowd",
        json!({ "attributes": { "POSITION": positions, "TEXCOORD_0": uvs } }),
    );
    let sentence =
        "Too many triangles of mesh `crowd` meet in one place to make tangents by the standard; theirs are arbitrary.";
    let arealess = "What has no area, such as a part that is scaled to nothing, is left out: `crowd`.";
    assert_eq!(file.model().warnings, [sentence, arealess]);
}

#[test]
fn a_model_without_uvs_has_none_and_still_has_tangents() {
    let mut file = Gltf::triangle();
    file.primitive()["attributes"]
        .as_object_mut()
        .unwrap()
        .remove("TEXCOORD_0");
    let model = file.model();
    assert!(model.mesh.uvs.is_empty() && model.warnings.is_empty());
}

#[test]
fn triangles_without_uvs_among_others_get_zeros_and_are_named() {
    let mut file = Gltf::triangle();
    let material = file.push("materials", json!({ "name": "bare" }));
    let bare = json!({ "attributes": { "POSITION": 0 }, "material": material });
    file.place("bare", bare);
    let model = file.model();
    assert_eq!(model.mesh.uvs[3..], [[0.0; 2]; 3]);
    let missing = MissingUvs {
        set: 0,
        triangles: 1..2,
    };
    assert_eq!(model.mesh.missing_uvs, [missing]);
    let bare: Vec<String> = model
        .without_uvs
        .iter()
        .map(|at| model.materials[*at as usize].label())
        .collect();
    assert_eq!(bare, ["material `bare`"]);
}

#[test]
fn triangles_that_lack_the_set_of_a_texture_are_named() {
    let mut file = Gltf::triangle();
    file.push("images", json!({ "uri": "data:image/png;base64,AAAA" }));
    file.push("textures", json!({ "source": 0 }));
    let occlusion = json!({ "occlusionTexture": { "index": 0, "texCoord": 1 } });
    let material = file.push("materials", occlusion);
    file.primitive()["material"] = json!(material);
    let bare = file.primitive().clone();
    let second = file.floats("VEC2", &[0.5; 6]);
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(second);
    file.place("bare", bare);
    let missing = MissingUvs {
        set: 1,
        triangles: 1..2,
    };
    assert_eq!(file.model().mesh.missing_uvs, [missing]);
}

#[test]
fn the_asked_uv_set_is_read() {
    let mut file = Gltf::triangle();
    let second = file.floats("VEC2", &[0.5; 6]);
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(second);
    let options = LoadOptions {
        uv_set: 1,
        ..LoadOptions::default()
    };
    assert_eq!(file.load_with(&options).unwrap().mesh.uvs, [[0.5; 2]; 3]);
}

#[test]
fn triangles_with_positions_that_are_not_finite_are_dropped() {
    let mut file = Gltf::new();
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, f32::NAN, 0.0, 0.0];
    let positions = file.floats("VEC3", &positions);
    let indices = file.accessor(U8, "SCALAR", 6, &[1, 2, 3, 0, 1, 2]);
    file.place(
        "leaf",
        json!({ "attributes": { "POSITION": positions }, "indices": indices }),
    );
    let model = file.model();
    assert_eq!(model.mesh.triangles, [[0, 1, 2]]);
    assert_eq!(
        model.warnings,
        ["1 triangle of mesh `leaf` had positions that are no numbers and had to be left out."]
    );
    file.json["nodes"][0]["scale"] = json!([1e38, 1e38, 1e38]);
    file.json["nodes"] = json!([{ "children": [1], "scale": [1e38, 1, 1] }, file.json["nodes"][0]]);
    assert!(
        file.load()
            .unwrap_err()
            .to_string()
            .contains("1 triangle reached out of the range of numbers")
    );
}

#[test]
fn texture_coordinates_that_are_not_finite_become_zero() {
    let mut file = Gltf::triangle();
    let uvs = file.floats("VEC2", &[0.0, f32::INFINITY, 1.0, 1.0, 0.0, 0.0]);
    file.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    let model = file.model();
    assert_eq!(model.mesh.uvs[0], [0.0; 2]);
    assert_eq!(model.warnings.len(), 1);
}
