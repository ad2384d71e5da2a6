//! New vertex data in files of every layout.

use sabi_surface::load::Up;
use sabi_surface::model::Mesh;

use super::file::{F32, GltfFile, U8, U16, floats};
use super::*;

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

/// Position, texture coordinates, normal and tangent.
type CornerData = ([f32; 3], [f32; 2], [f32; 3], [f32; 4]);

fn corners(mesh: &Mesh) -> Vec<CornerData> {
    let all = mesh.triangles.iter().flatten().map(|at| *at as usize);
    all.map(|at| (mesh.positions[at], mesh.uvs[at], mesh.normals[at], mesh.tangents[at]))
        .collect()
}

/// The copy of a file whose materials got maps, and the models of the file and of the copy.
fn copy_of(file: &GltfFile, options: &LoadOptions) -> (FinishedCopy, Model, Model) {
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
    let plain = LoadOptions {
        smooth_degrees: None,
        ..options.clone()
    };
    let copied = load(&path, &plain).unwrap();
    (finished, model, copied)
}

fn close(a: &[f32], b: &[f32]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
}

/// Checks that a copy has the corners of its model, with tangents of its own.
fn assert_same(what: &str, file: &GltfFile, options: &LoadOptions) -> Json {
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

/// Reads the numbers of an accessor's elements as `f64`. This repeats the loader's rules in independent code.
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
    let stride = document["bufferViews"][index]["byteStride"]
        .as_u64()
        .unwrap_or(size * parts) as usize;
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
        (0..parts as usize)
            .map(|part| read(first + part * size as usize))
            .collect()
    };
    (0..number(accessor, "count")).map(element).collect()
}

#[test]
fn the_frame_of_the_maps_is_in_files_of_every_layout() {
    for (what, uvs, vertices) in [("whole", PLAIN, 6), ("split", MIRRORED, 8)] {
        for layout in ["separate", "interleaved", "strip", "no indices", "sparse"] {
            let mut file = GltfFile::new();
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

fn primitive_of(file: &mut GltfFile, layout: &str, uvs: &[[f32; 2]; 6]) -> Json {
    match layout {
        "interleaved" => {
            let rows = (0..6).map(|at| [&POSITIONS[at][..], &uvs[at], &NORMALS[at]].concat());
            let view = file.view(&floats(&rows.collect::<Vec<_>>().concat()), Some(32));
            let [position, uv, normal] = [(0, "VEC3"), (12, "VEC2"), (20, "VEC3")]
                .map(|(offset, kind)| file.accessor(view, offset, F32, kind, 6));
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
            if layout == "strip" {
                // Both squares, with triangles without area between them.
                let indices = file.indices(&[0, 2, 1, 3, 3, 2, 2, 4, 3, 5]);
                return json!({ "attributes": attributes, "indices": indices, "mode": 5 });
            }
            json!({ "attributes": attributes, "indices": indices })
        }
    }
}

#[test]
fn tangents_are_those_of_the_mesh_wherever_nodes_place_it() {
    let mut file = GltfFile::new();
    let mut primitive = primitive_of(&mut file, "separate", &MIRRORED);
    primitive["material"] = json!(0);
    file.mesh(&[primitive]);
    for placed in [
        json!({ "mesh": 0, "scale": [-1, 1, 1], "translation": [0, 0, 2] }),
        json!({ "mesh": 0, "scale": [1, 3, 2], "rotation": [0.5, 0.5, 0.5, 0.5] }),
    ] {
        file.node(placed);
    }
    // Placements have the same tangents as the first one, except for the last digits.
    for (up, smooth_degrees) in [(Up::Y, None), (Up::Z, None), (Up::Z, Some(60.0))] {
        let options = LoadOptions {
            up,
            smooth_degrees,
            scale: 2.0,
            ..LoadOptions::default()
        };
        let is = assert_same(&format!("{up:?} {smooth_degrees:?}"), &file, &options);
        assert_eq!(is["meshes"].as_array().unwrap().len(), 1);
    }
}

#[test]
fn a_split_vertex_keeps_all_that_the_file_has_of_it() {
    let mut file = GltfFile::new();
    let mut primitive = primitive_of(&mut file, "separate", &MIRRORED);
    let numbers: Vec<u8> = (0..6).flat_map(|at| [at, 0, 0, 0]).collect();
    let view = file.view(&numbers, None);
    let joints = file.accessor(view, 0, U8, "VEC4", 6);
    let weights = file.floats(&[[1.0, 0.0, 0.0, 0.0]; 6]);
    // Bytes at a stride of two, as quantized files have them.
    let view = file.view(&[0, 9, 1, 9, 2, 9, 3, 9, 4, 9, 5, 9], Some(2));
    let own = file.accessor(view, 0, U8, "SCALAR", 6);
    let moves = file.floats(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|z| [0.0, 0.0, z]));
    let none = edit::push(
        &mut file.json,
        "accessors",
        json!({ "componentType": F32, "type": "VEC3", "count": 6, "min": [0, 0, 0], "max": [0, 0, 0] }),
    );
    primitive["material"] = json!(0);
    for (name, accessor) in [("JOINTS_0", joints), ("WEIGHTS_0", weights), ("_OWN", own)] {
        primitive["attributes"][name] = json!(accessor);
    }
    let tangents = file.floats(&[[0.0; 4]; 6]);
    primitive["attributes"]["TANGENT"] = json!(tangents);
    primitive["targets"] = json!([{ "POSITION": moves, "TANGENT": moves }, { "POSITION": none }]);
    file.mesh(&[primitive]);
    let joint = edit::push(&mut file.json, "nodes", json!({}));
    file.json["scenes"][0]["nodes"] = json!([0, joint]);
    file.json["skins"] = json!([{ "joints": [joint] }]);
    file.json["nodes"][0]["skin"] = json!(0);
    let (finished, model, copied) = copy_of(&file, &LoadOptions::default());
    assert_eq!(corners(&model.mesh), corners(&copied.mesh));
    let copy = &finished.copy.bytes;
    let is = parts(copy).0;
    assert_eq!([&is["skins"], &is["nodes"]], [&file.json["skins"], &file.json["nodes"]]);
    let primitive = &is["meshes"][0]["primitives"][0];
    let attributes = &primitive["attributes"];
    let vertices: Vec<f64> = elements(copy, &attributes["JOINTS_0"])
        .iter()
        .map(|joints| joints[0])
        .collect();
    assert_eq!(vertices, [0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 5.0]);
    let of = |accessor: &Json| elements(copy, accessor);
    assert_eq!(of(&attributes["WEIGHTS_0"]), vec![[1.0, 0.0, 0.0, 0.0]; 8]);
    assert_eq!(
        of(&attributes["_OWN"]),
        vertices.iter().map(|at| vec![*at]).collect::<Vec<_>>()
    );
    let target = &primitive["targets"][0];
    assert_eq!(target.get("TANGENT"), None, "it was one of other tangents");
    assert_eq!(
        of(&target["POSITION"]),
        vertices.iter().map(|at| vec![0.0, 0.0, *at]).collect::<Vec<_>>()
    );
    assert_eq!(of(&primitive["targets"][1]["POSITION"]), vec![[0.0; 3]; 8]);
    for (vertex, position) in vertices.iter().zip(of(&attributes["POSITION"])) {
        assert_eq!(position, POSITIONS[*vertex as usize].map(f64::from));
    }
}

#[test]
fn primitives_that_share_vertices_get_tangents_of_their_own() {
    let mut file = GltfFile::new();
    let whole = primitive_of(&mut file, "separate", &MIRRORED);
    let squares = CORNERS.chunks(6).map(|corners| {
        let mut primitive = whole.clone();
        primitive["indices"] = json!(file.indices(corners));
        primitive["material"] = json!(0);
        primitive
    });
    let squares: Vec<Json> = squares.collect();
    // A triangle of many vertices leaves the rest behind.
    let mut few = whole.clone();
    few["indices"] = json!(file.indices(&CORNERS[..3]));
    file.mesh(&[squares[0].clone(), squares[1].clone()]);
    file.mesh(&[few]);
    let is = assert_same("shared", &file, &LoadOptions::default());
    let attributes = |mesh: usize, primitive: usize| &is["meshes"][mesh]["primitives"][primitive]["attributes"];
    assert_eq!(
        attributes(0, 0)["POSITION"],
        attributes(0, 1)["POSITION"],
        "they are as they were"
    );
    assert_ne!(attributes(0, 0)["TANGENT"], attributes(0, 1)["TANGENT"]);
    assert_eq!(
        attributes(1, 0)["POSITION"],
        attributes(0, 0)["POSITION"],
        "half of the vertices"
    );
}

#[test]
fn new_uvs_of_a_file_with_a_set_of_any_number_come_behind_that() {
    let mut file = GltfFile::new();
    let mut primitive = primitive_of(&mut file, "separate", &PLAIN);
    primitive["attributes"]["TEXCOORD_4294967294"] = primitive["attributes"]["TEXCOORD_0"].clone();
    primitive["material"] = json!(0);
    file.mesh(&[primitive]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it.glb");
    fs::write(&path, file.bytes()).unwrap();
    let mut model = load(&path, &LoadOptions::default()).unwrap();
    let (unwrapped, _) = sabi_surface::unwrap::unwrap_cached(None, &model.mesh).unwrap();
    model.mesh = unwrapped.mesh;
    let origins = model.origins.as_mut().unwrap();
    origins.follow(&unwrapped.source_vertex);
    let source = CopySource {
        unwrapped_uv_set: Some(origins.free_uv_set(&model.mesh, None)),
        ..source(&path, &model)
    };
    let maps = BTreeMap::from([(set(0), all_maps())]);
    let copy = ModelCopy::open(source, &BTreeSet::from([set(0)]), CopyOptions::default()).unwrap();
    let finished = copy.finish(maps, &|_| false).unwrap();
    let is = parts(&finished.copy.bytes).0;
    let attributes = is["meshes"][0]["primitives"][0]["attributes"].as_object().unwrap();
    assert!(attributes.contains_key("TEXCOORD_4294967295"), "{attributes:?}");
    assert!(attributes.len() < 30, "gaps are filled as far as files have sets");
    let texture = &is["materials"][0]["normalTexture"];
    assert_eq!(texture["texCoord"], 4294967295_u32);
}
