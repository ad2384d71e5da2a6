//! Documents as a bake writes them.

use super::*;
use crate::preset::DocumentFormat;

/// The layout of a tile of a material.
fn tile(number: u32) -> SetLayout {
    let mut layout = layout();
    layout.key.uv_tile = [number as i32 - 1001, 0];
    layout.key.udim = Some(number);
    layout
}

/// Bakes tiles of one material with their channels, and writes documents.
fn bake_tiles(
    folder: &Path,
    options: &SetOptions,
    tiles: &[(SetLayout, Vec<(Channel, ChannelPixels)>)],
) -> WrittenDocuments {
    let mut writer = BakeWriter::create(folder).unwrap();
    for (layout, channels) in tiles {
        let mut set = writer.set(layout, "body", options);
        for (channel, pixels) in channels {
            set.channel(channel, pixels.clone(), true).unwrap();
        }
        set.finish().unwrap();
    }
    let written = writer.documents(options, &|_| 0).unwrap();
    let committed = writer.commit().unwrap();
    assert!(committed.left_over.is_empty(), "{:?}", committed.left_over);
    written
}

fn own(documents: &str, maps: &str) -> SetOptions {
    let head = format!("version = 1\nname = \"own\"\nabout = \"Own.\"\ndocuments = {documents}\n");
    let preset = Preset::parse("own.toml", &format!("{head}{maps}")).unwrap();
    SetOptions {
        presets: vec![NamedPreset {
            preset,
            names: NamePattern::default(),
        }],
        document_stem: Some("model".to_owned()),
        ..SetOptions::raw().unwrap()
    }
}

fn flat(channel: Channel, value: f32) -> (Channel, ChannelPixels) {
    let pixels = pixels(&channel, |_| value);
    (channel, pixels)
}

fn varied(channel: Channel) -> (Channel, ChannelPixels) {
    let pixels = pixels(&channel, wavy);
    (channel, pixels)
}

#[test]
fn documents_are_listed_with_their_hashes_and_are_the_same_twice() {
    let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut options = preset("usd");
    options.presets.extend(preset("materialx").presets);
    options.presets[1].names = NamePattern::parse("$material_x_$map", &[]).unwrap();
    options.document_stem = Some("figure".to_owned());
    assert_eq!(options.document_names(), ["figure.usda", "figure.usdz", "figure.mtlx"]);
    let sets = [(layout(), everything())];
    let written = bake_tiles(a.path(), &options, &sets);
    assert_eq!(written, bake_tiles(b.path(), &options, &sets));
    assert!(written.outputs.is_empty() && written.warnings.is_empty(), "{written:?}");
    let listed: Vec<(&str, &str, DocumentFormat)> = written
        .documents
        .iter()
        .map(|document| (document.path.as_str(), document.preset.as_str(), document.format))
        .collect();
    assert_eq!(
        listed,
        [
            ("figure.usda", "usd", DocumentFormat::Usda),
            ("figure.usdz", "usd", DocumentFormat::Usdz),
            ("figure.mtlx", "materialx", DocumentFormat::MaterialX)
        ]
    );
    for document in &written.documents {
        let bytes = fs::read(a.path().join(&document.path)).unwrap();
        assert_eq!(bytes, fs::read(b.path().join(&document.path)).unwrap());
        assert_eq!(document.blake3, blake3::hash(&bytes).to_hex().to_string());
        assert_eq!(document.materials[0].material, "body");
    }
    let package = fs::read(a.path().join("figure.usdz")).unwrap();
    let map = fs::read(a.path().join("body_Normal.png")).unwrap();
    assert!(package.windows(11).any(|bytes| bytes == b"figure.usda"));
    let place = package.windows(map.len()).position(|bytes| bytes == map).unwrap();
    assert_eq!(place % 64, 0, "the map is in the package, uncompressed");
}

#[test]
fn documents_undo_what_normalized_maps_were_divided_by() {
    let maps = "[[map]]\nname = \"Emission\"\nrgb = \"emission\"\nformat = \"png8\"\nsrgb = true\nnormalize = true\n\
                [[map]]\nname = \"Height\"\ngray = \"height\"\nformat = \"exr16\"\nnormalize = true\n";
    let options = own("[\"materialx\", \"usda\"]", maps);
    let folder = tempfile::tempdir().unwrap();
    let emission = (
        Channel::Emission,
        pixels(&Channel::Emission, |index| (index % 41) as f32 * 0.125),
    );
    let height = (
        Channel::Height,
        pixels(&Channel::Height, |index| (index % 9) as f32 * 0.25 - 0.5),
    );
    bake_tiles(folder.path(), &options, &[(layout(), vec![height, emission])]);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let usd = read("model.usda");
    assert!(usd.contains("float4 inputs:scale = (5, 5, 5, 1)"), "{usd}");
    assert!(usd.contains("float4 inputs:scale = (2, 1, 1, 1)"), "{usd}");
    assert!(usd.contains("float4 inputs:bias = (-0.5, 0, 0, 0)"), "{usd}");
    let text = read("model.mtlx");
    let product = "<multiply name=\"image_Emission_multiply\" type=\"color3\">";
    assert!(text.contains(product) && text.contains("value=\"5\""), "{text}");
}

#[test]
fn the_package_multiplies_emission_above_1_and_the_text_reads_it_from_floats() {
    let mut options = preset("usd");
    options.document_stem = Some("figure".to_owned());
    let folder = tempfile::tempdir().unwrap();
    let emission = (
        Channel::Emission,
        pixels(&Channel::Emission, |index| (index % 41) as f32 * 0.125),
    );
    bake_tiles(folder.path(), &options, &[(layout(), vec![emission])]);
    let read = |name: &str| String::from_utf8_lossy(&fs::read(folder.path().join(name)).unwrap()).into_owned();
    let scale = "float4 inputs:scale = (5, 5, 5, 1)";
    let text = read("figure.usda");
    assert!(
        text.contains("@./body_Emissive.exr@") && !text.contains(scale),
        "{text}"
    );
    let package = read("figure.usdz");
    assert!(package.contains("@./body_Emissive.png@") && package.contains(scale));
    // Emission up to 1 is stored as it is.
    let low = (
        Channel::Emission,
        pixels(&Channel::Emission, |index| (index % 9) as f32 * 0.125),
    );
    let folder = tempfile::tempdir().unwrap();
    bake_tiles(folder.path(), &options, &[(layout(), vec![low])]);
    let package = fs::read(folder.path().join("figure.usdz")).unwrap();
    let package = String::from_utf8_lossy(&package);
    assert!(package.contains("@./body_Emissive.png@") && !package.contains("inputs:scale = (5"));
    assert!(!folder.path().join("body_Emissive.exr").exists());
}

#[test]
fn a_tile_gets_the_map_that_others_have() {
    let maps = "[[map]]\nname = \"Surface\"\nr = \"occlusion\"\ng = \"roughness\"\nb = \"metallic\"\nformat = \"png8\"\n\
                [[map]]\nname = \"Opacity\"\ngray = \"opacity\"\nformat = \"png8\"\n\
                [[map]]\nname = \"Height\"\ngray = \"height\"\nformat = \"exr32\"\n";
    let options = own("[\"materialx\"]", maps);
    let folder = tempfile::tempdir().unwrap();
    // Roughness varies in one tile; both opacities are 1; each tile has a height of its own.
    let first = vec![
        varied(Channel::Roughness),
        flat(Channel::Metallic, 1.0),
        flat(Channel::Opacity, 1.0),
        flat(Channel::Height, 0.5),
    ];
    let second = vec![
        flat(Channel::Roughness, 0.2),
        flat(Channel::Metallic, 0.0),
        flat(Channel::Opacity, 1.0),
        flat(Channel::Height, -2.0),
    ];
    let written = bake_tiles(folder.path(), &options, &[(tile(1001), first), (tile(1002), second)]);
    let outputs: Vec<(&str, Option<u32>)> = written
        .outputs
        .iter()
        .map(|output| (output.path.as_str(), output.udim))
        .collect();
    assert_eq!(
        outputs,
        [
            ("body_Surface.1002.png", Some(1002)),
            ("body_Height.1001.exr", Some(1001)),
            ("body_Height.1002.exr", Some(1002))
        ]
    );
    let (_, found) = codes(folder.path(), "body_Surface.1002.png");
    assert!(found.chunks(3).all(|pixel| pixel == [255, 51, 0]));
    let height = decode("h.exr", &fs::read(folder.path().join("body_Height.1002.exr")).unwrap()).unwrap();
    assert_eq!(height.pixels, Pixels::F32(vec![-2.0; (SIZE * SIZE) as usize]));
    let text = fs::read_to_string(folder.path().join("model.mtlx")).unwrap();
    assert!(
        text.contains("body_Surface.&lt;UDIM&gt;.png") && text.contains("body_Height.&lt;UDIM&gt;.exr"),
        "{text}"
    );
    assert!(!text.contains("Opacity") && !text.contains("alpha"), "{text}");
}

#[test]
fn what_no_map_gives_is_told() {
    let maps = "[[map]]\nname = \"Red\"\ngray = \"base_color.r\"\nformat = \"png8\"\n";
    let options = own("[\"usda\", \"usdz\"]", maps);
    let folder = tempfile::tempdir().unwrap();
    let channels = vec![varied(Channel::BaseColor), varied(Channel::Roughness)];
    let written = bake_tiles(folder.path(), &options, &[(layout(), channels)]);
    assert_eq!(
        written.warnings,
        [
            "model.usda has no base_color, roughness of 'body': the preset own has no map that a document can read it from"
        ]
    );
    assert_eq!(
        written.documents[0].materials[0].left_out,
        [Channel::BaseColor, Channel::Roughness]
    );
}

#[test]
fn two_presets_with_one_document_are_refused_before_anything_is_written() {
    let mut options = own(
        "[\"usda\"]",
        "[[map]]\nname = \"a\"\ngray = \"height\"\nformat = \"png8\"\n",
    );
    options.presets.extend(preset("usd").presets);
    let told = options.refuse_same_names(&[("wood", None)], &[], 64).unwrap_err();
    assert_eq!(
        told.to_string(),
        "two presets would write the document model.usda; bake them one after the other, into folders of their own, or leave \
         `documents` out of one of them"
    );
}
