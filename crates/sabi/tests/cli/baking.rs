//! Files and messages of a bake.

use serde_json::Value as Json;

use crate::cli_folder::{CliFolder, graph};

const MAPS: [&str; 5] = [
    "cube_base_color.png",
    "cube_height.exr",
    "cube_height.png",
    "cube_normal.png",
    "cube_roughness.png",
];

fn json(text: &[u8]) -> Json {
    serde_json::from_slice(text).unwrap()
}

#[test]
fn a_bake_writes_the_maps_and_prints_their_paths() {
    let place = CliFolder::new();
    let run = place.bake("rust.sabi", "cube.glb", &[]).good();
    let mut paths: Vec<&str> = run.stdout.lines().collect();
    paths.sort_unstable();
    assert_eq!(paths, MAPS.map(|map| format!("out/{map}")));
    assert_eq!(place.listing("out"), MAPS);
    assert!(
        run.stderr
            .starts_with("Baked rust.sabi on cube.glb at 64 × 64: 5 maps in out, in "),
        "{}",
        run.stderr
    );
    for stage in ["load ", "atlas ", "compile ", "run ", "encode "] {
        assert!(run.stderr.contains(stage), "{}", run.stderr);
    }
    assert!(
        !run.stderr.contains('\u{1b}'),
        "no bars and no colors where nobody sees them"
    );
}

#[test]
fn two_bakes_give_the_same_bytes() {
    let place = CliFolder::new();
    place.bake("rust.sabi", "sphere.glb", &["-o", "one"]).good();
    place
        .bake("rust.sabi", "sphere.glb", &["-o", "two", "--no-cache"])
        .good();
    assert_eq!(place.listing("one"), place.listing("two"));
    for map in place.listing("one") {
        assert!(
            place.read(&format!("one/{map}")) == place.read(&format!("two/{map}")),
            "{map}"
        );
    }
}

#[test]
fn the_report_file_and_json_say_the_same() {
    let place = CliFolder::new();
    let run = place.bake(
        "rust.sabi",
        "cube.glb",
        &["--json", "--report", "out/report.json", "-q"],
    );
    let run = run.good();
    assert_eq!(run.stderr, "");
    let [mut report, mut file] = [run.stdout.into_bytes(), place.read("out/report.json")].map(|text| json(&text));
    let [recipe, file_recipe] = [&mut report, &mut file].map(|report| report["recipe"].take());
    let [inputs, file_inputs] = [&mut report, &mut file].map(|report| report["inputs"].take());
    assert_eq!(report, file, "but for paths");
    assert_eq!(file_recipe["graph"], "../rust.sabi");
    assert_eq!(
        [&file_inputs[0]["path"], &file_inputs[1]["path"]],
        ["../cube.glb", "../rust.sabi"]
    );
    let graph = recipe["graph"].as_str().unwrap();
    assert!(std::path::Path::new(graph).is_absolute(), "{graph}");
    assert_eq!(inputs[1]["path"], graph);
    assert_eq!(report["graph"], "rust.sabi");
    assert_eq!(report["mesh"]["triangles"], 12);
    assert_eq!(report["adapter"]["kind"], "cpu");
    let outputs = report["outputs"].as_array().unwrap();
    assert_eq!(outputs.len(), MAPS.len());
    let constants = report["constants"].as_array().unwrap();
    assert!(
        constants.iter().any(|constant| constant["channel"] == "metallic"),
        "{constants:?}"
    );
    let printed = place.bake("rust.sabi", "cube.glb", &["--report", "-"]).good();
    assert_eq!(json(printed.stdout.as_bytes())["outputs"], report["outputs"]);
    assert_eq!(place.listing("out").len(), MAPS.len() + 1);
}

#[test]
fn a_constant_channel_gets_a_map_on_request() {
    let place = CliFolder::new();
    place.bake("rust.sabi", "cube.glb", &["--all-maps"]).good();
    for channel in ["opacity", "metallic", "occlusion", "emission"] {
        place.read(&format!("out/cube_{channel}.png"));
    }
}

#[test]
fn fused_and_unfused_bakes_write_the_same_files() {
    let place = CliFolder::new();
    let report = |more: &[&str]| json(place.bake("rust.sabi", "cube.glb", more).good().stdout.as_bytes());
    let (fused, apart) = (report(&["--json"]), report(&["--json", "--no-fuse"]));
    assert!(fused["passes"].as_u64() < apart["passes"].as_u64());
    let paths = |report: &Json| -> Vec<Json> {
        let outputs = report["outputs"].as_array().unwrap();
        outputs.iter().map(|output| output["path"].clone()).collect()
    };
    assert_eq!(paths(&fused), paths(&apart));
}

#[test]
fn an_earlier_bake_is_replaced_and_what_else_is_there_stays() {
    let place = CliFolder::new();
    place.bake("rust.sabi", "cube.glb", &[]).good();
    let before = place.read("out/cube_base_color.png");
    place.write("out/notes.txt", "mine");
    place
        .bake("rust.sabi", "cube.glb", &["--set", "base.color=#ff0000"])
        .good();
    assert_ne!(place.read("out/cube_base_color.png"), before);
    assert_eq!(place.read("out/notes.txt"), b"mine");
}

#[test]
fn seams_of_heights_and_normals_are_erased_unless_they_are_to_be_kept() {
    let place = CliFolder::new();
    let maps = |more: &[&str]| {
        place.bake("rust.sabi", "sphere.glb", more).good();
        ["height.exr", "normal.png", "base_color.png", "roughness.png"]
            .map(|channel| place.read(&format!("out/sphere_{channel}")))
    };
    let (plain, erased, kept) = (maps(&[]), maps(&["--seams", "erase"]), maps(&["--seams", "keep"]));
    assert!(plain == erased);
    let differs: Vec<bool> = plain.iter().zip(&kept).map(|(one, other)| one != other).collect();
    assert_eq!(differs, [true, true, false, false]);
}

#[test]
fn how_a_model_is_taken_changes_the_maps() {
    let place = CliFolder::new();
    let map = |more: &[&str]| {
        place.bake("clouds.sabi", "cube.glb", more).good();
        let map = place.read("out/cube_mask.png");
        // A constant mask has no map, and an earlier map must not be used as its map.
        std::fs::remove_file(place.path("out/cube_mask.png")).unwrap();
        map
    };
    let plain = map(&[]);
    for more in [["--up", "z"], ["--padding", "infinite"]] {
        assert!(map(&more) != plain, "{more:?}");
    }
    assert!(
        map(&["--scale", "3"]) == plain,
        "the largest side counts as 1, however large it is"
    );
    // The cube's side is 1. With a fit of 2 it counts as 0.5, so clouds are twice as large on it.
    let larger = map(&["--set", "clouds.size=0.5"]);
    assert!(larger != plain);
    assert!(map(&["--fit", "2"]) == larger);
    assert!(map(&["--fit", "metres", "--scale", "0.5"]) == larger);
    assert!(map(&["--fit", "metres"]) == plain);
}

/// Raised from 0 to 0.01 along the cube.
const RAMP: &str = r##"    "base": { "kind": "source/material" },
    "clouds": { "kind": "surface/position", "params": { "along": [0, 1, 0] } },
    "out": { "kind": "output/material", "inputs": { "material": "raised" } },
    "raised": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" }, "params": { "height": 0.01 } }"##;

#[test]
fn heights_are_in_the_units_of_the_models_file_under_the_fit() {
    let place = CliFolder::new();
    place.write("ramp.sabi", graph(RAMP));
    let span = |more: &[&str]| {
        let run = place
            .bake("ramp.sabi", "cube.glb", &[more, &["--json"]].concat())
            .good();
        let report = json(run.stdout.as_bytes());
        let outputs = report["outputs"].as_array().unwrap();
        let range = outputs.iter().find_map(|output| output["range"].as_array()).unwrap();
        range[1].as_f64().unwrap() - range[0].as_f64().unwrap()
    };
    let one = span(&["--fit", "1"]);
    assert!((0.009..=0.01).contains(&one), "{one}");
    let cases: [(&[&str], f64); 6] = [
        (&["--fit", "2"], 2.0),
        (&["--fit", "0.25"], 0.25),
        (&["--fit", "metres"], 1.0),
        // The model is scaled by two, so a length on it is half as long in the file.
        (&["--fit", "1", "--scale", "2"], 0.5),
        (&["--fit", "metres", "--scale", "4"], 0.25),
        (&["--fit", "unit", "--scale", "3"], span(&["--fit", "unit"]) / one),
    ];
    for (more, factor) in cases {
        let ratio = span(more) / one;
        assert!(
            (ratio / factor - 1.0).abs() < 1e-4,
            "{more:?}: {ratio} instead of {factor}"
        );
    }
}

#[test]
fn only_the_material_asked_for_is_baked() {
    let place = CliFolder::new();
    place.refuses(
        "clouds.sabi",
        "cube.glb",
        &["--material", "wood"],
        2,
        "the model has no material 'wood'; it has cube",
    );
    place.bake("clouds.sabi", "cube.glb", &["--material", "cube"]).good();
}

#[test]
fn a_node_file_beside_the_graph_is_a_kind_of_its_own() {
    let place = CliFolder::new();
    std::fs::create_dir_all(place.path("nodes/own")).unwrap();
    place.write(
        "nodes/own/half.wgsl",
        "//! Half\n//! Half of a mask.\n\n/// Half of it.\n/// @input source What to halve.\nfn mask(source: f32) -> f32 \
         {\n    return 0.5 * source;\n}\n",
    );
    let nodes = r#"    "clouds": { "kind": "noise/simplex" },
    "half": { "kind": "own/half", "inputs": { "source": "clouds" } },
    "out": { "kind": "output/mask", "inputs": { "source": "half" } }"#;
    place.write("own.sabi", graph(nodes));
    let run = place.bake("own.sabi", "cube.glb", &[]).good();
    assert!(!run.stderr.contains("warning"), "{}", run.stderr);
    let listed = place.sabi(&["nodes", "--graph", "own.sabi"]).good().stdout;
    assert!(listed.contains("\nown/half "), "{listed}");
}
