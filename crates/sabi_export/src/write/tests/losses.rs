//! What a file cannot hold as it is: emission above 1, heights in 0 to 1, and channels that a preset has no map for.

use super::*;
use crate::preset::BUILTIN_NAMES;

/// Emission up to 4 in red alone.
fn bright() -> ChannelPixels {
    pixels(&Channel::Emission, |index| match index % 3 {
        0 => (index % 41) as f32 * 0.1,
        _ => 0.5,
    })
}

fn writer(folder: &Path) -> BakeWriter {
    let mut writer = BakeWriter::create(folder).unwrap();
    writer.keep_model_maps();
    writer
}

/// The output of a channel of a bake of that channel alone.
fn output(folder: &Path, options: &SetOptions, channel: Channel, pixels: &ChannelPixels) -> OutputRecord {
    let outputs = bake_set(folder, options, &[(channel.clone(), pixels.clone())]);
    let mut its = outputs.into_iter().filter(|output| output.channel == channel.name());
    its.next_back().unwrap()
}

#[test]
fn emission_above_one_is_divided_by_its_highest_value_where_an_engine_has_a_strength() {
    let emission = bright();
    for name in ["gltf", "unreal", "unity", "godot"] {
        let folder = tempfile::tempdir().unwrap();
        let record = output(folder.path(), &preset(name), Channel::Emission, &emission);
        assert_eq!(record.scale, Some(4.0), "{name}");
        let (channels, codes) = codes(folder.path(), &record.path);
        assert_eq!(channels, 3);
        for (code, value) in codes.iter().zip(&emission.data) {
            assert_eq!(*code, sabi_color::srgb8_from_linear(value / 4.0), "{name}: {value}");
        }
        let dim = pixels(&Channel::Emission, wavy);
        let record = output(folder.path(), &preset(name), Channel::Emission, &dim);
        assert_eq!(record.scale, None, "{name}: nothing exceeds 1");
    }
}

#[test]
fn tiles_of_a_material_share_the_divisor_of_their_emission() {
    let folder = tempfile::tempdir().unwrap();
    let layout = layout();
    let options = preset("gltf");
    let mut writer = writer(folder.path());
    writer.set_peak(0, &Channel::Emission, 8.0);
    let mut set = writer.set(&layout, "wood", &options);
    let written = set.channel(&Channel::Emission, bright(), true).unwrap();
    assert_eq!(written.outputs[0].scale, Some(8.0));
    let maps = writer.take_model_maps().remove(&layout.key).unwrap();
    assert_eq!(maps.emission_strength, 8.0);
    assert!(
        maps.emission.is_some_and(|map| map.is_written),
        "the copy names the map of the bake"
    );
}

#[test]
fn the_heights_of_godot_span_zero_to_one_and_the_record_has_their_range() {
    let folder = tempfile::tempdir().unwrap();
    let height = pixels(&Channel::Height, |index| index as f32 * 0.001 - 0.2);
    let record = output(folder.path(), &preset("godot"), Channel::Height, &height);
    let [low, high] = record.range.unwrap();
    // First and last owned texels.
    assert_eq!(
        (low, high),
        ((3 * 32 + 2) as f32 * 0.001 - 0.2, (29 * 32 + 29) as f32 * 0.001 - 0.2)
    );
    let picture = decode("h.exr", &fs::read(folder.path().join(&record.path)).unwrap()).unwrap();
    let values = picture.linear_rgba(sabi_image::TransferCurve::Linear).rgba;
    for (value, height) in values.iter().zip(&height.data) {
        let expected = ((height - low) / (high - low)).clamp(0.0, 1.0);
        assert!((value[0] - expected).abs() <= 0.5 / 1024.0, "{} {expected}", value[0]);
    }
    let edges: Vec<f32> = values.iter().map(|value| value[0]).collect();
    assert!(edges.contains(&0.0) && edges.contains(&1.0));
}

#[test]
fn a_map_that_is_cut_at_one_is_noted_unless_floats_hold_the_rest() {
    let own = |more: &str| {
        let text = format!(
            "version = 1\nname = \"own\"\nabout = \"Own.\"\n[[map]]\nname = \"E\"\nrgb = \"emission\"\nformat = \"png8\"\n{more}\n\
             [[map]]\noutputs = \"colors\"\nformat = \"png8\"\n"
        );
        let preset = Preset::parse("own.toml", &text).unwrap();
        let names = NamePattern::default();
        SetOptions {
            presets: vec![NamedPreset { preset, names }],
            ..SetOptions::raw().unwrap()
        }
    };
    let tint = Channel::Color("tint".into());
    let cut = |options: &SetOptions| {
        let folder = tempfile::tempdir().unwrap();
        let layout = layout();
        let mut writer = BakeWriter::create(folder.path()).unwrap();
        let mut set = writer.set(&layout, "wood", options);
        for channel in [&Channel::Emission, &tint] {
            set.channel(channel, bright(), true).unwrap();
        }
        let found = writer.cut_maps().iter();
        found
            .map(|map| (map.path.clone(), map.channel.clone(), map.peak))
            .collect::<Vec<_>>()
    };
    let of_tint = ("wood_tint.png".to_owned(), tint.clone(), 4.0);
    let of_emission = ("wood_E.png".to_owned(), Channel::Emission, 4.0);
    assert_eq!(cut(&own("srgb = true")), [of_emission, of_tint.clone()]);
    assert_eq!(cut(&own("normalize = true")), std::slice::from_ref(&of_tint));
    let floats = "[[map]]\nname = \"E\"\nrgb = \"emission\"\nformat = \"exr16\"\nwhen = \"above_one(emission)\"";
    assert_eq!(cut(&own(floats)), [of_tint]);
    for name in BUILTIN_NAMES {
        assert_eq!(cut(&preset(name)), [], "{name}");
    }
}

#[test]
fn what_a_preset_has_no_map_for_is_listed_for_each_material_that_has_it() {
    let left_out = |name: &str, channels: &[(Channel, ChannelPixels)]| {
        let folder = tempfile::tempdir().unwrap();
        let layout = layout();
        let options = preset(name);
        let mut writer = BakeWriter::create(folder.path()).unwrap();
        let mut set = writer.set(&layout, "wood", &options);
        for (channel, pixels) in channels {
            set.channel(channel, pixels.clone(), true).unwrap();
        }
        set.finish().unwrap();
        let found = writer.left_out(&options).into_iter();
        let found = found.map(|left| {
            assert_eq!((left.preset.as_str(), left.material.as_str()), (name, "wood"));
            left.channels
                .iter()
                .map(|channel| channel.name().into_owned())
                .collect::<Vec<_>>()
                .join(" ")
        });
        found.collect::<Vec<_>>().join("; ")
    };
    let cases = [
        ("raw", ""),
        ("materialx", ""),
        ("blender", ""),
        ("gltf", "height"),
        ("unreal", "sheen_roughness transmission"),
        ("unity", "sheen sheen_roughness subsurface transmission"),
        ("godot", "sheen sheen_roughness transmission"),
        ("usd", "anisotropy sheen sheen_roughness subsurface transmission"),
        ("mesh", ""),
    ];
    for (name, channels) in cases {
        assert_eq!(left_out(name, &everything()), channels, "{name}");
    }
    let flat = |channel: Channel, value: f32| {
        let pixels = pixels(&channel, |_| value);
        (channel, pixels)
    };
    // A value that changes nothing is no loss, and the roughness of no sheen neither; one value everywhere is.
    let none = [
        flat(Channel::Sheen, 0.0),
        flat(Channel::SheenRoughness, 0.4),
        flat(Channel::Height, 0.0),
    ];
    assert_eq!(left_out("unity", &none), "");
    assert_eq!(left_out("unity", &[flat(Channel::Transmission, 0.5)]), "transmission");
}

#[test]
fn the_copy_of_the_model_names_the_maps_of_the_preset_for_gltf() {
    let folder = tempfile::tempdir().unwrap();
    let layout = layout();
    let options = preset("gltf");
    let mut writer = writer(folder.path());
    let mut set = writer.set(&layout, "wood", &options);
    for (channel, pixels) in everything() {
        set.channel(&channel, pixels, true).unwrap();
    }
    set.finish().unwrap();
    let finish = writer.take_model_maps().remove(&layout.key).unwrap().finish;
    let names = [
        finish.coat.map,
        finish.anisotropy.map,
        finish.sheen.map,
        finish.subsurface.map,
        finish.transmission.map,
    ]
    .map(|map| map.map(|map| (map.name, map.is_written)));
    let expected = [
        "Clearcoat",
        "Anisotropy",
        "Sheen",
        "DiffuseTransmission",
        "Transmission",
    ];
    assert_eq!(names, expected.map(|word| Some((format!("wood_{word}.png"), true))));
}

#[test]
fn the_copy_of_the_model_takes_the_base_color_of_the_preset_whether_opacity_varies_or_is_one_value() {
    for (name, opacity) in [
        ("opaque", pixels(&Channel::Opacity, |_| 1.0)),
        ("half", pixels(&Channel::Opacity, |_| 0.5)),
        ("varied", pixels(&Channel::Opacity, wavy)),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let layout = layout();
        let options = preset("gltf");
        let mut writer = writer(folder.path());
        let mut set = writer.set(&layout, "wood", &options);
        let color = pixels(&Channel::BaseColor, wavy);
        set.channel(&Channel::BaseColor, color, true).unwrap();
        set.channel(&Channel::Opacity, opacity, true).unwrap();
        set.finish().unwrap();
        let maps = writer.take_model_maps().remove(&layout.key).unwrap();
        let color = maps.base_color.map(|map| (map.name, map.is_written));
        assert_eq!(color, Some(("wood_BaseColor.png".to_owned(), true)), "{name}");
    }
}

#[test]
fn packed_finishes_have_their_components_where_the_targets_read_them() {
    let (strength, x, y) = (0.5, 0.9, 0.2);
    let anisotropy = pixels(&Channel::Anisotropy, |index| match index % 3 {
        0 => x,
        1 => y,
        // One pixel differs, so that there is a map.
        _ if index == 3 * (10 * SIZE as usize + 10) + 2 => 0.0,
        _ => strength,
    });
    let coat = pixels(&Channel::Coat, wavy);
    let roughness = pixels(&Channel::CoatRoughness, |_| 0.25);
    let channels = [
        (Channel::Coat, coat.clone()),
        (Channel::CoatRoughness, roughness),
        (Channel::Anisotropy, anisotropy),
    ];
    let code = |value: f32| sabi_image::quantize_u8(value);
    let cases = [
        ("gltf", "wood_Anisotropy.png", vec![code(x), code(y), code(strength)]),
        ("unreal", "T_wood_A.png", vec![code(x), code(1.0 - y), code(strength)]),
        ("unity", "wood_Tangent.png", vec![code(x), code(y), code(0.5)]),
        ("unity", "wood_Anisotropy.png", vec![code(strength)]),
        ("godot", "wood_flowmap.png", vec![code(x), code(y), 0, code(strength)]),
        ("blender", "wood_Anisotropy.png", vec![code(x), code(y), code(strength)]),
        // Roughness, and for Unity its inverse, beside the coat in red.
        ("gltf", "wood_Clearcoat.png", vec![code(coat.data[0]), code(0.25), 0]),
        ("unreal", "T_wood_CC.png", vec![code(coat.data[0]), code(0.25), 0]),
        ("godot", "wood_clearcoat.png", vec![code(coat.data[0]), code(0.25), 0]),
        ("unity", "wood_CoatMask.png", vec![code(coat.data[0]), code(0.75), 0]),
    ];
    for (name, file, first) in cases {
        let folder = tempfile::tempdir().unwrap();
        bake_set(folder.path(), &preset(name), &channels);
        let (count, codes) = codes(folder.path(), file);
        assert_eq!(usize::from(count), first.len(), "{name} {file}");
        for (at, (found, expected)) in codes.iter().zip(&first).enumerate() {
            // Gradients are dithered by less than a code.
            let near = if at == 0 { 1 } else { 0 };
            assert!(
                found.abs_diff(*expected) <= near,
                "{name} {file}: {codes:?} {first:?}",
                codes = &codes[..count.into()]
            );
        }
    }
}
