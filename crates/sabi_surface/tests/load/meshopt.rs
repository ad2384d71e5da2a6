//! Buffer views packed by meshoptimizer.

use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    ExpMode, IndexEncoding, VertexEncoding, encode_filter_color, encode_filter_exp, encode_filter_oct,
    encode_index_buffer, encode_index_sequence, encode_vertex_buffer,
};
use sabi_surface::load::{LoadOptions, load_bytes};
use serde_json::{Value, json};

use crate::builder::{F32, Gltf, I16, U8, U16, U32, floats};
use crate::packed_quad::{CORNERS, check, meshopt};

const EXT: &str = "EXT_meshopt_compression";
const KHR: &str = "KHR_meshopt_compression";

/// A file whose second buffer is that of the unpacked views, without bytes.
fn packed_file(extension: &str) -> Gltf {
    let mut file = Gltf::new();
    file.push(
        "buffers",
        json!({ "byteLength": 1000, "extensions": { extension: { "fallback": true } } }),
    );
    file.json["extensionsRequired"] = json!([extension, "KHR_mesh_quantization"]);
    file
}

/// Adds a view of `count` elements that is packed in `bytes`.
fn packed_view(
    file: &mut Gltf,
    extension: &str,
    mut packing: Value,
    count: usize,
    stride: usize,
    bytes: &[u8],
) -> usize {
    let view = file.view(bytes);
    let place = &file.json["bufferViews"][view];
    let is_of_vertices = packing["mode"] == "ATTRIBUTES";
    for (key, value) in [
        ("buffer", json!(0)),
        ("byteOffset", place["byteOffset"].clone()),
        ("byteLength", place["byteLength"].clone()),
        ("count", json!(count)),
        ("byteStride", json!(stride)),
    ] {
        packing[key] = value;
    }
    file.json["bufferViews"][view] = json!({
        "buffer": 1, "byteLength": count * stride, "extensions": { extension: packing }
    });
    if is_of_vertices {
        file.json["bufferViews"][view]["byteStride"] = json!(stride);
    }
    view
}

/// Adds an accessor over a packed view of vertices.
fn attribute(file: &mut Gltf, extension: &str, filter: &str, stride: usize, component: u32, bytes: &[u8]) -> usize {
    let version = u8::from(extension == KHR);
    let encoding = VertexEncoding::new(version, 2).unwrap();
    let packed = encode_vertex_buffer(bytes, 4, stride, encoding, &mut Workspace::default()).unwrap();
    let packing = json!({ "mode": "ATTRIBUTES", "filter": filter });
    let view = packed_view(file, extension, packing, 4, stride, &packed);
    file.push(
        "accessors",
        json!({ "bufferView": view, "componentType": component, "type": "VEC3", "count": 4 }),
    )
}

fn shaped(file: &mut Gltf, accessor: usize, shape: &str, normalized: bool) -> usize {
    file.json["accessors"][accessor]["type"] = json!(shape);
    file.json["accessors"][accessor]["normalized"] = json!(normalized);
    accessor
}

/// The quad with each attribute packed in a way of its own, and indices as `indices` adds them.
fn quad(extension: &str, indices: fn(&mut Gltf, &str) -> usize) -> Gltf {
    let mut file = packed_file(extension);
    let work = &mut Workspace::default();
    let positions: Vec<f32> = CORNERS.iter().flat_map(|(position, ..)| *position).collect();
    let positions = encode_filter_exp(4, 12, 20, &positions, ExpMode::Separate, work).unwrap();
    let position = attribute(&mut file, extension, "EXPONENTIAL", 12, F32, &positions);
    let normals = encode_filter_oct(4, 8, 12, &[0.0, 0.0, 1.0, 0.0].repeat(4), work).unwrap();
    let normal = attribute(&mut file, extension, "OCTAHEDRAL", 8, I16, &normals);
    shaped(&mut file, normal, "VEC3", true);
    let uvs: Vec<f32> = CORNERS.iter().flat_map(|(_, uv, _)| *uv).collect();
    let uv = attribute(&mut file, extension, "NONE", 8, F32, &floats(&uvs));
    shaped(&mut file, uv, "VEC2", false);
    let colors: Vec<f32> = CORNERS.iter().flat_map(|(.., color)| *color).collect();
    let (filter, colors) = match extension {
        KHR => ("COLOR", encode_filter_color(4, 4, 8, &colors, work).unwrap()),
        _ => ("NONE", colors.iter().map(|part| (part * 255.0).round() as u8).collect()),
    };
    let color = attribute(&mut file, extension, filter, 4, U8, &colors);
    shaped(&mut file, color, "VEC4", true);
    let indices = indices(&mut file, extension);
    file.place(
        "leaf",
        json!({ "indices": indices, "attributes": {
            "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv, "COLOR_0": color } }),
    );
    file
}

const INDICES: [u32; 6] = [0, 1, 2, 0, 2, 3];

fn indices_of(file: &mut Gltf, extension: &str, mode: &str, stride: usize, component: u32, bytes: &[u8]) -> usize {
    let view = packed_view(file, extension, json!({ "mode": mode }), 6, stride, bytes);
    file.push(
        "accessors",
        json!({ "bufferView": view, "componentType": component, "type": "SCALAR", "count": 6 }),
    )
}

fn triangles(file: &mut Gltf, extension: &str) -> usize {
    let encoding = IndexEncoding::new(1).unwrap();
    let bytes = encode_index_buffer(&INDICES, encoding, &mut Workspace::default()).unwrap();
    indices_of(file, extension, "TRIANGLES", 2, U16, &bytes)
}

fn sequence(file: &mut Gltf, extension: &str) -> usize {
    let encoding = IndexEncoding::new(1).unwrap();
    let bytes = encode_index_sequence(&INDICES, encoding, &mut Workspace::default()).unwrap();
    indices_of(file, extension, "INDICES", 4, U32, &bytes)
}

#[test]
fn every_mode_and_filter_gives_the_quad() {
    for extension in [EXT, KHR] {
        for indices in [triangles, sequence] {
            let model = quad(extension, indices).model();
            check(&model);
            assert_eq!(model.warnings, [""; 0], "{extension}");
        }
    }
}

#[test]
fn sparse_values_replace_packed_ones_and_may_be_packed() {
    let mut file = meshopt();
    let indices = file.view(&[3]);
    let encoding = VertexEncoding::new(0, 2).unwrap();
    let bytes = encode_vertex_buffer(&floats(&[5.0, 6.0, 7.0]), 1, 12, encoding, &mut Workspace::default()).unwrap();
    let values = packed_view(&mut file, EXT, json!({ "mode": "ATTRIBUTES" }), 1, 12, &bytes);
    file.json["bufferViews"][values]
        .as_object_mut()
        .unwrap()
        .remove("byteStride");
    file.json["accessors"][1]["sparse"] = json!({ "count": 1,
        "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } });
    let model = file.model();
    assert_eq!(model.mesh.positions[3], [5.0, 6.0, 7.0]);
    assert_eq!(model.warnings, [""; 0]);
}

#[test]
fn plain_bytes_are_read_where_the_extension_is_not_required() {
    let mut file = meshopt();
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    check(&file.model());
    let fallback = file.json["buffers"][1]["byteLength"].as_u64().unwrap() as usize;
    file.json["buffers"][1]["uri"] = json!("plain.bin");
    let read = |file: &Gltf, there: Option<usize>| {
        let mut beside = |_: &str| match there {
            Some(length) => Ok(vec![0; length]),
            None => Err("there is no such file".to_string()),
        };
        load_bytes("test.glb", &file.glb(), &mut beside, &LoadOptions::default())
    };
    let model = read(&file, None).unwrap();
    check(&model);
    assert_eq!(model.warnings, [""; 0], "nobody needs the fallback");
    // Bytes of zeros, which are there to be read: all vertices are one.
    let flat = read(&file, Some(fallback)).unwrap_err().to_string();
    assert!(flat.contains("What has no area"), "{flat}");
    file.json["extensionsRequired"] = json!([EXT, "KHR_mesh_quantization"]);
    check(&read(&file, Some(fallback)).unwrap());
}

type JsonEdit = fn(&mut Value);

/// Edits of the extension of the positions, and what is said then.
const FAULTS: &[(JsonEdit, &str)] = &[
    (
        |e| e["count"] = json!(null),
        "bufferViews[2] has no `count` in its EXT_meshopt_compression",
    ),
    (
        |e| e["mode"] = json!("LINES"),
        "bufferViews[2] has a `mode` in its EXT_meshopt_compression that is not known",
    ),
    (
        |e| e["filter"] = json!("COLOR"),
        "bufferViews[2] has a `filter` in its EXT_meshopt_compression that is not known",
    ),
    (
        |e| e["buffer"] = json!(7),
        "bufferViews[2] is in buffers[7], which is not there",
    ),
    (
        |e| e["byteLength"] = json!(9999),
        "bufferViews[2] takes 9999 bytes from 92 on, and buffers[0] has 324 bytes",
    ),
    (
        |e| e["byteLength"] = json!(40),
        "bufferViews[2] cannot be unpacked (invalid encoded stream)",
    ),
    (
        |e| e["byteStride"] = json!(6),
        "bufferViews[2] cannot be unpacked (invalid vertex layout)",
    ),
    (
        |e| e["mode"] = json!("INDICES"),
        "bufferViews[2] cannot be unpacked (invalid vertex layout)",
    ),
    (
        |e| e["filter"] = json!("QUATERNION"),
        "bufferViews[2] cannot be unpacked (invalid vertex layout)",
    ),
    (
        |e| e["count"] = json!(10_000_000),
        "bufferViews[2] claims 120000000 bytes, more than its 67 packed bytes can hold",
    ),
    (
        |e| e["count"] = json!(1u64 << 40),
        "its packed buffer views claim 13194139533388 bytes together, more than the largest model has",
    ),
];

#[test]
fn each_fault_of_a_packed_view_has_its_sentence() {
    for (edit, sentence) in FAULTS {
        let mut file = meshopt();
        edit(&mut file.json["bufferViews"][2]["extensions"][EXT]);
        let error = file.load().unwrap_err().to_string();
        assert_eq!(error, format!("test.glb: the file is damaged: {sentence}"));
    }
}

#[test]
fn a_view_that_nothing_reads_may_be_damaged() {
    let mut file = meshopt();
    file.push(
        "bufferViews",
        json!({ "buffer": 1, "byteLength": 4, "extensions": { EXT: {} } }),
    );
    check(&file.model());
}

#[test]
fn vertices_of_a_packed_view_count_as_many_as_it_claims() {
    let mut file = packed_file(KHR);
    let count = 300_000;
    let view = packed_view(&mut file, KHR, json!({ "mode": "ATTRIBUTES" }), count, 12, &[0; 4]);
    let positions = file.push(
        "accessors",
        json!({ "bufferView": view, "componentType": F32, "type": "VEC3", "count": count }),
    );
    let indices = file.accessor(U8, "SCALAR", 3, &[0, 1, 2]);
    let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
    file.place("many", primitive.clone());
    file.json["meshes"][0]["primitives"] = Value::Array(vec![primitive; 7_200]);
    assert_eq!(
        file.load().unwrap_err().fault.to_string(),
        "the file is damaged: its primitives share vertices until there are 2160000000 of them; export it with vertices of \
         their own"
    );
}
