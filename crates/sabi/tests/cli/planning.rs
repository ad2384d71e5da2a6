//! `sabi plan`: matrices, and the plans that are made from them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::{Value as Json, json};

use crate::cli_folder::{CLOUDS, CliFolder, graph};

/// Returns a matrix with these keys in its only table.
fn matrix(row: &str) -> String {
    format!("version = 1\nout = \"out/$mesh/$graph(_$variant)(_$seed)/$size-$preset\"\n[[bake]]\n{row}\n")
}

/// Creates a folder with a matrix of this table.
fn place_with(row: &str) -> CliFolder {
    let place = CliFolder::new();
    place.write("matrix.toml", matrix(row));
    place
}

/// Plans the matrix and returns the items of the plan.
pub(crate) fn planned(place: &CliFolder) -> Vec<Json> {
    place.sabi(&["plan", "matrix.toml"]).good();
    items(&String::from_utf8(place.read("plan.jsonl")).unwrap())
}

fn items(lines: &str) -> Vec<Json> {
    lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn keys(items: &[Json]) -> Vec<&str> {
    items.iter().map(|item| item["key"].as_str().unwrap()).collect()
}

#[test]
fn a_matrix_becomes_a_line_for_each_combination() {
    let place = place_with(
        "models = [\"*.glb\"]\ngraphs = \"clouds.sabi\"\nvariants = [\"\", \"heavy\", { name = \"bright\", variant = \"heavy\", set = { look \
         = \"billow\" } }]\nsizes = [32, 64]\npresets = [\"raw\", [\"gltf\", \"unreal\"]]\nset = { amount = 0.25 }\nup = \"z\"\nexclude = \
         [{ model = \"sphere\", preset = \"gltf\" }, { size = 64, variant = \"bright\" }]",
    );
    let run = place.sabi(&["plan", "matrix.toml"]).good();
    assert_eq!(run.stdout, "plan.jsonl\n");
    assert_eq!(run.stderr, "Planned 15 items of matrix.toml in plan.jsonl\n");
    let items = planned(&place);
    let out: Vec<&str> = items.iter().map(|item| item["out"].as_str().unwrap()).collect();
    assert_eq!(
        out[..5],
        [
            "out/cube/clouds/32-raw",
            "out/cube/clouds/32-gltf-unreal",
            "out/cube/clouds/64-raw",
            "out/cube/clouds/64-gltf-unreal",
            "out/cube/clouds_heavy/32-raw"
        ]
    );
    assert_eq!(out.iter().filter(|out| out.contains("sphere")).count(), 5);
    assert!(!out.iter().any(|out| out.contains("bright/64")), "{out:?}");
    let bright = items
        .iter()
        .find(|item| item["out"] == "out/cube/clouds_bright/32-raw")
        .unwrap();
    assert_eq!(bright["item"], 8);
    let recipe = &bright["recipe"];
    assert_eq!(recipe["variant"], "heavy");
    let set = json!([{ "name": "amount", "value": 0.25 }, { "name": "look", "value": "billow" }]);
    assert_eq!(recipe["set"], set);
    assert_eq!((&recipe["size"], &recipe["presets"]), (&json!(32), &json!(["raw"])));
    let files = (&recipe["graph"], &recipe["model"]["file"], &recipe["model"]["up"]);
    assert_eq!(files, (&json!("clouds.sabi"), &json!("cube.glb"), &json!("z")));
    let names: Vec<&Json> = bright["inputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|input| &input["name"])
        .collect();
    assert_eq!(names, ["clouds.sabi", "mesh/cube.glb"]);
    assert_eq!(keys(&items).into_iter().collect::<BTreeSet<_>>().len(), items.len());
}

#[test]
fn a_seed_per_model_stays_when_models_are_added() {
    let place = place_with("models = [\"sphere.glb\"]\ngraphs = \"clouds.sabi\"\nseed = [\"per model\", 7]");
    let seeds = |place: &CliFolder| -> Vec<Json> {
        planned(place)
            .iter()
            .map(|item| item["recipe"]["seed"].clone())
            .collect()
    };
    let before = seeds(&place);
    assert_eq!(before[1], 7);
    place.write(
        "matrix.toml",
        matrix("models = [\"*.glb\"]\ngraphs = \"clouds.sabi\"\nseed = [\"per model\", 7]"),
    );
    let after = seeds(&place);
    assert_eq!((&after[2..], after[0] == after[2]), (&before[..], false));
}

#[test]
fn values_of_files_yield_to_the_matrix() {
    let place =
        place_with("models = \"cube.glb\"\ngraphs = \"clouds.sabi\"\nset_file = \"look.toml\"\nset = { amount = 0.5 }");
    place.write(
        "look.toml",
        "variant = \"heavy\"\nseed = 3\n[set]\namount = 0.1\nclouds.octaves = 2\n",
    );
    let [item] = &planned(&place)[..] else {
        panic!("one item")
    };
    let recipe = &item["recipe"];
    assert_eq!((&recipe["variant"], &recipe["seed"]), (&json!("heavy"), &json!(3)));
    let set = json!([{ "name": "clouds.octaves", "value": 2 }, { "name": "amount", "value": 0.5 }]);
    assert_eq!(recipe["set"], set);
}

#[test]
fn keys_follow_contents_and_not_places() {
    let place =
        place_with("models = \"*.glb\"\ngraphs = [\"clouds.sabi\", \"rust.sabi\"]\npresets = [\"raw\", \"own.toml\"]");
    let preset =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/presets/raw.toml")).unwrap();
    place.write("own.toml", &preset);
    let before = planned(&place);
    fs::create_dir(place.path("build")).unwrap();
    place.sabi(&["plan", "matrix.toml", "-o", "build/p.jsonl"]).good();
    let elsewhere = items(&String::from_utf8(place.read("build/p.jsonl")).unwrap());
    assert_eq!(keys(&elsewhere), keys(&before));
    assert_eq!(elsewhere[0]["recipe"]["graph"], "../clouds.sabi");
    assert_eq!(elsewhere[1]["recipe"]["presets"], json!(["../own.toml"]));
    place.write("clouds.sabi", graph(CLOUDS).replace("0.9", "0.8"));
    place.write("own.toml", preset.replace("raw", "own"));
    let after = planned(&place);
    for (before, after) in before.iter().zip(&after) {
        let is_same = before["recipe"]["graph"] == "rust.sabi" && before["recipe"]["presets"] == json!(["raw"]);
        assert_eq!(before["key"] == after["key"], is_same, "{before}");
    }
    let printed = items(&place.sabi(&["plan", "matrix.toml", "-o", "-"]).good().stdout);
    assert_eq!(printed, after);
}

/// Tables, in which `{}` is replaced by a valid beginning, with the exit code and the reason why each is refused.
const REFUSED: [(&str, i32, &str); 13] = [
    (
        "models = \"gone.glb\"\ngraphs = \"clouds.sabi\"",
        66,
        "gone.glb: there is no such file; check the path",
    ),
    (
        "models = \"cube.glb\"\ngraphs = \"gone.sabi\"",
        66,
        "gone.sabi: there is no such file; check the path",
    ),
    (
        "models = \"x*.glb\"\ngraphs = \"clouds.sabi\"",
        65,
        "matrix.toml: bake 1: no file fits 'x*.glb'",
    ),
    (
        "{}set = { amout = 1 }",
        65,
        "clouds.sabi: nothing is called \"amout\" (did you mean \"amount\"?); set an exposed knob (\"amount\", \"look\") or a \
                   node's parameter as node.param",
    ),
    (
        "{}variants = \"havy\"",
        65,
        "clouds.sabi: there is no variant \"havy\" (did you mean \"heavy\"?); this graph has \"heavy\"",
    ),
    (
        "{}variants = \"x*\"",
        65,
        "matrix.toml: bake 1: none of its graphs has a variant that fits 'x*'",
    ),
    (
        "{}presets = \"unrael\"",
        65,
        "there is no preset 'unrael'; there is: raw, gltf, unreal, unity, godot, blender, materialx, usd, mesh, or give the path of a \
             .toml file",
    ),
    (
        "{}presets = \"own.toml\"",
        66,
        "the preset own.toml does not exist; check the path",
    ),
    (
        "{}set_file = \"gone.toml\"",
        66,
        "gone.toml: there is no such file; check the path",
    ),
    (
        "{}out = \"$mesh\"\nsizes = [64, 128]",
        65,
        "matrix.toml: clouds.sabi on cube.glb, 64 as raw and clouds.sabi on cube.glb, 128 as raw would both write into cube; tell \
             them apart in 'out', with $mesh, $graph, $variant, $seed, $size, $preset or $name",
    ),
    (
        "{}out = \"$mesch\"",
        65,
        "matrix.toml: bake 1: folders cannot be named '$mesch': nobody knows $mesch; there is: $name, $mesh, $graph, $variant, \
             $seed, $size, $preset",
    ),
    (
        "{}presets = [[\"raw\", \"gltf\"]]",
        65,
        "two maps would be written to material_normal.png and material_Normal.png, which are one file on systems that ignore \
             capital letters; rename the material or the output that one of them belongs to, or name maps with $material and $preset",
    ),
    (
        "{}exclude = [{ size = 1024 }]",
        65,
        "matrix.toml: 'exclude' leaves nothing to bake",
    ),
];

#[test]
fn what_could_not_be_baked_is_refused_before_a_plan_is_written() {
    let good = "models = \"cube.glb\"\ngraphs = \"clouds.sabi\"\n";
    for (row, code, words) in REFUSED {
        let place = place_with(&row.replace("{}", good));
        let run = place.sabi(&["plan", "matrix.toml"]).fails(code);
        assert_eq!(run.stderr, format!("error: {words}\n"), "{row}");
        assert_eq!(run.stdout, "");
        assert!(!place.path("plan.jsonl").exists());
    }
}

#[test]
fn too_many_items_are_refused_unless_they_are_meant() {
    let row = "models = \"*.glb\"\ngraphs = \"clouds.sabi\"\nsizes = [16, 32, 64]";
    let place = CliFolder::new();
    place.write("matrix.toml", format!("limit = 5\n{}", matrix(row)));
    let run = place.sabi(&["plan", "matrix.toml"]).fails(65);
    assert_eq!(
        run.stderr,
        "error: matrix.toml: the matrix gives 6 items or more, and its limit is 5; if that is meant, raise 'limit'\n"
    );
    place.write("matrix.toml", format!("limit = 6\n{}", matrix(row)));
    assert_eq!(planned(&place).len(), 6);
}

#[test]
fn very_many_values_are_refused_before_their_graph_is_searched_for_them() {
    let values: Vec<String> = (0..20_000).map(|at| format!("a{at} = 1")).collect();
    let place = place_with(&format!(
        "models = \"cube.glb\"\ngraphs = \"clouds.sabi\"\n[bake.set]\n{}",
        values.join("\n")
    ));
    let run = place.sabi(&["plan", "matrix.toml"]).fails(65);
    let why = "matrix.toml: bake 1: an item would set 20000 values, and all items 20000 or more; an item may set 10000";
    assert!(run.stderr.contains(why), "{}", run.stderr);
    assert!(!place.path("plan.jsonl").exists());
}

#[test]
fn an_entry_that_leaves_nothing_out_is_told() {
    let place = place_with("models = \"cube.glb\"\ngraphs = \"clouds.sabi\"\nexclude = [{ size = 99 }]");
    let run = place.sabi(&["plan", "matrix.toml"]).good();
    let words = "warning: matrix.toml: 1 entry of 'exclude' of bake 1 leaves nothing out\n";
    assert!(run.stderr.starts_with(words), "{}", run.stderr);
}

#[test]
fn a_plan_is_printed_for_the_engine_that_runs_it() {
    let place = place_with("models = \"*.glb\"\ngraphs = \"clouds.sabi\"\nsizes = [16, 32]");
    let print = |format: &str, file: &str| {
        place
            .sabi(&["plan", "matrix.toml", "--format", format, "-o", file])
            .good()
            .stdout
    };
    assert_eq!(
        print("commands", "a plan.jsonl"),
        "sabi run 'a plan.jsonl' --items 0\nsabi run 'a plan.jsonl' --items 1\nsabi run 'a plan.jsonl' --items 2\nsabi run 'a plan.jsonl' \
         --items 3\n"
    );
    let script = print("slurm", "plan.jsonl");
    assert!(
        script.starts_with("#!/bin/bash\n#SBATCH --job-name=plan\n#SBATCH --array=0-3\n"),
        "{script}"
    );
    let last = "exec \"${SABI:-sabi}\" run plan.jsonl --items \"$items\"\n";
    assert!(script.ends_with(last), "{script}");
    let template = print("openjd", "plan.jsonl");
    for line in [
        "name: \"sabi plan\"",
        "    default: \"plan.jsonl\"",
        "    default: \"0-3\"",
        "          range: \"{{Param.Items}}\"",
    ] {
        assert!(template.lines().any(|written| written == line), "{line}: {template}");
    }
    let refused = place
        .sabi(&["plan", "matrix.toml", "--format", "slurm", "-o", "-"])
        .fails(2);
    assert_eq!(
        refused.stderr,
        "error: what is printed runs a plan in a file, but -o - writes none; name a file\n"
    );
}

#[test]
fn only_a_plan_is_replaced() {
    let place = place_with("models = \"cube.glb\"\ngraphs = \"clouds.sabi\"");
    let before = place.read("matrix.toml");
    let refused = place.sabi(&["plan", "matrix.toml", "-o", "matrix.toml"]).fails(73);
    assert_eq!(
        refused.stderr,
        "error: cannot write the plan matrix.toml: there is a file that is no plan; name another file\n"
    );
    assert!(place.read("matrix.toml") == before);
    assert_eq!(planned(&place), planned(&place), "a plan is replaced by the next");
    let nowhere = place.sabi(&["plan", "matrix.toml", "-o", "none/plan.jsonl"]).fails(73);
    assert_eq!(
        nowhere.stderr,
        "error: there is no folder none; make it, or name another file\n"
    );
    let folder = place.sabi(&["plan", "matrix.toml", "-o", "."]).fails(73);
    assert_eq!(
        folder.stderr,
        "error: cannot write the plan .: it is no ordinary file; name another file\n"
    );
}
