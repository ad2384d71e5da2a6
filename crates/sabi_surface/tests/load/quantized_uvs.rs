//! Texture coordinates that quantizers store under a transform.

use sabi_surface::load::LoadOptions;
use sabi_surface::model::{Model, UvDecoding};
use serde_json::{Value, json};

use crate::builder::{F32, Gltf, U16, floats, shorts};

const IDENTITY: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Stored coordinates of a triangle, by kind of accessor.
#[derive(Clone, Copy)]
enum StoredUvs {
    /// 16-bit integers as they are.
    Integers([u16; 6]),
    /// 16-bit integers as fractions of 1.
    Fractions([u16; 6]),
    Floats([f32; 6]),
}

fn transform(scale: [f32; 2], offset: [f32; 2]) -> Value {
    json!({ "KHR_texture_transform": { "scale": scale, "offset": offset } })
}

/// A textured triangle with stored coordinates; its base color and normal map have transforms.
fn triangle(stored: StoredUvs, base_color: Option<Value>, normal: Option<Value>) -> Gltf {
    let mut file = Gltf::new();
    let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let uvs = match stored {
        StoredUvs::Integers(values) => file.accessor(U16, "VEC2", 3, &shorts(&values)),
        StoredUvs::Fractions(values) => {
            let uvs = file.accessor(U16, "VEC2", 3, &shorts(&values));
            file.json["accessors"][uvs]["normalized"] = json!(true);
            uvs
        }
        StoredUvs::Floats(values) => file.accessor(F32, "VEC2", 3, &floats(&values)),
    };
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    file.push("images", json!({ "uri": "data:image/png;base64,AQID" }));
    file.push("textures", json!({ "source": 0 }));
    let texture = |extensions: Option<Value>| match extensions {
        Some(extensions) => json!({ "index": 0, "extensions": extensions }),
        None => json!({ "index": 0 }),
    };
    file.push(
        "materials",
        json!({ "pbrMetallicRoughness": { "baseColorTexture": texture(base_color) }, "normalTexture": texture(normal) }),
    );
    let attributes = json!({ "POSITION": positions, "TEXCOORD_0": uvs });
    file.place("leaf", json!({ "attributes": attributes, "material": 0 }));
    file
}

/// The coordinates of the maps, how they were decoded, and the transforms that are left of base color and normal map.
type LoadedUvs = (Vec<[f32; 2]>, Option<UvDecoding>, [[[f32; 3]; 2]; 2]);

/// Loads a file without a warning.
fn loaded(file: &Gltf) -> LoadedUvs {
    let model: Model = file.model();
    assert_eq!(model.warnings, [""; 0]);
    let material = &model.materials[0];
    let left = [&material.base_color, &material.normal].map(|used| used.as_ref().unwrap().transform);
    (model.mesh.uvs.clone(), material.uv_decoding, left)
}

#[test]
fn integers_under_one_transform_are_laid_out_by_it() {
    let scale = [1.0 / 4096.0, 1.0 / 2048.0];
    let decode = || Some(transform(scale, [0.125, 0.25]));
    let file = triangle(StoredUvs::Integers([0, 0, 2048, 0, 0, 1024]), decode(), decode());
    let decoding = UvDecoding {
        scale,
        offset: [0.125, 0.25],
    };
    let uvs = vec![[0.125, 0.25], [0.625, 0.25], [0.125, 0.75]];
    assert_eq!(loaded(&file), (uvs, Some(decoding), [IDENTITY; 2]));
}

#[test]
fn twelve_bits_of_sixteen_are_laid_out_by_their_transform() {
    let decode = || Some(transform([16.0, 16.0], [0.0, 0.0]));
    let file = triangle(StoredUvs::Fractions([0, 0, 4095, 0, 0, 4095]), decode(), decode());
    let (uvs, decoding, left) = loaded(&file);
    let most = 4095.0 / 65535.0 * 16.0;
    assert_eq!(uvs, [[0.0, 0.0], [most, 0.0], [0.0, most]]);
    assert_eq!(decoding.unwrap().scale, [16.0; 2]);
    assert_eq!(left, [IDENTITY; 2]);
}

#[test]
fn where_transforms_differ_that_of_the_normal_map_counts_before_that_of_base_color() {
    let file = triangle(
        StoredUvs::Integers([0, 0, 1024, 0, 0, 1024]),
        Some(transform([1.0 / 2048.0; 2], [0.5, 0.0])),
        Some(transform([1.0 / 1024.0; 2], [0.0, 0.0])),
    );
    let (uvs, _, [base_color, normal]) = loaded(&file);
    assert_eq!(uvs, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(normal, IDENTITY);
    assert_eq!(
        base_color,
        [[0.5, 0.0, 0.5], [0.0, 0.5, 0.0]],
        "what it does to decoded coordinates"
    );
}

#[test]
fn a_transform_that_leads_into_the_unit_square_counts_before_one_that_does_not() {
    let file = triangle(
        StoredUvs::Integers([0, 0, 1024, 0, 0, 1024]),
        Some(transform([1.0 / 1024.0; 2], [0.0, 0.0])),
        Some(transform([1.0 / 256.0; 2], [0.0, 0.0])),
    );
    let (uvs, ..) = loaded(&file);
    assert_eq!(uvs[1], [1.0, 0.0], "the normal map is tiled four times");
}

#[test]
fn a_tiled_texture_over_an_ordinary_layout_is_no_decoding() {
    let tiled = || Some(transform([4.0, 4.0], [0.0, 0.0]));
    for stored in [
        StoredUvs::Fractions([0, 0, 65535, 0, 0, 65535]),
        StoredUvs::Floats([0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
    ] {
        let (uvs, decoding, left) = loaded(&triangle(stored, tiled(), tiled()));
        assert_eq!(uvs, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!((decoding, left), (None, [[[4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]; 2]));
    }
}

#[test]
fn floats_are_decoded_only_from_a_tiny_corner_into_the_unit_square() {
    let stored = |side: f32| StoredUvs::Floats([0.0, 0.0, side, 0.0, 0.0, side]);
    let cases = [
        (1.0 / 16.0, 16.0, Some(16.0)),
        (1.0 / 4.0, 4.0, None),
        (1.0 / 16.0, 64.0, None),
    ];
    for (side, scale, expected) in cases {
        let decode = || Some(transform([scale; 2], [0.0, 0.0]));
        let (_, decoding, _) = loaded(&triangle(stored(side), decode(), decode()));
        assert_eq!(decoding.map(|decoding| decoding.scale[0]), expected, "{side} × {scale}");
    }
}

#[test]
fn a_texture_that_is_turned_or_mirrored_leaves_the_scale_of_the_quantizer() {
    let turned =
        json!({ "KHR_texture_transform": { "rotation": 1.0, "scale": [0.001, 0.0005], "offset": [3.0, 4.0] } });
    let mirrored = transform([-0.001, 0.0005], [1.0, 0.0]);
    for extensions in [turned, mirrored] {
        let stored = StoredUvs::Integers([0, 0, 1000, 0, 0, 2000]);
        let (uvs, decoding, [base_color, normal]) =
            loaded(&triangle(stored, Some(extensions.clone()), Some(extensions)));
        let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
        assert!(near(uvs[1][0], 1.0) && near(uvs[2][1], 1.0), "{uvs:?}");
        assert_eq!(decoding.unwrap().offset, [0.0; 2]);
        assert_eq!(base_color, normal);
        let [[u, ..], [v, ..]] = base_color;
        assert!(near(u.hypot(v), 1.0), "what is left turns or mirrors: {base_color:?}");
    }
}

#[test]
fn a_turned_texture_over_an_ordinary_layout_is_no_decoding() {
    let turned = || Some(json!({ "KHR_texture_transform": { "rotation": 1.0 } }));
    let stored = StoredUvs::Fractions([0, 0, 65535, 0, 0, 65535]);
    let (uvs, decoding, _) = loaded(&triangle(stored, turned(), turned()));
    assert_eq!((uvs[1], decoding), ([1.0, 0.0], None));
}

#[test]
fn a_texture_on_another_set_tells_the_way_back_where_those_on_the_set_do_not() {
    let plain = json!({ "KHR_texture_transform": { "scale": [0.001, 0.001], "offset": [0.0, 0.0], "texCoord": 1 } });
    let turned = json!({ "KHR_texture_transform": { "rotation": 1.0, "scale": [0.004, 0.004] } });
    for base_color in [turned, plain.clone()] {
        let stored = StoredUvs::Integers([0, 0, 1000, 0, 0, 1000]);
        let mut file = triangle(stored, Some(base_color), Some(plain.clone()));
        let second = file.floats("VEC2", &[0.0, 0.0, 250.0, 0.0, 0.0, 250.0]);
        file.primitive()["attributes"]["TEXCOORD_1"] = json!(second);
        let model = file.model();
        assert_eq!(model.mesh.uvs[1], [1.0, 0.0]);
        assert_eq!(model.materials[0].uv_decoding.unwrap().scale, [0.001; 2]);
    }
}

#[test]
fn a_texture_that_is_not_read_tells_the_way_back() {
    for (extension, member) in [
        ("KHR_materials_clearcoat", "clearcoatNormalTexture"),
        ("KHR_materials_iridescence", "iridescenceTexture"),
    ] {
        let mut file = triangle(StoredUvs::Integers([0, 0, 1000, 0, 0, 1000]), None, None);
        let texture = json!({ "index": 0, "extensions": transform([0.001, 0.001], [0.0, 0.0]) });
        file.json["materials"] = json!([{ "extensions": { extension: { member: texture } } }]);
        let model = file.model();
        assert_eq!(model.mesh.uvs[1], [1.0, 0.0], "{member}");
    }
}

#[test]
fn a_transform_of_another_set_leaves_an_ordinary_layout_alone() {
    let halved = || Some(json!({ "KHR_texture_transform": { "scale": [0.5, 0.5], "texCoord": 1 } }));
    let mut file = triangle(StoredUvs::Fractions([0, 0, 65535, 0, 0, 65535]), halved(), halved());
    let second = file.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(second);
    let (uvs, decoding, _) = loaded(&file);
    assert_eq!((uvs[1], decoding), ([1.0, 0.0], None));
}

#[test]
fn only_the_chosen_set_is_decoded() {
    let decode = || Some(transform([1.0 / 1024.0; 2], [0.0, 0.0]));
    let mut file = triangle(StoredUvs::Integers([0, 0, 1024, 0, 0, 1024]), decode(), decode());
    let plain = file.floats("VEC2", &[0.0, 0.0, 0.5, 0.0, 0.0, 0.5]);
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(plain);
    let options = LoadOptions {
        uv_set: 1,
        ..LoadOptions::default()
    };
    let model = file.load_with(&options).unwrap();
    assert_eq!(model.mesh.uvs[1], [0.5, 0.0]);
    assert_eq!(model.mesh.set(0).unwrap().0[1], [1024.0, 0.0]);
    let base_color = model.materials[0].base_color.as_ref().unwrap();
    assert_eq!(
        base_color.transform,
        [[1.0 / 1024.0, 0.0, 0.0], [0.0, 1.0 / 1024.0, 0.0]]
    );
}
