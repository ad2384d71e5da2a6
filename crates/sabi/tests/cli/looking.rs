//! The commands that write no file, and `preview`.

use serde_json::Value as Json;

use crate::cli_folder::{CLOUDS, CliFolder, graph, software_adapter};

fn json(text: &str) -> Json {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn nodes_are_listed_one_a_line_and_described_by_id() {
    let place = CliFolder::new();
    let table = place.sabi(&["nodes"]).good().stdout;
    let all = json(&place.sabi(&["nodes", "--json"]).good().stdout);
    let all = all.as_array().unwrap();
    assert_eq!(table.lines().count(), all.len());
    for (at, (line, node)) in table.lines().zip(all).enumerate() {
        let id = node["id"].as_str().unwrap();
        assert_eq!(line.split_whitespace().next(), Some(id));
        // The pages of all nodes are tested beside the code that writes them: a process for each page would take long.
        if at % 16 != 0 {
            continue;
        }
        let page = place.sabi(&["nodes", id]).good();
        assert!(page.stdout.starts_with(&format!("{id}\n")) && page.stderr.is_empty());
        assert_eq!(json(&place.sabi(&["nodes", id, "--json"]).good().stdout), *node);
    }
    let curve = place.sabi(&["nodes", "adjust/curve"]).good().stdout;
    assert!(
        curve.contains("[curve from -10 to 10, default [0, 0], [1, 1]]"),
        "{curve}"
    );
    let unknown = place.sabi(&["nodes", "noise/simplx"]).fails(2);
    assert_eq!(
        unknown.stderr,
        "error: there is no kind of node 'noise/simplx'; did you mean 'noise/simplex'?\n"
    );
}

#[test]
fn a_model_is_described() {
    let place = CliFolder::new();
    let run = place.sabi(&["mesh", "cube.glb", "--size", "64", "--json"]).good();
    let mesh = json(&run.stdout);
    assert_eq!((&mesh["triangles"], &mesh["charts"]), (&Json::from(12), &Json::from(6)));
    assert_eq!(mesh["vertex_colors"], false);
    let coverage = mesh["coverage"].as_f64().unwrap();
    assert!(coverage > 0.0);
    assert_eq!(
        mesh["coverage"].to_string(),
        (coverage as f32).to_string(),
        "no digits that a 32-bit float has not"
    );
    let table = place.sabi(&["mesh", "cube.glb", "--size", "64"]).good().stdout;
    assert!(table.starts_with("triangles                12\n"), "{table}");
    let missing = place.sabi(&["mesh", "none.glb"]).fails(66);
    assert_eq!(
        missing.stderr,
        "error: none.glb: there is no such file; check the path\n"
    );
}

#[test]
fn all_graphs_are_checked_whatever_is_wrong_with_the_first() {
    let place = CliFolder::new();
    let faulty = CLOUDS.replace("simplex", "simplx");
    place.write("faulty.sabi", graph(&faulty));
    place.write("cut.sabi", &graph(CLOUDS)[..90]);
    let run = place
        .sabi(&["check", "faulty.sabi", "clouds.sabi", "cut.sabi"])
        .fails(65);
    assert_eq!(
        run.stdout,
        "faulty.sabi: 1 error\nclouds.sabi: good, 2 nodes in 1 pass\ncut.sabi: 1 error\n"
    );
    let problems: Vec<&str> = run.stderr.lines().collect();
    assert_eq!(problems.len(), 2, "{}", run.stderr);
    assert!(problems[0].starts_with("faulty.sabi:8:5: node 'clouds' is of kind 'noise/simplx'"));
    assert!(problems[1].starts_with("cut.sabi:5:"), "{}", problems[1]);
    let run = place.sabi(&["check", "faulty.sabi", "clouds.sabi", "--json"]).fails(65);
    let found = json(&run.stdout);
    assert_eq!(found[0]["good"], false);
    assert_eq!(found[1]["good"], true);
    assert!(
        found[0]["errors"][0]
            .as_str()
            .unwrap()
            .contains("did you mean 'noise/simplex'?")
    );
    place.sabi(&["check", "clouds.sabi", "rust.sabi"]).good();
    place.sabi(&["check", "none.sabi", "clouds.sabi"]).fails(66);
}

#[test]
fn doctor_tells_how_to_get_an_adapter_where_there_is_none() {
    let place = CliFolder::new();
    software_adapter();
    let found = json(&place.sabi(&["doctor", "--json"]).good().stdout);
    assert_eq!(found["usable"], true);
    assert!(place.sabi(&["doctor"]).good().stdout.contains("\nadapter   "));
    if !cfg!(target_os = "linux") {
        return;
    }
    let without = |arguments: &[&str]| {
        let mut command = place.command(arguments);
        let nowhere = place.path("no_driver.json");
        command
            .env("VK_DRIVER_FILES", &nowhere)
            .env("VK_ICD_FILENAMES", &nowhere);
        crate::cli_folder::done(command.output().unwrap()).fails(4)
    };
    let advice = "error: no Vulkan, Metal or Direct3D 12 driver was found; on Debian or Ubuntu run `apt-get install \
                  mesa-vulkan-drivers libvulkan1`, which works without a graphics card\n";
    assert_eq!(without(&["doctor"]).stderr, advice);
    assert_eq!(json(&without(&["doctor", "--json"]).stdout)["usable"], false);
    let bake = without(&["bake", "clouds.sabi", "--mesh", "cube.glb", "-o", "out", "--size", "64"]);
    assert_eq!(bake.stderr, advice);
    assert!(!place.path("out").exists());
}

#[test]
fn any_result_can_be_looked_at() {
    let place = CliFolder::new();
    software_adapter();
    let preview = |node: &str, file: &str| {
        place.sabi(&[
            "preview",
            "rust.sabi",
            "--mesh",
            "cube.glb",
            "--size",
            "64",
            "--adapter",
            "cpu",
            "--node",
            node,
            "-o",
            file,
        ])
    };
    for (node, file, magic) in [
        ("clouds", "mask.png", &b"\x89PNG"[..]),
        ("clouds.mask", "mask.exr", b"\x76\x2f\x31\x01"),
        ("rust", "rust.png", b"\x89PNG"),
        ("rust", "rust.exr", b"\x76\x2f\x31\x01"),
    ] {
        let run = preview(node, file).good();
        assert_eq!(run.stdout, format!("{file}\n"));
        assert!(place.read(file).starts_with(magic), "{file}");
    }
    let cases = [
        (
            "cluds",
            "a.png",
            2,
            "the graph has no node 'cluds'; did you mean 'clouds'?",
        ),
        (
            "clouds.mesk",
            "a.png",
            2,
            "rust.sabi:9:5: node 'clouds' (noise/simplex) has no result 'mesk'; it gives mask",
        ),
        (
            "clouds",
            "a.jpg",
            2,
            "a.jpg: a preview is a .png or, for exact values, an .exr",
        ),
        (
            "clouds",
            "clouds.sabi/a.png",
            73,
            "cannot create the folder clouds.sabi: a file of that name is in the way; choose another folder with -o",
        ),
    ];
    for (node, file, code, words) in cases {
        let run = preview(node, file).fails(code);
        assert_eq!((run.stdout.as_str(), run.stderr), ("", format!("error: {words}\n")));
    }
}

#[test]
fn a_muted_node_that_passes_nothing_on_is_told_before_the_model_is_looked_at() {
    let place = CliFolder::new();
    let muted = graph(CLOUDS).replace(r#""noise/simplex""#, r#""noise/simplex", "muted": true"#);
    place.write("muted.sabi", muted);
    let run = place.sabi(&[
        "preview",
        "muted.sabi",
        "--mesh",
        "none.glb",
        "--node",
        "clouds",
        "-o",
        "a.png",
    ]);
    assert_eq!(
        run.fails(65).stderr,
        "error: muted.sabi: node 'clouds' is muted and passes nothing on, so it has no result; unmute it\n"
    );
}

#[test]
fn a_machine_without_a_desktop_hears_no_error_of_the_driver() {
    let place = CliFolder::new();
    let mut command = place.command(&["doctor"]);
    command.env_remove("XDG_RUNTIME_DIR").env_remove("NODEVICE_SELECT");
    let output = command.output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert!(output.status.success());
}

/// No process can create folders in `/proc`, not even with administrator rights.
#[cfg(target_os = "linux")]
#[test]
fn a_machine_without_a_home_folder_keeps_compiled_kernels_with_other_results() {
    let place = CliFolder::new();
    place.bake("clouds.sabi", "sphere.glb", &["--no-cache"]).good();
    assert!(
        !place.path(".cache/kernels").exists(),
        "this machine has a place for them"
    );
    let mut command = place.command(&[
        "bake",
        "clouds.sabi",
        "--mesh",
        "sphere.glb",
        "-o",
        "homeless",
        "--adapter",
        "cpu",
    ]);
    command.args(["--size", "64", "--no-cache", "--quiet"]);
    command
        .env("HOME", "/proc")
        .env("XDG_CACHE_HOME", "/proc")
        .env_remove("MESA_SHADER_CACHE_DIR");
    let output = command.output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert!(output.status.success());
    assert!(place.path(".cache/kernels").read_dir().unwrap().count() > 0);
}

#[test]
fn nodes_are_found_by_the_words_that_artists_use() {
    let place = CliFolder::new();
    assert!(
        place
            .sabi(&["nodes", "perlin"])
            .good()
            .stdout
            .starts_with("noise/simplex\n")
    );
    let several = place.sabi(&["nodes", "noise"]).good().stdout;
    assert!(
        several.lines().count() >= 3 && several.contains("noise/cells"),
        "{several}"
    );
    assert!(place.sabi(&["nodes", "graph/reroute"]).good().stdout.contains("bend"));
    let inputs = place.sabi(&["nodes", "effect/layer"]).good().stdout;
    assert!(inputs.contains("Where the layer lies. [mask, else 1]"), "{inputs}");
}

#[test]
fn a_file_of_strokes_is_described_and_anything_else_is_refused() {
    let place = CliFolder::new();
    let strokes = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../sabi_assets/src/reference/specimen.paint/crate.strokes"
    );
    let report = json(&place.sabi(&["paint", "info", strokes, "--json"]).good().stdout);
    assert_eq!(
        (&report["model"], &report["steps"]),
        (&Json::from("crate"), &Json::from(4))
    );
    assert_eq!(report["versions"][0]["strokes"], 4);
    let table = place.sabi(&["paint", "info", strokes]).good().stdout;
    assert!(
        table.starts_with("model                    crate\n") && table.contains("4 strokes, "),
        "{table}"
    );
    let missing = place.sabi(&["paint", "info", "none.strokes"]).fails(66);
    assert_eq!(
        missing.stderr,
        "error: none.strokes: there is no such file; check the path\n"
    );
    let other = place.sabi(&["paint", "info", "cube.glb"]).fails(65);
    assert_eq!(other.stderr, "error: cube.glb: it is not a file of strokes\n");
}
