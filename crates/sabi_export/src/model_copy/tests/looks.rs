//! Looks of baked materials in whole files.

use super::*;

#[test]
fn a_kept_appearance_keeps_rare_properties_and_reports_them() {
    let options = CopyOptions {
        keeps_look: true,
        ..CopyOptions::default()
    };
    let finished = copied_with(options, "it.glb", &[("it.glb", &glb())], &[(1, all_maps())]);
    let (is, _) = parts(&finished.copy.bytes);
    let sheen = json!({ "sheenColorTexture": { "index": 2 } });
    assert_eq!(is["materials"][1]["extensions"]["KHR_materials_sheen"], sheen);
    let change = |finished: &FinishedCopy| {
        let mut of_sheen = finished
            .changes
            .iter()
            .filter(|change| change.property == "KHR_materials_sheen");
        of_sheen.next().map(|change| (change.material.clone(), change.change))
    };
    assert_eq!(change(&finished), Some(("cloth".to_owned(), Treatment::Kept)));
    let finished = copied("it.glb", &[("it.glb", &glb())], &[(1, all_maps())]);
    assert_eq!(change(&finished), Some(("cloth".to_owned(), Treatment::Removed)));
}

#[test]
fn a_file_whose_references_are_all_known_keeps_nothing_unused() {
    let (mut document, binary) = document();
    edit::remove(&mut document, "extensions");
    edit::remove(&mut document["nodes"][0], "extensions");
    document["extensionsUsed"] = json!([
        "KHR_texture_transform",
        "KHR_materials_sheen",
        "KHR_materials_emissive_strength"
    ]);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(0);
    let before = Container::glb(binary).join(&mut document).unwrap();
    let maps = MaterialMaps {
        base_color: map("new color", true),
        ..MaterialMaps::default()
    };
    let finished = copied("it.glb", &[("it.glb", &before)], &[(1, maps)]);
    let (is, is_view) = parts(&finished.copy.bytes);
    let lengths = [
        "materials",
        "textures",
        "images",
        "samplers",
        "bufferViews",
        "accessors",
    ];
    let lengths = lengths.map(|list| is[list].as_array().unwrap().len());
    // The second texture, its picture and its sampler are gone; the first place is that of the new map.
    assert_eq!(lengths, [3, 3, 3, 1, 4, 3]);
    let shows = |texture: &Json| {
        let texture = &is["textures"][texture["index"].as_u64().unwrap() as usize];
        let image = &is["images"][texture["source"].as_u64().unwrap() as usize];
        is_view(image["bufferView"].as_u64().unwrap() as usize)
    };
    assert_eq!(
        shows(&is["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]),
        picture("glass")
    );
    assert_eq!(
        shows(&is["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]),
        picture("new color")
    );
    assert_eq!(shows(&is["materials"][2]["normalTexture"]), picture("sheen"));
    let positions = &is["accessors"][is["meshes"][0]["primitives"][0]["attributes"]["_COLOR_0"]
        .as_u64()
        .unwrap() as usize];
    assert_eq!(is_view(positions["bufferView"].as_u64().unwrap() as usize), triangle());
    let mut noted = document.clone();
    noted["materials"][2]["extras"] = json!({ "lightmap": { "index": 1 } });
    let before = Container::glb(super::document().1).join(&mut noted).unwrap();
    let finished = copied("it.glb", &[("it.glb", &before)], &[(1, MaterialMaps::default())]);
    let (is, _) = parts(&finished.copy.bytes);
    assert_eq!(
        is["textures"].as_array().unwrap().len(),
        4,
        "extras may count on places"
    );
}

#[test]
fn entries_used_by_feature_metadata_are_kept() {
    let (mut document, binary) = document();
    edit::remove(&mut document, "extensions");
    edit::remove(&mut document["nodes"][0], "extensions");
    document["extensionsUsed"] = json!(["EXT_mesh_features", "EXT_structural_metadata"]);
    let features = json!({ "EXT_mesh_features": { "featureIds": [{ "featureCount": 2, "texture": { "index": 2 } }] } });
    document["meshes"][0]["primitives"][0]["extensions"] = features;
    document["extensions"]["EXT_structural_metadata"] = json!({
        "propertyTables": [{ "properties": { "height": { "values": 4 } } }],
        "propertyTextures": [{ "properties": { "age": { "index": 3 } } }],
    });
    let before = Container::glb(binary).join(&mut document).unwrap();
    let finished = copied("it.glb", &[("it.glb", &before)], &[(1, MaterialMaps::default())]);
    let (is, is_view) = parts(&finished.copy.bytes);
    let shows = |texture: &Json| {
        let texture = &is["textures"][texture["index"].as_u64().unwrap() as usize];
        let image = &is["images"][texture["source"].as_u64().unwrap() as usize];
        is_view(image["bufferView"].as_u64().unwrap() as usize)
    };
    let metadata = &is["extensions"]["EXT_structural_metadata"];
    let features = &is["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"];
    assert_eq!(
        is["textures"].as_array().unwrap().len(),
        2,
        "those of the earlier look are gone"
    );
    assert_eq!(shows(&features["featureIds"][0]["texture"]), picture("sheen"));
    assert_eq!(
        shows(&metadata["propertyTextures"][0]["properties"]["age"]),
        picture("glass")
    );
    let height = &metadata["propertyTables"][0]["properties"]["height"]["values"];
    assert_eq!(is_view(height.as_u64().unwrap() as usize), picture("glass"));
}
