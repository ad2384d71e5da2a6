//! Error messages for files that cannot be read.

use sabi_surface::load::{LoadOptions, load_bytes};
use serde_json::{Value, json};

use crate::builder::{F32, Gltf, GltfEdit, I16, U8, U32, nothing};

/// Returns the error message for the bytes of a file.
pub(crate) fn said(name: &str, bytes: &[u8]) -> String {
    load_bytes(name, bytes, &mut nothing, &LoadOptions::default())
        .unwrap_err()
        .to_string()
}

/// Edits of a good file, and what is said then.
const FAULTS: &[(GltfEdit, &str)] = &[
    (
        |f| f.json["asset"] = json!({}),
        "the file is damaged: its asset does not say which version of glTF it is",
    ),
    (
        |f| f.json["asset"]["version"] = json!("1.0"),
        "this is glTF 1, and glTF 2 is read here; convert it (gltf-pipeline does so) or export it anew",
    ),
    (
        |f| f.json["asset"]["version"] = json!("3.0"),
        "this is glTF 3, and glTF 2 is read here",
    ),
    (
        |f| f.json["asset"] = json!({ "version": "2.1", "minVersion": "2.1" }),
        "this needs a reader of glTF 2.1, and glTF 2.0 is read here; export it as glTF 2.0",
    ),
    (
        |f| f.json["asset"] = json!({ "version": "3.0", "minVersion": "3.0" }),
        "this needs a reader of glTF 3.0, and glTF 2.0 is read here; export it as glTF 2.0",
    ),
    (
        |f| f.json["meshes"] = json!([]),
        "the file is damaged: nodes[0] shows meshes[0], which is not there",
    ),
    (
        |f| f.json["meshes"] = json!(3),
        "the file is damaged: meshes is not a list",
    ),
    (
        |f| f.json["meshes"][0] = json!({}),
        "the file is damaged: meshes[0] cannot be read (missing field `primitives`)",
    ),
    (
        |f| {
            f.json["meshes"] = json!([]);
            f.json["nodes"] = json!([]);
        },
        "it has no triangles; it has no meshes",
    ),
    (
        |f| f.primitive()["mode"] = json!(0),
        "it has no triangles; Points and lines of mesh `leaf` are left out",
    ),
    (
        |f| f.primitive()["mode"] = json!(9),
        "the file is damaged: mesh `leaf` has a primitive of unknown mode",
    ),
    (
        |f| f.primitive()["material"] = json!(4),
        "the file is damaged: mesh `leaf` uses materials[4], which is not there",
    ),
    (
        |f| f.primitive()["attributes"]["POSITION"] = json!(8),
        "the file is damaged: accessors[8] (positions of mesh `leaf`) is not there",
    ),
    (
        |f| f.primitive()["attributes"]["POSITION"] = json!(1),
        "the file is damaged: accessors[1] (positions of mesh `leaf`) has elements of kind Vec2, not of 3 numbers",
    ),
    (
        |f| f.json["accessors"][0]["componentType"] = json!(U32),
        "the file is damaged: accessors[0] (positions of mesh `leaf`) is stored as 32-bit integers, which glTF does not allow for positions",
    ),
    (
        |f| f.json["accessors"][0]["componentType"] = json!(1),
        "the file is damaged: accessors[0] (positions of mesh `leaf`) has an unknown type or componentType",
    ),
    (
        |f| f.json["accessors"][0]["count"] = json!(4),
        "the file is damaged: accessors[0] (positions of mesh `leaf`) needs 48 bytes, and bufferViews[0] has 36",
    ),
    (
        |f| f.json["accessors"][0]["byteOffset"] = json!(u64::MAX),
        "the file is damaged: accessors[0] (positions of mesh `leaf`) needs 18446744073709551651 bytes, and bufferViews[0] has 36",
    ),
    (
        |f| f.json["bufferViews"][0]["byteStride"] = json!(8),
        "the file is damaged: accessors[0] (positions of mesh `leaf`) has elements of 12 bytes, 8 bytes apart",
    ),
    (
        |f| f.json["bufferViews"][0]["byteLength"] = json!(1000),
        "the file is damaged: bufferViews[0] takes 1000 bytes from 0 on, and buffers[0] has 60 bytes",
    ),
    (
        |f| f.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
        "the file is damaged: bufferViews[0] takes 36 bytes from 18446744073709551615 on, and buffers[0] has 60 bytes",
    ),
    (
        |f| f.json["bufferViews"][0]["buffer"] = json!(1),
        "the file is damaged: bufferViews[0] is in buffers[1], which is not there",
    ),
    (
        |f| f.json["accessors"][0]["bufferView"] = json!(5),
        "the file is damaged: there is no bufferViews[5]",
    ),
    (
        |f| {
            f.json["accessors"][1] = json!({ "componentType": F32, "type": "VEC2", "count": 1u64 << 40 });
        },
        "the file is damaged: accessors[1] (coordinates of UV set 0 of mesh `leaf`) asks for 1099511627776 elements and stores none of them",
    ),
    (
        |f| {
            f.json["accessors"][1] = json!({ "componentType": F32, "type": "VEC2", "count": 70_000 });
        },
        "the file is damaged: accessors[1] (coordinates of UV set 0 of mesh `leaf`) asks for 70000 elements and stores none of them",
    ),
    (
        |f| {
            let indices = f.accessor(U8, "SCALAR", 3, &[0, 1, 2]);
            f.json["accessors"][0] = json!({ "componentType": F32, "type": "VEC3", "count": 65_536 });
            let primitive = json!({ "attributes": { "POSITION": 0 }, "indices": indices });
            f.json["meshes"][0]["primitives"] = Value::Array(vec![primitive; 32_769]);
        },
        "the file is damaged: its primitives share vertices until there are 2147549184 of them; export it with vertices of their own",
    ),
    (
        |f| f.json["accessors"][0]["count"] = json!(1u64 << 50),
        "it has 375299968947541 triangles, and at most 50000000 are handled; reduce it or split it",
    ),
    (
        |f| f.json["accessors"][1]["count"] = json!(2),
        "the file is damaged: mesh `leaf` has 3 positions and 2 texture coordinates",
    ),
    (
        |f| f.json["buffers"][0]["uri"] = json!("leaf%20data.bin"),
        "its vertex data is in `leaf%20data.bin`, which cannot be read: there is no such file; put that file back beside the model, or export the model as one .glb file",
    ),
    (
        |f| f.json["buffers"][0]["uri"] = json!("https://example.org/a.bin"),
        "its vertex data is in `https://example.org/a.bin`, which cannot be read: `https:` addresses are not fetched; put that file back beside the model, or export the model as one .glb file",
    ),
    (
        |f| f.json["buffers"][0]["uri"] = json!("data:;base64,?"),
        "the file is damaged: buffers[0]: its data URI is not proper base64",
    ),
    (
        |f| {
            f.push("buffers", json!({ "byteLength": 4 }));
            f.json["bufferViews"][0]["buffer"] = json!(1);
        },
        "the file is damaged: buffers[1] names no file and is not the binary chunk",
    ),
    (
        |f| f.json["extensionsRequired"] = json!(["ACME_gizmo"]),
        "it needs the glTF extension ACME_gizmo, which is not read here; export the model without it",
    ),
    (
        |f| f.json["nodes"][0]["children"] = json!([3]),
        "the file is damaged: its scene names nodes[3], which is not there",
    ),
    (
        |f| {
            f.json["nodes"] = json!([{ "children": [1] }, { "children": [2] }, { "mesh": 0, "children": [1] }]);
        },
        "the file is damaged: nodes[1] is below itself or below two nodes",
    ),
    (
        |f| f.json["scene"] = json!("first"),
        "the file is damaged: its scene is \"first\", which is not the number of one",
    ),
    (
        |f| f.json["scene"] = json!(2),
        "the file is damaged: its scene is scenes[2], which is not there",
    ),
];

#[test]
fn each_fault_of_a_gltf_file_has_its_sentence() {
    for (edit, sentence) in FAULTS {
        let mut file = Gltf::triangle();
        edit(&mut file);
        let error = file.load().unwrap_err();
        assert_eq!(error.to_string(), format!("test.glb: {sentence}"));
        assert_eq!(
            error.is_missing(),
            sentence.starts_with("its vertex data"),
            "{sentence}"
        );
    }
}

#[test]
fn indices_are_checked() {
    for (component, bytes, sentence) in [
        (
            U8,
            &[0, 1, 3][..],
            "the file is damaged: mesh `leaf` names vertex 3 of 3",
        ),
        (
            I16,
            &[0; 6],
            "the file is damaged: accessors[2] (indices of mesh `leaf`) is stored as signed 16-bit integers, not as unsigned integers",
        ),
    ] {
        let mut file = Gltf::triangle();
        let indices = file.accessor(component, "SCALAR", 3, bytes);
        file.primitive()["indices"] = json!(indices);
        assert_eq!(file.load().unwrap_err().to_string(), format!("test.glb: {sentence}"));
    }
}

#[test]
fn a_sparse_accessor_stays_within_its_count() {
    let mut file = Gltf::triangle();
    let indices = file.view(&[3]);
    let values = file.view(&[0; 12]);
    file.json["accessors"][0]["sparse"] = json!({ "count": 1,
        "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } });
    assert_eq!(
        file.load().unwrap_err().to_string(),
        "test.glb: the file is damaged: the sparse part of accessors[0] (positions of mesh `leaf`) replaces element 3 of 3"
    );
    file.json["accessors"][0]["sparse"]["count"] = json!(4);
    assert_eq!(
        file.load().unwrap_err().to_string(),
        "test.glb: the file is damaged: the sparse part of accessors[0] (positions of mesh `leaf`) replaces 4 elements of 3"
    );
}

#[test]
fn a_tree_of_instances_cannot_grow_beyond_the_limit() {
    let mut file = Gltf::triangle();
    let primitive = file.primitive().clone();
    file.json["meshes"][0]["primitives"] = Value::Array(vec![primitive; 1000]);
    file.json["nodes"] = Value::Array(vec![json!({ "mesh": 0 }); 50_001]);
    assert!(
        file.load()
            .unwrap_err()
            .to_string()
            .contains("it has 50001000 triangles, and at most 50000000 are handled")
    );
}

#[test]
fn uv_sets_cannot_multiply_beyond_the_limit() {
    let mut file = Gltf::new();
    // 101 sets besides the first for 3 030 000 vertices, the most being 300 million in all.
    let vertices = 30_000u64;
    let positions = file.push(
        "accessors",
        json!({ "componentType": F32, "type": "VEC3", "count": vertices }),
    );
    let uvs = file.push(
        "accessors",
        json!({ "componentType": F32, "type": "VEC2", "count": vertices }),
    );
    file.push("textures", json!({}));
    for set in 1..=101 {
        let texture = json!({ "index": 0, "texCoord": set });
        let material = file.push(
            "materials",
            json!({ "pbrMetallicRoughness": { "baseColorTexture": texture } }),
        );
        let mut attributes = json!({ "POSITION": positions });
        attributes[format!("TEXCOORD_{set}")] = json!(uvs);
        file.place("leaf", json!({ "attributes": attributes, "material": material }));
    }
    let error = file.load().unwrap_err();
    assert_eq!(
        error.fault.to_string(),
        "the file is damaged: its materials use 101 UV sets besides 0, too many for 3030000 vertices; export it with all \
         textures in one UV set"
    );
}

#[test]
fn a_missing_uv_set_names_those_there_are() {
    let options = |uv_set| LoadOptions {
        uv_set,
        ..LoadOptions::default()
    };
    let mut file = Gltf::triangle();
    let said = |file: &Gltf, set| file.load_with(&options(set)).unwrap_err().to_string();
    assert_eq!(said(&file, 2), "test.glb: it has no UV set 2; it has set 0");
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(1);
    assert_eq!(said(&file, 2), "test.glb: it has no UV set 2; it has the sets 0 and 1");
    file.primitive()["attributes"] = json!({ "POSITION": 0 });
    assert_eq!(said(&file, 2), "test.glb: it has no UV set 2; it has no UVs at all");
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(1);
    assert_eq!(said(&file, 0), "test.glb: it has no UV set 0; it has set 1");
}

#[test]
fn each_fault_of_the_container_has_its_sentence() {
    let whole = Gltf::triangle().glb();
    let edit = |at: usize, bytes: &[u8]| {
        let mut file = whole.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    for (bytes, sentence) in [
        (
            whole[..8].to_vec(),
            "the file is damaged: its GLB header is cut off".to_string(),
        ),
        (
            edit(4, &[3]),
            "this is version 3 of GLB, and version 2 is read here".into(),
        ),
        (
            whole[..whole.len() - 4].to_vec(),
            format!(
                "the file is damaged: its header promises {} bytes and there are {}; it was cut off",
                whole.len(),
                whole.len() - 4
            ),
        ),
        (
            edit(12, &[0xff; 4]),
            "the file is damaged: a chunk promises 4294967295 bytes and reaches over the end of the file".into(),
        ),
        (
            edit(16, b"BIN\0"),
            "the file is damaged: its first chunk is not JSON".into(),
        ),
        (
            edit(8, &[12, 0, 0, 0]),
            "the file is damaged: it has no JSON chunk".into(),
        ),
        (
            edit(8, &[16, 0, 0, 0]),
            "the file is damaged: a chunk header is cut off".into(),
        ),
        (
            edit(20, b"]"),
            "the file is damaged: its JSON cannot be read (expected value at line 1 column 1)".into(),
        ),
        (
            br#"{"asset": {"version": "2.0"}, "materials": [{"alphaCutoff": NaN}]}"#.to_vec(),
            "the file is damaged: its JSON has `NaN` for a number at line 1 column 61, which JSON does not know; put a number there, or \
             export it anew"
                .into(),
        ),
        (Vec::new(), "the file is damaged: it is empty".into()),
    ] {
        assert_eq!(said("a.glb", &bytes), format!("a.glb: {sentence}"));
    }
}

#[test]
fn a_scale_must_be_a_length() {
    for (scale, said) in [(0.0, "0"), (-1.0, "-1"), (f32::NAN, "NaN")] {
        let options = LoadOptions {
            scale,
            ..LoadOptions::default()
        };
        let error = Gltf::triangle().load_with(&options).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("test.glb: a scale of {said} makes no model; give a number above 0")
        );
    }
}
