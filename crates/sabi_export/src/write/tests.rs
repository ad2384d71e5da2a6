use std::fs;

use sabi_image::{DeclaredColorSpace, Pixels, decode};

mod outputs;

use super::*;

mod documents;
mod losses;

use crate::layout::{layouts, tests::atlas};
use crate::preset::Preset;
use crate::{ConstantValue, Padding, PaddingMap};

const SIZE: u32 = 32;

fn layout() -> SetLayout {
    layouts(&atlas(
        SIZE,
        SIZE,
        &[(0, [0, 0], [0, 0], 2..20, 3..30), (0, [0, 0], [0, 0], 24..30, 3..30)],
    ))
    .remove(0)
}

fn pixels(channel: &Channel, value: impl Fn(usize) -> f32) -> ChannelPixels {
    let components = channel.components();
    let texels: Vec<f32> = (0..(SIZE * SIZE) as usize * components).map(value).collect();
    let layout = layout();
    let texel = |at: usize| {
        let mut values = [0.0; 4];
        values[..components].copy_from_slice(&texels[at * components..][..components]);
        values
    };
    PaddingMap::new(&layout, Padding::Infinite).gather(&layout, channel, 0, texel)
}

fn wavy(index: usize) -> f32 {
    (index as f32 * 0.37).sin() * 0.4 + 0.5
}

fn bake(
    folder: &Path,
    options: &SetOptions,
    channels: &[(Channel, ChannelPixels)],
) -> (Vec<WrittenChannel>, CommittedBake) {
    let layout = layout();
    let mut writer = BakeWriter::create(folder).unwrap();
    let mut set = writer.set(&layout, "wood", options);
    let written = channels
        .iter()
        .map(|(channel, pixels)| set.channel(channel, pixels.clone(), true).unwrap())
        .collect();
    (written, writer.commit().unwrap())
}

fn everything() -> Vec<(Channel, ChannelPixels)> {
    let mut channels: Vec<Channel> = Channel::ALL.to_vec();
    channels.push(Channel::Mask("wear".into()));
    channels
        .into_iter()
        .map(|channel| (channel.clone(), pixels(&channel, wavy)))
        .collect()
}

#[test]
fn a_whole_set_is_written_as_raw_promises_and_twice_the_same() {
    let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (written, committed) = bake(a.path(), &SetOptions::raw().unwrap(), &everything());
    bake(b.path(), &SetOptions::raw().unwrap(), &everything());
    let outputs: Vec<&OutputRecord> = written.iter().flat_map(|written| &written.outputs).collect();
    let facts: Vec<(&str, u8, &str)> = outputs
        .iter()
        .map(|output| (output.path.as_str(), output.bits, output.color_space))
        .collect();
    assert_eq!(
        facts,
        [
            ("wood_base_color.png", 8, "srgb"),
            ("wood_opacity.png", 8, "linear"),
            ("wood_roughness.png", 8, "linear"),
            ("wood_metallic.png", 8, "linear"),
            ("wood_occlusion.png", 8, "linear"),
            ("wood_height.exr", 32, "linear"),
            ("wood_height.png", 16, "linear"),
            ("wood_normal.png", 16, "linear"),
            ("wood_emission.png", 8, "srgb"),
            ("wood_coat.png", 8, "linear"),
            ("wood_coat_roughness.png", 8, "linear"),
            ("wood_anisotropy.png", 8, "linear"),
            ("wood_sheen.png", 8, "srgb"),
            ("wood_sheen_roughness.png", 8, "linear"),
            ("wood_subsurface.png", 8, "srgb"),
            ("wood_transmission.png", 8, "linear"),
            ("wood_wear.png", 16, "linear"),
        ]
    );
    assert_eq!(committed.files.len(), facts.len());
    for output in outputs {
        let bytes = fs::read(a.path().join(&output.path)).unwrap();
        assert_eq!(bytes, fs::read(b.path().join(&output.path)).unwrap(), "{}", output.path);
        assert_eq!(output.blake3, blake3::hash(&bytes).to_hex().to_string());
        let picture = decode(&output.path, &bytes).unwrap();
        assert_eq!((picture.width, picture.height), (SIZE, SIZE));
        assert_eq!(usize::from(picture.channels), output.components.len());
        let declared = match (output.color_space, output.bits) {
            ("srgb", _) => DeclaredColorSpace::Srgb,
            (_, 32) => DeclaredColorSpace::Linear,
            _ => DeclaredColorSpace::Unknown,
        };
        assert_eq!(picture.color_space, declared, "{}", output.path);
    }
}

#[test]
fn heights_are_exact_and_their_range_spans_the_charts() {
    let folder = tempfile::tempdir().unwrap();
    let height = pixels(&Channel::Height, |index| index as f32 * 0.001 - 0.2);
    let (written, _) = bake(
        folder.path(),
        &SetOptions::raw().unwrap(),
        &[(Channel::Height, height.clone())],
    );
    let exact = decode("h.exr", &fs::read(folder.path().join("wood_height.exr")).unwrap()).unwrap();
    let [low, high] = written[0].outputs[1].range.unwrap();
    let cover = layout().cover;
    let within = height.data.iter().zip(&cover).map(|(height, cover)| match cover {
        Cover::Empty => height.clamp(low, high),
        _ => *height,
    });
    assert_eq!(
        exact.pixels,
        Pixels::F32(within.collect()),
        "the background lies in the range"
    );
    // First and last owned texels.
    assert_eq!(
        (low, high),
        ((3 * 32 + 2) as f32 * 0.001 - 0.2, (29 * 32 + 29) as f32 * 0.001 - 0.2)
    );
    assert_eq!(written[0].outputs[0].range, None);
    let coded = decode("h.png", &fs::read(folder.path().join("wood_height.png")).unwrap()).unwrap();
    for (value, texel) in coded
        .linear_rgba(sabi_image::TransferCurve::Linear)
        .rgba
        .iter()
        .zip(&height.data)
    {
        let expected = texel.clamp(low, high);
        assert!((low + value[0] * (high - low) - expected).abs() < 1e-5);
    }
}

#[test]
fn a_constant_channel_is_a_number_unless_all_maps_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let flat = [(Channel::Roughness, pixels(&Channel::Roughness, |_| 0.7))];
    let (written, committed) = bake(folder.path(), &SetOptions::raw().unwrap(), &flat);
    assert!(written[0].outputs.is_empty() && committed.files.is_empty());
    assert_eq!(written[0].constant.as_ref().unwrap().value, ConstantValue::Number(0.7));
    let all = SetOptions {
        all_maps: true,
        ..SetOptions::raw().unwrap()
    };
    let (written, committed) = bake(folder.path(), &all, &flat);
    assert_eq!((written[0].outputs.len(), committed.files.len()), (1, 1));
    let picture = decode("r.png", &fs::read(folder.path().join("wood_roughness.png")).unwrap()).unwrap();
    assert_eq!(picture.pixels, Pixels::U8(vec![179; (SIZE * SIZE) as usize]));
    let (_, committed) = bake(folder.path(), &SetOptions::raw().unwrap(), &flat);
    assert_eq!(
        committed.left_over,
        [folder.path().join("wood_roughness.png")],
        "the older map is mentioned"
    );
}

#[test]
fn emission_above_one_keeps_its_floats_beside_the_clamped_map() {
    let folder = tempfile::tempdir().unwrap();
    let emission = pixels(&Channel::Emission, |index| (index % 50) as f32 * 0.1);
    bake(
        folder.path(),
        &SetOptions::raw().unwrap(),
        &[(Channel::Emission, emission.clone())],
    );
    let exact = decode("e.exr", &fs::read(folder.path().join("wood_emission.exr")).unwrap()).unwrap();
    assert_eq!((exact.channels, exact.pixels), (3, Pixels::F32(emission.data)));
    assert!(folder.path().join("wood_emission.png").is_file());
}

#[test]
fn what_is_no_number_is_counted_and_made_neutral() {
    let folder = tempfile::tempdir().unwrap();
    let mut height = pixels(&Channel::Height, |index| index as f32);
    let owned = (3 * SIZE + 2) as usize;
    height.data[owned] = f32::NAN;
    height.data[owned + 1] = f32::NEG_INFINITY;
    let (written, _) = bake(folder.path(), &SetOptions::raw().unwrap(), &[(Channel::Height, height)]);
    assert_eq!(written[0].not_finite, 2);
    let exact = decode("h.exr", &fs::read(folder.path().join("wood_height.exr")).unwrap()).unwrap();
    assert_eq!(
        exact.linear_rgba(sabi_image::TransferCurve::Linear).rgba[owned + 1],
        [0.0, 0.0, 0.0, 1.0]
    );
}

#[test]
fn a_bake_that_fails_leaves_the_old_outputs_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    bake(folder.path(), &SetOptions::raw().unwrap(), &everything());
    let before = fs::read(folder.path().join("wood_roughness.png")).unwrap();
    let layout = layout();
    let mut writer = BakeWriter::create(folder.path()).unwrap();
    let options = SetOptions::raw().unwrap();
    let mut set = writer.set(&layout, "wood", &options);
    let other = pixels(&Channel::Roughness, |index| (index % 3) as f32 * 0.3);
    set.channel(&Channel::Roughness, other, true).unwrap();
    let short = ChannelPixels {
        components: 1,
        data: vec![0.0; 3],
    };
    let error = set.channel(&Channel::Opacity, short, true).unwrap_err();
    assert_eq!(
        error.to_string(),
        "channel opacity has 3 values for a texture set of 1024; this is a defect of Sabi"
    );
    drop(writer);
    assert_eq!(fs::read(folder.path().join("wood_roughness.png")).unwrap(), before);
    let names: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert!(
        names.iter().all(|name| !name.to_string_lossy().ends_with(".tmp")),
        "{names:?}"
    );
}

#[test]
fn two_masks_of_one_name_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let layout = layout();
    let mut writer = BakeWriter::create(folder.path()).unwrap();
    let options = SetOptions::raw().unwrap();
    let mut set = writer.set(&layout, "wood", &options);
    let (first, second) = (Channel::Mask("wear".into()), Channel::Mask("Wear".into()));
    set.channel(&first, pixels(&first, wavy), true).unwrap();
    let error = set.channel(&second, pixels(&second, wavy), true).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("two maps would be written to wood_Wear.png"),
        "{error}"
    );
}

#[test]
fn a_set_without_a_coat_tells_of_the_file_of_an_earlier_one() {
    let folder = tempfile::tempdir().unwrap();
    bake(folder.path(), &SetOptions::raw().unwrap(), &everything());
    let layout = layout();
    let options = SetOptions::raw().unwrap();
    let mut writer = BakeWriter::create(folder.path()).unwrap();
    writer.set(&layout, "wood", &options).leave_out(&Channel::Coat).unwrap();
    let committed = writer.commit().unwrap();
    assert_eq!(committed.left_over, [folder.path().join("wood_coat.png")]);
}

/// Options of one preset that comes with Sabi.
fn preset(name: &str) -> SetOptions {
    let preset = crate::preset::builtin(name).unwrap().unwrap();
    let names = NamePattern::parse(&preset.names, &[]).unwrap();
    SetOptions {
        presets: vec![NamedPreset { preset, names }],
        ..SetOptions::raw().unwrap()
    }
}

/// Bakes channels of a material with a preset, and ends the set.
fn bake_set(folder: &Path, options: &SetOptions, channels: &[(Channel, ChannelPixels)]) -> Vec<OutputRecord> {
    let layout = layout();
    let mut writer = BakeWriter::create(folder).unwrap();
    let mut set = writer.set(&layout, "wood", options);
    let mut outputs = Vec::new();
    for (channel, pixels) in channels {
        outputs.extend(set.channel(channel, pixels.clone(), true).unwrap().outputs);
    }
    outputs.extend(set.finish().unwrap());
    writer.commit().unwrap();
    outputs
}

fn codes(folder: &Path, name: &str) -> (u8, Vec<u8>) {
    let picture = decode(name, &fs::read(folder.join(name)).unwrap()).unwrap();
    match picture.pixels {
        Pixels::U8(codes) => (picture.channels, codes),
        _ => panic!("{name} has 8 bits"),
    }
}

#[test]
fn the_mask_map_of_unity_packs_smoothness_and_fills_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let roughness = pixels(&Channel::Roughness, |index| if index % 2 == 0 { 0.0 } else { 0.8 });
    let outputs = bake_set(folder.path(), &preset("unity"), &[(Channel::Roughness, roughness)]);
    let names: Vec<&str> = outputs.iter().map(|output| output.path.as_str()).collect();
    assert_eq!(names, ["wood_BaseMap.png", "wood_MaskMap.png", "wood_Normal.png"]);
    let mask = &outputs[1];
    assert_eq!(mask.components, ["metallic", "occlusion", "0.5", "1 - roughness"]);
    assert_eq!(
        (mask.channel.as_str(), mask.preset.as_str(), mask.color_space),
        ("MaskMap", "unity", "linear")
    );
    let (channels, found) = codes(folder.path(), "wood_MaskMap.png");
    assert_eq!(channels, 4);
    let texel = (10 * SIZE as usize + 10) * 4;
    assert_eq!(found[texel..texel + 8], [0, 255, 128, 255, 0, 255, 128, 51]);
    let (channels, found) = codes(folder.path(), "wood_Normal.png");
    assert_eq!(
        (channels, &found[..3]),
        (3, &[128, 128, 255][..]),
        "flat where nothing gives a normal"
    );
    assert_eq!(
        codes(folder.path(), "wood_BaseMap.png").0,
        3,
        "no alpha where all is opaque"
    );
}

#[test]
fn green_of_unreal_is_the_mirror_of_green_of_gltf() {
    let (up, down) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let normal = |flip: f32| {
        pixels(&Channel::Normal, move |at| match at % 3 {
            0 => wavy(at / 3) - 0.5,
            1 => (wavy(at / 3 + 7) - 0.5) * flip,
            _ => 0.8,
        })
    };
    bake_set(up.path(), &preset("gltf"), &[(Channel::Normal, normal(-1.0))]);
    bake_set(down.path(), &preset("unreal"), &[(Channel::Normal, normal(1.0))]);
    let (_, mirrored) = codes(up.path(), "wood_Normal.png");
    assert_eq!(codes(down.path(), "T_wood_N.png").1, mirrored);
}

#[test]
fn a_packed_map_waits_for_its_channels_in_any_order_and_masks_may_be_packed() {
    let text = "version = 1\nname = \"own\"\nabout = \"Own.\"\n[[map]]\nname = \"Packed\"\nr = \"output(wear)\"\n\
                g = \"1 - output(gone)\"\nb = \"metallic\"\nformat = \"png8\"\nsize = \"16x8\"\n";
    let wear = Channel::Mask("wear".into());
    let preset = Preset::parse("own.toml", text)
        .unwrap()
        .for_outputs(std::slice::from_ref(&wear))
        .unwrap();
    let options = SetOptions {
        presets: vec![NamedPreset {
            preset,
            names: NamePattern::parse("$map_$size", &[]).unwrap(),
        }],
        ..SetOptions::raw().unwrap()
    };
    let given = [
        (wear.clone(), pixels(&wear, |_| 1.0)),
        (Channel::Metallic, pixels(&Channel::Metallic, wavy)),
    ];
    let folder = tempfile::tempdir().unwrap();
    let outputs = bake_set(folder.path(), &options, &given);
    let [record] = &outputs[..] else { panic!("one file") };
    assert_eq!(
        (record.path.as_str(), record.width, record.height),
        ("Packed_16x8.png", 16, 8)
    );
    let (_, found) = codes(folder.path(), "Packed_16x8.png");
    assert!(
        found.chunks(3).all(|pixel| pixel[0] == 255 && pixel[1] == 255),
        "a mask that never comes is 0"
    );
}

#[test]
fn files_of_one_name_are_refused_before_anything_is_written() {
    let mut options = preset("raw");
    options.presets.extend(preset("blender").presets);
    let sets = [("wood", None), ("steel", Some(1001))];
    let told = |options: &SetOptions, masks: &[&str]| {
        let masks: Vec<Channel> = masks.iter().map(|name| Channel::Mask((*name).to_owned())).collect();
        options
            .refuse_same_names(&sets, &masks, 64)
            .map_err(|error| error.to_string())
    };
    assert_eq!(told(&preset("raw"), &["wear"]), Ok(()));
    let advice =
        "rename the material or the output that one of them belongs to, or name maps with $material and $preset";
    let same = "which are one file on systems that ignore capital letters";
    assert_eq!(
        told(&options, &[]),
        Err(format!(
            "two maps would be written to wood_roughness.png and wood_Roughness.png, {same}; {advice}"
        ))
    );
    assert_eq!(
        told(&preset("raw"), &["wear", "Wear"]),
        Err(format!(
            "two maps would be written to wood_wear.png and wood_Wear.png, {same}; {advice}"
        ))
    );
    assert_eq!(
        told(&preset("raw"), &["wear", "wear"]),
        Err(format!("two maps would be written to wood_wear.png; {advice}"))
    );
}
