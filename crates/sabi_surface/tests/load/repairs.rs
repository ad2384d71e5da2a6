//! Faults of a file that do not prevent reading it are repaired, with a warning.

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Mesh;
use serde_json::json;

use crate::builder::{Gltf, GltfEdit, U8, U16, floats, nothing, shorts};
use crate::promises;

/// Edits of a good file with one material, and the only warning that follows.
const REPAIRS: &[(GltfEdit, &str)] = &[
    (
        |f| {
            let indices = f.accessor(U8, "SCALAR", 3, &[0, 9, 1, 9, 2]);
            f.json["bufferViews"][2]["byteStride"] = json!(2);
            f.primitive()["indices"] = json!(indices);
        },
        "The indices of mesh `leaf` are stored at a distance, which glTF keeps for vertices; they are read that way.",
    ),
    (
        |f| {
            let indices = f.view(&[2, 0]);
            let values = f.view(&floats(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]));
            f.json["accessors"][0]["sparse"] = json!({ "count": 2,
                "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } });
        },
        "The sparse positions of mesh `leaf` are out of order; where two meet, the later one counts.",
    ),
    (
        |f| f.json["nodes"][0] = json!({ "name": "leaf", "mesh": 0, "rotation": [0, 0, 0, 2] }),
        "The rotation of the node `leaf` is not of unit length; it is taken as if it were.",
    ),
    (
        |f| {
            let matrix = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
            f.json["nodes"][0] = json!({ "mesh": 0, "matrix": matrix, "scale": [2, 2, 2] });
        },
        "The node 0 has both a matrix and a translation, rotation or scale; the matrix is taken.",
    ),
    (
        |f| {
            f.json["nodes"] = json!([{ "mesh": 0 }, { "children": [2],
                "extensions": { "KHR_node_visibility": { "visible": false } } }, { "mesh": 0 }]);
        },
        "Nodes that the file hides (KHR_node_visibility) are left out.",
    ),
    (
        |f| f.json["buffers"][0]["byteLength"] = json!(100),
        "buffers[0] should have 100 bytes and has 60: it was cut off, or it belongs to another model.",
    ),
    (
        |f| f.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = json!(-1),
        "The metallic factor of material `paint` cannot be -1; 0 is taken.",
    ),
    (
        |f| f.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1, 1, 1, 1.5]),
        "The base color of material `paint` cannot be 1.5; 1 is taken.",
    ),
    (
        |f| {
            f.json["materials"][0]["extensions"] =
                json!({ "KHR_materials_emissive_strength": { "emissiveStrength": -1 } });
        },
        "The emission strength of material `paint` cannot be -1; 0 is taken.",
    ),
    (
        |f| f.json["materials"][0]["extensions"] = json!({ "KHR_materials_pbrSpecularGlossiness": {} }),
        "The material `paint` is described by KHR_materials_pbrSpecularGlossiness, which is not read here; its metallic-roughness values are taken.",
    ),
    (
        |f| {
            f.push("textures", json!({ "source": 0, "sampler": 3 }));
            f.push("images", json!({ "uri": "data:image/png;base64,AQID" }));
            f.json["materials"][0]["normalTexture"] = json!({ "index": 0 });
        },
        "A texture of material `paint` is repeated: there is no samplers[3] to say otherwise.",
    ),
    (
        |f| f.primitive()["targets"] = json!([{ "POSITION": 77 }]),
        "Morph targets of mesh `leaf` are left out: it is taken at rest.",
    ),
    (
        |f| f.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]),
        "Copies made by EXT_mesh_gpu_instancing are left out.",
    ),
    (
        |f| f.json["extensionsRequired"] = json!(["KHR_materials_ior"]),
        "The file needs KHR_materials_ior, which is left out of its materials.",
    ),
    (
        |f| f.json["extensionsRequired"] = json!(["MSFT_texture_dds"]),
        "The file needs MSFT_texture_dds: pictures stored that way are left out.",
    ),
];

#[test]
fn each_repair_is_said_and_leaves_the_triangle_as_it_is() {
    let mut good = Gltf::triangle();
    good.push("materials", json!({ "name": "paint", "pbrMetallicRoughness": {} }));
    good.primitive()["material"] = json!(0);
    let mesh = good.model().mesh;
    for (edit, sentence) in REPAIRS {
        let mut file = good.clone();
        edit(&mut file);
        let model = file.model();
        assert_eq!(model.warnings, [*sentence]);
        // A repair may be of a texture, which repeats or not.
        let repeating = model.mesh.repeating.clone();
        assert_eq!(
            model.mesh,
            Mesh {
                repeating,
                ..mesh.clone()
            },
            "{sentence}"
        );
    }
}

#[test]
fn the_number_by_which_strips_begin_anew_is_no_vertex() {
    let mut file = Gltf::new();
    let vertices: Vec<f32> = (0..300)
        .flat_map(|at| [(at / 2) as f32, (at % 2) as f32, 0.0])
        .collect();
    let positions = file.floats("VEC3", &vertices);
    let bytes = file.accessor(U8, "SCALAR", 9, &[0, 2, 1, 3, 255, 4, 6, 5, 7]);
    let shorter = file.accessor(U16, "SCALAR", 8, &shorts(&[0, 2, 1, 65535, 4, 6, 5, 255]));
    file.place("strip", json!({ "attributes": { "POSITION": positions }, "mode": 5 }));
    for (mode, indices, triangles, restart) in [
        (5, bytes, 4, 255),
        (6, bytes, 4, 255),
        (4, bytes, 2, 255),
        (5, shorter, 3, 65535),
    ] {
        file.primitive()["indices"] = json!(indices);
        file.primitive()["mode"] = json!(mode);
        let model = file.model();
        assert_eq!(model.mesh.triangles.len(), triangles, "mode {mode}");
        let across = model.mesh.triangles.iter().any(|corners| {
            let at = corners.map(|vertex| model.mesh.positions[vertex as usize][0]);
            at.iter().any(|x| *x <= 1.0) && at.iter().any(|x| *x >= 2.0)
        });
        assert!(!across, "mode {mode}");
        let sentence = format!(
            "The indices of mesh `strip` use {restart}, by which strips begin anew, as no vertex; no triangle reaches over it."
        );
        assert!(model.warnings.contains(&sentence), "mode {mode}: {:?}", model.warnings);
    }
}

#[test]
fn the_first_chunk_of_a_kind_is_read() {
    let mut file = Gltf::triangle().glb();
    file.extend(4u32.to_le_bytes());
    file.extend(b"BIN\0\0\0\0\0");
    let length = file.len() as u32;
    file[8..12].copy_from_slice(&length.to_le_bytes());
    let model = load_bytes("a.glb", &file, &mut nothing, &LoadOptions::default()).unwrap();
    promises::check(&model);
    assert_eq!(
        model.warnings,
        ["The file has more than one chunk of a kind; the first one is read."]
    );
}
