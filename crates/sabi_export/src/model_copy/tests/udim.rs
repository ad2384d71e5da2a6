//! Copies of models whose maps lie in several UDIM tiles.

use sabi_surface::model::Mesh;

use super::*;

/// Sets of the first two tiles and of the one above the first.
const TILES: [SetKey; 3] = [tile([0, 0], 1001), tile([1, 0], 1002), tile([0, -1], 1011)];

const fn tile(uv_tile: [i32; 2], udim: u32) -> SetKey {
    SetKey {
        material: 0,
        uv_tile,
        udim: Some(udim),
    }
}

/// Four triangles: two in the first tile, one in each of the others. The first three share a vertex.
const CORNERS: [([f32; 3], [f32; 2]); 9] = [
    ([0.0, 0.0, 0.0], [0.0, 0.0]),
    ([1.0, 0.0, 0.0], [1.0, 0.0]),
    ([1.0, 1.0, 0.0], [1.0, 1.0]),
    ([0.0, 1.0, 0.0], [0.0, 1.0]),
    ([2.0, 0.0, 0.0], [2.0, 0.0]),
    ([0.0, 0.0, 1.0], [0.25, -0.25]),
    ([1.0, 0.0, 1.0], [0.75, -0.25]),
    ([0.0, 1.0, 1.0], [0.25, -0.75]),
    ([9.0, 9.0, 9.0], [0.0, 0.0]),
];
const TRIANGLES: [[u16; 3]; 4] = [[0, 1, 2], [0, 2, 3], [1, 4, 2], [5, 6, 7]];

/// Tile of each triangle, by its place in [`TILES`].
const TILE_OF: [usize; 4] = [0, 0, 1, 2];

fn gltf(decoding: Option<Json>) -> Vec<u8> {
    let floats = |values: Vec<f32>| values.into_iter().flat_map(f32::to_le_bytes);
    let mut bytes: Vec<u8> = floats(CORNERS.iter().flat_map(|corner| corner.0).collect()).collect();
    // UVs under a transform are stored as quarters.
    match decoding {
        None => bytes.extend(floats(CORNERS.iter().flat_map(|corner| corner.1).collect())),
        Some(_) => {
            let quarters = CORNERS
                .iter()
                .flat_map(|corner| [corner.1[0] * 4.0, corner.1[1] * 4.0 + 4.0, 0.0, 0.0]);
            bytes.extend(quarters.flat_map(|value| (value as u16).to_le_bytes()));
        }
    }
    bytes.extend(TRIANGLES.as_flattened().iter().flat_map(|corner| corner.to_le_bytes()));
    let mut material = json!({ "name": "wood", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
    let mut uvs = json!({ "bufferView": 1, "componentType": 5126, "count": 9, "type": "VEC2" });
    let mut extensions = json!(["KHR_mesh_quantization"]);
    if let Some(transform) = &decoding {
        uvs["componentType"] = json!(5123);
        material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = transform.clone();
        extensions = json!(["KHR_mesh_quantization", "KHR_texture_transform"]);
    }
    let document = json!({
        "asset": { "version": "2.0" }, "extensionsUsed": extensions, "extensionsRequired": extensions,
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [material],
        "textures": [{ "source": 0 }], "images": [{ "uri": "old.<UDIM>.png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 9, "type": "VEC3", "min": [0, 0, 0], "max": [9, 9, 9] },
            uvs,
            { "bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR" }
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 108 }, { "buffer": 0, "byteOffset": 108, "byteLength": 72, "byteStride": 8 },
            { "buffer": 0, "byteOffset": 180, "byteLength": 24 }
        ],
        "buffers": [{ "byteLength": 204 }]
    });
    super::super::container::tests::glb(&document, &bytes)
}

/// Maps of a tile.
fn maps_of(udim: u32) -> MaterialMaps {
    MaterialMaps {
        base_color: map(&format!("color {udim}"), true),
        normal: map(&format!("normal {udim}"), true),
        ..MaterialMaps::default()
    }
}

/// The copy of a file with the maps of its tiles, read back.
fn copied_tiles(name: &str, files: &[(&str, &[u8])]) -> (FinishedCopy, Model, Model) {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join(name);
    let model = load(&path, &LoadOptions::default()).unwrap();
    let baked = BTreeSet::from(TILES);
    let copy = ModelCopy::open(source(&path, &model), &baked, CopyOptions::default()).unwrap();
    let maps = TILES.map(|key| (key, maps_of(key.udim.unwrap())));
    let finished = copy.finish(BTreeMap::from(maps), &|_| false).unwrap();
    let path = folder.path().join("copy.glb");
    fs::write(&path, &finished.copy.bytes).unwrap();
    let copied = load(&path, &LoadOptions::default()).unwrap();
    (finished, model, copied)
}

/// Positions and tangents of the corners of each triangle, its material, and its UVs.
type Triangle = ([[f32; 3]; 3], String, [[f32; 2]; 3]);

fn triangles(model: &Model) -> Vec<Triangle> {
    let mesh: &Mesh = &model.mesh;
    let of = mesh.triangles.iter().zip(&mesh.triangle_material);
    let triangle = |(corners, material): (&[u32; 3], &u32)| {
        let corners = corners.map(|at| at as usize);
        let name = model.materials[*material as usize].name.clone();
        (
            corners.map(|at| mesh.positions[at]),
            name,
            corners.map(|at| mesh.uvs[at]),
        )
    };
    of.map(triangle).collect()
}

fn assert_tiled(what: &str, model: &Model, copied: &Model) {
    let is = triangles(copied);
    let was = triangles(model);
    assert_eq!(is.len(), was.len(), "{what}");
    for (number, (positions, _, uvs)) in was.into_iter().enumerate() {
        let key = TILES[TILE_OF[number]];
        let (_, name, moved) = is.iter().find(|triangle| triangle.0 == positions).unwrap();
        assert_eq!(*name, format!("wood.{}", key.udim.unwrap()), "{what}");
        let [u, v] = key.uv_tile.map(|tile| tile as f32);
        assert_eq!(*moved, uvs.map(|uv| [uv[0] - u, uv[1] - v]), "{what}");
    }
    for material in &copied.materials {
        let udim = &material.name["wood.".len()..];
        let color = material.base_color.as_ref().unwrap();
        let bytes = copied.images[color.image].bytes.clone().unwrap().to_vec();
        assert_eq!(bytes, picture(&format!("color {udim}")), "{what}");
    }
}

#[test]
fn each_tile_is_a_material_of_its_own_with_uvs_in_the_unit_square() {
    let gltf = gltf(None);
    let (finished, model, copied) = copied_tiles("it.glb", &[("it.glb", &gltf)]);
    assert!(
        finished.warnings.iter().all(|warning| warning.contains("old.")),
        "{:?}",
        finished.warnings
    );
    assert_tiled("glTF", &model, &copied);
    let is = parts(&finished.copy.bytes).0;
    let primitives = is["meshes"][0]["primitives"].as_array().unwrap();
    let places: Vec<&Json> = primitives.iter().map(|primitive| &primitive["material"]).collect();
    assert_eq!(places.len(), 3, "{places:?}");
    assert_eq!(is["materials"].as_array().unwrap().len(), 3);
    let changes = finished.changes.iter().filter(|change| change.property == "TANGENT");
    let changed: Vec<&str> = changes.map(|change| change.material.as_str()).collect();
    assert_eq!(changed, ["wood.1001", "wood.1002", "wood.1011"]);
}

#[test]
fn an_obj_model_in_tiles_is_copied_with_a_material_for_each() {
    let mut obj = "mtllib none.mtl\n".to_owned();
    for (position, _) in CORNERS {
        obj += &format!("v {} {} {}\n", position[0], position[1], position[2]);
    }
    for (_, uv) in CORNERS {
        obj += &format!("vt {} {}\n", uv[0], 1.0 - uv[1]);
    }
    obj += "usemtl wood\n";
    for corners in TRIANGLES {
        let [a, b, c] = corners.map(|corner| corner + 1);
        obj += &format!("f {a}/{a} {b}/{b} {c}/{c}\n");
    }
    let (finished, model, copied) = copied_tiles("it.obj", &[("it.obj", obj.as_bytes())]);
    assert!(finished.warnings.is_empty(), "{:?}", finished.warnings);
    assert_tiled("OBJ", &model, &copied);
}

#[test]
fn tiles_of_quantized_uvs_are_moved_by_their_transform() {
    let transform = json!({ "KHR_texture_transform": { "scale": [0.25, 0.25], "offset": [0, -1] } });
    let file = gltf(Some(transform));
    let (finished, model, copied) = copied_tiles("it.glb", &[("it.glb", &file)]);
    assert_tiled("quantized", &model, &copied);
    let is = parts(&finished.copy.bytes).0;
    let transform = |material: usize| {
        is["materials"][material]["normalTexture"]["extensions"]["KHR_texture_transform"]["offset"].clone()
    };
    let expected = [json!([0.0, -1.0]), json!([-1.0, -1.0]), json!([0.0, 0.0])];
    assert_eq!([0, 1, 2].map(transform), expected);
}

#[test]
fn lines_of_a_tiled_material_keep_the_earlier_one() {
    let file = gltf(None);
    let (mut document, view) = parts(&file);
    let mut lines = document["meshes"][0]["primitives"][0].clone();
    lines["mode"] = json!(1);
    edit::push(&mut document["meshes"][0], "primitives", lines);
    let bytes: Vec<u8> = (0..3).flat_map(view).collect();
    let file = super::super::container::tests::glb(&document, &bytes);
    let (finished, ..) = copied_tiles("it.glb", &[("it.glb", &file)]);
    let is = parts(&finished.copy.bytes).0;
    let place = is["meshes"][0]["primitives"][3]["material"].as_u64().unwrap() as usize;
    assert_eq!((place, &is["materials"][place]["name"]), (3, &json!("wood")));
}
