//! New vertex data in files of every layout.

use sabi_surface::load::Up;
use sabi_surface::model::Mesh;

use super::super::container::tests::glb;
use super::*;

const U8: u32 = 5121;
const U16: u32 = 5123;
const F32: u32 = 5126;

/// A file that grows.
struct File {
    json: Json,
    bytes: Vec<u8>,
}

impl File {
    fn new() -> File {
        let json = json!({
            "asset": { "version": "2.0" }, "buffers": [{}], "bufferViews": [], "accessors": [], "meshes": [],
            "materials": [{ "name": "wood" }], "nodes": [], "scene": 0, "scenes": [{ "nodes": [] }],
        });
        let bytes = Vec::new();
        File { json, bytes }
    }

    fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.bytes.extend_from_slice(bytes);
        edit::push(&mut self.json, "bufferViews", view)
    }

    fn accessor(&mut self, (view, offset): (usize, usize), component: u32, kind: &str, count: usize) -> usize {
        let accessor = json!({
            "bufferView": view, "byteOffset": offset, "componentType": component, "type": kind, "count": count
        });
        edit::push(&mut self.json, "accessors", accessor)
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let view = self.view(&floats(values.as_flattened()), None);
        let accessor = self.accessor((view, 0), F32, &format!("VEC{N}"), values.len());
        if N == 3 {
            let axis = |at: usize| values.iter().map(move |value| value[at]);
            let least: Vec<f32> = (0..3).map(|at| axis(at).fold(f32::INFINITY, f32::min)).collect();
            let most: Vec<f32> = (0..3).map(|at| axis(at).fold(f32::NEG_INFINITY, f32::max)).collect();
            self.json["accessors"][accessor]["min"] = json!(least);
            self.json["accessors"][accessor]["max"] = json!(most);
        }
        accessor
    }

    fn indices(&mut self, corners: &[u16]) -> usize {
        let view = self.view(corners.iter().flat_map(|at| at.to_le_bytes()).collect::<Vec<u8>>().as_slice(), None);
        self.accessor((view, 0), U16, "SCALAR", corners.len())
    }

    /// Adds a mesh and a node that shows it.
    fn mesh(&mut self, primitives: &[Json]) {
        let mesh = edit::push(&mut self.json, "meshes", json!({ "primitives": primitives }));
        self.node(json!({ "mesh": mesh }));
    }

    fn node(&mut self, node: Json) {
        let node = edit::push(&mut self.json, "nodes", node);
        edit::push(&mut self.json["scenes"][0], "nodes", json!(node));
    }

    fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0]["byteLength"] = json!(self.bytes.len());
        glb(&json, &self.bytes)
    }
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// A strip of two squares with their normals. The second is mirrored on the map, so tangents split the two vertices between them.
const POSITIONS: [[f32; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 1.0, 0.0],
];
const NORMALS: [[f32; 3]; 6] = [[0.0, 0.0, 1.0]; 6];
const MIRRORED: [[f32; 2]; 6] = [[0.1, 0.9], [0.1, 0.1], [0.9, 0.9], [0.9, 0.1], [0.1, 0.8], [0.1, 0.2]];
const PLAIN: [[f32; 2]; 6] = [[0.0, 0.9], [0.0, 0.1], [0.5, 0.9], [0.5, 0.1], [1.0, 0.9], [1.0, 0.1]];
const CORNERS: [u16; 12] = [0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5];

/// Position, texture coordinates, normal and tangent of each corner.
fn corners(mesh: &Mesh) -> Vec<([f32; 3], [f32; 2], [f32; 3], [f32; 4])> {
    let all = mesh.triangles.iter().flatten().map(|at| *at as usize);
    all.map(|at| (mesh.positions[at], mesh.uvs[at], mesh.normals[at], mesh.tangents[at]))
        .collect()
}

/// The copy of a file whose materials got maps, and the models of the file and of the copy.
fn copy_of(file: &File, options: &LoadOptions) -> (FinishedCopy, Model, Model) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it.glb");
    fs::write(&path, file.bytes()).unwrap();
    let model = load(&path, options).unwrap();
    let all = 0..model.materials.len() as u32;
    let maps: BTreeMap<SetKey, MaterialMaps> = all.map(|of| (set(of), all_maps())).collect();
    let baked = maps.keys().copied().collect();
    let copy = ModelCopy::open(source(&path, &model), &baked, CopyOptions::default()).unwrap();
    let finished = copy.finish(maps, &|_| false).unwrap();
    fs::write(&path, &finished.copy.bytes).unwrap();
    let plain = LoadOptions { smooth_degrees: None, ..options.clone() };
    let copied = load(&path, &plain).unwrap();
    (finished, model, copied)
}

fn close(a: &[f32], b: &[f32]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
}

/// Checks that a copy has the corners of its model, with tangents of its own.
fn assert_same(what: &str, file: &File, options: &LoadOptions) -> Json {
    let (finished, model, copied) = copy_of(file, options);
    assert!(finished.warnings.is_empty(), "{what}: {:?}", finished.warnings);
    let (was, is) = (corners(&model.mesh), corners(&copied.mesh));
    assert_eq!(was.len(), is.len(), "{what}");
    for (was, is) in was.iter().zip(&is) {
        assert_eq!((was.0, was.1), (is.0, is.1), "{what}");
        assert!(close(&was.2, &is.2) && close(&was.3, &is.3), "{what}: {was:?} {is:?}");
    }
    let placed = &copied.origins.as_ref().unwrap().placed;
    assert!(placed.iter().all(|placed| placed.has_own_tangents), "{what}");
    parts(&finished.copy.bytes).0
}

/// Numbers of an accessor's elements as `f64`, by the loader's own rules but written again.
fn elements(file: &[u8], accessor: &Json) -> Vec<Vec<f64>> {
    let (document, view) = parts(file);
    let accessor = &document["accessors"][accessor.as_u64().unwrap() as usize];
    let index = accessor["bufferView"].as_u64().unwrap() as usize;
    let bytes = view(index);
    let number = |of: &Json, key: &str| of[key].as_u64().unwrap_or(0) as usize;
    let size = match number(accessor, "componentType") as u32 {
        U8 => 1,
        U16 => 2,
        _ => 4,
    };
    let parts = match accessor["type"].as_str().unwrap() {
        "SCALAR" => 1,
        kind => kind[3..].parse().unwrap(),
    };
    let stride = document["bufferViews"][index]["byteStride"].as_u64().unwrap_or(size * parts) as usize;
    let read = |at: usize| {
        let word = &bytes[at..at + size as usize];
        match size {
            1 => f64::from(word[0]),
            2 => f64::from(u16::from_le_bytes(word.try_into().unwrap())),
            _ => f64::from(f32::from_le_bytes(word.try_into().unwrap())),
        }
    };
    let element = |at: usize| {
        let first = number(accessor, "byteOffset") + at * stride;
        (0..parts as usize).map(|part| read(first + part * size as usize)).collect()
    };
    (0..number(accessor, "count")).map(element).collect()
}

#[test]
fn the_frame_of_the_maps_is_in_files_of_every_layout() {
    for (what, uvs, vertices) in [("whole", PLAIN, 6), ("split", MIRRORED, 8)] {
        for layout in ["separate", "interleaved", "strip", "no indices", "sparse"] {
            let mut file = File::new();
            let mut primitive = primitive_of(&mut file, layout, &uvs);
            primitive["material"] = json!(0);
            file.mesh(&[primitive.clone()]);
            let case = format!("{what}, {layout}");
            let is = assert_same(&case, &file, &LoadOptions::default());
            let attributes = &is["meshes"][0]["primitives"][0]["attributes"];
            let count = |name: &str| {
                let accessor = attributes[name].as_u64().unwrap() as usize;
                is["accessors"][accessor]["count"].as_u64().unwrap()
            };
            // Vertices of their own for each triangle need not be split.
            let expected = if layout == "no indices" { 12 } else { vertices };
            assert_eq!(["POSITION", "TANGENT"].map(count), [expected; 2], "{case}");
        }
    }
}

fn primitive_of(file: &mut File, layout: &str, uvs: &[[f32; 2]; 6]) -> Json {
    match layout {
        "interleaved" => {
            let rows = (0..6).map(|at| [&POSITIONS[at][..], &uvs[at], &NORMALS[at]].concat());
            let view = file.view(&floats(&rows.collect::<Vec<_>>().concat()), Some(32));
            let [position, uv, normal] = [(0, "VEC3"), (12, "VEC2"), (20, "VEC3")]
                .map(|(offset, kind)| file.accessor((view, offset), F32, kind, 6));
            file.json["accessors"][position]["min"] = json!([0, 0, 0]);
            file.json["accessors"][position]["max"] = json!([2, 1, 0]);
            let indices = file.indices(&CORNERS);
            json!({ "attributes": { "POSITION": position, "TEXCOORD_0": uv, "NORMAL": normal }, "indices": indices })
        }
        "no indices" => {
            let corners = CORNERS.map(usize::from);
            let position = file.floats(&corners.map(|at| POSITIONS[at]));
            let uv = file.floats(&corners.map(|at| uvs[at]));
            let normal = file.floats(&corners.map(|at| NORMALS[at]));
            json!({ "attributes": { "POSITION": position, "TEXCOORD_0": uv, "NORMAL": normal } })
        }
        layout => {
            let position = file.floats(&POSITIONS);
            let uv = file.floats(uvs);
            let normal = file.floats(&NORMALS);
            let indices = file.indices(&CORNERS);
            let attributes = json!({ "POSITION": position, "TEXCOORD_0": uv, "NORMAL": normal });
            if layout == "sparse" {
                // Zeros, but for all that differs from zero.
                let places = file.view(&[1, 2, 3, 4, 5], None);
                let values = file.view(&floats(POSITIONS[1..].as_flattened()), None);
                let accessor = &mut file.json["accessors"][position];
                edit::remove(accessor, "bufferView");
                edit::remove(accessor, "byteOffset");
                accessor["sparse"] = json!({
                    "count": 5, "indices": { "bufferView": places, "componentType": U8 }, "values": { "bufferView": values }
                });
            }
            match layout {
                "strip" => {
                    let indices = file.indices(&[0, 2, 1, 3]);
                    let _ = indices;
                    // Two strips would need degenerate triangles between them, so this one goes on in one direction.
                    let indices = file.indices(&[0, 2, 1, 3, 3, 3, 2, 4, 3, 5]);
                    json!({ "attributes": attributes, "indices": indices, "mode": 5 })
                }
                _ => json!({ "attributes": attributes, "indices": indices }),
            }
        }
    }
}
