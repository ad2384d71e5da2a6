use super::rules::RULES;
use super::*;

const DOCUMENT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/model-copy.md"));

fn word(treatment: Treatment) -> String {
    serde_json::to_value(treatment).unwrap().as_str().unwrap().to_owned()
}

#[test]
fn the_document_has_the_treatment_of_every_property() {
    let rows = DOCUMENT.lines().filter_map(|line| line.strip_prefix("| "));
    let cells = rows.map(|row| row.split(" | ").map(|cell| cell.trim_matches('`')).collect::<Vec<_>>());
    let documented: Vec<[String; 3]> = cells
        .filter(|cells| cells[0] != "Property")
        .map(|cells| [0, 1, 2].map(|at| cells[at].to_owned()))
        .collect();
    let of_rule = |rule: &rules::Rule| [rule.property.to_owned(), word(rule.treatment), word(rule.kept_look)];
    assert_eq!(documented, RULES.each_ref().map(of_rule));
}

/// Creates a material with many different properties.
fn rich() -> Json {
    let texture = json!({ "index": 0 });
    json!({
        "name": "cloth", "doubleSided": true, "extras": { "shader": 7 }, "alphaMode": "MASK", "alphaCutoff": 0.3,
        "pbrMetallicRoughness": { "baseColorTexture": texture, "baseColorFactor": [1, 0, 0, 1], "metallicFactor": 0.5,
            "roughnessFactor": 0.5, "metallicRoughnessTexture": texture, "extras": "kept" },
        "normalTexture": texture, "occlusionTexture": texture, "emissiveTexture": texture, "emissiveFactor": [1, 1, 1],
        "extensions": {
            "KHR_materials_emissive_strength": { "emissiveStrength": 3 }, "KHR_materials_unlit": {},
            "KHR_materials_pbrSpecularGlossiness": { "diffuseTexture": texture },
            "KHR_materials_clearcoat": { "clearcoatFactor": 1 }, "KHR_materials_sheen": { "sheenColorTexture": texture },
            "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_volume": { "thicknessFactor": 1 },
            "KHR_materials_ior": { "ior": 2 }, "KHR_materials_specular": { "specularFactor": 0 },
            "KHR_materials_iridescence": { "iridescenceFactor": 1 }, "KHR_materials_dispersion": { "dispersion": 1 },
            "VENDOR_materials_toon": {}, "MSFT_packing_normalRoughnessMetallic": {}, "VENDOR_physics": { "mass": 2 }
        }
    })
}

#[test]
fn nothing_of_the_earlier_appearance_remains() {
    let mut material = rich();
    strip(&mut material, false);
    let left = json!({
        "name": "cloth", "doubleSided": true, "extras": { "shader": 7 }, "alphaMode": "MASK", "alphaCutoff": 0.3,
        "pbrMetallicRoughness": { "extras": "kept" }, "extensions": { "VENDOR_physics": { "mass": 2 } }
    });
    assert_eq!(material, left);
}

#[test]
fn a_kept_appearance_loses_only_properties_that_maps_replace() {
    let mut material = rich();
    strip(&mut material, true);
    let extensions: Vec<&String> = material["extensions"].as_object().unwrap().keys().collect();
    let kept = [
        "KHR_materials_unlit",
        "KHR_materials_clearcoat",
        "KHR_materials_sheen",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_materials_ior",
        "KHR_materials_specular",
        "KHR_materials_iridescence",
        "KHR_materials_dispersion",
        "VENDOR_materials_toon",
        "MSFT_packing_normalRoughnessMetallic",
        "VENDOR_physics",
    ];
    assert_eq!(extensions, kept);
    assert_eq!(material["pbrMetallicRoughness"], json!({ "extras": "kept" }));
    assert_eq!(material.get("normalTexture"), None);
}

#[test]
fn the_opacity_of_the_graph_decides_the_alpha_mode() {
    let (opaque, one, varying) = ((1.0, false), (0.4, true), (1.0, true));
    let cases = [
        (None, false, opaque, None),
        (Some("OPAQUE"), false, opaque, Some("OPAQUE")),
        (Some("BLEND"), false, opaque, None),
        (Some("MASK"), false, opaque, None),
        (None, false, one, Some("BLEND")),
        (Some("MASK"), false, one, Some("BLEND")),
        (Some("OPAQUE"), false, varying, Some("BLEND")),
        (Some("MASK"), false, varying, Some("MASK")),
        (Some("BLEND"), false, varying, Some("BLEND")),
        (Some("BLEND"), true, opaque, Some("BLEND")),
        (Some("MASK"), true, one, Some("MASK")),
        (None, true, varying, Some("BLEND")),
    ];
    for (before, keeps_look, (factor, has_opacity), expected) in cases {
        let mut material = json!({ "alphaCutoff": 0.3 });
        if let Some(mode) = before {
            material["alphaMode"] = json!(mode);
        }
        let maps = MaterialMaps {
            base_color_factor: [1.0, 1.0, 1.0, factor],
            has_opacity,
            ..MaterialMaps::default()
        };
        set_alpha_mode(&mut material, &maps, keeps_look);
        let case = format!("{before:?} {keeps_look} {factor} {has_opacity}");
        assert_eq!(material.get("alphaMode").and_then(Json::as_str), expected, "{case}");
        let is_same = before.unwrap_or("OPAQUE") == expected.unwrap_or("OPAQUE");
        assert_eq!(material.get("alphaCutoff").is_some(), is_same, "{case}");
    }
}

#[test]
fn every_change_of_a_material_is_listed() {
    let before = rich();
    let mut after = before.clone();
    strip(&mut after, false);
    after["normalTexture"] = json!({ "index": 5 });
    after["extensions"]["KHR_materials_clearcoat"] = json!({ "clearcoatFactor": 0.5 });
    after["extensions"]["KHR_materials_anisotropy"] = json!({ "anisotropyStrength": 0.5 });
    let of = |property: &str| {
        let found = changes("cloth", &before, &after, false);
        let mut of_property = found.into_iter().filter(|change| change.property == property);
        (of_property.next().map(|change| change.change), of_property.next())
    };
    for (property, change) in [
        ("normalTexture", Some(Treatment::Set)),
        ("baseColorTexture", Some(Treatment::Removed)),
        ("alphaMode", Some(Treatment::Kept)),
        ("doubleSided", Some(Treatment::Kept)),
        ("KHR_materials_unlit", Some(Treatment::Removed)),
        ("KHR_materials_clearcoat", Some(Treatment::Set)),
        ("KHR_materials_anisotropy", Some(Treatment::Set)),
        ("VENDOR_physics", Some(Treatment::Kept)),
        ("KHR_materials_diffuse_transmission", None),
    ] {
        assert_eq!(of(property), (change, None), "{property}");
    }
}

/// A document of two primitives with vertex colors, of two materials.
fn colored() -> Json {
    let primitive = |material: usize| {
        json!({
            "material": material, "attributes": { "POSITION": 0, "COLOR_0": 1, "COLOR_1": 2 },
            "targets": [{ "POSITION": 3, "COLOR_0": 4 }],
            "extensions": {
                "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": { "POSITION": 0, "COLOR_0": 1, "COLOR_1": 2 } },
                "KHR_materials_variants": { "mappings": [{ "material": 1, "variants": [0] }] }
            }
        })
    };
    json!({ "meshes": [{ "primitives": [primitive(0), primitive(1)] }] })
}

#[test]
fn vertex_colors_of_baked_primitives_stay_under_a_name_that_viewers_ignore() {
    let before = colored();
    let mut document = before.clone();
    let changes = change_primitives("cloth", &mut document, 1, false);
    let is = &document["meshes"][0]["primitives"];
    assert_eq!(
        is[0], before["meshes"][0]["primitives"][0],
        "the other material is not baked"
    );
    assert_eq!(
        is[1]["attributes"],
        json!({ "POSITION": 0, "_COLOR_0": 1, "_COLOR_1": 2 })
    );
    assert_eq!(is[1]["targets"], json!([{ "POSITION": 3, "_COLOR_0": 4 }]));
    assert_eq!(
        is[1]["extensions"]["KHR_draco_mesh_compression"]["attributes"],
        json!({ "POSITION": 0, "_COLOR_0": 1, "_COLOR_1": 2 })
    );
    let listed: Vec<(&str, Treatment)> = changes
        .iter()
        .map(|change| (&*change.property, change.change))
        .collect();
    let expected = [
        ("COLOR_0", Treatment::Removed),
        ("COLOR_1", Treatment::Removed),
        ("KHR_materials_variants", Treatment::Kept),
    ];
    assert_eq!(listed, expected);
    let mut document = before.clone();
    let changes = change_primitives("cloth", &mut document, 1, true);
    assert_eq!(document, before);
    assert!(changes.iter().all(|change| change.change == Treatment::Kept));
}
