use super::*;

#[test]
fn every_preset_that_comes_with_sabi_is_read_under_its_own_name() {
    for name in BUILTIN_NAMES {
        let text = builtin_text(name).unwrap();
        let preset = Preset::parse(name, text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(preset.name, name);
        assert!(preset.about.ends_with('.') && !preset.maps.is_empty(), "{name}");
        assert_eq!(builtin(name), Some(Ok(preset)));
    }
    assert_eq!(BUILTIN_NAMES[0], raw().unwrap().name);
    assert_eq!(builtin("other"), None);
}

/// Words of the files of a preset with their components.
fn packing(preset: &Preset) -> Vec<(String, String)> {
    let maps = preset.maps.iter().map(|map| match &map.content {
        MapContent::Every(kind) => (kind.plural().to_owned(), map.format.ending().to_owned()),
        MapContent::Packed(components) => {
            let components: Vec<String> = components.iter().map(ToString::to_string).collect();
            (format!("{}.{}", map.name, map.format.ending()), components.join(", "))
        }
    });
    maps.collect()
}

#[test]
fn engines_get_the_packing_that_they_read() {
    let of = |preset: &str, file: &str| {
        let found = packing(&builtin(preset).unwrap().unwrap())
            .into_iter()
            .find(|(name, _)| name == file);
        found.unwrap_or_else(|| panic!("{preset} has {file}")).1
    };
    let orm = "occlusion, roughness, metallic";
    assert_eq!(of("gltf", "OcclusionRoughnessMetallic.png"), orm);
    assert_eq!(of("unreal", "ORM.png"), orm);
    assert_eq!(of("godot", "orm.png"), orm);
    assert_eq!(of("unity", "MaskMap.png"), "metallic, occlusion, 0.5, 1 - roughness");
    assert_eq!(
        of("unity", "BaseMap.png"),
        "base_color.r, base_color.g, base_color.b, opacity"
    );
    assert_eq!(of("godot", "height.exr"), "height");
    let down: Vec<&str> = BUILTIN_NAMES
        .into_iter()
        .filter(|name| builtin(name).unwrap().unwrap().normal_y == NormalY::Down)
        .collect();
    assert_eq!(down, ["unreal"]);
}

#[test]
fn raw_has_the_promised_files() {
    let names: Vec<String> = packing(&raw().unwrap()).into_iter().map(|(name, _)| name).collect();
    assert_eq!(
        names,
        [
            "base_color.png",
            "opacity.png",
            "roughness.png",
            "metallic.png",
            "occlusion.png",
            "height.exr",
            "height.png",
            "normal.png",
            "emission.png",
            "emission.exr",
            "coat.png",
            "coat_roughness.png",
            "anisotropy.png",
            "sheen.png",
            "sheen_roughness.png",
            "subsurface.png",
            "transmission.png",
            "masks",
            "colors",
            "colors",
            "vectors"
        ]
    );
    let floats: Vec<MapFormat> = raw()
        .unwrap()
        .maps
        .iter()
        .map(|map| map.format)
        .filter(|format| !format.is_whole())
        .collect();
    assert_eq!(
        floats,
        [MapFormat::Exr, MapFormat::Exr, MapFormat::ExrHalf, MapFormat::Exr]
    );
}

fn with_map(map: &str) -> String {
    format!("version = 1\nname = \"own\"\nabout = \"Own.\"\n[[map]]\n{map}\n")
}

#[test]
fn a_preset_may_pack_any_component_its_inverse_a_constant_or_an_output() {
    let text = with_map(
        "name = \"Packed\"\nr = \"base_color.g\"\ng = \"1 - output(wear and tear)\"\nb = 0.25\na = \"normal.z\"\n\
         format = \"tga\"\nsize = \"1/2\"\nwhen = \"connected(height)\"\ndither = true",
    );
    let preset = Preset::parse("own.toml", &text).unwrap();
    let [map] = &preset.maps[..] else { panic!("one map") };
    let components = "base_color.g, 1 - output(wear and tear), 0.25, normal.b".to_owned();
    assert_eq!(packing(&preset), [("Packed.tga".to_owned(), components)]);
    assert_eq!((map.size, map.pixels(1024)), (MapSize::Divided(2), [512; 2]));
    assert_eq!(map.when, When::Connected(Channel::Height));
    assert_eq!((map.is_dithered, map.is_srgb), (true, false));
    let wear = Channel::Mask("wear and tear".to_owned());
    let given = preset.clone().for_outputs(std::slice::from_ref(&wear)).unwrap();
    assert_eq!(packing(&given), packing(&preset));
    assert!(given.maps[0].has(&wear) && !given.maps[0].has(&Channel::Height));
    let sized = |size: &str| {
        let text = with_map(&format!(
            "name = \"a\"\ngray = \"height\"\nformat = \"exr16\"\nsize = {size}"
        ));
        Preset::parse("own.toml", &text).unwrap().maps[0].size
    };
    assert_eq!(sized("512"), MapSize::Fixed([512; 2]));
    assert_eq!(sized("\"2048x1024\""), MapSize::Fixed([2048, 1024]));
}

/// Maps that cannot be used, with the sentence for each.
fn faulty_maps() -> Vec<(String, String)> {
    [faulty_components(), faulty_files()].concat()
}

fn faulty_components() -> Vec<(String, String)> {
    let channels = "base_color, opacity, roughness, metallic, occlusion, height, normal, emission, coat, coat_roughness, \
                    anisotropy, sheen, sheen_roughness, subsurface, transmission, output(NAME), mesh(NAME)";
    let gray = |more: &str| format!("name = \"a\"\nformat = \"png8\"\n{more}");
    vec![
        (
            gray("gray = \"rough\""),
            format!("map `a`: there is no channel `rough`; there is: {channels}"),
        ),
        (
            gray("gray = \"base_color\""),
            "map `a`: `base_color`: base_color has 3 components and one is needed here; write `base_color.r`, \
             `base_color.g` or `base_color.b`"
                .to_owned(),
        ),
        (
            gray("gray = \"roughness.g\""),
            "map `a`: `roughness.g`: roughness has one component and no `.g`; leave that out".to_owned(),
        ),
        (
            gray("gray = \"normal.q\""),
            "map `a`: `normal.q`: there is no component `.q`; there is: .r, .g, .b (or .x, .y, .z)".to_owned(),
        ),
        (
            gray("gray = 2"),
            "map `a`: 2 is no value of a map; give 0 to 1".to_owned(),
        ),
        (
            gray("gray = \"output()\""),
            "map `a`: `output()` names no output; write the name of an output node in it".to_owned(),
        ),
        (
            gray("r = \"roughness\""),
            "map `a`: name its components as `gray`, as `rgb`, or as `r`, `g` and `b`; `a` may follow".to_owned(),
        ),
    ]
}

fn faulty_files() -> Vec<(String, String)> {
    let gray = |more: &str| format!("name = \"a\"\nformat = \"png8\"\n{more}");
    vec![
        (
            gray("gray = \"roughness\"\nsize = \"1/3x\""),
            "map `a`: `1/3x` is no size; give 1/2 (of the other maps), 1024, or 2048x1024 (pixels, 1 to 16384)"
                .to_owned(),
        ),
        (
            gray("gray = \"roughness\"\nwhen = \"never\""),
            "map `a`: `never` is no condition; there is: varies, always, connected(CHANNEL), above_one, above_one(CHANNEL)"
                .to_owned(),
        ),
        (
            "name = \"a\"\nrgb = \"emission\"\nformat = \"exr16\"\nsrgb = true".to_owned(),
            "map `a`: OpenEXR files are linear; leave `srgb` out".to_owned(),
        ),
        (
            "name = \"a\"\ngray = \"roughness\"\nformat = \"png8\"\nnormalize = true".to_owned(),
            "map `a`: `normalize` is for the height or the emission of a material, alone in its file; leave it out".to_owned(),
        ),
        (
            "name = \"a\"\nr = \"height\"\ng = \"height\"\nb = \"roughness\"\nformat = \"png8\"\nnormalize = true".to_owned(),
            "map `a`: `normalize` is for the height or the emission of a material, alone in its file; leave it out".to_owned(),
        ),
        (
            "name = \"a\"\ngray = \"height\"\na = \"opacity\"\nformat = \"tga\"".to_owned(),
            "map `a`: TGA files have one, three or four components".to_owned(),
        ),
        (
            "gray = \"height\"\nformat = \"png8\"".to_owned(),
            "map 1: it has no `name`, which file names need".to_owned(),
        ),
        (
            "name = \"a/b\"\ngray = \"height\"\nformat = \"png8\"".to_owned(),
            "map `a/b`: `a/b` is no part of a file name; use letters, digits, '_' and '-'".to_owned(),
        ),
        (
            "name = \"a\"\noutputs = \"masks\"\nformat = \"png8\"".to_owned(),
            "map `a`: its files have the names of the outputs; leave `name` out".to_owned(),
        ),
        (
            format!(
                "{}\n[[map]]\n{}",
                gray("gray = \"height\""),
                gray("gray = \"roughness\"")
            ),
            "two of its maps are `a` as .png; give one of them another name".to_owned(),
        ),
    ]
}

#[test]
fn what_cannot_be_used_is_told_with_a_remedy() {
    for (map, why) in faulty_maps() {
        let told = Preset::parse("own.toml", &with_map(&map)).unwrap_err().to_string();
        assert_eq!(told, format!("the preset own.toml cannot be used: {why}"));
    }
    let told = |text: &str| Preset::parse("own.toml", text).unwrap_err().why;
    assert_eq!(
        told("version = 2\nname = \"own\"\nabout = \"Own.\""),
        "it has version 2, and version 1 is read here"
    );
    assert_eq!(
        told("version = 1\nname = \"own\"\nabout = \"Own.\""),
        "it has no maps; add one as [[map]]"
    );
    assert!(told("version = 1\nnam = \"own\"").contains("unknown field `nam`"));
}

#[test]
fn documents_are_read_and_need_green_upward() {
    let with = |keys: &str| {
        let map = "[[map]]\nname = \"a\"\ngray = \"height\"\nformat = \"png8\"\n";
        let head = "version = 1\nname = \"own\"\nabout = \"Own.\"\n";
        Preset::parse("own.toml", &format!("{head}{keys}\n{map}"))
    };
    let read = with("documents = [\"usdz\", \"materialx\"]").unwrap();
    assert_eq!(read.documents, [DocumentFormat::Usdz, DocumentFormat::MaterialX]);
    let told = |keys: &str| with(keys).unwrap_err().why;
    assert_eq!(
        told("normal_y = \"-\"\ndocuments = [\"usda\"]"),
        "its documents are read with green upward; set `normal_y` to \"+\", or leave `documents` out and put them into a preset \
         of their own"
    );
    assert_eq!(
        told("documents = [\"usda\", \"usda\"]"),
        "`documents` has `usda` twice; name it once"
    );
    assert!(told("documents = [\"usdc\"]").contains("unknown variant `usdc`"));
}

/// A preset of one map for a graph with a mask `wear`, a color `tint` and a vector `flow`: its packing, or why not.
fn packed_for_outputs(map: &str) -> Result<String, String> {
    let outputs = [
        Channel::Mask("wear".into()),
        Channel::Color("tint".into()),
        Channel::Vector("flow".into()),
    ];
    let preset = Preset::parse(
        "own.toml",
        &with_map(&format!("name = \"a\"\nformat = \"png8\"\n{map}")),
    )
    .unwrap();
    let given = preset.for_outputs(&outputs).map_err(|error| error.to_string())?;
    let known: Vec<Channel> = given.maps[0].channels().into_iter().cloned().collect();
    let others = known.iter().filter(|channel| !outputs.contains(channel)).count();
    Ok(format!("{}; {others} unknown", packing(&given)[0].1))
}

#[test]
fn outputs_are_packed_by_the_components_that_the_graph_gives_them() {
    let cases = [
        (
            "rgb = \"output(tint)\"",
            Ok("output(tint).r, output(tint).g, output(tint).b; 0 unknown"),
        ),
        (
            "rgb = \"1 - output(wear)\"",
            Ok("1 - output(wear), 1 - output(wear), 1 - output(wear); 0 unknown"),
        ),
        ("gray = \"output(flow).y\"", Ok("output(flow).g; 0 unknown")),
        ("gray = \"output(gone)\"", Ok("output(gone); 1 unknown")),
        (
            "gray = \"output(tint)\"",
            Err(
                "the preset own cannot be used: map `a`: `output(tint)`: this output has 3 components and one is needed \
                 here; write `.r`, `.g` or `.b` behind it",
            ),
        ),
        (
            "gray = \"output(wear).g\"",
            Err(
                "the preset own cannot be used: map `a`: `output(wear).g`: this output is a mask, which has one component; \
                 leave the letter out",
            ),
        ),
    ];
    for (map, expected) in cases {
        let expected = expected.map(str::to_owned).map_err(str::to_owned);
        assert_eq!(packed_for_outputs(map), expected, "{map}");
    }
}
