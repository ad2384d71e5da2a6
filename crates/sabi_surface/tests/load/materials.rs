//! Materials, textures and pictures of glTF files.

use std::sync::Arc;

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::{ModelFinish, ModelMaterial, TextureRef, Wrap};
use serde_json::{Value, json};

use crate::builder::Gltf;

const IDENTITY: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// The triangle with one material.
fn with_material(material: Value) -> Gltf {
    let mut file = Gltf::triangle();
    let material = file.push("materials", material);
    file.primitive()["material"] = json!(material);
    file
}

/// The triangle with one material that has one picture as its base color.
fn with_picture(image: Value) -> Gltf {
    let mut file = with_material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    file.push("textures", json!({ "source": 0 }));
    file.push("images", image);
    file
}

#[test]
fn factors_are_read_and_emission_includes_its_strength() {
    let file = with_material(json!({
        "name": "lamp",
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6 },
        "emissiveFactor": [1, 0.5, 0],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 4 } }
    }));
    let expected = ModelMaterial {
        name: "lamp".into(),
        file_index: Some(0),
        base_color_factor: [0.1, 0.2, 0.3, 0.4],
        ignores_alpha: true,
        is_double_sided: false,
        metallic_factor: 0.5,
        roughness_factor: 0.6,
        emission_factor: [4.0, 2.0, 0.0],
        ..ModelMaterial::default()
    };
    assert_eq!(file.model().materials, [expected]);
}

#[test]
fn alpha_of_gltf_is_believed_and_a_material_that_nobody_sees_is_told() {
    for (mode, warnings) in [
        ("OPAQUE", &[][..]),
        ("BLEND", &["The file has material `glass` invisible: its alpha is 0."]),
        (
            "MASK",
            &["The file has material `glass` invisible: its alpha is below its cutoff."],
        ),
    ] {
        let pbr = json!({ "baseColorFactor": [1, 1, 1, 0] });
        let file = with_material(json!({ "name": "glass", "alphaMode": mode, "pbrMetallicRoughness": pbr }));
        let model = file.model();
        assert_eq!(model.materials[0].base_color_factor[3], 0.0, "{mode}");
        assert_eq!(model.warnings, warnings, "{mode}");
    }
}

#[test]
fn only_the_alpha_mode_mask_has_a_cutoff_which_is_a_half_by_default() {
    let hidden = &["The file has material `leaf` invisible: its alpha is below its cutoff."][..];
    for (mode, cutoff, alpha, expected, warnings) in [
        ("MASK", json!(0.25), 0.25, Some(0.25), &[][..]),
        ("MASK", json!(0.3), 0.25, Some(0.3), hidden),
        ("MASK", json!(0), 0.0, Some(0.0), &[]),
        ("MASK", json!(null), 0.25, Some(0.5), hidden),
        ("MASK", json!(null), 0.5, Some(0.5), &[]),
        ("BLEND", json!(null), 0.25, None, &[]),
        ("OPAQUE", json!(null), 0.25, None, &[]),
    ] {
        let mut material = json!({ "name": "leaf", "alphaMode": mode,
            "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, alpha] } });
        if !cutoff.is_null() {
            material["alphaCutoff"] = cutoff.clone();
        }
        let model = with_material(material).model();
        assert_eq!(model.materials[0].alpha_cutoff, expected, "{mode} {cutoff}");
        assert_eq!(model.warnings, warnings, "{mode} {cutoff}");
    }
}

#[test]
fn extensions_give_a_coat_a_sheen_and_light_below_the_surface() {
    let mut file = with_material(json!({
        "extensions": {
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25,
                "clearcoatTexture": { "index": 0 }, "clearcoatNormalTexture": { "index": 0, "texCoord": 5 } },
            "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyRotation": 1.5 },
            "KHR_materials_sheen": { "sheenColorFactor": [0.125, 0.25, 0.5] },
            "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 0.5 },
            "KHR_materials_transmission": { "transmissionFactor": 2 }
        }
    }));
    file.push("textures", json!({ "source": 0 }));
    file.push("images", json!({ "uri": "data:image/png;base64,AQID" }));
    let model = file.model();
    let finish = &model.materials[0].finish;
    assert_eq!((finish.coat.factor, finish.coat_roughness.factor), (0.75, 0.25));
    assert_eq!(finish.coat.texture.as_ref().map(|texture| texture.image), Some(0));
    assert_eq!((finish.anisotropy.factor, finish.anisotropy_rotation), (0.5, 1.5));
    assert_eq!(finish.sheen.factor, [0.125, 0.25, 0.5]);
    assert_eq!(
        (finish.subsurface.factor, finish.subsurface_color.factor),
        (0.5, [1.0; 3])
    );
    assert_eq!(finish.transmission.factor, 1.0);
    assert_eq!(finish.textures().count(), 1, "the normal map of the coat is not read");
    let told = ["The transmissionFactor of material 0 cannot be 2; 1 is taken."];
    assert_eq!(model.warnings, told);
    assert_eq!(
        with_material(json!({})).model().materials[0].finish,
        ModelFinish::default()
    );
}

#[test]
fn materials_in_use_keep_the_order_of_the_file_and_the_unnamed_one_comes_last() {
    let mut file = Gltf::triangle();
    file.json["materials"] = json!([{ "name": "a" }, { "name": "unused" }, { "name": "b" }]);
    let primitive = file.primitive().clone();
    let material = |index: usize| {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(index);
        primitive
    };
    file.json["meshes"][0]["primitives"] = json!([primitive, material(2), material(0), material(2)]);
    let model = file.model();
    let names: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["a", "b", ""]);
    assert_eq!(model.mesh.triangle_material, [2, 1, 0, 1]);
}

#[test]
fn a_texture_keeps_its_wrap_transform_and_uv_set() {
    let mut file = with_picture(json!({ "uri": "data:image/png;base64,AQID" }));
    file.push("samplers", json!({ "wrapS": 33071, "wrapT": 33648 }));
    file.json["textures"][0]["sampler"] = json!(0);
    file.json["materials"][0]["normalTexture"] = json!({ "index": 0, "scale": 0.5, "extensions": {
        "KHR_texture_transform": { "offset": [0.25, 0.5], "rotation": std::f32::consts::FRAC_PI_2, "scale": [2, 4] } } });
    file.json["materials"][0]["occlusionTexture"] = json!({ "index": 0, "texCoord": 1 });
    let model = file.model();
    let [material] = &model.materials[..] else {
        panic!("one material")
    };
    let wrap = [Wrap::Clamp, Wrap::Mirror];
    let plain = TextureRef {
        image: 0,
        wrap,
        transform: IDENTITY,
        uv_set: 0,
    };
    assert_eq!(material.base_color, Some(plain.clone()));
    assert_eq!(material.occlusion, Some(TextureRef { uv_set: 1, ..plain }));
    assert_eq!(material.normal_scale, 0.5);
    // A quarter turn counter-clockwise, v growing downward: +u goes to -v.
    let [row_u, row_v] = material.normal.as_ref().unwrap().transform;
    for (value, expected) in row_u.iter().chain(&row_v).zip([0.0, 4.0, 0.25, -2.0, 0.0, 0.5]) {
        assert!((value - expected).abs() < 1e-6, "{row_u:?} {row_v:?}");
    }
    assert_eq!(model.warnings, [""; 0]);
}

#[test]
fn pictures_come_from_data_from_views_and_from_files_with_spaces() {
    let bytes = |file: &Gltf| {
        let mut beside = |path: &str| match path {
            "my picture.png" => Ok(vec![4, 5, 6]),
            _ => Err("there is no such file".to_string()),
        };
        let model = load_bytes("test.glb", &file.glb(), &mut beside, &LoadOptions::default()).unwrap();
        let [image] = &model.images[..] else {
            panic!("one picture")
        };
        (
            image.name.clone(),
            image.bytes.clone().map(|bytes| bytes.to_vec()),
            model.warnings,
        )
    };
    let mut in_view = with_picture(json!({ "bufferView": 2, "mimeType": "image/png" }));
    in_view.view(&[7, 8, 9]);
    let missing = "The picture gone.png cannot be read: there is no such file.".to_string();
    for (file, name, expected) in [
        (
            with_picture(json!({ "uri": "data:image/png;base64,AQID" })),
            "image 0 of test.glb",
            Ok(vec![1, 2, 3]),
        ),
        (
            with_picture(json!({ "uri": "my%20picture.png" })),
            "my picture.png",
            Ok(vec![4, 5, 6]),
        ),
        (
            with_picture(json!({ "uri": "my picture.png" })),
            "my picture.png",
            Ok(vec![4, 5, 6]),
        ),
        (in_view, "image 0 of test.glb", Ok(vec![7, 8, 9])),
        (
            with_picture(json!({ "uri": "textures/gone.png" })),
            "gone.png",
            Err(missing),
        ),
    ] {
        let warnings: Vec<String> = expected.clone().err().into_iter().collect();
        assert_eq!(bytes(&file), (name.to_string(), expected, warnings));
    }
}

#[test]
fn a_picture_named_often_is_read_once_and_pictures_do_not_overlap() {
    let mut file = Gltf::triangle();
    let whole = file.view(&[9; 64]);
    let mut twin = file.json["bufferViews"][whole].clone();
    let twin_view = file.push("bufferViews", twin.clone());
    twin["byteLength"] = json!(63);
    let overlapping = file.push("bufferViews", twin);
    let primitive = file.primitive().clone();
    let mut primitives = Vec::new();
    let in_view = |view: usize| json!({ "bufferView": view });
    let same = json!({ "uri": "same.png" });
    let images = [
        same.clone(),
        same,
        in_view(whole),
        in_view(whole),
        in_view(twin_view),
        in_view(overlapping),
    ];
    for (number, image) in images.into_iter().enumerate() {
        file.push("images", image);
        file.push("textures", json!({ "source": number }));
        file.push("materials", json!({ "emissiveTexture": { "index": number } }));
        let mut primitive = primitive.clone();
        primitive["material"] = json!(number);
        primitives.push(primitive);
    }
    file.json["meshes"][0]["primitives"] = json!(primitives);
    let mut times = 0;
    let mut beside = |_: &str| {
        times += 1;
        Ok(vec![1])
    };
    let model = load_bytes("test.glb", &file.glb(), &mut beside, &LoadOptions::default()).unwrap();
    assert_eq!(times, 1);
    let [_, _, first, others @ .., last] = &model.images[..] else {
        panic!("six pictures");
    };
    for other in others {
        let (first, other) = (first.bytes.as_ref().unwrap(), other.bytes.as_ref().unwrap());
        assert!(Arc::ptr_eq(first, other), "pictures share a view");
    }
    // 124 bytes have no room for 64 and 63.
    let sentence = "The picture image 5 of test.glb cannot be read: the pictures of the file overlap.";
    assert_eq!(last.bytes, Err(sentence.into()));
    assert_eq!(model.warnings, [sentence]);
}

#[test]
fn the_picture_of_an_extension_is_read_where_there_is_no_other() {
    for (extension, is_read) in [
        ("EXT_texture_webp", true),
        ("KHR_texture_basisu", true),
        ("EXT_texture_avif", false),
        ("MSFT_texture_dds", false),
    ] {
        let mut file = with_picture(json!({ "uri": "data:image/png;base64,AQID" }));
        file.json["textures"][0] = json!({ "extensions": { extension: { "source": 0 } } });
        let unread = format!(
            "The picture image 0 of test.glb cannot be read: it is stored with {extension}, which is not read here."
        );
        let picture = file.model().images[0].bytes.clone().map(|bytes| bytes.to_vec());
        assert_eq!(picture, if is_read { Ok(vec![1, 2, 3]) } else { Err(unread) });
        let plain = file.push("images", json!({ "uri": "data:image/png;base64,BAUG" }));
        file.json["textures"][0]["source"] = json!(plain);
        let model = file.model();
        assert_eq!(&model.images[0].bytes.as_ref().unwrap()[..], [4, 5, 6], "{extension}");
        assert_eq!(model.warnings, [""; 0]);
    }
}

#[test]
fn a_broken_texture_takes_nothing_else_with_it() {
    let mut file = with_picture(json!({ "bufferView": 9 }));
    file.json["materials"][0]["normalTexture"] = json!({ "index": 7 });
    let model = file.model();
    assert!(model.images[0].bytes.is_err() && model.materials[0].normal.is_none());
    assert_eq!(
        model.warnings,
        [
            "A texture of material 0 is left out: there is no textures[7].",
            "The picture image 0 of test.glb cannot be read: the file is damaged: there is no bufferViews[9].",
        ]
    );
}
