//! Folders of image files that become materials.

use std::path::PathBuf;

use super::*;

fn files(names: &[&str]) -> Vec<PathBuf> {
    names.iter().map(|name| PathBuf::from("textures").join(name)).collect()
}

/// Returns the kind and the output of the node that a channel of the selected material reads.
fn reads(document: &OpenDocument, channel: &str) -> Option<(String, Option<String>)> {
    let material = document.selected_one()?;
    let from = connections::wire_into(document, &slot(material, channel))?;
    Some((document.node(&from.node)?.kind.clone(), from.port.clone()))
}

#[test]
fn a_texture_set_becomes_a_material_in_one_step() {
    let mut document = opened("", "");
    let set = files(&[
        "Bricks001_2K_Color.png",
        "Bricks001_2K_NormalDX.png",
        "Bricks001_2K_NormalGL.png",
        "Bricks001_2K_Roughness.png",
        "Bricks001_2K_AmbientOcclusion.png",
        "Bricks001_2K_Displacement.png",
        "Bricks001.png",
    ]);
    assert!(step(&mut document, |document| texture_sets::add(
        document,
        &set,
        [100.0, 40.0]
    )));
    let image = |port: Option<&str>| Some(("source/image".to_owned(), port.map(str::to_owned)));
    assert_eq!(reads(&document, "base_color"), image(None));
    assert_eq!(reads(&document, "roughness"), image(Some("mask")));
    assert_eq!(reads(&document, "occlusion"), image(Some("mask")));
    assert_eq!(reads(&document, "slope"), image(Some("slope")));
    assert_eq!(reads(&document, "height"), Some(("adjust/remap".to_owned(), None)));
    assert_eq!(reads(&document, "metallic"), None);
    let material = document.selected_one().cloned().expect("the material");
    assert_eq!(document.title(&material), "Bricks001");
    let slope = connections::wire_into(&document, &slot(&material, "slope"))
        .cloned()
        .expect("a normal map");
    let file = param(&document, slope.node.as_str(), "file");
    let file = file.and_then(|file| file.as_text().map(str::to_owned)).expect("a file");
    assert!(
        file.ends_with("Bricks001_2K_NormalGL.png"),
        "green up goes before green down: {file}"
    );
    assert_eq!(param(&document, slope.node.as_str(), "normal_y"), None);
    flat(&document);
}

#[test]
fn a_normal_map_for_direct_x_is_read_as_such() {
    let mut document = opened("", "");
    texture_sets::add(&mut document, &files(&["wall_nor_dx_1k.png"]), [0.0; 2]);
    let material = document.selected_one().cloned().expect("the material");
    let slope = connections::wire_into(&document, &slot(&material, "slope"))
        .cloned()
        .expect("a normal map");
    assert_eq!(
        param(&document, slope.node.as_str(), "normal_y"),
        Some(Value::Text("down".to_owned()))
    );
}

#[test]
fn each_set_of_a_folder_is_a_material_and_none_covers_another() {
    let mut document = opened("", "");
    let sets = files(&[
        "wall_diff.png",
        "wall_rough.png",
        "floor_diff.png",
        "floor_ao.png",
        "floor_disp.png",
    ]);
    step(&mut document, |document| texture_sets::add(document, &sets, [0.0; 2]));
    assert_eq!(document.selection().len(), 2);
    let placed: Vec<([f32; 2], f32)> = document
        .graph()
        .nodes()
        .map(|(id, node)| (node.pos, node_size::of(&document, id)[1]))
        .collect();
    for (at, (one, height)) in placed.iter().enumerate() {
        for (other, _) in placed[at + 1..].iter().filter(|(other, _)| other[0] == one[0]) {
            let is_apart = other[1] >= one[1] + height || one[1] >= other[1] + 1.0;
            assert!(is_apart, "{placed:?}");
        }
    }
}

/// Node that gives a channel of the selected material, and the output.
fn source_of(document: &OpenDocument, channel: &str) -> (NodeId, Option<String>) {
    let material = document.selected_one().expect("the material");
    let from = connections::wire_into(document, &slot(material, channel)).expect("a wire");
    (from.node.clone(), from.port.clone())
}

#[test]
fn maps_of_the_unreal_preset_are_unpacked_with_green_down() {
    let mut document = opened("", "");
    let set = files(&["T_crate_BC.png", "T_crate_ORM.png", "T_crate_N.png", "T_crate_H.png"]);
    assert!(step(&mut document, |document| texture_sets::add(
        document, &set, [0.0; 2]
    )));
    let material = document.selected_one().cloned().expect("one material");
    assert_eq!(document.title(&material), "Crate");
    let packed = source_of(&document, "occlusion").0;
    assert_eq!(source_of(&document, "occlusion").1.as_deref(), Some("r"));
    assert_eq!(
        source_of(&document, "roughness"),
        (packed.clone(), Some("g".to_owned()))
    );
    assert_eq!(source_of(&document, "metallic"), (packed, Some("b".to_owned())));
    let color = source_of(&document, "base_color").0;
    assert_eq!(source_of(&document, "alpha"), (color, Some("alpha".to_owned())));
    let normal = source_of(&document, "slope").0;
    let down = Some(Value::Text("down".to_owned()));
    assert_eq!(param(&document, normal.as_str(), "normal_y"), down);
    assert_eq!(reads(&document, "height"), Some(("adjust/remap".to_owned(), None)));
    flat(&document);
}

#[test]
fn the_smoothness_of_a_mask_map_is_inverted_to_roughness() {
    let mut document = opened("", "");
    let set = files(&["crate_BaseMap.png", "crate_MaskMap.png", "crate_Normal.png"]);
    texture_sets::add(&mut document, &set, [0.0; 2]);
    let (inverted, _) = source_of(&document, "roughness");
    assert_eq!(document.node(&inverted).expect("a node").kind, "adjust/invert");
    let from = connections::wire_into(&document, &slot(&inverted, "source")).cloned();
    let (mask_map, red) = source_of(&document, "metallic");
    assert_eq!(red.as_deref(), Some("r"));
    let alpha = OutputRef {
        node: mask_map,
        port: Some("alpha".to_owned()),
    };
    assert_eq!(from, Some(alpha));
}

#[test]
fn the_roughness_of_sheen_is_read_from_the_alpha_if_the_image_has_one() {
    let folder = tempfile::tempdir().expect("a folder");
    // Color type in the header of a PNG: 2 is RGB, 6 is RGB with alpha, 4 is gray with alpha.
    let header = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x01\0\0\0\x01\x08";
    let png = |kind: u8| [header.as_slice(), &[kind]].concat();
    let sheen = folder.path().join("crate_Sheen.png");
    let own = folder.path().join("crate_SheenRoughness.png");
    std::fs::write(&own, png(0)).expect("a picture");
    let alpha = Some(("source/image".to_owned(), Some("alpha".to_owned())));
    let mask = Some(("source/image".to_owned(), Some("mask".to_owned())));
    for (kind, wanted) in [(6, alpha), (2, None)] {
        std::fs::write(&sheen, png(kind)).expect("a picture");
        let mut document = opened("", "");
        texture_sets::add(&mut document, std::slice::from_ref(&sheen), [0.0; 2]);
        assert_eq!(reads(&document, "sheen"), Some(("source/image".to_owned(), None)));
        assert_eq!(reads(&document, "sheen_roughness"), wanted, "colors of kind {kind}");
        let mut document = opened("", "");
        texture_sets::add(&mut document, &[sheen.clone(), own.clone()], [0.0; 2]);
        assert_eq!(reads(&document, "sheen_roughness"), mask, "a picture of its own");
    }
}

#[test]
fn a_separate_map_is_preferred_to_a_packed_one() {
    let mut document = opened("", "");
    let set = files(&["wall_arm.png", "wall_rough.png", "wall_diff.png"]);
    texture_sets::add(&mut document, &set, [0.0; 2]);
    assert_eq!(source_of(&document, "roughness").1.as_deref(), Some("mask"));
    assert_eq!(source_of(&document, "metallic").1.as_deref(), Some("b"));
    // Three images and their material.
    assert_eq!(document.graph().len(), 4);
}

#[test]
fn images_that_are_no_maps_are_reported() {
    let mut document = opened("", "");
    let said = refused(&mut document, |document| {
        texture_sets::add(document, &files(&["cat.png", "dog.jpg"]), [0.0; 2])
    });
    assert_eq!(
        said,
        "none of these 2 files is named as a map of a texture set, as bricks_color.png or bricks_nor_gl.png are"
    );
    let set = files(&["wall_color.1001.png", "wall_color.1002.png", "wall_world_normal.png"]);
    texture_sets::add(&mut document, &set, [0.0; 2]);
    assert_eq!(
        document.take_notices(),
        [
            "wall_color.1002.png: left out, since an Image reads one picture, and not the tiles of a UDIM layout",
            "wall_world_normal.png: left out, since Combine material has no such channel"
        ]
    );
    assert_eq!(document.graph().len(), 2);
}
