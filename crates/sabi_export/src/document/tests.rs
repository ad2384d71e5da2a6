//! Documents of sets whose files are described by hand, without images.

use std::collections::BTreeMap;

use super::*;
use crate::layout::SetKey;
use crate::name_pattern::NamePattern;
use crate::preset::{MapContent, Preset, builtin};
use crate::{Channel, ConstantValue};

/// Number of the material that has maps for a second UV set.
const SECOND_UVS: u32 = 7;

/// A set of a material: channels that vary, and values of those that do not.
struct TestSet {
    key: SetKey,
    name: &'static str,
    vary: Vec<Channel>,
    values: Vec<(Channel, ConstantValue)>,
}

fn set(material: u32, udim: Option<u32>, name: &'static str) -> TestSet {
    TestSet {
        key: SetKey {
            material,
            uv_tile: [udim.unwrap_or(1001) as i32 - 1001, 0],
            udim,
        },
        name,
        vary: Vec::new(),
        values: Vec::new(),
    }
}

/// Returns the facts of a bake of sets with a preset, which writes each map with a channel that varies, and those that are always written.
fn facts(preset: &Preset, sets: &[TestSet]) -> BTreeMap<SetKey, SetFacts> {
    let names = NamePattern::parse(&preset.names, &[]).unwrap();
    let of_set = |set: &TestSet| {
        let mut facts = SetFacts {
            name: set.name.to_owned(),
            size: 64,
            ..SetFacts::default()
        };
        for channel in &set.vary {
            let range = [-0.25, 0.5];
            facts
                .channels
                .insert(channel.clone(), ChannelFacts { constant: None, range });
        }
        for (channel, value) in &set.values {
            let constant = ChannelFacts {
                constant: Some(*value),
                range: [value.component(0); 2],
            };
            facts.channels.insert(channel.clone(), constant);
        }
        for (at, map) in preset.maps.iter().enumerate() {
            let MapContent::Packed(components) = &map.content else {
                continue;
            };
            let is_always = map.when == crate::preset::When::Always;
            if !is_always && !map.channels().into_iter().any(|channel| set.vary.contains(channel)) {
                continue;
            }
            let mut components = components.clone();
            if components.len() == 4 && !set.vary.contains(&Channel::Opacity) {
                components.pop();
            }
            let parts = crate::NameParts {
                material: set.name,
                map: &map.name,
                udim: set.key.udim,
                size: [64; 2],
            };
            let name = map.file_name(&names, &parts);
            facts.files.insert(
                [0, at],
                FileFacts {
                    name,
                    components,
                    scale: 1.0,
                },
            );
        }
        (set.key, facts)
    };
    sets.iter().map(of_set).collect()
}

fn materials_of(preset: &Preset, document: DocumentFormat, sets: &[TestSet]) -> Vec<DocumentMaterial> {
    let names = NamePattern::parse(&preset.names, &[]).unwrap();
    let files = PresetFiles {
        index: 0,
        preset,
        names: &names,
        takes: &|format| document.takes(format),
        uv_set: &|material| u32::from(material == SECOND_UVS),
    };
    materials(&facts(preset, sets), files)
}

fn text_of(preset: &Preset, document: DocumentFormat, sets: &[TestSet]) -> String {
    text(document, &materials_of(preset, document, sets))
}

fn own(maps: &str) -> Preset {
    let head = "version = 1\nname = \"own\"\nabout = \"Own.\"\n";
    Preset::parse("own.toml", &format!("{head}{maps}")).unwrap()
}

/// Returns two materials: one with maps and a name that is not an identifier, and one with constant values only.
fn two_materials() -> [TestSet; 2] {
    let mut strap = set(0, None, "Leather <Strap> & \"Buckle\"");
    strap.vary = vec![Channel::BaseColor, Channel::Roughness, Channel::Normal, Channel::Height];
    strap.values = vec![
        (Channel::Opacity, ConstantValue::Number(1.0)),
        (Channel::Metallic, ConstantValue::Number(0.0)),
        (Channel::Occlusion, ConstantValue::Number(1.0)),
        (Channel::Emission, ConstantValue::Triple([0.0; 3])),
    ];
    let mut lamp = set(1, None, "Lamp");
    lamp.values = vec![
        (Channel::BaseColor, ConstantValue::Triple([0.5, 0.25, 0.125])),
        (Channel::Opacity, ConstantValue::Number(0.5)),
        (Channel::Roughness, ConstantValue::Number(0.7)),
        (Channel::Metallic, ConstantValue::Number(1.0)),
        (Channel::Normal, ConstantValue::Triple([0.0, 0.0, 1.0])),
        (Channel::Emission, ConstantValue::Triple([4.0, 2.0, 0.0])),
    ];
    [strap, lamp]
}

/// Returns a preset without the maps that are always written, so that constant values stay values.
fn frugal(name: &str) -> Preset {
    let text = crate::preset::builtin_text(name).unwrap();
    Preset::parse(name, &text.replace("when = \"always\"\n", "")).unwrap()
}

#[test]
fn a_small_materialx_document_has_this_text() {
    let text = text_of(&frugal("materialx"), DocumentFormat::MaterialX, &two_materials());
    assert_eq!(text, include_str!("tests/two_materials.mtlx"));
}

#[test]
fn a_small_usd_document_has_this_text() {
    let text = text_of(&frugal("usd"), DocumentFormat::Usda, &two_materials());
    assert_eq!(text, include_str!("tests/two_materials.usda"));
}

fn everything() -> TestSet {
    let mut cloth = set(SECOND_UVS, None, "Cloth");
    cloth.vary = Channel::ALL.to_vec();
    cloth
}

#[test]
fn every_channel_is_in_the_materialx_document_of_its_preset() {
    let preset = builtin("materialx").unwrap().unwrap();
    let materials = materials_of(&preset, DocumentFormat::MaterialX, &[everything()]);
    let told = text(DocumentFormat::MaterialX, &materials);
    let connected = |input: &str, ty: &str, output: &str| {
        format!(r#"<input name="{input}" type="{ty}" nodegraph="NG_Cloth" output="out_{output}" />"#)
    };
    let inputs = [
        ("occlusion", "float", "occlusion"),
        ("clearcoat_normal", "vector3", "normal"),
        ("sheen_color", "color3", "sheen"),
        ("anisotropy_rotation", "float", "anisotropy_rotation"),
        ("geometry_opacity", "float", "opacity"),
        ("emission_color", "color3", "emission"),
        ("coat_roughness", "float", "coat_roughness"),
        ("geometry_coat_normal", "vector3", "normal"),
        ("fuzz_weight", "float", "sheen_weight"),
        ("fuzz_color", "color3", "sheen_color"),
        ("fuzz_roughness", "float", "sheen_roughness"),
        ("subsurface_weight", "float", "subsurface_weight"),
        ("subsurface_color", "color3", "base_color"),
        ("transmission_color", "color3", "base_color"),
        ("specular_roughness_anisotropy", "float", "anisotropy_strength"),
        ("geometry_tangent", "vector3", "tangent"),
        ("displacement", "float", "height"),
    ];
    for (input, ty, output) in inputs {
        let line = connected(input, ty, output);
        assert!(told.contains(&line), "{line}\n{told}");
    }
    let second_set = r#"<input name="texcoord" type="vector2" nodename="uv" />"#;
    let packed = preset
        .maps
        .iter()
        .filter(|map| matches!(map.content, MapContent::Packed(_)));
    assert_eq!(told.matches(second_set).count(), packed.count(), "all but outputs");
    let documented = documented(DocumentFormat::MaterialX, &materials[0]);
    assert_eq!(documented.names, ["M_Cloth_gltf_pbr", "M_Cloth_open_pbr_surface"]);
    assert_eq!(documented.left_out, []);
}

#[test]
fn usd_leaves_out_the_channels_that_its_surface_does_not_have() {
    let preset = builtin("usd").unwrap().unwrap();
    let materials = materials_of(&preset, DocumentFormat::Usda, &[everything()]);
    let documented_text = documented(DocumentFormat::Usda, &materials[0]);
    let left_out = [
        Channel::Anisotropy,
        Channel::Sheen,
        Channel::SheenRoughness,
        Channel::Subsurface,
        Channel::Transmission,
    ];
    assert_eq!(
        (documented_text.names, documented_text.left_out),
        (vec!["/Materials/Cloth".to_owned()], left_out.to_vec())
    );
    let told = text(DocumentFormat::Usda, &materials);
    for line in [
        "string inputs:varname = \"st1\"",
        "float inputs:opacity.connect = </Materials/Cloth/BaseColor.outputs:a>",
        "token inputs:opacityMode = \"presence\"",
        "float inputs:displacement.connect = </Materials/Cloth/Height.outputs:r>",
        "color3f inputs:emissiveColor.connect = </Materials/Cloth/Emissive.outputs:rgb>",
        "asset inputs:file = @./Cloth_Emissive.exr@",
        "float inputs:clearcoatRoughness.connect = </Materials/Cloth/ClearcoatRoughness.outputs:r>",
    ] {
        assert!(told.contains(line), "{line}\n{told}");
    }
    let packed = materials_of(&preset, DocumentFormat::Usdz, &[everything()]);
    let files = usd_files(&packed);
    assert_eq!(
        files,
        [
            "Cloth_BaseColor.png",
            "Cloth_OcclusionRoughnessMetallic.png",
            "Cloth_Normal.png",
            "Cloth_Emissive.png",
            "Cloth_Clearcoat.png",
            "Cloth_ClearcoatRoughness.png"
        ],
        "no OpenEXR in a package"
    );
    assert!(
        documented(DocumentFormat::Usdz, &packed[0])
            .left_out
            .contains(&Channel::Height)
    );
}

#[test]
fn numbers_in_a_file_are_converted_back_to_values() {
    let preset = own(
        "[[map]]\nname = \"Mask\"\nr = \"metallic\"\ng = \"occlusion\"\nb = 0.5\na = \"1 - roughness\"\nformat = \"png8\"\n\
         [[map]]\nname = \"Height\"\ngray = \"height\"\nformat = \"png16\"\n",
    );
    let mut wood = set(0, None, "wood");
    // Maps with four components are read. The files of this test lack an alpha that is not a separate opacity.
    wood.vary = vec![Channel::Metallic, Channel::Roughness, Channel::Height, Channel::Opacity];
    let usd = text_of(&preset, DocumentFormat::Usda, std::slice::from_ref(&wood));
    for line in [
        "float inputs:roughness.connect = </Materials/wood/Mask.outputs:a>",
        "float4 inputs:scale = (1, 1, 1, -1)",
        "float4 inputs:bias = (0, 0, 0, 1)",
        "float4 inputs:scale = (0.75, 1, 1, 1)",
        "float4 inputs:bias = (-0.25, 0, 0, 0)",
    ] {
        assert!(usd.contains(line), "{line}\n{usd}");
    }
    let materials = materials_of(&preset, DocumentFormat::MaterialX, &[wood]);
    assert_eq!(materials[0].missing, [Channel::Opacity]);
    let mtlx = text(DocumentFormat::MaterialX, &materials);
    for line in [
        r#"<image name="image_Mask" type="vector4">"#,
        r#"<multiply name="image_Mask_3_multiply" type="float">"#,
        r#"<output name="out_roughness" type="float" nodename="image_Mask_3_multiply_add" />"#,
        r#"<output name="out_height" type="float" nodename="image_Height_multiply_add" />"#,
    ] {
        assert!(mtlx.contains(line), "{line}\n{mtlx}");
    }
}

#[test]
fn tiles_are_one_material_whose_file_names_have_a_placeholder() {
    let preset = own("names = \"$material(_u$udim)_$map\"\n\
         [[map]]\nname = \"Color & more\"\nrgb = \"base_color\"\na = \"opacity\"\nformat = \"png8\"\nsrgb = true\n\
         [[map]]\nname = \"Height\"\ngray = \"height\"\nformat = \"png16\"\n\
         [[map]]\nname = \"Metal\"\ngray = \"metallic\"\nformat = \"png8\"\n");
    let (mut one, mut two) = (set(0, Some(1001), "body"), set(0, Some(1002), "body"));
    one.vary = vec![Channel::BaseColor, Channel::Height, Channel::Metallic];
    two.vary = vec![Channel::BaseColor, Channel::Opacity, Channel::Height];
    one.values = vec![(Channel::Opacity, ConstantValue::Number(1.0))];
    two.values = vec![(Channel::Metallic, ConstantValue::Number(0.0))];
    let sets = [one, two];
    let [body] = &materials_of(&preset, DocumentFormat::MaterialX, &sets)[..] else {
        panic!("one material")
    };
    let text = text_of(&preset, DocumentFormat::MaterialX, &sets);
    assert!(
        text.contains(r#"value="body_u&lt;UDIM&gt;_Color &amp; more.png" colorspace="srgb_texture""#),
        "{text}"
    );
    assert!(
        text.contains(r#"<image name="image_Color_more" type="color4">"#),
        "{text}"
    );
    assert_eq!(
        body.maps[0].files,
        ["body_u1001_Color & more.png", "body_u1002_Color & more.png"]
    );
    assert!(text_of(&preset, DocumentFormat::Usda, &sets).contains("@./body_u<UDIM>_Color & more.png@"));
    assert_eq!(body.missing, [Channel::Metallic], "a tile lacks the file");
    let mut uneven = facts(&preset, &sets);
    for set in uneven.values_mut().take(1) {
        set.channels.insert(
            Channel::Height,
            ChannelFacts {
                constant: None,
                range: [0.0, 1.0],
            },
        );
    }
    let names = NamePattern::parse(&preset.names, &[]).unwrap();
    let files = PresetFiles {
        index: 0,
        preset: &preset,
        names: &names,
        takes: &|_| true,
        uv_set: &|_| 0,
    };
    assert_eq!(
        materials(&uneven, files)[0].missing,
        [Channel::Metallic, Channel::Height],
        "whole numbers of two ranges cannot be one picture"
    );
}

#[test]
fn paths_and_names_of_any_letters_are_quoted() {
    let preset = own("[[map]]\nname = \"a\"\ngray = \"roughness\"\nformat = \"png8\"\n");
    let mut odd = set(0, None, "x@@@y\\\u{ffff}");
    odd.vary = vec![Channel::Roughness];
    let mut same = set(1, None, "x y");
    same.values = vec![(Channel::Roughness, ConstantValue::Number(0.25))];
    let sets = [odd, same];
    let usd = text_of(&preset, DocumentFormat::Usda, &sets);
    assert!(
        usd.contains("asset inputs:file = @@@./x\\@@@y\\\u{ffff}_a.png@@@"),
        "{usd}"
    );
    assert!(usd.contains("string material = \"x@@@y\\\\\u{ffff}\""), "{usd}");
    assert!(
        usd.contains("def Material \"x_y\"") && usd.contains("def Material \"x_y_2\""),
        "{usd}"
    );
    let mtlx = text_of(&preset, DocumentFormat::MaterialX, &sets);
    assert!(mtlx.contains("value=\"x@@@y\\\u{fffd}_a.png\""), "{mtlx}");
}
