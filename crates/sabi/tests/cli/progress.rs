//! Progress without a terminal.

use serde_json::{Value as Json, json};

use crate::cli_folder::{CliFolder, RunOutput, software_adapter};

/// Returns the lines of standard error that are JSON.
fn events(run: &RunOutput) -> Vec<Json> {
    let lines = run.stderr.lines().filter(|line| line.starts_with('{'));
    lines
        .map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}")))
        .collect()
}

#[test]
fn events_tell_each_phase_to_its_end_and_the_exit_code() {
    let place = CliFolder::new();
    let run = place
        .bake("rust.sabi", "cube.glb", &["--progress", "json", "--quiet"])
        .good();
    let events = events(&run);
    assert_eq!(
        events.len(),
        run.stderr.lines().count(),
        "quiet work has events only: {}",
        run.stderr
    );
    let (last, phases) = events.split_last().unwrap();
    assert_eq!(*last, json!({ "event": "done", "exit": 0 }));
    let mut seen: Vec<&str> = Vec::new();
    for event in phases {
        assert_eq!(event["event"], "phase");
        let name = event["phase"].as_str().unwrap();
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    assert_eq!(seen, ["load", "atlas", "upload", "run", "encode"]);
    for name in ["load", "atlas", "run", "encode"] {
        let end = phases.iter().rfind(|event| event["phase"] == name).unwrap();
        assert_eq!(end["done"], end["of"], "{name}");
    }
}

#[test]
fn a_command_that_fails_tells_its_exit_code_last() {
    let place = CliFolder::new();
    let run = place.sabi(&["info", "none.sabi", "--progress", "json"]).fails(66);
    let words = "error: none.sabi: there is no such file; check the path\n{\"event\":\"done\",\"exit\":66}\n";
    assert_eq!(run.stderr, words);
}

#[test]
fn plain_progress_is_lines_of_phases() {
    let place = CliFolder::new();
    let run = place.bake("rust.sabi", "cube.glb", &["--progress", "plain"]).good();
    for phase in ["Reading 1/1", "Preparing UV seams 0/1", "Evaluating ", "Writing maps "] {
        assert!(
            run.stderr.lines().any(|line| line.starts_with(phase)),
            "{phase}: {}",
            run.stderr
        );
    }
    assert!(run.stderr.contains("\nBaked rust.sabi on cube.glb"), "{}", run.stderr);
    assert!(events(&run).is_empty());
}

#[test]
fn progress_is_chosen_on_the_command_line_before_the_variable() {
    software_adapter();
    let place = CliFolder::new();
    let preview = |variable: &str, more: &[&str]| {
        let fixed = [
            "preview",
            "clouds.sabi",
            "--mesh",
            "cube.glb",
            "--node",
            "clouds",
            "--size",
            "16",
            "--adapter",
            "cpu",
            "-o",
            "a.png",
        ];
        let mut command = place.command(&[&fixed, more].concat());
        crate::cli_folder::done(command.env("SABI_PROGRESS", variable).output().unwrap())
    };
    assert!(preview("plain", &[]).good().stderr.starts_with("Reading 1/1\n"));
    assert_eq!(preview("plain", &["--progress", "none"]).good().stderr, "");
    assert_eq!(preview("json", &["--no-progress"]).good().stderr, "");
    assert!(!events(&preview("none", &["--progress", "json"]).good()).is_empty());
    let wrong = preview("bars", &[]).fails(2);
    assert_eq!(
        wrong.stderr,
        "error: SABI_PROGRESS takes auto, plain, json, openjd or none, not 'bars'\n"
    );
    place.sabi(&["doctor", "--no-progress", "--progress", "json"]).fails(2);
}
