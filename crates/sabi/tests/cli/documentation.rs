//! Runs the commands and reads the files that the documentation shows, as a reader would.

#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use serde_json::Value as Json;

use crate::cli_folder::{CLOUDS, CliFolder, RunOutput, done, graph, software_adapter};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the blocks of code of a page, without their indent.
fn blocks(page: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"));
    let mut blocks = Vec::new();
    let mut block = String::new();
    for line in text.lines() {
        match line.strip_prefix("    ") {
            Some(code) => block.extend([code, "\n"]),
            // Blocks may contain empty lines.
            None if line.is_empty() && !block.is_empty() => block.push('\n'),
            None => blocks.push(std::mem::take(&mut block)),
        }
    }
    blocks.push(block);
    blocks.retain(|block| !block.trim().is_empty());
    blocks
}

/// Returns the only block of a page that contains these words.
fn block(page: &str, words: &str) -> String {
    let mut found = blocks(page);
    found.retain(|block| block.contains(words));
    assert_eq!(found.len(), 1, "blocks of {page} with {words}");
    found.remove(0)
}

/// Returns the shell lines on a page that run `sabi`, without comments.
fn commands(page: &str) -> Vec<String> {
    let blocks = blocks(page);
    let lines = blocks.iter().flat_map(|block| block.lines());
    let lines = lines.map(|line| line.split(" #").next().unwrap_or(line).trim().replace("$sabi", "sabi"));
    let runs = |line: &String| line.starts_with("sabi ") || line.contains("| sabi ");
    lines.filter(runs).collect()
}

/// A graph with the knobs, nodes and variants that the documentation names.
const GRAPH: &str = r##"{ "format": "sabi", "version": 1, "name": "Documented",
  "exposed": { "age": { "to": ["clouds.gain"], "range": [0, 1] }, "color": { "to": ["base.color"] } },
  "variants": { "desert": { "color": "#c2a878" } },
  "groups": { "patina": { "exposed": { "amount": { "to": ["layer.roughness"] } },
    "inputs": { "material": { "to": ["layer.base"] }, "mask": { "to": ["layer.mask"] } }, "outputs": { "material": "layer" },
    "nodes": { "layer": { "kind": "effect/layer" } } } },
  "nodes": {
    "base": { "kind": "source/material", "params": { "color": "#3c5a6e" } },
    "clouds": { "kind": "noise/simplex" },
    "rust": { "kind": "graph/group", "group": "patina", "inputs": { "material": "base", "mask": "clouds" } },
    "dirt": { "kind": "output/mask", "inputs": { "source": "clouds" }, "params": { "name": "dirt" } },
    "out": { "kind": "output/material", "inputs": { "material": "rust" } } } }
"##;

/// Returns a matrix of a few small items.
const MATRIX: &str = "version = 1\nout = \"export/$mesh/$graph(_$variant)_$seed\"\n[[bake]]\nmodels = \"model.glb\"\ngraphs = \"graph.sabi\"\n\
                      sizes = 32\nvariants = [\"\", \"desert\"]\nseed = [1, 2, 3, 4]\n";

/// Creates a folder with the files that the documentation names.
fn place() -> CliFolder {
    let place = CliFolder::new();
    for folder in ["graphs/examples", "assets/meshes", "bake"] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    for model in ["model.glb", "my-model.glb", "helmet.glb", "assets/meshes/crate.glb"] {
        place.write(model, place.read("cube.glb"));
    }
    for name in [
        "graph.sabi",
        "graphs/examples/army-paint.sabi",
        "graphs/examples/bronze-statue.sabi",
    ] {
        place.write(name, GRAPH);
    }
    place.write("matrix.toml", MATRIX);
    place.write("look.toml", block("docs/command-line.md", "variant = \"desert\""));
    place.write("studio.toml", block("docs/presets.md", "name = \"studio\""));
    place
}

/// Runs a shell line, with the program in the path.
fn shell(place: &CliFolder, line: &str) -> RunOutput {
    software_adapter();
    let program = Path::new(env!("CARGO_BIN_EXE_sabi"));
    let folders = env::var_os("PATH").unwrap_or_default();
    let folders = program
        .parent()
        .map(Path::to_owned)
        .into_iter()
        .chain(env::split_paths(&folders));
    // Used only for its environment variables, which are those of all tests.
    let template = place.command(&[]);
    let mut command = Command::new("sh");
    command.args(["-c", line]).current_dir(place.path("."));
    for (name, value) in template.get_envs() {
        match value {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    command
        .env("PATH", env::join_paths(folders).unwrap())
        .env("GALLIVM_PERF", "nopt");
    done(command.output().unwrap())
}

/// Returns the same command for small maps and pictures, on the software adapter, so that the test is fast.
fn smaller(line: &str) -> String {
    let mut line = line.to_owned();
    for (large, small) in [
        ("--size 2048", "--size 32"),
        ("--size 1920x1080", "--size 48x32"),
        ("--turntable 48", "--turntable 2"),
        ("--node NODE", "--node clouds"),
        // The plan in the folder has only eight items.
        ("--items 0-99", "--items 0-3"),
        ("--items 100-199", "--items 4-7"),
    ] {
        line = line.replace(large, small);
    }
    for (command, options) in [
        ("sabi bake ", &[("--adapter", "cpu"), ("--size", "32")][..]),
        ("sabi preview ", &[("--adapter", "cpu"), ("--size", "32")]),
        (
            "sabi render ",
            &[("--adapter", "cpu"), ("--size", "48x32"), ("--texels", "32")],
        ),
        ("sabi run ", &[("--adapter", "cpu")]),
    ] {
        for (option, value) in options {
            if line.contains(command) && !line.contains(option) {
                line = line.replace(command, &format!("{command}{option} {value} "));
            }
        }
    }
    line
}

/// Returns true for a line that needs a window, or a program that may not be installed.
fn needs_more(line: &str) -> bool {
    let word = line.split_whitespace().nth(1).unwrap_or_default();
    word.is_empty() || Path::new(word).extension().is_some() || line.starts_with("jq ")
}

/// Runs the commands of a page in their order.
fn runs(page: &str, least: usize) {
    let place = place();
    if page == "docs/build-server.md" {
        let matrix = ["model.glb", "graph.sabi", "export/"]
            .into_iter()
            .fold(MATRIX.to_owned(), |matrix, path| {
                matrix.replace(&format!("\"{path}"), &format!("\"../{path}"))
            });
        place.write("bake/matrix.toml", matrix);
        place.write("graphs/graph.sabi", GRAPH);
    }
    let mut count = 0;
    for line in commands(page) {
        if needs_more(&line) {
            continue;
        }
        let run = shell(&place, &smaller(&line));
        assert_eq!(run.code, Some(0), "{page}: {line}\n{}\n{}", run.stdout, run.stderr);
        count += 1;
    }
    assert!(count >= least, "{page} has {count} commands that can be run");
}

#[test]
fn the_commands_of_the_first_pages_do_what_they_say() {
    runs("README.md", 5);
    runs("docs/command-line.md", 11);
    runs("docs/rendering.md", 4);
}

#[test]
fn the_commands_for_many_bakes_do_what_they_say() {
    runs("docs/batch.md", 4);
    runs("docs/build-server.md", 5);
}

#[test]
fn the_commands_about_presets_documents_and_farms_do_what_they_say() {
    runs("docs/presets.md", 6);
    runs("docs/documents.md", 2);
    runs("docs/open-job-description.md", 1);
    runs("docs/slurm.md", 1);
}

/// Creates a project folder whose models have the names of a matrix in the documentation.
fn project(models: &[(&str, &str)]) -> CliFolder {
    let place = CliFolder::new();
    place.write("sabi.toml", "");
    for folder in ["meshes", "graphs", "bake"] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    for (name, own) in models {
        let own = root().join("assets/meshes").join(own);
        fs::copy(own, place.path("meshes").join(name)).unwrap();
    }
    place
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => copy_folder(&entry.path(), &target),
            false => drop(fs::copy(entry.path(), target).unwrap()),
        }
    }
}

#[test]
fn the_matrix_of_the_page_about_many_bakes_gives_the_items_that_it_describes() {
    let models = [
        ("crate.glb", "cube.glb"),
        ("barrel_1.glb", "cube.glb"),
        ("barrel_big.glb", "cube.glb"),
        ("owl.glb", "cube.glb"),
    ];
    let place = project(&models);
    copy_folder(&root().join("graphs/library"), &place.path("library"));
    fs::copy(
        root().join("graphs/examples/army-paint.sabi"),
        place.path("graphs/army-paint.sabi"),
    )
    .unwrap();
    place.write("matrix.toml", block("docs/batch.md", "[[bake]]"));
    let run = place.sabi(&["plan", "matrix.toml"]).good();
    // Three models with two variants in two sizes, except one model in one size only; and one model in two variants.
    assert_eq!(run.stderr, "Planned 12 items of matrix.toml in plan.jsonl\n");
    let plan = String::from_utf8(place.read("plan.jsonl")).unwrap();
    let items: Vec<Json> = plan.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let out: Vec<&str> = items.iter().filter_map(|item| item["out"].as_str()).collect();
    assert!(out.contains(&"export/crate/army-paint_desert/2048"), "{out:?}");
    assert!(out.contains(&"export/owl/army-paint_red/4096"), "{out:?}");
    assert!(
        !out.iter()
            .any(|out| out.contains("barrel_big") && out.ends_with("1024")),
        "{out:?}"
    );
}

#[test]
fn the_script_of_a_build_server_bakes_graphs_with_and_without_variants() {
    let place = project(&[("cube.glb", "cube.glb")]);
    place.write("graphs/clouds.sabi", graph(CLOUDS));
    place.write(
        "graphs/plain.sabi",
        format!("{{ \"format\": \"sabi\", \"version\": 1, \"nodes\": {{ {CLOUDS} }} }}"),
    );
    let matrix = block("docs/build-server.md", "[[bake]]");
    place.write("bake/matrix.toml", format!("{matrix}\nsizes = 32\n"));
    let script = block("docs/build-server.md", "set -eu");
    shell(&place, &script).good();
    let summary: Json = serde_json::from_slice(&place.read("bake/summary.json")).unwrap();
    assert_eq!(summary["items"].as_array().map(Vec::len), Some(3), "{summary}");
    for folder in ["cube/clouds", "cube/clouds_heavy", "cube/plain"] {
        let maps = place.listing(&format!("export/{folder}"));
        assert!(maps.iter().any(|map| map.starts_with("T_")), "{folder}: {maps:?}");
    }
}

#[test]
fn the_graph_that_the_page_of_the_format_shows_is_one() {
    let place = CliFolder::new();
    place.write("worn.sabi", block("docs/graph-file.md", "\"format\": \"sabi\""));
    let run = place.sabi(&["check", "--strict", "worn.sabi"]).good();
    assert!(run.stdout.starts_with("worn.sabi: good, 2 nodes in "), "{run:?}");
}
