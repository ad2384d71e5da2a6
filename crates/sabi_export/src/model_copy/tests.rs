use std::fs;
use std::sync::Arc;

use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::Wrap;
use serde_json::json;

use super::*;

mod embedded_files;
mod faithful;
mod file;
mod geometry;
mod looks;
mod packed_files;
mod udim;

/// Bytes that stand for a picture: only their place matters here.
fn picture(name: &str) -> Vec<u8> {
    [b"\x89PNG", name.repeat(40).as_bytes()].concat()
}

/// Positions, texture coordinates and indices of a triangle.
fn triangle() -> Vec<u8> {
    let floats: [f32; 15] = [0., 0., 0., 1., 0., 0., 0., 1., 0., 0.1, 0.1, 0.9, 0.1, 0.1, 0.9];
    let indices = [0_u16, 1, 2];
    let floats = floats.iter().flat_map(|value| value.to_le_bytes());
    floats
        .chain(indices.iter().flat_map(|index| index.to_le_bytes()))
        .collect()
}

/// One that stays, one that is baked, and one that nothing uses.
fn materials() -> Json {
    let transform = json!({ "KHR_texture_transform": { "scale": [2, 2] } });
    json!([
        { "name": "glass", "pbrMetallicRoughness": { "baseColorTexture": { "index": 3 } }, "alphaMode": "BLEND" },
        {
            "name": "cloth", "doubleSided": true, "extras": { "shader": 7 },
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": 0, "extensions": transform }, "baseColorFactor": [1, 0, 0, 1],
                "extras": "kept"
            },
            "normalTexture": { "index": 1, "scale": 2 },
            "emissiveFactor": [1, 1, 1],
            "extensions": {
                "KHR_materials_emissive_strength": { "emissiveStrength": 3 },
                "KHR_materials_sheen": { "sheenColorTexture": { "index": 2 } }
            }
        },
        { "name": "unused", "normalTexture": { "index": 2 } }
    ])
}

/// Creates a document with a triangle of each of two materials and one without a material, images before and after the
/// geometry, and various data that Sabi does not know.
fn document() -> (Json, Vec<u8>) {
    let mut binary = Vec::new();
    let mut views = Vec::new();
    for bytes in [
        picture("old color"),
        triangle(),
        picture("old normal"),
        picture("sheen"),
        picture("glass"),
    ] {
        binary.resize(binary.len().next_multiple_of(4), 0);
        views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() }));
        binary.extend_from_slice(&bytes);
    }
    let primitive = json!({ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2 });
    let with = |material: usize| {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(material);
        primitive
    };
    let image = |name: &str, view: usize| json!({ "name": name, "mimeType": "image/png", "bufferView": view });
    let document = json!({
        "asset": { "version": "2.0", "copyright": "somebody", "extras": { "a": [1, 2.5, null] } },
        "extensionsUsed": ["KHR_texture_transform", "KHR_materials_sheen", "EXT_unheard_of", "VENDOR_name_only",
                           "KHR_materials_emissive_strength"],
        "extensions": { "EXT_unheard_of": { "deep": [{ "er": true }] } },
        "scene": 0,
        "scenes": [{ "nodes": [0], "extras": "kept" }],
        "nodes": [{ "mesh": 0, "name": "body", "extensions": { "EXT_unheard_of": { "weight": 0.1 } } }],
        "animations": [{ "channels": [], "samplers": [], "name": "wave" }],
        "meshes": [{ "primitives": [with(1), with(0), primitive.clone()], "extras": { "x": 1e-9 } }],
        "materials": materials(),
        "samplers": [{ "wrapS": 33648 }],
        "textures": [{ "source": 0 }, { "source": 1, "sampler": 0 }, { "source": 2 }, { "source": 3 }],
        "images": [image("color", 0), image("normal", 2), image("sheen", 3), image("glass", 4)],
        "accessors": [
            { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC2" },
            { "bufferView": 1, "byteOffset": 60, "componentType": 5123, "count": 3, "type": "SCALAR" }
        ],
        "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }],
    });
    (document, binary)
}

fn glb() -> Vec<u8> {
    let (mut document, binary) = document();
    Container::glb(binary).join(&mut document).unwrap()
}

fn map(name: &str, is_written: bool) -> Option<MapFile> {
    let bytes = Arc::new(picture(name));
    let name = format!("{name}.png");
    Some(MapFile {
        name,
        bytes,
        is_written,
    })
}

/// Maps of every kind.
fn all_maps() -> MaterialMaps {
    MaterialMaps {
        base_color: map("new color", true),
        packed: map("new packed", false),
        packed_surface: true,
        packed_occlusion: true,
        normal: map("new normal", false),
        emission: map("new emission", true),
        emission_factor: [1.0; 3],
        emission_strength: 2.5,
        has_opacity: true,
        ..MaterialMaps::default()
    }
}

/// The set of a material.
fn set(material: u32) -> SetKey {
    SetKey {
        material,
        uv_tile: [0, 0],
        udim: None,
    }
}

/// The copy of a file with maps by material of the model.
fn copied(name: &str, files: &[(&str, &[u8])], maps: &[(u32, MaterialMaps)]) -> FinishedCopy {
    copied_with(CopyOptions::default(), name, files, maps)
}

fn source<'m>(path: &'m Path, model: &'m Model) -> CopySource<'m> {
    CopySource {
        path,
        model,
        uv_set: 0,
        unwrapped_uv_set: None,
    }
}

fn copied_with(
    options: CopyOptions,
    name: &str,
    files: &[(&str, &[u8])],
    maps: &[(u32, MaterialMaps)],
) -> FinishedCopy {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join(name);
    let model = load(&path, &LoadOptions::default()).unwrap();
    let maps: BTreeMap<SetKey, MaterialMaps> = maps.iter().map(|(of, maps)| (set(*of), maps.clone())).collect();
    let baked = maps.keys().copied().collect();
    let copy = ModelCopy::open(source(&path, &model), &baked, options).unwrap();
    copy.finish(maps, &|_| false).unwrap()
}

/// A file's document and the bytes of a buffer view.
fn parts(file: &[u8]) -> (Json, impl Fn(usize) -> Vec<u8>) {
    let (container, document) = Container::split(file).unwrap();
    let views = document["bufferViews"].clone();
    let binary = container.binary().to_vec();
    let view = move |index: usize| {
        let number = |key: &str| views[index][key].as_u64().unwrap_or(0) as usize;
        binary[number("byteOffset")..][..number("byteLength")].to_vec()
    };
    (document, view)
}

/// Maps that need no tangents.
fn flat_maps() -> MaterialMaps {
    MaterialMaps {
        normal: None,
        ..all_maps()
    }
}

#[test]
fn everything_except_the_baked_material_stays_unchanged() {
    let before = glb();
    // The model's materials are those in use, in the file's order: glass, cloth, none.
    let finished = copied("it.glb", &[("it.glb", &before)], &[(1, flat_maps())]);
    assert_eq!((finished.copy.name.as_str(), finished.beside.len()), ("it.glb", 0));
    let ((was, was_view), (is, is_view)) = (parts(&before), parts(&finished.copy.bytes));
    for key in [
        "asset",
        "extensions",
        "scene",
        "scenes",
        "nodes",
        "animations",
        "meshes",
        "accessors",
    ] {
        assert_eq!(was[key], is[key], "{key}");
    }
    for (list, places) in [
        ("materials", &[0_usize, 2][..]),
        ("textures", &[2, 3][..]),
        ("images", &[2, 3][..]),
        ("samplers", &[0][..]),
    ] {
        for &place in places {
            assert_eq!(was[list][place], is[list][place], "{list}[{place}]");
        }
    }
    for view in [1, 3, 4] {
        assert_eq!(was_view(view), is_view(view), "bufferViews[{view}]");
    }
}

#[test]
fn the_baked_material_has_its_maps_and_unused_data_is_removed() {
    let finished = copied("it.glb", &[("it.glb", &glb())], &[(1, all_maps())]);
    let (is, is_view) = parts(&finished.copy.bytes);
    let cloth = json!({
        "name": "cloth", "doubleSided": true, "extras": { "shader": 7 },
        "pbrMetallicRoughness": {
            "extras": "kept", "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 1 }
        },
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 2.5 } },
        "normalTexture": { "index": 4 }, "occlusionTexture": { "index": 1 }, "emissiveTexture": { "index": 5 },
        "emissiveFactor": [1.0, 1.0, 1.0], "alphaMode": "BLEND"
    });
    assert_eq!(is["materials"][1], cloth);
    let used = json!(["EXT_unheard_of", "VENDOR_name_only", "KHR_materials_emissive_strength"]);
    assert_eq!(
        is["extensionsUsed"], used,
        "transform and sheen are gone, a bare name stays"
    );
    for (texture, name) in [
        (0_usize, "new color"),
        (1, "new packed"),
        (4, "new normal"),
        (5, "new emission"),
    ] {
        let image = &is["images"][is["textures"][texture]["source"].as_u64().unwrap() as usize];
        assert_eq!(is_view(image["bufferView"].as_u64().unwrap() as usize), picture(name));
    }
    let holds = |what: &str| {
        finished
            .copy
            .bytes
            .windows(what.len())
            .any(|bytes| bytes == what.as_bytes())
    };
    assert!(
        !holds("old colorold color") && !holds("old normalold normal"),
        "what nobody shows is gone"
    );
}

#[test]
fn a_gltf_file_keeps_its_buffers_and_names_maps_beside_it() {
    let (mut document, binary) = document();
    document["buffers"][0]["uri"] = json!("data/geo%20metry.bin");
    document["images"][3] = json!({ "uri": "glass pane.png" });
    document["images"][2] = json!({ "uri": "data:image/png;base64,iVBORw==" });
    let text = document.to_string();
    let glass = picture("pane");
    let files: [(&str, &[u8]); 3] = [
        ("old one.gltf", text.as_bytes()),
        ("geo metry.bin", &binary),
        ("glass pane.png", &glass),
    ];
    let finished = copied("old one.gltf", &files, &[(1, all_maps())]);
    assert!(finished.warnings.is_empty(), "{:?}", finished.warnings);
    assert_eq!(finished.copy.name, "old one.gltf");
    let beside = |name: &str| {
        finished
            .beside
            .iter()
            .find(|file| file.name == name)
            .map(|file| &file.bytes)
    };
    assert_eq!(beside("old one.bin"), Some(&binary), "buffers are copied byte for byte");
    assert_eq!(beside("glass pane.png"), Some(&glass));
    assert_eq!(beside("new packed.png"), Some(&picture("new packed")));
    assert_eq!(beside("new color.png"), None, "the bake writes it");
    // Normals and tangents of three vertices.
    assert_eq!(beside("old one_vertices.bin").map(Vec::len), Some(3 * (12 + 16)));
    assert_eq!(finished.beside.len(), 5);
    let is: Json = serde_json::from_slice(&finished.copy.bytes).unwrap();
    assert_eq!(is["buffers"][0]["uri"], "old%20one.bin");
    assert_eq!(is["images"][3]["uri"], "glass%20pane.png");
    assert_eq!(is["images"][2], document["images"][2]);
    assert_eq!(is["images"][0]["uri"], "new%20color.png");
    assert_eq!(
        is["buffers"][1],
        json!({ "byteLength": 84, "uri": "old%20one_vertices.bin" })
    );
    let (views, before) = (
        is["bufferViews"].as_array().unwrap(),
        document["bufferViews"].as_array().unwrap(),
    );
    assert_eq!(views[..before.len()], before[..]);
}

#[test]
fn a_constant_channel_is_a_factor_without_an_image() {
    let constants = MaterialMaps {
        base_color_factor: [0.5, 0.25, 0.7, 1.0],
        metallic_factor: 0.0,
        roughness_factor: 0.7,
        ..MaterialMaps::default()
    };
    let (before, seen) = (glb(), [(0, constants.clone()), (1, constants.clone()), (2, constants)]);
    let finished = copied("it.glb", &[("it.glb", &before)], &seen);
    let (is, _) = parts(&finished.copy.bytes);
    let looks = json!({ "baseColorFactor": [0.5, 0.25, 0.7, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7 });
    for material in [0_usize, 3] {
        assert_eq!(is["materials"][material]["pbrMetallicRoughness"], looks);
    }
    // The third primitive named no material.
    let of = |primitive: usize| is["meshes"][0]["primitives"][primitive]["material"].clone();
    assert_eq!([of(0), of(1), of(2)], [json!(1), json!(0), json!(3)]);
    assert_eq!(
        is["materials"][0].get("alphaMode"),
        None,
        "what the graph says is opaque"
    );
    assert_eq!(
        is["textures"].as_array().unwrap().len(),
        3,
        "the last one is gone, others keep their places"
    );
}

#[test]
fn an_obj_model_is_copied_as_it_was_loaded() {
    let obj = "mtllib it.mtl\no left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nvt 0.9 0.9\n\
               usemtl wood\nf 1/1 2/2 3/3\no right\nusemtl steel\nf 2/2 4/4 3/3\n";
    let library = "newmtl wood\nmap_Kd wood.png\nnewmtl steel\nmap_Kd steel.png\nPr 0.25\n";
    let (wood, steel) = (picture("wood"), picture("steel"));
    let files: [(&str, &[u8]); 4] = [
        ("it.obj", obj.as_bytes()),
        ("it.mtl", library.as_bytes()),
        ("wood.png", &wood),
        ("steel.png", &steel),
    ];
    let finished = copied("it.obj", &files, &[(0, all_maps())]);
    assert_eq!(finished.copy.name, "it.glb");
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files.iter().copied().chain([("it.glb", &finished.copy.bytes[..])]) {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let [was, is] = ["it.obj", "it.glb"].map(|name| load(&folder.path().join(name), &LoadOptions::default()).unwrap());
    let corners = |model: &Model| -> Vec<([f32; 3], [f32; 2], [f32; 4])> {
        let mesh = &model.mesh;
        let all = mesh.triangles.iter().flatten().map(|at| *at as usize);
        // Unit vectors are normalized again when they are read.
        let rounded = |tangent: [f32; 4]| tangent.map(|part| (part * 1e5).round());
        all.map(|at| (mesh.positions[at], mesh.uvs[at], rounded(mesh.tangents[at])))
            .collect()
    };
    assert_eq!(corners(&was), corners(&is));
    assert_eq!(
        (&was.mesh.triangle_material, &was.parts),
        (&is.mesh.triangle_material, &is.parts)
    );
    assert_eq!(
        (is.materials[1].roughness_factor, is.materials[1].metallic_factor),
        (0.25, 0.0)
    );
    let bytes = |texture: &Option<sabi_surface::model::TextureRef>| {
        is.images[texture.as_ref().unwrap().image]
            .bytes
            .clone()
            .unwrap()
            .to_vec()
    };
    assert_eq!(bytes(&is.materials[0].base_color), picture("new color"));
    let used = parts(&finished.copy.bytes).0["extensionsUsed"].clone();
    assert_eq!(used, json!(["KHR_materials_emissive_strength"]));
    assert_eq!(
        bytes(&is.materials[1].base_color),
        steel,
        "a material that was not baked keeps its looks"
    );
    assert_eq!(is.materials[0].base_color.as_ref().unwrap().wrap, [Wrap::Clamp; 2]);
    assert!(!finished.copy.bytes.windows(8).any(|bytes| bytes == b"woodwood"));
}
