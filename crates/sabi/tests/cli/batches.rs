//! `sabi run`: items of a plan.

use std::fs;
use std::process::Stdio;

use serde_json::{Value as Json, json};

use crate::cli_folder::{CLOUDS, CliFolder, RunOutput, graph, software_adapter};
use crate::planning::planned;

const MATRIX: &str = "version = 1\nout = \"out/$mesh/$graph\"\n[[bake]]\nmodels = \"*.glb\"\ngraphs = [\"clouds.sabi\", \"rust.sabi\"]\nsizes = \
    32\n";

/// Creates a folder with a plan of four items.
fn place() -> CliFolder {
    software_adapter();
    let place = CliFolder::new();
    place.write("matrix.toml", MATRIX);
    assert_eq!(planned(&place).len(), 4);
    place
}

fn run(place: &CliFolder, more: &[&str]) -> RunOutput {
    place.sabi(&[&["run", "plan.jsonl", "--adapter", "cpu"], more].concat())
}

/// Returns the output of a run, with paths relative to the folder of the plan.
fn placed(place: &CliFolder, text: &str) -> String {
    let folder = fs::canonicalize(place.path("")).unwrap();
    text.replace(&format!("{}/", folder.display()), "")
}

/// Returns the numbers of the items with a status in a summary.
fn with_status(run: &RunOutput, status: &str) -> Vec<u64> {
    let summary: Json = serde_json::from_str(&run.stdout).unwrap();
    let items = summary["items"].as_array().unwrap().iter();
    let found: Vec<u64> = items
        .filter(|item| item["status"] == status)
        .map(|item| item["item"].as_u64().unwrap())
        .collect();
    assert_eq!(summary[status], found.len(), "{summary}");
    found
}

#[test]
fn finished_items_are_left_alone_and_damaged_ones_baked_again() {
    let place = place();
    let first = run(&place, &["--items", "0-1,3"]).good();
    assert_eq!(first.stdout, "out/cube/clouds\nout/cube/rust\nout/sphere/rust\n");
    assert!(
        first.stderr.starts_with("item 0 of 4: out/cube/clouds: 1 map in "),
        "{}",
        first.stderr
    );
    assert!(first.stderr.ends_with("plan.jsonl: 3 baked\n"), "{}", first.stderr);
    assert!(!place.path("out/sphere/clouds").exists());
    let map = place.read("out/cube/rust/cube_base_color.png");
    place.write("out/cube/rust/cube_base_color.png", "damaged");
    fs::remove_dir_all(place.path("out/sphere/rust/.sabi")).unwrap();
    let dry = run(&place, &["--dry-run"]).good();
    assert_eq!(
        dry.stdout,
        "   0  finished  out/cube/clouds\n   1  waiting   out/cube/rust\n   2  waiting   out/sphere/clouds\n   3  waiting   \
         out/sphere/rust\n"
    );
    let second = run(&place, &["--json", "--jobs", "2"]).good();
    assert_eq!(
        (with_status(&second, "finished"), with_status(&second, "baked")),
        (vec![0], vec![1, 2, 3])
    );
    assert!(place.read("out/cube/rust/cube_base_color.png") == map);
    assert_eq!(with_status(&run(&place, &["--json"]).good(), "finished"), [0, 1, 2, 3]);
    assert_eq!(
        with_status(&run(&place, &["--json", "--again", "--items", "2"]).good(), "baked"),
        [2]
    );
}

#[test]
fn an_item_that_fails_is_told_and_the_others_go_on() {
    let place = place();
    fs::create_dir_all(place.path("out/cube/rust")).unwrap();
    place.write("out/cube/rust/letter.txt", "dear reader");
    let first = run(&place, &["--json"]).fails(1);
    assert_eq!(
        (with_status(&first, "failed"), with_status(&first, "baked")),
        (vec![1], vec![0, 2, 3])
    );
    let words = "error: item 1 of 4: out/cube/rust: the folder out/cube/rust has files but no earlier maps; write into this folder anyway \
                 with --force\n";
    assert!(placed(&place, &first.stderr).contains(words), "{}", first.stderr);
    let summary: Json = serde_json::from_str(&placed(&place, &first.stdout)).unwrap();
    let expected = json!({ "kind": "cannot_write", "exit": 73, "message": "the folder out/cube/rust has files but no earlier maps",
        "remedies": ["write into this folder anyway with --force"] });
    assert_eq!(summary["items"][1]["error"], expected);
    assert_eq!(place.listing("out/cube/rust"), ["letter.txt"]);
    let forced = run(&place, &["--json", "--force"]).good();
    assert_eq!(
        (with_status(&forced, "baked"), with_status(&forced, "finished")),
        (vec![1], vec![0, 2, 3])
    );
}

#[test]
fn an_item_whose_inputs_changed_is_planned_again_first() {
    let place = place();
    place.write("clouds.sabi", graph(CLOUDS).replace("0.9", "0.8"));
    fs::remove_file(place.path("sphere.glb")).unwrap();
    let refused = run(&place, &["--json"]).fails(1);
    assert_eq!(
        (with_status(&refused, "failed"), with_status(&refused, "baked")),
        (vec![0, 2, 3], vec![1])
    );
    for words in [
        "error: item 0 of 4: out/cube/clouds: clouds.sabi was changed after the plan was made; plan again\n",
        "error: item 3 of 4: out/sphere/rust: sphere.glb: there is no such file; check the path\n",
    ] {
        assert!(placed(&place, &refused.stderr).contains(words), "{}", refused.stderr);
    }
    assert_eq!(planned(&place).len(), 2);
    let again = run(&place, &["--json"]).good();
    assert_eq!(
        (with_status(&again, "baked"), with_status(&again, "finished")),
        (vec![0], vec![1])
    );
}

#[test]
fn a_plan_moves_with_its_folder() {
    let place = place();
    run(&place, &["--items", "0"]).good();
    let there = place.path("there");
    fs::create_dir(&there).unwrap();
    for name in [
        "cube.glb",
        "sphere.glb",
        "clouds.sabi",
        "rust.sabi",
        "plan.jsonl",
        "out",
    ] {
        fs::rename(place.path(name), there.join(name)).unwrap();
    }
    let arguments = [
        "run",
        "there/plan.jsonl",
        "--adapter",
        "cpu",
        "--items",
        "0-1",
        "--json",
    ];
    let run = place.sabi(&arguments).good();
    assert_eq!(
        (with_status(&run, "finished"), with_status(&run, "baked")),
        (vec![0], vec![1])
    );
    place
        .sabi(&["verify", "there/out/cube/clouds", "there/out/cube/rust"])
        .good();
}

#[test]
fn maps_may_be_beside_the_folder_of_the_plan() {
    software_adapter();
    let place = CliFolder::new();
    fs::create_dir(place.path("bake")).unwrap();
    place.write(
        "bake/matrix.toml",
        MATRIX
            .replace("out/", "../out/")
            .replace("\"*.glb\"", "\"../cube.glb\"")
            .replace("[\"clouds.sabi\", \"rust.sabi\"]", "\"../rust.sabi\""),
    );
    place.sabi(&["plan", "bake/matrix.toml"]).good();
    let arguments = ["run", "bake/plan.jsonl", "--adapter", "cpu"];
    assert_eq!(place.sabi(&arguments).good().stdout, "out/cube/rust\n");
    assert_eq!(
        with_status(&place.sabi(&[&arguments[..], &["--json"]].concat()).good(), "finished"),
        [0]
    );
    place.sabi(&["verify", "out/cube/rust"]).good();
}

#[test]
fn a_bake_into_a_folder_named_with_detours_remembers_its_inputs() {
    let place = CliFolder::new();
    fs::create_dir(place.path("below")).unwrap();
    place.bake("rust.sabi", "cube.glb", &["-o", "below/../out"]).good();
    place.sabi(&["verify", "out"]).good();
}

#[test]
fn what_is_no_plan_is_refused_with_its_line() {
    let place = CliFolder::new();
    place.write("matrix.toml", MATRIX);
    planned(&place);
    let text = String::from_utf8(place.read("plan.jsonl")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let cases = [
        (String::new(), "plan.jsonl: the plan has no items"),
        (
            text.replacen("\"size\":32", "\"size\":64", 1),
            "plan.jsonl:1: item 0 was changed after it was planned; change the matrix and plan again",
        ),
        (
            lines[1..].join("\n"),
            "plan.jsonl:1: this is item 1, and its place is that of item 0; plan again",
        ),
        (
            format!("{}\nx", lines[0]),
            "plan.jsonl:2: this is no item of a plan: expected value at line 1 column 1; plan again",
        ),
    ];
    for (content, words) in cases {
        place.write("plan.jsonl", content);
        let run = place.sabi(&["run", "plan.jsonl"]).fails(65);
        assert_eq!(run.stderr, format!("error: {words}\n"));
    }
    place.write("plan.jsonl", text);
    let beyond = place.sabi(&["run", "plan.jsonl", "--items", "2-4"]).fails(2);
    assert_eq!(
        beyond.stderr,
        "error: there is no item 4; plan.jsonl has the items 0 to 3\n"
    );
    let missing = place.sabi(&["run", "gone.jsonl"]).fails(66);
    assert_eq!(
        missing.stderr,
        "error: gone.jsonl: there is no such file; check the path\n"
    );
}

#[test]
fn an_item_stops_when_its_run_ends() {
    let place = place();
    let arguments = [
        "run",
        "plan.jsonl",
        "--items",
        "0",
        "--alone",
        "--json",
        "--adapter",
        "cpu",
    ];
    // Its standard input is at its end already.
    let stopped = place.command(&arguments).stdin(Stdio::null()).output().unwrap();
    assert_eq!(stopped.status.code(), Some(130));
    let told: Json = serde_json::from_slice(&stopped.stdout).unwrap();
    assert_eq!(told["error"]["kind"], "interrupted");
    assert!(!place.path("out").exists());
}

#[test]
fn progress_is_told_item_by_item() {
    let place = place();
    let events = run(&place, &["--items", "0-1", "--progress", "json", "--quiet"]).good();
    let lines: Vec<Json> = events
        .stderr
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let of_items: Vec<&Json> = lines.iter().filter(|event| event["event"] == "item").collect();
    let first = json!({ "event": "item", "item": 0, "status": "baked", "done": 1, "of": 2 });
    assert_eq!((of_items.len(), of_items[0]), (2, &first));
    assert_eq!((&lines[0]["item"], &lines[0]["phase"]), (&json!(0), &json!("load")));
    assert_eq!(lines.last().unwrap(), &json!({ "event": "done", "exit": 0 }));
    place.write("sphere.glb", "no model");
    let told = run(&place, &["--items", "0-2", "--progress", "openjd"]).fails(1);
    let said: Vec<&str> = told.stdout.lines().collect();
    let expected = [
        "openjd_status: item 0 of 4: out/cube/clouds: finished before",
        "openjd_progress: 33.3",
        "openjd_status: item 1 of 4: out/cube/rust: finished before",
        "openjd_progress: 66.7",
    ];
    assert_eq!(said[..4], expected);
    assert!(
        said[4].starts_with("openjd_fail: item 2 of 4: out/sphere/clouds: "),
        "{said:?}"
    );
    assert_eq!(said[5..], ["openjd_progress: 100.0"]);
}
