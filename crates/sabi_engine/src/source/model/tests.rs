//! Naming of the results of a model, and the values where texture coordinates are missing.

use std::sync::Arc;

use sabi_surface::model::{Mesh, MissingUvs, Model, ModelImage, ModelMaterial, TextureRef, TextureUvs, Wrap};

use super::{kind_for, open_materials};
use crate::source::session_pictures::SessionPictures;

fn model(texture_uvs: Vec<TextureUvs>, missing_uvs: Vec<MissingUvs>) -> Model {
    Model {
        mesh: Mesh {
            texture_uvs,
            missing_uvs,
            triangle_material: vec![0, 1, 1, 0],
            ..Mesh::default()
        },
        ..Model::default()
    }
}

fn set(set: u32, uvs: &[[f32; 2]]) -> TextureUvs {
    TextureUvs {
        set,
        uvs: uvs.to_vec(),
        ..TextureUvs::default()
    }
}

#[test]
fn the_key_tells_which_set_has_which_coordinates() {
    let of = |sets: Vec<TextureUvs>| kind_for(&model(sets, Vec::new())).content;
    let [a, b] = [[0.0, 1.0], [2.0, 3.0]];
    let split = of(vec![set(1, &[a]), set(2, &[b])]);
    assert_ne!(split, of(vec![set(1, &[a]), set(3, &[b])]));
    assert_ne!(split, of(vec![set(1, &[a, b]), set(2, &[])]));
    let missing = MissingUvs {
        set: 1,
        triangles: 0..1,
    };
    assert_ne!(
        kind_for(&model(Vec::new(), vec![missing])).content,
        of(Vec::new()),
        "what lacks a set shows the factor"
    );
}

/// A BMP of one gray pixel.
fn bmp() -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [
        58_u32,
        0,
        54,
        40,
        1,
        1,
        1 | 24 << 16,
        0,
        4,
        2835,
        2835,
        0,
        0,
        0x0080_8080,
    ] {
        bytes.extend(word.to_le_bytes());
    }
    bytes
}

#[test]
fn triangles_without_the_set_of_a_picture_show_the_factor_with_a_warning() {
    let missing = MissingUvs {
        set: 1,
        triangles: 1..3,
    };
    let mut model = model(vec![set(1, &[])], vec![missing]);
    model.images = vec![ModelImage {
        name: "rust.bmp".to_owned(),
        bytes: Ok(Arc::from(bmp())),
    }];
    let painted = ModelMaterial {
        base_color: Some(TextureRef {
            image: 0,
            wrap: [Wrap::Repeat; 2],
            transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            uv_set: 1,
        }),
        ..ModelMaterial::default()
    };
    model.materials = vec![painted.clone(), painted];
    let mut warnings = Vec::new();
    let materials = open_materials(&model, &SessionPictures::default(), u64::MAX, 16, &mut warnings);
    let texture = materials[1].base_color.as_ref().unwrap();
    assert_eq!(
        [0, 1, 2, 3].map(|triangle| texture.covers(triangle)),
        [true, false, false, true]
    );
    // The first material has none of these triangles.
    assert_eq!(
        warnings,
        [
            "the base color picture rust.bmp is laid out by UV set 1, which some triangles of its material do not have; \
          there the factor is used alone"
        ]
    );
}

#[test]
fn roughness_and_metallic_of_pictures_of_their_own_are_opened() {
    let mut model = model(vec![set(1, &[])], Vec::new());
    model.images = vec![ModelImage {
        name: "rough.bmp".to_owned(),
        bytes: Ok(Arc::from(bmp())),
    }];
    let alone = TextureRef {
        image: 0,
        wrap: [Wrap::Repeat; 2],
        transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        uv_set: 1,
    };
    let worn = ModelMaterial {
        roughness: Some(alone.clone()),
        ..ModelMaterial::default()
    };
    let steel = ModelMaterial {
        metallic: Some(alone),
        ..ModelMaterial::default()
    };
    model.materials = vec![worn, steel];
    let mut warnings = Vec::new();
    let materials = open_materials(&model, &SessionPictures::default(), u64::MAX, 16, &mut warnings);
    let open = |material: usize| {
        [
            materials[material].roughness.is_some(),
            materials[material].metallic.is_some(),
        ]
    };
    assert_eq!((open(0), open(1)), ([true, false], [false, true]));
    assert!(warnings.is_empty(), "{warnings:?}");
}
