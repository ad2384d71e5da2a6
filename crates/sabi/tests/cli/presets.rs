//! Presets: their list, their maps and their messages.

use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

#[test]
fn presets_are_listed_shown_and_a_copy_of_one_is_baked_with() {
    let place = CliFolder::new();
    let listed = place.sabi(&["presets", "list"]).good();
    for name in ["raw", "gltf", "unreal", "unity", "godot", "blender", "materialx", "usd"] {
        assert!(
            listed.stdout.lines().any(|line| line.starts_with(name)),
            "{}",
            listed.stdout
        );
    }
    let shown = place.sabi(&["presets", "show", "unity"]).good();
    assert!(
        shown.stdout.contains("R metallic, G occlusion, B 0.5, A 1 - roughness"),
        "{}",
        shown.stdout
    );
    let text = place.sabi(&["presets", "show", "unity", "--toml"]).good().stdout;
    place.write("studio.toml", text.replace("MaskMap", "Masks"));
    place.sabi(&["presets", "check", "studio.toml"]).good();
    place
        .bake(
            "rust.sabi",
            "cube.glb",
            &["--preset", "studio.toml", "--names", "$mesh_$map(_$variant)"],
        )
        .good();
    let maps = place.listing("out");
    assert!(maps.contains(&"cube_Masks.png".to_owned()), "{maps:?}");
    assert!(maps.contains(&"cube_BaseMap.png".to_owned()), "{maps:?}");
}

#[test]
fn a_preset_that_cannot_be_used_is_told_before_anything_is_read() {
    let place = CliFolder::new();
    place.write("odd.toml", "version = 1\nname = \"odd\"\nabout = \"Odd.\"\n");
    let checked = place.sabi(&["presets", "check", "odd.toml"]);
    assert_eq!(checked.code, Some(65));
    assert!(
        checked
            .stderr
            .contains("the preset odd.toml cannot be used: it has no maps; add one as [[map]]"),
        "{}",
        checked.stderr
    );
    let unknown = place.bake("rust.sabi", "cube.glb", &["--preset", "unrael"]);
    assert_eq!(unknown.code, Some(2));
    assert!(
        unknown.stderr.contains("there is no preset 'unrael'"),
        "{}",
        unknown.stderr
    );
}

#[test]
fn the_report_says_what_each_component_of_a_packed_map_is() {
    let place = CliFolder::new();
    let run = place
        .bake("rust.sabi", "cube.glb", &["--preset", "unreal", "--json"])
        .good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    let outputs = report["outputs"].as_array().unwrap();
    let packed = outputs.iter().find(|output| output["channel"] == "ORM").unwrap();
    assert_eq!(
        packed["components"],
        serde_json::json!(["occlusion", "roughness", "metallic"])
    );
    assert_eq!(packed["preset"], "unreal");
}

#[test]
fn documents_are_shown_written_beside_the_maps_and_listed() {
    let place = CliFolder::new();
    let shown = place.sabi(&["presets", "show", "usd"]).good().stdout;
    assert!(
        shown.contains("(model)                     usdz                the same with its PNG maps in one file\n"),
        "{shown}"
    );
    let arguments = [
        "--preset",
        "usd",
        "--preset",
        "materialx",
        "--names",
        "$preset_$map",
        "--json",
    ];
    let run = place.bake("rust.sabi", "cube.glb", &arguments).good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    let documents = report["documents"].as_array().unwrap();
    let paths: Vec<&str> = documents
        .iter()
        .filter_map(|document| document["path"].as_str())
        .collect();
    assert_eq!(paths, ["cube.usda", "cube.usdz", "cube.mtlx"]);
    assert_eq!(documents[0]["format"], "usda");
    let listing = place.listing("out");
    assert!(
        paths.iter().all(|path| listing.contains(&(*path).to_owned())),
        "{listing:?}"
    );
    for output in report["outputs"].as_array().unwrap() {
        let file = output["path"].as_str().unwrap();
        let document = match output["preset"].as_str().unwrap() {
            "usd" => place.read("out/cube.usda"),
            _ => place.read("out/cube.mtlx"),
        };
        assert!(String::from_utf8(document).unwrap().contains(file), "{file}");
    }
    place.sabi(&["verify", "out"]).good();
    // A folder with documents alone is also the folder of an earlier bake.
    for map in listing.iter().filter(|name| !name.starts_with("cube")) {
        std::fs::remove_file(place.path("out").join(map)).unwrap();
    }
    let again = place.bake("rust.sabi", "cube.glb", &arguments[..6]).good();
    assert!(
        again.stderr.contains(", cube.usda, cube.usdz and cube.mtlx in out"),
        "{}",
        again.stderr
    );
}

#[test]
fn documents_of_a_part_never_replace_complete_ones() {
    let place = CliFolder::new();
    let some = place
        .bake(
            "rust.sabi",
            "cube.glb",
            &["--preset", "materialx", "--channel", "roughness"],
        )
        .good();
    assert!(
        some.stderr.contains(
            "no documents of materials were written: with a part of the channels they would be incomplete; bake all channels to \
             write them"
        ),
        "{}",
        some.stderr
    );
    let one = [
        "--preset",
        "materialx",
        "--material",
        "cube",
        "--variant",
        "heavy",
        "--seed",
        "7",
    ];
    place.bake("rust.sabi", "cube.glb", &one).good();
    let listing = place.listing("out");
    let documents: Vec<&String> = listing.iter().filter(|name| name.ends_with(".mtlx")).collect();
    assert_eq!(documents, ["cube_cube.mtlx"]);
}
