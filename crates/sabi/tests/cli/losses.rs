//! Values that a preset has no map for, or that a file cannot store unchanged: reported by the presets, the report and warnings.

use serde_json::{Value as Json, json};

use crate::cli_folder::{CliFolder, graph};

/// A material with values that few materials have, and with emission up to 4.
const FINISH: &str = r##"    "base": { "kind": "source/material", "params": { "color": "#3c5a6e" } },
    "clouds": { "kind": "noise/simplex" },
    "out": { "kind": "output/material", "inputs": { "material": "rust" } },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
      "params": { "coat": 0.8, "coat_roughness": 0.3, "anisotropy": 0.5, "sheen": "#808080", "sheen_roughness": 0.6,
        "subsurface": "#804020", "subsurface_transmission": 0.7, "emission": "#ffffff", "emission_on": true,
        "emission_strength": 4 } }"##;

fn place() -> CliFolder {
    let place = CliFolder::new();
    place.write("finish.sabi", graph(FINISH));
    place
}

fn baked(place: &CliFolder, graph: &str, more: &[&str]) -> (Json, String) {
    let more = [more, &["--json"]].concat();
    let run = place.bake(graph, "cube.glb", &more).good();
    (serde_json::from_str(&run.stdout).unwrap(), run.stderr)
}

#[test]
fn a_preset_lists_what_it_leaves_out() {
    let place = place();
    let shown = |name: &str| place.sabi(&["presets", "show", name]).good().stdout;
    assert!(shown("unity").ends_with("\nleft out  sheen, sheen_roughness, subsurface, transmission\n"));
    assert!(!shown("blender").contains("left out"));
    let listed = place.sabi(&["presets", "show", "unreal", "--json"]).good().stdout;
    let listed: Json = serde_json::from_str(&listed).unwrap();
    assert_eq!(listed["left_out"], json!(["sheen_roughness", "transmission"]));
}

#[test]
fn a_bake_warns_of_what_its_preset_leaves_out_and_reports_it() {
    let place = place();
    let (report, told) = baked(&place, "finish.sabi", &["--preset", "unity"]);
    let channels = json!(["sheen", "sheen_roughness", "subsurface", "transmission"]);
    let left_out = json!([{ "preset": "unity", "material": "cube", "channels": channels }]);
    assert_eq!(report["left_out"], left_out);
    let sentence = "warning: the preset unity has no place for sheen, sheen roughness, subsurface, transmission of 'cube', which is left \
                    out; the preset raw has a map for every channel\n";
    assert!(told.contains(sentence), "{told}");
    for (preset, files) in [
        (
            "gltf",
            [
                "cube_Clearcoat.png",
                "cube_Sheen.png",
                "cube_DiffuseTransmission.png",
                "cube_Transmission.png",
            ],
        ),
        (
            "blender",
            [
                "cube_Coat.png",
                "cube_Anisotropy.png",
                "cube_Subsurface.png",
                "cube_Transmission.png",
            ],
        ),
    ] {
        let (report, told) = baked(&place, "finish.sabi", &["--preset", preset, "-o", preset]);
        assert!(!told.contains("has no place for"), "{told}");
        let maps = place.listing(preset);
        assert!(
            files.iter().all(|file| maps.contains(&(*file).to_owned())),
            "{preset}: {maps:?}"
        );
        assert_eq!(report["left_out"], json!([]), "{preset}");
    }
    // Nothing is reported as left out for a part of the channels, or for a material without the special values.
    let (report, told) = baked(
        &place,
        "finish.sabi",
        &["--preset", "unity", "--channel", "roughness", "-o", "part"],
    );
    assert_eq!((&report["left_out"], told.contains("no place")), (&json!([]), false));
    let (report, _) = baked(&place, "rust.sabi", &["--preset", "unity", "-o", "rust"]);
    assert_eq!(report["left_out"], json!([]));
}

#[test]
fn emission_above_one_is_scaled_and_the_number_is_told() {
    let place = place();
    let (report, told) = baked(&place, "finish.sabi", &["--preset", "gltf", "--model"]);
    let outputs = report["outputs"].as_array().unwrap();
    let emission = outputs.iter().find(|output| output["channel"] == "emission").unwrap();
    let scale = emission["scale"].as_f64().unwrap();
    assert!(scale > 1.5 && scale <= 4.0, "{scale}");
    let sentence = format!(
        "warning: cube_Emissive.png holds the emission of 'cube' divided by {scale}, since it exceeds 1: set the strength of the \
         emission to {scale} where the map is used\n"
    );
    assert!(told.contains(&sentence), "{told}");
    // The copy of the model has it.
    let copy = place.read("out/cube.glb");
    let text = String::from_utf8_lossy(&copy);
    assert!(text.contains("emissiveStrength"), "{text}");
    assert!(!place.listing("out").iter().any(|name| name.contains("up_to_1")));
    let (report, told) = baked(&place, "rust.sabi", &["--preset", "gltf", "-o", "rust"]);
    assert!(
        !told.contains("divided by")
            && report["outputs"]
                .as_array()
                .unwrap()
                .iter()
                .all(|output| output["scale"].is_null())
    );
}

#[test]
fn a_preset_of_ones_own_that_cuts_emission_is_told_with_the_key_that_helps() {
    let place = place();
    let map = "version = 1\nname = \"own\"\nabout = \"Own.\"\n[[map]]\nname = \"E\"\nrgb = \"emission\"\nformat = \"png8\"\nsrgb = true\n";
    place.write("own.toml", map);
    let (_, told) = baked(&place, "finish.sabi", &["--preset", "own.toml"]);
    let sentence = "warning: cube_E.png is cut at 1, and emission of 'cube' goes up to ";
    assert!(told.contains(sentence), "{told}");
    assert!(
        told.contains("; give the map `normalize = true`, or a format of floats, in its preset\n"),
        "{told}"
    );
    assert!(!told.contains("has no place"), "a preset of a part is meant so: {told}");
}

#[test]
fn heights_for_godot_are_zero_to_one_with_their_range_in_report_and_summary() {
    let place = place();
    let run = place
        .bake(
            "rust.sabi",
            "cube.glb",
            &["--preset", "godot", "--report", "godot.json"],
        )
        .good();
    let report: Json = serde_json::from_slice(&place.read("godot.json")).unwrap();
    let outputs = report["outputs"].as_array().unwrap();
    let height = outputs.iter().find(|output| output["channel"] == "height").unwrap();
    let range: Vec<f64> = height["range"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Json::as_f64)
        .collect();
    assert!(range[0] < range[1], "{range:?}");
    let line = format!(
        "  height     cube_height.exr is {} to {} in the model's units\n",
        range[0], range[1]
    );
    assert!(run.stderr.contains(&line), "{line}{}", run.stderr);
}

#[test]
fn the_stages_of_a_bake_are_the_time_that_it_took() {
    let place = place();
    let started = std::time::Instant::now();
    let (report, _) = baked(&place, "rust.sabi", &["--model"]);
    let process = started.elapsed().as_secs_f64() * 1000.0;
    let stages = report["stages_ms"].as_object().unwrap();
    assert_eq!(
        stages.keys().collect::<Vec<_>>(),
        ["load", "atlas", "compile", "run", "encode"]
    );
    let sum: f64 = stages.values().filter_map(Json::as_f64).sum();
    assert!(sum > 0.0 && sum <= process, "{sum} of {process}");
    // For maps that existed already, the report has the times of the bake that made them.
    let (again, _) = baked(&place, "rust.sabi", &["--model"]);
    assert_eq!(again["up_to_date"], true);
    let again: f64 = again["stages_ms"]
        .as_object()
        .unwrap()
        .values()
        .filter_map(Json::as_f64)
        .sum();
    assert!(again > 0.0 && again <= sum, "{again} of {sum}");
}

#[test]
fn a_document_never_names_the_maps_of_another_bake_in_silence() {
    let place = place();
    let seeded = |seed: &str, more: &[&str]| {
        let more = [&["--preset", "usd", "--seed", seed], more].concat();
        place.bake("rust.sabi", "cube.glb", &more).good()
    };
    seeded("1", &[]);
    let documents = |folder: &str| {
        let mut names = place.listing(folder);
        names.retain(|name| name.contains(".usd"));
        names
    };
    assert_eq!(documents("out"), ["cube.usda", "cube.usdz"]);
    let first = place.read("out/cube.usda");
    seeded("2", &[]);
    // The document belongs to the maps, and says the same about other maps.
    assert_eq!(
        (documents("out"), place.read("out/cube.usda")),
        (vec!["cube.usda".to_owned(), "cube.usdz".to_owned()], first)
    );
    place.sabi(&["verify", "out"]).good();
    let names = ["--names", "$material_$map_$seed", "-o", "both"];
    seeded("1", &names);
    seeded("2", &names);
    assert_eq!(
        documents("both"),
        ["cube_1.usda", "cube_1.usdz", "cube_2.usda", "cube_2.usdz"]
    );
    let second = String::from_utf8(place.read("both/cube_2.usda")).unwrap();
    assert!(
        second.contains("cube_BaseColor_2.png") && !second.contains("_1.png"),
        "{second}"
    );
    place.sabi(&["verify", "both"]).good();
    // A document of all materials stays when one of them is baked again.
    let one = seeded("3", &["--material", "cube"]);
    let sentence = "warning: cube.usda of an earlier bake names maps that this one has replaced; bake it again into a folder of its own, \
                    or remove it\n";
    assert!(one.stderr.contains(sentence), "{}", one.stderr);
}

#[test]
fn a_bake_with_documents_is_made_again_from_its_report() {
    let place = place();
    place
        .bake("rust.sabi", "cube.glb", &["--preset", "usd", "--report", "usd.json"])
        .good();
    let again = place.sabi(&["bake", "--from", "usd.json", "-o", "again"]).good();
    assert!(
        again.stderr.contains("all with the bytes that it records"),
        "{}",
        again.stderr
    );
}

#[test]
fn all_tiles_of_a_material_have_the_same_strength_of_emission() {
    let place = place();
    // Two squares in two tiles of UDIM.
    let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\n";
    let uvs = "vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\nvt 1.1 0.1\nvt 1.9 0.1\nvt 1.9 0.9\nvt 1.1 0.9\n";
    place.write(
        "tiles.obj",
        format!("{vertices}{uvs}usemtl lamp\nf 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n"),
    );
    // The light grows along the model: the second tile is brighter.
    let ramp = FINISH.replace(
        "\"noise/simplex\"",
        "\"surface/position\", \"params\": { \"along\": [1, 0, 0] }",
    );
    let text = graph(&ramp)
        .replace("\"clouds.gain\"", "\"rust.coat\"")
        .replace("\"clouds.mode\"", "\"rust.color\"");
    place.write("lamp.sabi", text.replace("\"heavy\": { \"amount\": 0.9 }", ""));
    let options = ["--preset", "godot", "--udim", "on", "--json"];
    let run = place.bake("lamp.sabi", "tiles.obj", &options).good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    let outputs = report["outputs"].as_array().unwrap();
    let emission = outputs.iter().filter(|output| output["channel"] == "emission");
    let scales: Vec<(u64, f64)> = emission
        .map(|output| (output["udim"].as_u64().unwrap(), output["scale"].as_f64().unwrap()))
        .collect();
    assert_eq!(scales.iter().map(|(udim, _)| *udim).collect::<Vec<_>>(), [1001, 1002]);
    assert!(scales[0].1 == scales[1].1 && scales[0].1 > 3.0, "{scales:?}");
    let told = run.stderr.lines().filter(|line| line.contains("divided by")).count();
    assert!(
        told == 1 && run.stderr.contains(" and 1 more hold the emission of 'lamp'"),
        "{}",
        run.stderr
    );
}
