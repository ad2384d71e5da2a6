//! Graphs from standard input.

use std::fs;

use crate::cli_folder::{CLOUDS, CliFolder, RUST, graph, software_adapter};

#[test]
fn a_graph_from_standard_input_is_evaluated_like_its_file() {
    software_adapter();
    let place = CliFolder::new();
    let text = graph(RUST);
    place.bake("rust.sabi", "cube.glb", &["-o", "file"]).good();
    let fixed = ["--mesh", "cube.glb", "--adapter", "cpu"];
    let bake = ["bake", "-", "-o", "piped", "--size", "64", "--report", "report.json"];
    let run = place.sabi_reading(&[&bake[..], &fixed].concat(), &text).good();
    assert!(
        run.stderr.starts_with("Baked standard input on cube.glb at 64 × 64: "),
        "{}",
        run.stderr
    );
    assert_eq!(place.listing("piped"), place.listing("file"));
    for name in place.listing("file") {
        assert!(
            place.read(&format!("piped/{name}")) == place.read(&format!("file/{name}")),
            "{name}"
        );
    }
    let report: serde_json::Value = serde_json::from_slice(&place.read("report.json")).unwrap();
    assert_eq!(report["graph"], "standard input");
    let preview = ["preview", "-", "--node", "clouds", "-o", "a.png", "--size", "64"];
    place.sabi_reading(&[&preview[..], &fixed].concat(), &text).good();
    let render = ["render", "-", "-o", "b.png", "--size", "32x32", "--samples", "1"];
    place.sabi_reading(&[&render[..], &fixed].concat(), &text).good();
    for name in ["a.png", "b.png"] {
        assert!(place.read(name).starts_with(b"\x89PNG"), "{name}");
    }
}

#[test]
fn a_graph_from_standard_input_is_checked_and_described() {
    let place = CliFolder::new();
    let check = place.sabi_reading(&["check", "-", "rust.sabi"], graph(CLOUDS)).good();
    let lines: Vec<&str> = check.stdout.lines().collect();
    assert_eq!(lines[0], "standard input: good, 2 nodes in 1 pass");
    assert!(lines[1].starts_with("rust.sabi: good"), "{}", check.stdout);
    let info = place.sabi_reading(&["info", "-"], graph(CLOUDS)).good();
    assert!(info.stdout.contains("\ngraph     standard input\n"), "{}", info.stdout);
}

#[test]
fn paths_in_a_graph_from_standard_input_start_from_the_current_folder() {
    let place = CliFolder::new();
    fs::create_dir_all(place.path("groups")).unwrap();
    let group = r#"{ "format": "sabi", "version": 1, "outputs": { "mask": "n" }, "nodes": { "n": { "kind": "noise/simplex" } } }"#;
    place.write("groups/wear.sabi", group);
    let text = r#"{ "format": "sabi", "version": 1, "nodes": {
        "g": { "kind": "graph/group", "group": "groups/wear.sabi" },
        "out": { "kind": "output/mask", "inputs": { "source": "g.mask" } } } }"#;
    let check = place.sabi_reading(&["check", "-"], text).good();
    assert_eq!(check.stdout, "standard input: good, 2 nodes in 1 pass\n");
}

#[test]
fn what_is_wrong_with_standard_input_is_told() {
    let place = CliFolder::new();
    let faulty = CLOUDS.replace("simplex", "simplx");
    let cases = [
        (
            graph(&faulty).into_bytes(),
            "standard input:8:5: node 'clouds' is of kind 'noise/simplx'",
        ),
        (Vec::new(), "standard input:1:1: "),
        (
            vec![b'{', 0xff],
            "standard input: the file is not text: byte 1 is not UTF-8; graphs are JSON",
        ),
        (
            b"PK\x03\x04".to_vec(),
            "standard input: this is a zip archive and no graph; ",
        ),
    ];
    for (input, words) in cases {
        let run = place.sabi_reading(&["check", "-"], input).fails(65);
        assert!(run.stderr.starts_with(words), "{words}: {}", run.stderr);
        assert_eq!(run.stdout, "standard input: 1 error\n");
    }
    let twice = place.sabi_reading(&["check", "-", "-"], graph(CLOUDS)).fails(2);
    assert_eq!(
        twice.stderr,
        "standard input holds one graph, but - stands more than once\n"
    );
}

#[test]
fn a_graph_from_standard_input_that_is_too_large_is_refused_before_all_of_it_is_read() {
    let place = CliFolder::new();
    let run = place.sabi_reading(&["info", "-"], vec![b' '; (65 << 20) + 1]).fails(65);
    assert_eq!(
        run.stderr,
        "error: standard input: it goes on after 64 MiB; graphs have at most that\n"
    );
}

#[test]
fn commands_that_need_the_folder_of_a_graph_refuse_standard_input() {
    let place = CliFolder::new();
    let cases: [(&[&str], &str); 4] = [
        (
            &["pack", "-", "-o", "a.zip"],
            "the files of a graph are found from its folder; name a file in place of -",
        ),
        (
            &["edit", "-"],
            "the editor saves a graph to its file; name a file in place of -",
        ),
        (
            &["paint", "flatten", "-"],
            "strokes lie beside the file of their graph; name a file in place of -",
        ),
        (
            &["paint", "reproject", "-", "--mesh", "cube.glb"],
            "strokes lie beside the file of their graph; name a file in place of -",
        ),
    ];
    for (arguments, words) in cases {
        let run = place.sabi_reading(arguments, graph(CLOUDS)).fails(2);
        assert_eq!((run.stdout.as_str(), run.stderr), ("", format!("error: {words}\n")));
    }
}
