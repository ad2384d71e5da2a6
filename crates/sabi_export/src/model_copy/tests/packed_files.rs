//! Copies of files whose vertices are packed by Draco or meshoptimizer, or whose pictures are packed for graphics cards.

use sabi_surface::model::Mesh;

use super::super::container::tests::glb;
use super::*;

/// A quad with one picture, which lies before the packed bytes.
const FILES: [(&str, &[u8]); 2] = [
    (
        "KHR_draco_mesh_compression",
        include_bytes!("../../../../../fuzz/seeds/gltf/draco.glb"),
    ),
    (
        "EXT_meshopt_compression",
        include_bytes!("../../../../../fuzz/seeds/gltf/meshopt.glb"),
    ),
];

/// The model in a copy and the files beside it.
fn reloaded(finished: &FinishedCopy) -> Model {
    let folder = tempfile::tempdir().unwrap();
    for file in finished.beside.iter().chain([&finished.copy]) {
        fs::write(folder.path().join(&file.name), &file.bytes).unwrap();
    }
    load(&folder.path().join(&finished.copy.name), &LoadOptions::default()).unwrap()
}

fn mesh_of(file: &[u8], options: &LoadOptions) -> Mesh {
    let none = &mut |_: &str| Err("there is no such file".to_owned());
    sabi_surface::load::load_bytes("it.glb", file, none, options)
        .unwrap()
        .mesh
}

/// The mesh without what the look decides: new maps are clamped where old ones repeated, and vertex colors are in the maps.
fn shape(mesh: &Mesh) -> Mesh {
    Mesh {
        repeating: BTreeSet::new(),
        colors: Vec::new(),
        ..mesh.clone()
    }
}

fn color_of(model: &Model) -> Vec<u8> {
    let texture = model.materials[0].base_color.as_ref().unwrap();
    model.images[texture.image].bytes.clone().unwrap().to_vec()
}

#[test]
fn packed_vertices_stay_packed_where_new_maps_take_the_place_of_pictures() {
    for (extension, file) in FILES {
        let finished = copied("it.glb", &[("it.glb", file)], &[(0, flat_maps())]);
        let (was, is) = (parts(file).0, parts(&finished.copy.bytes).0);
        for key in ["accessors", "nodes", "extensionsRequired"] {
            assert_eq!(was[key], is[key], "{extension}: {key}");
        }
        let used = is["extensionsUsed"].as_array().unwrap();
        assert!(used.contains(&json!(extension)), "{used:?}");
        let model = reloaded(&finished);
        assert_eq!(
            shape(&model.mesh),
            shape(&mesh_of(file, &LoadOptions::default())),
            "{extension}"
        );
        assert_eq!((color_of(&model), &model.warnings[..]), (picture("new color"), &[][..]));
        assert!(finished.warnings.is_empty(), "{:?}", finished.warnings);
        // 64 of the 69 bytes of the old picture are gone, and what lay behind has moved.
        let packed = |document: &Json| {
            let view = match extension {
                "EXT_meshopt_compression" => &document["bufferViews"][2]["extensions"][extension],
                _ => &document["bufferViews"][1],
            };
            view["byteOffset"].as_u64().unwrap()
        };
        assert_eq!(packed(&was) - packed(&is), 64, "{extension}");
    }
}

#[test]
fn a_packed_file_in_several_parts_keeps_its_buffers() {
    for (extension, file) in FILES {
        let (container, mut document) = Container::split(file).unwrap();
        document["buffers"][0]["uri"] = json!("packed.bin");
        let text = document.to_string();
        let files: [(&str, &[u8]); 2] = [("it.gltf", text.as_bytes()), ("packed.bin", container.binary())];
        let mut finished = copied("it.gltf", &files, &[(0, flat_maps())]);
        let is: Json = serde_json::from_slice(&finished.copy.bytes).unwrap();
        // The view of the old picture is gone, and the others are numbered after that.
        assert_eq!(document["extensionsRequired"], is["extensionsRequired"], "{extension}");
        document["buffers"][0]["uri"] = json!("it.bin");
        assert_eq!(document["buffers"], is["buffers"], "{extension}");
        let buffer = finished.beside.iter().find(|file| file.name == "it.bin").unwrap();
        assert_eq!(buffer.bytes, container.binary(), "{extension}");
        for map in ["new color", "new packed", "new normal", "new emission"] {
            let (name, bytes) = (format!("{map}.png"), picture(map));
            finished.beside.push(CopiedFile { name, bytes });
        }
        let model = reloaded(&finished);
        assert_eq!(
            shape(&model.mesh),
            shape(&mesh_of(file, &LoadOptions::default())),
            "{extension}"
        );
        assert_eq!(color_of(&model), picture("new color"));
    }
}

#[test]
fn tangents_lie_beside_packed_vertices() {
    for (extension, file) in FILES {
        let finished = copied("it.glb", &[("it.glb", file)], &[(0, all_maps())]);
        assert!(finished.warnings.is_empty(), "{:?}", finished.warnings);
        let is = parts(&finished.copy.bytes).0;
        assert_eq!(
            is["extensionsRequired"],
            parts(file).0["extensionsRequired"],
            "{extension}"
        );
        let primitive = &is["meshes"][0]["primitives"][0];
        assert!(primitive["attributes"]["TANGENT"].is_u64(), "{primitive}");
        let model = reloaded(&finished);
        assert!(model.origins.as_ref().unwrap().placed[0].has_own_tangents);
        assert_eq!(
            shape(&model.mesh),
            shape(&mesh_of(file, &LoadOptions::default())),
            "{extension}"
        );
    }
}

/// Gives the second triangle vertices of its own with other normals.
fn crease(model: &mut Model) {
    let mesh = &mut model.mesh;
    let origins = &mut model.origins.as_mut().unwrap().vertices;
    let corners = mesh.triangles[1].map(|at| at as usize);
    mesh.triangles[1] = [0, 1, 2].map(|at| (mesh.positions.len() + at) as u32);
    for at in corners {
        mesh.positions.push(mesh.positions[at]);
        mesh.normals.push([0.0, 1.0, 0.0]);
        mesh.tangents.push(mesh.tangents[at]);
        mesh.uvs.push(mesh.uvs[at]);
        mesh.colors.push(mesh.colors[at]);
        origins.push(origins[at]);
    }
}

#[test]
fn packed_vertices_that_are_split_are_stored_plain() {
    for (extension, file) in FILES {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("it.glb");
        fs::write(&path, file).unwrap();
        let options = LoadOptions {
            smooth_degrees: Some(30.0),
            ..LoadOptions::default()
        };
        let mut model = load(&path, &options).unwrap();
        crease(&mut model);
        let copy = ModelCopy::open(source(&path, &model), &BTreeSet::new(), CopyOptions::default()).unwrap();
        let finished = copy.finish(BTreeMap::new(), &|_| false).unwrap();
        assert!(finished.warnings.is_empty(), "{:?}", finished.warnings);
        let (was, is) = (parts(file).0, parts(&finished.copy.bytes).0);
        assert!(!is.to_string().contains("compression"), "{extension}: {is}");
        assert_eq!([&was["nodes"], &was["materials"]], [&is["nodes"], &is["materials"]]);
        assert_eq!(
            is["buffers"].as_array().unwrap().len(),
            1,
            "{extension}: the place of unpacked bytes is gone"
        );
        let corners = |mesh: &Mesh| -> Vec<([f32; 3], [f32; 2], [f32; 3])> {
            let all = mesh.triangles.iter().flatten().map(|at| *at as usize);
            all.map(|at| (mesh.positions[at], mesh.uvs[at], mesh.normals[at]))
                .collect()
        };
        assert_eq!(corners(&reloaded(&finished).mesh), corners(&model.mesh), "{extension}");
    }
}

#[test]
fn packed_vertices_that_cannot_be_unpacked_are_told() {
    let (extension, file) = FILES[0];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it.glb");
    fs::write(&path, file).unwrap();
    let options = LoadOptions {
        smooth_degrees: Some(30.0),
        ..LoadOptions::default()
    };
    let model = load(&path, &options).unwrap();
    let (container, mut document) = Container::split(file).unwrap();
    document["meshes"][0]["primitives"][0]["extensions"][extension]["attributes"] = json!({});
    fs::write(&path, glb(&document, container.binary())).unwrap();
    let copy = ModelCopy::open(source(&path, &model), &BTreeSet::new(), CopyOptions::default()).unwrap();
    let finished = copy.finish(BTreeMap::new(), &|_| false).unwrap();
    let why = format!(
        "the copy of the model was made from the loaded mesh, with each node's place applied: its vertices are compressed \
         ({extension}); export the model without that to keep its structure"
    );
    assert_eq!(finished.warnings, [why]);
    let is = parts(&finished.copy.bytes).0;
    assert!(!is.to_string().contains("compression"), "{is}");
}

#[test]
fn packed_places_move_with_what_they_refer_to() {
    let packed =
        |from: usize| json!({ "EXT_meshopt_compression": { "buffer": 0, "byteOffset": from, "byteLength": 32 } });
    let views = json!([
        { "buffer": 0, "byteOffset": 64, "byteLength": 16 },
        { "buffer": 1, "byteOffset": 0, "byteLength": 96, "extensions": packed(32) },
        { "buffer": 1, "byteOffset": 96, "byteLength": 96, "extensions": packed(80) },
    ]);
    let dead = [json!({ "buffer": 0, "byteLength": 48 })];
    let file = |views: &Json| {
        let document = json!({ "asset": {}, "buffers": [{ "byteLength": 112 }], "bufferViews": views });
        Container::split(&glb(&document, &[7; 112])).unwrap()
    };
    let (mut container, mut document) = file(&views);
    container.forget(&mut document, &dead);
    assert_eq!(
        document["bufferViews"], views,
        "a packed view uses the bytes from 32 to 64"
    );
    let dead = [json!({ "buffer": 0, "byteLength": 32 })];
    container.forget(&mut document, &dead);
    assert_eq!(container.binary().len(), 80);
    let mut moved = views.clone();
    moved[0]["byteOffset"] = json!(32);
    moved[1]["extensions"] = packed(0);
    moved[2]["extensions"] = packed(48);
    assert_eq!(document["bufferViews"], moved);
    // The references of an unknown extension are not known either.
    let mut strange = views.clone();
    strange[0]["extensions"]["ACME_bits"] = json!({ "from": 3 });
    let (mut container, mut document) = file(&strange);
    container.forget(&mut document, &dead);
    assert_eq!((container.binary().len(), &document["bufferViews"]), (112, &strange));
}

#[test]
fn pictures_of_extensions_come_along_with_the_loaded_mesh() {
    let webp = b"RIFF\x04\0\0\0WEBP".to_vec();
    let ktx2 = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    for (extension, kind, bytes) in [
        ("EXT_texture_webp", "image/webp", webp),
        ("KHR_texture_basisu", "image/ktx2", ktx2),
    ] {
        let (mut document, mut binary) = document();
        let view = json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() });
        binary.extend(&bytes);
        let view = edit::push(&mut document, "bufferViews", view);
        document["images"][3] = json!({ "mimeType": kind, "bufferView": view });
        document["textures"][3] = json!({ "extensions": { extension: { "source": 3 } } });
        // Smoothed vertices would have to be split.
        let outline = json!({ "CESIUM_primitive_outline": { "indices": 2 } });
        document["meshes"][0]["primitives"][0]["extensions"] = outline;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("it.glb");
        fs::write(&path, glb(&document, &binary)).unwrap();
        let options = LoadOptions {
            smooth_degrees: Some(30.0),
            ..LoadOptions::default()
        };
        let model = load(&path, &options).unwrap();
        let copy = ModelCopy::open(
            source(&path, &model),
            &BTreeSet::from([1, 2].map(set)),
            CopyOptions::default(),
        )
        .unwrap();
        let finished = copy.finish(BTreeMap::new(), &|_| false).unwrap();
        let is = parts(&finished.copy.bytes).0;
        assert_eq!(is["extensionsRequired"], json!([extension]));
        let image = &is["images"][0];
        assert_eq!(
            (&image["mimeType"], is["images"].as_array().unwrap().len()),
            (&json!(kind), 1)
        );
        assert_eq!(color_of(&reloaded(&finished)), bytes, "{extension}");
    }
}
