//! UV sets, materials and pictures of FBX files.

use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::{ModelMaterial, TextureRef, Wrap};

use crate::fbx_builder::{Fbx, FbxValue, element, layer, mesh, properties, text};
use crate::promises;

/// Coordinates of a texture as they are.
const UNMOVED: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// The square with two UV sets, the second of them half as large, and a material whose normal map uses that one.
fn two_sets() -> Fbx {
    let mut file = Fbx::square();
    let square = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let half = square.iter().map(|x| x / 2.0).collect();
    let sets = [square, half].into_iter().zip(0..);
    let layers = sets.map(|(uvs, set)| layer("LayerElementUV", set, "UV", uvs, Some(vec![0, 1, 2, 3])));
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    *file.geometry() = mesh(1, &corners, &[0, 1, 2, -4], layers.collect());
    paint(&mut file, &[]);
    picture(&mut file, 20, "bumps.png", None, &[("UVSet", "KString", "UV1")]);
    file.connect(20, 10, Some("NormalMap"));
    file
}

/// Adds a material, 10, of the older kind to the board.
fn paint(file: &mut Fbx, entries: &[(&str, &str, &[f64])]) {
    let below = vec![
        element("ShadingModel", vec![text("phong")], vec![]),
        properties(entries),
    ];
    file.add("Material", 10, "paint", "", below);
    file.connect(10, 2, None);
}

/// Adds a texture with the path of its picture, or its bytes.
fn picture(file: &mut Fbx, id: i64, path: &str, bytes: Option<&[u8]>, words: &[(&str, &str, &str)]) {
    let word = |(name, kind, word): &(&str, &str, &str)| {
        element(
            "P",
            vec![text(name), text(kind), text(""), text(""), text(word)],
            vec![],
        )
    };
    let names = |path: &str| {
        vec![
            element("FileName", vec![text(&format!("C:\\somewhere\\{path}"))], vec![]),
            element("RelativeFilename", vec![text(path)], vec![]),
        ]
    };
    let mut below = names(path);
    below.push(element("Properties70", vec![], words.iter().map(word).collect()));
    file.add("Texture", id, "texture", "", below);
    let mut video = names(path);
    if let Some(bytes) = bytes {
        video.push(element("Content", vec![FbxValue::Bytes(bytes.to_vec())], vec![]));
    }
    file.add("Video", id + 1000, "video", "Clip", video);
    file.connect(id + 1000, id, None);
}

#[test]
fn uv_sets_have_numbers_in_their_order_and_textures_find_theirs_by_name() {
    let model = two_sets().model();
    assert_eq!(model.mesh.uv_set, Some(0));
    assert_eq!(model.materials[0].normal.as_ref().unwrap().uv_set, 1);
    let [other] = &model.mesh.texture_uvs[..] else {
        panic!("{:?}", model.mesh.texture_uvs)
    };
    assert_eq!((other.set, other.uvs[2]), (1, [0.5, 0.5]));
    assert_eq!(other.tangents.len(), 4, "its normal map needs them");
    let options = |uv_set| LoadOptions {
        uv_set,
        ..LoadOptions::default()
    };
    let second = two_sets().load_with(&options(1)).unwrap();
    promises::check(&second);
    assert_eq!((second.mesh.uv_set, second.mesh.uvs[2]), (Some(1), [0.5, 0.5]));
    assert!(second.mesh.texture_uvs.is_empty());
    let error = two_sets().load_with(&options(2)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "test.fbx: it has no UV set 2; it has the sets 0 and 1"
    );
}

#[test]
fn an_older_material_gives_color_shininess_and_opacity() {
    let mut file = Fbx::square();
    let entries: [(&str, &str, &[f64]); 7] = [
        ("DiffuseColor", "Color", &[0.5, 0.25, 1.0]),
        ("DiffuseFactor", "Number", &[0.5]),
        ("EmissiveColor", "Color", &[1.0, 0.5, 0.0]),
        ("EmissiveFactor", "Number", &[4.0]),
        ("ShininessExponent", "Number", &[25.0]),
        ("TransparentColor", "Color", &[1.0, 1.0, 1.0]),
        ("TransparencyFactor", "Number", &[0.25]),
    ];
    paint(&mut file, &entries);
    let expected = ModelMaterial {
        name: "paint".into(),
        base_color_factor: [0.25, 0.125, 0.5, 0.75],
        emission_factor: [4.0, 2.0, 0.0],
        roughness_factor: 0.5,
        metallic_factor: 0.0,
        ..ModelMaterial::default()
    };
    assert_eq!(file.model().materials, [expected]);
    let mut unseen = Fbx::square();
    paint(
        &mut unseen,
        &[
            ("TransparencyFactor", "Number", &[1.0]),
            ("TransparentColor", "Color", &[1.0, 1.0, 1.0]),
        ],
    );
    let unseen = unseen.model();
    assert_eq!(unseen.materials[0].base_color_factor[3], 1.0);
    assert_eq!(
        unseen.warnings,
        ["The file has material `paint` invisible; it is taken as opaque."]
    );
}

#[test]
fn a_color_out_of_its_range_is_told_and_clamped() {
    let mut file = Fbx::square();
    paint(&mut file, &[("DiffuseColor", "Color", &[4.0, 0.5, 0.0])]);
    let model = file.model();
    assert_eq!(model.materials[0].base_color_factor, [1.0, 0.5, 0.0, 1.0]);
    assert_eq!(
        model.warnings,
        ["The base color of material `paint` cannot be 4; 1 is taken."]
    );
}

#[test]
fn pictures_are_found_in_the_file_and_beside_it_but_never_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let outside = folder.path().join("outside.png");
    std::fs::write(&outside, [9]).unwrap();
    let inside = folder.path().join("inside");
    std::fs::create_dir_all(inside.join("board.fbm")).unwrap();
    std::fs::write(inside.join("board.fbm/unpacked.png"), [2]).unwrap();
    std::fs::write(inside.join("beside.png"), [3]).unwrap();
    let mut file = Fbx::square();
    paint(&mut file, &[]);
    let pictures: [(&str, &str, Option<&[u8]>); 4] = [
        ("DiffuseColor", "textures\\packed.png", Some(&[1])),
        ("EmissiveColor", "D:\\work\\unpacked.png", None),
        ("NormalMap", "/store/maps/beside.png", None),
        ("Bump", "unused.png", None),
    ];
    for (number, (property, path, bytes)) in (20..).zip(pictures) {
        picture(&mut file, number, path, bytes, &[]);
        file.connect(number, 10, Some(property));
    }
    let path = inside.join("board.fbx");
    std::fs::write(&path, file.binary()).unwrap();
    let model = load(&path, &LoadOptions::default()).unwrap();
    let read: Vec<(&str, &[u8])> = model
        .images
        .iter()
        .map(|image| (image.name.as_str(), &image.bytes.as_ref().unwrap()[..]))
        .collect();
    let expected: [(&str, &[u8]); 3] = [("packed.png", &[1]), ("beside.png", &[3]), ("unpacked.png", &[2])];
    assert_eq!(read, expected);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    assert!(model.files.contains(&inside.join("beside.png")));

    let mut astray = Fbx::square();
    paint(&mut astray, &[]);
    picture(&mut astray, 20, &outside.display().to_string(), None, &[]);
    astray.connect(20, 10, Some("DiffuseColor"));
    std::fs::write(&path, astray.binary()).unwrap();
    let model = load(&path, &LoadOptions::default()).unwrap();
    assert_eq!(
        model.warnings,
        ["The picture outside.png cannot be read: there is no such file."]
    );
}

/// The square with a texture that has properties of its own.
fn with_texture(entries: &[(&str, &str, &[f64])]) -> TextureRef {
    let mut file = Fbx::square();
    paint(&mut file, &[]);
    picture(&mut file, 20, "a.png", Some(&[1]), &[]);
    let texture = file.objects.iter_mut().find(|object| object.name == "Texture").unwrap();
    texture.below.push(properties(entries));
    texture.below.swap_remove(2);
    file.connect(20, 10, Some("DiffuseColor"));
    file.model().materials[0].base_color.clone().unwrap()
}

#[test]
fn a_texture_is_moved_and_wrapped_as_the_file_says() {
    let texture = with_texture(&[
        ("Scaling", "Vector", &[2.0, 4.0, 1.0]),
        ("Translation", "Vector", &[0.5, 0.0, 0.0]),
        ("WrapModeU", "enum", &[1.0]),
    ]);
    assert_eq!(texture.wrap, [Wrap::Clamp, Wrap::Repeat]);
    // Scaling and moving the picture scales and moves its coordinates the other way; v grows downward.
    let [[a, b, c], [d, e, f]] = texture.transform;
    let expected = [[0.5, 0.0, -0.25], [0.0, 0.25, 0.75]];
    for (is, expected) in [a, b, c, d, e, f].into_iter().zip(expected.concat()) {
        assert!((is - expected).abs() < 1e-5, "{:?}", texture.transform);
    }
}

#[test]
fn a_texture_without_a_third_dimension_is_not_one_color() {
    let flat = with_texture(&[("Scaling", "Vector", &[1.0, 1.0, 0.0])]);
    assert_eq!(flat.transform, UNMOVED);
    let turned = with_texture(&[
        ("Scaling", "Vector", &[2.0, 4.0, 0.0]),
        ("Rotation", "Vector", &[0.0, 0.0, 90.0]),
    ]);
    let with_depth = with_texture(&[
        ("Scaling", "Vector", &[2.0, 4.0, 1.0]),
        ("Rotation", "Vector", &[0.0, 0.0, 90.0]),
    ]);
    assert_eq!(turned.transform, with_depth.transform);
    let nowhere = with_texture(&[("Scaling", "Vector", &[0.0, 1.0, 1.0])]);
    assert_eq!(nowhere.transform, UNMOVED);
}
