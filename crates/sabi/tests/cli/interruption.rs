//! Ctrl-C during a bake, and the end of a run.
#![cfg(unix)]

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use crate::cli_folder::{CliFolder, graph, software_adapter};

/// Twelve noises of sixteen octaves: enough work for an interruption.
fn long_work() -> String {
    let mut nodes = String::new();
    for at in 0..12 {
        let params = format!(r#""params": {{ "octaves": 16, "seed": {at} }}"#);
        nodes += &format!("    \"noise_{at}\": {{ \"kind\": \"noise/simplex\", {params} }},\n");
        let below = if at == 0 {
            String::new()
        } else {
            format!(", \"below\": \"sum_{}\"", at - 1)
        };
        nodes += &format!(
            "    \"sum_{at}\": {{ \"kind\": \"blend/mask\", \"inputs\": {{ \"above\": \"noise_{at}\"{below} }} }},\n"
        );
    }
    nodes += r#"    "clouds": { "kind": "noise/simplex" },
    "out": { "kind": "output/mask", "inputs": { "source": "sum_11" } }"#;
    graph(&nodes)
}

/// Starts a long bake, and returns the process and the rest of its standard error once it evaluates.
fn started(place: &CliFolder) -> (Child, impl BufRead + use<>) {
    software_adapter();
    place.write("long.sabi", long_work());
    let arguments = [
        "bake",
        "long.sabi",
        "--mesh",
        "sphere.glb",
        "-o",
        "out",
        "--size",
        "4096",
        "--adapter",
        "cpu",
        "--no-fuse",
        "--report",
        "report.json",
        "--log",
        "sabi=debug",
    ];
    let mut child = place
        .command(&arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut words = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("Evaluating") {
        line.clear();
        assert_ne!(
            words.read_line(&mut line).unwrap(),
            0,
            "the bake ended before it evaluated anything"
        );
    }
    (child, words)
}

fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
}

#[test]
fn ctrl_c_leaves_no_half_file_and_the_earlier_maps_as_they_were() {
    let place = CliFolder::new();
    place.bake("clouds.sabi", "sphere.glb", &[]).good();
    place.write("report.json", "earlier");
    let before = (place.listing("out"), place.read("out/sphere_mask.png"));
    let (mut child, mut words) = started(&place);
    interrupt(&child);
    let mut said = String::new();
    std::io::Read::read_to_string(&mut words, &mut said).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{said}");
    assert!(
        said.contains("stopping; press Ctrl-C again to quit at once\n"),
        "{said}"
    );
    assert!(
        said.ends_with("error: stopped; nothing was written or changed\n"),
        "{said}"
    );
    assert_eq!((place.listing("out"), place.read("out/sphere_mask.png")), before);
    assert_eq!(place.read("report.json"), b"earlier");
    assert!(!place.listing(".").iter().any(|name| name.ends_with(".tmp")));
}

#[test]
fn a_run_that_the_system_ends_cleans_up_and_leaves_no_process() {
    software_adapter();
    let place = CliFolder::new();
    place.write("long.sabi", long_work());
    let matrix = "version = 1\nout = \"out/$size\"\n[[bake]]\nmodels = \"sphere.glb\"\ngraphs = \"long.sabi\"\nsizes = [4096, 2048]\n";
    place.write("matrix.toml", matrix);
    place.sabi(&["plan", "matrix.toml"]).good();
    let arguments = ["run", "plan.jsonl", "--adapter", "cpu", "--json", "--progress", "json"];
    let mut command = place.command(&arguments);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut words = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains(r#""phase":"run""#) {
        line.clear();
        assert_ne!(
            words.read_line(&mut line).unwrap(),
            0,
            "it ended before it evaluated anything"
        );
    }
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    // Both streams end when all processes that write to them have ended.
    let mut said = String::new();
    std::io::Read::read_to_string(&mut words, &mut said).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(143), "{said}");
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&summary["waiting"], &summary["failed"]), (&2.into(), &0.into()));
    assert!(
        !place.path("out").exists() || place.listing("out").is_empty(),
        "{:?}",
        place.listing("out")
    );
    assert!(said.contains("plan.jsonl: 2 not baked\n"), "{said}");
}

#[test]
fn a_second_ctrl_c_does_not_wait() {
    let place = CliFolder::new();
    let (mut child, mut words) = started(&place);
    interrupt(&child);
    let mut line = String::new();
    while !line.contains("press Ctrl-C again") {
        line.clear();
        assert_ne!(words.read_line(&mut line).unwrap(), 0);
    }
    interrupt(&child);
    // An immediate exit unloads the driver while its threads run, and sometimes a thread crashes first: then a signal ends
    // the process, which is as fast.
    let code = child.wait().unwrap().code();
    assert!(matches!(code, Some(130) | None), "{code:?}");
    let maps = if place.path("out").exists() {
        place.listing("out")
    } else {
        Vec::new()
    };
    assert!(maps.iter().all(|name| name.ends_with(".tmp")), "{maps:?}");
}
