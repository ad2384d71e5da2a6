//! `--model`: writes a copy of the model that uses the maps.

use serde_json::Value as Json;

use crate::cli_folder::{CliFolder, graph};

#[test]
fn a_copy_of_the_model_lies_beside_the_maps_and_in_the_report() {
    let place = CliFolder::new();
    let run = place.bake("rust.sabi", "cube.glb", &["--model", "--json"]).good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["model"]["path"], "cube.glb");
    assert_eq!(report["model"]["files"], Json::Array(Vec::new()), "its maps are in it");
    assert!(
        run.stderr.contains(": 5 maps and cube.glb in out, in "),
        "{}",
        run.stderr
    );
    assert!(place.listing("out").contains(&"cube.glb".to_owned()));
    let twice = place.bake("rust.sabi", "cube.glb", &["--model", "-o", "twice"]).good();
    assert!(twice.stdout.contains("cube.glb"), "{}", twice.stdout);
    assert_eq!(
        place.read("out/cube.glb"),
        place.read("twice/cube.glb"),
        "the same bytes"
    );
    place.sabi(&["mesh", "out/cube.glb"]).good();
}

#[test]
fn a_copy_never_takes_the_place_of_the_model() {
    let place = CliFolder::new();
    let before = place.read("cube.glb");
    let run = place
        .bake("rust.sabi", "cube.glb", &["--model", "-o", ".", "--force"])
        .fails(73);
    let words =
        "cube.glb is read by this very bake and would be replaced by its own result; choose another folder with -o";
    assert!(run.stderr.trim_end().ends_with(words), "{}", run.stderr);
    assert_eq!(place.read("cube.glb"), before);
}

/// Document of a GLB file.
fn glb_document(place: &CliFolder, file: &str) -> Json {
    let glb = place.read(file);
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&glb[20..20 + length]).unwrap()
}

#[test]
fn a_model_in_udim_tiles_gets_a_material_for_each_in_its_copy() {
    let place = CliFolder::new();
    // The last triangle extends into the tile on the right.
    let tiles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\n\
                 vt 1.1 0.1\nvt 1.9 0.9\nvt 1.1 0.9\nvt 0.5 0.9\nvt 0.6 0.9\nvt 1.1 0.95\nusemtl wood\n\
                 f 1/1 2/2 3/3\nf 2/4 4/5 3/6\nf 1/7 2/8 5/9\n";
    place.write("tiles.obj", tiles);
    let run = place
        .bake("rust.sabi", "tiles.obj", &["--model", "--udim", "on", "--json"])
        .good();
    let words = "warning: the copy of the model has a material for each UDIM tile of 'wood', and 1 triangle reaches over the border \
                 of a tile: the copy shows the edge of the picture there; cut the UVs at the borders of the tiles";
    assert!(run.stderr.contains(words), "{}", run.stderr);
    let copy = glb_document(&place, "out/tiles.glb");
    let materials = copy["materials"].as_array().unwrap().iter();
    let names: Vec<&str> = materials.map(|material| material["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["wood.1001", "wood.1002"]);
    let maps: Vec<&str> = copy["images"]
        .as_array()
        .unwrap()
        .iter()
        .map(|image| image["name"].as_str().unwrap())
        .collect();
    for tile in ["1001", "1002"] {
        assert!(maps.contains(&&*format!("wood_base_color.{tile}")), "{maps:?}");
    }
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    let changes = report["model"]["changes"].as_array().unwrap().iter();
    let of_color = changes.filter(|change| change["property"] == "baseColorTexture");
    let of_color: Vec<&Json> = of_color.map(|change| &change["material"]).collect();
    assert_eq!(of_color, ["wood.1001", "wood.1002"]);
    let mesh = place.sabi(&["mesh", "out/tiles.glb", "--json"]).good();
    assert!(!mesh.stderr.contains("tile"), "{}", mesh.stderr);
}

#[test]
fn a_copy_uses_the_color_and_opacity_of_a_preset_that_writes_them_as_one_map() {
    let place = CliFolder::new();
    unlit(&place);
    // Opacity that varies, and the same opacity everywhere.
    for (name, mask) in [("varying", ", \"mask\": \"clouds\""), ("even", "")] {
        let nodes = format!(
            r##"    "base": {{ "kind": "source/material", "params": {{ "color": "#3c5a6e" }} }},
    "clouds": {{ "kind": "noise/simplex" }},
    "glass": {{ "kind": "effect/layer", "inputs": {{ "base": "base"{mask} }},
      "params": {{ "color": "#8090a0", "alpha_on": true, "alpha": 0.4 }} }},
    "stain": {{ "kind": "effect/layer", "inputs": {{ "base": "glass", "mask": "clouds" }}, "params": {{ "color": "#402010" }} }},
    "out": {{ "kind": "output/material", "inputs": {{ "material": "stain" }} }}"##
        );
        place.write("glass.sabi", graph(&nodes));
        place
            .bake("glass.sabi", "unlit.gltf", &["--model", "--preset", "gltf", "-o", name])
            .good();
        let files = place.listing(name);
        assert!(!files.iter().any(|file| file.contains("base_color")), "{files:?}");
        let copy: Json = serde_json::from_slice(&place.read(&format!("{name}/unlit.gltf"))).unwrap();
        let pbr = &copy["materials"][0]["pbrMetallicRoughness"];
        let image = &copy["images"][pbr["baseColorTexture"]["index"].as_u64().unwrap() as usize];
        assert!(image["uri"].as_str().unwrap().ends_with("_BaseColor.png"), "{copy}");
        assert_eq!(pbr.get("baseColorFactor"), None, "the map has all of it");
        assert_eq!(copy["materials"][0]["alphaMode"], "BLEND", "{copy}");
    }
}

#[test]
fn an_embedded_copy_names_no_file() {
    let place = CliFolder::new();
    unlit(&place);
    place.bake("rust.sabi", "unlit.gltf", &["--embed"]).fails(2);
    let run = place
        .bake("rust.sabi", "unlit.gltf", &["--model", "--embed", "--json"])
        .good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["model"]["files"], Json::Array(Vec::new()));
    assert!(
        !place.listing("out").iter().any(|file| file.ends_with(".bin")),
        "{:?}",
        place.listing("out")
    );
    let copy: Json = serde_json::from_slice(&place.read("out/unlit.gltf")).unwrap();
    let entries = ["buffers", "images"].map(|list| copy[list].as_array().unwrap());
    for entry in entries.into_iter().flatten() {
        assert!(entry["uri"].as_str().unwrap().starts_with("data:"), "{entry}");
    }
    place.write("alone.gltf", place.read("out/unlit.gltf"));
    place.sabi(&["mesh", "alone.gltf"]).good();
}

/// Writes a tetrahedron without UVs whose four triangles share its vertices, shown by two nodes, and an animation; its bytes. Its
/// weights are bytes.
fn bare(place: &CliFolder) -> Vec<u8> {
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let indices = [0_u16, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    let mut bytes = corners.map(f32::to_le_bytes).as_flattened().to_vec();
    bytes.extend([11_u8, 0, 0, 0, 22, 0, 0, 0, 33, 0, 0, 0, 44, 0, 0, 0]);
    bytes.extend(indices.map(u16::to_le_bytes).as_flattened());
    place.write("bare.bin", &bytes);
    place.write(
        "bare.gltf",
        r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1] }],
            "nodes": [{ "mesh": 0 }, { "mesh": 0, "translation": [3, 0, 0] }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "_WEIGHT": 1 }, "indices": 2 }] }],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                            "min": [0, 0, 0], "max": [1, 1, 1] },
                          { "bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR" },
                          { "bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR" }],
            "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 16, "byteStride": 4 },
                            { "buffer": 0, "byteOffset": 64, "byteLength": 24 }],
            "buffers": [{ "uri": "bare.bin", "byteLength": 88 }],
            "animations": [{ "channels": [], "samplers": [], "name": "wave" }] }"#,
    );
    bytes
}

#[test]
fn a_copy_of_an_unwrapped_model_keeps_its_animations_and_its_own_attributes() {
    let place = CliFolder::new();
    let bytes = bare(&place);
    let run = place.bake("rust.sabi", "bare.gltf", &["--model"]).good();
    assert!(!run.stderr.contains("made from the loaded mesh"), "{}", run.stderr);
    let copy: Json = serde_json::from_slice(&place.read("out/bare.gltf")).unwrap();
    assert_eq!(copy["animations"][0]["name"], "wave");
    assert_eq!(copy["nodes"][1]["translation"], serde_json::json!([3, 0, 0]));
    // Each instance has separate UVs, and therefore a separate mesh.
    assert_eq!([&copy["nodes"][0]["mesh"], &copy["nodes"][1]["mesh"]], [0, 1]);
    // The vertices of the original file are not used any more.
    assert_eq!(copy["buffers"].as_array().unwrap().len(), 1);
    let buffer = place.read("out/bare_vertices.bin");
    for mesh in 0..2 {
        let attributes = &copy["meshes"][mesh]["primitives"][0]["attributes"];
        let read = |name: &str, size: usize| -> Vec<Vec<u8>> {
            let accessor = &copy["accessors"][attributes[name].as_u64().unwrap() as usize];
            let view = &copy["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
            let number = |key: &str| view[key].as_u64().unwrap_or(0) as usize;
            let bytes = &buffer[number("byteOffset")..][..number("byteLength")];
            bytes
                .chunks(number("byteStride"))
                .map(|element| element[..size].to_vec())
                .collect()
        };
        let (positions, weights) = (read("POSITION", 12), read("_WEIGHT", 1));
        assert_eq!(
            (positions.len(), read("TEXCOORD_0", 8).len(), weights.len()),
            (12, 12, 12),
            "hard edges split all"
        );
        for (position, weight) in positions.iter().zip(&weights) {
            let vertex = bytes[..48].chunks(12).position(|corner| corner == position).unwrap();
            assert_eq!(
                weight[0],
                11 * (vertex as u8 + 1),
                "a duplicate has all that its vertex has"
            );
        }
    }
    let mesh = place.sabi(&["mesh", "out/bare.gltf", "--json"]).good();
    assert!(!mesh.stderr.contains("unwrapped"), "{}", mesh.stderr);
}

#[test]
fn outputs_for_materials_on_one_sheet_share_its_maps() {
    let place = CliFolder::new();
    place.write(
        "two.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nusemtl wood\nf 1 2 3\nusemtl steel\nf 2 4 3\n",
    );
    let nodes = |steel: &str| {
        graph(&format!(
            r##"    "clouds": {{ "kind": "noise/simplex" }},
    "red": {{ "kind": "source/material", "params": {{ "color": "#ff0000", "roughness": 0.5 }} }},
    "blue": {{ "kind": "source/material", "params": {{ "color": "#0000ff", "roughness": {steel} }} }},
    "wood": {{ "kind": "output/material", "params": {{ "materials": "wood" }}, "inputs": {{ "material": "red" }} }},
    "steel": {{ "kind": "output/material", "params": {{ "materials": "steel" }}, "inputs": {{ "material": "blue" }} }}"##
        ))
    };
    for (roughness, maps) in [("0.5", vec!["base_color"]), ("0.6", vec!["base_color", "roughness"])] {
        place.write("two.sabi", nodes(roughness));
        let run = place.bake("two.sabi", "two.obj", &["--json", "-o", roughness]).good();
        assert!(!run.stderr.contains("output"), "{}", run.stderr);
        let report: Json = serde_json::from_str(&run.stdout).unwrap();
        let outputs = report["outputs"].as_array().unwrap().iter();
        let channels: Vec<&str> = outputs.map(|output| output["channel"].as_str().unwrap()).collect();
        assert_eq!(channels, maps);
    }
}

#[test]
fn a_copy_of_a_model_far_away_stands_where_the_model_does() {
    let place = CliFolder::new();
    let corners = "v 4000 0 -9000\nv 4001 0 -9000\nv 4000 1 -9000\n";
    place.write("far.obj", format!("{corners}vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"));
    place.bake("rust.sabi", "far.obj", &["--model"]).good();
    let copy = glb_document(&place, "out/far.glb");
    assert_eq!(
        copy["nodes"][0]["translation"],
        serde_json::json!([4000.5, 0.5, -9000.0])
    );
    let positions = &copy["accessors"][copy["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        .as_u64()
        .unwrap() as usize];
    assert_eq!(positions["min"], serde_json::json!([-0.5, -0.5, 0.0]));
}

/// A colored triangle without light.
fn unlit(place: &CliFolder) {
    let floats = [
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].as_slice(),
        &[0.1, 0.1, 0.9, 0.1, 0.1, 0.9],
        &[0.5; 9],
    ];
    place.write(
        "unlit.bin",
        floats
            .concat()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect::<Vec<u8>>(),
    );
    place.write(
        "unlit.gltf",
        r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "extensionsUsed": ["KHR_materials_unlit"],
            "materials": [{ "name": "sign", "doubleSided": true, "alphaMode": "BLEND",
                            "extensions": { "KHR_materials_unlit": {} } }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2 }, "material": 0 }] }],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                            "min": [0, 0, 0], "max": [1, 1, 0] },
                          { "bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC2" },
                          { "bufferView": 0, "byteOffset": 60, "componentType": 5126, "count": 3, "type": "VEC3" }],
            "bufferViews": [{ "buffer": 0, "byteLength": 96 }], "buffers": [{ "uri": "unlit.bin", "byteLength": 96 }] }"#,
    );
}

#[test]
fn the_look_of_a_model_does_not_hide_the_maps_of_its_copy_unless_it_is_kept() {
    let place = CliFolder::new();
    unlit(&place);
    let changes = |options: &[&str]| {
        let run = place.bake("rust.sabi", "unlit.gltf", options).good();
        let report: Json = serde_json::from_str(&run.stdout).unwrap();
        let changes = report["model"]["changes"].as_array().unwrap().iter();
        let named = ["alphaMode", "doubleSided", "KHR_materials_unlit", "COLOR_0"];
        let change = |change: &Json| {
            assert_eq!(change["material"], "sign");
            let property = change["property"].as_str().unwrap().to_owned();
            named
                .contains(&&*property)
                .then(|| (property, change["change"].as_str().unwrap().to_owned()))
        };
        let found: Vec<(String, String)> = changes.filter_map(change).collect();
        let copy: Json = serde_json::from_slice(&place.read(&format!("{}/unlit.gltf", options[3]))).unwrap();
        (found, copy, run.stderr)
    };
    let listed =
        |changes: [(&str, &str); 4]| changes.map(|(property, change)| (property.to_owned(), change.to_owned()));
    let (found, copy, said) = changes(&["--model", "--json", "-o", "new"]);
    let expected = [
        ("alphaMode", "removed"),
        ("doubleSided", "kept"),
        ("KHR_materials_unlit", "removed"),
        ("COLOR_0", "removed"),
    ];
    assert_eq!(found, listed(expected));
    assert_eq!(
        (copy.get("extensionsUsed"), copy["materials"][0].get("alphaMode")),
        (None, None)
    );
    assert_eq!(copy["meshes"][0]["primitives"][0]["attributes"]["_COLOR_0"], 2);
    assert!(!said.contains("vertex colors"), "{said}");
    let (found, copy, said) = changes(&["--model", "--json", "-o", "kept", "--keep-look"]);
    assert_eq!(found, listed(expected.map(|(property, _)| (property, "kept"))));
    assert_eq!(
        copy["materials"][0]["extensions"],
        serde_json::json!({ "KHR_materials_unlit": {} })
    );
    assert_eq!(copy["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"], 2);
    let words = "the model has vertex colors, and programs that show its copy multiply base color by them";
    assert!(said.contains(words), "{said}");
    place.bake("rust.sabi", "unlit.gltf", &["--keep-look"]).fails(2);
}

#[test]
fn alpha_below_the_cutoff_of_a_masked_material_is_nothing_and_all_else_is_opaque() {
    let place = CliFolder::new();
    unlit(&place);
    place.write(
        "own.sabi",
        r#"{ "format": "sabi", "version": 1, "nodes": { "own": { "kind": "source/model" },
            "out": { "kind": "output/material", "inputs": { "material": "own" } } } }"#,
    );
    let model = String::from_utf8(place.read("unlit.gltf")).unwrap();
    // At the cutoff itself, a material is opaque (glTF 2.0, 3.9.4). Both numbers are exact.
    for (name, cutoff, opacity) in [("above", 0.5, 0.0), ("equal", 0.25, 1.0), ("below", 0.125, 1.0)] {
        let look = format!(
            r#""alphaMode": "MASK", "alphaCutoff": {cutoff}, "pbrMetallicRoughness": {{ "baseColorFactor": [1, 1, 1, 0.25] }},"#
        );
        place.write("masked.gltf", model.replace(r#""alphaMode": "BLEND","#, &look));
        place.bake("own.sabi", "masked.gltf", &["--model", "-o", name]).good();
        let copy: Json = serde_json::from_slice(&place.read(&format!("{name}/masked.gltf"))).unwrap();
        let material = &copy["materials"][0];
        let factor = material.pointer("/pbrMetallicRoughness/baseColorFactor/3");
        assert_eq!(
            factor.map_or(1.0, |alpha| alpha.as_f64().unwrap()),
            opacity,
            "{name}: {copy}"
        );
        let mode = material.get("alphaMode").and_then(Json::as_str);
        assert_eq!(mode, (opacity == 0.0).then_some("BLEND"), "{name}: {copy}");
    }
}
